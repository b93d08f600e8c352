// SPDX-License-Identifier: MIT
/*
 * engine_film.h - film files of an engine's picture
 *
 * Threads:   main, but engine_film_hash(): any
 * Errors:    files that cannot be written
 */
#ifndef GLIM_ENGINE_FILM_H
#define GLIM_ENGINE_FILM_H

#include "engine/engine.h"
#include "film/film_file.h"

/* Finds what decides the samples of pictures of the view. */
bool engine_film_identify(struct engine *e, const struct view *view,
                          struct film_identity *id, struct error *err);

/* The same in two steps: all but the hashes, with the world that they are of;
 * and the hashes, which take a while, for kernels of a folder or built in
 * (NULL), as long as the world stays as it is. */
bool engine_film_describe(struct engine *e, const struct view *view,
                          struct film_identity *id, struct world *world,
                          struct error *err);
bool engine_film_hash(const struct world *world, const char *kernels_path,
                      struct film_identity *id, struct error *err);

/* Returns the head of the film as it is now, without its identity; *range
 * becomes its one range. The film has at least these samples from here on.
 * `total` are the samples of the whole picture; 0: unknown. */
struct film_header engine_film_header(const struct engine *e,
                                      const struct view *view,
                                      uint64_t first_sample, uint64_t total,
                                      struct film_range *range);

/* Writes the film with a head of engine_film_header(). */
bool engine_film_write(const struct engine *e, const char *path,
                       const struct film_header *h, struct error *err);

#endif
