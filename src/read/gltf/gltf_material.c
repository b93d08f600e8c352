// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/name_table.h"
#include "read/gltf/gltf_texture.h"
#include "read/gltf/gltf_value.h"
#include "read/mtl.h"
#include "read/scene_lists.h"
#include "scene/material_values.h"

/* Lines of statements only tell whether a file has them. */
#define LINE 1

/* Largest ratio of the widths of a highlight, that of aniso 1, and what aniso
 * multiplies: the inverse of the ratio is 1 - ANISO_SHARE aniso. */
#define STRETCH_MAX 10
#define ANISO_SHARE 0.9

/* The Abbe number of a dispersion of 1. */
#define DISPERSION_ABBE 20

/* Memory of a material with its statements; 3,300 were measured. */
#define MATERIAL_BYTES 4096

/* A material while it is read. */
struct reader {
    struct gltf_textures *textures;
    struct name_table *names; /* of the materials before */
    struct gltf_value v;      /* the material */
    struct gltf_value pbr;    /* its pbrMetallicRoughness */
    struct material_values source;
    struct error *err;
};

static const struct gltf_texture_use of_color = {NULL, false, CHANNEL_DEFAULT,
                                                 0};
static const struct gltf_texture_use of_red = {NULL, true, CHANNEL_RED, 0};
static const struct gltf_texture_use of_green = {NULL, true, CHANNEL_GREEN, 0};
static const struct gltf_texture_use of_blue = {NULL, true, CHANNEL_BLUE, 0};
static const struct gltf_texture_use of_alpha = {NULL, true, CHANNEL_ALPHA, 0};

/* ---- statements ---- */

static void set_number(struct mtl_number *to, double value)
{
    *to = (struct mtl_number){value, LINE};
}

static void set_unit(struct mtl_number *to, double value)
{
    set_number(to, statement_clamped(value));
}

static void set_color(struct mtl_color *to, const double rgb[3])
{
    to->line = LINE;
    for (int i = 0; i < 3; i++)
        to->rgb[i] = statement_clamped(rgb[i]);
}

static bool is_black(const double rgb[3])
{
    return !(rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0);
}

static bool read_number(struct reader *r, const struct gltf_value *object,
                        const char *key, double *to)
{
    return gltf_number(object, key, -INFINITY, INFINITY, to, r->err);
}

static bool read_map(struct reader *r, const struct gltf_value *object,
                     const char *key, struct gltf_texture_use use,
                     enum mtl_map map)
{
    struct gltf_value info;

    use.key = key;
    return gltf_texture_read(r->textures, object, use, &r->source.maps[map],
                             &info, r->err);
}

static void warn(struct reader *r, const char *kind, const char *what)
{
    warnings_add(r->textures->report, kind, "%s: found %s", r->v.document->path,
                 what);
}

/* ---- the core ---- */

/* Reads the base colour. `alpha_flag` is TEXTURE_OPAQUE if its alpha is
 * ignored. The map of a black colour would be taken as a white one. */
static bool read_base(struct reader *r, const struct gltf_value *object,
                      const char *factor, const char *texture,
                      uint32_t alpha_flag)
{
    struct gltf_texture_use use = of_color;
    double color[4] = {1, 1, 1, 1};
    struct material_values *s = &r->source;

    use.flags = alpha_flag;
    if (!gltf_numbers(object, factor, 4, color, r->err) ||
        !read_map(r, object, texture, use, MTL_MAP_COLOR))
        return false;
    set_color(&s->base_color, color);
    if (is_black(color))
        s->maps[MTL_MAP_COLOR] = NO_INDEX;
    if (alpha_flag == 0 && color[3] < 1)
        set_unit(&s->opacity, color[3]);
    return alpha_flag != 0 || !is_black(color) ||
           read_map(r, object, texture, of_alpha, MTL_MAP_OPACITY);
}

static bool read_metal_and_roughness(struct reader *r)
{
    struct material_values *s = &r->source;
    double metal = 1, roughness = 1;

    if (!read_number(r, &r->pbr, "metallicFactor", &metal) ||
        !read_number(r, &r->pbr, "roughnessFactor", &roughness))
        return false;
    set_unit(&s->metalness, metal);
    set_unit(&s->roughness, roughness);
    if (s->metalness.value > 0 &&
        !read_map(r, &r->pbr, "metallicRoughnessTexture", of_blue,
                  MTL_MAP_METALNESS))
        return false;
    return !(s->roughness.value > 0) ||
           read_map(r, &r->pbr, "metallicRoughnessTexture", of_green,
                    MTL_MAP_ROUGHNESS);
}

