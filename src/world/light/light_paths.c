// SPDX-License-Identifier: MIT
#include "world/light/light_paths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "world/bvh/ray_queries.h"
#include "kernels/medium.h"
#include "kernels/camera.h"
#include "kernels/dispersion.h"
#include "kernels/light.h"
#include "kernels/path_state.h"
#include "kernels/rng.h"

/* Key and dimensions of light paths. */
#define LIGHT_PATH_KEY       0x3c6ef372u
#define LIGHT_PATH_DIMENSION 0x20000u

enum {
    NUMBER_CHOICE, /* of the lamp and the triangle that casts */
    NUMBER_LAMP,   /* the point on the lamp */
    NUMBER_CASTER,
    NUMBER_SPOT, /* of the sky */
    NUMBER_WAVELENGTH,
    NUMBER_VERTEX = NUMBER_WAVELENGTH, /* plus STRIDE times a vertex, from 1 */
    NUMBER_STRIDE = 3,
    NUMBER_LOBE = 1, /* and roulette */
    NUMBER_LENS = 2
};

/* Largest number of vertices of a light path. */
#define VERTICES_MAX 64u

/* Places on casters where the light of lamps is compared. */
#define PLACES 32u

/* Least squared distance of a point on a lamp and one that casts. */
#define DISTANCE2_MIN 1e-30f

enum source_kind {
    SOURCE_TRIANGLE,
    SOURCE_POINT,
    SOURCE_DIRECTIONAL,
    SOURCE_SKY
};

/* ---- tables ---- */

static struct vec2 number_2d(struct sampler s, uint32_t number)
{
    return random_2d(s, LIGHT_PATH_DIMENSION + number);
}

static uint32_t lamp_count(const struct world *w)
{
    return w->settings.point_light_count + w->settings.directional_light_count;
}

/* Irradiance of a place that faces the source, about. */
static double irradiance_at(const struct world *w, const struct light_source *s,
                            double power, struct vec3 place)
{
    struct light_sample l;
    struct vec3 d;

    if (s->kind == SOURCE_DIRECTIONAL || s->kind == SOURCE_SKY)
        return power;
    if (s->kind == SOURCE_POINT)
        return point_light_sample(w, s->number, place, v2(0.5f, 0.5f), &l)
                   ? color_mean(l.radiance) / (double)l.pdf
                   : 0;
    d = v3_sub(tri_point(w, s->number, v2(0.5f, 0.5f)), place);
    return power *
           fabs((double)v3_dot(tri_placed(w, s->number).t.ng, v3_unit(d))) /
           fmax((double)v3_dot(d, d), 1e-12);
}

struct building {
    const struct world *w;
    struct light_source *sources;
    double *powers;
    uint32_t count;
};

static void add_source(struct building *b, enum source_kind kind,
                       uint32_t number, double power)
{
    b->powers[b->count] = power;
    b->sources[b->count++] = (struct light_source){number, kind, 0.0f};
}

/* Lists the lamps. Lights from infinity have their irradiance as the power. */
static void add_sources(struct building *b, const struct lights *lights,
                        const struct sky_spots *spots)
{
    const struct world *w = b->w;

    for (uint32_t i = 0; i < lights->light_count; i++)
        for (int k = 0; k < 2; k++)
            if (lights->lights[i].tris[k] != NO_INDEX)
                add_source(b, SOURCE_TRIANGLE, lights->lights[i].tris[k],
                           lights->powers[i][k]);
    for (uint32_t i = 0; i < w->settings.point_light_count; i++)
        add_source(b, SOURCE_POINT, i,
                   point_light_power(w, &w->point_lights[i]));
    for (uint32_t i = 0; i < w->settings.directional_light_count; i++)
        add_source(b, SOURCE_DIRECTIONAL, i,
                   (double)w->directional_lights[i].power);
    if (spots->power > 0)
        add_source(b, SOURCE_SKY, 0, spots->power);
}

