// SPDX-License-Identifier: MIT
#include "light/caustics.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "light/triangle_cdf.h"
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

/* What caustics bring where they are as much as the rest, as a part of what
 * all lights would shed on the box around the scene. Tried on two balls: twice
 * as much leaves 4 % more error. */
#define REST 0.25

/* Square of the distance below which a light and what casts are one place: the
 * sum of all photons' flux, which is in inverse proportion, stays finite. */
#define DISTANCE2_LEAST 1e-30f

/* Diffuse surfaces on which a photon is counted. */
#define LANDINGS 2u

/* Where a photon has landed: in which of the table's bins, with what flux. */
struct landing {
    size_t bin;
    float flux;
};

struct search {
    const struct bvh8_world *w;
    const struct guide_grid *grid;
    struct triangle_cdf lights;  /* by power */
    struct triangle_cdf casters; /* by area */
    struct landing *landings;    /* LANDINGS of each photon */
};

struct photon {
    struct ray ray;
    float flux;
    uint32_t aim; /* the triangle that it has to meet first */
};

/* Does light that falls on it leave in a few directions? */
static bool casts(const struct material *m)
{
    return m->alpha < GUIDE_ALPHA_MAX &&
           (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS ||
            m->kind == MATERIAL_METAL);
}

struct material caustics_material(struct material m)
{
    float grey = casts(&m) ? 1.0f : 0.5f;

    m.color = m.coat = v3(grey, grey, grey);
    m.color_texture = m.coat_texture = NO_INDEX;
    return m;
}

/* Triangles are many: whether one of them has a material that casts is asked
 * only if there is such a material. */
bool caustics_possible(const struct world *w)
{
    bool may = false, found = false;

    for (uint32_t i = 0; i < w->settings.material_count && !may; i++)
        may = w->settings.light_count > 0 && casts(&w->materials[i]);
    for (uint32_t i = 0; may && i < w->settings.tri_count && !found; i++)
        found = casts(&w->materials[w->tris[i].material]);
    return found;
}

static bool find_lists(struct search *s, const struct lights *lights)
{
    const struct world *w = &s->w->world;

    if (!triangle_cdf_init(&s->lights, 2 * w->settings.light_count) ||
        !triangle_cdf_init(&s->casters, w->settings.tri_count))
        return false;
    for (uint32_t i = 0; i < lights->light_count; i++)
        for (int k = 0; k < 2; k++)
            if (lights->lights[i].tris[k] != NO_INDEX)
                triangle_cdf_add(&s->lights, lights->lights[i].tris[k],
                                 lights->powers[i][k]);
    for (uint32_t i = 0; i < w->settings.tri_count; i++)
        if (casts(&w->materials[w->tris[i].material]))
            triangle_cdf_add(&s->casters, i, tri_area(w, i));
    return true;
}

static struct vec2 photon_2d(uint32_t photon, uint32_t vertex, uint32_t kind)
{
    struct sampler s = {PHOTON_KEY, reverse_bits(photon)};

    return random_2d(s, PHOTON_DIMENSION + PHOTON_STRIDE * vertex + kind);
}

/* From a light to something that casts: uniform points on both make a flux per
 * photon of radiance, cosines and areas over distance^2. False if the face is
 * turned away. */
static bool photon_open(const struct search *s, uint32_t i, struct photon *p)
{
    const struct world *w = &s->w->world;
    struct vec2 choice = photon_2d(i, 0, 0);
    uint32_t light = triangle_cdf_choose(&s->lights, choice.x);
    struct vec3 na = w->tris[light].ng;
    struct vec3 nb, a[3], b[3], from, to, error, d;
    float cos_a, cos_b;

    p->aim = triangle_cdf_choose(&s->casters, choice.y);
    tri_corners(w, light, a);
    tri_corners(w, p->aim, b);
    nb = w->tris[p->aim].ng;
    to =
        hit_point(triangle_point(photon_2d(i, 1, 0)), b[0], b[1], b[2], &error);
    from = hit_point_inset(triangle_point(photon_2d(i, 1, 1)), a[0], a[1], a[2],
                           &error);
    d = v3_sub(to, from);
    if (!(v3_dot(d, d) > DISTANCE2_LEAST))
        return false;
    p->ray.d = v3_unit(d);
    cos_a = v3_dot(na, p->ray.d);
    cos_b = v3_dot(nb, p->ray.d);
    if (cos_b > 0.0f &&
        w->materials[w->tris[p->aim].material].kind == MATERIAL_GLASS)
        return false;
    p->ray.o = offset_ray_origin(from, error, cos_a > 0.0f ? na : v3_neg(na));
    p->ray.key = hash_u32(i);
    p->ray.from = light + 1;
    p->flux = fabsf(cos_a * cos_b) / v3_dot(d, d);
    return true;
}

