// SPDX-License-Identifier: MIT
#include "world/light/photons.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/color.h"
#include "world/bvh/bvh8_traverse.h"
#include "world/light/triangle_cdf.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/rng.h"

/* Dimensions and key of photons, so that their random numbers are not shared
 * with pixel samples. */
#define PHOTON_DIMENSION 0x10000u
#define PHOTON_STRIDE    2u
#define PHOTON_KEY       0x6a09e667u

/* Least probability of either way at smooth glass, so that there are enough
 * photons of faint caustics, which make specks too. */
#define CHANCE_MIN 0.25f

/* Largest number of vertices of a photon. It ends there even within glass. */
#define PHOTON_VERTICES 12u

/* Places on casters where the light of lamps is compared, and what it counts
 * beside their power, which is right for lamps that reach none of the places. A
 * spot's power is small, but all of it may be on a caster: chosen by power
 * alone, it has a few photons of much flux. On a gold ball under a point and a
 * spot that leaves ten times the error. */
#define PLACES      32u
#define PLACES_SIDE 3.0

/* Least squared distance of a point on a light and one on a caster. The flux,
 * which is inversely proportional to it, stays finite. */
#define DISTANCE2_MIN 1e-30f

struct search {
    const struct bvh8_world *w;
    struct triangle_cdf lights;  /* triangles; point, then directional lights */
    struct triangle_cdf casters; /* by area */
    double power;                /* of the lights */
    float *lamp_powers;          /* by the probabilities of lamps */
    enum photon_source source;
    double box;  /* surface area of the box around the scene */
    float reach; /* a distance at which rays begin outside of it */
    struct landing *landings;
    uint32_t landings_each;
};

struct photon {
    struct ray ray;
    float flux;
    float radiance;
    bool needs_rough; /* it is of no use if the next surface is smooth */
    uint32_t chain;
    uint32_t aim; /* triangle of the caster, which it has to hit first */
    uint32_t number;
    bool is_of_lamp;
};

bool photons_cast(const struct material *m)
{
    return m->alpha < GUIDE_ALPHA_MAX &&
           (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS ||
            m->kind == MATERIAL_METAL ||
            (m->kind == MATERIAL_PRINCIPLED &&
             m->metalness + m->transmission >= 0.5f));
}

struct material photons_material(struct material m)
{
    float grey = photons_cast(&m) ? 1.0f : 0.5f;

    m.color = m.specular = v3(grey, grey, grey);
    m.color_texture = m.specular_texture = NO_INDEX;
    return m;
}

/* Least roughness of casters that send light of this kind to paths. A point or
 * a single direction is found by light samples only, which smooth surfaces do
 * not take. */
static float least_alpha(const struct world *w, enum photon_source source)
{
    const struct settings *s = &w->settings;
    bool has_size = s->sphere_count > 0;

    if (source == PHOTONS_OF_TRIANGLES)
        return s->light_count > 0 ? 0.0f : INFINITY;
    for (uint32_t i = 0; i < s->directional_light_count && !has_size; i++)
        has_size = w->directional_lights[i].size > 0.0f;
    if (has_size)
        return 0.0f;
    return s->point_light_count + s->directional_light_count > 0 ? ALPHA_SMOOTH
                                                                 : INFINITY;
}

static bool casts(const struct material *m, float alpha)
{
    return photons_cast(m) && m->alpha >= alpha;
}

bool photons_need_rough(const struct world *w, enum photon_source source)
{
    return least_alpha(w, source) >= ALPHA_SMOOTH;
}

/* Looks through the triangles only if there is a material that casts. */
bool photons_possible(const struct world *w, enum photon_source source)
{
    float alpha = least_alpha(w, source);
    bool may = false, found = false;

    for (uint32_t i = 0; i < w->settings.material_count && !may; i++)
        may = casts(&w->materials[i], alpha);
    for (uint32_t i = 0; may && i < plain_tri_count(w) && !found; i++)
        found = casts(&w->materials[w->tris[i].material], alpha);
    for (uint32_t i = 0; may && i < w->settings.instance_count && !found; i++)
        found = casts(&w->materials[w->instances[i].material], alpha);
    return found;
}

/* Power of a surface that gives the box of the scene as much light as a disc:
 * a convex body shows a quarter of its surface to a direction, on average. */
static double disc_power(const struct search *s, uint32_t i)
{
    return (double)s->w->world.directional_lights[i].power * s->box /
           (8 * M_PI);
}

static struct vec2 photon_2d(uint32_t photon, uint32_t vertex, uint32_t kind)
{
    struct sampler s = {PHOTON_KEY, reverse_bits(photon), 0};

