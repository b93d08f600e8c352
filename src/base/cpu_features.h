// SPDX-License-Identifier: MIT
/*
 * cpu_features.h - instruction sets of this processor, as kernels.mk names
 * them (ISAS)
 *
 * Threads:   any
 */
#ifndef GLIM_CPU_FEATURES_H
#define GLIM_CPU_FEATURES_H

#include <stdbool.h>

bool cpu_has_avx2(void);   /* with FMA and BMI */
bool cpu_has_avx512(void); /* VL, DQ and BW, with the above */

#endif
