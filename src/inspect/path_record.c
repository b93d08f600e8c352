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

/* h: without a triangle in the sky and at a collision. */
static enum path_record_way way_of(const struct world *w,
                                   const struct path *before,
                                   const struct path *after, struct hit h,
                                   bool is_collision, bool goes_on)
{
    if (is_collision && goes_on)
        return PATH_RECORD_SCATTERED;
    if (is_collision)
        return after->out.cut != 0 ? PATH_RECORD_ENDED : PATH_RECORD_ROULETTE;
    if (h.tri == NO_INDEX)
        return PATH_RECORD_SKY;
    if (goes_on)
        return side_of(w, h, before->ray.d, after->ray.d);
    return is_same(before->ray.o, after->ray.o) ? PATH_RECORD_ENDED
                                                : PATH_RECORD_ROULETTE;
}

void path_record_follow(struct path_record *t, const struct world *w,
                        uint32_t x, uint32_t y, uint64_t index)
{
    struct camera_sample start = camera_sample_begin(&w->settings, x, y, index);
    bool goes_on = true;
    struct path p;
    struct hit h;

    path_set_key(w, start.sampler, 1, &start.ray);
    hit_closest(w, start.ray, &h);
    path_open(w, &p, start, NULL);
    t->count = t->vertices = 0;
    while (goes_on) {
        struct path before = p;
        struct hit vertex = h;
        struct vec3 to;
        bool is_collision;

        goes_on = path_step(w, &p, &h);
        t->vertices++;
        if (t->count == PATH_RECORD_STEPS)
            continue;
        is_collision = collides(&before, &p, vertex, goes_on, &to);
        if (is_collision)
            vertex.tri = NO_INDEX;
        else
            to = end_of(w, before.ray, vertex);
        t->steps[t->count++] = (struct path_record_step){
            .from = before.ray.o,
            .to = to,
            .hit = vertex,
            .throughput = v3_scale(before.beta, before.scale),
            .light = v3_sub(path_light(&p), path_light(&before)),
            .way = way_of(w, &before, &p, vertex, is_collision, goes_on),
            .pdf = goes_on ? p.pdf : 0.0f,
        };
    }
    t->radiance = path_light(&p);
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