    return random_2d(s, PHOTON_DIMENSION + PHOTON_STRIDE * vertex + kind);
}

static void add_triangles(struct search *s, const struct lights *lights)
{
    for (uint32_t i = 0; i < lights->light_count; i++)
        for (int k = 0; k < 2; k++)
            if (lights->lights[i].tris[k] != NO_INDEX)
                triangle_cdf_add(&s->lights, lights->lights[i].tris[k],
                                 lights->powers[i][k]);
    s->power = triangle_cdf_total(&s->lights);
}

static bool is_delta_lamp(const struct world *w, uint32_t lamp)
{
    uint32_t points = w->settings.point_light_count;

    return lamp < points ? lamp >= w->settings.sphere_count
                         : !(w->directional_lights[lamp - points].size > 0.0f);
}

static double lamp_power(const struct search *s, uint32_t lamp)
{
    const struct world *w = &s->w->world;
    uint32_t points = w->settings.point_light_count;

    return lamp < points ? point_light_power(w, &w->point_lights[lamp])
                         : disc_power(s, lamp - points);
}

/* Mean irradiance by a lamp at casters that face it. */
static double lamp_irradiance(const struct search *s, uint32_t lamp,
                              const struct vec3 places[PLACES])
{
    const struct world *w = &s->w->world;
    uint32_t points = w->settings.point_light_count;
    double sum = 0;

    if (lamp >= points)
        return (double)w->directional_lights[lamp - points].power;
    for (uint32_t i = 0; i < PLACES; i++) {
        struct light_sample l;

        if (point_light_sample(w, lamp, places[i], v2(0.5f, 0.5f), &l))
            sum += color_mean(l.radiance) / (double)l.pdf;
    }
    return sum / PLACES;
}

/* Adds a lamp by its parts of the power and of the light that casters get. */
static void add_lamp(struct search *s, uint32_t lamp, double irradiance,
                     double sum)
{
    bool is_seen = sum > 0;
    double weight = lamp_power(s, lamp) / s->power +
                    (is_seen ? PLACES_SIDE * (irradiance / sum) : 0);

    triangle_cdf_add(&s->lights, lamp, weight);
    s->lamp_powers[lamp] =
        (float)(s->power * (weight / (is_seen ? 1 + PLACES_SIDE : 1)));
}

/* Adds lamps; points and single directions only if casters are rough. */
static bool add_lamps(struct search *s, bool are_rough)
{
    const struct world *w = &s->w->world;
    uint32_t count =
        w->settings.point_light_count + w->settings.directional_light_count;
    double *irradiances = alloc_array(count, sizeof *irradiances), sum = 0;
    struct vec3 places[PLACES];
    bool ok;

    s->lamp_powers = alloc_array(count, sizeof *s->lamp_powers);
    ok = irradiances != NULL && s->lamp_powers != NULL;
    for (uint32_t i = 0; i < PLACES; i++)
        places[i] =
            tri_point(w,
                      triangle_cdf_choose(
                          &s->casters, photon_2d(i, PHOTON_VERTICES + 1, 0).x),
                      photon_2d(i, PHOTON_VERTICES + 1, 1));
    for (uint32_t i = 0; ok && i < count; i++)
        if (are_rough || !is_delta_lamp(w, i)) {
            irradiances[i] = lamp_irradiance(s, i, places);
            sum += irradiances[i];
            s->power += lamp_power(s, i);
        }
    for (uint32_t i = 0; ok && i < count && s->power > 0; i++)
        if (are_rough || !is_delta_lamp(w, i))
            add_lamp(s, i, irradiances[i], sum);
    free(irradiances);
    return ok;
}

static bool find_lists(struct search *s, const struct lights *lights)
{
    const struct world *w = &s->w->world;
    uint32_t lamps =
        w->settings.point_light_count + w->settings.directional_light_count;
    float alpha = least_alpha(w, s->source);
    bool are_rough = false;

    if (!triangle_cdf_init(&s->lights, s->source == PHOTONS_OF_LAMPS
                                           ? lamps
                                           : 2 * w->settings.light_count) ||
        !triangle_cdf_init(&s->casters, listed_tri_count(w)))
        return false;
    for (uint32_t i = 0; i < listed_tri_count(w); i++) {
        const struct material *m = &w->materials[tri_material_number(w, i)];

        if (!casts(m, alpha))
            continue;
        triangle_cdf_add(&s->casters, i, tri_area(w, i));
        are_rough = are_rough || m->alpha >= ALPHA_SMOOTH;
    }
    if (!(triangle_cdf_total(&s->casters) > 0))
        return true;
    if (s->source == PHOTONS_OF_LAMPS)
        return add_lamps(s, are_rough);
    add_triangles(s, lights);
    return true;
}

