// SPDX-License-Identifier: MIT
#include "inspect/path_record.h"

#include "world/bvh/ray_queries.h"

#include "kernels/path.h"

/* Length of a ray that hits nothing: out of the scene, whose extent is below
 * 2. */
#define SKY_DISTANCE 4.0f

static struct vec3 end_of(const struct world *w, struct ray r, struct hit h)
{
    struct placed_tri t;
    struct vec3 error;

    if (h.tri == NO_INDEX)
        return v3_add(r.o, v3_scale(r.d, SKY_DISTANCE));
    t = tri_placed(w, h.tri);
    return hit_point(h, t.p[0], t.p[1], t.p[2], &error);
}

static bool is_same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Tells on which side of the face the path continues. */
static enum path_record_way side_of(const struct world *w, struct hit h,
                                    struct vec3 before, struct vec3 after)
{
    struct vec3 ng = tri_placed(w, h.tri).t.ng;

    return v3_dot(before, ng) * v3_dot(after, ng) < 0.0f
               ? PATH_RECORD_REFLECTED
               : PATH_RECORD_TRANSMITTED;
}

/* True if the path goes on, or is ended by roulette, at a place on the way of
 * its ray, *place. */
static bool collides(const struct path *before, const struct path *after,
                     struct hit h, bool goes_on, struct vec3 *place)
{
    float reach = before->below.reach;

    if (before->below.steps > 0) {
        *place = v3_add(before->ray.o, v3_scale(before->ray.d, reach));
        return path_collides_below(before, &h);
    }
    *place = after->ray.o;
    return after->from.is_free && (goes_on ? after->vertex > before->vertex
                                           : !is_same(before->ray.o, *place));
}

/* A path between the steps of a sample. */
struct follower {
    const struct world *world;
    struct path path;
    struct hit hit; /* of its ray */
    bool goes_on;
};

/* Tells what has ended a path at a surface with this BSDF, which it has left
 * with another ray only where roulette has ended it. */
static enum path_record_way end_of_path(const struct follower *f,
                                        const struct path *before,
                                        const struct bsdf *b)
{
    const struct settings *s = &f->world->settings;

    if (!is_same(before->ray.o, f->path.ray.o))
        return PATH_RECORD_ROULETTE;
    if (f->path.out.cut != 0 || before->vertex >= s->max_vertices)
        return PATH_RECORD_LIMIT;
    /* the path has not come to the choice of a light */
    return s->has_radiance_cells != 0 && before->below.steps == 0 &&
                   !bsdf_is_black(b) && is_same(before->from.p, f->path.from.p)
               ? PATH_RECORD_CELL
               : PATH_RECORD_ENDED;
}

/* h: without a triangle in the sky and at a collision. */
static enum path_record_way way_of(const struct follower *f,
                                   const struct path *before, struct hit h,
                                   const struct bsdf *b, bool is_collision)
{
    if (is_collision && f->goes_on)
        return PATH_RECORD_SCATTERED;
    if (is_collision)
        return f->path.out.cut != 0 ? PATH_RECORD_LIMIT : PATH_RECORD_ROULETTE;
    if (h.tri == NO_INDEX)
        return PATH_RECORD_SKY;
    if (f->goes_on)
        return side_of(f->world, h, before->ray.d, f->path.ray.d);
    return end_of_path(f, before, b);
}

/* Adds what the step's surface is to it, and returns its BSDF. */
static struct bsdf meet(const struct world *w, const struct path *before,
                        struct path_record_step *step)
{
    struct bsdf black = {.kind = MATERIAL_DIFFUSE};
    struct surface_point v;
    struct material m;

    if (step->hit.tri == NO_INDEX)
        return black;
    m = w->materials[tri_material(w, step->hit.tri,
                                  instance_of(w, step->hit.tri))];
    if (!surface_at(w, &m, before->ray, step->hit, &v))
        return black;
    black = bsdf_at(w, &m, &v);
    step->n = v.n;
    step->is_boundary = m.is_boundary != 0;
    step->is_diffuse = radiance_is_diffuse(&black);
    return black;
}