/* Sets the probabilities: half by the power, half by the light that surfaces
 * get that cast, so that no lamp starves. */
static bool choose_by(struct light_paths *p, struct building *b)
{
    const struct sampler s = {LIGHT_PATH_KEY, 0};
    double *irradiances = alloc_array(b->count, sizeof *irradiances);
    double power = 0, sum = 0;

    if (irradiances == NULL)
        return false;
    for (uint32_t k = 0; k < PLACES; k++) {
        struct sampler at = {s.key, reverse_bits(k)};
        struct vec3 place =
            casters_choose(&p->casters, b->w, (double)number_2d(at, 0).x,
                           number_2d(at, 1))
                .p;

        for (uint32_t i = 0; i < b->count; i++)
            irradiances[i] +=
                irradiance_at(b->w, &b->sources[i], b->powers[i], place);
    }
    for (uint32_t i = 0; i < b->count; i++) {
        power += b->powers[i];
        sum += irradiances[i];
    }
    for (uint32_t i = 0; i < b->count; i++) {
        double by_power = power > 0 ? b->powers[i] / power : 0;
        double by_light = sum > 0 ? irradiances[i] / sum : by_power;
        double weight = 0.5 * (by_power + by_light);

        b->sources[i].probability = (float)weight;
        triangle_cdf_add(&p->choice, i, weight);
    }
    free(irradiances);
    return true;
}

bool light_paths_build(struct light_paths *p, const struct world *w,
                       const struct lights *lights, double sky_mean)
{
    uint32_t count = 2 * w->settings.light_count + lamp_count(w);
    struct building b = {.w = w};
    bool ok;

    *p = (struct light_paths){.reach = beyond_scene(w),
                              .spots = {.level = INFINITY}};
    if (!casters_build(&p->casters, w))
        return false;
    if (!(triangle_cdf_total(&p->casters.list) > 0))
        return true;
    if (!sky_spots_build(&p->spots, w, sky_mean))
        return false;
    count += p->spots.power > 0;
    if (count == 0)
        return true;
    b.sources = p->sources = alloc_array(count, sizeof *p->sources);
    b.powers = alloc_array(count, sizeof *b.powers);
    ok = b.sources != NULL && b.powers != NULL &&
         triangle_cdf_init(&p->choice, count);
    if (ok) {
        add_sources(&b, lights, &p->spots);
        ok = choose_by(p, &b);
    }
    free(b.powers);
    if (!ok)
        light_paths_free(p);
    return ok;
}

void light_paths_free(struct light_paths *p)
{
    free(p->sources);
    triangle_cdf_free(&p->choice);
    casters_free(&p->casters);
    sky_spots_free(&p->spots);
    *p = (struct light_paths){.sources = NULL};
}

/* ---- images ---- */

bool light_image_init(struct light_image *image, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;

    *image = (struct light_image){.width = width, .height = height};
    for (int h = 0; h < 2; h++)
        image->sums[h] = alloc_array(pixels, 3 * sizeof(struct sum));
    for (int i = 0; i < LIGHT_LOCKS; i++)
        pthread_mutex_init(&image->locks[i], NULL);
    return image->sums[0] != NULL && image->sums[1] != NULL;
}

void light_image_clear(struct light_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;

    for (int h = 0; h < 2; h++)
        memset(image->sums[h], 0, 3 * pixels * sizeof(struct sum));
    atomic_init(&image->rays, 0);
}

void light_image_free(struct light_image *image)
{
    for (int i = 0; image->sums[0] != NULL && i < LIGHT_LOCKS; i++)
        pthread_mutex_destroy(&image->locks[i]);
    free(image->sums[0]);
    free(image->sums[1]);
    *image = (struct light_image){.width = 0};
}

static bool has_pixel(const struct light_image *image, int x, int y)
{
    return x >= image->x0 && y >= image->y0 && x - image->x0 < image->width &&
           y - image->y0 < image->height;
}

