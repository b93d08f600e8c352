// SPDX-License-Identifier: MIT
#include "world/world_lamps.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "image/color.h"
#include "world/light/daylight.h"

#include "kernels/vec.h"

/* Least radius of a sphere, and greatest distance of any lamp, in normalised
 * units. Squares of both are normal floats; smaller spheres are points. */
#define RADIUS_MIN 1e-6
#define REACH_MAX  1e9

/* Least difference between the cosines of a spot's angles, that of glTF's
 * formula. */
#define CONE_MIN 0.001

/* Counts and arrays that a view needs. */
struct made {
    struct point_light *points;
    struct directional_light *directions;
    uint32_t point_count, direction_count;
    float *profiles; /* values of all profiles */
    uint32_t profile_value_count;
    uint32_t *starts; /* of each lamp: where its profile begins in them */
};

/* Rounds to float. Numbers beyond its range become the greatest one. */
static float clamped(double x, double most)
{
    return (float)fmax(fmin(x, most), -most);
}

static struct vec3 scaled_rgb(const double rgb[3], double scale)
{
    return (struct vec3){clamped(rgb[0] * scale, (double)FLT_MAX),
                         clamped(rgb[1] * scale, (double)FLT_MAX),
                         clamped(rgb[2] * scale, (double)FLT_MAX)};
}

static bool shines(const struct lamp *lamp)
{
    return lamp->rgb[0] > 0 || lamp->rgb[1] > 0 || lamp->rgb[2] > 0;
}

/* Turns the profile: the angle 0 around an axis is that of +x, or of +z for an
 * axis along x. */
static void aim_profile(struct point_light *l)
{
    struct vec3 x = {1, 0, 0}, z = {0, 0, 1};
    struct vec3 to = fabsf(l->axis.x) < 0.99f ? x : z;

    l->side = v3_unit(v3_sub(to, v3_scale(l->axis, v3_dot(to, l->axis))));
}

/* Sets the axis and the falloff of a spot, as glTF defines it. */
static void aim_spot(struct point_light *l, const struct lamp *lamp)
{
    double axis[3], length = 0;
    double outer = cos(angle_rad(lamp->outer_deg));
    double scale = 1 / fmax(CONE_MIN, cos(angle_rad(lamp->inner_deg)) - outer);

    for (int k = 0; k < 3; k++) {
        axis[k] = lamp->at[k] - lamp->position[k];
        length = hypot(length, axis[k]);
    }
    l->axis =
        (struct vec3){(float)(axis[0] / length), (float)(axis[1] / length),
                      (float)(axis[2] / length)};
    l->cone_scale = (float)scale;
    l->cone_offset = (float)(-outer * scale);
}

/* A lamp with a profile. */
struct profiled {
    const struct profile *profile;
    uint32_t lamp;
};

static int by_profile(const void *a, const void *b)
{
    const struct profiled *p = a, *q = b;

    if (p->profile != q->profile)
        return (uintptr_t)p->profile < (uintptr_t)q->profile ? -1 : 1;
    return p->lamp < q->lamp ? -1 : p->lamp > q->lamp;
}

/* Finds for each lamp with a profile the first lamp that has the same one, in
 * `starts`. Returns the number of values of all profiles. */
static size_t find_first(struct made *m, const struct lamps *lamps,
                         struct profiled *order)
{
    uint32_t count = 0, first = 0;
    size_t values = 0;

    for (uint32_t i = 0; i < lamps->count; i++)
        if (lamps->items[i].profile != NULL)
            order[count++] = (struct profiled){lamps->items[i].profile, i};
    qsort(order, count, sizeof *order, by_profile);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || order[i].profile != order[i - 1].profile) {
            first = order[i].lamp;
            values += profile_value_count(order[i].profile);
        }
        m->starts[order[i].lamp] = first;
    }
    return values;
}

/* Puts the values of each profile where the first lamp needs them, and where
 * they begin into `starts`. */
static bool add_profiles(struct made *m, const struct lamps *lamps)
{
    struct profiled *order = alloc_array(lamps->count, sizeof *order);
    size_t values = order != NULL ? find_first(m, lamps, order) : 0;

    free(order);
    m->profiles =
        order != NULL ? alloc_array(values, sizeof *m->profiles) : NULL;
    if (m->profiles == NULL)
        return false;
    for (uint32_t i = 0; i < lamps->count; i++) {
        const struct profile *p = lamps->items[i].profile;

        if (p == NULL)
            continue;
        if (m->starts[i] != i) {
            m->starts[i] = m->starts[m->starts[i]];
            continue;
        }
        memcpy(m->profiles + m->profile_value_count, p->values,
               profile_value_count(p) * sizeof *p->values);
        m->starts[i] = m->profile_value_count;
        m->profile_value_count += profile_value_count(p);
    }
    return true;
}

static struct point_light make_point(const struct scene *scene,
                                     const struct lamp *lamp, uint32_t profile)
{
    double p[3], radius = lamp->radius * scene->scale;
    double intensity = scene->scale * scene->scale;
    struct point_light l = {.cone_offset = 1};

    for (int k = 0; k < 3; k++)
        p[k] = (lamp->position[k] - scene->center[k]) * scene->scale;
    l.p = (struct vec3){clamped(p[0], REACH_MAX), clamped(p[1], REACH_MAX),
                        clamped(p[2], REACH_MAX)};
    if (radius > RADIUS_MIN) {
        l.radius = clamped(radius, REACH_MAX);
        intensity /= M_PI * (double)l.radius * (double)l.radius;
    }
    l.emission = scaled_rgb(lamp->rgb, intensity);
    if (lamp->kind == LAMP_SPOT)
        aim_spot(&l, lamp);
    if (lamp->profile != NULL) {
        if (lamp->kind == LAMP_POINT)
            l.axis = (struct vec3){0, -1, 0};
        l.profile = 1 + profile;
        l.profile_columns = lamp->profile->columns;
        aim_profile(&l);
    }
    return l;
}

