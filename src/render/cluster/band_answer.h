// SPDX-License-Identifier: MIT
/*
 * band_answer.h - the answer of a rank to a band: a message with its samples
 *
 * Ownership: the caller frees answers
 * Threads:   one at a time
 * Errors:    out of memory, damaged bytes
 */
#ifndef GLIM_BAND_ANSWER_H
#define GLIM_BAND_ANSWER_H

#include "render/cluster/band.h"

/* The rows of film_pack() follow if there are samples. */
struct band_answer {
    uint32_t epoch; /* of the band */
    uint32_t has_failed;
    char error[256];
    int y, rows;
    uint64_t first; /* as in struct band_range */
    uint64_t samples, rays, non_finite, saturated, cut_paths;
};

/* Makes the answer for a band with its new samples. `error` is "" or why it
 * failed. *size is that of the message. Returns NULL without memory. */
struct band_answer *band_answer_make(struct band *b, uint32_t epoch,
                                     const char *error, size_t *size);

/* Adds the samples of an answer to the film. */
bool band_answer_add(const struct band_answer *a, size_t size,
                     struct film *film, struct error *err);

#endif
