// SPDX-License-Identifier: MIT
/*
 * film_merge.h - adds the samples of one film to another
 *
 * Threads:   any; the rows of the film are locked one by one, and the part is
 *            used by nobody else
 */
#ifndef GLIM_FILM_MERGE_H
#define GLIM_FILM_MERGE_H

#include "film/film.h"

/* Adds sums, numbers of samples and counters of a part, whose first row is row
 * y of the film. Both have the same width, and surfaces or none. Pixels of the
 * part without samples have sums of 0. */
void film_merge(struct film *film, int y, const struct film *part);

#endif
