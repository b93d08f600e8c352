// SPDX-License-Identifier: MIT
/*
 * instance_build.h - makes the instances that kernels read of those that the
 * reader added
 *
 * Units:     file units until instances_build()
 * Ownership: the arrays belong to the scene
 * Threads:   one thread while loading
 * Errors:    memory; more triangles than have numbers
 */
#ifndef GLIM_INSTANCE_BUILD_H
#define GLIM_INSTANCE_BUILD_H

#include <stdbool.h>

#include "base/error.h"
#include "base/warnings.h"

struct scene;

/* Joins the bounds of the scene, unless has_bounds is false, with those of all
 * vertices of its instances. */
void instances_join_bounds(struct scene *scene, bool has_bounds);

/* Makes the scene's `placed`, after its meshes were normalised, and frees what
 * it is made of except the meshes. Instances that have no size are dropped. */
bool instances_build(struct scene *scene, struct warnings *report,
                     struct error *err);

#endif
