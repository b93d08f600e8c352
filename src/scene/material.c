// SPDX-License-Identifier: MIT
#include "scene/material.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "scene/material_values.h"
#include "kernels/bump.h"
#include "kernels/energy.h"
#include "kernels/light.h"
#include "kernels/medium.h"

/* ---- materials ---- */

/* Least Ns that gives a perfect mirror: exporters write 1000 for mirrors.
 * Blender writes 1000 times the square of 1 - roughness. */
#define NS_SMOOTH 1000

/* Roughness below which a surface cannot be distinguished from a Lambertian
 * one. */
#define ROUGH_MIN 1e-3

#define IOR_DEFAULT 1.5
#define IOR_MAX     1e6

#define NO_TEXTURE(name, member, ...) .member = NO_INDEX,
#define ADDRESS(name, member, ...)    &m->member,
#define NOTHING(...)

struct material material_default(void)
{
    struct material m = {
        .color = {MATERIAL_GREY, MATERIAL_GREY, MATERIAL_GREY},
        .ior = (float)IOR_DEFAULT,
        .kind = MATERIAL_DIFFUSE,
        .role = ROLE_MATTE,
        MATERIAL_MAP_LIST(NO_TEXTURE, NOTHING).bump_scale = 1,
        .coat_normal_strength = 1,
        .normal_strength = 1,
        .normal_depth = 1,
        .opacity = 1,
        .grain = {1, 0},
    };

    return m;
}

uint32_t *material_map(struct material *m, uint32_t number)
{
    uint32_t *const all[] = {MATERIAL_MAP_LIST(ADDRESS, NOTHING)};

    return all[number];
}

void material_maps(const struct material *material,
                   uint32_t maps[MATERIAL_MAPS])
{
    struct material m = *material;

    for (uint32_t i = 0; i < MATERIAL_MAPS; i++)
        maps[i] = *material_map(&m, i);
}

static bool is_of_blender(const struct material_values *s)
{
    return s->dialect != MTL_CLASSIC;
}

static double alpha(const struct material_values *s,
                    const struct statement_place *at)
{
    double ns = statement_within(&s->shininess, "Ns", 0, DBL_MAX, 0, at);

    if (s->roughness.line != 0) {
        double pr = statement_unit(&s->roughness, "Pr", at);

        return pr * pr;
    }
    if (is_of_blender(s) && s->shininess.line != 0) {
        double roughness = 1 - sqrt(fmin(ns, NS_SMOOTH) / NS_SMOOTH);

        return roughness * roughness;
    }
    return ns == 0 || ns >= NS_SMOOTH ? 0 : sqrt(2 / (ns + 2));
}

static void roughen(struct material *m, const struct material_values *s,
                    const struct statement_place *at)
{
    m->alpha = (float)alpha(s, at);
    m->alpha_texture = material_values_map(s, MTL_MAP_ROUGHNESS);
}

/* Returns the opacity of d, or without d that of Tr. A file that says Tr 1
 * alone means what MeshLab did, an opaque surface, and no one draws a scene
 * that is not to be seen: Blender does not read Tr. */
static double opacity(const struct material_values *s,
                      const struct statement_place *at)
{
    if (s->opacity.line != 0)
        return statement_within(&s->opacity, "d", 0, 1,
                                isnan(s->opacity.value)
                                    ? 1
                                    : statement_clamped(s->opacity.value),
                                at);
    if (s->transparency.value < 1)
        return 1 - statement_unit(&s->transparency, "Tr", at);
    warnings_add(at->report, "transparencies of 1",
                 "%s:%" PRIu64 ": found Tr %g without d, expected d 0 for an "
                 "invisible surface: read as opaque",
                 at->path, s->transparency.line, s->transparency.value);
    return 1;
}

static int illumination(const struct material_values *s,
                        const struct statement_place *at)
{
    double illum = statement_within(&s->illum, "illum", 0, 10, 2, at);

    return (int)illum;
}

static float index_of(const struct material_values *s,
                      const struct statement_place *at)
{
    return (float)statement_within(&s->ior, "Ni", 1 / IOR_MAX, IOR_MAX,
                                   IOR_DEFAULT, at);
}

/* Sets the index, and its dispersion where light is refracted by it. */
static void set_index(struct material *m, const struct material_values *s,
                      const struct statement_place *at)
{
    double abbe = statement_within(&s->abbe, "Ni_abbe", 0, DBL_MAX, 0, at);

    m->ior = index_of(s, at);
    if (abbe > 0 && m->ior > 1 &&
        (m->kind != MATERIAL_PRINCIPLED || m->transmission > 0))
        m->dispersion = (float)fmin(((double)m->ior - 1) / abbe, IOR_MAX);
}

