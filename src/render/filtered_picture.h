// SPDX-License-Identifier: MIT
/*
 * filtered_picture.h - the filtered picture of a film without surfaces, in any
 * size
 *
 * It is that of screen_filter.h. The first surfaces are those of a draft of as
 * many pixels, which is traced with a few samples.
 *
 * Units:     as screen_filter.h
 * Ownership: all is the caller's, who frees the draft, also after an error
 * Threads:   any, each with films of its own; the film's rows are locked one by
 *            one; workers of the pool trace
 * Errors:    out of memory, or cancelled
 */
#ifndef GLIM_FILTERED_PICTURE_H
#define GLIM_FILTERED_PICTURE_H

#include "base/thread_pool.h"
#include "film/film.h"
#include "kernels/types.h"

/* Traces the draft of a picture, whose pixels are those of the world's camera.
 * The world has its tree. Blocks; the cancel may be NULL. */
bool filtered_picture_draft(struct film *draft, const struct world *world,
                            int width, int height, struct pool *pool,
                            const struct cancel *cancel, struct error *err);

/* Fills a frame of the draft's size, or of the size that film and draft have
 * both, with the filtered light. Blocks. */
bool filtered_picture_paint(struct film *film, struct film *draft,
                            struct develop how, struct frame *frame,
                            struct error *err);

#endif
