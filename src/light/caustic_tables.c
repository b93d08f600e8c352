// SPDX-License-Identifier: MIT
#include "light/caustic_tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "light/guide_grid.h"
#include "light/photons.h"
#include "kernels/caustic_table.h"

/* Number of photons. On a glass ball under the sun four times as many leave no
 * less error after 128 samples, and take .3 s more. */
#define PHOTONS 65536u

/* Cubes along the longest side of the inner grid. On that ball 30 to 60 leave
 * the same error. */
#define CUBES_A_SIDE 40.0f

/* Part of the landings on either side of the inner grid, along each axis. */
#define TAIL 0.03

/* Least number of photons for a bin, on average, by which a group has the
 * finest bins that its photons can fill. */
#define PHOTONS_A_BIN 3u

/* Level of the bins whose photons are a group. */
#define GROUP_LEVEL 3u

/* Photons that a group needs for its bins to move: numbers that are fitted to
 * them, and how far that is damped, as a part of the square of a cell. */
#define FITTED  3u
#define DAMPING 1e-3

/* Flux that each bin lends to each of the eight around it. */
#define SPILL 0.04

/* Share of a table: half of the part of the light that caustics are. */
#define SHARE_MOST  0.5
#define SHARE_LEAST 0.1

/* Light of other kinds, as a part of the mean irradiance by all lamps on the
 * box around the scene. */
#define REST 0.25

/* A photon in its cell. */
struct arrival {
    uint32_t cell;
    uint32_t group;  /* bin of GROUP_LEVEL */
    uint32_t number; /* of the landing */
    struct vec3 p;
    struct vec2 place; /* in the map of directions */
    float flux;
};

/* A bin of the group that is being made. */
struct part {
    uint32_t index;
    float flux;
};

struct build {
    struct caustic_tables *to;
    struct arrival *arrivals;
    uint32_t arrival_count;
    struct part *parts; /* room for 9 of each arrival */
    double rest[2];     /* light of other kinds in a cell of either grid */
};

