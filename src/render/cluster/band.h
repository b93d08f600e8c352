// SPDX-License-Identifier: MIT
/*
 * band.h - a band of a film's rows, which a rank renders in a film of its own,
 * and the message with its samples that the rank answers
 *
 * Sums are integers, so the bands can be added to the whole film in any order
 * (film_merge()).
 *
 * Units:     pixels
 * Ownership: band_free() frees; a zeroed struct is empty; the caller frees
 *            answers
 * Threads:   one at a time
 * Errors:    out of memory, errors of the backend, damaged bytes
 */
#ifndef GLIM_BAND_H
#define GLIM_BAND_H

#include "render/cluster/band_plan.h"

/* ---- bands ---- */

struct band {
    struct band_range range; /* whose shares are these */
    /* the new samples alone, after band_render() */
    struct film film;
    uint64_t *before; /* samples that the pixels had in the whole film */
    uint16_t *shares; /* of adaptive sampling; NULL: none */
};

/* Makes a band of a film of this width. `before`, and `shares` if the pass has
 * some, are to be filled. */
bool band_init(struct band *b, int width, const struct band_range *range,
               bool has_surfaces, struct error *err);

/* Fills `before` and `shares` from the whole film and the pass. */
void band_take(struct band *b, const struct film *film,
               const struct band_range *range);

/* Renders the band of a film whose corner is (x0, y0) in the picture, and whose
 * pixels begin with sample first_sample. */
enum pass_result band_render(struct band *b, struct backend *backend,
                             const struct host_world *host,
                             const struct world *world, int x0, int y0,
                             uint64_t first_sample, const struct cancel *cancel,
                             struct error *err);

void band_free(struct band *b);

/* ---- answers ---- */

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