/* Aims a photon of a triangle from a uniform point on it. Like the functions
 * below, it sets the flux to the irradiance of a caster that faces the light,
 * and returns the density by which the flux has to be divided, or 0. */
static float leave_triangle(const struct world *w, uint32_t light,
                            struct vec3 to, struct vec2 u, struct photon *p)
{
    struct vec3 n = tri_placed(w, light).t.ng, a[3], from, error, d;
    float square;

    tri_corners(w, light, a);
    from = hit_point_inset(triangle_point(u), a[0], a[1], a[2], &error);
    d = v3_sub(to, from);
    square = v3_dot(d, d);
    if (!(square > DISTANCE2_MIN))
        return 0.0f;
    p->ray.d = v3_unit(d);
    p->flux = v3_dot(n, p->ray.d);
    p->ray.o = offset_ray_origin(from, error, p->flux > 0.0f ? n : v3_neg(n));
    p->ray.from = light + 1;
    p->radiance = 0.0f;
    return square;
}

/* Aims a photon of a point, or of a sphere from a point that is uniform in the
 * cone in which the caster sees it. */
static float leave_point(const struct search *s, uint32_t i, struct vec3 to,
                         struct vec2 u, struct photon *p)
{
    struct light_sample l;

    if (!point_light_sample(&s->w->world, i, to, u, &l))
        return 0.0f;
    p->ray.o = l.p;
    p->ray.d = v3_neg(l.wi);
    p->ray.from = 0;
    p->flux = (float)color_mean(l.radiance);
    p->radiance = p->flux;
    return l.pdf * s->lamp_powers[i];
}

/* Aims a photon of a disc or a single direction from outside of the scene. */
static float leave_disc(const struct search *s, uint32_t i, struct vec3 to,
                        struct vec2 u, struct photon *p)
{
    const struct world *w = &s->w->world;
    const struct directional_light *l =
        &w->directional_lights[i - w->settings.point_light_count];
    struct vec3 wi = cone_around(l->d, l->size, u);

    p->ray.o = v3_add(to, v3_scale(wi, s->reach));
    p->ray.d = v3_neg(wi);
    p->ray.from = 0;
    p->flux = l->power;
    p->radiance = (float)color_mean(l->emission);
    return s->lamp_powers[i];
}

static float leave_light(const struct search *s, uint32_t light, struct vec3 to,
                         struct vec2 u, struct photon *p)
{
    const struct world *w = &s->w->world;

    p->needs_rough = s->source == PHOTONS_OF_LAMPS && is_delta_lamp(w, light);
    if (s->source == PHOTONS_OF_TRIANGLES)
        return leave_triangle(w, light, to, u, p);
    return light < w->settings.point_light_count
               ? leave_point(s, light, to, u, p)
               : leave_disc(s, light, to, u, p);
}

/* Samples a point on a light and a uniform one on a caster. Those factors of
 * the photon's flux are left out that are the same for all photons. Returns
 * false if the caster is not visible from there: solid glass has to be hit from
 * outside. */
static bool photon_open(const struct search *s, uint32_t i, struct photon *p)
{
    const struct world *w = &s->w->world;
    struct vec2 choice = photon_2d(i, 0, 0);
    uint32_t light = triangle_cdf_choose(&s->lights, choice.x);
    struct vec3 to;
    float cosine, density;

    p->number = i;
    p->is_of_lamp = s->source == PHOTONS_OF_LAMPS;
    p->aim = triangle_cdf_choose(&s->casters, choice.y);
    p->ray.key = hash_u32(i);
    p->chain = light;
    to = tri_point(w, p->aim, photon_2d(i, 1, 0));
    density = leave_light(s, light, to, photon_2d(i, 1, 1), p);
    if (!(density > 0.0f))
        return false;
    cosine = v3_dot(tri_placed(w, p->aim).t.ng, p->ray.d);
    p->flux = fabsf(p->flux * cosine) / density;
    return !(cosine > 0.0f &&
             w->materials[tri_material_number(w, p->aim)].kind ==
                 MATERIAL_GLASS);
}

/* Reflectance of smooth glass, or 0 for other surfaces. */
static float reflectance_at(const struct bsdf *b, struct vec3 wo)
{
    float cos_t, f;

    if ((b->kind != MATERIAL_GLASS && b->kind != MATERIAL_THIN_GLASS) ||
        !bsdf_is_delta(b) || has_film(b) || glass_is_index_matched(b))
        return 0.0f;
    f = fresnel_dielectric(wo.z, b->eta, &cos_t);
    return b->kind == MATERIAL_THIN_GLASS ? thin_reflectance(f) : f;
}