/* Reads a map of normals, a member of *v, with its scale. */
static bool read_normals(struct reader *r, const struct gltf_value *v,
                         const char *key, enum mtl_map map)
{
    struct gltf_texture_use use = of_alpha;
    struct gltf_value info;
    double scale = 1;

    use.key = key;
    if (!gltf_texture_read(r->textures, v, use, &r->source.maps[map], &info,
                           r->err) ||
        !read_number(r, &info, "scale", &scale))
        return false;
    *material_values_map_scale(&r->source, map) = fmin(fmax(scale, -1e3), 1e3);
    return true;
}

static bool read_emission(struct reader *r)
{
    double color[3] = {0, 0, 0}, strength = 1;
    struct gltf_value v;

    if (!gltf_numbers(&r->v, "emissiveFactor", 3, color, r->err) ||
        !gltf_extension(&r->v, "KHR_materials_emissive_strength", &v, r->err) ||
        !read_number(r, &v, "emissiveStrength", &strength))
        return false;
    if (is_black(color) || !(strength > 0))
        return true;
    r->source.emission.line = LINE;
    for (int i = 0; i < 3; i++)
        r->source.emission.rgb[i] = fmin(fmax(color[i], 0) * strength, 1e30);
    return read_map(r, &r->v, "emissiveTexture", of_color, MTL_MAP_EMISSION);
}

/* Reads alphaMode. *flag becomes TEXTURE_OPAQUE if alpha is ignored. A cutoff
 * of 0 leaves all of the surface, and one above 1 nothing. */
static bool read_alpha_mode(struct reader *r, uint32_t *flag)
{
    const char *mode = "OPAQUE";
    double cutoff = 0.5;

    if (!gltf_string(&r->v, "alphaMode", &mode, r->err) ||
        !read_number(r, &r->v, "alphaCutoff", &cutoff))
        return false;
    *flag = 0;
    if (strcmp(mode, "MASK") == 0 && cutoff > 1)
        set_number(&r->source.opacity, 0);
    else if (strcmp(mode, "MASK") == 0 && cutoff > 0)
        set_number(&r->source.cutoff, cutoff);
    else if (strcmp(mode, "BLEND") != 0)
        *flag = TEXTURE_OPAQUE;
    return true;
}

/* ---- reflectance of dielectrics ---- */

/* Sets Ks and Ks_full for a reflectance at normal incidence. Ks is rounded to
 * what is worth writing. */
static void set_specular(struct material_values *s, const double f0[3])
{
    double top = fmax(f0[0], fmax(f0[1], f0[2]));
    double full = (double)MATERIAL_SPECULAR;

    if (top > full)
        set_unit(&s->specular_scale, top);
    if (top > full)
        full = s->specular_scale.value;
    s->specular_color.line = LINE;
    for (int i = 0; i < 3; i++)
        s->specular_color.rgb[i] =
            statement_clamped(round(fmax(f0[i], 0) / full * 1e6) * 1e-6);
}

/* Reads KHR_materials_ior and KHR_materials_specular. */
static bool read_specular(struct reader *r)
{
    double ior = 1.5, weight = 1, color[3] = {1, 1, 1}, f0[3], r0;
    struct gltf_value at, specular;

    if (!gltf_extension(&r->v, "KHR_materials_ior", &at, r->err) ||
        !read_number(r, &at, "ior", &ior) ||
        !gltf_extension(&r->v, "KHR_materials_specular", &specular, r->err) ||
        !read_number(r, &specular, "specularFactor", &weight) ||
        !gltf_numbers(&specular, "specularColorFactor", 3, color, r->err))
        return false;
    ior = ior == 0 ? 1e6 : fmin(fmax(ior, 1), 1e6); /* 0 means infinite */
    if (at.json != NULL)
        set_number(&r->source.ior, ior);
    r0 = (ior - 1) / (ior + 1);
    for (int i = 0; i < 3; i++)
        f0[i] =
            fmin(r0 * r0 * fmax(color[i], 0), 1) * statement_clamped(weight);
    set_specular(&r->source, f0);
    if (is_black(f0))
        return true;
    return read_map(r, &specular, "specularTexture", of_alpha,
                    MTL_MAP_SPECULAR_WEIGHT) &&
           read_map(r, &specular, "specularColorTexture", of_color,
                    MTL_MAP_SPECULAR);
}

