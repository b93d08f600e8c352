// SPDX-License-Identifier: MIT
/*
 * band.h - a band of a film's rows, which a rank renders in a film of its own
 *
 * Sums are integers, so the bands can be added to the whole film in any order
 * (film_merge()).
 *
 * Units:     pixels
 * Ownership: band_free() frees; a zeroed struct is empty
 * Threads:   one at a time
 * Errors:    out of memory, errors of the backend
 */
#ifndef GLIM_BAND_H
#define GLIM_BAND_H

#include "render/backend.h"

/* The first row of a band is a multiple of this. */
#define BAND_ROWS 8

struct band {
    int y; /* first row in the whole film */
    /* the new samples alone, after band_render() */
    struct film film;
    uint64_t *before; /* samples that the pixels had in the whole film */
    uint16_t *shares; /* of adaptive sampling; NULL: none */
    struct pass pass; /* the band's part of a pass; its shares are these */
};

/* Makes a band of rows from y on of a film of this width, for a pass. `before`,
 * and `shares` if the pass has some, are to be filled. */
bool band_init(struct band *b, int width, int y, int rows, bool has_surfaces,
               const struct pass *pass, struct error *err);

/* Fills `before` and `shares` from the whole film and the pass. Nobody adds to
 * these rows. */
void band_take(struct band *b, const struct film *film,
               const struct pass *pass);

/* Renders the band of a film whose corner is (x0, y0) in the picture, and whose
 * pixels begin with sample first_sample. */
enum pass_result band_render(struct band *b, struct backend *backend,
                             const struct host_world *host,
                             const struct world *world, int x0, int y0,
                             uint64_t first_sample, const struct cancel *cancel,
                             struct error *err);

void band_free(struct band *b);

#endif
