// SPDX-License-Identifier: MIT
#include "world/light/casters.h"

#include <stdlib.h>

#include "base/memory.h"
#include "kernels/instance.h"
#include "kernels/light.h"

/* Cells of clusters along each side of the box around the casters, and octants
 * of normals. */
#define CELLS        4u
#define CLUSTERS_MAX (8u * CELLS * CELLS * CELLS)

/* Least light of a cluster by the mean of all. */
#define LIGHT_MIN 0.2

/* ---- the list ---- */

static bool casts(const struct world *w, uint32_t tri)
{
    return w->materials[tri_material_number(w, tri)].role == ROLE_CASTS;
}

static bool has_casters(const struct world *w)
{
    bool may = false, found = false;

    if (!all_are_listed(w))
        return false;
    for (uint32_t i = 0; i < w->settings.material_count && !may; i++)
        may = w->materials[i].role == ROLE_CASTS;
    for (uint32_t i = 0; may && i < plain_tri_count(w) && !found; i++)
        found = w->materials[w->tris[i].material].role == ROLE_CASTS;
    for (uint32_t i = 0; may && i < w->settings.instance_count && !found; i++)
        found = w->materials[w->instances[i].material].role == ROLE_CASTS;
    return found;
}

/* A box around the casters. */
struct extent {
    struct vec3 lo, hi;
};

static struct extent extent_of(const struct world *w)
{
    struct extent e = {v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX),
                       v3(-FLOAT_MAX, -FLOAT_MAX, -FLOAT_MAX)};
    struct vec3 p[3];

    for (uint32_t i = 0; i < listed_tri_count(w); i++) {
        if (!casts(w, i))
            continue;
        tri_corners(w, i, p);
        for (int k = 0; k < 3; k++) {
            e.lo = v3_min(e.lo, p[k]);
            e.hi = v3_max(e.hi, p[k]);
        }
    }
    return e;
}

static uint32_t cell_of(float x, float lo, float hi)
{
    float at = (float)CELLS * (x - lo) / (hi - lo);

    return at > 0.0f ? (uint32_t)f_min(at, (float)(CELLS - 1)) : 0u;
}

static uint32_t cluster_of(const struct world *w, const struct extent *e,
                           uint32_t tri)
{
    struct vec3 p[3], n, c;

    tri_corners(w, tri, p);
    n = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    c = v3_scale(v3_add(p[0], v3_add(p[1], p[2])), 1.0f / 3.0f);
    return (n.x > 0.0f ? 1u : 0u) + (n.y > 0.0f ? 2u : 0u) +
           (n.z > 0.0f ? 4u : 0u) +
           8u * (cell_of(c.x, e->lo.x, e->hi.x) +
                 CELLS * (cell_of(c.y, e->lo.y, e->hi.y) +
                          CELLS * cell_of(c.z, e->lo.z, e->hi.z)));
}

/* Sorts the triangles that cast by their clusters, which are counted. */
static bool sort(struct casters *c, const struct world *w,
                 const struct extent *e)
{
    uint32_t next[CLUSTERS_MAX] = {0}, sum = 0;
    struct triangle_cdf *l = &c->list;
    uint32_t *tris;

    for (uint32_t i = 0; i < listed_tri_count(w); i++)
        if (casts(w, i))
            next[cluster_of(w, e, i)]++;
    for (uint32_t i = 0; i < CLUSTERS_MAX; i++) {
        sum += next[i];
        if (next[i] > 0)
            c->ends[c->cluster_count++] = sum;
        next[i] = sum - next[i];
    }
    tris = alloc_array(sum, sizeof *tris);
    if (tris == NULL || !triangle_cdf_init(l, sum)) {
        free(tris);
        return false;
    }
    for (uint32_t i = 0; i < listed_tri_count(w); i++)
        if (casts(w, i))
            tris[next[cluster_of(w, e, i)]++] = i;
    for (uint32_t i = 0; i < sum; i++)
        triangle_cdf_add(l, tris[i], tri_area(w, tris[i]));
    free(tris);
    return true;
}

bool casters_build(struct casters *c, const struct world *w)
{
    struct extent e;

    *c = (struct casters){.cluster_count = 0};
    if (!has_casters(w))
        return true;
    c->ends = alloc_array(CLUSTERS_MAX, sizeof *c->ends);
    if (c->ends == NULL)
        return false;
    e = extent_of(w);
    return sort(c, w, &e);
}

void casters_free(struct casters *c)
{
    triangle_cdf_free(&c->list);
    free(c->ends);
    *c = (struct casters){.cluster_count = 0};
}

/* ---- weights and samples ---- */

static double weight_before(const struct casters *c, uint32_t i)
{
    return i > 0 ? c->list.sums[i - 1] : 0;
}

static uint32_t cluster_begin(const struct casters *c, uint32_t cluster)
{
    return cluster > 0 ? c->ends[cluster - 1] : 0;
}

/* Samples a point of the triangle at which the weights have this sum. */
static struct caster_point choose_at(const struct casters *c,
                                     const struct world *w, double sum,
                                     struct vec2 u)
{
    uint32_t i = triangle_cdf_index(&c->list, sum), tri = c->list.tris[i];
    double weight = c->list.sums[i] - weight_before(c, i);
    double area = triangle_cdf_total(&c->list) * tri_area(w, tri);

    return (struct caster_point){tri_point(w, tri, u), tri,
                                 weight > 0 ? (float)(area / weight) : 0.0f};
}

struct caster_point casters_choose(const struct casters *c,
                                   const struct world *w, double choice,
                                   struct vec2 u)
{
    return choose_at(c, w, choice * triangle_cdf_total(&c->list), u);
}

struct caster_point casters_choose_in(const struct casters *c,
                                      const struct world *w, uint32_t cluster,
                                      double choice, struct vec2 u)
{
    double begin = weight_before(c, cluster_begin(c, cluster));
    double end = weight_before(c, c->ends[cluster]);

    return choose_at(c, w, begin + choice * (end - begin), u);
}

void casters_weigh(struct casters *c, const double *light)
{
    double sum = 0, least = 0, before = 0;

    for (uint32_t i = 0; i < c->cluster_count; i++)
        sum += light[i] * (weight_before(c, c->ends[i]) -
                           weight_before(c, cluster_begin(c, i)));
    if (!(sum > 0 && sum <= FLOAT_MAX))
        return;
    least = LIGHT_MIN * sum / triangle_cdf_total(&c->list);
    sum = 0;
    for (uint32_t i = 0; i < c->cluster_count; i++)
        for (uint32_t k = cluster_begin(c, i); k < c->ends[i]; k++) {
            double area = c->list.sums[k] - before;

            before = c->list.sums[k];
            sum += area * (light[i] + least);
            c->list.sums[k] = sum;
        }
}
