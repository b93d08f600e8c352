// SPDX-License-Identifier: MIT
#include "read/child/import_material.h"

/* ---- cameras and lights ---- */

#if HAS_ASSIMP

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Width by height of a picture whose camera does not say. */
#define ASPECT_DEFAULT (16.0 / 9)

/* Angle across a picture below which libassimp has lost it, as it does for
 * Collada cameras without a name, and the one that is taken. */
#define ACROSS_MIN     0.02
#define ACROSS_DEFAULT 1.0

/* Part of a Collada spot's cone that has its full light: libassimp's number for
 * the edge does not come from the file. It is Blender's default. */
#define SPOT_FULL 0.85

/* ---- the program that wrote the file ---- */

static const struct aiMetadataEntry *find(const struct aiScene *scene,
                                          const char *key)
{
    const struct aiMetadata *m = scene->mMetaData;

    for (unsigned i = 0; m != NULL && i < m->mNumProperties; i++)
        if (strcmp(m->mKeys[i].data, key) == 0)
            return &m->mValues[i];
    return NULL;
}

/* Returns true if the text of this key has the word. */
static bool says(const struct aiScene *scene, const char *key, const char *word)
{
    const struct aiMetadataEntry *e = find(scene, key);

    return e != NULL && e->mType == AI_AISTRING &&
           strstr(((const struct aiString *)e->mData)->data, word) != NULL;
}

/* Returns the units of a metre: FBX states centimetres for each unit, and
 * libassimp makes the units of Collada metres. */
static double units_of(const struct aiScene *scene, bool is_fbx)
{
    const struct aiMetadataEntry *e = find(scene, "UnitScaleFactor");
    double centimeters = 1;

    if (!is_fbx)
        return 1;
    if (e != NULL && e->mType == AI_DOUBLE)
        centimeters = *(const double *)e->mData;
    else if (e != NULL && e->mType == AI_FLOAT)
        centimeters = (double)*(const float *)e->mData;
    return 100 / centimeters;
}

struct import_source import_source_of(const struct aiScene *scene)
{
    struct import_source s = {
        .is_fbx = says(scene, "SourceAsset_Format", "FBX"),
        .is_collada = says(scene, "SourceAsset_Format", "Collada"),
    };

    s.is_blender = (s.is_fbx || s.is_collada) &&
                   says(scene, "SourceAsset_Generator", "Blender");
    s.units_per_meter = units_of(scene, s.is_fbx);
    return s;
}

/* ---- places ---- */

struct affine import_matrix(const struct aiNode *node)
{
    const struct aiMatrix4x4 *m = &node->mTransformation;

