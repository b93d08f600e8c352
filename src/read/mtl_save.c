// SPDX-License-Identifier: MIT
#include "read/mtl_save.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "read/asset_path.h"
#include "read/mtl.h"

/* Keys with the same meaning. The first is the one that is written. */
typedef const char *const mtl_aliases[MTL_MAP_KEYS];

struct mtl_document {
    char *bytes;
    size_t size;
    const char *line_end;
};

/* Position of a statement in the text. */
struct mtl_statement {
    size_t line;             /* start of its line */
    size_t key, key_end;     /* the first word */
    size_t value, value_end; /* the words after it */
    size_t end;              /* start of the next line */
    bool has_comment;
    bool is_unterminated; /* the text ends without a line end */
};

/* Block of a material: its newmtl statement and its last statement, which may
 * be the same. */
struct mtl_block {
    struct mtl_statement newmtl, last;
    size_t end; /* start of the next newmtl, or end of the text */
};

/* ---- the document ---- */

/*
 * Edits keep comments, order, blanks, line ends and all statements that are
 * not named. The last of several blocks with the same name counts, and the
 * last of several statements with the same meaning, as in reading.
 */

/* Returns the line end of the first line; a line feed if there is only one
 * line. */
static const char *line_end_of(const char *text, size_t size_bytes)
{
    for (size_t i = 0; i < size_bytes; i++) {
        if (text[i] == '\n')
            return "\n";
        if (text[i] == '\r')
            return i + 1 < size_bytes && text[i + 1] == '\n' ? "\r\n" : "\r";
    }
    return "\n";
}

/* Initializes the document with a copy of the text. */
static bool mtl_document_init(struct mtl_document *t, const char *text,
                              size_t size_bytes)
{
    /* what is appended must not stand behind NULs, which readers drop */
    size_bytes = lexer_text_size(text, size_bytes);
    *t = (struct mtl_document){alloc_array(size_bytes + 1, 1), size_bytes,
                               line_end_of(text, size_bytes)};
    if (t->bytes != NULL)
        memcpy(t->bytes, text, size_bytes);
    return t->bytes != NULL;
}

static bool splice(struct mtl_document *t, size_t at, size_t removed,
                   const char *insert, size_t added)
{
    size_t behind = t->size - at - removed;
    char *bytes = t->bytes;

    if (added > removed) {
        bytes = realloc(t->bytes, t->size + added - removed + 1);
        if (bytes == NULL)
            return false;
    }
    t->bytes = bytes;
    memmove(bytes + at + added, bytes + at + removed, behind);
    memcpy(bytes + at, insert, added);
    t->size += added - removed;
    return true;
}

/* Replaces `removed` bytes at `at` by the text `insert`. */
static bool mtl_document_splice(struct mtl_document *t, size_t at,
                                size_t removed, const char *insert)
{
    return splice(t, at, removed, insert, strlen(insert));
}

/* Returns a lexer that starts at `at`. */
static struct lexer mtl_document_lex(const struct mtl_document *t, size_t at)
{
    struct lexer lex;

    if (at == 0)
        lexer_init(&lex, t->bytes, t->size);
    else
        lex = (struct lexer){t->bytes + at, t->bytes + t->size, 1};
    return lex;
}

/* Finds the value of a statement whose key and end are known. */
static void find_value(const struct mtl_document *t, struct mtl_statement *s)
{
    struct lexer lex = {t->bytes + s->key_end, t->bytes + s->end, 1};
    bool is_option = false;

    s->value = s->value_end = s->key_end;
    while (!lexer_at_line_end(&lex)) {
        struct word word = lexer_word(&lex);

        if (s->value == s->key_end || is_option)
            s->value = (size_t)(word.start - t->bytes);
        s->value_end = (size_t)(lex.p - t->bytes);
        is_option = word_is(word, "-halo");
    }
    s->has_comment = lex.p < lex.end && *lex.p == '#';
}

