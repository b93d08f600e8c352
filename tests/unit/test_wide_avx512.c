// SPDX-License-Identifier: MIT
#include "glim/wide_hit.h"

#include "isa_trees.h"

int main(void)
{
    return run_isa_trees("avx512");
}