/* Least share of light that is left after Tf_distance, so that absorption is
 * finite. */
#define TRANSMITTANCE_MIN 1e-30f

/* Returns the absorption of a channel of which `share` is left after a distance
 * d. */
static float absorption(float share, double d)
{
    return (float)fmin(-log((double)fmaxf(share, TRANSMITTANCE_MIN)) / d,
                       (double)FLT_MAX);
}

/* Returns true if the glass of a mixture is a thin sheet. */
static bool is_thin(const struct material_values *s,
                    const struct statement_place *at)
{
    return statement_unit(&s->thinness, "Tf_thin", at) > 0;
}

/* Largest coefficient of a medium, in units of the file or of the scene. */
#define COEFFICIENT_MAX 1e30f

/* Mean cosine of scattering that is nearest to straight on or back. */
#define ANISOTROPY_MAX 0.999

float medium_anisotropy(double cosine)
{
    return (float)fmax(fmin(cosine, ANISOTROPY_MAX), -ANISOTROPY_MAX);
}

struct medium medium_scaled(struct medium m, float factor)
{
    const struct vec3 most = {COEFFICIENT_MAX, COEFFICIENT_MAX,
                              COEFFICIENT_MAX};

    m.extinction = v3_min(v3_scale(m.extinction, factor), most);
    m.scattering = v3_min(v3_scale(m.scattering, factor), m.extinction);
    return m;
}

/* The square of the root in medium_albedo_of() is linear in the color after its
 * own terms of second order are gone: 17.7126 is 4.20863 squared. */
float seen_color(float albedo, float g)
{
    float a = 4.09712f - sqrtf((1 - albedo) / (1 - g * albedo));
    float color = (a * a - 9.59217f) / (41.6808f - 2 * 4.20863f * a);

    return fminf(fmaxf(color, 0), 1);
}

/* Returns the share of the extinction that is scattered. */
static struct vec3 medium_albedo(const struct material_values *s, float g,
                                 const struct statement_place *at)
{
    struct vec3 c;

    if (s->medium_color.line == 0)
        return statement_reflectance(&s->medium_albedo, "Tf_albedo", 0, at);
    c = statement_reflectance(&s->medium_color, "Tf_multiscatter", 0, at);
    return (struct vec3){medium_albedo_of(c.x, g), medium_albedo_of(c.y, g),
                         medium_albedo_of(c.z, g)};
}

/* Sets the medium of a solid: by its coefficients; or by the color that is left
 * of light after Tf_distance, tf or Tf_attenuation if that is present. Returns
 * true if it explains tf. */
static bool fill(struct material *m, struct vec3 tf,
                 const struct material_values *s,
                 const struct statement_place *at)
{
    double d = statement_within(&s->attenuation_distance, "Tf_distance", 0,
                                DBL_MAX, 0, at);
    double g =
        statement_within(&s->medium_anisotropy, "Tf_anisotropy", -1, 1, 0, at);
    struct medium *to = &m->medium;

    to->anisotropy = medium_anisotropy(g);
    if (s->medium_scatter.line != 0 || s->medium_absorb.line != 0) {
        to->scattering =
            statement_amounts(&s->medium_scatter, "Tf_scatter", at);
        to->extinction =
            v3_add(to->scattering,
                   statement_amounts(&s->medium_absorb, "Tf_absorb", at));
        *to = medium_scaled(*to, 1);
        return false;
    }
    if (d == 0)
        return false;
    if (s->attenuation.line != 0)
        tf = statement_reflectance(&s->attenuation, "Tf_attenuation", 1, at);
    to->extinction = (struct vec3){absorption(tf.x, d), absorption(tf.y, d),
                                   absorption(tf.z, d)};
    to->scattering =
        v3_mul(to->extinction, medium_albedo(s, to->anisotropy, at));
    *to = medium_scaled(*to, 1);
    return s->attenuation.line == 0;
}

static bool is_black(const struct vec3 *c)
{
    return c->x == 0 && c->y == 0 && c->z == 0;
}

