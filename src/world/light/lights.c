// SPDX-License-Identifier: MIT
#include "world/light/lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "world/light/light_tree.h"
#include "world/light/triangle_cdf.h"
#include "kernels/light.h"
#include "kernels/texture.h"

/* ---- power of textured emitters ---- */

/* Largest number of bands of a triangle. */
#define BANDS 64

/* Beyond these coordinates a triangle counts as showing the whole image. */
#define UV_MAX 1e6

/* Reach of a texel into its neighbours by bilinear interpolation. */
#define REACH 0.5

bool texture_power_init(struct texture_power_sums *f, const struct world *w,
                        const struct material *m, struct error *err)
{
    struct texture t = w->textures[m->emission_texture];
    size_t stride = (size_t)t.width + 1;

    f->width = t.width;
    f->height = t.height;
    f->sums = alloc_array(stride * ((size_t)t.height + 1), sizeof *f->sums);
    if (f->sums == NULL)
        return fail(err, "out of memory for the light of a texture of %ux%u",
                    t.width, t.height);
    for (uint32_t y = 0; y < t.height; y++) {
        double *above = f->sums + y * stride;
        double row = 0;

        for (uint32_t x = 0; x < t.width; x++) {
            struct vec3 c = v3_mul(m->emission, texel(w, t, x, y).color);

            row += color_mean(c);
            above[stride + x + 1] = above[x + 1] + row;
        }
    }
    return true;
}

/* The sum over texels 0 to x and 0 to y of the repeating image. */
static double sum_to(const struct texture_power_sums *f, double x, double y)
{
    double columns = floor(x / f->width);
    double rows = floor(y / f->height);
    size_t stride = (size_t)f->width + 1;
    const double *row = f->sums + (size_t)(y - rows * f->height) * stride;
    const double *last = f->sums + f->height * stride;
    size_t column = (size_t)(x - columns * f->width);

    return rows * (columns * last[f->width] + last[column]) +
           columns * row[f->width] + row[column];
}

static double sum_within(const struct texture_power_sums *f, double x0,
                         double x1, double y0, double y1)
{
    return sum_to(f, x1, y1) - sum_to(f, x0, y1) - sum_to(f, x1, y0) +
           sum_to(f, x0, y0);
}

/* Finds the least and the greatest x of the triangle between two rows. Returns
 * false if it has no part there. */
static bool extent(const double p[3][2], double y0, double y1, double *x0,
                   double *x1)
{
    *x0 = INFINITY;
    *x1 = -INFINITY;
    for (int i = 0; i < 3; i++) {
        const double *a = p[i], *b = p[(i + 1) % 3];
        double edges[2] = {y0, y1};

        if (a[1] >= y0 && a[1] <= y1) {
            *x0 = fmin(*x0, a[0]);
            *x1 = fmax(*x1, a[0]);
        }
        for (int k = 0; k < 2; k++) {
            if ((a[1] < edges[k]) == (b[1] < edges[k]))
                continue;
            double x = a[0] + (b[0] - a[0]) * (edges[k] - a[1]) / (b[1] - a[1]);
            *x0 = fmin(*x0, x);
            *x1 = fmax(*x1, x);
        }
    }
    return *x0 <= *x1;
}

double texture_power_whole(const struct texture_power_sums *f)
{
    return f->sums[((size_t)f->width + 1) * (f->height + 1) - 1] /
           ((double)f->width * f->height);
}

double texture_power_mean(const struct texture_power_sums *f,
                          const struct vec2 uv[3])
{
    double whole = texture_power_whole(f);
    double top = INFINITY, bottom = -INFINITY;
    double sum = 0, area = 0;
    double p[3][2];

    for (int i = 0; i < 3; i++) {
        double u = (double)uv[i].x, v = (double)uv[i].y;

        if (!(fabs(u) < UV_MAX && fabs(v) < UV_MAX))
            return whole;
        p[i][0] = u * f->width;
        p[i][1] = (1 - v) * f->height;
        top = fmin(top, p[i][1]);
        bottom = fmax(bottom, p[i][1]);
    }
    top = floor(top - REACH);
    bottom = floor(bottom + REACH) + 1;
    double step = ceil((bottom - top) / BANDS);
    for (int i = 0; i < BANDS; i++) {
        double y = top + i * step;
        double end = fmin(y + step, bottom);
        double x0, x1;

        if (y >= bottom)
            break;
        if (!extent((const double(*)[2])p, y - REACH, end + REACH, &x0, &x1))
            continue;
        x0 = floor(x0 - REACH);
        x1 = floor(x1 + REACH) + 1;
        sum += sum_within(f, x0, x1, y, end);
        area += (x1 - x0) * (end - y);
    }
    return area > 0 ? fmax(sum / area, 0) : whole;
}