/* Adds light to a pixel that the image has. Light that no sum accepts is left
 * out. */
static void add_light(struct light_image *image, int half, int x, int y,
                      struct vec3 light)
{
    size_t row = (size_t)(y - image->y0);
    struct sum *to = image->sums[half] +
                     3 * (row * (size_t)image->width + (size_t)(x - image->x0));

    if (!sum_accepts(light.x) || !sum_accepts(light.y) || !sum_accepts(light.z))
        return;
    pthread_mutex_lock(&image->locks[row % LIGHT_LOCKS]);
    sum_join(&to[0], sum_of(light.x));
    sum_join(&to[1], sum_of(light.y));
    sum_join(&to[2], sum_of(light.z));
    pthread_mutex_unlock(&image->locks[row % LIGHT_LOCKS]);
}

void light_image_means(const struct light_image *image, uint64_t count,
                       float *means)
{
    size_t numbers = 3 * (size_t)image->width * (size_t)image->height;

    for (int h = 0; h < 2; h++)
        for (size_t i = 0; i < numbers; i++)
            *means++ = sum_float(image->sums[h][i]) / (float)count;
}

/* ---- the way from the lamp ---- */

struct light_path {
    struct ray ray;
    struct sampler sampler;
    uint32_t number; /* among those that are traced */
    uint32_t rays;   /* number of rays that were traced for it */
    int half, worker;
    struct vec3 flux; /* over the density of the path so far */
    struct media media;
    float wavelength; /* in nanometres; 0: none yet */
    uint32_t aim;     /* triangle that it has to hit first */
};

/* Sets the ray from a lamp to a point, and the flux to the irradiance of a face
 * that looks at the lamp. Returns false if there is none. */
static bool leave_triangle(const struct world *w, uint32_t tri, struct vec3 to,
                           struct vec2 u, struct light_path *p)
{
    struct hit h = triangle_point(u);
    struct placed_tri t = tri_placed(w, tri);
    struct material m = w->materials[tri_material_number(w, tri)];
    struct vec3 error, from, d;
    struct surface_point v;
    struct ray r = {.t_max = FLOAT_MAX};
    float square, cosine;

    h.tri = tri;
    from = hit_point_inset(h, t.p[0], t.p[1], t.p[2], &error);
    d = v3_sub(to, from);
    square = v3_dot(d, d);
    if (!(square > DISTANCE2_MIN))
        return false;
    p->ray.d = v3_unit(d);
    cosine = v3_dot(t.t.ng, p->ray.d);
    p->ray.o =
        offset_ray_origin(from, error, cosine > 0.0f ? t.t.ng : v3_neg(t.t.ng));
    p->ray.from = tri + 1;
    r.d = v3_neg(p->ray.d);
    if (!surface_at(w, &m, r, h, &v))
        return false;
    p->flux = v3_scale(emission_at(w, &m, &v),
                       fabsf(cosine) * (float)tri_area(w, tri) / square);
    if (has_coverage(w))
        p->flux = v3_scale(p->flux, coverage_at(w, h));
    return true;
}

static bool leave_point(const struct world *w, uint32_t i, struct vec3 to,
                        struct vec2 u, struct light_path *p)
{
    struct light_sample l;

    if (!point_light_sample(w, i, to, u, &l) || !(l.pdf > 0.0f))
        return false;
    p->ray.o = l.p;
    p->ray.d = v3_neg(l.wi);
    p->ray.from = 0;
    p->flux = v3_scale(l.radiance, 1.0f / l.pdf);
    return true;
}

static bool leave_directional(const struct light_paths *paths,
                              const struct world *w, uint32_t i, struct vec3 to,
                              struct vec2 u, struct light_path *p)
{
    const struct directional_light *l = &w->directional_lights[i];
    struct vec3 wi = l->size > 0.0f ? cone_around(l->d, l->size, u) : l->d;

