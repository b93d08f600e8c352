// SPDX-License-Identifier: MIT
#include "glim/mtl.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/asset.h"
#include "glim/blackbody.h"
#include "glim/file.h"
#include "glim/lex.h"
#include "glim/map.h"
#include "glim/material.h"
#include "glim/names.h"

struct parser {
    struct scene *scene;
    const char *path;
    struct report *report;
    struct error *err;
    struct lex lex;
    struct names materials; /* of the scene, numbered alike */
    struct names textures;
    size_t material_capacity;
    size_t texture_capacity;
    char *name; /* of the material that is being read; NULL: none */
    uint64_t name_line;
    struct mtl_source source;
};

static bool out_of_memory(const struct parser *p)
{
    return fail(p->err, "%s:%" PRIu64 ": out of memory for the materials",
                p->path, p->lex.line);
}

/* Room for one more material and its name. */
static bool grow_materials(struct scene *scene, size_t *capacity)
{
    size_t needed = (size_t)scene->material_count + 1;
    size_t material_capacity = *capacity;
    void *materials = scene->materials;
    void *names = scene->material_names;

    if (needed >= NO_INDEX || !grow_array(&materials, &material_capacity,
                                          needed, sizeof *scene->materials))
        return false;
    scene->materials = materials;
    if (!grow_array(&names, capacity, needed, sizeof *scene->material_names))
        return false;
    scene->material_names = names;
    return true;
}

static bool add_material(struct scene *scene, size_t *capacity,
                         const char *name, const struct material *material)
{
    char *copy = strdup(name);

    if (copy == NULL || !grow_materials(scene, capacity)) {
        free(copy);
        return false;
    }
    scene->material_names[scene->material_count] = copy;
    scene->materials[scene->material_count++] = *material;
    return true;
}

