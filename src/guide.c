// SPDX-License-Identifier: MIT
#include "glim/guide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glim/caustics.h"
#include "glim/openings.h"
#include "glim/split.h"
#include "glim/tri_list.h"
#include "kernels/light.h"

/* Along the longest side of the scene. On two balls 8 to 16 leave the same
 * error within 2 %, and many sums do not stay near. */
#define CELLS_A_SIDE 10

/* How often the table is asked for one kind of light at most, and where that
 * is as much as the rest it is asked half as often. */
#define SHARE_MOST 0.5

/* Cells that would be asked less often for it are not: half of them on two
 * balls, for 3 % more error and 7 % less time. */
#define SHARE_LEAST 0.05

/* The table while it is made. */
struct table {
    uint32_t *cells;
    float *sums;
    uint32_t cell_count;
};

/* ---- the grid ---- */

static uint32_t cells_along(float length, const struct guide_grid *g)
{
    return (uint32_t)f_max(ceilf(length * g->cells_a_unit), 1.0f);
}

/* Around all triangles; returns the surface of the box. */
static double make_grid(const struct world *w, struct guide_grid *g)
{
    struct vec3 lo = w->positions[w->tris[0].v[0]], hi = lo, size;
    struct box box;

    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct vec3 p[3];

        tri_corners(w, i, p);
        for (int k = 0; k < 3; k++) {
            lo = v3_low(lo, p[k]);
            hi = v3_high(hi, p[k]);
        }
    }
    size = v3_sub(hi, lo);
    g->lo = lo;
    g->cells_a_unit = CELLS_A_SIDE / f_max(size.x, f_max(size.y, size.z));
    g->width = cells_along(size.x, g);
    g->height = cells_along(size.y, g);
    g->depth = cells_along(size.z, g);
    box = box_of_corners(lo, hi);
    return 2.0 * (double)box_area(&box);
}

/* ---- the parts ---- */

static double power_of(const struct world *w)
{
    double power = 0;

    for (uint32_t i = 0; i < w->settings.tri_count; i++)
        if (light_of(w, i) != NO_INDEX)
            power += tri_power(w, i);
    return power;
}

static bool wants_caustics(const struct guide *g, const struct world *w)
{
    return g->caustics.flux == NULL && caustics_possible(w);
}

static bool wants_openings(const struct guide *g, double sky)
{
    return g->openings.flux == NULL && sky > 0;
}

static bool find_parts(struct guide *g, const struct wide_world *w, double sky,
                       struct pool *pool)
{
    bool has_caustics = wants_caustics(g, &w->world);
    bool has_openings = wants_openings(g, sky);
    double box;

    if (!has_caustics && !has_openings)
        return true;
    box = make_grid(&w->world, &g->grid);
    g->lights = 2 * power_of(&w->world) / box;
    return (!has_caustics ||
            (guide_part_init(&g->caustics, &g->grid) &&
             caustics_find(w, &g->grid, box, pool, &g->caustics))) &&
           (!has_openings || (guide_part_init(&g->openings, &g->grid) &&
                              openings_find(w, &g->grid, pool, &g->openings)));
}

/* ---- the table ---- */

/* How often the table is asked for this light in a cell with so much of it and
 * of other light. */
static double share_of(double total, double rest)
{
    double share = total > 0 ? SHARE_MOST * total / (total + rest) : 0;

    return share < SHARE_LEAST ? 0 : share;
}

/* Adds a part's sums, the last of which is `share`. */
static void add_sums(const struct guide_part *part, uint32_t cell, double total,
                     double share, float *sums)
{
    const float *flux = part->flux + (size_t)cell * GUIDE_BINS;
    double sum = 0;

    for (uint32_t i = 0; i < GUIDE_BINS && share > 0; i++) {
        sum += (double)flux[i];
        sums[i] += (float)(sum / total * share);
    }
}

