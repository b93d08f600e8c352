// SPDX-License-Identifier: MIT
/*
 * reference.h - the picture that others are compared with, and its own noise
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
    char origin[160]; /* where it comes from, for people */
};

/* A picture by another renderer: reference.pfm, of which `reduce` x `reduce`
 * pixels become one, and reference.json with its noise, both beside the
 * scene. */
bool reference_read(struct reference *r, const char *scene_path, int reduce,
                    struct error *err);

/* A long render by glim itself, of seeds that no measurement uses: two halves,
 * which say how noisy it is. They are kept in `folder` and read again from
 * there unless the scene is younger. */
bool reference_make(struct reference *r, struct session *s, enum direct direct,
                    const char *folder, struct error *err);

/* Relative MSE of a picture of the same size, the reference's noise included.
 */
double reference_error(const struct reference *r, const float *rgb);

/* By how much its mean is above the reference's, as a part of that. */
double reference_bias(const struct reference *r, const float *rgb);

void reference_free(struct reference *r);

#endif
