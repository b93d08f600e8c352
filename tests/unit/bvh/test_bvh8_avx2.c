// SPDX-License-Identifier: MIT
#define ISA "avx2"

#include "test_bvh8.c"
