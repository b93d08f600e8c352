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

/* Width of the first light cells of the halves in pixels, the finest. */
#define CELL_WIDE   2.4
#define CELL_NARROW 0.6

/* Number of deposits in each of the first narrow cells at which no wider ones
 * are needed. */
#define LIGHT_COUNT_MIN 0.9

/* Distance in widths of a cell within which it gets light that is seen in it
 * from a point. */
#define CELL_REACH 2.5f

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
    for (int g = 0; g < CELL_GRIDS; g++) {
        c->grids[g] =
            random_grid(camera, hash_u32(key ^ (uint32_t)g), widths[g]);
        c->grids[g].count_min =
            (float)(LIGHT_COUNT_MIN *
                    pow(widths[g] / (CELL_NARROW * pixel), 2));
    }
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

/* Adds light to the cells of its octave, and to those of the next ones that
 * reach as far. */
void light_cells_add(struct light_cells *c, int thread, int half, struct vec3 p,
                     struct vec3 ng, const struct light_deposit *deposit)
{
    const struct light_grid *g = &c->grids[half];
    uint32_t octave = cell_octave(g, p);
    float reach = CELL_REACH * (float)(1u << (CELL_LEVELS - 1)) * g->width *
                  g->distance_scale;
    float distance = v3_length(v3_sub(p, g->eye)) * g->distance_scale;
    float begin = bits_float(octave << 23);
    struct light_deposit d = *deposit;

