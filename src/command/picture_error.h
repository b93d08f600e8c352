// SPDX-License-Identifier: MIT
/*
 * picture_error.h - the error of a picture against a reference
 *
 * Units:     linear radiance, row 0 at the top, 3 floats a pixel
 * Threads:   any
 */
#ifndef GLIM_PICTURE_ERROR_H
#define GLIM_PICTURE_ERROR_H

/* Two pictures of the same size. */
struct picture_pair {
    int width, height;
    const float *rgb;
    const float *reference;
};

/* Differences are rgb - reference. Means are over pixels and channels. */
struct picture_error {
    double mse;    /* mean of the squares of the differences */
    double relmse; /* mean of (rgb - reference)^2 / (reference^2 + 0.01) */
    double bias;   /* mean difference over the mean of the reference; NaN for a
                      black reference */
    double bias_margin; /* half of the 95 % interval of the bias, if the noise
                           of pixels is independent; NaN for a single pixel */
    double percentile;  /* 99.9 % of the differences are at most this, without
                           their sign */
    double largest;     /* the largest difference, with its sign */
    int largest_x, largest_y, largest_channel;
};

struct picture_error picture_error_of(const struct picture_pair *pair);

/* Returns the relative root mean square error as film_error.h defines it, with
 * the means of the reference around each pixel: what a film of the picture is
 * to state. `exposure` is that of the view. */
double picture_error_stated(const struct picture_pair *pair, double exposure);

/* Errors of parts of the picture, which are independent of each other: each has
 * pixels from everywhere. */
#define PIXEL_GROUPS 16

struct group_errors {
    double mse[PIXEL_GROUPS], relmse[PIXEL_GROUPS];
};

struct group_errors picture_error_groups(const struct picture_pair *pair);

/* Returns the measured error without the reference's own, which is independent
 * and so adds to it. Up to 5 % of the measured error it does not matter and
 * stays. The result is 0 or less if the reference is too noisy. */
double picture_error_without(double measured, double own);

#endif
