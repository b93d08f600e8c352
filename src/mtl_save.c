// SPDX-License-Identifier: MIT
#include "glim/mtl_save.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/asset.h"
#include "glim/file.h"
#include "glim/lex.h"
#include "glim/map.h"
#include "glim/number.h"

/* Statements that stand for each other: the last one counts. The first name is
 * the one that is written. */
#define ALIASES_MAX 3
typedef const char *const aliases[ALIASES_MAX];

static aliases light_keys = {"Ke", "Ke_blackbody"};
static aliases blackbody_keys = {"Ke_blackbody", "Ke"};
static aliases map_keys[MTL_MAPS] = {
    {"map_Kd"}, {"map_Ks"}, {"map_Ke"}, {"map_Pr"},
    {"map_Pm"}, {"map_d"},  {"norm"},   {"map_Bump", "map_bump", "bump"},
};

struct text {
    char *bytes;
    size_t size;
};

/* Where a statement stands in the text. */
struct statement {
    size_t line;             /* its line begins here, */
    size_t key, key_end;     /* the first word, */
    size_t value, value_end; /* the words after it, */
    size_t end;              /* behind the end of its line */
    bool has_comment;
};

/* A newmtl statement, and its last one (itself if there is no other). */
struct block {
    struct statement newmtl, last;
    size_t end; /* the next newmtl, or the end of the text */
};

struct writer {
    const struct scene *scene;
    const char *path;
    struct text text;
    const char *line_end;
};

