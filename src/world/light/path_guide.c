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
#include "kernels/guide.h"
#include "kernels/light.h"

/* Share of the table for paths to the sky behind panes of glass. A share of 1/2
 * leaves up to a third more error in rooms of albedo .8 and more, and as much
 * error in darker ones. */
#define SHARE_GLAZED 0.25

/* Share of the table for light samples of the sky. .75 leaves 4 to 8 % less
 * variance in rooms, and as much more in an arcade and where a window is
 * smaller than a bin. */
#define SHARE_SKY 0.5

/* Least share of a cell's light for which the cell gets a table. */
#define PART_MIN 0.1

/* The tables while they are made. */
struct table {
    struct guide_cell *cells;
    float *sums;
    uint32_t count;
};

/* ---- the search ---- */

static bool wants_portals(const struct path_guide *g, double sky)
{
    return g->portals.open.flux == NULL && sky > 0;
}

static bool find_portals(struct path_guide *g, const struct world *w,
                         const struct lights *lights, double sky,
                         struct pool *pool)
{
    double box, overlap;

    if (!wants_portals(g, sky))
        return true;
    box = guide_grid_init(&g->grid, w, &overlap);
    g->lights = 2 * lights_power(lights) / box;
    return sky_portals_find(w, &g->grid, overlap, pool, &g->portals);
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
    const struct guide_flux *glazed = &g->portals.glazed;
    double total, part;

    if (glazed->flux == NULL)
        return NO_INDEX;
    total = guide_flux_total(glazed, cell);
    part = guide_flux_share(glazed, cell, total, other_light(g, cell, o));
    if (part < PART_MIN)
        return NO_INDEX;
    guide_flux_add_cdf(glazed, cell, total, SHARE_GLAZED * part, next_sums(t));
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

static bool update(struct path_guide *g, const struct world *w,
                   const struct lights *lights, double sky, struct pool *pool)
{
    struct table t = {.cells = NULL};

    if (w->settings.tri_count > 0 && sky > 0) {
        struct other o;

        if (!find_portals(g, w, lights, sky, pool))
            return false;
        o = (struct other){g->lights / sky,
                           sky_portals_bounces(&g->portals, w)};
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
    return g->cells != NULL;
}

bool path_guide_is_current(const struct path_guide *g, double sky)
{
    return g->is_current && g->sky == sky;
}

bool path_guide_needs_rays(const struct path_guide *g, const struct world *w,
                           double sky)
{
    return !path_guide_is_current(g, sky) && w->settings.tri_count > 0 &&
           wants_portals(g, sky);
}

bool path_guide_update(struct path_guide *g, const struct world *w,
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
    sky_portals_free(&g->portals);
    g->is_current = false;
}

void path_guide_recolor(struct path_guide *g)
{
    g->is_current = g->is_current && g->portals.open.flux == NULL;
}

/* A material without its colours, which the rays of the search do not see. */
static struct material without_colors(struct material m)
{
    m.color = m.specular = v3(1.0f, 1.0f, 1.0f);
    m.color_texture = m.specular_texture = NO_INDEX;
    return m;
}

bool path_guides_differ(const struct material *a, const struct material *b)
{
    struct material x = without_colors(*a), y = without_colors(*b);

    return memcmp(&x, &y, sizeof x) != 0;
}

void path_guide_lend(const struct path_guide *g, struct world *world)
{
    world->settings.guide = (struct guide_grid){.width = 0};
    if (g->cells != NULL)
        world->settings.guide = g->grid;
    world->guide_cells = g->cells;
    world->guide_cdf = g->sums;
}

void path_guide_free(struct path_guide *g)
{
    path_guide_outdate(g);
    free(g->cells);
    free(g->sums);
    *g = (struct path_guide){.cells = NULL};
}