/* Makes a light of this irradiance, in degrees as of struct sun. Its disc has
 * the diameter `angle_deg`. */
static struct directional_light make_directional(double azimuth_deg,
                                                 double elevation_deg,
                                                 double angle_deg,
                                                 const double irradiance[3])
{
    double azimuth = angle_rad(azimuth_deg);
    double elevation = angle_rad(elevation_deg);
    double sine = sin(angle_rad(angle_deg) / 2);
    double part = angle_deg > 0 ? 1 / (M_PI * sine * sine) : 1;

    return (struct directional_light){
        .d = {(float)(sin(azimuth) * cos(elevation)), (float)sin(elevation),
              (float)(-cos(azimuth) * cos(elevation))},
        .size = (float)(2 * pow(sin(angle_rad(angle_deg) / 4), 2)),
        .sine = (float)sine,
        .emission = scaled_rgb(irradiance, part),
        .power = (float)color_mean(scaled_rgb(irradiance, 1)),
    };
}

/* Makes the light of the view's sun, which is above the horizon. */
static struct directional_light make_sun(const struct lighting *l)
{
    double irradiance[3];

    sun_irradiance(l->sun.elevation_deg, l->sun.turbidity, irradiance);
    for (int i = 0; i < 3; i++)
        irradiance[i] *= l->sky_strength;
    return make_directional(l->sun.azimuth_deg, l->sun.elevation_deg,
                            2 * SUN_RADIUS_DEG, irradiance);
}

static bool make_lamps(const struct scene *scene, const struct view *view,
                       struct made *m)
{
    const struct sun *sun = &view->lighting.sun;
    const struct lamps *lamps = &view->lamps;

    m->starts = alloc_array(lamps->count, sizeof *m->starts);
    m->points = alloc_array(view->lamps.count, sizeof *m->points);
    m->directions =
        alloc_array((size_t)view->lamps.count + 1, sizeof *m->directions);
    if (m->points == NULL || m->directions == NULL || m->starts == NULL ||
        !add_profiles(m, lamps))
        return false;
    for (uint32_t i = 0; i < lamps->count; i++) {
        const struct lamp *lamp = &lamps->items[i];

        if (!shines(lamp))
            continue;
        if (lamp->kind == LAMP_DIRECTIONAL)
            m->directions[m->direction_count++] =
                make_directional(lamp->azimuth_deg, lamp->elevation_deg,
                                 lamp->angle_deg, lamp->rgb);
        else
            m->points[m->point_count++] = make_point(scene, lamp, m->starts[i]);
    }
    if (sun->is_on && sun->elevation_deg > 0 && view->lighting.sky_strength > 0)
        m->directions[m->direction_count++] = make_sun(&view->lighting);
    return true;
}

/* Builds the lights of a world that gets other point lights. */
static bool set_points(struct host_world *host, const struct scene *scene,
                       struct made *m, struct error *err)
{
    struct world arrays = world_arrays(host, scene);
    struct lights lights = {.lights = NULL};

    if (m->point_count == host->point_light_count &&
        m->profile_value_count == host->profile_value_count &&
        (m->point_count == 0 ||
         memcmp(m->points, host->point_lights,
                m->point_count * sizeof *m->points) == 0) &&
        (m->profile_value_count == 0 ||
         memcmp(m->profiles, host->profiles,
                m->profile_value_count * sizeof *m->profiles) == 0))
        return true;
    arrays.point_lights = m->points;
    arrays.profiles = m->profiles;
    arrays.settings.profile_value_count = m->profile_value_count;
    arrays.settings.point_light_count = m->point_count;
    if (!lights_build(&lights, &arrays, err))
        return false;
    lights_free(&host->lights);
    host->lights = lights;
    free(host->point_lights);
    host->point_lights = m->points;
    host->point_light_count = m->point_count;
    m->points = NULL; /* the world owns it now */
    free(host->profiles);
    host->profiles = m->profiles;
    host->profile_value_count = m->profile_value_count;
    m->profiles = NULL; /* the world owns it now */
    world_renew(host, WORLD_LIGHTS);
    path_guide_outdate(&host->guide);
    return true;
}

static void set_directions(struct host_world *host, struct made *m)
{
    if (m->direction_count == host->directional_light_count &&
        (m->direction_count == 0 ||
         memcmp(m->directions, host->directional_lights,
                m->direction_count * sizeof *m->directions) == 0))
        return;
    free(host->directional_lights);
    host->directional_lights = m->directions;
    host->directional_light_count = m->direction_count;
    m->directions = NULL; /* the world owns it now */
    world_renew(host, WORLD_DIRECTIONAL_LIGHTS);
}

bool world_set_lamps(struct host_world *host, const struct scene *scene,
                     const struct view *view, struct error *err)
{
    struct made m = {.points = NULL};
    bool ok = make_lamps(scene, view, &m) ||
              fail(err, "%s: out of memory for its lamps", scene->path);

    ok = ok && set_points(host, scene, &m, err);
    if (ok)
        set_directions(host, &m);
    free(m.points);
    free(m.directions);
    free(m.profiles);
    free(m.starts);
    return ok;
}
