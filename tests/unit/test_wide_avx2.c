// SPDX-License-Identifier: MIT
#define ISA "avx2"

#include "test_wide.c"