static void make_glass(struct material *m, uint32_t kind,
                       const struct material_values *s,
                       const struct statement_place *at)
{
    m->kind = kind;
    m->color = statement_reflectance(&s->transmission, "Tf", 1, at);
    m->color_texture = material_values_map(s, MTL_MAP_COLOR);
    if (kind == MATERIAL_GLASS && fill(m, m->color, s, at))
        m->color = (struct vec3){1, 1, 1};
    if (is_black(&m->color) && m->color_texture != NO_INDEX)
        m->color = (struct vec3){1, 1, 1}; /* a factor of map_Kd, as Kd is */
    if (kind == MATERIAL_GLASS || s->roughness.line != 0)
        roughen(m, s, at);
    set_index(m, s, at);
}

/* Returns true if the statements ask for partial opacity. */
static bool is_partial(const struct material_values *s)
{
    double d =
        s->opacity.line != 0 ? s->opacity.value : 1 - s->transparency.value;

    /* other programs write d 0 beside illum 4 for clear glass */
    return material_values_map(s, MTL_MAP_OPACITY) != NO_INDEX ||
           (d < 1 && (d > 0 || is_of_blender(s)));
}

static bool is_white_or_absent(const struct mtl_color *c)
{
    return c->line == 0 || (c->rgb[0] == 1 && c->rgb[1] == 1 && c->rgb[2] == 1);
}

/* Returns true for illum 4 and 9 that mean a sheet of glass. With neither tint
 * nor refraction it would be invisible: then they mean an opaque surface, as
 * Maya writes it, or one of partial opacity. Blender writes illum 9 for all
 * materials of partial opacity. */
static bool is_sheet(const struct material_values *s, int illum)
{
    bool has_surface = s->transmission.line != 0 || s->base_color.line != 0 ||
                       s->specular_color.line != 0;

    if (illum != 4 && illum != 9)
        return false;
    if (is_of_blender(s) && illum == 9)
        return !is_partial(s);
    return !is_white_or_absent(&s->transmission) ||
           !(is_partial(s) ||
             (s->ior.line != 0 && s->ior.value == 1 && has_surface));
}

/* Returns true for illum 6 and 7 that mean solid glass. Blender writes 6 for
 * metals of partial opacity. */
static bool is_solid_glass(const struct material_values *s, int illum)
{
    return illum == 7 || (illum == 6 && !(is_of_blender(s) && is_partial(s)));
}

/* Returns the reflectance of plastic whose Ks is 1. From Blender 4.0 on, Ks 0.5
 * is the Fresnel reflectance of Ni. */
static float full_specular(const struct material_values *s,
                           const struct statement_place *at)
{
    float ni = index_of(s, at);
    float r = (ni - 1) / (ni + 1);

    if (s->specular_scale.line != 0)
        return (float)statement_unit(&s->specular_scale, "Ks_full", at);
    return s->dialect == MTL_BLENDER_4 ? 2 * r * r : MATERIAL_SPECULAR;
}

static void make_plastic(struct material *m, const struct vec3 *ks,
                         const struct material_values *s,
                         const struct statement_place *at)
{
    float full = full_specular(s, at);

    m->kind = MATERIAL_PLASTIC;
    m->specular = (struct vec3){fminf(ks->x * full, 1), fminf(ks->y * full, 1),
                                fminf(ks->z * full, 1)};
    m->specular_texture = material_values_map(s, MTL_MAP_SPECULAR);
    m->specular_weight_texture =
        material_values_map(s, MTL_MAP_SPECULAR_WEIGHT);
    roughen(m, s, at);
}

static void make_diffuse(struct material *m, const struct material_values *s,
                         const struct statement_place *at)
{
    double r = statement_unit(&s->diffuse_roughness, "Kd_roughness", at);

    if (r < ROUGH_MIN)
        return;
    m->kind = MATERIAL_ROUGH_DIFFUSE;
    m->alpha = (float)r;
}

/* Sets the diffuse transmission. */
static void set_translucency(struct material *m,
                             const struct material_values *s,
                             const struct statement_place *at)
{
    double weight = statement_unit(&s->translucency, "Td_weight", at);

    if (!(weight > 0))
        return;
    m->translucency = (float)weight;
    m->back_color = statement_reflectance(&s->back_color, "Td", 1, at);
    m->back_texture = material_values_map(s, MTL_MAP_BACK_COLOR);
    m->translucency_texture = material_values_map(s, MTL_MAP_TRANSLUCENCY);
}

/* Returns the weight of transmission, which Blender writes as a grey Tf. With
 * Tf_distance, it is the largest channel, and the rest is absorption. */