    p->ray.o = v3_add(to, v3_scale(wi, paths->reach));
    p->ray.d = v3_neg(wi);
    p->ray.from = 0;
    p->flux =
        v3_scale(l->emission, l->size > 0.0f ? 1.0f / cone_pdf(l->size) : 1.0f);
    return true;
}

static bool leave_sky(const struct light_paths *paths, const struct world *w,
                      float choice, struct vec3 to, struct vec2 u,
                      struct light_path *p)
{
    struct vec3 wi;

    p->flux = sky_spots_sample(&paths->spots, w, choice, u, &wi);
    p->ray.o = v3_add(to, v3_scale(wi, paths->reach));
    p->ray.d = v3_neg(wi);
    p->ray.from = 0;
    return true;
}

/* Begins a path: chooses a lamp, from which it goes to a point that casts.
 * Returns false if the lamp gives that no light. */
static bool path_leave(const struct light_paths *paths, const struct world *w,
                       struct caster_point to, struct light_path *p)
{
    struct vec2 choice = number_2d(p->sampler, NUMBER_CHOICE);
    struct vec2 u = number_2d(p->sampler, NUMBER_LAMP);
    const struct light_source *s =
        &paths->sources[triangle_cdf_choose(&paths->choice, choice.x)];
    float cosine;
    bool ok;

    p->aim = to.tri;
    if (s->kind == SOURCE_TRIANGLE)
        ok = leave_triangle(w, s->number, to.p, u, p);
    else if (s->kind == SOURCE_POINT)
        ok = leave_point(w, s->number, to.p, u, p);
    else if (s->kind == SOURCE_SKY)
        ok = leave_sky(paths, w, number_2d(p->sampler, NUMBER_SPOT).x, to.p, u,
                       p);
    else
        ok = leave_directional(paths, w, s->number, to.p, u, p);
    if (!ok || (s->kind == SOURCE_TRIANGLE && s->number == p->aim))
        return false;
    cosine = fabsf(v3_dot(tri_placed(w, p->aim).t.ng, p->ray.d));
    p->flux = v3_scale(p->flux, cosine * to.area / s->probability);
    p->media.count = 0;
    return v3_max_component(p->flux) > 0.0f;
}

/* ---- the aim ---- */

/* Key and number of the paths that find the light of each cluster. */
#define AIM_KEY   0x1f83d9abu
#define AIM_PATHS 16u

struct aiming {
    const struct light_paths *paths;
    const struct world *w;
    double *light; /* of each cluster */
};

static void find_light(void *context, uint32_t cluster, int worker)
{
    const struct aiming *a = context;
    const struct world *w = a->w;

    (void)worker;
    for (uint32_t i = 0; i < AIM_PATHS; i++) {
        struct light_path p = {.ray.t_max = FLOAT_MAX};
        struct caster_point to;
        struct hit h;

        p.sampler.key = hash_u32(AIM_KEY + cluster);
        p.sampler.reversed_index = reverse_bits(i);
        to = casters_choose_in(&a->paths->casters, w, cluster,
                               (double)number_2d(p.sampler, NUMBER_CHOICE).y,
                               number_2d(p.sampler, NUMBER_CASTER));
        if (path_leave(a->paths, w, to, &p) && hit_closest(w, p.ray, &h) &&
            h.tri == p.aim)
            a->light[cluster] += color_mean(p.flux) / AIM_PATHS;
    }
}

void light_paths_aim(struct light_paths *paths, const struct world *w,
                     struct pool *pool)
{
    struct casters *c = &paths->casters;
    struct aiming a = {paths, w,
                       alloc_array(c->cluster_count, sizeof *a.light)};

    if (a.light != NULL && triangle_cdf_total(&paths->choice) > 0) {
        pool_each(pool, c->cluster_count, find_light, &a);
        casters_weigh(c, a.light);
    }
    free(a.light);
}

