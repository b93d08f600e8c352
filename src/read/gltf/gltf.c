// SPDX-License-Identifier: MIT
#include "read/gltf/gltf.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "read/gltf/gltf_animation.h"
#include "read/gltf/gltf_document.h"
#include "read/gltf/gltf_draco.h"
#include "read/gltf/gltf_material.h"
#include "read/gltf/gltf_mesh.h"
#include "read/gltf/gltf_node.h"
#include "read/gltf/gltf_value.h"
#include "read/mesh_finish.h"
#include "scene/lamp.h"
#include "scene/scene.h"
#include "kernels/types.h"

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

/* ---- the unit of lights ---- */

/*
 * KHR_lights_punctual has candela and lux, which few programs write. Blender's
 * exporter has three modes since version 3.4: Standard (683 lm for a watt),
 * Unitless and Raw (watts); earlier ones write watts. Files do not say which
 * mode they have: people's powers are round numbers, so that the unit is the
 * one in which the powers are round.
 */

/* First version of Blender's exporter that has modes. */
#define MODES_MAJOR 3
#define MODES_MINOR 4

/* Relative errors of powers: of the floats that Blender has, and of those files
 * that have six digits of an intensity at most. */
#define FLOAT_ERROR  1e-7
#define SHORT_ERROR  1e-5
#define SHORT_DIGITS 6

/* Digits of round powers. A number is round by chance with a probability of
 * about its error times 10 to the power of the digits, for each unit: one in a
 * hundred is certain enough, and more than one in ten tells nothing. */
#define DIGITS_MAX  6
#define CHANCE_SURE 0.011
#define CHANCE_MAX  0.11

/* Units in the order in which they are guessed: Blender's default first. */
static const enum light_unit units[] = {LIGHT_UNIT_LUMEN, LIGHT_UNIT_NONE,
                                        LIGHT_UNIT_WATT};
#define UNITS (sizeof units / sizeof units[0])

/* Reads the version behind the name, such as "Khronos glTF Blender I/O
 * v4.0.44". */
static bool read_version(const char *name, uint64_t *major, uint64_t *minor)
{
    const char *p = strstr(name, " v");

    if (p == NULL)
        return false;
    p += 2;
    if (!digits_parse(&p, 10, 1000, major) || *p != '.')
        return false;
    p++;
    return digits_parse(&p, 10, 1000, minor);
}

/* Returns true if the number has this many digits at most, but for an error. */
static bool is_round(double number, int digits, double error)
{
    double scaled = number * pow(10, digits - 1 - floor(log10(number) + error));

    return fabs(scaled - round(scaled)) <= error * scaled;
}

/* Returns the probability that the powers of all lights would be round in any
 * unit, 0 if no light shines, or 1 if they are not round in this one. Lights
 * may be copies of one, so the least probability counts. *has_lamp is set if
 * one is not directional. */
static double chance_of_powers(const json_t *lights, enum light_unit unit,
                               int digits, bool *has_lamp)
{
    double chance = 1;
    bool is_there = false;
    const json_t *light;
    size_t i;

    json_array_foreach (lights, i, light) {
        const json_t *v = json_object_get(light, "intensity");
        const char *type = json_string_value(json_object_get(light, "type"));
        double intensity = v != NULL ? json_number_value(v) : 1;
        bool is_sun = type != NULL && strcmp(type, "directional") == 0;
        double power = intensity * light_unit_factor(unit, is_sun);
        double error;

        if (!(power > 0 && power < 1e30))
            continue;
        error = is_round(intensity, SHORT_DIGITS, DBL_EPSILON) ? SHORT_ERROR
                                                               : FLOAT_ERROR;
        if (!is_round(is_sun ? power : power * 4 * M_PI, digits, error))
            return 1;
        chance = fmin(chance, error * pow(10, digits));
        is_there = true;
        *has_lamp |= !is_sun;
    }
    return is_there ? chance : 0;
}

