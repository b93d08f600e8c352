// SPDX-License-Identifier: MIT
#define ISA "avx512"

#include "test_bvh8.c"