static int compare_numbers(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

static int compare_arrivals(const void *a, const void *b)
{
    const struct arrival *x = a, *y = b;

    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->group != y->group)
        return x->group < y->group ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

static int compare_parts(const void *a, const void *b)
{
    const struct part *x = a, *y = b;

    return (x->index > y->index) - (x->index < y->index);
}

/* Sets the range of an axis that has all landings but the tails. */
static void find_range(const struct photons *p, float *numbers, uint32_t axis,
                       float range[2])
{
    uint32_t count = 0, tail;

    for (uint32_t i = 0; i < p->landing_count; i++)
        if (p->landings[i].flux > 0.0f)
            numbers[count++] = v3_axis(p->landings[i].p, axis);
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    tail = (uint32_t)(TAIL * count);
    range[0] = count > 0 ? numbers[tail] : 0.0f;
    range[1] = count > 0 ? numbers[count - 1 - tail] : 0.0f;
}

/* Lays the inner grid around most landings, with a margin of half a cube. */
static bool lay_inner(struct guide_grid *g, const struct photons *p)
{
    float *numbers = alloc_array(p->landing_count, sizeof *numbers);
    float ranges[3][2], longest = 1e-6f;
    float margin;

    if (numbers == NULL)
        return false;
    for (uint32_t k = 0; k < 3; k++) {
        find_range(p, numbers, k, ranges[k]);
        longest = f_max(longest, ranges[k][1] - ranges[k][0]);
    }
    free(numbers);
    g->cells_per_unit = CUBES_A_SIDE / longest;
    margin = 0.5f / g->cells_per_unit;
    g->lo =
        v3(ranges[0][0] - margin, ranges[1][0] - margin, ranges[2][0] - margin);
    g->width =
        1 + (uint32_t)ceilf((ranges[0][1] - ranges[0][0]) * g->cells_per_unit);
    g->height =
        1 + (uint32_t)ceilf((ranges[1][1] - ranges[1][0]) * g->cells_per_unit);
    g->depth =
        1 + (uint32_t)ceilf((ranges[2][1] - ranges[2][0]) * g->cells_per_unit);
    return true;
}

/* Sorts the landings into their cells. */
static bool find_arrivals(struct build *b, const struct photons *p)
{
    b->arrivals = alloc_array(p->landing_count, sizeof *b->arrivals);
    b->parts = alloc_array((size_t)p->landing_count * 9, sizeof *b->parts);
    if (b->arrivals == NULL || b->parts == NULL)
        return false;
    for (uint32_t i = 0; i < p->landing_count; i++) {
        const struct landing *l = &p->landings[i];
        struct vec2 place = guide_place(l->wi);

        if (!(l->flux > 0.0f))
            continue;
        b->arrivals[b->arrival_count++] = (struct arrival){
            .cell = caustic_cell_index(b->to->grids, l->p, l->n),
            .group = caustic_bin(place, GROUP_LEVEL),
            .number = i,
            .p = l->p,
            .place = place,
            .flux = l->flux,
        };
    }
    qsort(b->arrivals, b->arrival_count, sizeof *b->arrivals, compare_arrivals);
    return true;
}

/* Adds up parts of the same bin and orders them. Returns their number. */
static uint32_t merge_parts(struct part *parts, uint32_t count)
{
    uint32_t merged = 0;

    qsort(parts, count, sizeof *parts, compare_parts);
    for (uint32_t i = 0; i < count; i++)
        if (merged > 0 && parts[merged - 1].index == parts[i].index)
            parts[merged - 1].flux += parts[i].flux;
        else
            parts[merged++] = parts[i];
    return merged;
}

/* Makes the parts of a group from its arrivals. Returns the number of bins that
 * they are in. */
static uint32_t find_parts(const struct arrival *a, uint32_t count,
                           const struct caustic_group *g, struct part *parts)
{
    uint32_t found = 0;

    for (uint32_t i = 0; i < count; i++) {
        struct vec2 shift = caustic_shift(g, a[i].p);
        struct vec2 place = v2(a[i].place.x - shift.x, a[i].place.y - shift.y);

        if (is_in_map(place))
            parts[found++] =
                (struct part){caustic_bin(place, g->level), a[i].flux};
    }
    return merge_parts(parts, found);
}

/* Adds to each bin a part of those around it, since rays between the photons
 * are near to theirs. */
static uint32_t spill_parts(struct part *parts, uint32_t count, uint32_t level)
{
    uint32_t side = 1u << level, all = count;

    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 9; k++) {
            /* a coordinate of -1 is a large number */
            uint32_t x = parts[i].index % side + k % 3 - 1;
            uint32_t y = parts[i].index / side + k / 3 - 1;

            if (k != 4 && x < side && y < side)
                parts[all++] =
                    (struct part){y * side + x, parts[i].flux * (float)SPILL};
        }
    return merge_parts(parts, all);
}

/* Solves the symmetric equations m x = y for x. m is positive definite. */
static struct vec3 solve(double m[3][3], const double y[3])
{
    double a[3][4], x[3];

    for (int i = 0; i < 3; i++) {
        memcpy(a[i], m[i], sizeof m[i]);
        a[i][3] = y[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++)
            for (int k = 3; k >= i; k--)
                a[j][k] -= a[i][k] * a[j][i] / a[i][i];
    for (int i = 2; i >= 0; i--) {
        x[i] = a[i][3];
        for (int k = i + 1; k < 3; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    return v3((float)x[0], (float)x[1], (float)x[2]);
}

/* Fits the change of directions with the position to a group's arrivals, by
 * least squares. */
static void fit_group(const struct arrival *a, uint32_t count, double cell,
                      struct caustic_group *g)
{
    double m[3][3] = {{0}}, y[2][3] = {{0}}, middle[2] = {0, 0};

    for (uint32_t i = 0; i < count; i++) {
        middle[0] += (double)a[i].place.x / count;
        middle[1] += (double)a[i].place.y / count;
    }
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 way = v3_sub(a[i].p, g->p);
        double way_of[3] = {(double)way.x, (double)way.y, (double)way.z};

        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++)
                m[j][k] += way_of[j] * way_of[k];
            y[0][j] += way_of[j] * ((double)a[i].place.x - middle[0]);
            y[1][j] += way_of[j] * ((double)a[i].place.y - middle[1]);
        }
    }
    for (int j = 0; j < 3; j++)
        m[j][j] += DAMPING * count * cell * cell;
    g->dx = solve(m, y[0]);
    g->dy = solve(m, y[1]);
}

