// SPDX-License-Identifier: MIT
/*
 * batch_filter.h - the filtered picture of --denoise
 *
 * Threads:   main only
 * Errors:    out of memory; a file that cannot be written
 */
#ifndef GLIM_BATCH_FILTER_H
#define GLIM_BATCH_FILTER_H

#include "session/session.h"

/* Checks before the render that the file of --denoise=FILE can be written. */
bool batch_filter_check(const struct session *s, struct error *err);

/* Say that the picture was not filtered, and to which file it was written. */
void batch_filter_warn(void);
void batch_filter_say(const char *path);

/* Filters the film of the render into *filtered, for film_free(), and sets
 * s->is_denoised. If a pixel has fewer than two samples it reports that
 * instead. */
bool batch_filter(struct session *s, struct film *filtered, struct error *err);

/* Writes the filtered film to the file of --denoise=FILE and says so. */
bool batch_filter_write(struct session *s, struct film *filtered,
                        struct error *err);

/* Returns the metadata of a film of the session, which says whether it is the
 * filtered one. */
struct image_metadata batch_filter_metadata(const struct session *s,
                                            const struct film *film);

#endif
