// SPDX-License-Identifier: MIT
#include "read/mtl.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "image/color.h"
#include "read/asset_path.h"
#include "read/mtl_dialect.h"
#include "read/mtl_map.h"
#include "read/scene_lists.h"
#include "scene/material.h"

struct parser {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    struct error *err;
    struct lexer lex;
    struct name_table materials; /* with the numbers they have in the scene */
    struct texture_table textures;
    size_t material_capacity;
    char *name; /* of the material that is being read; NULL before the first */
    uint64_t name_line;
    uint32_t file;          /* number of this file in scene->mtl_paths */
    bool is_made;           /* the text is a reader's, not that of the file */
    uint32_t earlier_count; /* materials of the scene before this text */
    enum mtl_dialect dialect;
    struct material_values source;
};

static bool out_of_memory(const struct parser *p)
{
    return fail(p->err, "%s:%" PRIu64 ": out of memory for the materials",
                p->path, p->lex.line);
}

bool mtl_add_default(struct scene *scene, struct error *err)
{
    struct material m = material_default();
    struct material_origin origin = {material_values_empty(), NO_INDEX};
    size_t capacity = 0;

    if (scene->material_count > 0 ||
        scene_add_material(scene, &capacity, "", &m, &origin))
        return true;
    return fail(err, "out of memory for the materials");
}

uint32_t mtl_find(const struct scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (strcmp(scene->material_names[i], name) == 0)
            return i;
    }
    return NO_INDEX;
}

/* Adds the material that was read last to the scene. */
static bool finish_material(struct parser *p)
{
    struct material_origin origin = {p->source, p->file};
    struct material m;
    uint32_t index;

    if (p->name == NULL)
        return true;
    if (*p->name == '\0') {
        warnings_add(p->report, "materials without a name",
                     "%s:%" PRIu64
                     ": found newmtl without a name: material ignored",
                     p->path, p->name_line);
        return true;
    }
    m = material_from_source(&p->source, p->path, p->report);
    index = name_table_add(&p->materials, p->name);
    if (index == NO_NAME)
        return out_of_memory(p);
    if (index < p->scene->material_count) {
        bool is_anew = index < p->earlier_count &&
                       p->scene->material_origins[index].file == p->file;

        if (!is_anew)
            warnings_add_named(p->report, "materials defined twice", p->name,
                               "%s:%" PRIu64
                               ": found newmtl '%s' again: the later "
                               "one is used",
                               p->path, p->name_line, p->name);
        p->scene->materials[index] = m;
        p->scene->material_origins[index] = origin;
        return true;
    }
    return scene_add_material(p->scene, &p->material_capacity, p->name, &m,
                              &origin) ||
           out_of_memory(p);
}

static bool read_newmtl(struct parser *p)
{
    if (!finish_material(p))
        return false;
    free(p->name);
    p->name_line = p->lex.line;
    p->name = lexer_rest(&p->lex);
    p->source = material_values_empty();
    p->source.dialect = p->dialect;
    return p->name != NULL || out_of_memory(p);
}

static bool expected(struct parser *p, struct word key, const char *what)
{
    return fail(p->err, "%s:%" PRIu64 ": found %s after %.*s, expected %s",
                p->path, p->lex.line, word_quote(lexer_word(&p->lex)).text,
                (int)key.length, key.start, what);
}

static bool read_number(struct parser *p, struct word key,
                        struct mtl_number *number)
{
    struct lexer start = p->lex;

    /* the only option of d */
    if (!word_is(lexer_word(&p->lex), "-halo"))
        p->lex = start;
    if (lexer_at_line_end(&p->lex) || !lexer_number(&p->lex, &number->value))
        return expected(p, key, "a number");
    number->line = p->lex.line;
    return true;
}

/* Reads 1 number, a grey, or 3. */
static bool read_color(struct parser *p, struct word key,
                       struct mtl_color *color)
{
    struct lexer start = p->lex;
    struct word word = lexer_word(&p->lex);
    int count = 0;

    if (word_is(word, "spectral") || word_is(word, "xyz")) {
        warnings_add(p->report, "spectral colours",
                     "%s:%" PRIu64
                     ": found %.*s %.*s, expected a colour: ignored",
                     p->path, p->lex.line, (int)key.length, key.start,
                     (int)word.length, word.start);
        return true;
    }
    p->lex = start;
    while (count < 3 && !lexer_at_line_end(&p->lex)) {
        if (!lexer_number(&p->lex, &color->rgb[count++]))
            return expected(p, key, "a number");
    }
    if (count == 1)
        color->rgb[1] = color->rgb[2] = color->rgb[0];
    else if (count != 3)
        return expected(p, key, "1 or 3 numbers");
    color->line = p->lex.line;
    return true;
}

/* Reads Ke_blackbody KELVIN [LUMINANCE]: emission with the colour of that
 * temperature. The luminance is 1 unless it is given. */