    return (struct affine){
        {{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
         {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
         {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static void place(const struct affine *matrix, struct aiVector3D p,
                  double to[3])
{
    affine_point(matrix, (double[3]){(double)p.x, (double)p.y, (double)p.z},
                 to);
}

/* Turns a direction, without moving it. */
static void turn(const struct affine *matrix, struct aiVector3D d, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = matrix->m[i][0] * (double)d.x + matrix->m[i][1] * (double)d.y +
                matrix->m[i][2] * (double)d.z;
    vec3d_normalize(to);
}

/* ---- records ---- */

void import_camera_fill(const struct aiCamera *camera,
                        const struct affine *matrix, struct import_camera *to)
{
    double aspect = (double)camera->mAspect;
    double across = (double)camera->mHorizontalFOV;

    memset(to, 0, sizeof *to);
    snprintf(to->name, sizeof to->name, "%.127s", camera->mName.data);
    place(matrix, camera->mPosition, to->eye);
    turn(matrix, camera->mLookAt, to->forward);
    turn(matrix, camera->mUp, to->up);
    if (!(aspect > 0))
        aspect = ASPECT_DEFAULT;
    if (!(across > ACROSS_MIN))
        across = ACROSS_DEFAULT;
    to->yfov = 2 * atan(tan(across / 2) / aspect);
}

/* Returns the intensity of a light of colour 1. Blender writes the power in
 * watts of a light that shines to all sides. Other programs write the light of
 * a white surface that faces it, which fades with the distance as a polynomial
 * says: their lights are made to have it at the middle of the scene. The
 * polynomial of FBX files is about other things. */
static double intensity_of(const struct aiLight *l,
                           const struct import_source *s, const double from[3],
                           const double center[3])
{
    double square = 0, fade;

    if (s->is_blender)
        return s->units_per_meter * s->units_per_meter / (4 * M_PI);
    for (int i = 0; i < 3; i++)
        square += (center[i] - from[i]) * (center[i] - from[i]);
    fade = (double)l->mAttenuationConstant +
           (double)l->mAttenuationLinear * sqrt(square) +
           (double)l->mAttenuationQuadratic * square;
    if (s->is_fbx || !(fade > 0))
        fade = 1;
    return M_PI * square / fade;
}

/* Angles of libassimp go from edge to edge. */
static void set_cone(const struct aiLight *l, const struct import_source *s,
                     struct import_lamp *to)
{
    to->inner = (double)l->mAngleInnerCone / 2;
    to->outer = (double)l->mAngleOuterCone / 2;
    if (s->is_collada) {
        to->outer = to->inner;
        to->inner *= SPOT_FULL;
    }
}

bool import_lamp_fill(const struct aiLight *light, const struct affine *matrix,
                      const struct import_source *source,
                      const double center[3], struct import_lamp *to)
{
    const float rgb[3] = {light->mColorDiffuse.r, light->mColorDiffuse.g,
                          light->mColorDiffuse.b};
    double scale = source->is_blender ? 1 : M_PI;

    memset(to, 0, sizeof *to);
    place(matrix, light->mPosition, to->position);
    turn(matrix, light->mDirection, to->forward);
    switch ((int)light->mType) {
    case aiLightSource_DIRECTIONAL: to->kind = LAMP_DIRECTIONAL; break;
    case aiLightSource_POINT: to->kind = LAMP_POINT; break;
    case aiLightSource_SPOT:
        to->kind = LAMP_SPOT;
        set_cone(light, source, to);
        break;
    default: return false;
    }
    if (to->kind != LAMP_DIRECTIONAL)
        scale = intensity_of(light, source, to->position, center);
    for (int i = 0; i < 3; i++)
        to->rgb[i] = (double)rgb[i] * scale;
    return true;
}

#else

typedef int import_view_is_absent;

#endif

/* ---- materials ---- */

#if HAS_ASSIMP

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

#define NO_IMAGE UINT_MAX

struct writer {
    const struct assimp_api *api;
    const struct import_materials *all;
    const struct aiMaterial *material;
    FILE *to;
};

/* Replaces what would end a line, or the name, of MTL text. */
static void make_word(char *text)
{
    for (char *p = text; *p != '\0'; p++)
        if (iscntrl((unsigned char)*p) || *p == '\\' || *p == '#')
            *p = '_';
}

/* Returns true if the name has a character that is not a blank. */
static bool is_name(const char *name)
{
    return name[strspn(name, " ")] != '\0';
}

static bool write_name(const struct writer *w, struct name_table *names)
{
    struct aiString given = {0};
    uint32_t number = names->count;
    char *name;
    bool ok;

    if (w->api->GetMaterialString(w->material, AI_MATKEY_NAME, &given) !=
        aiReturn_SUCCESS)
        given.data[0] = '\0';
    make_word(given.data);
    if (is_name(given.data) && name_table_find(names, given.data) == NO_NAME)
        name = format_text("%s", given.data);
    else
        name =
            format_text("%s-%u", is_name(given.data) ? given.data : "material",
                        number + 1);
    while (name != NULL && name_table_find(names, name) != NO_NAME) {
        char *longer = format_text("%s-", name);

        free(name);
        name = longer;
    }
    ok = name != NULL && name_table_add(names, name) != NO_NAME;
    if (ok)
        fprintf(w->to, "newmtl %s\n", name);
    free(name);
    return ok;
}

/* Reads a number that is finite. */
static bool get_number(const struct writer *w, const char *key, float *x)
{
    return w->api->GetMaterialFloatArray(w->material, key, 0, 0, x, NULL) ==
               aiReturn_SUCCESS &&
           isfinite(*x);
}

static bool get_color(const struct writer *w, const char *key,
                      struct aiColor4D *c)
{
    return w->api->GetMaterialColor(w->material, key, 0, 0, c) ==
               aiReturn_SUCCESS &&
           isfinite(c->r) && isfinite(c->g) && isfinite(c->b);
}

static void write_number(const struct writer *w, const char *key, float x)
{
    fprintf(w->to, "%s %.9g\n", key, (double)x);
}

static void write_color(const struct writer *w, const char *key,
                        const struct aiColor4D *c, float scale)
{
    fprintf(w->to, "%s %.9g %.9g %.9g\n", key, (double)(c->r * scale),
            (double)(c->g * scale), (double)(c->b * scale));
}

/* Returns the last part of a name with folders of any system. */
static const char *last_part(const char *name)
{
    const char *last = name;

    for (; *name != '\0'; name++)
        if (*name == '/' || *name == '\\')
            last = name + 1;
    return last;
}

/* Returns the number of the image in the file that `name` means: *3, or the
 * name of the file that it was. */
static unsigned embedded_image(const struct writer *w, const char *name)
{
    const struct aiScene *scene = w->all->scene;

    for (unsigned i = 0; i < scene->mNumTextures; i++) {
        const char *image = scene->mTextures[i]->mFilename.data;
        char number[16];

        snprintf(number, sizeof number, "*%u", i);
        if (strcmp(name, number) == 0 ||
            (*image != '\0' && strcmp(last_part(name), last_part(image)) == 0))
            return i;
    }
    return NO_IMAGE;
}

/* Writes a map. Returns true if the material has one. */
static bool write_map(const struct writer *w, const char *key,
                      enum aiTextureType type)
{
    struct aiString path;
    unsigned image;

    if (w->api->GetMaterialTexture(w->material, type, 0, &path, NULL, NULL,
                                   NULL, NULL, NULL,
                                   NULL) != aiReturn_SUCCESS ||
        path.length == 0)
        return false;
    image = embedded_image(w, path.data);
    if (image != NO_IMAGE) {
        fprintf(w->to, "%s %s#image%u\n", key, path_name(w->all->path), image);
        return true;
    }
    for (char *p = path.data; *p != '\0'; p++) {
        if (*p == '\\') /* a folder on Windows */
            *p = '/';
        else if (iscntrl((unsigned char)*p))
            *p = '_';
    }
    fprintf(w->to, "%s %s\n", key, path.data);
    return true;
}

/* Writes how much of a metal it is. Blender's exporters write that as the
 * reflectivity; for other programs this is a mirror in front of the surface,
 * which many have for no reason. */
static void write_metal(const struct writer *w)
{
    float metal;

    if (get_number(w, "$mat.metallicFactor", &metal) ||
        (w->all->source->is_blender &&
         get_number(w, "$mat.reflectivity", &metal) && metal > 0))
        write_number(w, "Pm", metal);
}

/* Returns a roughness from 0 to 1. libassimp makes 1 - sqrt(N) / 10 of the
 * exponent N of a highlight, which is below 0 for most of 3ds Max's: those are
 * as wide as that highlight, as Ns is. */
static float roughness_within(const struct writer *w, float roughness)
{
    float root = 10 * (1 - roughness);

    if (roughness >= 0 && roughness <= 1)
        return roughness;
    ++*w->all->clamped_count;
    return roughness < 0 ? powf(2 / (root * root + 2), 0.25f) : 1;
}

/* Writes roughness and metal if the file has them, else the highlight. */
static void write_facets(const struct writer *w)
{
    float roughness, shininess = 0, strength = 1;
    struct aiColor4D specular;

    write_metal(w);
    if (get_number(w, "$mat.roughnessFactor", &roughness)) {
        write_number(w, "Pr", roughness_within(w, roughness));
        write_color(w, "Ks", &(struct aiColor4D){0.5f, 0.5f, 0.5f, 1}, 1);
        return;
    }
    if (!get_number(w, "$mat.shininess", &shininess) || shininess <= 0 ||
        !get_color(w, "$clr.specular", &specular))
        return;
    get_number(w, "$mat.shinpercent", &strength);
    write_color(w, "Ks", &specular, strength);
    write_number(w, "Ns", shininess);
}

static void write_surface(const struct writer *w)
{
    struct aiColor4D c;
    float x, strength = 1;
    bool has_map = write_map(w, "map_Kd", aiTextureType_BASE_COLOR) ||
                   write_map(w, "map_Kd", aiTextureType_DIFFUSE);

    /* programs write a texture beside black, which it would multiply */
    if (has_map)
        fputs("Kd 1 1 1\n", w->to);
    else if (get_color(w, "$clr.base", &c) || get_color(w, "$clr.diffuse", &c))
        write_color(w, "Kd", &c, 1);
    if (get_color(w, "$clr.emissive", &c)) {
        get_number(w, "$mat.emissiveIntensity", &strength);
        write_color(w, "Ke", &c, strength);
    }
    write_facets(w);
    /* 0 comes from programs that mean the opposite */
    if (get_number(w, "$mat.opacity", &x) && x > 0 && x < 1)
        write_number(w, "d", x);
    if (get_number(w, "$mat.refracti", &x) && x > 1)
        write_number(w, "Ni", x);
    write_map(w, "map_d", aiTextureType_OPACITY);
    write_map(w, "map_Ke", aiTextureType_EMISSIVE);
    write_map(w, "norm", aiTextureType_NORMALS);
    write_map(w, "map_bump", aiTextureType_HEIGHT);
}

bool import_material_write(const struct import_materials *m,
                           const struct aiMaterial *material,
                           struct name_table *names)
{
    struct writer w = {m->api, m, material, m->to};

    if (!write_name(&w, names))
        return false;
    write_surface(&w);
    return true;
}

#else

typedef int import_material_is_absent;

#endif