/* Chooses the finest level whose bins the arrivals fill. Returns the number of
 * bins. */
static uint32_t choose_level(const struct arrival *a, uint32_t count,
                             uint32_t fitted, struct caustic_group *g,
                             struct part *parts)
{
    uint32_t bins;

    g->level = CAUSTIC_LEVEL_MOST;
    bins = find_parts(a, count, g, parts);
    while (g->level > CAUSTIC_LEVEL_LEAST &&
           bins * PHOTONS_A_BIN + fitted > count) {
        g->level--;
        bins = find_parts(a, count, g, parts);
    }
    return bins;
}

/* Makes a group, still or moved if that has finer bins. Returns the number of
 * its parts. */
static uint32_t make_group(struct build *b, const struct arrival *a,
                           uint32_t count, double cell, struct caustic_group *g)
{
    uint32_t bins, level;

    memset(g, 0, sizeof *g);
    for (uint32_t i = 0; i < count; i++)
        g->p = v3_add(g->p, v3_scale(a[i].p, 1.0f / (float)count));
    bins = choose_level(a, count, 0, g, b->parts);
    level = g->level;
    if (count >= FITTED + PHOTONS_A_BIN) {
        fit_group(a, count, cell, g);
        bins = choose_level(a, count, FITTED, g, b->parts);
        if (g->level <= level || bins == 0) {
            g->dx = g->dy = v3(0.0f, 0.0f, 0.0f);
            g->level = level;
            bins = find_parts(a, count, g, b->parts);
        }
    }
    return spill_parts(b->parts, bins, g->level);
}

/* Adds a group, whose bins have a sum of 1 for all of the cell's flux. */
static void add_group(struct build *b, const struct arrival *a, uint32_t count,
                      double cell, double total, double *sum)
{
    struct caustic_tables *to = b->to;
    struct caustic_group *g = &to->groups[to->group_count];
    uint32_t parts = make_group(b, a, count, cell, g);
    double flux = 0, all = 0;

    for (uint32_t i = 0; i < parts; i++)
        all += (double)b->parts[i].flux;
    for (uint32_t i = 0; i < count; i++)
        flux += (double)a[i].flux;
    g->before = (float)*sum;
    g->first_bin = to->bin_count;
    g->bin_count = parts;
    g->next = ++to->group_count;
    for (uint32_t i = 0; i < parts; i++) {
        *sum += flux / total * ((double)b->parts[i].flux / all);
        to->bins[to->bin_count++] =
            (struct caustic_bin){b->parts[i].index, (float)*sum};
    }
}

/* Scales the table of a cell to its share. */
static void finish_cell(struct caustic_tables *to, uint32_t first, double total,
                        double rest)
{
    float share = (float)fmax(SHARE_MOST * total / (total + rest), SHARE_LEAST);

    for (uint32_t i = first; i < to->group_count; i++) {
        to->groups[i].before *= share;
        for (uint32_t k = 0; k < to->groups[i].bin_count; k++)
            to->bins[to->groups[i].first_bin + k].sum *= share;
    }
    for (uint32_t i = first; i < to->group_count; i++)
        to->groups[i].share = to->bins[to->bin_count - 1].sum;
    to->groups[to->group_count - 1].next = NO_INDEX;
}