/* ---- the way to the eye ---- */

/* A place on the film as a point of the scene sees it. */
struct lens_view {
    struct vec3 eye; /* the point of the lens */
    float x, y;      /* in pixels of the picture */
    float factor;    /* radiance of a pixel by that of a surface whose area is
                        projected and divided by the distance squared */
};

/* Finds where the camera sees a point through a point of its lens. */
static bool see(const struct camera *c, struct vec3 point, struct vec2 u,
                struct lens_view *view)
{
    float across = v3_dot(c->right, c->right), up = v3_dot(c->up, c->up);
    float depth, focus = c->lens_radius > 0.0f ? c->focus : 1.0f, cosine;
    struct vec3 d, at;

    view->eye = c->eye;
    if (c->lens_radius > 0.0f) {
        struct vec2 turn = cos_sin_turns(u.y);
        float radius = c->lens_radius * sqrtf(u.x);

        view->eye =
            v3_add(c->eye,
                   v3_add(v3_scale(c->right, radius * turn.x / sqrtf(across)),
                          v3_scale(c->up, radius * turn.y / sqrtf(up))));
    }
    d = v3_sub(point, view->eye);
    depth = v3_dot(d, c->forward);
    if (!(depth > 0.0f))
        return false;
    at = v3_sub(v3_add(view->eye, v3_scale(d, focus / depth)), c->eye);
    view->x =
        0.5f * (v3_dot(at, c->right) / (across * focus) + 1.0f) * c->width -
        c->left;
    view->y =
        0.5f * (1.0f - v3_dot(at, c->up) / (up * focus)) * c->height - c->top;
    cosine = depth / v3_length(d);
    view->factor = c->width * c->height /
                   (4.0f * sqrtf(across * up) * cosine * cosine * cosine);
    return view->x >= 0.0f && view->y >= 0.0f && view->x < 0x1p30f &&
           view->y < 0x1p30f;
}

struct tracing {
    const struct light_paths *paths;
    const struct world *w;
    uint64_t first;
    uint32_t count;
    struct light_film film;
};

/* The BSDF at a vertex, at the path's wavelength. */
static struct bsdf vertex_bsdf(const struct world *w,
                               const struct light_path *p,
                               const struct material *m,
                               const struct surface_point *v)
{
    struct bsdf b = bsdf_at(w, m, v);

    if (m->dispersion > 0.0f)
        bsdf_disperse(m, v, p->wavelength, &b);
    return b;
}

/* Connects a vertex to the eye. The surface is that which the eye sees. */
static void connect(const struct tracing *t, struct light_path *p,
                    const struct material *m, struct hit h, uint32_t vertex)
{
    const struct world *w = t->w;
    struct placed_tri tri = tri_placed(w, h.tri);
    struct vec3 l = v3_neg(p->ray.d), error, wo, wi, f;
    struct vec3 point = hit_point(h, tri.p[0], tri.p[1], tri.p[2], &error);
    struct lens_view view;
    struct surface_point v;
    struct ray r = {.t_max = FLOAT_MAX};
    struct bsdf b;
    struct medium medium;
    float pdf, square;

    if (!see(&w->settings.camera, point,
             number_2d(p->sampler,
                       NUMBER_VERTEX + NUMBER_STRIDE * vertex + NUMBER_LENS),
             &view) ||
        !has_pixel(t->film.image, (int)view.x, (int)view.y))
        return;
    r.o = view.eye;
    r.d = v3_unit(v3_sub(point, view.eye));
    if (!surface_at(w, m, r, h, &v))
        return;
    b = vertex_bsdf(w, p, m, &v);
    wo = surface_to_local(&v, v3_neg(r.d));
    wi = surface_to_local(&v, l);
    if (!surface_sides_agree(&v, l, wi.z))
        return;
    f = bsdf_terms(&b, wo, wi, &pdf);
    if (v3_is_zero(f))
        return;
    square = v3_dot(v3_sub(point, view.eye), v3_sub(point, view.eye));
    f = v3_scale(f, bsdf_eta_scale(&b, wi) * fabsf(v3_dot(r.d, v.ng)) *
                        view.factor / (fabsf(v3_dot(l, v.ng)) * square));
    medium = medium_of(w, &p->media);
    f = v3_mul(f, attenuated(p->flux, &medium, r, sqrtf(square)));
    r.o = surface_ray_origin(&v, wo.z);
    r.d = v3_sub(view.eye, r.o);
    r.t_max = 1.0f;
    r.from = v.face;
    if (has_coverage(w))
        r.key = ray_key(p->sampler, LIGHT_PATH_DIMENSION + vertex);
    p->rays++;
    if (!hit_any(w, r, NO_INDEX))
        add_light(t->film.image, p->half, (int)view.x, (int)view.y, f);
}