static double transmission(struct material *m, const struct material_values *s,
                           int illum, const struct statement_place *at)
{
    struct vec3 tf;
    float top;

    if (s->transmission.line == 0 || s->roughness.line == 0 ||
        (!is_of_blender(s) &&
         (s->roughness.line == MTL_IMPLIED || (illum != 2 && illum != 3))))
        return 0;
    m->transmission_texture = material_values_map(s, MTL_MAP_TRANSMISSION);
    tf = statement_reflectance(&s->transmission, "Tf", 1, at);
    top = v3_max_component(tf);
    m->is_thin = top > 0 && is_thin(s, at);
    if (top > 0 && m->is_thin == 0 && fill(m, v3_scale(tf, 1 / top), s, at))
        return (double)top;
    return (double)(tf.x + tf.y + tf.z) / 3;
}

/* Returns the weight of metal. Without the extension, Blender writes it as Ka,
 * which is 1 for other materials. */
static double metalness(const struct material_values *s, int illum,
                        const struct statement_place *at)
{
    double ka = s->ambient.line != 0 ? statement_clamped(s->ambient.rgb[0]) : 1;

    if (s->metalness.line != 0 || !is_of_blender(s))
        return statement_unit(&s->metalness, "Pm", at);
    if (illum == 3 || illum == 6)
        return ka;
    return illum == 1 && ka < 1 ? ka : 0; /* Ks is 0 */
}

/* Sets the film. One without thickness, or without a surface that reflects, has
 * no effect. */
static void set_film(struct material *m, bool has_facets,
                     const struct material_values *s,
                     const struct statement_place *at)
{
    double weight = statement_unit(&s->film, "Pf", at);
    double ior = statement_within(&s->film_ior, "Pf_ior", 1,
                                  MATERIAL_FILM_IOR_MAX, MATERIAL_FILM_IOR, at);
    double thickness = statement_within(&s->film_thickness, "Pf_thickness", 0,
                                        MATERIAL_FILM_THICKNESS_MAX,
                                        MATERIAL_FILM_THICKNESS, at);

    if (!(weight > 0) || !(thickness > 0) || !has_facets)
        return;
    m->film = (float)weight;
    m->film_ior = (float)ior;
    m->film_thickness = (float)thickness;
    m->film_texture = material_values_map(s, MTL_MAP_FILM);
    m->film_thickness_texture = material_values_map(s, MTL_MAP_FILM_THICKNESS);
    if (m->film_thickness_texture != NO_INDEX)
        m->film_thinnest =
            (float)statement_within(&s->film_thinnest, "Pf_thinnest", 0,
                                    MATERIAL_FILM_THICKNESS_MAX, 0, at);
}

/* Returns the map of sheen. Colours come before weights. */
static uint32_t sheen_map(const struct material_values *s)
{
    uint32_t colors = material_values_map(s, MTL_MAP_SHEEN_COLOR);

    return colors != NO_INDEX ? colors : material_values_map(s, MTL_MAP_SHEEN);
}

static void set_sheen_and_grain(struct material *m,
                                const struct material_values *s,
                                const struct statement_place *at)
{
    uint32_t map = sheen_map(s);
    float ps = (float)statement_unit(&s->sheen, "Ps", at);
    struct vec3 color =
        statement_reflectance(&s->sheen_color, "Ps_color", 1, at);
    double roughness =
        s->sheen_roughness.line != 0
            ? statement_unit(&s->sheen_roughness, "Ps_roughness", at)
            : MATERIAL_SHEEN_ROUGHNESS;
    double turn =
        s->anisotropy_rotation.line != 0 ? s->anisotropy_rotation.value : 0;

    m->sheen = (struct vec3){ps * color.x, ps * color.y, ps * color.z};
    m->sheen_texture = map;
    if (ps > 0)
        m->sheen_alpha_texture =
            material_values_map(s, MTL_MAP_SHEEN_ROUGHNESS);
    if (ps > 0)
        m->sheen_alpha = fmaxf((float)(roughness * roughness), SHEEN_ALPHA_MIN);
    m->anisotropy = (float)statement_unit(&s->anisotropy, "aniso", at);
    if (m->anisotropy > 0)
        m->grain_texture = material_values_map(s, MTL_MAP_GRAIN);
    if (m->anisotropy > 0 && isfinite(turn)) {
        turn = 2 * M_PI * (turn - floor(turn));
        m->grain = (struct vec2){(float)cos(turn), (float)sin(turn)};
    }
}

/* Sets the weights of a mixture. Returns false, and leaves the material, if it
 * is not one. A grain needs highlights: metal, or Ks (has_ks). */