/* Finds the next statement from *lex on and moves *lex to the line after it. */
static bool next_statement(const struct mtl_document *t, struct lexer *lex,
                           struct mtl_statement *s)
{
    for (; lex->p < lex->end; lexer_next_line(lex)) {
        struct word word;

        s->line = (size_t)(lex->p - t->bytes);
        if (lexer_at_line_end(lex))
            continue;
        word = lexer_word(lex);
        s->key = (size_t)(word.start - t->bytes);
        s->key_end = s->key + word.length;
        s->is_unterminated = !lexer_next_line(lex);
        s->end = (size_t)(lex->p - t->bytes);
        find_value(t, s);
        return true;
    }
    return false;
}

/* Returns true if the statement has one of these keys. */
static bool mtl_document_has_key(const struct mtl_document *t,
                                 const struct mtl_statement *s,
                                 mtl_aliases keys)
{
    struct word word = {t->bytes + s->key, s->key_end - s->key};

    for (int i = 0; i < MTL_MAP_KEYS && keys[i] != NULL; i++)
        if (word_is(word, keys[i]))
            return true;
    return false;
}

/* Returns the value of a statement, joined to one line, for free(). NULL when
 * memory is out. */
static char *rest_of(const struct mtl_document *t,
                     const struct mtl_statement *s)
{
    struct lexer lex = mtl_document_lex(t, s->key_end);

    return lexer_rest(&lex);
}

/* Finds the last block of this name. Returns false if there is none; blocks
 * without a name are not found. */
static bool mtl_document_find_block(const struct mtl_document *t,
                                    const char *name, struct mtl_block *b)
{
    static mtl_aliases newmtl = {"newmtl"};
    struct lexer lex = mtl_document_lex(t, 0);
    struct mtl_statement s;
    bool is_in = false;
    bool is_found = false;

    while (next_statement(t, &lex, &s)) {
        if (mtl_document_has_key(t, &s, newmtl)) {
            char *found = rest_of(t, &s);

            if (is_in)
                b->end = s.line;
            is_in = found != NULL && *found != '\0' && strcmp(found, name) == 0;
            is_found |= is_in;
            if (is_in)
                *b = (struct mtl_block){s, s, t->size};
            free(found);
        } else if (is_in) {
            b->last = s;
        }
    }
    return is_found;
}

/* Finds the last statement of a block with one of these keys. */
static bool find_statement(const struct mtl_document *t,
                           const struct mtl_block *b, mtl_aliases keys,
                           struct mtl_statement *found)
{
    struct lexer lex = mtl_document_lex(t, b->newmtl.end);
    struct mtl_statement s;
    bool is_found = false;

    while (next_statement(t, &lex, &s) && s.line < b->end) {
        if (!mtl_document_has_key(t, &s, keys))
            continue;
        *found = s;
        is_found = true;
    }
    return is_found;
}

/* Returns the line ends that an unterminated last line needs, for free(), or
 * NULL if memory is out. A line that ends in a backslash needs two, for the
 * backslash joins the next line. The same holds for a backslash and a carriage
 * return, to which the first line feed belongs. */
static char *final_line_end(const struct mtl_document *t)
{
    char last = t->size > 0 ? t->bytes[t->size - 1] : '\n';
    bool joins = last == '\\' || last == '\r';

    return format_text("%s%s", joins ? t->line_end : "", t->line_end);
}

/* Inserts a statement after the last one of the block, with the same
 * indentation. */
static bool mtl_document_insert(struct mtl_document *t,
                                const struct mtl_block *b, const char *key,
                                const char *value)
{
    const struct mtl_statement *last = &b->last;
    int indent = (int)(last->key - last->line);
    const char *margin = t->bytes + last->line;
    char *closing = last->is_unterminated ? final_line_end(t) : strdup("");
    char *line = closing == NULL
                     ? NULL
                     : format_text("%s%.*s%s %s%s%s", closing, indent, margin,
                                   key, value, lexer_rest_guard(value),
                                   last->is_unterminated ? "" : t->line_end);
    bool ok = line != NULL && mtl_document_splice(t, last->end, 0, line);

    free(line);
    free(closing);
    return ok;
}

