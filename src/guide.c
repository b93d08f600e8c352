// SPDX-License-Identifier: MIT
#include "glim/guide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glim/wide_hit.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/rng.h"

/* Tried; about half of them arrive. On two balls four times as many leave 8 %
 * less error, and the first picture would wait for them. */
#define PHOTONS 16384u

/* Of their random numbers, which no sample of a pixel has. */
#define PHOTON_DIMENSION 0x10000u
#define PHOTON_STRIDE    2u
#define PHOTON_KEY       0x6a09e667u

/* Where a photon ends that is still in glass. */
#define PHOTON_VERTICES 12u

/* Along the longest side of the scene. On two balls 8 to 16 leave the same
 * error within 2 %, and many sums do not stay near. */
#define CELLS_A_SIDE 10

/* How often the table is asked at most, and where it is half as often: where
 * caustics bring this part of what all lights would shed on the box around the
 * scene. Tried on two balls: twice as much leaves 4 % more error. */
#define SHARE_MOST 0.5
#define SHARE_HALF 0.25

/* Cells that are asked less often have no table: half of them on two balls, for
 * 3 % more error and 7 % less time. */
#define SHARE_LEAST 0.05

/* A tree for more would take longer than the first picture. */
#define TRIS_MOST 200000u

/* Triangles, chosen by a weight. */
struct list {
    uint32_t *tris;
    double *sums; /* of the weights up to and with each */
    uint32_t count;
};

struct pass {
    struct wide_world wide;
    struct wide tree;
    struct list lights;  /* by power */
    struct list casters; /* by area */
    struct guide *guide;
    float *flux; /* GUIDE_BINS for each cell of the grid */
};

struct photon {
    struct ray ray;
    float flux;
    uint32_t aim; /* the triangle that it has to meet first */
};

static bool casts(const struct material *m)
{
    return m->alpha < GUIDE_ALPHA_MAX &&
           (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS ||
            m->kind == MATERIAL_METAL);
}

static double mean(struct vec3 color)
{
    return ((double)color.x + (double)color.y + (double)color.z) / 3;
}

static void corners(const struct world *w, uint32_t tri, struct vec3 p[3])
{
    for (uint32_t k = 0; k < 3; k++)
        p[k] = w->positions[w->tris[tri].v[k]];
}

static double area_of(const struct world *w, uint32_t tri)
{
    struct vec3 p[3];

    corners(w, tri, p);
    return 0.5 *
           (double)v3_length(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])));
}

/* ---- what shines, and what casts ---- */

static bool list_init(struct list *l, uint32_t capacity)
{
    l->tris = alloc_array(capacity, sizeof *l->tris);
    l->sums = alloc_array(capacity, sizeof *l->sums);
    return l->tris != NULL && l->sums != NULL;
}

static double list_total(const struct list *l)
{
    return l->count > 0 ? l->sums[l->count - 1] : 0;
}

static void list_add(struct list *l, uint32_t tri, double weight)
{
    double total = list_total(l);

    l->tris[l->count] = tri;
    l->sums[l->count++] = total + weight;
}

/* For u in [0, 1). */
static uint32_t list_choose(const struct list *l, float u)
{
    double sum = (double)u * list_total(l);
    uint32_t low = 0, high = l->count - 1;

    while (low < high) {
        uint32_t middle = (low + high) / 2;

        if (l->sums[middle] <= sum)
            low = middle + 1;
        else
            high = middle;
    }
    return l->tris[low];
}

static void list_free(struct list *l)
{
    free(l->tris);
    free(l->sums);
}

static bool find_lists(struct pass *p)
{
    const struct world *w = &p->wide.world;

    if (!list_init(&p->lights, w->settings.light_count) ||
        !list_init(&p->casters, w->settings.tri_count))
        return false;
    for (uint32_t i = 0; i < w->settings.light_count; i++) {
        uint32_t tri = w->lights[i].tri;

        list_add(&p->lights, tri,
                 area_of(w, tri) *
                     mean(w->materials[w->tris[tri].material].emission));
    }
    for (uint32_t i = 0; i < w->settings.tri_count; i++)
        if (casts(&w->materials[w->tris[i].material]))
            list_add(&p->casters, i, area_of(w, i));
    return true;
}

/* ---- the grid ---- */

static uint32_t cell_count(const struct guide_grid *g)
{
    return g->width * g->height * g->depth;
}

static uint32_t cells_along(float length, const struct guide_grid *g)
{
    return (uint32_t)f_max(ceilf(length * g->cells_a_unit), 1.0f);
}

