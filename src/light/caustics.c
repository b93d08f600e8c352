// SPDX-License-Identifier: MIT
#include "light/caustics.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "light/triangle_cdf.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/rng.h"

/* Number of photons, of which about half arrive. On two balls four times as
 * many leave 8 % less error, but the first picture has to wait for them. */
#define PHOTONS 16384u

/* Dimensions and key of photons, so that their random numbers are not shared
 * with pixel samples. */
#define PHOTON_DIMENSION 0x10000u
#define PHOTON_STRIDE    2u
#define PHOTON_KEY       0x6a09e667u

/* Largest number of vertices of a photon. It ends there even within glass. */
#define PHOTON_VERTICES 12u

/* Light of other kinds, as a part of the mean irradiance by all lights on the
 * box around the scene. Caustics of this size get half of their share. On two
 * balls twice as much leaves 4 % more error. */
#define REST 0.25

/* Least squared distance of a point on a light and one on a caster. The flux,
 * which is inversely proportional to it, stays finite. */
#define DISTANCE2_LEAST 1e-30f

/* Diffuse surfaces on which a photon is stored. */
#define LANDINGS 2u

/* Flux of a photon at a diffuse surface, and its bin in the tables. */
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
    uint32_t aim; /* triangle of the caster, which it has to hit first */
};

/* Returns true if the material reflects or refracts light into few directions.
 */
static bool casts(const struct material *m)
{
    return m->alpha < GUIDE_ALPHA_MAX &&
           (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS ||
            m->kind == MATERIAL_METAL ||
            (m->kind == MATERIAL_PRINCIPLED &&
             m->metalness + m->transmission >= 0.5f));
}

struct material caustics_material(struct material m)
{
    float grey = casts(&m) ? 1.0f : 0.5f;

    m.color = m.specular = v3(grey, grey, grey);
    m.color_texture = m.specular_texture = NO_INDEX;
    return m;
}

/* Looks through the triangles only if there is a material that casts. */
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

/* Samples uniform points on a light and on a caster. The flux of the photon is
 * radiance, cosines and areas over distance^2, of which those factors are left
 * out that are the same for all photons. Returns false if the caster is not
 * visible from there: solid glass has to be hit from outside. */
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
        if (!surface_at(w, &m, p.ray, h, &v))
            return;
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

/* Sets the light of other kinds in the unit of the photons' flux, in which each
 * stands for the power of the lights times the area of the casters over their
 * number. */
static void fill_rest(const struct search *s, double box,
                      struct guide_flux *caustics)
{
    double cell = 1 / (double)s->grid->cells_per_unit;
    double rest = REST * 2 * M_PI * PHOTONS / triangle_cdf_total(&s->casters) *
                  cell * cell / box;

    for (uint32_t i = 0; i < guide_cell_count(s->grid); i++)
        caustics->rest[i] = (float)rest;
}

bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *caustics)
{
    struct search s = {.w = w, .grid = grid};
    bool ok = find_lists(&s, lights);

    s.landings = alloc_array((size_t)PHOTONS * LANDINGS, sizeof *s.landings);
    ok = ok && s.landings != NULL;
    if (ok && triangle_cdf_total(&s.lights) > 0 &&
        triangle_cdf_total(&s.casters) > 0) {
        pool_each(pool, PHOTONS, photon_send, &s);
        /* in the order of photons, so that threads do not matter */
        for (uint32_t i = 0; i < PHOTONS * LANDINGS; i++)
            caustics->flux[s.landings[i].bin] += s.landings[i].flux;
        fill_rest(&s, box, caustics);
    }
    triangle_cdf_free(&s.lights);
    triangle_cdf_free(&s.casters);
    free(s.landings);
    return ok;
}