static bool make_principled(struct material *m, int illum, bool has_ks,
                            const struct material_values *s,
                            const struct statement_place *at)
{
    struct mtl_number pc = {s->coat.value / material_values_full_coat(s),
                            s->coat.line};
    double pcr = statement_unit(&s->coat_roughness, "Pcr", at);

    m->metal_texture = material_values_map(s, MTL_MAP_METALNESS);
    m->metalness = (float)metalness(s, illum, at);
    m->transmission = (float)transmission(m, s, illum, at);
    m->coat = (float)statement_unit(&pc, "Pc", at);
    m->coat_texture = material_values_map(s, MTL_MAP_COAT);
    if (m->coat > 0) {
        m->coat_alpha = (float)(pcr * pcr);
        m->coat_alpha_texture = material_values_map(s, MTL_MAP_COAT_ROUGHNESS);
        m->coat_normal_texture = material_values_map(s, MTL_MAP_COAT_NORMAL);
    }
    if (m->coat_normal_texture != NO_INDEX)
        m->coat_normal_strength = (float)s->map_scales[MTL_MAP_COAT_NORMAL];
    set_sheen_and_grain(m, s, at);
    if (m->metalness == 0 && !has_ks)
        m->anisotropy = 0;
    set_film(m, m->metalness > 0 || has_ks || m->transmission > 0, s, at);
    return !is_black(&m->sheen) || m->anisotropy > 0 || m->film > 0 ||
           m->metal_texture != NO_INDEX || m->transmission > 0 || m->coat > 0 ||
           (m->metalness > 0 && m->metalness < 1);
}

/* Returns true if the material has a diffuse part. */
static bool has_base(const struct material *m)
{
    return m->kind == MATERIAL_DIFFUSE || m->kind == MATERIAL_ROUGH_DIFFUSE ||
           m->kind == MATERIAL_PLASTIC ||
           (m->kind == MATERIAL_PRINCIPLED &&
            (m->metalness < 1 || m->metal_texture != NO_INDEX) &&
            (m->transmission < 1 || m->transmission_texture != NO_INDEX));
}

/* Sets what is below the diffuse part of a surface. Sr is the mean free path in
 * each channel, in units of the file. */
static void set_subsurface(struct material *m, const struct material_values *s,
                           const struct statement_place *at)
{
    float weight = (float)statement_unit(&s->subsurface, "Sf", at);
    double g = statement_within(&s->subsurface_anisotropy, "Sg", -1, 1, 0, at);
    struct vec3 path = statement_amounts(&s->subsurface_path, "Sr", at);

    if (!(weight > 0) || !has_base(m) || !(v3_max_component(path) > 0) ||
        !v3_is_zero(m->medium.extinction))
        return;
    m->subsurface = weight;
    m->subsurface_texture = material_values_map(s, MTL_MAP_SUBSURFACE);
    m->medium = (struct medium){
        .extinction = {1 / path.x, 1 / path.y, 1 / path.z},
        .anisotropy = medium_anisotropy(g),
    };
    m->medium = medium_scaled(m->medium, 1);
}

static void make_opaque(struct material *m, int illum,
                        const struct material_values *s,
                        const struct statement_place *at)
{
    uint32_t map_ks = material_values_map(s, MTL_MAP_SPECULAR);
    struct vec3 ks = statement_reflectance(&s->specular_color, "Ks", 0, at);
    bool has_ks = !is_black(&ks) || map_ks != NO_INDEX;
    bool is_principled = make_principled(m, illum, has_ks, s, at);

    m->opacity = (float)opacity(s, at);
    if (m->opacity <= 0)
        warnings_add(at->report, "invisible materials",
                     "%s:%" PRIu64
                     ": found d %g: surfaces with this material are invisible",
                     at->path, s->opacity.line, s->opacity.value);
    m->opacity_texture = material_values_map(s, MTL_MAP_OPACITY);
    m->cutoff = (float)statement_unit(&s->cutoff, "d_cutoff", at);
    m->color = statement_reflectance(&s->base_color, "Kd", MATERIAL_GREY, at);
    m->color_texture = material_values_map(s, MTL_MAP_COLOR);
    if (m->metalness == 1 && !is_principled) {
        m->kind = MATERIAL_METAL;
        roughen(m, s, at);
    } else if (has_ks && material_values_is_mirror(s)) {
        m->kind = MATERIAL_METAL;
        m->metalness = 1;
        m->color = ks;
        m->color_texture = map_ks;
        roughen(m, s, at);
    } else if (has_ks || is_principled) {
        make_plastic(m, &ks, s, at);
    } else {
        make_diffuse(m, s, at);
    }
    if (is_principled) {
        m->kind = MATERIAL_PRINCIPLED;
        set_index(m, s, at);
    }
    if (m->kind != MATERIAL_METAL)
        set_translucency(m, s, at);
    set_subsurface(m, s, at);
}

