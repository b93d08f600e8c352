// SPDX-License-Identifier: MIT
/*
 * student_t.h - quantiles of Student's t distribution
 *
 * Threads:   any
 */
#ifndef GLIM_STUDENT_T_H
#define GLIM_STUDENT_T_H

/* Returns the bound that |t| exceeds with this probability, above 0 and below
 * 1, if t has Student's distribution with `degrees` degrees of freedom, at
 * least 1. For the 95 % interval of a mean the probability is 0.05. */
double student_t_bound(double probability, double degrees);

#endif
