// SPDX-License-Identifier: MIT
#include "world/light/light_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "kernels/light_cells.h"
#include "kernels/rng.h"

/* Least width of cells by their distance: coordinates have an end. */
#define WIDTH_MIN 0x1p-15

/* Width of the first light cells of the halves in pixels. */
#define CELL_WIDE   2.4
#define CELL_NARROW 0.6

/* Key of the places of grids. */
#define GRID_KEY 0x5be0cd19u

/* ---- grids ---- */

static float random_float(uint32_t *key)
{
    *key = hash_u32(*key + 1u);
    return unit_float(*key);
}

static struct light_grid random_grid(const struct camera *c, uint32_t key,
                                     double pixels)
{
    double pixel = 2 * (double)v3_length(c->up) / (double)c->height;
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
    g.width = (float)(fmax(4. / 3 * pixels * pixel, WIDTH_MIN) /
                      (double)g.distance_scale);
    return g;
}

bool light_cells_begin(struct light_cells *c, const struct world *w,
                       uint64_t begin, const struct pool *pool)
{
    int thread_count = pool != NULL ? pool_thread_count(pool) : 1;
    double finer = pow(1 + (double)begin / 32, -0.25);
    const double pixels[2] = {CELL_WIDE * finer, CELL_NARROW * finer};
    uint32_t key = hash_u32(w->settings.seed + GRID_KEY);

    if (c->thread_count != thread_count) {
        light_cells_free(c);
        c->lists = alloc_array(2 * (size_t)thread_count, sizeof *c->lists);
        if (c->lists == NULL)
            return false;
        c->thread_count = thread_count;
    }
    key = hash_u32(key ^ (uint32_t)begin) ^ (uint32_t)(begin >> 32);
    for (int h = 0; h < 2; h++)
        c->grids[h] = random_grid(&w->settings.camera,
                                  hash_u32(key ^ (uint32_t)h), pixels[h]);
    for (int i = 0; i < 2 * thread_count; i++) {
        c->lists[i].count = 0;
        c->lists[i].is_cut = false;
    }
    return true;
}

void light_cells_add(struct light_cells *c, int thread, int half, struct vec3 p,
                     struct vec3 ng, const struct light_deposit *deposit)
{
    struct light_deposits *list = &c->lists[2 * thread + half];
    struct light_place at = light_place(&c->grids[half], p, ng);

    if (at.key == 0)
        return;
    if (list->count == list->capacity &&
        !grow_array((void **)&list->items, &list->capacity, list->count + 1,
                    sizeof *list->items)) {
        list->is_cut = true;
        return;
    }
    list->items[list->count] = *deposit;
    list->items[list->count++].key = at.key;
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

/* The deposits of a half, sorted. */
struct sorting {
    struct light_cells *cells;
    struct light_deposits halves[2];
    size_t unique[2]; /* cells */
};

static void sort_half(void *context, uint32_t half, int worker)
{
    struct sorting *s = context;
    struct light_deposits *to = &s->halves[half];

    (void)worker;
    for (int i = 0; i < s->cells->thread_count; i++) {
        const struct light_deposits *from = &s->cells->lists[2 * i + (int)half];

        if (from->count > 0)
            memcpy(to->items + to->count, from->items,
                   from->count * sizeof *from->items);
        to->count += from->count;
    }
    qsort(to->items, to->count, sizeof *to->items, compare);
    for (size_t i = 0; i < to->count; i++)
        s->unique[half] += i == 0 || to->items[i].key != to->items[i - 1].key;
}

/* Returns a cell of `count` deposits. */
static struct light_cell sum_cell(const struct light_deposit *d, size_t count,
                                  double scale)
{
    double rgb[3] = {0, 0, 0}, total = 0, choice;
    struct light_cell cell = {.key = d->key};
    size_t i = 0;

    for (size_t k = 0; k < count; k++) {
        rgb[0] += (double)d[k].flux.x;
        rgb[1] += (double)d[k].flux.y;
        rgb[2] += (double)d[k].flux.z;
        total += color_mean(d[k].flux);
    }
    cell.flux = v3((float)(rgb[0] * scale), (float)(rgb[1] * scale),
                   (float)(rgb[2] * scale));
    choice = (double)unit_float(hash_u32(d->path ^ (uint32_t)d->key)) * total;
    while (i + 1 < count && choice >= color_mean(d[i].flux))
        choice -= color_mean(d[i++].flux);
    cell.d = d[i].d;
    return cell;
}

static void fill_half(struct sorting *s, int half, double scale)
{
    const struct light_deposits *from = &s->halves[half];
    const struct light_grid *g = &s->cells->grids[half];
    struct light_cell *slots = s->cells->cells + g->first;

    for (size_t i = 0, end; i < from->count; i = end) {
        uint32_t slot = light_slot(g, from->items[i].key);

        for (end = i + 1;
             end < from->count && from->items[end].key == from->items[i].key;)
            end++;
        while (slots[slot].key != 0)
            slot = (slot + 1u) & g->mask;
        slots[slot] = sum_cell(from->items + i, end - i, scale);
    }
}

/* Gives each grid twice as many slots as it has cells, or more. */
static bool make_slots(struct sorting *s)
{
    struct light_cells *c = s->cells;

    c->slot_count = 0;
    for (int h = 0; h < 2; h++) {
        uint32_t slots = 2;

        while (slots < 2 * s->unique[h])
            slots *= 2;
        c->grids[h].first = (uint32_t)c->slot_count;
        c->grids[h].mask = slots - 1;
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

    for (int h = 0; h < 2; h++) {
        size_t count = 0;

        for (int i = 0; i < c->thread_count; i++) {
            count += c->lists[2 * i + h].count;
            ok = ok && !c->lists[2 * i + h].is_cut;
        }
        s.halves[h].items = alloc_array(count, sizeof *s.halves[h].items);
        ok = ok && s.halves[h].items != NULL;
    }
    if (ok) {
        pool_each(pool, 2, sort_half, &s);
        ok = make_slots(&s);
    }
    for (int h = 0; h < 2; h++) {
        if (ok)
            fill_half(&s, h, 1 / (double)path_count);
        free(s.halves[h].items);
    }
    return ok;
}

void light_cells_free(struct light_cells *c)
{
    for (int i = 0; i < 2 * c->thread_count; i++)
        free(c->lists[i].items);
    free(c->lists);
    free(c->cells);
    *c = (struct light_cells){.cells = NULL};
}
