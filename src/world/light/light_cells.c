// SPDX-License-Identifier: MIT
#include "world/light/light_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "kernels/light_cells.h"
#include "kernels/radiance_cells.h"
#include "kernels/rng.h"

/* Least width of cells by their distance: coordinates have an end. */
#define WIDTH_MIN 0x1p-15

/* Width of the first light cells of the halves in pixels. */
#define CELL_WIDE   2.4
#define CELL_NARROW 0.6

/* Width of the first radiance cells of the halves by their distance. In rooms
 * .03 to .12 are within 20 % of the least error. */
#define RADIANCE_WIDE   0.1
#define RADIANCE_NARROW 0.05

/* Samples after which the width falls with the fourth root of their number. */
#define CELL_HALF     32
#define RADIANCE_HALF 256

/* Key of the places of grids. */
#define GRID_KEY 0x5be0cd19u

/* ---- grids ---- */

static float random_float(uint32_t *key)
{
    *key = hash_u32(*key + 1u);
    return unit_float(*key);
}

/* Returns a grid with cells of a mean width by their distance. */
static struct light_grid random_grid(const struct camera *c, uint32_t key,
                                     double width)
{
    float z = 2.0f * random_float(&key) - 1.0f;
    struct vec2 turn = cos_sin_turns(random_float(&key));
    float radius = sqrtf(1.0f - z * z);
    struct light_grid g = {.eye = c->eye,
                           .facing = v3(radius * turn.x, radius * turn.y, z)};

    g.offset.x = random_float(&key);
    g.offset.y = random_float(&key);
    g.offset.z = random_float(&key);
    g.distance_scale = 1.0f + random_float(&key);
    /* cells of an octave are 1 to 1/2 of this by the distance */
    g.width =
        (float)(fmax(4. / 3 * width, WIDTH_MIN) / (double)g.distance_scale);
    return g;
}

bool light_cells_begin(struct light_cells *c, const struct world *w,
                       uint64_t begin, double wider, const struct pool *pool)
{
    const struct camera *camera = &w->settings.camera;
    double pixel = 2 * (double)v3_length(camera->up) / (double)camera->height;
    int thread_count = pool != NULL ? pool_thread_count(pool) : 1;
    double finer = pow(1 + (double)begin / CELL_HALF, -0.25);
    double radiance = wider * pow(1 + (double)begin / RADIANCE_HALF, -0.25);
    const double widths[CELL_GRIDS] = {
        CELL_WIDE * pixel * finer,
        CELL_NARROW * pixel * finer,
        RADIANCE_WIDE * radiance,
        RADIANCE_NARROW * radiance,
    };
    uint32_t key = hash_u32(w->settings.seed + GRID_KEY);

    if (c->thread_count != thread_count) {
        light_cells_free(c);
        c->lists =
            alloc_array(CELL_GRIDS * (size_t)thread_count, sizeof *c->lists);
        if (c->lists == NULL)
            return false;
        c->thread_count = thread_count;
    }
    key = hash_u32(key ^ (uint32_t)begin) ^ (uint32_t)(begin >> 32);
    for (int g = 0; g < CELL_GRIDS; g++)
        c->grids[g] =
            random_grid(camera, hash_u32(key ^ (uint32_t)g), widths[g]);
    for (int i = 0; i < CELL_GRIDS * thread_count; i++) {
        c->lists[i].count = 0;
        c->lists[i].is_cut = false;
    }
    return true;
}

/* Adds a deposit to a grid, unless it has no cell. */
static void add(struct light_cells *c, int thread, int grid,
                const struct light_deposit *deposit)
{
    struct light_deposits *list = &c->lists[CELL_GRIDS * thread + grid];

    if (deposit->key == 0)
        return;
    if (list->count == list->capacity &&
        !grow_array((void **)&list->items, &list->capacity, list->count + 1,
                    sizeof *list->items)) {
        list->is_cut = true;
        return;
    }
    list->items[list->count++] = *deposit;
}

void light_cells_add(struct light_cells *c, int thread, int half, struct vec3 p,
                     struct vec3 ng, const struct light_deposit *deposit)
{
    struct light_deposit d = *deposit;

    d.key = light_place(&c->grids[half], p, ng).key;
    add(c, thread, half, &d);
}

void light_cells_estimate(struct light_cells *c, int thread, int half,
                          uint32_t path, const struct cell_estimates *estimates)
{
    for (uint32_t i = 0; i < estimates->count; i++)
        add(c, thread, (int)RADIANCE_GRID + half,
            &(struct light_deposit){.key = estimates->at[i].key,
                                    .path = path,
                                    .vertex = i,
                                    .light = estimates->at[i].radiance});
}

/* ---- sums ---- */

