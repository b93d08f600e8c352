// SPDX-License-Identifier: MIT
#include "formats/mtl_save.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "formats/asset_path.h"
#include "formats/mtl_dialect.h"
#include "formats/mtl_document.h"
#include "formats/mtl_map.h"

static mtl_aliases light_keys = {"Ke", "Ke_blackbody"};
static mtl_aliases blackbody_keys = {"Ke_blackbody", "Ke"};
static mtl_aliases classic_map_keys[MTL_MAPS] = {
    {"map_Kd"},
    {"map_Ks"},
    {"map_Ke"},
    {"map_Pr"},
    {"map_Pm"},
    {"map_d"},
    {"map_Tf"},
    {"map_Pc"},
    {"map_Pcr"},
    {"map_Ps"},
    {"map_Ps_color"},
    {"map_Ps_roughness"},
    {"map_Ks_weight"},
    {"map_Pf"},
    {"map_Pf_thickness"},
    {"map_grain"},
    {"map_Pc_norm"},
    {"norm", "map_Kn"},
    {"map_Bump", "map_bump", "bump"},
};
static mtl_aliases roughness_of_blender = {"map_Pr", "map_Ns"};
static mtl_aliases metal_of_blender = {"map_Pm", "map_refl"};

/* Returns the keys that mean this map in a file of the material's dialect. */
static const char *const *map_keys(const struct mtl_source *s, enum mtl_map map)
{
    if (s->dialect != MTL_CLASSIC && map == MTL_MAP_PR)
        return roughness_of_blender;
    if (s->dialect != MTL_CLASSIC && map == MTL_MAP_PM)
        return metal_of_blender;
    return classic_map_keys[map];
}

struct writer {
    const struct scene *scene;
    const char *path;
    struct mtl_document text;
};

static bool write_color(struct writer *w, const struct mtl_change *c,
                        mtl_aliases keys, const struct mtl_color *before,
                        const struct mtl_color *after)
{
    char text[3][DECIMAL_TEXT_BYTES], value[3 * DECIMAL_TEXT_BYTES];

    if (after->line == 0)
        return before->line == 0 ||
               mtl_document_remove(&w->text, c->name, keys);
    if (mtl_color_equal(before, after))
        return true;
    for (int i = 0; i < 3; i++)
        decimal_format(text[i], after->rgb[i]);
    snprintf(value, sizeof value, "%s %s %s", text[0], text[1], text[2]);
    return mtl_document_set(&w->text, c->name, keys, value);
}

static bool write_number(struct writer *w, const struct mtl_change *c,
                         mtl_aliases keys, const struct mtl_number *before,
                         const struct mtl_number *after)
{
    char text[DECIMAL_TEXT_BYTES];

    if (after->line == 0)
        return before->line == 0 ||
               mtl_document_remove(&w->text, c->name, keys);
    if (mtl_number_equal(before, after))
        return true;
    decimal_format(text, after->value);
    return mtl_document_set(&w->text, c->name, keys, text);
}

/* Writes Ke or Ke_blackbody, whichever the material uses. */
static bool write_light(struct writer *w, const struct mtl_change *c)
{
    static const struct mtl_color none = {.line = 0};
    const struct mtl_source *a = c->before, *b = c->after;
    char text[2][DECIMAL_TEXT_BYTES], value[2 * DECIMAL_TEXT_BYTES];

    if (b->kelvin.line == 0)
        return write_color(w, c, light_keys,
                           a->kelvin.line == 0 ? &a->ke : &none, &b->ke) &&
               (a->kelvin.line == 0 || b->ke.line != 0 ||
                mtl_document_remove(&w->text, c->name, light_keys));
    if (mtl_number_equal(&a->kelvin, &b->kelvin) &&
        mtl_number_equal(&a->luminance, &b->luminance))
        return true;
    decimal_format(text[0], b->kelvin.value);
    decimal_format(text[1], b->luminance.value);
    snprintf(value, sizeof value, "%s %s", text[0], text[1]);
    return mtl_document_set(&w->text, c->name, blackbody_keys, value);
}

/* Returns true if the text at `at` is a map statement that names the
 * texture. */
static bool is_map(const struct writer *w, size_t at, mtl_aliases keys,
                   uint32_t texture)
{
    struct mtl_statement s = {.key = at};
    struct lexer lex = mtl_document_lex(&w->text, at);
    struct mtl_map_options options;
    struct word word = lexer_word(&lex);
    char *name, *path = NULL;
    bool is_same;

    s.key_end = at + word.length;
    if (!mtl_document_has_key(&w->text, &s, keys))
        return false;
    name = mtl_map_read(&lex, &options);
    is_same = name != NULL && asset_path_find(w->path, name, &path) &&
              path != NULL &&
              strcmp(path, w->scene->texture_paths[texture]) == 0;
    free(path);
    free(name);
    return is_same;
}

