// SPDX-License-Identifier: MIT
/*
 * replicates.h - the mean of independent renders, and its error by Student's t
 * distribution
 *
 * Units:     linear radiance; errors as struct picture_error
 * Ownership: replicates_free() frees the pictures
 * Threads:   any
 * Errors:    out of memory
 */
#ifndef GLIM_REPLICATES_H
#define GLIM_REPLICATES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

/* ---- quantiles of Student's t ---- */

/* Returns the bound that |t| exceeds with this probability, above 0 and below
 * 1, if t has Student's distribution with `degrees` degrees of freedom, at
 * least 1. For the 95 % interval of a mean the probability is 0.05. */
double student_t_bound(double probability, double degrees);

/* ---- replicates ---- */

/* With fewer, the interval of the error is too wide to be useful. */
#define REPLICATES_MIN 4
#define REPLICATES_MAX 64

/* Pictures of the same scene, size and number of samples with different
 * seeds. */
struct replicates {
    int width, height;
    int count; /* pictures that are complete */
    float *rgb[REPLICATES_MAX];
};

/* Error of the mean of the pictures. */
struct mean_error {
    double mse, relmse;
    double relmse_low, relmse_high; /* 95 % interval of the mean's true error */
    double mean;                    /* over pixels and channels */
};

/* Allocates `capacity` pictures; none is complete. */
bool replicates_init(struct replicates *r, int width, int height, int capacity,
                     struct error *err);

void replicates_free(struct replicates *r);

/* Writes the mean of the complete pictures, at least REPLICATES_MIN, to the
 * first of them, and returns it; *error gets its error. */
const float *replicates_mean(struct replicates *r, struct mean_error *error);

#endif