/* Around all triangles; returns the surface of the box. */
static double make_grid(const struct world *w, struct guide_grid *g)
{
    struct vec3 lo = w->positions[w->tris[0].v[0]], hi = lo, size;

    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct vec3 p[3];

        corners(w, i, p);
        for (int k = 0; k < 3; k++) {
            lo = v3(f_min(lo.x, p[k].x), f_min(lo.y, p[k].y),
                    f_min(lo.z, p[k].z));
            hi = v3(f_max(hi.x, p[k].x), f_max(hi.y, p[k].y),
                    f_max(hi.z, p[k].z));
        }
    }
    size = v3_sub(hi, lo);
    g->lo = lo;
    g->cells_a_unit = CELLS_A_SIDE / f_max(size.x, f_max(size.y, size.z));
    g->width = cells_along(size.x, g);
    g->height = cells_along(size.y, g);
    g->depth = cells_along(size.z, g);
    return 2.0 * (double)(size.x * size.y + size.y * size.z + size.z * size.x);
}

/* ---- photons ---- */

static struct vec2 photon_2d(uint32_t photon, uint32_t vertex, uint32_t kind)
{
    struct sampler s = {PHOTON_KEY, reverse_bits(photon)};

    return random_2d(s, PHOTON_DIMENSION + PHOTON_STRIDE * vertex + kind);
}

/* From a light to something that casts: uniform points on both make a flux per
 * photon of radiance, cosines and areas over distance^2. False if the face is
 * turned away. */
static bool photon_open(const struct pass *pass, uint32_t i, struct photon *p)
{
    const struct world *w = &pass->wide.world;
    struct vec2 choice = photon_2d(i, 0, 0);
    uint32_t light = list_choose(&pass->lights, choice.x);
    struct vec3 na = w->tris[light].ng;
    struct vec3 nb, a[3], b[3], from, to, error, d;
    float cos_a, cos_b;

    p->aim = list_choose(&pass->casters, choice.y);
    corners(w, light, a);
    corners(w, p->aim, b);
    nb = w->tris[p->aim].ng;
    if (v3_is_zero(na) || v3_is_zero(nb))
        return false;
    to =
        hit_point(triangle_point(photon_2d(i, 1, 0)), b[0], b[1], b[2], &error);
    from = hit_inside(triangle_point(photon_2d(i, 1, 1)), a[0], a[1], a[2],
                      &error);
    d = v3_sub(to, from);
    if (!(v3_dot(d, d) > 0.0f))
        return false;
    p->ray.d = v3_unit(d);
    cos_a = v3_dot(na, p->ray.d);
    cos_b = v3_dot(nb, p->ray.d);
    if (cos_b > 0.0f &&
        w->materials[w->tris[p->aim].material].kind == MATERIAL_GLASS)
        return false;
    p->ray.o = leave_surface(from, error, cos_a > 0.0f ? na : v3_neg(na));
    p->ray.key = hash_u32(i);
    p->ray.from = light + 1;
    p->flux = fabsf(cos_a * cos_b) / v3_dot(d, d);
    return true;
}

static void deposit(struct pass *pass, const struct photon *p, struct vec3 at)
{
    size_t cell = guide_cell(&pass->guide->grid, at);

    pass->flux[cell * GUIDE_BINS + guide_bin(v3_neg(p->ray.d))] += p->flux;
}

/* Sends the photon on from a vertex; roulette keeps the flux as it is. */
static bool photon_scatter(struct photon *p, const struct bsdf *b,
                           const struct vertex *v, uint32_t i, uint32_t vertex)
{
    struct vec3 wo = vertex_to_local(v, v3_neg(p->ray.d));
    struct vec2 choice = photon_2d(i, vertex + 1, 1);
    struct bsdf_sample s;
    struct vec3 wi;

    if (!bsdf_sample(b, wo, photon_2d(i, vertex + 1, 0), choice.x, &s) ||
        !(choice.y < v3_max(s.weight)))
        return false;
    wi = v3_unit(vertex_to_world(v, s.wi));
    if (!vertex_sides_agree(v, wi, s.wi.z))
        return false;
    p->ray.o = vertex_leave(v, s.wi.z);
    p->ray.d = wi;
    p->ray.from = v->face;
    return true;
}

/* Photons see no colours, so that one that is edited leaves the table as it is:
 * what casts is white, the rest grey. */
static struct material without_colors(struct material m)
{
    float grey = casts(&m) ? 1.0f : 0.5f;

    m.color = m.coat = v3(grey, grey, grey);
    m.color_texture = m.coat_texture = NO_INDEX;
    return m;
}

