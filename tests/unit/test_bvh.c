// SPDX-License-Identifier: MIT
#include "kernels/traverse.h"

#include "trees.h"

int main(void)
{
    return run_trees();
}