/* Chooses between reflection and refraction with a probability of at least
 * CHANCE_MIN, and weights the flux so that its mean stays the same. Returns
 * the number in [0, 1) by which the glass makes the same choice. */
static float photon_choose(struct photon *p, float reflectance, float u)
{
    float chance = f_min(f_max(reflectance, CHANCE_MIN), 1.0f - CHANCE_MIN);

    if (!(reflectance > 0.0f && reflectance < 1.0f))
        return u;
    if (u < chance) {
        p->flux *= reflectance / chance;
        p->radiance *= reflectance;
        return u / chance * reflectance;
    }
    p->flux *= (1.0f - reflectance) / (1.0f - chance);
    p->radiance *= 1.0f - reflectance;
    return reflectance + (u - chance) / (1.0f - chance) * (1.0f - reflectance);
}

/* Scatters the photon at a surface, which is vertex `vertex` of its path.
 * Russian roulette keeps its flux. Returns false if the photon is absorbed. */
static bool photon_scatter(struct photon *p, const struct bsdf *b,
                           const struct surface_point *v, uint32_t material,
                           uint32_t vertex)
{
    struct vec3 wo = surface_to_local(v, v3_neg(p->ray.d));
    struct vec2 choice = photon_2d(p->number, vertex + 1, 1);
    struct bsdf_sample s;
    struct vec3 wi;

    if (p->is_of_lamp)
        choice.x = photon_choose(p, reflectance_at(b, wo), choice.x);
    if (!surface_scatter(v, b, wo, photon_2d(p->number, vertex + 1, 0),
                         choice.x, &s, &wi) ||
        !(choice.y < v3_max_component(s.weight)) ||
        (s.is_delta && p->needs_rough))
        return false;
    surface_spawn_ray(v, wi, s.wi.z, &p->ray);
    p->chain = hash_u32(p->chain ^ (2 * material + (s.wi.z < 0.0f)));
    if (!s.is_delta) {
        p->radiance = 0.0f;
        p->needs_rough = false;
    }
    return true;
}

static void photon_follow(const struct search *s, struct photon p)
{
    const struct world *w = &s->w->world;
    struct landing *landings =
        &s->landings[(size_t)p.number * s->landings_each];
    uint32_t landed = 0;

    for (uint32_t vertex = 1; vertex <= PHOTON_VERTICES; vertex++) {
        struct material m;
        struct surface_point v = {0}; /* gcc 12 warns without */
        struct vec3 from = p.ray.o;
        uint32_t material;
        struct bsdf b;
        struct hit h;

        p.ray.t_max = FLOAT_MAX;
        if (!hit_closest(w, p.ray, &h) || (vertex == 1 && h.tri != p.aim))
            return;
        material = tri_material_number(w, h.tri);
        m = photons_material(w->materials[material]);
        if (!surface_at(w, &m, p.ray, h, &v))
            return;
        b = bsdf_at(w, &m, &v);
        if (guide_helps(&b)) {
            landings[landed++] =
                (struct landing){v.p,     v.ng,       v3_neg(p.ray.d), from,
                                 p.chain, p.radiance, p.flux};
            if (landed == s->landings_each)
                return;
        }
        if (!photon_scatter(&p, &b, &v, material, vertex))
            return;
    }
}

static void photon_send(void *context, uint32_t i, int worker)
{
    const struct search *s = context;
    struct photon p;

    (void)worker;
    if (photon_open(s, i, &p))
        photon_follow(s, p);
}

bool photons_trace(const struct bvh8_world *w, const struct lights *lights,
                   const struct photon_plan *plan, struct pool *pool,
                   struct photons *photons)
{
    struct search s = {.w = w,
                       .source = plan->source,
                       .box = plan->box,
                       .reach = beyond_scene(&w->world),
                       .landings_each = plan->landings_each};
    bool ok = find_lists(&s, lights);

    *photons =
        (struct photons){.landing_count = plan->count * plan->landings_each};
    photons->landings =
        alloc_array(photons->landing_count, sizeof *photons->landings);
    s.landings = photons->landings;
    ok = ok && s.landings != NULL;
    if (ok && triangle_cdf_total(&s.lights) > 0 &&
        triangle_cdf_total(&s.casters) > 0) {
        photons->power = s.power;
        photons->caster_area = triangle_cdf_total(&s.casters);
        pool_each(pool, plan->count, photon_send, &s);
    }
    free(s.lamp_powers);
    triangle_cdf_free(&s.lights);
    triangle_cdf_free(&s.casters);
    return ok;
}

void photons_free(struct photons *photons)
{
    free(photons->landings);
    *photons = (struct photons){.landings = NULL};
}