void texture_power_free(struct texture_power_sums *f)
{
    free(f->sums);
    *f = (struct texture_power_sums){NULL, 0, 0};
}

/* ---- lights ---- */

/* Least share of a light in the power of all. No light has none. */
#define POWER_MIN 1e-30

/* Twice the area of the smallest light. The density of a smaller one would
 * overflow in float; only BSDF samples find it. */
#define AREA_MIN 1e-30

/* Variance that lights would cause without light samples, relative to the
 * square of the irradiance of a constant sky on a plane: from VARIANCE_FULL on
 * they are sampled each time, below in proportion, but never less often than
 * SHARE_MIN. Measured: without sampling, the lamps of five scenes (6 and
 * more) leave 3 to 80 times the error. A large paper lamp in a room with a
 * window (.01) leaves 1.2 times, and its shadow rays would double the time. */
#define VARIANCE_FULL 0.1
#define SHARE_MIN     0.1

/* Limits for two triangles to become one light: the cosine between their
 * normals, of which the tree knows one, and the ratio of their powers, as each
 * is sampled half the time. Densities are exact for any pair. */
#define FLAT_COSINE 0.999999f
#define PAIR_RATIO  1.5

/* Textures of which a triangle may show other texels than those between its
 * coordinates in uvs. */
#define NOT_REPEATED \
    (TEXTURE_CLAMP | TEXTURE_MIRROR_U | TEXTURE_MIRROR_V | TEXTURE_SECOND_UVS)

/* Instances with more triangles that shine together are found by BSDF samples
 * only: their lights would take more than 1 GB. */
#define INSTANCE_LIGHTS_MAX (1u << 22)

bool lights_differ(const struct material *a, const struct material *b)
{
    if (!material_shines(a) && !material_shines(b))
        return false;
    return memcmp(&a->emission, &b->emission, sizeof a->emission) != 0 ||
           a->emission_texture != b->emission_texture ||
           a->opacity != b->opacity;
}

static double mean_radiance(const struct world *w, const struct tri *t,
                            const struct texture_power_sums *footprints)
{
    const struct material *m = &w->materials[t->material];
    double mean = color_mean(m->emission);

    if (m->emission_texture != NO_INDEX && t->vt[0] != NO_INDEX) {
        const struct texture_power_sums *f = &footprints[t->material];
        struct texture texture = w->textures[m->emission_texture];
        struct vec2 uv[3];

        for (int i = 0; i < 3; i++)
            uv[i] = texture_uv(texture, w->uvs[t->vt[i]]);
        /* a triangle outside a clamped image shows the border, of unknown
         * extent */
        mean = (texture.flags & NOT_REPEATED) != 0 ? texture_power_whole(f)
                                                   : texture_power_mean(f, uv);
    }
    return mean * (double)m->opacity;
}

static struct vec3 corner(const struct world *w, uint32_t tri, uint32_t k)
{
    uint32_t instance = instance_of(w, tri);

    return position_at(w, tri_at(w, tri, instance).v[k % 3], instance);
}

/* A normal of twice the triangle's area. */
static struct vec3 long_normal(const struct world *w, uint32_t tri)
{
    struct vec3 p = corner(w, tri, 0);

    return v3_cross(v3_sub(corner(w, tri, 1), p), v3_sub(corner(w, tri, 2), p));
}

/* Fills an emitter. Returns false if the triangle is not worth sampling. Adds
 * its term to *unsampled_variance. */
static bool make_emitter(const struct world *w, uint32_t tri,
                         const struct texture_power_sums *footprints,
                         struct emitter *e, double *unsampled_variance)
{
    const struct tri t = tri_placed(w, tri).t;
    double twice_area = (double)v3_length(long_normal(w, tri));
    double radiance;

    if (!(twice_area > AREA_MIN))
        return false;
    radiance = mean_radiance(w, &t, footprints);
    *e = (struct emitter){.lo = corner(w, tri, 0),
                          .hi = corner(w, tri, 0),
                          .normal = t.ng,
                          .power = twice_area * radiance};
    *unsampled_variance += e->power / 2 * radiance;
    for (uint32_t k = 1; k < 3; k++) {
        e->lo = v3_min(e->lo, corner(w, tri, k));
        e->hi = v3_max(e->hi, corner(w, tri, k));
    }
    return e->power > 0;
}

