// SPDX-License-Identifier: MIT
#include "scene/world_lamps.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "picture/color.h"
#include "light/daylight.h"
#include "light/sun_sky.h"

/* Least radius of a sphere, and greatest distance of any lamp, in normalised
 * units. Squares of both are normal floats; smaller spheres are points. */
#define RADIUS_LEAST 1e-6
#define REACH_MAX    1e9

/* Least difference between the cosines of a spot's angles, that of glTF's
 * formula. */
#define CONE_LEAST 0.001

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

/* Sets the axis and the falloff of a spot, as glTF defines it. */
static void aim_spot(struct point_light *l, const struct lamp *lamp)
{
    double axis[3], length = 0;
    double outer = cos(angle_rad(lamp->outer_deg));
    double scale =
        1 / fmax(CONE_LEAST, cos(angle_rad(lamp->inner_deg)) - outer);

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

static struct point_light make_point(const struct scene *scene,
                                     const struct lamp *lamp)
{
    double p[3], radius = lamp->radius * scene->scale;
    double intensity = scene->scale * scene->scale;
    struct point_light l = {.cone_offset = 1};

    for (int k = 0; k < 3; k++)
        p[k] = (lamp->position[k] - scene->center[k]) * scene->scale;
    l.p = (struct vec3){clamped(p[0], REACH_MAX), clamped(p[1], REACH_MAX),
                        clamped(p[2], REACH_MAX)};
    if (radius > RADIUS_LEAST) {
        l.radius = clamped(radius, REACH_MAX);
        intensity /= M_PI * (double)l.radius * (double)l.radius;
    }
    l.emission = scaled_rgb(lamp->rgb, intensity);
    if (lamp->kind == LAMP_SPOT)
        aim_spot(&l, lamp);
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

/* Counts and arrays that a view needs. */
struct made {
    struct point_light *points;
    struct directional_light *directions;
    uint32_t point_count, direction_count;
};

static bool make_lamps(const struct scene *scene, const struct view *view,
                       struct made *m)
{
    const struct sun *sun = &view->lighting.sun;

    m->points = alloc_array(view->lamps.count, sizeof *m->points);
    m->directions =
        alloc_array((size_t)view->lamps.count + 1, sizeof *m->directions);
    if (m->points == NULL || m->directions == NULL)
        return false;
    for (uint32_t i = 0; i < view->lamps.count; i++) {
        const struct lamp *lamp = &view->lamps.items[i];

        if (!shines(lamp))
            continue;
        if (lamp->kind == LAMP_DIRECTIONAL)
            m->directions[m->direction_count++] =
                make_directional(lamp->azimuth_deg, lamp->elevation_deg,
                                 lamp->angle_deg, lamp->rgb);
        else
            m->points[m->point_count++] = make_point(scene, lamp);
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
        (m->point_count == 0 ||
         memcmp(m->points, host->point_lights,
                m->point_count * sizeof *m->points) == 0))
        return true;
    arrays.point_lights = m->points;
    arrays.settings.point_light_count = m->point_count;
    if (!lights_build(&lights, &arrays, err))
        return false;
    lights_free(&host->lights);
    host->lights = lights;
    free(host->point_lights);
    host->point_lights = m->points;
    host->point_light_count = m->point_count;
    m->points = NULL; /* the world owns it now */
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
    return ok;
}
