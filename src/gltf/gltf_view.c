// SPDX-License-Identifier: MIT
#include "gltf/gltf_view.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gltf/gltf_light_unit.h"
#include "kernels/types.h"
#include "scene/lamp.h"

/* Least and greatest vertical field of view that glim's cameras have. */
#define YFOV_MIN 1e-6
#define YFOV_MAX 3.14

/* Field of view of cameras that are not perspective, in radians. */
#define YFOV_DEFAULT 0.7

/* Returns column `k` of the matrix with length 1; unchanged if it is 0. */
static void column(const struct affine *a, int k, double sign, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = sign * a->m[i][k];
    vec3d_normalize(to);
}

static void position_of(const struct affine *a, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a->m[i][3];
}

/* ---- cameras ---- */

static bool read_yfov(const struct gltf_value *v, double *yfov,
                      struct warnings *report, struct error *err)
{
    struct gltf_value lens;
    const char *type = "";

    if (!gltf_string(v, "type", &type, err) ||
        !gltf_object(v, "perspective", &lens, err))
        return false;
    *yfov = YFOV_DEFAULT;
    if (strcmp(type, "perspective") == 0)
        return gltf_number(&lens, "yfov", YFOV_MIN, YFOV_MAX, yfov, err);
    warnings_add(report, "cameras without perspective",
                 "%s: found a camera of type \"%.20s\", expected perspective: "
                 "taken as one of 40 degrees",
                 v->document->path, type);
    return true;
}

static bool add_camera(struct scene *scene, size_t *capacity, const char *name,
                       const struct affine *a, double yfov)
{
    void *cameras = scene->cameras;
    struct scene_camera c = {.name = strdup(name),
                             .pose = {.fovy_deg = angle_deg(yfov)}};
    double forward[3];

    if (c.name == NULL ||
        !grow_array(&cameras, capacity, (size_t)scene->camera_count + 1,
                    sizeof *scene->cameras)) {
        free(c.name);
        return false;
    }
    position_of(a, c.pose.eye);
    column(a, 1, 1, c.pose.up);
    column(a, 2, -1, forward);
    for (int i = 0; i < 3; i++)
        c.pose.at[i] = c.pose.eye[i] + forward[i];
    scene->cameras = cameras;
    scene->cameras[scene->camera_count++] = c;
    return true;
}

static bool read_camera(const struct gltf_value *node,
                        const struct gltf_node *n, struct scene *scene,
                        size_t *capacity, struct warnings *report,
                        struct error *err)
{
    char cut[GLTF_NAME_BYTES];
    struct gltf_value v;
    const char *name;
    double yfov;

    return gltf_entry(node->document, "cameras", n->camera, &v, err) &&
           gltf_node_name(node, &v, cut, &name, err) &&
           read_yfov(&v, &yfov, report, err) &&
           (add_camera(scene, capacity, name, &n->world, yfov) ||
            gltf_fail(node, err, "out of memory for its camera"));
}

/* ---- lights ---- */

static bool read_kind(const struct gltf_value *v, struct lamp *lamp,
                      struct error *err)
{
    static const char *const kinds[LAMP_KINDS] = {
        [LAMP_POINT] = "point",
        [LAMP_SPOT] = "spot",
        [LAMP_DIRECTIONAL] = "directional",
    };
    const char *type = "";

    if (!gltf_string(v, "type", &type, err))
        return false;
    for (int i = 0; i < LAMP_KINDS; i++)
        if (strcmp(type, kinds[i]) == 0) {
            lamp_init(lamp, (enum lamp_kind)i);
            return true;
        }
    return gltf_fail(v, err,
                     "found the type \"%.20s\", expected point, spot or "
                     "directional",
                     type);
}

static bool read_cone(const struct gltf_value *v, struct lamp *lamp,
                      struct error *err)
{
    double inner = 0, outer = M_PI / 4;
    struct gltf_value spot;

    if (!gltf_object(v, "spot", &spot, err) ||
        !gltf_number(&spot, "innerConeAngle", 0, M_PI / 2, &inner, err) ||
        !gltf_number(&spot, "outerConeAngle", 0, M_PI / 2, &outer, err))
        return false;
    if (inner > outer)
        return gltf_fail(v, err,
                         "found an innerConeAngle of %g above the "
                         "outerConeAngle of %g",
                         inner, outer);
    lamp->inner_deg = angle_deg(inner);
    lamp->outer_deg = fmin(angle_deg(outer), 90);
    return true;
}

/* Lights shine along -z of their nodes. */
static void place_lamp(struct lamp *lamp, const struct affine *a)
{
    double forward[3], backward[3];

    column(a, 2, -1, forward);
    position_of(a, lamp->position);
    for (int i = 0; i < 3; i++)
        lamp->at[i] = lamp->position[i] + forward[i];
    column(a, 2, 1, backward);
    lamp_set_direction(lamp, backward);
}

static bool read_light(const struct gltf_value *node, const struct gltf_node *n,
                       struct scene *scene, struct error *err)
{
    double color[3] = {1, 1, 1}, intensity = 1, unit;
    struct gltf_value v;
    struct lamp lamp;

    if (!gltf_entry(node->document, "lights", n->light, &v, err) ||
        !read_kind(&v, &lamp, err) ||
        !gltf_numbers(&v, "color", 3, color, err) ||
        !gltf_number(&v, "intensity", 0, FLT_MAX, &intensity, err) ||
        (lamp.kind == LAMP_SPOT && !read_cone(&v, &lamp, err)))
        return false;
    unit = light_unit_factor(scene->light_unit, lamp.kind == LAMP_DIRECTIONAL);
    for (int i = 0; i < 3; i++) {
        if (!(color[i] >= 0 && color[i] <= FLT_MAX))
            return gltf_fail(&v, err, "found a color of %g, expected 0 to 1",
                             color[i]);
        lamp.rgb[i] = fmin(color[i] * intensity * unit, FLT_MAX);
    }
    place_lamp(&lamp, &n->world);
    return lamps_add(&scene->lamps, &lamp) ||
           gltf_fail(node, err, "out of memory for its light");
}

bool gltf_view_read(const struct gltf_document *document,
                    const struct gltf_nodes *nodes, struct scene *scene,
                    struct warnings *report, struct error *err)
{
    size_t capacity = 0;

    scene->light_unit =
        gltf_light_unit(document, &scene->light_unit_is_guessed);
    for (uint32_t i = 0; i < nodes->visible_count; i++) {
        const struct gltf_node *n = &nodes->items[nodes->visible[i]];
        struct gltf_value v;

        if (n->camera == NO_INDEX && n->light == NO_INDEX)
            continue;
        if (!gltf_entry(document, "nodes", nodes->visible[i], &v, err) ||
            (n->camera != NO_INDEX &&
             !read_camera(&v, n, scene, &capacity, report, err)) ||
            (n->light != NO_INDEX && !read_light(&v, n, scene, err)))
            return false;
    }
    return true;
}
