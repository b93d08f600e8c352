// SPDX-License-Identifier: MIT
/*
 * classes.h - variance of a sample by the class of its paths
 *
 * Paths from the eye are traced four times with the same random numbers: all of
 * them, without those that light paths make, without those whose light light
 * cells have, and with those that end at radiance cells. The variance that each
 * step takes away is that of its class.
 *
 * Units:     variance relative to the square of the pixel's mean, mean of all
 *            pixels
 * Threads:   one
 * Errors:    out of memory
 */
#ifndef ERROR_CLASSES_H
#define ERROR_CLASSES_H

#include "base/error.h"
#include "render/cpu_kernel.h"
#include "world/world.h"

struct class_variance {
    double light_paths;    /* lamp, casters, any surfaces, a matte one, eye */
    double light_cells;    /* the same, seen by way of casters */
    double radiance_cells; /* light of two matte surfaces and more */
    double rest;
};

/* Measures samples of all pixels of a world, which has its tree. */
bool class_variance_measure(const struct world *world,
                            const struct cpu_kernel *paths,
                            struct class_variance *v, struct error *err);

#endif
