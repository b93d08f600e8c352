// SPDX-License-Identifier: MIT
#include "light/caustics.h"

#include <math.h>

#include "light/photons.h"
#include "kernels/guide.h"

/* Number of photons, of which about half arrive. On two balls four times as
 * many leave 8 % less error, but the first picture has to wait for them. */
#define PHOTONS 16384u

/* Diffuse surfaces on which a photon is stored. */
#define LANDINGS 2u

/* Light of other kinds, as a part of the mean irradiance by all lights on the
 * box around the scene. Caustics of this size get half of their share. On two
 * balls twice as much leaves 4 % more error. */
#define REST 0.25

/* Sets the light of other kinds in the unit of the photons' flux. */
static void fill_rest(const struct photons *p, const struct guide_grid *grid,
                      double box, struct guide_flux *caustics)
{
    double cell = 1 / (double)grid->cells_per_unit;
    double rest =
        REST * 2 * M_PI * PHOTONS / p->caster_area * cell * cell / box;

    for (uint32_t i = 0; i < guide_cell_count(grid); i++)
        caustics->rest[i] = (float)rest;
}

bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *caustics)
{
    struct photons p = {.landings = NULL};
    bool ok = photons_trace(w, lights, PHOTONS_OF_TRIANGLES, PHOTONS, LANDINGS,
                            box, pool, &p);

    for (uint32_t i = 0; ok && i < p.landing_count; i++) {
        const struct landing *l = &p.landings[i];

        if (l->flux > 0.0f)
            caustics
                ->flux[guide_cell_index(grid, l->p, l->n) * (size_t)GUIDE_BINS +
                       guide_bin(l->wi)] += l->flux;
    }
    if (ok && p.caster_area > 0)
        fill_rest(&p, grid, box, caustics);
    photons_free(&p);
    return ok;
}
