// SPDX-License-Identifier: MIT
#include "glim/wide_hit.h"

#include "trees.h"

int main(void)
{
    return run_trees();
}