static void photon_follow(struct pass *pass, struct photon p, uint32_t i)
{
    const struct world *w = &pass->wide.world;
    uint32_t landed = 0;

    for (uint32_t vertex = 1; vertex <= PHOTON_VERTICES; vertex++) {
        struct material m;
        struct vertex v;
        struct bsdf b;
        struct hit h;

        p.ray.t_max = FLOAT_MAX;
        if (!hit_closest(w, p.ray, &h) || (vertex == 1 && h.tri != p.aim))
            return;
        m = without_colors(w->materials[w->tris[h.tri].material]);
        if (!vertex_at(w, &m, p.ray, h, &v))
            return;
        b = bsdf_at(w, &m, &v);
        if (guide_helps(&b)) {
            deposit(pass, &p, v.p);
            if (++landed == 2)
                return;
        }
        if (!photon_scatter(&p, &b, &v, i, vertex))
            return;
    }
}

/* ---- sums ---- */

static double total_of(const float *flux)
{
    double total = 0;

    for (uint32_t i = 0; i < GUIDE_BINS; i++)
        total += (double)flux[i];
    return total;
}

/* How often a cell's table is asked; `half` is the flux where that is half as
 * often as can be. */
static double share_of(double total, double half)
{
    return SHARE_MOST * total / (total + half);
}

static void fill_sums(const float *flux, double total, double share,
                      float *sums)
{
    double sum = 0;

    for (uint32_t i = 0; i < GUIDE_BINS; i++) {
        sum += (double)flux[i];
        sums[i] = (float)(sum / total * share);
    }
}

static bool make_cells(struct pass *p, double half)
{
    struct guide *g = p->guide;
    uint32_t count = cell_count(&g->grid);

    g->cells = alloc_array(count, sizeof *g->cells);
    if (g->cells == NULL)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        double total = total_of(p->flux + (size_t)i * GUIDE_BINS);

        g->cells[i] = share_of(total, half) < SHARE_LEAST
                          ? NO_INDEX
                          : g->grid.cell_count++ * (uint32_t)GUIDE_BINS;
    }
    g->sums =
        alloc_array((size_t)g->grid.cell_count * GUIDE_BINS, sizeof *g->sums);
    if (g->sums == NULL)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (g->cells[i] != NO_INDEX) {
            const float *flux = p->flux + (size_t)i * GUIDE_BINS;
            double total = total_of(flux);

            fill_sums(flux, total, share_of(total, half),
                      g->sums + g->cells[i]);
        }
    return true;
}

/* Photons have no unit of their own: each stands for the lights' power times
 * the casters' area over their number. */
static double half_flux(const struct pass *p, double box)
{
    double cell = 1 / (double)p->guide->grid.cells_a_unit;

    return SHARE_HALF * 2 * M_PI * PHOTONS / list_total(&p->casters) * cell *
           cell / box;
}

static bool run(struct pass *p)
{
    double box = make_grid(&p->wide.world, &p->guide->grid);

    p->flux = alloc_array((size_t)cell_count(&p->guide->grid) * GUIDE_BINS,
                          sizeof *p->flux);
    if (p->flux == NULL)
        return false;
    for (uint32_t i = 0; i < PHOTONS; i++) {
        struct photon photon;

        if (photon_open(p, i, &photon))
            photon_follow(p, photon, i);
    }
    return make_cells(p, half_flux(p, box));
}

bool guide_build(struct guide *guide, const struct world *w, struct error *err)
{
    struct pass p = {.wide = {.world = *w, .tree = &p.tree}, .guide = guide};
    bool ok = true;

    guide_free(guide);
    if (w->settings.light_count == 0 || w->settings.tri_count > TRIS_MOST)
        return true;
    ok = find_lists(&p);
    if (ok && list_total(&p.lights) > 0 && list_total(&p.casters) > 0)
        ok = wide_build(&p.tree, &p.wide.world, NULL, err) && run(&p);
    wide_free(&p.tree);
    list_free(&p.lights);
    list_free(&p.casters);
    free(p.flux);
    if (!ok || guide->grid.cell_count == 0)
        guide_free(guide);
    return ok || fail(err, "out of memory for the table of caustics");
}

bool guides_differ(const struct material *a, const struct material *b)
{
    struct material x = without_colors(*a), y = without_colors(*b);

    return memcmp(&x, &y, sizeof x) != 0;
}

void guide_lend(const struct guide *guide, struct world *world)
{
    world->settings.guide = guide->grid;
    world->guide_cells = guide->cells;
    world->guide_sums = guide->sums;
}

void guide_free(struct guide *guide)
{
    free(guide->cells);
    free(guide->sums);
    memset(guide, 0, sizeof *guide);
}
