// SPDX-License-Identifier: MIT
#include "studio/presets.h"

#include <math.h>

#include "base/decimal.h"
#include "base/geometry.h"
#include "scene/material.h"
#include "studio/medium_parameters.h"

/* ---- substances ---- */

/* Coefficients of milk, skin and marble: Jensen et al. 2001, "A practical model
 * for subsurface light transport", per millimetre, reduced, so that scattering
 * is isotropic. Those of wax and jade are estimates. */
/* clang-format off */
static const struct substance substances[] = {
    {"milk", 1.34, 0, 0, 40, {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
    {"skin", 1.4, 0, 0.4, 40, {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},
    {"marble", 1.5, 0, 0.2, 30, {2.19, 2.62, 3}, {0.0021, 0.0041, 0.0071}},
    {"wax", 1.44, 0, 0.35, 20, {1.5, 1.4, 1.1}, {0.001, 0.008, 0.04}},
    {"jade", 1.61, 0, 0.15, 12, {1, 1.2, 1}, {0.14, 0.012, 0.08}},
    {.name = "water", .ior = 1.333, .abbe = 55.7},
    {.name = "crown glass", .ior = 1.52, .abbe = 64},
    {.name = "flint glass", .ior = 1.62, .abbe = 36},
    {.name = "diamond", .ior = 2.42, .abbe = 44.3},
};
/* clang-format on */

#define SUBSTANCES (sizeof substances / sizeof substances[0])

const struct substance *substance_at(uint32_t i)
{
    return i >= 1 && i <= SUBSTANCES ? &substances[i - 1] : NULL;
}

double body_size(const struct selection *s)
{
    const struct scene *scene = s->scene;
    const uint32_t *assigned = s->edit->now.assigned;
    uint32_t object = NO_INDEX;
    struct vec3 lo = {INFINITY, INFINITY, INFINITY}, hi = v3_scale(lo, -1);
    double size;

    for (uint32_t i = 0; i < scene->tri_count; i++) {
        const struct tri *t = &scene->tris[i];
        uint32_t of = scene->tri_objects[i];
        uint32_t material =
            assigned[of] != NO_INDEX ? assigned[of] : t->material;

        if (object == NO_INDEX && material == s->index[PAGE_MATERIALS])
            object = of;
        for (int k = 0; k < 3 && of == object; k++) {
            lo = v3_min(lo, scene->positions[t->v[k]]);
            hi = v3_max(hi, scene->positions[t->v[k]]);
        }
    }
    size = (double)v3_max_component(v3_sub(hi, lo));
    return (size > 0 ? size : 2) / scene->scale;
}

void substance_color(const struct substance *p, double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double albedo = p->scatter[c] / (p->scatter[c] + p->absorb[c]);

        rgb[c] = decimal_shortened((double)seen_color((float)albedo, 0));
    }
}

void substance_path(const struct substance *p, double width, double rgb[3])
{
    double most = 0;

    for (int c = 0; c < 3; c++)
        most = fmax(most, p->scatter[c] + p->absorb[c]);
    for (int c = 0; c < 3; c++)
        rgb[c] = decimal_shortened(width * most / p->depth /
                                   (p->scatter[c] + p->absorb[c]));
}

/* ---- fogs ---- */

/* Droplets scatter nearly straight on, particles of smoke also absorb. */
static const struct {
    const char *name;
    double depth; /* distance of what the eye looks at in mean free paths */
    struct fog medium;
} fogs[] = {
    {"off", 0, {{0, 0, 0}, {0, 0, 0}, 0, 0, 0}},
    {"fog", 0.7, {{1, 1, 1}, {0, 0, 0}, 0.8, 0, 0}},
    {"haze", 0.25, {{0.6, 0.78, 1}, {0, 0, 0}, 0.6, 0, 0}},
    {"smoke", 1, {{0.6, 0.62, 0.65}, {0.4, 0.38, 0.35}, 0.4, 0, 0}},
};

#define FOGS (uint32_t)(sizeof fogs / sizeof fogs[0])

uint32_t fog_find(const struct fog *f)
{
    uint32_t i = 0;

    while (i < FOGS && !medium_is_alike(*f, fogs[i].medium))
        i++;
    return i;
}

const char *fog_name(const struct owner *o, uint32_t i)
{
    if (i < FOGS)
        return fogs[i].name;
    if (i > FOGS)
        return NULL;
    return fog_find(&o->lighting.fog) == FOGS ? "other" : "";
}

/* The fog thins out with height, or no light of the sky would come through. */
struct fog fog_preset(uint32_t i, const struct selection *s)
{
    const struct pose *pose = &s->edit->now.view.pose;
    struct fog f = fogs[i].medium;
    double look[3], distance;

    if (!(fogs[i].depth > 0))
        return f;
    vec3d_sub(pose->at, pose->eye, look);
    distance = fmax(vec3d_length(look), 1e-3 / s->scene->scale);
    medium_set_density(&f, fogs[i].depth / distance);
    f.base = decimal_shortened(s->scene->bounds_lo[1]);
    f.falloff = decimal_shortened(distance);
    return f;
}