/* Reads KHR_materials_pbrSpecularGlossiness in place of
 * pbrMetallicRoughness. */
static bool read_glossiness(struct reader *r, const struct gltf_value *v,
                            uint32_t alpha_flag)
{
    double f0[3] = {1, 1, 1}, gloss = 1;
    struct gltf_texture_use use = of_color;

    use.flags = TEXTURE_OPAQUE;
    if (!read_base(r, v, "diffuseFactor", "diffuseTexture", alpha_flag) ||
        !gltf_numbers(v, "specularFactor", 3, f0, r->err) ||
        !read_number(r, v, "glossinessFactor", &gloss))
        return false;
    set_unit(&r->source.roughness, 1 - gloss);
    set_specular(&r->source, f0);
    if (is_black(f0))
        return true;
    if (!read_map(r, v, "specularGlossinessTexture", use, MTL_MAP_SPECULAR))
        return false;
    if (r->source.maps[MTL_MAP_SPECULAR] != NO_INDEX)
        warn(r, "maps of glossiness",
             "KHR_materials_pbrSpecularGlossiness: the alpha channel of its "
             "texture is not used");
    return true;
}

/* ---- layers ---- */

/* What is in a body, or in a thin wall. */
struct inside {
    bool is_thick;
    double distance, tint[3];          /* of attenuation */
    double color[3], strength, cosine; /* of scattering */
    bool may_be_thin;                  /* the draft has thin walls */
    bool has_maps;                     /* of scattering */
};

/* Reads scattering: that of KHR_materials_scatter, else of
 * KHR_materials_volume_scatter, the draft before it. Both spellings of the
 * color are in use. The strength is 0 without either. */
static bool read_scatter(struct reader *r, struct inside *in)
{
    struct gltf_value v, older;

    if (!gltf_extension(&r->v, "KHR_materials_scatter", &v, r->err) ||
        !gltf_extension(&r->v, "KHR_materials_volume_scatter", &older, r->err))
        return false;
    in->may_be_thin = v.json != NULL;
    in->strength = v.json == NULL;
    for (int i = 0; i < 3; i++)
        in->color[i] = v.json != NULL;
    if (v.json == NULL)
        v = older;
    if (!read_number(r, &v, "scatterStrengthFactor", &in->strength) ||
        !gltf_numbers(&v, "multiscatterColor", 3, in->color, r->err) ||
        !gltf_numbers(&v, "multiscatterColorFactor", 3, in->color, r->err) ||
        !read_number(r, &v, "scatterAnisotropy", &in->cosine))
        return false;
    in->strength = statement_clamped(in->strength);
    if (is_black(in->color))
        in->strength = 0;
    for (int i = 0; i < 3; i++)
        in->color[i] = fmin(fmax(in->color[i], 0), 1);
    in->cosine = fmin(fmax(in->cosine, -1), 1);
    in->has_maps =
        json_object_get(v.json, "multiscatterColorTexture") != NULL ||
        json_object_get(v.json, "scatterStrengthTexture") != NULL;
    return true;
}

static bool read_inside(struct reader *r, struct inside *in)
{
    double thickness = 0;
    struct gltf_value v;

    *in = (struct inside){.distance = INFINITY, .tint = {1, 1, 1}};
    if (!gltf_extension(&r->v, "KHR_materials_volume", &v, r->err) ||
        !read_number(r, &v, "thicknessFactor", &thickness) ||
        !read_number(r, &v, "attenuationDistance", &in->distance) ||
        !gltf_numbers(&v, "attenuationColor", 3, in->tint, r->err))
        return false;
    in->is_thick = thickness > 0;
    return read_scatter(r, in);
}

/* Says that scattering has no place in this material. */
static void warn_of_scatter(struct reader *r, const struct inside *in)
{
    if (in->strength > 0)
        warn(r, "media without a body",
             "scattering without KHR_materials_transmission and a thick "
             "KHR_materials_volume: ignored");
}

static void warn_of_scatter_maps(struct reader *r, const struct inside *in)
{
    if (in->strength > 0 && in->has_maps)
        warn(r, "maps of media", "textures of scattering: not used");
}