/* Reports a map that this kind of material does not use. */
static void check_map(const struct material_values *s, enum mtl_map which,
                      const struct material *m,
                      const struct statement_place *at)
{
    uint32_t map = material_values_map(s, which);
    uint32_t used[MATERIAL_MAPS];

    material_maps(m, used);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (map == used[i])
            return;
    if (map != NO_INDEX)
        warnings_add(at->report, "maps that their material does not use",
                     "%s: found %s, which this material does not use: ignored",
                     at->path, mtl_maps[which].keys[0]);
}

/* Reports Td of a material without a diffuse part. */
static void check_translucency(const struct material_values *s,
                               const struct material *m,
                               const struct statement_place *at)
{
    uint64_t line = s->translucency.line;

    if (line == MTL_IMPLIED)
        line = s->back_color.line;
    if (s->translucency.value > 0 && m->translucency == 0 &&
        line != MTL_IMPLIED)
        warnings_add(at->report, "statements without effect",
                     "%s:%" PRIu64 ": found Td, which diffuse surfaces, "
                     "plastic and mixtures use: ignored",
                     at->path, line);
}

/* Reports light below a surface that the material does not have. */
static void check_subsurface(const struct material_values *s,
                             const struct material *m,
                             const struct statement_place *at)
{
    uint64_t line = s->subsurface.line;

    if (!((float)s->subsurface.value > 0) || m->subsurface > 0 ||
        line == MTL_IMPLIED)
        return;
    warnings_add(at->report, "statements without effect",
                 "%s:%" PRIu64 ": found Sf%s: ignored", at->path, line,
                 !has_base(m)
                     ? ", which diffuse surfaces, plastic and mixtures "
                       "with a diffuse part use"
                 : !v3_is_zero(m->medium.extinction)
                     ? " beside a medium of glass, which is used instead"
                     : " without Sr, expected a mean free path above 0");
}

/* Reports statements about a medium that do nothing here. */
static void check_medium(const struct material_values *s,
                         const struct material *m,
                         const struct statement_place *at)
{
    bool is_solid =
        m->kind == MATERIAL_GLASS || (m->transmission > 0 && m->is_thin == 0);
    bool is_by_coefficients =
        s->medium_scatter.line != 0 || s->medium_absorb.line != 0;
    bool is_by_distance =
        !is_by_coefficients && s->attenuation_distance.value > 0;
    bool scatters = s->medium_scatter.line != 0 ||
                    (is_by_distance &&
                     (s->medium_color.line != 0 || s->medium_albedo.line != 0));
    const char *instead = is_by_coefficients
                              ? "which Tf_scatter and Tf_absorb replace"
                              : "which needs Tf_distance";
    const struct {
        const char *key, *reason;
        uint64_t line;
        bool is_used;
    } statements[] = {
        {"Tf_distance", instead,
         s->attenuation_distance.value > 0 ? s->attenuation_distance.line : 0,
         is_by_distance},
        {"Tf_attenuation", instead, s->attenuation.line, is_by_distance},
        {"Tf_scatter", NULL, s->medium_scatter.line, true},
        {"Tf_absorb", NULL, s->medium_absorb.line, true},
        {"Tf_multiscatter", instead, s->medium_color.line, is_by_distance},
        {"Tf_albedo",
         is_by_distance ? "which Tf_multiscatter replaces" : instead,
         s->medium_albedo.line, is_by_distance && s->medium_color.line == 0},
        {"Tf_anisotropy", "which media that scatter use",
         s->medium_anisotropy.line, scatters},
    };

    for (size_t i = 0; i < sizeof statements / sizeof statements[0]; i++)
        if (statements[i].line != 0 && !(is_solid && statements[i].is_used))
            warnings_add(at->report, "statements without effect",
                         "%s:%" PRIu64 ": found %s, %s: ignored", at->path,
                         statements[i].line, statements[i].key,
                         is_solid ? statements[i].reason
                                  : "which solid glass uses");
}

/* Roughness below which metal and glass cast, above which metal is matte; and
 * least one of highlights on matte surfaces: a narrow highlight that a light
 * path meets by chance is a speck. */
#define CASTS_ALPHA_MAX     0.2f
#define HIGHLIGHT_ALPHA_MIN 0.3f

