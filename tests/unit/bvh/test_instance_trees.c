// SPDX-License-Identifier: MIT
#include "kernels/traverse.h"

#include "tests/unit/instance_rays.h"

int main(void)
{
    return run_instance_rays();
}
