// SPDX-License-Identifier: MIT
/*
 * reference.h - the reference picture and its own noise
 *
 * Units:     linear radiance, row 0 at the top; errors are relative MSE: the
 *            mean over pixels and channels of (x - ref)^2 / (ref^2 + 0.01)
 * Ownership: reference_free() frees
 * Threads:   one
 * Errors:    unreadable files; the text names them
 */
#ifndef ERROR_REFERENCE_H
#define ERROR_REFERENCE_H

#include "session/session.h"

struct reference {
    int width, height;
    float *rgb;
    double noise;     /* relative MSE of the reference itself */
    char origin[160]; /* description for people */
};

/* Reads a picture by another renderer: reference.pfm, reduced by `reduce` in
 * width and height, and reference.json with its noise, both beside the scene.
 */
bool reference_read(struct reference *r, const char *scene_path, int reduce,
                    struct error *err);

/* Makes a long render by glim with seeds that no measurement uses, in two
 * halves whose difference gives its noise. They are kept in `folder` and read
 * from there unless the scene is newer. */
bool reference_make(struct reference *r, struct session *s, enum direct direct,
                    const char *folder, struct error *err);

/* Returns the relative MSE of a picture of the same size, including the
 * reference's noise. */
double reference_error(const struct reference *r, const float *rgb);

/* Returns the relative difference of the picture's mean from the
 * reference's. */
double reference_bias(const struct reference *r, const float *rgb);

void reference_free(struct reference *r);

#endif
