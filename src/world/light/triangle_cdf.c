// SPDX-License-Identifier: MIT
#include "world/light/triangle_cdf.h"

#include <stdlib.h>

#include "base/memory.h"
#include "kernels/instance.h"
#include "kernels/light.h"

/* Triangles that are measured as one. */
#define BLOCK_TRIS 16384u

/* A list of so many takes 50 MB and half a second. */
#define LISTED_MAX (1u << 22)

bool triangle_cdf_init(struct triangle_cdf *l, uint32_t capacity)
{
    l->count = 0;
    l->tris = alloc_array(capacity, sizeof *l->tris);
    l->sums = alloc_array(capacity, sizeof *l->sums);
    return l->tris != NULL && l->sums != NULL;
}

double triangle_cdf_total(const struct triangle_cdf *l)
{
    return l->count > 0 ? l->sums[l->count - 1] : 0;
}

void triangle_cdf_add(struct triangle_cdf *l, uint32_t tri, double weight)
{
    double total = triangle_cdf_total(l);

    l->tris[l->count] = tri;
    l->sums[l->count++] = total + weight;
}

uint32_t triangle_cdf_index(const struct triangle_cdf *l, double sum)
{
    uint32_t low = 0, high = l->count - 1;

    while (low < high) {
        uint32_t middle = (low + high) / 2;

        if (l->sums[middle] <= sum)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

uint32_t triangle_cdf_choose(const struct triangle_cdf *l, float u)
{
    return l->tris[triangle_cdf_index(l, (double)u * triangle_cdf_total(l))];
}

void triangle_cdf_free(struct triangle_cdf *l)
{
    free(l->tris);
    free(l->sums);
    *l = (struct triangle_cdf){.tris = NULL};
}

uint32_t listed_tri_count(const struct world *w)
{
    uint32_t all = all_tri_count(w);

    return has_instances(w) && all > LISTED_MAX ? LISTED_MAX : all;
}

bool all_are_listed(const struct world *w)
{
    return listed_tri_count(w) == all_tri_count(w);
}

void tri_corners(const struct world *w, uint32_t tri, struct vec3 p[3])
{
    uint32_t instance = instance_of(w, tri);
    struct tri t = tri_at(w, tri, instance);

    for (uint32_t k = 0; k < 3; k++)
        p[k] = position_at(w, t.v[k], instance);
}

double tri_area(const struct world *w, uint32_t tri)
{
    struct vec3 p[3];

    tri_corners(w, tri, p);
    return 0.5 *
           (double)v3_length(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])));
}

struct vec3 tri_point(const struct world *w, uint32_t tri, struct vec2 u)
{
    struct vec3 p[3], error;

    tri_corners(w, tri, p);
    return hit_point(triangle_point(u), p[0], p[1], p[2], &error);
}

uint32_t tri_material_number(const struct world *w, uint32_t tri)
{
    return tri_material(w, tri, instance_of(w, tri));
}

float beyond_scene(const struct world *w)
{
    float most = has_instances(w) ? 1.7320508f : 0.0f;

    for (uint32_t i = 0; !has_instances(w) && i < w->settings.position_count;
         i++)
        most = f_max(most, v3_length(w->positions[i]));
    return 4.0f * most;
}

/* ---- the areas ---- */

struct areas {
    const struct world *world;
    struct triangle_cdf *list;
};

static void measure_block(void *context, uint32_t block, int worker)
{
    const struct areas *a = context;
    uint32_t begin = block * BLOCK_TRIS, left = a->list->count - begin;
    uint32_t end = begin + (left < BLOCK_TRIS ? left : BLOCK_TRIS);

    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        a->list->tris[i] = i;
        a->list->sums[i] = tri_area(a->world, i);
    }
}

bool triangle_cdf_of_areas(struct triangle_cdf *l, const struct world *w,
                           struct pool *pool)
{
    struct areas areas = {w, l};
    uint32_t count = listed_tri_count(w);

    if (!triangle_cdf_init(l, count))
        return false;
    l->count = count;
    pool_each(pool, count / BLOCK_TRIS + (count % BLOCK_TRIS > 0),
              measure_block, &areas);
    for (uint32_t i = 1; i < count; i++)
        l->sums[i] += l->sums[i - 1];
    return true;
}