/* Takes the path on as path_step() does. */
static struct path_record_step follow(struct follower *f)
{
    const struct world *w = f->world;
    struct path before = f->path, *p = &f->path;
    struct path_record_step step = {
        .from = before.ray.o,
        .hit = f->hit,
        .throughput = v3_scale(before.beta, before.scale),
        .is_below = before.below.steps > 0,
        .medium = before.media.count > 0
                      ? before.media.at[before.media.count - 1]
                      : NO_INDEX,
    };
    struct vec3 found;
    struct bsdf b;
    bool is_collision;

    f->goes_on = path_extend(w, p, &f->hit);
    found = path_light(p);
    if (p->light.is_lit)
        path_add_light(w, p);
    if (f->goes_on)
        hit_closest(w, p->ray, &f->hit);
    is_collision = collides(&before, p, step.hit, f->goes_on, &step.to);
    if (is_collision)
        step.hit.tri = NO_INDEX;
    else
        step.to = end_of(w, before.ray, step.hit);
    b = meet(w, &before, &step);
    step.light = v3_sub(path_light(p), path_light(&before));
    step.sampled = v3_sub(path_light(p), found);
    step.way = way_of(f, &before, step.hit, &b, is_collision);
    step.pdf = f->goes_on ? p->pdf : 0.0f;
    step.wavelength = p->wavelength;
    step.enters = !step.is_below && f->goes_on && p->below.steps > 0;
    return step;
}

struct vec3 path_record_each(const struct world *w, struct sample_id id,
                             path_record_visit *visit, void *context)
{
    struct camera_sample start =
        camera_sample_begin(&w->settings, id.x, id.y, id.index);
    struct follower f = {.world = w, .goes_on = true};

    path_set_key(w, start.sampler, 1, &start.ray);
    hit_closest(w, start.ray, &f.hit);
    path_open(w, &f.path, start, NULL);
    while (f.goes_on) {
        struct path_record_step step = follow(&f);

        visit(context, &step);
    }
    return path_light(&f.path);
}

static void record(void *context, const struct path_record_step *step)
{
    struct path_record *t = context;

    t->vertices++;
    if (t->count < PATH_RECORD_STEPS)
        t->steps[t->count++] = *step;
}

void path_record_follow(struct path_record *t, const struct world *w,
                        uint32_t x, uint32_t y, uint64_t index)
{
    t->count = t->vertices = 0;
    t->radiance =
        path_record_each(w, (struct sample_id){x, y, index}, record, t);
}

static void add_lobe(struct path_record_lobes *l, const struct bsdf *b,
                     const struct surface_point *v, struct vec3 wo,
                     struct sampler s)
{
    struct bsdf_sample sample;

    if (!bsdf_sample(b, wo,
                     random_2d(s, DIMENSION_BOUNCE + DIMENSION_BSDF_DIRECTION),
                     random_2d(s, DIMENSION_BOUNCE + DIMENSION_BSDF_LOBE).x,
                     &sample))
        return;
    l->wi[l->count] = surface_to_world(v, sample.wi);
    l->weight[l->count] = sample.weight;
    l->pdf[l->count] = sample.pdf;
    l->count++;
}

bool path_record_scatter(struct path_record_lobes *l, const struct world *w,
                         uint32_t x, uint32_t y)
{
    struct ray r = camera_ray(w->settings.camera, x, y, v2(0.5f, 0.5f));
    struct material m;
    struct surface_point v;
    struct bsdf b;
    struct hit h;

    *l = (struct path_record_lobes){0};
    if (!hit_closest(w, r, &h))
        return false;
    m = w->materials[tri_material(w, h.tri, instance_of(w, h.tri))];
    if (!surface_at(w, &m, r, h, &v))
        return false;
    b = bsdf_at(w, &m, &v);
    l->p = v.p;
    l->n = v.n;
    l->t = v.t;
    l->b = v.b;
    l->wo = v3_neg(r.d);
    l->distance = h.t;
    l->tri = h.tri;
    for (uint32_t i = 0; i < PATH_RECORD_LOBES; i++)
        add_lobe(l, &b, &v, surface_to_local(&v, l->wo),
                 sampler_start_half(x, y, i, w->settings.seed));
    return true;
}