/* Puts `insert` in the place of `removed` bytes. False when memory is out. */
static bool splice(struct text *t, size_t at, size_t removed,
                   const char *insert)
{
    size_t added = strlen(insert);
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

static struct lex lex_at(const struct text *t, size_t at)
{
    struct lex lex;

    if (at == 0)
        lex_init(&lex, t->bytes, t->size);
    else
        lex = (struct lex){t->bytes + at, t->bytes + t->size, 1};
    return lex;
}

/* The next statement from *lex on, which moves behind its line. */
static bool next_statement(const struct text *t, struct lex *lex,
                           struct statement *s)
{
    for (; lex->p < lex->end; lex_next_line(lex)) {
        struct word word;

        s->line = (size_t)(lex->p - t->bytes);
        if (lex_at_line_end(lex))
            continue;
        word = lex_word(lex);
        s->key = (size_t)(word.start - t->bytes);
        s->key_end = s->value = s->value_end = s->key + word.length;
        while (!lex_at_line_end(lex)) {
            bool is_option = word_is(word, "-halo");

            word = lex_word(lex);
            if (s->value == s->key_end || is_option)
                s->value = (size_t)(word.start - t->bytes);
            s->value_end = (size_t)(lex->p - t->bytes);
        }
        s->has_comment = lex->p < lex->end && *lex->p == '#';
        lex_next_line(lex);
        s->end = (size_t)(lex->p - t->bytes);
        return true;
    }
    return false;
}

static bool has_key(const struct text *t, const struct statement *s,
                    aliases keys)
{
    struct word word = {t->bytes + s->key, s->key_end - s->key};

    for (int i = 0; i < ALIASES_MAX && keys[i] != NULL; i++)
        if (word_is(word, keys[i]))
            return true;
    return false;
}

/* What follows the key, joined to one line. NULL when memory is out. */
static char *rest_of(const struct text *t, const struct statement *s)
{
    struct lex lex = lex_at(t, s->key_end);

    return lex_rest(&lex);
}

/* The last block of this name. False if there is none or memory is out. */
static bool find_block(const struct text *t, const char *name, struct block *b)
{
    static aliases newmtl = {"newmtl"};
    struct lex lex = lex_at(t, 0);
    struct statement s;
    bool is_in = false;
    bool is_found = false;

    while (next_statement(t, &lex, &s)) {
        if (has_key(t, &s, newmtl)) {
            char *found = rest_of(t, &s);

            if (is_in)
                b->end = s.line;
            is_in = found != NULL && strcmp(found, name) == 0;
            is_found |= is_in;
            if (is_in)
                *b = (struct block){s, s, t->size};
            free(found);
        } else if (is_in) {
            b->last = s;
        }
    }
    return is_found;
}

/* The last statement of the block with one of these keys. */
static bool find_statement(const struct text *t, const struct block *b,
                           aliases keys, struct statement *found)
{
    struct lex lex = lex_at(t, b->newmtl.end);
    struct statement s;
    bool is_found = false;

    while (next_statement(t, &lex, &s) && s.line < b->end) {
        if (!has_key(t, &s, keys))
            continue;
        *found = s;
        is_found = true;
    }
    return is_found;
}

static bool ends_line(char c)
{
    return c == '\n' || c == '\r';
}

/* A statement of its own behind the last one of the block, as far from the
 * margin as that. */
static bool insert_line(struct writer *w, const struct block *b,
                        const char *key, const char *value)
{
    const struct statement *last = &b->last;
    int indent = (int)(last->key - last->line);
    const char *margin = w->text.bytes + last->line;
    bool is_open = !ends_line(w->text.bytes[last->end - 1]);
    char *line = xformat("%s%.*s%s %s%s", is_open ? w->line_end : "", indent,
                         margin, key, value, is_open ? "" : w->line_end);
    bool ok = splice(&w->text, last->end, 0, line);

    free(line);
    return ok;
}

/* Gives the statement this value, wherever in the block it is. */
static bool set_value(struct writer *w, const char *name, aliases keys,
                      const char *value)
{
    struct word word;
    struct statement s;
    struct block b;
    char *whole;
    bool ok;

    if (!find_block(&w->text, name, &b))
        return false;
    if (!find_statement(&w->text, &b, keys, &s))
        return insert_line(w, &b, keys[0], value);
    word = (struct word){w->text.bytes + s.key, s.key_end - s.key};
    if (word_is(word, keys[0]) && s.value > s.key_end)
        return splice(&w->text, s.value, s.value_end - s.value, value);
    whole = xformat("%s %s", keys[0], value);
    ok = splice(&w->text, s.key, s.value_end - s.key, whole);
    free(whole);
    return ok;
}

/* Removes all such statements of the block, but not the comments behind them.
 */
static bool remove_value(struct writer *w, const char *name, aliases keys)
{
    struct statement s;
    struct block b;

    while (find_block(&w->text, name, &b) &&
           find_statement(&w->text, &b, keys, &s)) {
        size_t length = s.value_end - s.key;

        if (!s.has_comment)
            splice(&w->text, s.line, s.end - s.line, "");
        else
            splice(&w->text, s.key, length, "");
    }
    return true;
}

static bool write_color(struct writer *w, const struct mtl_change *c,
                        aliases keys, const struct mtl_color *before,
                        const struct mtl_color *after)
{
    char text[3][NUMBER_TEXT_BYTES], value[3 * NUMBER_TEXT_BYTES];

    if (after->line == 0)
        return before->line == 0 || remove_value(w, c->name, keys);
    if (before->line != 0 &&
        memcmp(before->rgb, after->rgb, sizeof before->rgb) == 0)
        return true;
    for (int i = 0; i < 3; i++)
        number_format(text[i], after->rgb[i]);
    snprintf(value, sizeof value, "%s %s %s", text[0], text[1], text[2]);
    return set_value(w, c->name, keys, value);
}

static bool write_number(struct writer *w, const struct mtl_change *c,
                         aliases keys, const struct mtl_number *before,
                         const struct mtl_number *after)
{
    char text[NUMBER_TEXT_BYTES];

    if (after->line == 0)
        return before->line == 0 || remove_value(w, c->name, keys);
    if (before->line != 0 && before->value == after->value)
        return true;
    number_format(text, after->value);
    return set_value(w, c->name, keys, text);
}

/* Ke or Ke_blackbody, whichever counts. */
static bool write_light(struct writer *w, const struct mtl_change *c)
{
    static const struct mtl_color none = {.line = 0};
    const struct mtl_source *a = c->before, *b = c->after;
    char text[2][NUMBER_TEXT_BYTES], value[2 * NUMBER_TEXT_BYTES];

    if (b->kelvin.line == 0)
        return write_color(w, c, light_keys,
                           a->kelvin.line == 0 ? &a->ke : &none, &b->ke) &&
               (a->kelvin.line == 0 || b->ke.line != 0 ||
                remove_value(w, c->name, light_keys));
    if (a->kelvin.line != 0 && a->kelvin.value == b->kelvin.value &&
        a->luminance.value == b->luminance.value)
        return true;
    number_format(text[0], b->kelvin.value);
    number_format(text[1], b->luminance.value);
    snprintf(value, sizeof value, "%s %s", text[0], text[1]);
    return set_value(w, c->name, blackbody_keys, value);
}

/* Turns the block's statements of a map into comments. */
static bool comment_map(struct writer *w, const char *name, aliases keys)
{
    struct statement s;
    struct block b;

    while (find_block(&w->text, name, &b) &&
           find_statement(&w->text, &b, keys, &s)) {
        char *rest = rest_of(&w->text, &s);
        struct lex lex = lex_at(&w->text, s.key_end);
        size_t end;
        char *line;
        bool ok;

        free(lex_rest(&lex)); /* a name may hold a '#': the rest is all of it */
        end = (size_t)(lex.p - w->text.bytes);
        if (rest == NULL)
            return false;
        line = xformat("#%.*s %s", (int)(s.key_end - s.key),
                       w->text.bytes + s.key, rest);
        ok = splice(&w->text, s.key, end - s.key, line);
        free(line);
        free(rest);
        if (!ok)
            return false;
    }
    return true;
}

/* Whether what stands at `at` is a statement of a map that means the texture.
 */
static bool is_map(const struct writer *w, size_t at, aliases keys,
                   uint32_t texture)
{
    struct statement s = {.key = at};
    struct lex lex = lex_at(&w->text, at);
    struct map_options options;
    struct word word = lex_word(&lex);
    char *name, *path;
    bool is_same;

    s.key_end = at + word.length;
    if (!has_key(&w->text, &s, keys))
        return false;
    name = map_read(&lex, &options);
    path = name == NULL ? NULL : asset_find(w->path, name);
    is_same =
        path != NULL && strcmp(path, w->scene->texture_paths[texture]) == 0;
    free(path);
    free(name);
    return is_same;
}

/* Finds the last comment of the block that was a statement of the map. */
static bool find_commented_map(const struct writer *w, const struct block *b,
                               aliases keys, uint32_t texture, size_t *at)
{
    struct lex lex = lex_at(&w->text, b->newmtl.end);
    const char *end = w->text.bytes + b->end;
    bool is_found = false;

    for (; lex.p < end; lex_next_line(&lex)) {
        size_t hash;

        lex_skip_blanks(&lex);
        hash = (size_t)(lex.p - w->text.bytes);
        if (lex.p == end || *lex.p != '#' ||
            !is_map(w, hash + 1, keys, texture))
            continue;
        *at = hash;
        is_found = true;
    }
    return is_found;
}

static void print_pair(FILE *to, const char *option, struct vec2 v)
{
    char x[NUMBER_TEXT_BYTES], y[NUMBER_TEXT_BYTES];

    number_format(x, (double)v.x);
    number_format(y, (double)v.y);
    fprintf(to, "%s %s %s 0 ", option, x, y);
}

/* What follows the key of a map: options and the name. */
static char *map_value(const struct writer *w, const struct mtl_source *s,
                       enum mtl_map map)
{
    const struct texture *t = &w->scene->textures[s->maps[map]];
    char *name = path_seen_from(w->path, w->scene->texture_paths[s->maps[map]]);
    char bump[NUMBER_TEXT_BYTES];
    char *text = NULL;
    size_t size_bytes;
    FILE *to = open_memstream(&text, &size_bytes);

    if (to != NULL) {
        if (t->scale.x != 1 || t->scale.y != 1)
            print_pair(to, "-s", t->scale);
        if (t->offset.x != 0 || t->offset.y != 0)
            print_pair(to, "-o", t->offset);
        if (t->is_clamped != 0)
            fputs("-clamp on ", to);
        number_format(bump, s->bump_scale);
        if (map == MTL_MAP_BUMP && s->bump_scale != 1)
            fprintf(to, "-bm %s ", bump);
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
    struct block b;
    size_t hash;
    char *value;
    bool ok;

    if (was_on == is_on)
        return true;
    if (!is_on)
        return comment_map(w, c->name, map_keys[map]);
    if (!find_block(&w->text, c->name, &b))
        return false;
    if (find_commented_map(w, &b, map_keys[map], c->after->maps[map], &hash))
        return splice(&w->text, hash, 1, "");
    value = map_value(w, c->after, map);
    ok = value != NULL && insert_line(w, &b, map_keys[map][0], value);
    free(value);
    return ok;
}

/* A new block at the end of the text: a copy of the other's statements. */
static bool append_block(struct writer *w, const struct mtl_change *c)
{
    struct text *t = &w->text;
    bool is_open = t->size > 0 && !ends_line(t->bytes[t->size - 1]);
    struct block b;
    char *text;
    bool ok;

    if (find_block(t, c->copied_from, &b))
        text =
            xformat("%s%snewmtl %s%s%.*s", is_open ? w->line_end : "",
                    w->line_end, c->name, w->line_end,
                    (int)(b.last.end - b.newmtl.end), t->bytes + b.newmtl.end);
    else
        text = xformat("%s%snewmtl %s%s", is_open ? w->line_end : "",
                       w->line_end, c->name, w->line_end);
    ok = splice(t, t->size, 0, text);
    free(text);
    return ok;
}

static bool write_change(struct writer *w, const struct mtl_change *c)
{
    const struct mtl_source *a = c->before, *b = c->after;
    const struct {
        aliases keys;
        const struct mtl_number *before, *after;
    } numbers[] = {
        {{"illum"}, &a->illum, &b->illum},
        {{"Ns"}, &a->ns, &b->ns},
        {{"Ni"}, &a->ni, &b->ni},
        {{"d"}, &a->d, &b->d},
        {{"Tr"}, &a->tr, &b->tr},
        {{"Pr"}, &a->pr, &b->pr},
        {{"Pm"}, &a->pm, &b->pm},
        {{"Kd_roughness"}, &a->kd_roughness, &b->kd_roughness},
    };
    static aliases kd = {"Kd"}, ks = {"Ks"}, tf = {"Tf"};
    struct block block;
    bool ok = c->copied_from == NULL || append_block(w, c);

    if (ok && !find_block(&w->text, c->name, &block)) {
        /* somebody has removed it from the file: it comes back */
        struct mtl_source none = mtl_source_empty();
        struct mtl_change whole = {c->name, c->name, &none, c->after};

        return write_change(w, &whole);
    }
    ok = ok && write_color(w, c, kd, &a->kd, &b->kd) &&
         write_color(w, c, ks, &a->ks, &b->ks) &&
         write_color(w, c, tf, &a->tf, &b->tf) && write_light(w, c);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        ok = ok && write_number(w, c, numbers[i].keys, numbers[i].before,
                                numbers[i].after);
    for (int i = 0; i < MTL_MAPS; i++)
        ok = ok && write_map(w, c, (enum mtl_map)i);
    return ok;
}

/* The end of the first line, or a line feed. */
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

bool mtl_rewrite(const struct scene *scene, const char *path, const char *text,
                 size_t size_bytes, const struct mtl_change *changes,
                 size_t change_count, char **new_text, size_t *new_size_bytes,
                 struct error *err)
{
    struct writer w = {.scene = scene, .path = path};
    bool ok;

    w.text = (struct text){alloc_array(size_bytes + 1, 1), size_bytes};
    w.line_end = line_end_of(text, size_bytes);
    ok = w.text.bytes != NULL;
    if (ok)
        memcpy(w.text.bytes, text, size_bytes);
    /* new ones copy blocks that are as the file has them */
    for (size_t i = 0; ok && i < change_count; i++)
        ok = changes[i].copied_from == NULL || write_change(&w, &changes[i]);
    for (size_t i = 0; ok && i < change_count; i++)
        ok = changes[i].copied_from != NULL || write_change(&w, &changes[i]);
    if (!ok) {
        free(w.text.bytes);
        return fail(err, "%s: out of memory for the changed materials", path);
    }
    *new_text = w.text.bytes;
    *new_size_bytes = w.text.size;
    return true;
}

bool mtl_save(const struct scene *scene, const char *path,
              const struct mtl_change *changes, size_t change_count,
              struct error *err)
{
    char *text, *new_text;
    size_t size_bytes, new_size_bytes;
    bool ok;

    if (!file_read(path, &text, &size_bytes, err))
        return false;
    ok = mtl_rewrite(scene, path, text, size_bytes, changes, change_count,
                     &new_text, &new_size_bytes, err);
    free(text);
    if (!ok)
        return false;
    ok = file_write(path, new_text, new_size_bytes, false, NULL, err);
    free(new_text);
    return ok;
}