static bool read_blackbody(struct parser *p, struct word key)
{
    struct material_values *s = &p->source;
    double kelvin, scale = 1;

    if (lexer_at_line_end(&p->lex) || !lexer_number(&p->lex, &kelvin) ||
        (!lexer_at_line_end(&p->lex) && !lexer_number(&p->lex, &scale)))
        return expected(p, key, "a temperature and perhaps a luminance");
    if (!(kelvin >= 0 && kelvin <= BLACKBODY_GREATEST)) {
        warnings_add(p->report, "temperatures out of range",
                     "%s:%" PRIu64
                     ": found %.*s %g, expected kelvins from 0 to "
                     "%g: taken as 0",
                     p->path, p->lex.line, (int)key.length, key.start, kelvin,
                     BLACKBODY_GREATEST);
        kelvin = 0;
    }
    s->kelvin = (struct mtl_number){kelvin, p->lex.line};
    s->luminance = (struct mtl_number){scale, p->lex.line};
    return true;
}

/* Reads Ke. It replaces an earlier Ke_blackbody. */
static bool read_light(struct parser *p, struct word key)
{
    struct material_values *s = &p->source;

    if (!read_color(p, key, &s->emission))
        return false;
    if (s->emission.line ==
        p->lex.line) /* a colour was read, not a spectral one */
        s->kelvin = s->luminance = (struct mtl_number){.line = 0};
    return true;
}

/* Returns the path of the file that a map names, for free(); a path beside the
 * MTL file if none exists. NULL if memory is out. */
static char *map_path(const struct parser *p, const char *name)
{
    char *found;

    if (!asset_path_find(p->path, name, &found))
        return NULL;
    return found != NULL ? found : path_beside(p->path, name);
}

/* Reads a map statement. *scale is set by -bm; it is NULL for maps of neither
 * heights nor normals. */
static bool read_map(struct parser *p, struct word key, bool is_data,
                     uint32_t *texture, double *scale)
{
    struct texture_origin origin = {.file = p->file,
                                    .line = p->is_made ? 0 : p->lex.line,
                                    .is_opacity = word_is(key, "map_d")};
    struct mtl_map_options o;
    char *name = mtl_map_read(&p->lex, &o);
    char *path;

    if (name == NULL)
        return out_of_memory(p);
    o.texture.is_data = is_data;
    if (!is_data)
        o.texture.channel = CHANNEL_DEFAULT;
    origin.rotation_deg = o.rotation_deg;
    if (o.unknown_count > 0)
        warnings_add(p->report, "maps with unknown options",
                     "%s:%" PRIu64 ": found an unknown option of %.*s, "
                     "expected one that the manual lists: ignored",
                     p->path, p->lex.line, (int)key.length, key.start);
    if (*name == '\0') {
        warnings_add(p->report, "maps without a file",
                     "%s:%" PRIu64 ": found %.*s without a file name: ignored",
                     p->path, p->lex.line, (int)key.length, key.start);
        free(name);
        return true;
    }
    path = map_path(p, name);
    if (scale != NULL)
        *scale = o.bump_scale;
    *texture = path == NULL
                   ? NO_INDEX
                   : texture_table_add(&p->textures, path, &o.texture, &origin);
    free(path);
    free(name);
    return *texture != NO_INDEX || out_of_memory(p);
}

static void skip_statement(struct parser *p, struct word key)
{
    char name[64];
    int length = key.length < 40 ? (int)key.length : 40;

    if (word_is(key, "Ka"))
        return;
    snprintf(name, sizeof name, "%.*s", length, key.start);
    warnings_add_named(p->report, "unknown statements", name,
                       "%s:%" PRIu64 ": found '%s', which glim does not use",
                       p->path, p->lex.line, name);
}

/* Returns the table's row of a statement of one colour or number, or NULL. */
static const struct mtl_property *find_property(const struct parser *p,
                                                struct word key)
{
    if (p->dialect == MTL_CLASSIC && word_is(key, "Ka"))
        return NULL;
    for (int i = 0; i < MTL_PROPERTIES; i++)
        if (word_is(key, mtl_properties[i].key))
            return &mtl_properties[i];
    return NULL;
}