bool mtl_add_default(struct scene *scene, struct error *err)
{
    struct material m = material_default();
    size_t capacity = 0;

    if (scene->material_count > 0 || add_material(scene, &capacity, "", &m))
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

/* One texture for each path and way to look it up; NULL when memory is out. */
static char *texture_key(const char *path, const struct texture *t)
{
    char *key = NULL;
    int length = asprintf(&key, "%g %g %g %g %u %u %s", (double)t->scale.x,
                          (double)t->scale.y, (double)t->offset.x,
                          (double)t->offset.y, t->is_clamped, t->is_data, path);

    return length < 0 ? NULL : key;
}

static uint32_t name_texture(struct names *names, const char *path,
                             const struct texture *texture)
{
    char *key = texture_key(path, texture);
    uint32_t index = key == NULL ? NO_NAME : names_add(names, key);

    free(key);
    return index;
}

/* The number of the texture, a new one without texels if need be. */
static uint32_t add_texture(struct parser *p, const char *path,
                            const struct texture *texture)
{
    struct scene *scene = p->scene;
    uint32_t index = name_texture(&p->textures, path, texture);
    size_t needed = (size_t)scene->texture_count + 1;
    size_t texture_capacity = p->texture_capacity;
    void *textures = scene->textures;
    void *paths = scene->texture_paths;
    char *copy;

    if (index == NO_NAME || index < scene->texture_count)
        return index;
    if (!grow_array(&textures, &texture_capacity, needed,
                    sizeof *scene->textures))
        return NO_NAME;
    scene->textures = textures;
    if (!grow_array(&paths, &p->texture_capacity, needed,
                    sizeof *scene->texture_paths))
        return NO_NAME;
    scene->texture_paths = paths;
    copy = strdup(path);
    if (copy == NULL)
        return NO_NAME;
    scene->texture_paths[scene->texture_count] = copy;
    scene->textures[scene->texture_count++] = *texture;
    return index;
}

/* The material that was being read is complete. */
static bool finish_material(struct parser *p)
{
    struct material m;
    uint32_t index;

    if (p->name == NULL)
        return true;
    if (*p->name == '\0') {
        report_add(p->report, "materials without a name",
                   "%s:%" PRIu64 ": found newmtl without a name: not used",
                   p->path, p->name_line);
        return true;
    }
    m = material_from_source(&p->source, p->path, p->report);
    index = names_add(&p->materials, p->name);
    if (index == NO_NAME)
        return out_of_memory(p);
    if (index < p->scene->material_count) {
        report_add_named(p->report, "materials defined twice", p->name,
                         "%s:%" PRIu64 ": found newmtl '%s' again: the later "
                         "one is used",
                         p->path, p->name_line, p->name);
        p->scene->materials[index] = m;
        return true;
    }
    return add_material(p->scene, &p->material_capacity, p->name, &m) ||
           out_of_memory(p);
}

static bool read_newmtl(struct parser *p)
{
    if (!finish_material(p))
        return false;
    free(p->name);
    p->name_line = p->lex.line;
    p->name = lex_rest(&p->lex);
    p->source = (struct mtl_source){.map_kd = NO_INDEX,
                                    .map_ks = NO_INDEX,
                                    .map_ke = NO_INDEX,
                                    .map_pr = NO_INDEX,
                                    .map_pm = NO_INDEX,
                                    .map_d = NO_INDEX,
                                    .map_bump = NO_INDEX,
                                    .norm = NO_INDEX};
    return p->name != NULL || out_of_memory(p);
}

static bool expected(struct parser *p, struct word key, const char *what)
{
    return fail(p->err, "%s:%" PRIu64 ": found %s after %.*s, expected %s",
                p->path, p->lex.line, word_quote(lex_word(&p->lex)).text,
                (int)key.length, key.start, what);
}

static bool read_number(struct parser *p, struct word key,
                        struct mtl_number *number)
{
    struct lex start = p->lex;

    /* d has an option of its own */
    if (!word_is(lex_word(&p->lex), "-halo"))
        p->lex = start;
    if (lex_at_line_end(&p->lex) || !lex_number(&p->lex, &number->value))
        return expected(p, key, "a number");
    number->line = p->lex.line;
    return true;
}

/* One number is a grey. */
static bool read_color(struct parser *p, struct word key,
                       struct mtl_color *color)
{
    struct lex start = p->lex;
    struct word word = lex_word(&p->lex);
    int count = 0;

    if (word_is(word, "spectral") || word_is(word, "xyz")) {
        report_add(p->report, "spectral colours",
                   "%s:%" PRIu64 ": found %.*s %.*s, expected a colour: not "
                   "used",
                   p->path, p->lex.line, (int)key.length, key.start,
                   (int)word.length, word.start);
        return true;
    }
    p->lex = start;
    while (count < 3 && !lex_at_line_end(&p->lex)) {
        if (!lex_number(&p->lex, &color->rgb[count++]))
            return expected(p, key, "a number");
    }
    if (count == 1)
        color->rgb[1] = color->rgb[2] = color->rgb[0];
    else if (count != 3)
        return expected(p, key, "1 or 3 numbers");
    color->line = p->lex.line;
    return true;
}

/* Ke_blackbody KELVIN [SCALE]: Ke as the colour of that temperature, with
 * luminance SCALE or 1. */
static bool read_blackbody(struct parser *p, struct word key,
                           struct mtl_color *ke)
{
    double kelvin, scale = 1;

    if (lex_at_line_end(&p->lex) || !lex_number(&p->lex, &kelvin) ||
        (!lex_at_line_end(&p->lex) && !lex_number(&p->lex, &scale)))
        return expected(p, key, "a temperature and perhaps a luminance");
    *ke = (struct mtl_color){.line = p->lex.line};
    if (kelvin >= BLACKBODY_LEAST && kelvin <= BLACKBODY_GREATEST) {
        blackbody_rgb(kelvin, ke->rgb);
        for (int i = 0; i < 3; i++)
            ke->rgb[i] *= scale;
    } else if (!(kelvin >= 0 && kelvin < BLACKBODY_LEAST)) {
        report_add(p->report, "impossible temperatures",
                   "%s:%" PRIu64 ": found %.*s %g, expected kelvins from 0 to "
                   "%g: taken as 0",
                   p->path, p->lex.line, (int)key.length, key.start, kelvin,
                   BLACKBODY_GREATEST);
    }
    return true;
}

/* The file that a map names, or as it is written if there is no such file. */
static char *map_path(const struct parser *p, const char *name)
{
    char *found = asset_find(p->path, name);

    return found != NULL ? found : path_beside(p->path, name);
}

/* bump_scale: set by -bm; NULL for maps without heights. */
static bool read_map(struct parser *p, struct word key, bool is_data,
                     uint32_t *texture, double *bump_scale)
{
    uint64_t line = p->lex.line;
    struct map_options o;
    char *name = map_read(&p->lex, &o);
    char *path;

    if (name == NULL)
        return out_of_memory(p);
    o.texture.is_data = is_data;
    if (o.unknown_count > 0)
        report_add(p->report, "maps with options",
                   "%s:%" PRIu64 ": found options of %.*s other than -o, -s, "
                   "-bm and -clamp: the texture is used without them",
                   p->path, line, (int)key.length, key.start);
    if (*name == '\0') {
        report_add(p->report, "maps without a file",
                   "%s:%" PRIu64 ": found %.*s without the name of a file",
                   p->path, line, (int)key.length, key.start);
        free(name);
        return true;
    }
    path = map_path(p, name);
    if (bump_scale != NULL)
        *bump_scale = o.bump_scale;
    *texture = add_texture(p, path, &o.texture);
    free(path);
    free(name);
    return *texture != NO_NAME || out_of_memory(p);
}

static void skip_statement(struct parser *p, struct word key)
{
    char name[64];
    int length = key.length < 40 ? (int)key.length : 40;

    if (word_is(key, "Ka"))
        return;
    snprintf(name, sizeof name, "%.*s", length, key.start);
    report_add_named(p->report, "unknown statements", name,
                     "%s:%" PRIu64 ": found '%s', which glim does not use",
                     p->path, p->lex.line, name);
}

static bool read_property(struct parser *p, struct word key)
{
    struct mtl_source *s = &p->source;
    const struct {
        const char *key;
        struct mtl_color *color;
        struct mtl_number *number;
        uint32_t *texture;
        double *bump_scale;
        bool is_data;
    } properties[] = {
        {"Kd", .color = &s->kd},
        {"Ks", .color = &s->ks},
        {"Ke", .color = &s->ke},
        {"Tf", .color = &s->tf},
        {"Ns", .number = &s->ns},
        {"Ni", .number = &s->ni},
        {"d", .number = &s->d},
        {"Tr", .number = &s->tr},
        {"illum", .number = &s->illum},
        {"Pr", .number = &s->pr},
        {"Pm", .number = &s->pm},
        {"Kd_roughness", .number = &s->kd_roughness},
        {"map_Kd", .texture = &s->map_kd},
        {"map_Ks", .texture = &s->map_ks},
        {"map_Ke", .texture = &s->map_ke},
        {"map_Pr", .texture = &s->map_pr, .is_data = true},
        {"map_Pm", .texture = &s->map_pm, .is_data = true},
        {"map_d", .texture = &s->map_d, .is_data = true},
        {"norm", .texture = &s->norm, .is_data = true},
        {"bump", .texture = &s->map_bump, .bump_scale = &s->bump_scale,
         .is_data = true},
        {"map_bump", .texture = &s->map_bump, .bump_scale = &s->bump_scale,
         .is_data = true},
        {"map_Bump", .texture = &s->map_bump, .bump_scale = &s->bump_scale,
         .is_data = true},
    };

    if (word_is(key, "Ke_blackbody"))
        return read_blackbody(p, key, &s->ke);
    for (size_t i = 0; i < sizeof properties / sizeof properties[0]; i++) {
        if (!word_is(key, properties[i].key))
            continue;
        if (properties[i].color != NULL)
            return read_color(p, key, properties[i].color);
        if (properties[i].number != NULL)
            return read_number(p, key, properties[i].number);
        return read_map(p, key, properties[i].is_data, properties[i].texture,
                        properties[i].bump_scale);
    }
    skip_statement(p, key);
    return true;
}

static bool parse_lines(struct parser *p)
{
    for (; p->lex.p < p->lex.end; lex_next_line(&p->lex)) {
        struct word key;

        if (lex_at_line_end(&p->lex))
            continue;
        key = lex_word(&p->lex);
        if (word_is(key, "newmtl")) {
            if (!read_newmtl(p))
                return false;
        } else if (p->name == NULL) {
            report_add(p->report, "statements before newmtl",
                       "%s:%" PRIu64 ": found %s, expected newmtl", p->path,
                       p->lex.line, word_quote(key).text);
        } else if (!read_property(p, key)) {
            return false;
        }
    }
    return finish_material(p);
}

/* What other files have brought keeps its numbers. */
static bool add_known(struct parser *p)
{
    const struct scene *scene = p->scene;

    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (names_add(&p->materials, scene->material_names[i]) == NO_NAME)
            return false;
    }
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        if (name_texture(&p->textures, scene->texture_paths[i],
                         &scene->textures[i]) == NO_NAME)
            return false;
    }
    return true;
}

bool mtl_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct report *report, struct error *err)
{
    struct parser p = {.scene = scene,
                       .path = path,
                       .report = report,
                       .err = err};
    bool ok = mtl_add_default(scene, err);

    if (ok) {
        lex_init(&p.lex, text, size_bytes);
        p.material_capacity = scene->material_count;
        p.texture_capacity = scene->texture_count;
        ok = add_known(&p);
        ok = ok ? parse_lines(&p) : out_of_memory(&p);
    }
    free(p.name);
    names_free(&p.materials);
    names_free(&p.textures);
    return ok;
}
