// SPDX-License-Identifier: MIT
#include "read/child/import_material.h"

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
