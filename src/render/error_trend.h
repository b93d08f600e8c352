// SPDX-License-Identifier: MIT
/*
 * error_trend.h - the course of a film's error over its samples, and the
 * samples that reach a given error
 *
 * The square of the error falls as 1 / n^p with the samples n: p is 1 for
 * independent samples and a little more where the sequences stratify well.
 *
 * Units:     samples per pixel; relative errors, 0.01 is 1 %
 * Threads:   one at a time
 */
#ifndef GLIM_ERROR_TREND_H
#define GLIM_ERROR_TREND_H

#include <stdint.h>

/* Estimates that the fit looks back on, each with at least twice the samples of
 * the one before. */
#define ERROR_TREND_MAX 5

struct error_trend {
    struct error_at {
        double spp, error;
    } points[ERROR_TREND_MAX], last;
    int count;
};

/* Adds the error after so many samples. */
void error_trend_add(struct error_trend *t, uint64_t spp, double error);

/* Returns p, from 1 to 1.14; 1 while fewer than two estimates are known. */
double error_trend_exponent(const struct error_trend *t);

/* Returns the samples at which an error of `error` after `spp` samples will
 * have fallen to `target`. */
double error_trend_spp(double spp, double error, double target,
                       double exponent);

#endif