static struct light make_light(const struct world *w, uint32_t tri)
{
    const struct tri t = tri_at(w, tri, instance_of(w, tri));
    const struct material *m = &w->materials[t.material];
    struct light l = {.tris = {tri, NO_INDEX},
                      .texture = NO_INDEX,
                      .corners = {corner(w, tri, 0), corner(w, tri, 1),
                                  corner(w, tri, 2), corner(w, tri, 2)},
                      .scaled_normals = {long_normal(w, tri)},
                      .emission = m->emission};

    if (t.vt[0] != NO_INDEX)
        l.texture = m->emission_texture;
    return l;
}

static bool is_same_place(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Returns true if the triangles share a side and have the same winding. *i and
 * *k are the corners that are not on it. */
static bool share_side(const struct world *w, uint32_t a, uint32_t b,
                       uint32_t *i, uint32_t *k)
{
    for (*i = 0; *i < 3; (*i)++)
        for (*k = 0; *k < 3; (*k)++)
            if (is_same_place(corner(w, a, *i + 1), corner(w, b, *k + 2)) &&
                is_same_place(corner(w, a, *i + 2), corner(w, b, *k + 1)))
                return true;
    return false;
}

/* Makes one light of the last one and the triangle of `other`, which has the
 * emitter `e`. Returns false if they are not alike enough to be sampled equally
 * often, as one face. */
static bool join_light(const struct world *w, struct light *l,
                       struct emitter *last, const struct light *other,
                       const struct emitter *e)
{
    uint32_t tri = other->tris[0];
    uint32_t i, k;

    if (l->tris[0] + 1 != tri || l->tris[1] != NO_INDEX ||
        l->texture != other->texture ||
        lights_differ(&w->materials[tri_material_number(w, l->tris[0])],
                      &w->materials[tri_material_number(w, tri)]) ||
        !(v3_dot(e->normal, last->normal) > FLAT_COSINE) ||
        fmax(e->power, last->power) >
            PAIR_RATIO * fmin(e->power, last->power) ||
        !share_side(w, l->tris[0], tri, &i, &k))
        return false;
    l->corners[0] = corner(w, l->tris[0], i);
    l->corners[1] = corner(w, l->tris[0], i + 1);
    l->corners[2] = corner(w, tri, k);
    l->corners[3] = corner(w, l->tris[0], i + 2);
    l->tris[1] = tri;
    l->rotation[0] = (3 - i) % 3;
    l->rotation[1] = (3 - k) % 3;
    l->scaled_normals[0] = v3_scale(l->scaled_normals[0], 2.0f);
    l->scaled_normals[1] = v3_scale(other->scaled_normals[0], 2.0f);
    last->power += e->power;
    last->lo = v3_min(last->lo, e->lo);
    last->hi = v3_max(last->hi, e->hi);
    return true;
}

/* Adds the light of a triangle, or joins it to the last light. */
static void add_light(const struct world *w, struct lights *l,
                      struct emitter *emitters, uint32_t tri,
                      const struct emitter *e)
{
    struct light light = make_light(w, tri);
    uint32_t n = l->light_count;

    if (n > 0 &&
        join_light(w, &l->lights[n - 1], &emitters[n - 1], &light, e)) {
        l->powers[n - 1][1] = e->power / 2;
        return;
    }
    l->lights[n] = light;
    l->powers[n][0] = e->power / 2;
    emitters[n] = *e;
    emitters[n].light = n;
    l->light_count++;
}

/* Intensity of a point light along its axis. */
static double intensity_of(const struct point_light *l)
{
    double area =
        l->radius > 0 ? M_PI * (double)l->radius * (double)l->radius : 1;

    return color_mean(l->emission) * area;
}

/* Part of the sphere of directions into which a point light shines. The mean of
 * its falloff (see struct point_light) over cosines is a cubic. */
static double lit_part(const struct point_light *l)
{
    double scale = (double)l->cone_scale, offset = (double)l->cone_offset;
    double outer, inner;

    if (!(scale > 0))
        return 1;
    outer = fmax(-offset / scale, -1);
    inner = fmin((1 - offset) / scale, 1);
    return (1 - inner) / 2 +
           (pow(inner * scale + offset, 3) - pow(outer * scale + offset, 3)) /
               (6 * scale);
}

/* Mean of a light's profile over the sphere of directions. */
static double profile_mean(const struct world *w, const struct point_light *l)
{
    double sum = 0, weights = 0;

    if (l->profile == 0)
        return 1;
    for (uint32_t row = 0; row < PROFILE_ROWS; row++) {
        double weight = sin(M_PI * row / (PROFILE_ROWS - 1));

        for (uint32_t i = 0; i < l->profile_columns; i++)
            sum +=
                weight *
                (double)
                    w->profiles[l->profile - 1 + row * l->profile_columns + i];
        weights += weight * l->profile_columns;
    }
    return sum / weights;
}

double point_light_power(const struct world *w, const struct point_light *l)
{
    return 2 * intensity_of(l) * lit_part(l) * profile_mean(w, l);
}

/* Copies point lights of one kind with their emitters. Returns their power. */
static double add_points(struct lights *l, struct emitter *emitters,
                         const struct world *w, bool is_sphere)
{
    double total = 0;

    for (uint32_t i = 0; i < w->settings.point_light_count; i++) {
        const struct point_light *p = &w->point_lights[i];
        struct vec3 half = v3(p->radius, p->radius, p->radius);
        uint32_t n = l->light_count + l->point_light_count;

        if ((p->radius > 0) != is_sphere)
            continue;
        /* the cone of a spot has its full width where falloff ends */
        emitters[n] = (struct emitter){
            .lo = v3_sub(p->p, half),
            .hi = v3_add(p->p, half),
            .normal = p->axis,
            .spread = p->cone_scale > 0
                          ? 1 - f_max(-p->cone_offset / p->cone_scale, 0)
                          : 1,
            .power = 2 * intensity_of(p) * profile_mean(w, p),
            .light = n,
        };
        total += emitters[n].power;
        l->point_power += point_light_power(w, p);
        l->point_lights[l->point_light_count++] = *p;
        l->sphere_count += is_sphere;
    }
    return total;
}

/* Returns the number of instances whose lights are sampled: all or none. */
static uint32_t shining_instances(const struct world *w)
{
    uint64_t tris = 0;

    for (uint32_t i = 0; i < w->settings.instance_count; i++)
        if (material_shines(&w->materials[w->instances[i].material]))
            tris += w->instances[i].tri_count;
    return tris <= INSTANCE_LIGHTS_MAX ? w->settings.instance_count : 0;
}

/* Adds the light of a triangle if it shines, and its power. Returns its index,
 * or NO_INDEX. */
static uint32_t find_light(struct lights *l, struct emitter *emitters,
                           const struct world *w, uint32_t tri,
                           const struct texture_power_sums *footprints,
                           double *total)
{
    struct emitter e;

    if (!material_shines(&w->materials[tri_material_number(w, tri)]) ||
        !make_emitter(w, tri, footprints, &e, &l->unsampled_variance))
        return NO_INDEX;
    *total += e.power;
    add_light(w, l, emitters, tri, &e);
    return l->light_count - 1;
}

/* Finds the emitters among `candidate_count` triangles of emissive materials,
 * and adds those of point lights. */
static bool find_emitters(struct lights *l, struct emitter **emitters,
                          const struct world *w, uint32_t candidate_count,
                          const struct texture_power_sums *footprints,
                          struct error *err)
{
    uint32_t point_count = w->settings.point_light_count;
    uint32_t instance_count = shining_instances(w);
    double total = 0;

    *emitters =
        alloc_array((size_t)candidate_count + point_count, sizeof **emitters);
    l->point_lights = alloc_array(point_count, sizeof *l->point_lights);
    l->lights = alloc_array(candidate_count, sizeof *l->lights);
    l->powers = alloc_array(candidate_count, sizeof *l->powers);
    l->tri_lights = alloc_array(w->settings.tri_count, sizeof *l->tri_lights);
    if (*emitters == NULL || l->lights == NULL || l->powers == NULL ||
        l->tri_lights == NULL || l->point_lights == NULL)
        return fail(err, "out of memory for %u lights",
                    candidate_count + point_count);
    for (uint32_t i = 0; i < plain_tri_count(w); i++)
        l->tri_lights[i] = find_light(l, *emitters, w, i, footprints, &total);
    for (uint32_t i = 0; i < instance_count; i++) {
        const struct instance *at = &w->instances[i];
        bool shines = material_shines(&w->materials[at->material]);

        for (uint32_t k = 0; shines && k < at->tri_count; k++)
            find_light(l, *emitters, w, at->first_tri + k, footprints, &total);
    }
    total +=
        add_points(l, *emitters, w, true) + add_points(l, *emitters, w, false);
    for (uint32_t i = 0; i < l->light_count + l->point_light_count; i++)
        (*emitters)[i].power = fmax((*emitters)[i].power / total, POWER_MIN);
    return true;
}

/* Makes the sums of emission textures, of one material each. */
static bool make_footprints(const struct world *w, const bool *is_used,
                            uint32_t material_count,
                            struct texture_power_sums *footprints,
                            struct error *err)
{
    for (uint32_t i = 0; i < material_count; i++) {
        const struct material *m = &w->materials[i];

        if (is_used[i] && m->emission_texture != NO_INDEX &&
            !texture_power_init(&footprints[i], w, m, err))
            return false;
    }
    return true;
}

/* Finds the materials that shine. Returns the number of their triangles. Looks
 * through the triangles only if there is such a material. */
static uint32_t find_shining(const struct world *w, bool *is_used)
{
    uint32_t instance_count = shining_instances(w);
    uint32_t count = 0;
    bool may = false;

    for (uint32_t i = 0; i < w->settings.material_count && !may; i++)
        may = material_shines(&w->materials[i]);
    for (uint32_t i = 0; may && i < plain_tri_count(w); i++) {
        uint32_t material = w->tris[i].material;

        is_used[material] = material_shines(&w->materials[material]);
        count += is_used[material] ? 1 : 0;
    }
    for (uint32_t i = 0; i < instance_count; i++) {
        const struct instance *at = &w->instances[i];

        is_used[at->material] = material_shines(&w->materials[at->material]);
        count += is_used[at->material] ? at->tri_count : 0;
    }
    return count;
}

bool lights_build(struct lights *lights, const struct world *w,
                  struct error *err)
{
    struct emitter *emitters = NULL;
    uint32_t material_count = w->settings.material_count;
    struct texture_power_sums *footprints =
        alloc_array(material_count, sizeof *footprints);
    bool *is_used = alloc_array(material_count, sizeof *is_used);
    uint32_t candidate_count = 0;
    bool ok = false;

    lights_free(lights);
    if (footprints == NULL || is_used == NULL) {
        fail(err, "out of memory for the lights of %u materials",
             material_count);
        goto out;
    }
    candidate_count = find_shining(w, is_used);
    ok = candidate_count + w->settings.point_light_count == 0 ||
         (make_footprints(w, is_used, material_count, footprints, err) &&
          find_emitters(lights, &emitters, w, candidate_count, footprints,
                        err) &&
          light_tree_build(lights, emitters, err));
out:
    for (uint32_t i = 0; footprints != NULL && i < material_count; i++)
        texture_power_free(&footprints[i]);
    free(footprints);
    free(is_used);
    free(emitters);
    if (!ok)
        lights_free(lights);
    return ok;
}

double lights_power(const struct lights *lights)
{
    double power = lights->point_power;

    for (uint32_t i = 0; i < lights->light_count; i++)
        power += lights->powers[i][0] + lights->powers[i][1];
    return power;
}

/* Share of light samples for the lights. Light from them that only BSDF samples
 * find has on a plane a variance of about pi times power times radiance at
 * distance 1. */
static float light_share(const struct lights *lights, const struct sky *sky)
{
    double radiance = color_mean(sky->color);
    double ratio = lights->unsampled_variance / (M_PI * radiance * radiance);

    if (lights->point_light_count > 0)
        return 1;
    if (lights->light_count == 0)
        return 0;
    if (sky->width != 0 || !(ratio < VARIANCE_FULL))
        return 1;
    return (float)fmax(ratio / VARIANCE_FULL, SHARE_MIN);
}

void lights_lend(const struct lights *lights, struct world *world)
{
    world->lights = lights->lights;
    world->settings.light_count = lights->light_count;
    world->settings.light_share = light_share(lights, &world->settings.sky);
    world->tri_lights = lights->tri_lights;
    world->light_nodes = lights->nodes;
    world->settings.light_node_count = lights->node_count;
    world->point_lights = lights->point_lights;
    world->settings.point_light_count = lights->point_light_count;
    world->settings.sphere_count = lights->sphere_count;
}

void lights_free(struct lights *lights)
{
    free(lights->lights);
    free(lights->powers);
    free(lights->tri_lights);
    free(lights->point_lights);
    free(lights->nodes);
    memset(lights, 0, sizeof *lights);
}
