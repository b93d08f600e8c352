// SPDX-License-Identifier: MIT
/*
 * render_metadata.h - the metadata of a rendered picture
 *
 * Threads:   any
 */
#ifndef GLIM_RENDER_METADATA_H
#define GLIM_RENDER_METADATA_H

#include "film/film_file.h"
#include "image/image_metadata.h"
#include "render/render_loop.h"

/* Returns program, scene, seed, samples, the error if it is known, the limit
 * that ended the render, and whether the picture is filtered. Nothing depends
 * on the machine: equal renders have equal metadata. The time of rendering is
 * given only if it ended the render. Of the scene's path only the name counts.
 */
struct image_metadata render_metadata(const struct render_progress *p,
                                      const char *scene_path, uint32_t seed,
                                      bool is_denoised);

/* Returns the same of a film, with what its samples are counted from, and how
 * the scene was opened, without the hashes of its identity. */
struct image_metadata render_metadata_film(const struct render_progress *p,
                                           const struct film_header *h,
                                           bool is_denoised);

/* Adds the hashes of an identity. */
void render_metadata_identify(struct image_metadata *m,
                              const struct film_identity *id);

/* Sets the hashes of an identity. Returns false if there are none. */
bool render_metadata_identity(const struct image_metadata *m,
                              struct film_identity *id);

/* Returns the name of a limit: samples, error or time; NULL for none. */
const char *render_limit_name(enum render_limit limit);

#endif
