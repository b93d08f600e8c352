// SPDX-License-Identifier: MIT
#include "world/light/path_guide.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/thread_pool.h"
#include "world/bvh/bvh8.h"
#include "world/light/guide_grid.h"
#include "world/light/lights.h"
#include "world/light/photons.h"
#include "world/light/triangle_cdf.h"
#include "kernels/guide.h"
#include "kernels/light.h"

/* Share of the table for caustics, at most; half of it where caustics are as
 * bright as other light. */
#define SHARE_CAUSTICS 0.5

/* Share of the table for paths to the sky behind panes of glass. A share of 1/2
 * leaves up to a third more error in rooms of albedo .8 and more, and as much
 * error in darker ones. */
#define SHARE_GLAZED 0.25

/* Share of the table for light samples of the sky. .75 leaves 4 to 8 % less
 * variance in rooms, and as much more in an arcade and where a window is
 * smaller than a bin. */
#define SHARE_SKY 0.5

/* Least share of a cell's light for which the cell gets a table. For caustics
 * on two balls this leaves out half of the cells, for 3 % more error and 7 %
 * less time. */
#define PART_MIN 0.1

/* The tables while they are made. */
struct table {
    struct guide_cell *cells;
    float *sums;
    uint32_t count;
};

/* ---- caustics ---- */

/*
 * Their flux is added up on the next two diffuse surfaces: those that have the
 * caustic, and those that it lights. Measured for a glass ball and a gold one:
 * 20 ms of one thread, and .66 times the error.
 */

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

/* Traces photons and adds their flux to `caustics`. `box` is the surface area
 * of the box around the scene. */
static bool caustics_find(const struct bvh8_world *w,
                          const struct lights *lights,
                          const struct guide_grid *grid, double box,
                          struct pool *pool, struct guide_flux *caustics)
{
    struct photons p = {.landings = NULL};
    const struct photon_plan plan = {PHOTONS_OF_TRIANGLES, PHOTONS, LANDINGS,
                                     box};
    bool ok = photons_trace(w, lights, &plan, pool, &p);

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

/* ---- the fluxes ---- */

static bool wants_caustics(const struct path_guide *g, const struct world *w)
{
    return g->caustics.flux == NULL &&
           photons_possible(w, PHOTONS_OF_TRIANGLES);
}

static bool wants_lamps(const struct path_guide *g, const struct world *w)
{
    return !g->has_lamps && photons_possible(w, PHOTONS_OF_LAMPS);
}

static bool wants_portals(const struct path_guide *g, double sky)
{
    return g->portals.open.flux == NULL && sky > 0;
}

static bool find_parts(struct path_guide *g, const struct bvh8_world *w,
                       const struct lights *lights, double sky,
                       struct pool *pool)
{
    bool has_caustics = wants_caustics(g, &w->world);
    bool has_portals = wants_portals(g, sky);
    double box, overlap;

    if (!has_caustics && !has_portals)
        return true;
    box = guide_grid_init(&g->grid, &w->world, &overlap);
    g->lights = 2 * lights_power(lights) / box;
    return (!has_caustics ||
            (guide_flux_init(&g->caustics, &g->grid) &&
             caustics_find(w, lights, &g->grid, box, pool, &g->caustics))) &&
           (!has_portals ||
            sky_portals_find(w, &g->grid, overlap, pool, &g->portals));
}

/* Searches for caustics of lamps, or frees the tables if there can be none. */
static bool update_lamps(struct path_guide *g, const struct bvh8_world *w,
                         const struct lights *lights, struct pool *pool)
{
    if (g->has_lamps)
        return true;
    if (!wants_lamps(g, &w->world))
        caustic_lobes_free(&g->lamps);
    else if (!caustic_lobes_build(&g->lamps, w, lights, pool))
        return false;
    g->has_lamps = true;
    return true;
}

/* ---- the table ---- */

/* Light that no table has, relative to the radiance of the sky. */
struct other {
    double lights;
    double bounces; /* sky_portals_bounces() */
};

/* Space for the cdf of one more table, all 0. */
static float *next_sums(struct table *t)
{
    float *sums = t->sums + (size_t)t->count * GUIDE_BINS;

    return memset(sums, 0, GUIDE_BINS * sizeof *sums);
}

static uint32_t take_sums(struct table *t)
{
    return t->count++ * (uint32_t)GUIDE_BINS;
}

static double other_light(const struct path_guide *g, uint32_t cell,
                          const struct other *o)
{
    return o->bounces * (double)g->portals.bounced[cell] + o->lights;
}

/* Adds a table for the next ray of paths. Returns where it begins, or NO_INDEX
 * if it is not worth its time in this cell. */
static uint32_t add_scatter_table(struct table *t, const struct path_guide *g,
                                  uint32_t cell, const struct other *o)
{
    const struct guide_flux *fluxes[2] = {&g->caustics, &g->portals.glazed};
    const double most[2] = {SHARE_CAUSTICS, SHARE_GLAZED};
    double totals[2] = {0, 0}, shares[2] = {0, 0};
    double scale;
    float *sums;

    for (int i = 0; i < 2; i++)
        if (fluxes[i]->flux != NULL) {
            double other = i == 0 ? 0 : other_light(g, cell, o), part;

            totals[i] = guide_flux_total(fluxes[i], cell);
            part = guide_flux_share(fluxes[i], cell, totals[i], other);
            shares[i] = part < PART_MIN ? 0 : most[i] * part;
        }
    if (shares[0] + shares[1] == 0)
        return NO_INDEX;
    /* the shares as if one table were asked after the other */
    scale = 1 - shares[0] * shares[1] / (shares[0] + shares[1]);
    sums = next_sums(t);
    for (int i = 0; i < 2; i++)
        guide_flux_add_cdf(fluxes[i], cell, totals[i], scale * shares[i], sums);
    return take_sums(t);
}

/* Adds a table for light samples of the sky, in the same way. */
static uint32_t add_sky_table(struct table *t, const struct path_guide *g,
                              uint32_t cell, const struct other *o)
{
    const struct guide_flux *open = &g->portals.open;
    double total = guide_flux_total(open, cell);

    if (guide_flux_share(open, cell, total, other_light(g, cell, o)) < PART_MIN)
        return NO_INDEX;
    guide_flux_add_cdf(open, cell, total, SHARE_SKY, next_sums(t));
    return take_sums(t);
}

/* Returns true if direct light of the sky is enough of the light in the cells
 * that it reaches. In white rooms it is not: few of a path's many vertices
 * would gain, and all would take more time. */
static bool is_sky_worth_it(const struct path_guide *g, const struct other *o)
{
    const struct guide_flux *open = &g->portals.open;
    double direct = 0, all = 0;

    for (uint32_t i = 0; open->flux != NULL && i < guide_cell_count(&g->grid);
         i++) {
        double total = guide_flux_total(open, i);

        if (total > 0) {
            direct += total;
            all += total + (double)open->rest[i] + other_light(g, i, o);
        }
    }
    return all > 0 && direct >= PART_MIN * all;
}

static bool make_table(const struct path_guide *g, const struct other *o,
                       struct table *t)
{
    uint32_t count = guide_cell_count(&g->grid);
    bool has_sky = is_sky_worth_it(g, o);