/* Sets the value of a statement in the block of this name. Adds the statement
 * if the block does not have it. */
static bool mtl_document_set(struct mtl_document *t, const char *name,
                             mtl_aliases keys, const char *value)
{
    struct word word;
    struct mtl_statement s;
    struct mtl_block b;
    char *whole;
    bool ok;

    if (!mtl_document_find_block(t, name, &b))
        return false;
    if (!find_statement(t, &b, keys, &s))
        return mtl_document_insert(t, &b, keys[0], value);
    word = (struct word){t->bytes + s.key, s.key_end - s.key};
    if (word_is(word, keys[0]) && s.value > s.key_end)
        return mtl_document_splice(t, s.value, s.value_end - s.value, value);
    whole = format_text("%s %s", keys[0], value);
    ok = whole != NULL &&
         mtl_document_splice(t, s.key, s.value_end - s.key, whole);
    free(whole);
    return ok;
}

/* The first removes all statements with these keys from the block of this name
 * and keeps comments after them. The second turns the statements into
 * comments. */
static bool mtl_document_remove(struct mtl_document *t, const char *name,
                                mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_document_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        size_t length = s.value_end - s.key;

        if (!s.has_comment)
            mtl_document_splice(t, s.line, s.end - s.line, "");
        else
            mtl_document_splice(t, s.key, length, "");
    }
    return true;
}

static bool mtl_document_comment(struct mtl_document *t, const char *name,
                                 mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_document_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        char *rest = rest_of(t, &s);
        struct lexer lex = mtl_document_lex(t, s.key_end);
        size_t end;
        char *line;
        bool ok;

        free(lexer_rest(
            &lex)); /* reads to the end of the line: names may contain '#' */
        end = (size_t)(lex.p - t->bytes);
        if (rest == NULL)
            return false;
        line = format_text("#%.*s %s%s", (int)(s.key_end - s.key),
                           t->bytes + s.key, rest, lexer_rest_guard(rest));
        ok = line != NULL && mtl_document_splice(t, s.key, end - s.key, line);
        free(line);
        free(rest);
        if (!ok)
            return false;
    }
    return true;
}

/* Returns true if the last line of the text has no line end. */
static bool is_unterminated(const struct mtl_document *t)
{
    struct lexer lex = mtl_document_lex(t, 0);
    bool has_end = true;

    while (lex.p < lex.end)
        has_end = lexer_next_line(&lex);
    return !has_end;
}

/* Appends a new block with a copy of the statements of the block `copied_from`,
 * if that exists. */
static bool mtl_document_append_block(struct mtl_document *t, const char *name,
                                      const char *copied_from)
{
    char *closing = is_unterminated(t) ? final_line_end(t) : strdup("");
    char *head = closing == NULL
                     ? NULL
                     : format_text("%s%snewmtl %s%s%s", closing, t->line_end,
                                   name, lexer_rest_guard(name), t->line_end);
    struct mtl_block b;
    size_t length = 0; /* size of the copied block */
    char *copy = NULL;
    bool ok = head != NULL;

    if (mtl_document_find_block(t, copied_from, &b)) {
        length = b.last.end - b.newmtl.end;
        copy = alloc_array(length, 1);
        ok = ok && copy != NULL;
    }
    if (ok && length > 0)
        memcpy(copy, t->bytes + b.newmtl.end, length);
    ok = ok && mtl_document_splice(t, t->size, 0, head) &&
         splice(t, t->size, 0, copy != NULL ? copy : "", length);
    free(copy);
    free(head);
    free(closing);
    return ok;
}

/* ---- keys ---- */

static mtl_aliases light_keys = {"Ke", "Ke_blackbody"};
static mtl_aliases blackbody_keys = {"Ke_blackbody", "Ke"};