/* The sums of a cell; false if none are worth their time. */
static bool fill_sums(const struct guide *g, uint32_t cell, double lights,
                      float *sums)
{
    const struct guide_part *parts[2] = {&g->caustics, &g->openings};
    const double other[2] = {0, lights};
    double totals[2] = {0, 0}, shares[2] = {0, 0};
    double scale;

    for (int i = 0; i < 2; i++)
        if (parts[i]->flux != NULL) {
            totals[i] = guide_part_total(parts[i], cell);
            shares[i] =
                share_of(totals[i], (double)parts[i]->rest[cell] + other[i]);
        }
    if (shares[0] + shares[1] == 0)
        return false;
    /* as if one were asked after the other */
    scale = 1 - shares[0] * shares[1] / (shares[0] + shares[1]);
    memset(sums, 0, GUIDE_BINS * sizeof *sums);
    for (int i = 0; i < 2; i++)
        add_sums(parts[i], cell, totals[i], scale * shares[i], sums);
    return true;
}

static bool make_table(const struct guide *g, double lights, struct table *t)
{
    uint32_t count = guide_cell_count(&g->grid);

    t->cells = alloc_array(count, sizeof *t->cells);
    t->sums = alloc_array((size_t)count * GUIDE_BINS, sizeof *t->sums);
    if (t->cells == NULL || t->sums == NULL)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = t->cell_count * (uint32_t)GUIDE_BINS;

        t->cells[i] = NO_INDEX;
        if (fill_sums(g, i, lights, t->sums + first)) {
            t->cells[i] = first;
            t->cell_count++;
        }
    }
    return true;
}

static void take_table(struct guide *g, struct table *t)
{
    free(g->cells);
    free(g->sums);
    if (t->cell_count == 0) {
        free(t->cells);
        free(t->sums);
        *t = (struct table){.cells = NULL};
    }
    g->cells = t->cells;
    g->sums = t->sums;
    g->grid.cell_count = t->cell_count;
}

static bool update(struct guide *g, const struct wide_world *w, double sky,
                   struct pool *pool)
{
    struct table t = {.cells = NULL};

    if (w->world.settings.tri_count > 0) {
        if (!find_parts(g, w, sky, pool))
            return false;
        if (!make_table(g, sky > 0 ? g->lights / sky : INFINITY, &t)) {
            free(t.cells);
            free(t.sums);
            return false;
        }
    }
    take_table(g, &t);
    return true;
}

static bool is_done(const struct guide *g, double sky)
{
    return g->is_current && g->sky == sky;
}

bool guide_needs_rays(const struct guide *g, const struct world *w, double sky)
{
    return !is_done(g, sky) && w->settings.tri_count > 0 &&
           (wants_caustics(g, w) || wants_openings(g, sky));
}

bool guide_update(struct guide *g, const struct wide_world *w, double sky,
                  struct pool *pool, struct error *err)
{
    if (is_done(g, sky))
        return true;
    if (!update(g, w, sky, pool)) {
        guide_outdate(g);
        return fail(err, "out of memory for the table of directions");
    }
    g->sky = sky;
    g->is_current = true;
    return true;
}

void guide_outdate(struct guide *g)
{
    guide_part_free(&g->caustics);
    guide_part_free(&g->openings);
    g->is_current = false;
}

bool guides_differ(const struct material *a, const struct material *b)
{
    struct material x = caustics_material(*a), y = caustics_material(*b);

    return memcmp(&x, &y, sizeof x) != 0;
}

void guide_lend(const struct guide *g, struct world *world)
{
    world->settings.guide = (struct guide_grid){.width = 0};
    if (g->cells != NULL)
        world->settings.guide = g->grid;
    world->guide_cells = g->cells;
    world->guide_sums = g->sums;
}

void guide_free(struct guide *g)
{
    guide_outdate(g);
    free(g->cells);
    free(g->sums);
    *g = (struct guide){.cells = NULL};
}