/* Finds the unit in which the powers have the fewest digits. */
static enum light_unit unit_of_powers(const json_t *lights,
                                      enum light_unit otherwise,
                                      bool *is_guessed)
{
    *is_guessed = true;
    for (int digits = 1; digits <= DIGITS_MAX; digits++) {
        enum light_unit found = LIGHT_UNIT_OF_FILE;
        double chance = 1;
        int count = 0;

        for (size_t i = 0; i < UNITS; i++) {
            bool has_lamp = false;
            double c = chance_of_powers(lights, units[i], digits, &has_lamp);

            if (c > CHANCE_MAX)
                continue;
            /* watts and no unit are the same for directional lights */
            count += units[i] != LIGHT_UNIT_WATT || has_lamp;
            if (found == LIGHT_UNIT_OF_FILE)
                found = units[i];
            chance = c;
        }
        if (found == LIGHT_UNIT_OF_FILE)
            continue;
        *is_guessed = chance > 0 && (count > 1 || chance > CHANCE_SURE);
        return found;
    }
    return otherwise;
}

/* Returns the unit; *is_guessed if neither version nor powers tell it. */
static enum light_unit gltf_light_unit(const struct gltf_document *document,
                                       bool *is_guessed)
{
    const char *name = strstr(gltf_generator(document), "Blender");
    uint64_t major, minor;
    bool has_version;

    *is_guessed = false;
    if (name == NULL)
        return LIGHT_UNIT_NONE;
    has_version = read_version(name, &major, &minor);
    if (has_version &&
        (major < MODES_MAJOR || (major == MODES_MAJOR && minor < MODES_MINOR)))
        return LIGHT_UNIT_WATT;
    return unit_of_powers(gltf_lights(document),
                          has_version ? LIGHT_UNIT_LUMEN : LIGHT_UNIT_WATT,
                          is_guessed);
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

/* Adds the cameras and lights of the visible nodes to the scene, after
 * gltf_nodes_place(). Cameras look at a point at distance 1. */
static bool gltf_view_read(const struct gltf_document *document,
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

/* ---- the whole ---- */

/* Reads the nodes, poses them and lists those of the chosen scene. */
static bool place_nodes(const struct gltf_document *document,
                        const struct scene_choice *choice,
                        struct gltf_nodes *nodes, struct error *err)
{
    uint32_t scene = NO_INDEX, animation = 0;
    bool is_animated = choice->has_time || choice->animation != NULL;

    if (choice->scene != NULL &&
        !gltf_find(document, "scenes", "scene", choice->scene, &scene, err))
        return false;
    if (is_animated &&
        !gltf_find(document, "animations", "animation",
                   choice->animation != NULL ? choice->animation : "1",
                   &animation, err))
        return false;
    return gltf_nodes_read(document, nodes, err) &&
           (!is_animated || gltf_animation_pose(document, animation,
                                                choice->time_s, nodes, err)) &&
           gltf_nodes_place(document, scene, nodes, err);
}

/* Gives the scene the names of the files of its buffers. */
static bool take_paths(struct gltf_document *document, struct scene *scene,
                       struct error *err)
{
    scene->data_paths =
        alloc_array(document->file_count, sizeof *scene->data_paths);
    if (scene->data_paths == NULL)
        return fail(err, "%s: out of memory for its buffers", scene->path);
    for (size_t i = 0; i < document->file_count; i++) {
        scene->data_paths[scene->data_path_count++] = document->files[i].path;
        document->files[i].path = NULL;
    }
    return true;
}

static bool hint(const struct gltf_document *document,
                 const struct scene *scene, struct warnings *report)
{
    gltf_materials_hint(document, scene, report);
    return true;
}

bool gltf_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err)
{
    struct gltf_document document = {.path = path, .memory = &scene->memory};
    struct gltf_nodes nodes = {.count = 0};
    bool ok =
        mesh_begin(scene, path, err) &&
        gltf_document_open(&document, bytes, size_bytes, path, report, err) &&
        take_paths(&document, scene, err) &&
        gltf_draco_unpack(&document, scene->program, err) &&
        mesh_mtl_begin(scene, "", report, err) &&
        gltf_materials_read(&document, scene, report, err) &&
        mesh_mtl_read(scene, report, err) && hint(&document, scene, report) &&
        place_nodes(&document, &scene->choice, &nodes, err) &&
        gltf_view_read(&document, &nodes, scene, report, err) &&
        gltf_meshes_add(&document, &nodes, scene, report, err);

    gltf_nodes_free(&nodes);
    gltf_document_close(&document);
    return ok;
}