/* Adds the table of a cell. */
static void add_cell(struct build *b, const struct arrival *a, uint32_t count)
{
    struct caustic_tables *to = b->to;
    uint32_t first = to->group_count, end;
    bool is_inner = a->cell < guide_cell_count(&to->grids[0]);
    const struct guide_grid *grid = &to->grids[is_inner ? 0 : 1];
    double cell = 1 / (double)grid->cells_per_unit;
    double total = 0, sum = 0;

    for (uint32_t i = 0; i < count; i++)
        total += (double)a[i].flux;
    for (uint32_t i = 0; i < count; i = end) {
        end = i;
        while (end < count && a[end].group == a[i].group)
            end++;
        add_group(b, &a[i], end - i, cell, total, &sum);
    }
    to->cells[a->cell] = first;
    finish_cell(to, first, total, b->rest[is_inner ? 0 : 1]);
}

static bool make_tables(struct build *b)
{
    struct caustic_tables *to = b->to;
    uint32_t end;

    to->cell_count =
        guide_cell_count(&to->grids[0]) + guide_cell_count(&to->grids[1]);
    to->cells = alloc_array(to->cell_count, sizeof *to->cells);
    to->groups = alloc_array(b->arrival_count, sizeof *to->groups);
    to->bins = alloc_array((size_t)b->arrival_count * 9, sizeof *to->bins);
    if (to->cells == NULL || to->groups == NULL || to->bins == NULL)
        return false;
    memset(to->cells, 0xff, to->cell_count * sizeof *to->cells); /* NO_INDEX */
    for (uint32_t i = 0; i < b->arrival_count; i = end) {
        end = i;
        while (end < b->arrival_count &&
               b->arrivals[end].cell == b->arrivals[i].cell)
            end++;
        add_cell(b, &b->arrivals[i], end - i);
    }
    return true;
}

static bool build(struct caustic_tables *to, const struct bvh8_world *w,
                  const struct lights *lights, struct pool *pool,
                  struct photons *p)
{
    struct build b = {.to = to};
    double box = guide_grid_init(&to->grids[1], &w->world);
    bool ok =
        photons_trace(w, lights, PHOTONS_OF_LAMPS, PHOTONS, 1, box, pool, p) &&
        lay_inner(&to->grids[0], p) && find_arrivals(&b, p);

    for (int i = 0; ok && i < 2; i++) {
        double cell = 1 / (double)to->grids[i].cells_per_unit;

        b.rest[i] =
            REST * 2 * M_PI * PHOTONS / p->caster_area * cell * cell / box;
    }
    ok = ok && (b.arrival_count == 0 || make_tables(&b));
    free(b.arrivals);
    free(b.parts);
    return ok;
}

bool caustic_tables_build(struct caustic_tables *tables,
                          const struct bvh8_world *w,
                          const struct lights *lights, struct pool *pool)
{
    struct caustic_tables made = {.cells = NULL};
    struct photons photons = {.landings = NULL};
    bool ok = build(&made, w, lights, pool, &photons);

    photons_free(&photons);
    if (!ok) {
        caustic_tables_free(&made);
        return false;
    }
    caustic_tables_free(tables);
    *tables = made;
    return true;
}

void caustic_tables_lend(const struct caustic_tables *t, struct world *world)
{
    memcpy(world->settings.caustic_grids, t->grids, sizeof t->grids);
    world->settings.caustic_cell_count = t->cell_count;
    world->settings.caustic_group_count = t->group_count;
    world->settings.caustic_bin_count = t->bin_count;
    world->caustic_cells = t->cells;
    world->caustic_groups = t->groups;
    world->caustic_bins = t->bins;
}

void caustic_tables_free(struct caustic_tables *t)
{
    free(t->cells);
    free(t->groups);
    free(t->bins);
    *t = (struct caustic_tables){.cells = NULL};
}