/* Sets the inside of a solid: what it absorbs and scatters. Its attenuation is
 * the extinction, of which a part scatters. */
static void set_solid(struct reader *r, const struct inside *in)
{
    struct material_values *s = &r->source;
    double color[3];

    warn_of_scatter_maps(r, in);
    if (!(in->distance > 0 && in->distance < (double)INFINITY))
        return;
    set_number(&s->attenuation_distance, in->distance);
    set_color(&s->attenuation, in->tint);
    if (!(in->strength > 0))
        return;
    for (int i = 0; i < 3; i++)
        color[i] = in->color[i] * in->strength;
    set_color(&s->medium_color, color);
    if (in->cosine != 0)
        set_number(&s->medium_anisotropy, in->cosine);
}

/* Makes a part of what goes through a thin wall diffuse: the strength is its
 * share. It has the color of scattering to both sides, and (1 + cosine) / 2 of
 * it goes on. What is opaque has the base color, so that reflection has a mean
 * of both. Returns the rest of the weight. */
static double scatter_in_wall(struct reader *r, const struct inside *in,
                              double weight)
{
    struct material_values *s = &r->source;
    double rest = statement_clamped(weight) * (1 - in->strength);
    double share =
        rest < 1 ? (statement_clamped(weight) - rest) / (1 - rest) : 0;
    double behind = share * (1 + in->cosine) / 2;
    double color[3];

    warn_of_scatter_maps(r, in);
    if (!(share > 0))
        return rest;
    for (int i = 0; i < 3; i++)
        color[i] = behind < 1 ? ((1 - share) * s->base_color.rgb[i] +
                                 (share - behind) * in->color[i]) /
                                    (1 - behind)
                              : in->color[i];
    set_color(&s->base_color, color);
    set_unit(&s->translucency, behind);
    set_color(&s->back_color, in->color);
    return rest;
}

static bool read_dispersion(struct reader *r)
{
    double dispersion = 0;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_dispersion", &v, r->err) ||
        !read_number(r, &v, "dispersion", &dispersion))
        return false;
    if (dispersion > 0)
        set_number(&r->source.abbe, DISPERSION_ABBE / dispersion);
    return true;
}

static bool read_transmission(struct reader *r, const struct inside *in)
{
    struct material_values *s = &r->source;
    bool is_wall = !in->is_thick && in->may_be_thin && in->strength > 0;
    double weight = 0;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_transmission", &v, r->err) ||
        !read_number(r, &v, "transmissionFactor", &weight))
        return false;
    if (!(weight > 0))
        return true;
    if (is_wall)
        weight = scatter_in_wall(r, in, weight);
    else if (!in->is_thick)
        warn_of_scatter(r, in);
    if (!(weight > 0))
        return read_map(r, &v, "transmissionTexture", of_red,
                        MTL_MAP_TRANSLUCENCY);
    set_color(&s->transmission, (const double[3]){weight, weight, weight});
    if (in->is_thick)
        set_solid(r, in);
    else
        set_number(&s->thinness, 1);
    return (!in->is_thick || read_dispersion(r)) &&
           read_map(r, &v, "transmissionTexture", of_red, MTL_MAP_TRANSMISSION);
}

/* Longest mean free path: that of channels that nothing takes light from. */
#define PATH_MAX 1e30

/* Returns true if there is a medium, and its mean free paths. */
static bool mean_paths(const struct inside *in, double path[3])
{
    bool is_there = false;

    for (int i = 0; i < 3; i++) {
        double depth = log(1 / fmin(fmax(in->tint[i], 1e-30), 1));

        path[i] = fmin(in->distance / depth, PATH_MAX);
        is_there = is_there || path[i] < PATH_MAX;
    }
    return in->distance > 0 && is_there;
}

/* Sets a medium behind diffuse transmission: light below the surface, whose
 * color is that of scattering after two ways through the surface. What is
 * reflected has the base color, and a thick body the mean of both. v: the
 * extension of diffuse transmission, with its weight and color. */
