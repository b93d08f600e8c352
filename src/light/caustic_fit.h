// SPDX-License-Identifier: MIT
/*
 * caustic_fit.h - lobes of kernels/caustic_lobes.h that are fitted to photons
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef GLIM_CAUSTIC_FIT_H
#define GLIM_CAUSTIC_FIT_H

#include "light/photons.h"

/* Most photons of a fit. */
#define CAUSTIC_FIT_MOST 48u

/* Most lobes of one place. */
#define CAUSTIC_LOBES_MOST 32u

/* A photon near a place. */
struct near_photon {
    const struct landing *landing;
    float square; /* of the distance */
};

/* A lobe, whose sum is not set, and its photons. */
struct caustic_part {
    struct caustic_lobe lobe;
    double flux;        /* sum */
    double radiance;    /* mean, by flux */
    double solid_angle; /* that of the lobe, seen from where they landed */
};

struct caustic_parts {
    struct caustic_part list[CAUSTIC_LOBES_MOST];
    uint32_t count;
};

/* Adds lobes for photons that have met the same kinds of surfaces: one, or
 * several if that suits them better. Changes the order of the photons. Lobes
 * beyond the most are left out. */
void caustic_fit(struct near_photon *near, uint32_t count,
                 struct caustic_parts *parts);

#endif