/* Finds the last comment of the block that is a disabled map statement. */
static bool find_commented_map(const struct writer *w,
                               const struct mtl_block *b, mtl_aliases keys,
                               uint32_t texture, size_t *at)
{
    struct lexer lex = mtl_document_lex(&w->text, b->newmtl.end);
    const char *end = w->text.bytes + b->end;
    bool is_found = false;

    for (; lex.p < end; lexer_next_line(&lex)) {
        size_t hash;

        lexer_skip_blanks(&lex);
        hash = (size_t)(lex.p - w->text.bytes);
        if (lex.p == end || *lex.p != '#' ||
            !is_map(w, hash + 1, keys, texture))
            continue;
        *at = hash;
        is_found = true;
    }
    return is_found;
}

/* Writes an option with its three numbers. The third is the depth of a solid
 * texture; it keeps its default. */
static void print_pair(FILE *to, const char *option, struct vec2 v, int third)
{
    char x[DECIMAL_TEXT_BYTES], y[DECIMAL_TEXT_BYTES];

    decimal_format_float(x, v.x);
    decimal_format_float(y, v.y);
    fprintf(to, "%s %s %s %d ", option, x, y, third);
}

/* Writes an option with one number, unless that is the default. */
static void print_number(FILE *to, const char *option, double value,
                         double missing)
{
    char text[DECIMAL_TEXT_BYTES];

    decimal_format(text, value);
    if (value != missing)
        fprintf(to, "%s %s ", option, text);
}

/* Writes an option that may be on for both axes or for one. */
static void print_axes(FILE *to, const char *option, bool has_u, bool has_v)
{
    if (has_u || has_v)
        fprintf(to, "%s %s ", option, !has_v ? "u" : !has_u ? "v" : "on");
}

static void print_flags(FILE *to, uint32_t flags)
{
    print_axes(to, "-clamp", (flags & TEXTURE_CLAMP_U) != 0,
               (flags & TEXTURE_CLAMP_V) != 0);
    print_axes(to, "-mirror", (flags & TEXTURE_MIRROR_U) != 0,
               (flags & TEXTURE_MIRROR_V) != 0);
    if ((flags & TEXTURE_NEAREST) != 0)
        fputs("-nearest on ", to);
    if ((flags & TEXTURE_SECOND_UVS) != 0)
        fputs("-uv 1 ", to);
    if ((flags & TEXTURE_OPAQUE) != 0)
        fputs("-alpha off ", to);
}

/* Returns the options and the file name of a map statement, for free(). NULL
 * when memory is out. */
static char *map_value(const struct writer *w, const struct mtl_source *s,
                       enum mtl_map map)
{
    const struct texture *t = &w->scene->textures[s->maps[map]];
    double angle = w->scene->texture_origins[s->maps[map]].rotation_deg;
    char *name = path_seen_from(w->path, w->scene->texture_paths[s->maps[map]]);
    char *text = NULL;
    size_t size_bytes;
    FILE *to = name == NULL ? NULL : open_memstream(&text, &size_bytes);