/* Sets the keys that mean this map in a file of the material's dialect. */
static void map_keys(const struct material_values *s, enum mtl_map map,
                     const char *keys[MTL_MAP_KEYS])
{
    memcpy(keys, mtl_maps[map].keys, sizeof mtl_maps[map].keys);
    if (mtl_maps[map].is_second_of_blender && s->dialect == MTL_CLASSIC)
        keys[1] = NULL;
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
    const struct material_values *a = c->before, *b = c->after;
    char text[2][DECIMAL_TEXT_BYTES], value[2 * DECIMAL_TEXT_BYTES];

    if (b->kelvin.line == 0)
        return write_color(w, c, light_keys,
                           a->kelvin.line == 0 ? &a->emission : &none,
                           &b->emission) &&
               (a->kelvin.line == 0 || b->emission.line != 0 ||
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
static char *map_value(const struct writer *w, const struct material_values *s,
                       enum mtl_map map)
{
    const struct texture *t = &w->scene->textures[s->maps[map]];
    double angle = w->scene->texture_origins[s->maps[map]].rotation_deg;
    char *name = path_seen_from(w->path, w->scene->texture_paths[s->maps[map]]);
    char *text = NULL;
    size_t size_bytes;
    struct text_stream stream;

    if (name != NULL && text_stream_open(&stream)) {
        FILE *to = stream.to;

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
        text = text_stream_close(&stream, &size_bytes);
    }
    free(name);
    return text;
}

static bool write_map(struct writer *w, const struct mtl_change *c,
                      enum mtl_map map)
{
    bool was_on = material_values_map(c->before, map) != NO_INDEX;
    bool is_on = material_values_map(c->after, map) != NO_INDEX;
    const char *keys[MTL_MAP_KEYS];
    struct mtl_block b;
    size_t hash;
    char *value;
    bool ok;

    if (was_on == is_on &&
        (!is_on || c->before->maps[map] == c->after->maps[map]))
        return true;
    map_keys(c->after, map, keys);
    if (!is_on)
        return mtl_document_comment(&w->text, c->name, keys);
    if (!mtl_document_find_block(&w->text, c->name, &b))
        return false;
    if (!was_on && find_commented_map(w, &b, keys, c->after->maps[map], &hash))
        return mtl_document_splice(&w->text, hash, 1, "");
    value = map_value(w, c->after, map);
    ok = value != NULL &&
         (was_on ? mtl_document_set(&w->text, c->name, keys, value)
                 : mtl_document_insert(&w->text, &b, keys[0], value));
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
    const struct material_values none = material_values_empty();
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

bool mtl_rewrite(const struct scene *scene, const struct file_bytes *old,
                 struct mtl_changes changes, char **text, size_t *size_bytes,
                 struct error *err)
{
    struct writer w = {.scene = scene, .path = old->path};
    const struct mtl_change *end = changes.items + changes.count;
    bool ok;

    ok = mtl_document_init(&w.text, old->bytes, old->size_bytes);
    /* new materials first: they copy blocks of the unchanged file */
    for (const struct mtl_change *c = changes.items; ok && c < end; c++)
        ok = c->copied_from == NULL || write_change(&w, c);
    for (const struct mtl_change *c = changes.items; ok && c < end; c++)
        ok = c->copied_from != NULL || write_change(&w, c);
    ok = ok &&
         keep_dialect(&w.text,
                      mtl_dialect_find(old->bytes, old->size_bytes).dialect);
    if (!ok) {
        free(w.text.bytes);
        return fail(err, "%s: out of memory for the changed materials",
                    old->path);
    }
    *text = w.text.bytes;
    *size_bytes = w.text.size;
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
              struct mtl_changes changes, struct file_change *change,
              struct error *err)
{
    char *old, *text;
    size_t old_bytes, size_bytes;
    bool ok;

    change->before = file_identify(path);
    if (!read_text(scene, path, change->before.exists, &old, &old_bytes, err))
        return false;
    ok = mtl_rewrite(scene, &(struct file_bytes){path, old, old_bytes}, changes,
                     &text, &size_bytes, err);
    free(old);
    if (!ok)
        return false;
    ok = file_replace(path, text, size_bytes, change, err);
    free(text);
    return ok;
}