    t->cells = alloc_array(count, sizeof *t->cells);
    t->sums = alloc_array((size_t)count * 2 * GUIDE_BINS, sizeof *t->sums);
    if (t->cells == NULL || t->sums == NULL)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        t->cells[i].scatter = add_scatter_table(t, g, i, o);
        t->cells[i].sky = has_sky ? add_sky_table(t, g, i, o) : NO_INDEX;
    }
    return true;
}

static void take_table(struct path_guide *g, struct table *t)
{
    free(g->cells);
    free(g->sums);
    if (t->count == 0) {
        free(t->cells);
        free(t->sums);
        *t = (struct table){.cells = NULL};
    }
    g->cells = t->cells;
    g->sums = t->sums;
    g->grid.table_count = t->count;
}

static bool update(struct path_guide *g, const struct bvh8_world *w,
                   const struct lights *lights, double sky, struct pool *pool)
{
    struct table t = {.cells = NULL};

    if (w->world.settings.tri_count > 0) {
        struct other o = {.lights = INFINITY};

        if (!find_parts(g, w, lights, sky, pool) ||
            !update_lamps(g, w, lights, pool))
            return false;
        if (sky > 0)
            o = (struct other){g->lights / sky,
                               sky_portals_bounces(&g->portals, &w->world)};
        if (!make_table(g, &o, &t)) {
            free(t.cells);
            free(t.sums);
            return false;
        }
    }
    take_table(g, &t);
    return true;
}

bool path_guide_has_tables(const struct path_guide *g)
{
    return g->cells != NULL || g->lamps.nodes != NULL;
}

bool path_guide_is_current(const struct path_guide *g, double sky)
{
    return g->is_current && g->sky == sky;
}

bool path_guide_needs_rays(const struct path_guide *g, const struct world *w,
                           double sky)
{
    return !path_guide_is_current(g, sky) && w->settings.tri_count > 0 &&
           (wants_caustics(g, w) || wants_lamps(g, w) || wants_portals(g, sky));
}

bool path_guide_update(struct path_guide *g, const struct bvh8_world *w,
                       const struct lights *lights, double sky,
                       struct pool *pool, struct error *err)
{
    if (path_guide_is_current(g, sky))
        return true;
    if (!update(g, w, lights, sky, pool)) {
        path_guide_outdate(g);
        return fail(err, "out of memory for the table of directions");
    }
    g->sky = sky;
    g->is_current = true;
    return true;
}

void path_guide_outdate(struct path_guide *g)
{
    guide_flux_free(&g->caustics);
    sky_portals_free(&g->portals);
    path_guide_outdate_lamps(g);
}

void path_guide_outdate_lamps(struct path_guide *g)
{
    g->has_lamps = false;
    g->is_current = false;
}

void path_guide_recolor(struct path_guide *g)
{
    g->is_current = g->is_current && g->portals.open.flux == NULL;
}

bool path_guides_differ(const struct material *a, const struct material *b)
{
    struct material x = photons_material(*a), y = photons_material(*b);

    return memcmp(&x, &y, sizeof x) != 0;
}

void path_guide_lend(const struct path_guide *g, struct world *world)
{
    world->settings.guide = (struct guide_grid){.width = 0};
    if (g->cells != NULL)
        world->settings.guide = g->grid;
    world->guide_cells = g->cells;
    world->guide_cdf = g->sums;
    caustic_lobes_lend(&g->lamps, world);
}

void path_guide_free(struct path_guide *g)
{
    path_guide_outdate(g);
    free(g->cells);
    free(g->sums);
    caustic_lobes_free(&g->lamps);
    *g = (struct path_guide){.cells = NULL};
}