/* True if a highlight is wide, or a delta, which light paths do not see. */
static bool is_wide(float alpha, uint32_t texture)
{
    return alpha < ALPHA_SMOOTH ||
           (alpha >= HIGHLIGHT_ALPHA_MIN && texture == NO_INDEX);
}

static enum material_role role_of(const struct material *m)
{
    bool is_clear = m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS;
    bool is_matte = is_wide(m->alpha, m->alpha_texture) &&
                    is_wide(m->coat_alpha, m->coat_alpha_texture);

    if (m->subsurface > 0)
        return ROLE_NONE;
    if (m->kind == MATERIAL_DIFFUSE || m->kind == MATERIAL_ROUGH_DIFFUSE)
        return ROLE_MATTE;
    if (m->is_boundary != 0)
        return ROLE_NONE;
    if (is_clear || m->kind == MATERIAL_METAL ||
        (m->kind == MATERIAL_PRINCIPLED &&
         m->metalness + m->transmission >= 0.5f)) {
        if (m->alpha < CASTS_ALPHA_MAX)
            return ROLE_CASTS;
        is_matte = m->kind == MATERIAL_METAL && m->alpha_texture == NO_INDEX;
    }
    return is_matte ? ROLE_MATTE : ROLE_NONE;
}

/* Returns true for a face of Ni 1 without color, behind which there is a
 * medium: it neither reflects nor bends light. */
static bool is_boundary(const struct material *m)
{
    const struct vec3 c = m->color;

    return m->kind == MATERIAL_GLASS && m->ior == 1 && c.x == 1 && c.y == 1 &&
           c.z == 1 && m->color_texture == NO_INDEX &&
           !v3_is_zero(m->medium.extinction) && v3_is_zero(m->emission);
}

struct material material_from_source(const struct material_values *source,
                                     const char *path, struct warnings *report)
{
    struct statement_place at = {path, report};
    struct material m = material_default();
    const struct material_values factors = material_values_with_factors(source);
    const struct material_values *s = &factors;
    struct mtl_color light = material_values_light(s);
    int illum = illumination(s, &at);

    if (is_solid_glass(s, illum))
        make_glass(&m, MATERIAL_GLASS, s, &at);
    else if (is_sheet(s, illum))
        make_glass(&m, MATERIAL_THIN_GLASS, s, &at);
    else
        make_opaque(&m, illum, s, &at);
    m.emission_texture = material_values_map(s, MTL_MAP_EMISSION);
    m.normal_texture = material_values_map(s, MTL_MAP_NORMAL);
    if (m.normal_texture != NO_INDEX)
        m.normal_strength = (float)s->map_scales[MTL_MAP_NORMAL];
    m.bump_texture = material_values_map(s, MTL_MAP_BUMP);
    m.bump_scale = (float)s->map_scales[MTL_MAP_BUMP];
    for (int i = 0; i < MTL_MAPS; i++)
        check_map(s, (enum mtl_map)i, &m, &at);
    if (m.kind == MATERIAL_THIN_GLASS && m.ior == 1 &&
        is_white_or_absent(&s->transmission) && m.color_texture == NO_INDEX)
        warnings_add(report, "invisible materials",
                     "%s:%" PRIu64 ": found glass of Ni 1 without a tint: "
                     "surfaces with this material are invisible",
                     path, s->illum.line);
    check_medium(s, &m, &at);
    check_translucency(s, &m, &at);
    check_subsurface(s, &m, &at);
    m.emission = statement_amounts(&light, "Ke", &at);
    m.is_boundary = is_boundary(&m);
    m.role = role_of(&m);
    return m;
}

/* Replaces *s by the candidate if both give the same material. */
static void take_if_same(struct material_values *s,
                         const struct material_values *candidate)
{
    struct warnings ignored = {0};
    struct material a = material_from_source(s, "", &ignored);
    struct material b = material_from_source(candidate, "", &ignored);

    if (memcmp(&a, &b, sizeof a) == 0)
        *s = *candidate;
    warnings_free(&ignored);
}

struct material_values
material_values_needed(const struct material_values *file,
                       const struct material_values *wanted)
{
    struct material_values s = *wanted;
    struct material_values candidate;

    /* colours first, so that Pm makes the metal and not the Ks of plastic */
    for (int i = 0; i < MTL_PROPERTIES; i++) {
        const struct mtl_property *p = &mtl_properties[i];

        candidate = s;
        memcpy((char *)&candidate + p->member, (const char *)file + p->member,
               p->is_color ? sizeof file->base_color : sizeof file->illum);
        take_if_same(&s, &candidate);
    }
    candidate = s;
    candidate.emission = file->emission;
    candidate.kelvin = file->kelvin;
    candidate.luminance = file->luminance;
    take_if_same(&s, &candidate);
    return s;
}

