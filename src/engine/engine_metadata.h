// SPDX-License-Identifier: MIT
/*
 * engine_metadata.h - the metadata of an engine's picture, by which its scene
 * can be opened again as it was rendered
 *
 * The view is the text of a view file in one line, with semicolons for the ends
 * of lines, and names of files as seen from the scene's folder. Lines before it
 * have other options: `option gi exact`.
 *
 * Ownership: engine_metadata_view() returns memory for free()
 * Threads:   main only
 * Errors:    a view that has a semicolon, or no room in its text, is left out
 */
#ifndef GLIM_ENGINE_METADATA_H
#define GLIM_ENGINE_METADATA_H

#include "engine/engine.h"
#include "film/film_file.h"

/* Returns the metadata of the picture of the view as it is now, or of its
 * filtered copy. The hashes of its identity take a while. */
struct image_metadata engine_metadata(struct engine *e, const struct view *view,
                                      bool is_filtered);

/* The same without the hashes, which the caller adds: the identity is that of
 * engine_film_describe(). */
struct image_metadata engine_metadata_described(const struct engine *e,
                                                const struct view *view,
                                                const struct film_identity *id,
                                                bool is_filtered);

/* Writes how the scene was opened, or "". */
void engine_metadata_write_view(const struct engine *e, const struct view *view,
                                char text[FILM_VIEW_BYTES]);

/* Returns the lines of the view, or NULL if there are none. `option` lines are
 * the first. */
char *engine_metadata_view(const struct image_metadata *m);

#endif