/* Weighs a direction that was sampled with a density: by the BSDF as paths from
 * the eye have it, which come the other way. */
static struct vec3 weight_of(const struct world *w, const struct light_path *p,
                             const struct material *m, struct hit h,
                             struct vec3 out, float density)
{
    struct ray r = {.d = v3_neg(out), .t_max = FLOAT_MAX};
    struct surface_point v;
    struct vec3 l = v3_neg(p->ray.d), wi, none = v3(0.0f, 0.0f, 0.0f);
    struct bsdf b;
    float pdf;

    if (!surface_at(w, m, r, h, &v))
        return none;
    b = vertex_bsdf(w, p, m, &v);
    wi = surface_to_local(&v, l);
    if (!surface_sides_agree(&v, l, wi.z))
        return none;
    return v3_scale(bsdf_terms(&b, surface_to_local(&v, out), wi, &pdf),
                    bsdf_eta_scale(&b, wi) * fabsf(v3_dot(out, v.ng)) /
                        (fabsf(v3_dot(l, v.ng)) * density));
}

/* Scatters a path at a surface. Roulette keeps its flux. Returns false if it
 * ends. */
static bool scatter(const struct world *w, struct light_path *p,
                    uint32_t material, const struct surface_point *v,
                    struct hit h, uint32_t vertex)
{
    const struct material *m = &w->materials[material];
    uint32_t first = NUMBER_VERTEX + NUMBER_STRIDE * vertex;
    struct vec2 choice = number_2d(p->sampler, first + NUMBER_LOBE);
    struct bsdf b = vertex_bsdf(w, p, m, v);
    struct vec3 l = v3_neg(p->ray.d), wo = surface_to_local(v, l), wi, weight;
    struct surface_point face;
    struct bsdf_sample s;
    float q;

    if (bsdf_is_black(&b))
        return false;
    if (!surface_scatter(v, &b, wo, number_2d(p->sampler, first), choice.x, &s,
                         &wi)) {
        face = surface_of_face(*v); /* as path_scatter() */
        if (!bsdf_is_delta(&b) ||
            !surface_scatter(&face, &b, surface_to_local(&face, l),
                             number_2d(p->sampler, first), choice.x, &s, &wi))
            return false;
        v = &face;
    }
    weight = s.is_delta ? v3_scale(s.weight,
                                   fabsf((v3_dot(wi, v->ng) * v3_dot(l, v->n)) /
                                         (v3_dot(wi, v->n) * v3_dot(l, v->ng))))
                        : weight_of(w, p, m, h, wi, s.pdf);
    q = f_min(v3_max_component(weight), 1.0f);
    if (!(choice.y < q))
        return false;
    p->flux = v3_scale(v3_mul(p->flux, weight), 1.0f / q);
    surface_spawn_ray(v, wi, s.wi.z, &p->ray);
    media_follow(&p->media, material, &b, v, s.wi.z);
    return true;
}