static bool set_below(struct reader *r, const struct inside *in,
                      const struct gltf_value *v, double weight,
                      const double through[3])
{
    struct material_values *s = &r->source;
    double share = statement_clamped(weight), color[3];

    s->subsurface_path.line = LINE;
    mean_paths(in, s->subsurface_path.rgb);
    warn_of_scatter_maps(r, in);
    for (int i = 0; i < 3; i++) {
        double t = fmin(fmax(through[i], 0), 1);

        color[i] = (1 - share) * s->base_color.rgb[i] +
                   share * in->color[i] * in->strength * t * t;
    }
    set_color(&s->base_color, color);
    set_unit(&s->subsurface, share);
    if (in->cosine != 0)
        set_number(&s->subsurface_anisotropy, in->cosine);
    if (s->maps[MTL_MAP_COLOR] != NO_INDEX)
        warn(r, "maps of colors below surfaces",
             "baseColorTexture, which also multiplies the color of scattering "
             "behind KHR_materials_diffuse_transmission");
    else if (!read_map(r, v, "diffuseTransmissionColorTexture", of_color,
                       MTL_MAP_COLOR))
        return false;
    return read_map(r, v, "diffuseTransmissionTexture", of_alpha,
                    MTL_MAP_SUBSURFACE);
}

static bool read_diffuse_transmission(struct reader *r, const struct inside *in)
{
    struct material_values *s = &r->source;
    double weight = 0, color[3] = {1, 1, 1}, path[3];
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_diffuse_transmission", &v,
                        r->err) ||
        !read_number(r, &v, "diffuseTransmissionFactor", &weight) ||
        !gltf_numbers(&v, "diffuseTransmissionColorFactor", 3, color, r->err))
        return false;
    if (s->transmission.line == 0 && s->translucency.line == 0 &&
        !(weight > 0 && in->is_thick))
        warn_of_scatter(r, in);
    if (!(weight > 0))
        return true;
    if (s->transmission.line == 0 && in->is_thick && in->strength > 0 &&
        mean_paths(in, path))
        return set_below(r, in, &v, weight, color);
    set_unit(&s->translucency, weight);
    set_color(&s->back_color, color);
    return read_map(r, &v, "diffuseTransmissionTexture", of_alpha,
                    MTL_MAP_TRANSLUCENCY) &&
           read_map(r, &v, "diffuseTransmissionColorTexture", of_color,
                    MTL_MAP_BACK_COLOR);
}

static bool read_coat(struct reader *r)
{
    struct material_values *s = &r->source;
    double weight = 0, roughness = 0;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_clearcoat", &v, r->err) ||
        !read_number(r, &v, "clearcoatFactor", &weight) ||
        !read_number(r, &v, "clearcoatRoughnessFactor", &roughness))
        return false;
    if (!(weight > 0))
        return true;
    set_unit(&s->coat, weight);
    set_unit(&s->coat_roughness, roughness);
    return read_map(r, &v, "clearcoatTexture", of_red, MTL_MAP_COAT) &&
           (!(roughness > 0) || read_map(r, &v, "clearcoatRoughnessTexture",
                                         of_green, MTL_MAP_COAT_ROUGHNESS)) &&
           read_normals(r, &v, "clearcoatNormalTexture", MTL_MAP_COAT_NORMAL);
}

static bool read_sheen(struct reader *r)
{
    struct material_values *s = &r->source;
    double color[3] = {0, 0, 0}, roughness = 0;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_sheen", &v, r->err) ||
        !gltf_numbers(&v, "sheenColorFactor", 3, color, r->err) ||
        !read_number(r, &v, "sheenRoughnessFactor", &roughness))
        return false;
    if (is_black(color))
        return true;
    set_number(&s->sheen, 1);
    set_color(&s->sheen_color, color);
    set_unit(&s->sheen_roughness, roughness);
    return read_map(r, &v, "sheenColorTexture", of_color,
                    MTL_MAP_SHEEN_COLOR) &&
           read_map(r, &v, "sheenRoughnessTexture", of_alpha,
                    MTL_MAP_SHEEN_ROUGHNESS);
}

/* glTF widens highlights along the grain from a to a + (1 - a) s^2, up to any
 * ratio; aniso keeps the geometric mean of the widths, which Pr has. */
static void stretch(struct material_values *s, double strength)
{
    double a = s->roughness.value * s->roughness.value;
    double along = a + (1 - a) * strength * strength;
    double across = fmax(a, along / STRETCH_MAX);

    set_unit(&s->roughness, sqrt(sqrt(along * across)));
    set_unit(&s->anisotropy, (1 - across / along) / ANISO_SHARE);
}