/* ---- features ---- */

static bool has_texture(const struct material *m)
{
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (maps[i] != NO_INDEX)
            return true;
    return false;
}

/* Flags that no kernel reads, or every one. */
#define PLAIN_FLAGS (TEXTURE_CLAMP | TEXTURE_OPAQUE)

/* Returns true if a build without FEATURE_TEXTURE_OPTIONS would look the
 * texture up wrongly. */
static bool has_options(const struct texture *t)
{
    uint32_t clamp = t->flags & TEXTURE_CLAMP;

    return (t->flags & ~(uint32_t)PLAIN_FLAGS) != 0 ||
           (clamp != 0 && clamp != TEXTURE_CLAMP) ||
           (t->channel >= CHANNEL_RED && t->channel <= CHANNEL_BLUE);
}

static bool needs_options(const struct material *m,
                          const struct texture *textures)
{
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (maps[i] != NO_INDEX && has_options(&textures[maps[i]]))
            return true;
    return m->specular_weight_texture != NO_INDEX ||
           m->subsurface_texture != NO_INDEX ||
           m->sheen_alpha_texture != NO_INDEX || m->film_texture != NO_INDEX ||
           m->film_thickness_texture != NO_INDEX ||
           m->grain_texture != NO_INDEX;
}

static bool has_alpha(const struct texture *textures, uint32_t texture)
{
    return texture != NO_INDEX && textures[texture].has_alpha != 0;
}

uint64_t material_features(const struct material *m,
                           const struct texture *textures)
{
    uint64_t features = 0;

    if (material_shines(m))
        features |= FEATURE_EMITTERS;
    if (has_texture(m))
        features |= FEATURE_TEXTURES;
    if (needs_options(m, textures))
        features |= FEATURE_TEXTURE_OPTIONS;
    if (m->bump_texture != NO_INDEX || m->normal_texture != NO_INDEX)
        features |= FEATURE_BUMPS;
    if (has_coat_bumps(m))
        features |= FEATURE_COAT_NORMALS;
    if (m->opacity < 1 ||
        (m->color_is_opaque == 0 && has_alpha(textures, m->color_texture)) ||
        has_alpha(textures, m->opacity_texture))
        features |= FEATURE_COVERAGE;
    if (m->kind == MATERIAL_METAL)
        features |= FEATURE_METAL;
    if (m->kind == MATERIAL_PRINCIPLED)
        features |= FEATURE_PRINCIPLED;
    if (m->kind == MATERIAL_PRINCIPLED && m->anisotropy > 0)
        features |= FEATURE_ANISOTROPY;
    if (m->kind == MATERIAL_PRINCIPLED && !v3_is_zero(m->sheen))
        features |= FEATURE_SHEEN;
    if (m->kind == MATERIAL_PRINCIPLED && m->film > 0)
        features |= FEATURE_THIN_FILM;
    if (m->translucency > 0)
        features |= FEATURE_TRANSLUCENT;
    if (m->subsurface > 0)
        features |= FEATURE_SUBSURFACE;
    else if (!v3_is_zero(m->medium.extinction))
        features |= FEATURE_ATTENUATION;
    if (!v3_is_zero(m->medium.scattering) || m->is_boundary != 0)
        features |= FEATURE_MEDIA;
    if (m->dispersion > 0)
        features |= FEATURE_DISPERSION;
    if (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS)
        features |= FEATURE_GLASS;
    if (m->is_thin != 0 ||
        (m->kind == MATERIAL_THIN_GLASS && m->alpha >= ALPHA_SMOOTH))
        features |= FEATURE_ROUGH_SHEETS;
    if (m->kind == MATERIAL_PLASTIC)
        features |= FEATURE_PLASTIC;
    if (m->kind == MATERIAL_ROUGH_DIFFUSE)
        features |= FEATURE_ROUGH_DIFFUSE;
    else if (m->kind != MATERIAL_DIFFUSE &&
             (m->alpha >= ALPHA_SMOOTH || m->coat_alpha >= ALPHA_SMOOTH))
        features |= FEATURE_ROUGH;
    return features;
}

bool features_use_tangents(uint64_t features)
{
    return (features &
            (FEATURE_BUMPS | FEATURE_ANISOTROPY | FEATURE_COAT_NORMALS)) != 0;
}
