// SPDX-License-Identifier: MIT
/*
 * band_plan.h - the bands of a pass, in the order in which ranks get them
 *
 * A pass is divided into bands of rows. Each band is a part of a rank's share
 * of the rows that are left, so that bands are large at first and small at the
 * end, and a slow rank gets fewer of them. If there are too few rows for the
 * ranks, the samples of the pass are divided, too, into slices, which are
 * handed out one after the other.
 *
 * Units:     rows of a film, mean samples per pixel
 * Threads:   one at a time
 */
#ifndef GLIM_BAND_PLAN_H
#define GLIM_BAND_PLAN_H

#include "render/backend.h"

/* The first row of a band is a multiple of this. */
#define BAND_ROWS 2

/* A band: rows in which the pixels get the samples of a slice. */
struct band_range {
    int y, rows;
    uint64_t first; /* samples at the beginning of the slice: as pass.target */
    struct pass pass; /* of the slice */
};

struct band_plan {
    const struct film *film;
    struct pass pass;
    int ranks;
    int most_rows; /* of a band, for the size of messages */
    int slices;
    int slice, y; /* the next band */
};

/* Begins the plan for a pass over the film, of which nobody has more. */
struct band_plan band_plan_begin(const struct film *film,
                                 const struct pass *pass, int ranks,
                                 int most_rows);

/* Takes the next band whose pixels lack samples. Returns false if there are no
 * more. */
bool band_plan_next(struct band_plan *p, struct band_range *range);

/* Returns true in the last part of the pass, where ranks would wait for one
 * that has a second band. */
bool band_plan_is_ending(const struct band_plan *p);

/* Returns true if no band is left. */
bool band_plan_is_empty(const struct band_plan *p);

/* Returns the samples of pixel `at` of the film before the slice: those that it
 * will have then, if slices before are in progress. */
uint64_t band_plan_before(const struct film *film,
                          const struct band_range *range, size_t at);

/* Returns true if the film has all samples before those of a band. */
bool band_plan_is_next(const struct film *film, const struct band_range *range);

#endif