static bool read_anisotropy(struct reader *r)
{
    double strength = 0, angle = 0;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_anisotropy", &v, r->err) ||
        !read_number(r, &v, "anisotropyStrength", &strength) ||
        !read_number(r, &v, "anisotropyRotation", &angle))
        return false;
    if (!(strength > 0))
        return true;
    stretch(&r->source, fmin(strength, 1));
    if (angle != 0)
        set_number(&r->source.anisotropy_rotation, angle / (2 * M_PI));
    return read_map(r, &v, "anisotropyTexture", of_alpha, MTL_MAP_GRAIN);
}

static bool read_film(struct reader *r)
{
    struct material_values *s = &r->source;
    double weight = 0, ior = 1.3, least = 100, most = 400;
    struct gltf_value v;

    if (!gltf_extension(&r->v, "KHR_materials_iridescence", &v, r->err) ||
        !read_number(r, &v, "iridescenceFactor", &weight) ||
        !read_number(r, &v, "iridescenceIor", &ior) ||
        !read_number(r, &v, "iridescenceThicknessMinimum", &least) ||
        !read_number(r, &v, "iridescenceThicknessMaximum", &most))
        return false;
    if (!(weight > 0))
        return true;
    set_unit(&s->film, weight);
    set_number(&s->film_ior, fmin(fmax(ior, 1), MATERIAL_FILM_IOR_MAX));
    set_number(&s->film_thickness,
               fmin(fmax(most, 0), MATERIAL_FILM_THICKNESS_MAX));
    if (!read_map(r, &v, "iridescenceTexture", of_red, MTL_MAP_FILM) ||
        !read_map(r, &v, "iridescenceThicknessTexture", of_green,
                  MTL_MAP_FILM_THICKNESS))
        return false;
    if (s->maps[MTL_MAP_FILM_THICKNESS] != NO_INDEX)
        set_number(&s->film_thinnest,
                   fmin(fmax(least, 0), MATERIAL_FILM_THICKNESS_MAX));
    return true;
}

/* ---- whole materials ---- */

/* Makes a surface without light: it shines with its base colour. Where alpha
 * counts, map_d has it. */
static bool make_unlit(struct reader *r, uint32_t alpha_flag)
{
    struct material_values *s = &r->source;

    s->emission = s->base_color;
    s->maps[MTL_MAP_EMISSION] = s->maps[MTL_MAP_COLOR];
    s->maps[MTL_MAP_COLOR] = NO_INDEX;
    set_color(&s->base_color, (const double[3]){0, 0, 0});
    return alpha_flag != 0 ||
           read_map(r, &r->pbr, "baseColorTexture", of_alpha, MTL_MAP_OPACITY);
}

static bool read_layers(struct reader *r)
{
    struct inside in;

    return read_inside(r, &in) && read_transmission(r, &in) &&
           read_diffuse_transmission(r, &in) && read_coat(r) && read_sheen(r) &&
           read_anisotropy(r) && read_film(r);
}

static bool read_statements(struct reader *r)
{
    struct gltf_value unlit, gloss;
    uint32_t alpha_flag;

    if (!gltf_object(&r->v, "pbrMetallicRoughness", &r->pbr, r->err) ||
        !gltf_extension(&r->v, "KHR_materials_unlit", &unlit, r->err) ||
        !gltf_extension(&r->v, "KHR_materials_pbrSpecularGlossiness", &gloss,
                        r->err) ||
        !read_alpha_mode(r, &alpha_flag))
        return false;
    if (unlit.json != NULL)
        return read_base(r, &r->pbr, "baseColorFactor", "baseColorTexture",
                         alpha_flag) &&
               make_unlit(r, alpha_flag);
    if (gloss.json != NULL)
        return read_glossiness(r, &gloss, alpha_flag) &&
               read_normals(r, &r->v, "normalTexture", MTL_MAP_NORMAL) &&
               read_emission(r);
    return read_base(r, &r->pbr, "baseColorFactor", "baseColorTexture",
                     alpha_flag) &&
           read_metal_and_roughness(r) && read_specular(r) &&
           read_normals(r, &r->v, "normalTexture", MTL_MAP_NORMAL) &&
           read_emission(r) && read_layers(r);
}

