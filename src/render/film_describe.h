// SPDX-License-Identifier: MIT
/*
 * film_describe.h - the head of the film file of a render
 *
 * Threads:   any
 */
#ifndef GLIM_FILM_DESCRIBE_H
#define GLIM_FILM_DESCRIBE_H

#include "picture/film_header.h"
#include "render/render_loop.h"

/* Returns the identity of a picture's samples, without hashes. `features` are
 * those of the settings. */
struct film_identity film_describe_identity(const struct view *view,
                                            struct rect crop, uint32_t seed,
                                            uint32_t features,
                                            bool is_adaptive);

/* Returns the head of the film at this progress, without identity and tone;
 * *range becomes its one range. `total` are the samples of the whole picture;
 * 0: unknown. */
struct film_header film_describe_header(const struct render_progress *p,
                                        const char *scene_path,
                                        uint64_t first_sample, uint64_t total,
                                        struct film_range *range);

#endif