    d.key = light_place(g, p, ng, octave).key;
    add(c, thread, half, &d);
    if (distance - begin <= 0.5f * begin * reach) {
        d.key = light_place(g, p, ng, octave - 1u).key;
        add(c, thread, half, &d);
    }
    if (2.0f * begin - distance <= 2.0f * begin * reach) {
        d.key = light_place(g, p, ng, octave + 1u).key;
        add(c, thread, half, &d);
    }
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

static uint32_t level_count(uint32_t grid)
{
    return grid < RADIANCE_GRID ? CELL_LEVELS : 1;
}

/* The key of a deposit's cell of a level. */
static uint64_t key_at(uint64_t key, uint32_t grid, uint32_t level)
{
    return grid < RADIANCE_GRID ? light_cell_above(key, level) : key;
}

/* Deposits are divided by the hash of their widest cell, so that sorting is
 * parallel and ends soon after a cancel. */
#define BUCKETS 64

static uint32_t bucket_of(uint64_t key, uint32_t grid)
{
    return cell_hash(key_at(key, grid, level_count(grid) - 1)) /
           (UINT32_MAX / BUCKETS + 1);
}

/* The deposits of each grid, bucket by bucket. */
struct sorting {
    struct light_cells *cells;
    struct light_deposits grids[CELL_GRIDS];
    size_t ends[CELL_GRIDS][BUCKETS];   /* of the buckets */
    size_t unique[CELL_GRIDS][BUCKETS]; /* cells */
    uint64_t path_count;
};

static const struct light_deposits *list_of(const struct sorting *s, int thread,
                                            uint32_t grid)
{
    return &s->cells->lists[CELL_GRIDS * thread + (int)grid];
}

/* Divides the deposits of a grid into buckets. */
static void divide_grid(void *context, uint32_t grid, int worker)
{
    struct sorting *s = context;
    size_t next[BUCKETS] = {0}, sum = 0;

    (void)worker;
    for (int i = 0; i < s->cells->thread_count; i++)
        for (size_t k = 0; k < list_of(s, i, grid)->count; k++)
            next[bucket_of(list_of(s, i, grid)->items[k].key, grid)]++;
    for (int i = 0; i < BUCKETS; i++) {
        sum += next[i];
        s->ends[grid][i] = sum;
        next[i] = sum - next[i];
    }
    for (int i = 0; i < s->cells->thread_count; i++) {
        const struct light_deposits *from = list_of(s, i, grid);

        for (size_t k = 0; k < from->count; k++) {
            uint32_t bucket = bucket_of(from->items[k].key, grid);

            s->grids[grid].items[next[bucket]++] = from->items[k];
        }
    }
    s->grids[grid].count = sum;
}

static void sort_bucket(void *context, uint32_t item, int worker)
{
    struct sorting *s = context;
    uint32_t grid = item / BUCKETS, bucket = item % BUCKETS;
    size_t begin = bucket > 0 ? s->ends[grid][bucket - 1] : 0;
    size_t count = s->ends[grid][bucket] - begin;
    struct light_deposit *items = s->grids[grid].items + begin;

    (void)worker;
    if (count > 1)
        qsort(items, count, sizeof *items, compare);
    for (uint32_t level = 0; level < level_count(grid); level++)
        for (size_t i = 0; i < count; i++)
            s->unique[grid][bucket] +=
                i == 0 || key_at(items[i].key, grid, level) !=
                              key_at(items[i - 1].key, grid, level);
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
                                  uint32_t grid, uint64_t path_count)
{
    struct light_cell cell = {.d = v3((float)count, 0, 0)};

    if (grid < RADIANCE_GRID)
        cell.d = v3_scale(choose_direction(d, count), (float)count);
    cell.light =
        sum_light(d, count,
                  1 / (double)(grid < RADIANCE_GRID ? path_count : count));
    return cell;
}

static void fill_level(struct sorting *s, uint32_t grid, uint32_t level)
{
    const struct light_deposits *from = &s->grids[grid];
    const struct light_grid *g = &s->cells->grids[grid];
    struct light_cell *slots = s->cells->cells + g->first;

    for (size_t i = 0, end; i < from->count; i = end) {
        uint64_t key = key_at(from->items[i].key, grid, level);
        uint32_t slot = cell_hash(key) & g->mask;

        for (end = i + 1; end < from->count &&
                          key_at(from->items[end].key, grid, level) == key;)
            end++;
        while (slots[slot].key != 0)
            slot = (slot + 1u) & g->mask;
        slots[slot] = sum_cell(from->items + i, end - i, grid, s->path_count);
        slots[slot].key = key;
    }
}

static void fill_grid(void *context, uint32_t grid, int worker)
{
    struct sorting *s = context;

    (void)worker;
    for (uint32_t level = 0; level < level_count(grid); level++)
        fill_level(s, grid, level);
}

/* Gives each grid twice as many slots as it has cells, or more. */
static bool make_slots(struct sorting *s)
{
    struct light_cells *c = s->cells;

    c->slot_count = 0;
    for (int g = 0; g < CELL_GRIDS; g++) {
        uint32_t slots = 2;
        size_t unique = 0;

        for (int i = 0; i < BUCKETS; i++)
            unique += s->unique[g][i];
        while (slots < 2 * unique)
            slots *= 2;
        c->grids[g].first = (uint32_t)c->slot_count;
        c->grids[g].mask = slots - 1;
        c->slot_count += slots;
    }
    free(c->cells);
    c->cells = alloc_array(c->slot_count, sizeof *c->cells);
    return c->cells != NULL;
}

/* Makes room for the deposits of each grid. Returns false if memory is or was
 * out. */
static bool make_room(struct sorting *s)
{
    bool ok = true;

    for (uint32_t g = 0; g < CELL_GRIDS; g++) {
        size_t count = 0;

        for (int i = 0; i < s->cells->thread_count; i++) {
            count += list_of(s, i, g)->count;
            ok = ok && !list_of(s, i, g)->is_cut;
        }
        s->grids[g].items = alloc_array(count, sizeof *s->grids[g].items);
        ok = ok && s->grids[g].items != NULL;
    }
    return ok;
}

bool light_cells_end(struct light_cells *c, uint64_t path_count,
                     struct pool *pool, const struct cancel *cancel)
{
    struct sorting s = {.cells = c, .path_count = path_count};
    bool ok = make_room(&s);

    if (ok) {
        pool_each(pool, CELL_GRIDS, divide_grid, &s);
        ok = pool_run(pool, CELL_GRIDS * BUCKETS, sort_bucket, &s, cancel) &&
             make_slots(&s);
    }
    if (ok)
        pool_each(pool, CELL_GRIDS, fill_grid, &s);
    for (int g = 0; g < CELL_GRIDS; g++)
        free(s.grids[g].items);
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
