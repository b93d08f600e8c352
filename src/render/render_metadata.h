// SPDX-License-Identifier: MIT
/*
 * render_metadata.h - the metadata of a rendered picture
 *
 * Threads:   any
 */
#ifndef GLIM_RENDER_METADATA_H
#define GLIM_RENDER_METADATA_H

#include "picture/image_metadata.h"
#include "render/render_loop.h"

/* Returns program, scene, seed and samples. Nothing depends on the machine or
 * the time: equal renders have equal metadata. Of the scene's path only the
 * name counts. */
struct image_metadata render_metadata(const struct render_progress *p,
                                      const char *scene_path, uint32_t seed);

#endif
