// SPDX-License-Identifier: MIT
#define ISA "avx512"

#include "test_wide.c"