    if (to != NULL) {
        if (t->scale.x != 1 || t->scale.y != 1)
            print_pair(to, "-s", t->scale, 1);
        print_number(to, "-rotate", angle, 0);
        if (t->offset.x != 0 || t->offset.y != 0)
            print_pair(to, "-o", t->offset, 0);
        print_flags(to, t->flags);
        if (t->channel != CHANNEL_DEFAULT)
            fprintf(to, "-imfchan %c ",
                    t->channel == CHANNEL_GREY ? 'l' : " rgbm"[t->channel]);
        print_number(to, "-bm", s->map_scales[map], 1);
        fputs(name, to);
        if (fclose(to) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(name);
    return text;
}

static bool write_map(struct writer *w, const struct mtl_change *c,
                      enum mtl_map map)
{
    bool was_on = mtl_source_map(c->before, map) != NO_INDEX;
    bool is_on = mtl_source_map(c->after, map) != NO_INDEX;
    const char *const *keys = map_keys(c->after, map);
    struct mtl_block b;
    size_t hash;
    char *value;
    bool ok;

    if (was_on == is_on)
        return true;
    if (!is_on)
        return mtl_document_comment(&w->text, c->name, keys);
    if (!mtl_document_find_block(&w->text, c->name, &b))
        return false;
    if (find_commented_map(w, &b, keys, c->after->maps[map], &hash))
        return mtl_document_splice(&w->text, hash, 1, "");
    value = map_value(w, c->after, map);
    ok = value != NULL && mtl_document_insert(&w->text, &b, keys[0], value);
    free(value);
    return ok;
}

static bool write_properties(struct writer *w, const struct mtl_change *c,
                             bool is_color)
{
    bool ok = true;

    for (int i = 0; ok && i < MTL_PROPERTIES; i++) {
        const struct mtl_property *p = &mtl_properties[i];
        const void *before = (const char *)c->before + p->member;
        const void *after = (const char *)c->after + p->member;
        mtl_aliases keys = {p->key};

        if (p->is_color == is_color)
            ok = is_color ? write_color(w, c, keys, before, after)
                          : write_number(w, c, keys, before, after);
    }
    return ok;
}

static bool write_change(struct writer *w, const struct mtl_change *c)
{
    const struct mtl_source none = mtl_source_empty();
    struct mtl_change whole = {c->name, c->copied_from, &none, c->after};
    struct mtl_block block;
    bool ok = true;

    if (c->copied_from != NULL &&
        mtl_document_find_block(&w->text, c->copied_from, &block)) {
        ok = mtl_document_append_block(&w->text, c->name, c->copied_from);
    } else if (c->copied_from != NULL ||
               !mtl_document_find_block(&w->text, c->name, &block)) {
        /* the file has no such block, or not any more: write all of it */
        ok = mtl_document_append_block(&w->text, c->name, c->name);
        c = &whole;
    }
    ok = ok && write_properties(w, c, true) && write_light(w, c) &&
         write_properties(w, c, false);
    for (int i = 0; i < MTL_MAPS; i++)
        ok = ok && write_map(w, c, (enum mtl_map)i);
    return ok;
}

/* Names the dialect in the first line if the changed statements do not show it
 * any more. */
static bool keep_dialect(struct mtl_document *t, enum mtl_dialect dialect)
{
    struct lexer lex = mtl_document_lex(t, 0);
    char *line;
    bool ok;

    if (mtl_dialect_find(t->bytes, t->size).dialect == dialect)
        return true;
    line = format_text("%s%s", mtl_dialect_line(dialect), t->line_end);
    ok = line != NULL &&
         mtl_document_splice(t, (size_t)(lex.p - t->bytes), 0, line);
    free(line);
    return ok;
}

bool mtl_rewrite(const struct scene *scene, const char *path, const char *text,
                 size_t size_bytes, const struct mtl_change *changes,
                 size_t change_count, char **new_text, size_t *new_size_bytes,
                 struct error *err)
{
    struct writer w = {.scene = scene, .path = path};
    bool ok;

    ok = mtl_document_init(&w.text, text, size_bytes);
    /* new materials first: they copy blocks of the unchanged file */
    for (size_t i = 0; ok && i < change_count; i++)
        ok = changes[i].copied_from == NULL || write_change(&w, &changes[i]);
    for (size_t i = 0; ok && i < change_count; i++)
        ok = changes[i].copied_from != NULL || write_change(&w, &changes[i]);
    ok =
        ok && keep_dialect(&w.text, mtl_dialect_find(text, size_bytes).dialect);
    if (!ok) {
        free(w.text.bytes);
        return fail(err, "%s: out of memory for the changed materials", path);
    }
    *new_text = w.text.bytes;
    *new_size_bytes = w.text.size;
    return true;
}

/* Reads the file. The scene's own file may be missing, which is an empty one.
 */
static bool read_text(const struct scene *scene, const char *path, bool exists,
                      char **text, size_t *size_bytes, struct error *err)
{
    if (exists || !scene->has_own_mtl)
        return file_read(path, text, size_bytes, err);
    *size_bytes = 0;
    *text = strdup("");
    return *text != NULL || fail(err, "%s: out of memory", path);
}

bool mtl_save(const struct scene *scene, const char *path,
              const struct mtl_change *changes, size_t change_count,
              struct file_change *change, struct error *err)
{
    char *text, *new_text;
    size_t size_bytes, new_size_bytes;
    bool ok;

    change->before = file_identify(path);
    if (!read_text(scene, path, change->before.exists, &text, &size_bytes, err))
        return false;
    ok = mtl_rewrite(scene, path, text, size_bytes, changes, change_count,
                     &new_text, &new_size_bytes, err);
    free(text);
    if (!ok)
        return false;
    ok = file_replace(path, new_text, new_size_bytes, change, err);
    free(new_text);
    return ok;
}