static bool read_property(struct parser *p, struct word key)
{
    struct material_values *s = &p->source;
    static const struct {
        const char *key;
        enum mtl_map map;
        bool is_data;
        bool is_of_blender; /* has this meaning in its files only */
    } maps[] = {
        {"map_Kd", MTL_MAP_COLOR, false, false},
        {"map_Ks", MTL_MAP_SPECULAR, false, false},
        {"map_Ke", MTL_MAP_EMISSION, false, false},
        {"map_Pr", MTL_MAP_ROUGHNESS, true, false},
        {"map_Ns", MTL_MAP_ROUGHNESS, true, true},
        {"map_Pm", MTL_MAP_METALNESS, true, false},
        {"map_refl", MTL_MAP_METALNESS, true, true},
        {"map_d", MTL_MAP_OPACITY, true, false},
        {"map_Tf", MTL_MAP_TRANSMISSION, true, false},
        {"map_Pc", MTL_MAP_COAT, true, false},
        {"map_Pcr", MTL_MAP_COAT_ROUGHNESS, true, false},
        {"map_Ps", MTL_MAP_SHEEN, true, false},
        {"map_Ps_color", MTL_MAP_SHEEN_COLOR, false, false},
        {"map_Ps_roughness", MTL_MAP_SHEEN_ROUGHNESS, true, false},
        {"map_Ks_weight", MTL_MAP_SPECULAR_WEIGHT, true, false},
        {"map_Pf", MTL_MAP_FILM, true, false},
        {"map_Pf_thickness", MTL_MAP_FILM_THICKNESS, true, false},
        {"map_grain", MTL_MAP_GRAIN, true, false},
        {"map_Pc_norm", MTL_MAP_COAT_NORMAL, true, false},
        {"norm", MTL_MAP_NORMAL, true, false},
        {"map_Kn", MTL_MAP_NORMAL, true, false},
        {"bump", MTL_MAP_BUMP, true, false},
        {"map_bump", MTL_MAP_BUMP, true, false},
        {"map_Bump", MTL_MAP_BUMP, true, false},
    };
    const struct mtl_property *property = find_property(p, key);

    if (word_is(key, "Ke"))
        return read_light(p, key);
    if (word_is(key, "Ke_blackbody"))
        return read_blackbody(p, key);
    if (property != NULL) {
        void *member = (char *)s + property->member;

        return property->is_color ? read_color(p, key, member)
                                  : read_number(p, key, member);
    }
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        if (word_is(key, maps[i].key) &&
            (p->dialect != MTL_CLASSIC || !maps[i].is_of_blender))
            return read_map(p, key, maps[i].is_data, &s->maps[maps[i].map],
                            material_values_map_scale(s, maps[i].map));
    }
    skip_statement(p, key);
    return true;
}

static bool parse_lines(struct parser *p)
{
    for (; p->lex.p < p->lex.end; lexer_next_line(&p->lex)) {
        struct word key;

        if (lexer_at_line_end(&p->lex))
            continue;
        key = lexer_word(&p->lex);
        if (word_is(key, "newmtl")) {
            if (!read_newmtl(p))
                return false;
        } else if (p->name == NULL) {
            warnings_add(p->report, "statements before newmtl",
                         "%s:%" PRIu64 ": found %s, expected newmtl", p->path,
                         p->lex.line, word_quote(key).text);
        } else if (!read_property(p, key)) {
            return false;
        }
    }
    return finish_material(p);
}

/* Registers the materials and textures of earlier files, so that they keep
 * their numbers. */
static bool register_existing(struct parser *p)
{
    const struct scene *scene = p->scene;

    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (name_table_add(&p->materials, scene->material_names[i]) == NO_NAME)
            return false;
    }
    return texture_table_init(&p->textures, p->scene);
}

/* Adds this file to the scene's list of MTL files, unless it is the first of
 * them and the scene's own. */
static bool add_file(struct parser *p)
{
    struct scene *scene = p->scene;
    size_t capacity = scene->mtl_path_count;
    void *paths = scene->mtl_paths;
    char *copy;

    if (scene->has_own_mtl && scene->mtl_path_count > 0 &&
        strcmp(scene->mtl_paths[0], p->path) == 0)
        return true;
    copy = strdup(p->path);
    p->file = scene->mtl_path_count;
    p->is_made = scene->has_own_mtl && p->file == 0;
    if (copy == NULL ||
        !grow_array(&paths, &capacity, (size_t)p->file + 1, sizeof copy)) {
        free(copy);
        return false;
    }
    scene->mtl_paths = paths;
    scene->mtl_paths[scene->mtl_path_count++] = copy;
    return true;
}

/* Finds the dialect of the file, and says it if the file does not: then it was
 * concluded. The default material gets that of the first file, because copies
 * of it are saved there. */
static void find_dialect(struct parser *p, const char *text, size_t size_bytes)
{
    struct mtl_dialect_found found = mtl_dialect_find(text, size_bytes);

    p->dialect = found.dialect;
    if (p->file == 0)
        p->scene->material_origins[0].source.dialect = found.dialect;
    if (found.dialect != MTL_CLASSIC && *found.version == '\0')
        warnings_add_named(p->report, "files of Blender", p->path,
                           "%s: read as Blender writes it, by the order of its "
                           "statements",
                           p->path);
}

bool mtl_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err)
{
    struct parser p = {.scene = scene,
                       .path = path,
                       .report = report,
                       .err = err};
    bool ok = mtl_add_default(scene, err);

    if (ok) {
        lexer_init(&p.lex, text, size_bytes);
        p.material_capacity = scene->material_count;
        p.earlier_count = scene->material_count;
        ok = add_file(&p) && register_existing(&p);
        if (ok)
            find_dialect(&p, text, size_bytes);
        ok = ok ? parse_lines(&p) : out_of_memory(&p);
    }
    free(p.name);
    name_table_free(&p.materials);
    texture_table_free(&p.textures);
    return ok;
}