/* Puts light into the cell of a vertex. */
static void deposit(const struct tracing *t, const struct light_path *p,
                    const struct surface_point *v, uint32_t vertex)
{
    float by_normals = v3_dot(p->ray.d, v->n) / v3_dot(p->ray.d, v->ng);
    const struct light_deposit d = {.path = p->number,
                                    .vertex = vertex,
                                    .light = v3_scale(p->flux, by_normals),
                                    .d = v3_neg(p->ray.d)};

    light_cells_add(t->film.cells, p->worker, p->half, v->p, v->ng, &d);
}

static void follow(const struct tracing *t, struct light_path *p)
{
    const struct world *w = t->w;
    uint32_t last = w->settings.max_vertices - 1;

    for (uint32_t vertex = 1; vertex <= VERTICES_MAX && vertex <= last;
         vertex++) {
        struct material m;
        struct surface_point v = {0};
        struct medium medium;
        uint32_t material;
        struct hit h;

        p->rays++;
        p->ray.t_max = FLOAT_MAX;
        if (has_coverage(w))
            p->ray.key = ray_key(p->sampler, vertex);
        if (!hit_closest(w, p->ray, &h) || (vertex == 1 && h.tri != p->aim))
            return;
        material = tri_material_number(w, h.tri);
        m = w->materials[material];
        if (!surface_at(w, &m, p->ray, h, &v))
            return;
        if (vertex == 1 && !v.is_outside) /* the lamp is in the body */
            media_enter(&p->media, material);
        medium = medium_of(w, &p->media);
        p->flux = attenuated(p->flux, &medium, p->ray, h.t);
        if (m.dispersion > 0.0f && p->wavelength == 0.0f)
            p->wavelength =
                wavelength_draw(&p->flux,
                                number_2d(p->sampler, NUMBER_WAVELENGTH).x);
        if (m.role == ROLE_MATTE) {
            connect(t, p, &m, h, vertex);
            if (t->film.cells != NULL)
                deposit(t, p, &v, vertex);
        }
        if (!scatter(w, p, material, &v, h, vertex))
            return;
    }
}

/* Paths of each half that a thread traces at a time: a cancel waits for them.
 */
#define BLOCK 16u

static void trace_block(void *context, uint32_t item, int worker)
{
    const struct tracing *t = context;
    const struct world *w = t->w;
    uint32_t begin = item * BLOCK;
    uint32_t end = t->count - begin < BLOCK ? t->count : begin + BLOCK;
    uint64_t rays = 0;

    for (uint32_t i = begin; i < end; i++)
        for (int half = 0; half < 2; half++) {
            uint64_t number = t->first + i;
            struct light_path p = {.number = i, .half = half, .worker = worker};
            struct caster_point to;

            p.sampler.key = hash_u32(w->settings.seed + LIGHT_PATH_KEY);
            p.sampler.key = hash_u32(p.sampler.key ^ (uint32_t)half);
            p.sampler.key = hash_u32(p.sampler.key ^ (uint32_t)(number >> 32));
            p.sampler.reversed_index = reverse_bits((uint32_t)number);
            to = casters_choose(&t->paths->casters, w,
                                (double)number_2d(p.sampler, NUMBER_CHOICE).y,
                                number_2d(p.sampler, NUMBER_CASTER));
            if (path_leave(t->paths, w, to, &p))
                follow(t, &p);
            rays += p.rays;
        }
    atomic_fetch_add_explicit(&t->film.image->rays, rays, memory_order_relaxed);
}

bool light_paths_trace(const struct light_paths *paths, const struct world *w,
                       uint64_t first, uint32_t count, struct pool *pool,
                       const struct cancel *cancel, struct light_film film)
{
    struct tracing t = {paths, w, first, count, film};

    return !(triangle_cdf_total(&paths->choice) > 0) ||
           pool_run(pool, (count + BLOCK - 1) / BLOCK, trace_block, &t, cancel);
}