static int compare(const void *a, const void *b)
{
    const struct light_deposit *x = a, *y = b;

    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    if (x->path != y->path)
        return x->path < y->path ? -1 : 1;
    return x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

/* The deposits of each grid, sorted. */
struct sorting {
    struct light_cells *cells;
    struct light_deposits grids[CELL_GRIDS];
    size_t unique[CELL_GRIDS]; /* cells */
};

static void sort_grid(void *context, uint32_t grid, int worker)
{
    struct sorting *s = context;
    struct light_deposits *to = &s->grids[grid];

    (void)worker;
    for (int i = 0; i < s->cells->thread_count; i++) {
        const struct light_deposits *from =
            &s->cells->lists[CELL_GRIDS * i + (int)grid];

        if (from->count > 0)
            memcpy(to->items + to->count, from->items,
                   from->count * sizeof *from->items);
        to->count += from->count;
    }
    qsort(to->items, to->count, sizeof *to->items, compare);
    for (size_t i = 0; i < to->count; i++)
        s->unique[grid] += i == 0 || to->items[i].key != to->items[i - 1].key;
}

static struct vec3 sum_light(const struct light_deposit *d, size_t count,
                             double scale)
{
    double rgb[3] = {0, 0, 0};

    for (size_t i = 0; i < count; i++) {
        rgb[0] += (double)d[i].light.x;
        rgb[1] += (double)d[i].light.y;
        rgb[2] += (double)d[i].light.z;
    }
    return v3((float)(rgb[0] * scale), (float)(rgb[1] * scale),
              (float)(rgb[2] * scale));
}

/* Chooses the direction of a deposit by flux. */
static struct vec3 choose_direction(const struct light_deposit *d, size_t count)
{
    double total = 0, choice;
    size_t i = 0;

    for (size_t k = 0; k < count; k++)
        total += color_mean(d[k].light);
    choice = (double)unit_float(hash_u32(d->path ^ (uint32_t)d->key)) * total;
    while (i + 1 < count && choice >= color_mean(d[i].light))
        choice -= color_mean(d[i++].light);
    return d[i].d;
}

/* Returns a cell of `count` deposits. */
static struct light_cell sum_cell(const struct light_deposit *d, size_t count,
                                  int grid, uint64_t path_count)
{
    if (grid >= (int)RADIANCE_GRID)
        return (struct light_cell){.key = d->key,
                                   .light =
                                       sum_light(d, count, 1 / (double)count),
                                   .d = v3((float)count, 0, 0)};
    return (struct light_cell){.key = d->key,
                               .light =
                                   sum_light(d, count, 1 / (double)path_count),
                               .d = choose_direction(d, count)};
}

static void fill_grid(struct sorting *s, int grid, uint64_t path_count)
{
    const struct light_deposits *from = &s->grids[grid];
    const struct light_grid *g = &s->cells->grids[grid];
    struct light_cell *slots = s->cells->cells + g->first;

    for (size_t i = 0, end; i < from->count; i = end) {
        uint32_t slot = cell_slot(g, from->items[i].key);

        for (end = i + 1;
             end < from->count && from->items[end].key == from->items[i].key;)
            end++;
        while (slots[slot].key != 0)
            slot = (slot + 1u) & g->mask;
        slots[slot] = sum_cell(from->items + i, end - i, grid, path_count);
    }
}

/* Gives each grid twice as many slots as it has cells, or more. */
static bool make_slots(struct sorting *s)
{
    struct light_cells *c = s->cells;

    c->slot_count = 0;
    for (int g = 0; g < CELL_GRIDS; g++) {
        uint32_t slots = 2;

        while (slots < 2 * s->unique[g])
            slots *= 2;
        c->grids[g].first = (uint32_t)c->slot_count;
        c->grids[g].mask = slots - 1;
        c->slot_count += slots;
    }
    free(c->cells);
    c->cells = alloc_array(c->slot_count, sizeof *c->cells);
    return c->cells != NULL;
}

bool light_cells_end(struct light_cells *c, uint64_t path_count,
                     struct pool *pool)
{
    struct sorting s = {.cells = c};
    bool ok = true;

    for (int g = 0; g < CELL_GRIDS; g++) {
        size_t count = 0;

        for (int i = 0; i < c->thread_count; i++) {
            count += c->lists[CELL_GRIDS * i + g].count;
            ok = ok && !c->lists[CELL_GRIDS * i + g].is_cut;
        }
        s.grids[g].items = alloc_array(count, sizeof *s.grids[g].items);
        ok = ok && s.grids[g].items != NULL;
    }
    if (ok) {
        pool_each(pool, CELL_GRIDS, sort_grid, &s);
        ok = make_slots(&s);
    }
    for (int g = 0; g < CELL_GRIDS; g++) {
        if (ok)
            fill_grid(&s, g, path_count);
        free(s.grids[g].items);
    }
    return ok;
}

void light_cells_free(struct light_cells *c)
{
    for (int i = 0; i < CELL_GRIDS * c->thread_count; i++)
        free(c->lists[i].items);
    free(c->lists);
    free(c->cells);
    *c = (struct light_cells){.cells = NULL};
}