/* Returns a name that no material before has, for free(). */
static char *unique_name(struct name_table *names, const char *name, size_t i)
{
    bool is_new = *name != '\0' && name_table_find(names, name) == NO_NAME;
    char *unique = is_new ? strdup(name) : format_text("%s#%zu", name, i);

    if (unique == NULL || name_table_add(names, unique) != NO_NAME)
        return unique;
    free(unique);
    return NULL;
}

/* Adds the material that r->v has. */
static bool add_material(struct reader *r, size_t i, size_t *capacity)
{
    struct gltf_textures *t = r->textures;
    struct material_origin origin = {.file = 0};
    const char *name = "";
    struct material m;
    char *unique;
    bool ok;

    if (!gltf_string(&r->v, "name", &name, r->err) || !read_statements(r))
        return false;
    origin.source = r->source;
    m = material_from_source(&origin.source, t->document->path, t->report);
    unique = unique_name(r->names, name, i);
    ok = unique != NULL &&
         scene_add_material(t->scene, capacity, unique, &m, &origin);
    free(unique);
    return ok || fail(r->err, "%s: out of memory for the materials",
                      t->document->path);
}

static bool read_material(struct reader *r, size_t i, size_t *capacity)
{
    r->source = material_values_empty();
    return gltf_entry(r->textures->document, "materials", i, &r->v, r->err) &&
           add_material(r, i, capacity);
}

/* Returns true if a primitive has no material. */
static bool needs_default(const struct gltf_document *d)
{
    const json_t *meshes = json_object_get(d->root, "meshes");
    const json_t *mesh, *primitive;
    size_t i, k;

    json_array_foreach (meshes, i, mesh) {
        json_array_foreach (json_object_get(mesh, "primitives"), k, primitive) {
            if (json_object_get(primitive, "material") == NULL)
                return true;
        }
    }
    return false;
}

/* Adds the specification's default material, which is that of {}. */
static bool add_default(struct reader *r, size_t count, size_t *capacity)
{
    const struct gltf_document *document = r->textures->document;
    json_t *empty = json_pack("{ss}", "name", "default");
    bool ok;

    if (empty == NULL)
        return fail(r->err, "%s: out of memory for the materials",
                    document->path);
    r->source = material_values_empty();
    r->v = gltf_root(document);
    r->v.json = empty;
    ok = add_material(r, count, capacity);
    json_decref(empty);
    return ok;
}

void gltf_materials_hint(const struct gltf_document *document,
                         const struct scene *scene, struct warnings *report)
{
    size_t count = gltf_entry_count(document, "materials");

    if (strstr(gltf_generator(document), "Blender") == NULL)
        return;
    for (size_t i = 1; i <= count && i < scene->material_count; i++) {
        const struct material_values *s = &scene->material_origins[i].source;

        /* statements of edits are behind the first line of their file */
        if (s->thinness.line == LINE && s->thinness.value > 0)
            warnings_add(report, "materials of thin glass",
                         "%s: found '%.80s', glass without a volume, which is "
                         "a thin shell: for solid glass set 'glass is' to "
                         "glass in the panel (Tf_thin 0), or a Thickness in "
                         "Blender's glTF Material Output",
                         document->path, scene->material_names[i]);
    }
}

bool gltf_material_has_alpha(const struct gltf_document *document,
                             uint32_t material, bool *does, struct error *err)
{
    const char *mode = "OPAQUE";
    struct gltf_value v;

    if (!gltf_entry(document, "materials", material, &v, err) ||
        !gltf_string(&v, "alphaMode", &mode, err))
        return false;
    *does = strcmp(mode, "MASK") == 0 || strcmp(mode, "BLEND") == 0;
    return true;
}

bool gltf_materials_read(const struct gltf_document *document,
                         struct scene *scene, struct warnings *report,
                         struct error *err)
{
    struct gltf_textures textures = {.document = document};
    struct name_table names = {0};
    struct reader r = {.textures = &textures, .names = &names, .err = err};
    struct gltf_value root = gltf_root(document);
    size_t count = gltf_entry_count(document, "materials");
    size_t capacity = scene->material_count;
    bool ok = gltf_take(&root, count, MATERIAL_BYTES, "materials", err) &&
              gltf_textures_begin(&textures, document, scene, report, err);

    for (size_t i = 0; ok && i < count; i++)
        ok = read_material(&r, i, &capacity);
    if (ok && needs_default(document))
        ok = add_default(&r, count, &capacity);
    name_table_free(&names);
    gltf_textures_end(&textures);
    return ok;
}