static struct landing landing_of(const struct search *s, const struct photon *p,
                                 const struct surface_point *v)
{
    size_t cell = guide_cell_index(s->grid, v->p, v->ng);
    struct landing l = {cell * GUIDE_BINS + guide_bin(v3_neg(p->ray.d)),
                        p->flux};

    return l;
}

/* Scatters the photon at a surface. Russian roulette keeps its flux. Returns
 * false if the photon is absorbed. */
static bool photon_scatter(struct photon *p, const struct bsdf *b,
                           const struct surface_point *v, uint32_t i,
                           uint32_t vertex)
{
    struct vec3 wo = surface_to_local(v, v3_neg(p->ray.d));
    struct vec2 choice = photon_2d(i, vertex + 1, 1);
    struct bsdf_sample s;
    struct vec3 wi;

    if (!surface_scatter(v, b, wo, photon_2d(i, vertex + 1, 0), choice.x, &s,
                         &wi) ||
        !(choice.y < v3_max_component(s.weight)))
        return false;
    surface_spawn_ray(v, wi, s.wi.z, &p->ray);
    return true;
}

static void photon_follow(const struct search *s, struct photon p, uint32_t i)
{
    const struct world *w = &s->w->world;
    struct landing *landings = &s->landings[i * LANDINGS];
    uint32_t landed = 0;

    for (uint32_t vertex = 1; vertex <= PHOTON_VERTICES; vertex++) {
        struct material m;
        struct surface_point v;
        struct bsdf b;
        struct hit h;

        p.ray.t_max = FLOAT_MAX;
        if (!hit_closest(w, p.ray, &h) || (vertex == 1 && h.tri != p.aim))
            return;
        m = caustics_material(w->materials[w->tris[h.tri].material]);
        surface_at(w, &m, p.ray, h, &v);
        b = bsdf_at(w, &m, &v);
        if (guide_helps(&b)) {
            landings[landed++] = landing_of(s, &p, &v);
            if (landed == LANDINGS)
                return;
        }
        if (!photon_scatter(&p, &b, &v, i, vertex))
            return;
    }
}

static void photon_send(void *context, uint32_t i, int worker)
{
    const struct search *s = context;
    struct photon p;

    (void)worker;
    if (photon_open(s, i, &p))
        photon_follow(s, p, i);
}

/* Photons have no unit of their own: each stands for the lights' power times
 * the casters' area over their number. */
static void fill_rest(const struct search *s, double box,
                      struct guide_flux *part)
{
    double cell = 1 / (double)s->grid->cells_per_unit;
    double rest = REST * 2 * M_PI * PHOTONS / triangle_cdf_total(&s->casters) *
                  cell * cell / box;

    for (uint32_t i = 0; i < guide_cell_count(s->grid); i++)
        part->rest[i] = (float)rest;
}

bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *part)
{
    struct search s = {.w = w, .grid = grid};
    bool ok = find_lists(&s, lights);

    s.landings = alloc_array((size_t)PHOTONS * LANDINGS, sizeof *s.landings);
    ok = ok && s.landings != NULL;
    if (ok && triangle_cdf_total(&s.lights) > 0 &&
        triangle_cdf_total(&s.casters) > 0) {
        pool_each(pool, PHOTONS, photon_send, &s);
        /* in order, whoever sent them */
        for (uint32_t i = 0; i < PHOTONS * LANDINGS; i++)
            part->flux[s.landings[i].bin] += s.landings[i].flux;
        fill_rest(&s, box, part);
    }
    triangle_cdf_free(&s.lights);
    triangle_cdf_free(&s.casters);
    free(s.landings);
    return ok;
}
