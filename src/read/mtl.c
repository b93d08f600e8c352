// SPDX-License-Identifier: MIT
#include "read/mtl.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "image/color.h"
#include "read/asset_path.h"
#include "read/scene_lists.h"
#include "scene/material.h"

/* ---- dialects ---- */

/* First version of the exporter that writes its version and these meanings. */
#define BLENDER_FIRST 3.1

/* First version of Blender's second principled surface. */
#define BLENDER_SECOND 4

/* Index of refraction of an untouched surface before the second one. Where the
 * line of the version was lost, it shows the version if most materials have
 * it. */
#define NI_BEFORE_SECOND "1.450000"

/* Index of refraction that exporters before 3.1 wrote. */
#define NI_OLD "1.000000"

/* ---- comments at the beginning of the file ---- */

/* Returns major and minor version as a decimal number, or 0. */
static double version_of(struct word word)
{
    char text[16];
    unsigned major, minor;

    snprintf(text, sizeof text, "%.*s", (int)word.length, word.start);
    if (word.length >= sizeof text ||
        sscanf(text, "%3u.%3u", &major, &minor) != 2)
        return 0;
    return (double)major + (minor < 10 ? 0.1 * minor : 0.01 * minor);
}

/* Reads a comment. Returns true if it decides the dialect. *is_script is set
 * for the exporter before 3.1, which names no version. */
static bool read_comment(struct lexer lex, struct mtl_dialect_found *found,
                         bool *is_script)
{
    struct word program, version;
    double number;

    lex.p++; /* the sign */
    program = lexer_word(&lex);
    version = lexer_word(&lex);
    if (word_is(program, "Wavefront") && word_is(version, "MTL"))
        return true;
    if (!word_is(program, "Blender"))
        return false;
    if (word_is(version, "MTL")) {
        *is_script = true;
        return true;
    }
    number = version_of(version);
    if (number < BLENDER_FIRST || !word_is(lexer_word(&lex), "MTL"))
        return number > 0;
    found->dialect = number < BLENDER_SECOND ? MTL_BLENDER_3 : MTL_BLENDER_4;
    snprintf(found->version, sizeof found->version, "%.*s", (int)version.length,
             version.start);
    return true;
}

/* Reads the comments before the first statement. */
static bool read_comments(struct lexer *lex, struct mtl_dialect_found *found,
                          bool *is_script)
{
    while (lex->p < lex->end && lexer_at_line_end(lex)) {
        if (lex->p < lex->end && *lex->p == '#' &&
            read_comment(*lex, found, is_script))
            return true;
        lexer_next_line(lex);
    }
    return false;
}

/* ---- order of the statements ---- */

/* Statements in the order of Blender's exporter. Maps replace some of them and
 * come last. */
static const struct {
    const char *key;
    int numbers;
} order[] = {
    {"Ns", 1},  {"Ka", 3},    {"Kd", 3},     {"Ks", 3}, {"Ke", 3}, {"Ni", 1},
    {"d", 1},   {"illum", 1}, {"Pr", 1},     {"Pm", 1}, {"Ps", 1}, {"Pc", 1},
    {"Pcr", 1}, {"aniso", 1}, {"anisor", 1}, {"Tf", 3},
};

#define ORDER ((int)(sizeof order / sizeof order[0]))

/* Places in the order. */
enum { AT_KA = 1, AT_NI = 5, AT_ILLUM = 7, AT_PC = 11 };

struct block {
    uint32_t keys; /* bit set of places in the order */
    int last;      /* place of the last statement; ORDER for a map */
};

struct pattern {
    struct block block;
    int blocks;
    bool is_broken;
    int old_indices, new_indices; /* of refraction; NI_OLD is neither */
    bool has_strong_coat;         /* Pc above 1, which only 4.0 writes */
};

/* Every material has Ni and illum. It has Ka without the extension, and with
 * it Pc, but never both. */
static void end_block(struct pattern *p)
{
    uint32_t keys = p->block.keys;
    bool has_ka = (keys >> AT_KA & 1) != 0, has_pc = (keys >> AT_PC & 1) != 0;

    if (p->blocks > 0 && ((keys >> AT_NI & 1) == 0 ||
                          (keys >> AT_ILLUM & 1) == 0 || has_ka == has_pc))
        p->is_broken = true;
    p->block = (struct block){0, -1};
}

static bool has_six_decimals(struct word word)
{
    const char *dot = memchr(word.start, '.', word.length);

    return dot != NULL && word.start + word.length - dot == 7;
}

static void check_numbers(struct pattern *p, struct lexer *lex, int place)
{
    struct word word = {"", 0};

    for (int i = 0; i < order[place].numbers; i++) {
        word = lexer_word(lex);
        p->is_broken |=
            place == AT_ILLUM ? word.length != 1 : !has_six_decimals(word);
    }
    p->is_broken |= !lexer_at_line_end(lex);
    if (place == AT_NI && !word_is(word, NI_OLD)) {
        p->old_indices += word_is(word, NI_BEFORE_SECOND);
        p->new_indices += !word_is(word, NI_BEFORE_SECOND);
    }
    if (place == AT_PC && !p->is_broken)
        p->has_strong_coat |= word.length != 8 || (*word.start != '0' &&
                                                   !word_is(word, "1.000000"));
}

static void read_statement(struct pattern *p, struct lexer *lex)
{
    struct word key = lexer_word(lex);
    int place = 0;

    if (word_is(key, "newmtl")) {
        end_block(p);
        p->blocks++;
        return;
    }
    while (place < ORDER && !word_is(key, order[place].key))
        place++;
    if (p->blocks == 0 || place < p->block.last ||
        (place == ORDER &&
         (key.length < 5 || memcmp(key.start, "map_", 4) != 0)) ||
        (place < ORDER && place == p->block.last)) {
        p->is_broken = true;
        return;
    }
    p->block.last = place;
    if (place < ORDER) {
        p->block.keys |= 1u << place;
        check_numbers(p, lex, place);
    }
}

/* Reads the order of all statements. Returns false if it is not Blender's. */
static bool read_order(struct pattern *p, struct lexer lex)
{
    *p = (struct pattern){.block = {0, -1}};
    for (; lex.p < lex.end && !p->is_broken; lexer_next_line(&lex))
        if (!lexer_at_line_end(&lex))
            read_statement(p, &lex);
    end_block(p);
    return !p->is_broken;
}

static enum mtl_dialect dialect_of_order(struct lexer lex)
{
    struct pattern p;

    if (!read_order(&p, lex) || p.old_indices + p.new_indices == 0)
        return MTL_CLASSIC;
    return p.old_indices > p.new_indices && !p.has_strong_coat ? MTL_BLENDER_3
                                                               : MTL_BLENDER_4;
}

/* Returns the dialect of a file without a version. Blender 2.8 to 3.0 wrote the
 * same meanings as 3.1, and its usual index of refraction; 2.7 did not. */
static enum mtl_dialect dialect_of_script(struct lexer lex)
{
    struct pattern p;

    return read_order(&p, lex) && p.old_indices > 0 ? MTL_BLENDER_3
                                                    : MTL_CLASSIC;
}

struct mtl_dialect_found mtl_dialect_find(const char *text, size_t size_bytes)
{
    struct mtl_dialect_found found = {.dialect = MTL_CLASSIC};
    struct lexer lex;
    bool is_script = false;

    lexer_init(&lex, text, size_bytes);
    if (!read_comments(&lex, &found, &is_script))
        found.dialect = dialect_of_order(lex);
    else if (is_script)
        found.dialect = dialect_of_script(lex);
    return found;
}

const char *mtl_dialect_line(enum mtl_dialect dialect)
{
    if (dialect == MTL_CLASSIC)
        return "# Wavefront MTL File";
    return dialect == MTL_BLENDER_3 ? "# Blender 3.4.0 MTL File"
                                    : "# Blender 5.0.0 MTL File";
}

/* ---- maps ---- */

/* Limit for the scale of bump maps; steeper heights have no use. */
#define BUMP_MAX 1e6

enum map_option {
    OPTION_OFFSET,
    OPTION_SCALE,
    OPTION_CLAMP,
    OPTION_BUMP,
    OPTION_CHANNEL,
    OPTION_MIRROR,
    OPTION_NEAREST,
    OPTION_ROTATE,
    OPTION_UV,
    OPTION_ALPHA,
    OPTION_OTHER
};

/* Map options and the number of words after each. -o, -s and -t take 1 to 3
 * numbers. -alpha, -mirror, -nearest, -rotate and -uv are glim's own. */
static const struct {
    const char *name;
    enum map_option option;
    int least, most;
} options[] = {
    {"-alpha", OPTION_ALPHA, 1, 1},     {"-blendu", OPTION_OTHER, 1, 1},
    {"-blendv", OPTION_OTHER, 1, 1},    {"-bm", OPTION_BUMP, 1, 1},
    {"-boost", OPTION_OTHER, 1, 1},     {"-cc", OPTION_OTHER, 1, 1},
    {"-clamp", OPTION_CLAMP, 1, 1},     {"-imfchan", OPTION_CHANNEL, 1, 1},
    {"-mirror", OPTION_MIRROR, 1, 1},   {"-mm", OPTION_OTHER, 2, 2},
    {"-nearest", OPTION_NEAREST, 1, 1}, {"-o", OPTION_OFFSET, 1, 3},
    {"-rotate", OPTION_ROTATE, 1, 1},   {"-s", OPTION_SCALE, 1, 3},
    {"-t", OPTION_OTHER, 1, 3},         {"-texres", OPTION_OTHER, 1, 1},
    {"-type", OPTION_OTHER, 1, 1},      {"-uv", OPTION_UV, 1, 1},
};

#define OPTION_COUNT (sizeof options / sizeof options[0])

/* Returns the first two numbers as floats, or `other` if a float cannot hold
 * one of them. */
static struct vec2 finite_pair(const double values[3], struct vec2 other)
{
    if (!(fabs(values[0]) <= (double)FLT_MAX) ||
        !(fabs(values[1]) <= (double)FLT_MAX))
        return other;
    return (struct vec2){(float)values[0], (float)values[1]};
}

static size_t find_option(struct word word)
{
    size_t i = 0;

    while (i < OPTION_COUNT && !word_is(word, options[i].name))
        i++;
    return i;
}

/* Sets or clears flags by a value that is on, off, or the axis u or v. */
static void set_flags(struct texture *t, uint32_t u, uint32_t v,
                      struct word word)
{
    bool is_on = word_is(word, "on");

    t->flags &= ~(u | v);
    if (is_on || word_is(word, "u"))
        t->flags |= u;
    if (is_on || word_is(word, "v"))
        t->flags |= v;
}

/* Sets the channel. Returns false for one that glim does not know. */
static bool set_channel(struct texture *t, struct word word)
{
    static const char names[] = "rgbm";
    const char *at = word.length == 1 ? strchr(names, *word.start) : NULL;

    if (at == NULL && !word_is(word, "l"))
        return false;
    t->channel = at ? CHANNEL_RED + (uint32_t)(at - names) : CHANNEL_GREY;
    return true;
}

static void set_word(struct mtl_map_options *o, enum map_option option,
                     struct word word)
{
    struct texture *t = &o->texture;

    if (option == OPTION_CLAMP)
        set_flags(t, TEXTURE_CLAMP_U, TEXTURE_CLAMP_V, word);
    else if (option == OPTION_MIRROR)
        set_flags(t, TEXTURE_MIRROR_U, TEXTURE_MIRROR_V, word);
    else if (option == OPTION_NEAREST)
        set_flags(t, TEXTURE_NEAREST, TEXTURE_NEAREST, word);
    else if (option == OPTION_ALPHA)
        t->flags = word_is(word, "off") ? t->flags | TEXTURE_OPAQUE
                                        : t->flags & ~(uint32_t)TEXTURE_OPAQUE;
    else if (option == OPTION_UV)
        t->flags = word_is(word, "1")
                       ? t->flags | TEXTURE_SECOND_UVS
                       : t->flags & ~(uint32_t)TEXTURE_SECOND_UVS;
    else if (option != OPTION_CHANNEL || !set_channel(t, word))
        o->unknown_count++;
}

static void set_option(struct mtl_map_options *o, enum map_option option,
                       const double values[3], struct word word)
{
    if (option == OPTION_OFFSET)
        o->texture.offset = finite_pair(values, o->texture.offset);
    else if (option == OPTION_SCALE)
        o->texture.scale = finite_pair(values, o->texture.scale);
    else if (option == OPTION_BUMP)
        o->bump_scale = fabs(values[0]) <= BUMP_MAX ? values[0] : 1;
    else if (option == OPTION_ROTATE)
        o->rotation_deg = isfinite(values[0]) ? values[0] : 0;
    else
        set_word(o, option, word);
}

static bool has_number(enum map_option option)
{
    return option == OPTION_BUMP || option == OPTION_ROTATE;
}

/* Returns true for a word that looks like an option: a minus and a word without
 * the dot of a file name. */
static bool looks_like_option(struct word word)
{
    return word.length >= 2 && word.start[0] == '-' &&
           ((word.start[1] | 32) >= 'a' && (word.start[1] | 32) <= 'z') &&
           memchr(word.start, '.', word.length) == NULL;
}

/* Reads an option that no list has, as -colorspace of Autodesk's programs, with
 * its one value. A name must be left: the last word is no option, and the word
 * before it no value. */
static bool read_unknown(struct lexer *lex, struct mtl_map_options *o)
{
    struct lexer next = *lex, behind;

    if (!looks_like_option(lexer_word(&next)) || lexer_at_line_end(&next))
        return false;
    behind = next;
    if (!looks_like_option(lexer_word(&behind)) && !lexer_at_line_end(&behind))
        next = behind;
    *lex = next;
    o->unknown_count++;
    return true;
}

/* Reads an option and its values. Returns false if the next word is none. */
static bool read_option(struct lexer *lex, struct mtl_map_options *o)
{
    struct lexer start = *lex;
    size_t i = find_option(lexer_word(lex));
    double values[3] = {0, 0, 0};
    struct word word = {"", 0};
    bool has_numbers;

    if (i == OPTION_COUNT) {
        *lex = start;
        return false;
    }
    if (options[i].option == OPTION_SCALE || options[i].option == OPTION_BUMP)
        values[0] = values[1] = 1;
    has_numbers = options[i].most == 3 || has_number(options[i].option);
    for (int n = 0; n < options[i].most; n++) {
        if (has_numbers && lexer_number(lex, &values[n]))
            continue;
        if (n >= options[i].least)
            break;
        word = lexer_word(lex);
    }
    set_option(o, options[i].option, values, word);
    return true;
}

/* Reads options after the file name, which some programs write, and removes
 * them from the name. */
static void cut_options(char *name, struct mtl_map_options *o)
{
    const char *end = name + strlen(name);
    char *cut = NULL;

    for (char *p = name; (p = strchr(p, ' ')) != NULL; p++) {
        struct lexer lex = {p + 1, end, 1};

        if (p == name || p[1] != '-' || !read_option(&lex, o))
            continue;
        if (cut == NULL)
            cut = p;
    }
    if (cut == NULL)
        return;
    while (cut > name && cut[-1] == ' ')
        cut--;
    *cut = '\0';
}

char *mtl_map_read(struct lexer *lex, struct mtl_map_options *o)
{
    char *name;

    *o =
        (struct mtl_map_options){.texture = texture_default(), .bump_scale = 1};
    while (read_option(lex, o) || read_unknown(lex, o))
        continue;
    name = lexer_rest(lex);
    if (name != NULL)
        cut_options(name, o);
    texture_rotate(&o->texture, o->rotation_deg);
    return name;
}

/* ---- statements ---- */

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

uint32_t mtl_add_map(struct scene *scene, enum mtl_map map, const char *path)
{
    struct texture_origin origin = {.file = NO_INDEX,
                                    .is_opacity = map == MTL_MAP_OPACITY};
    struct texture texture = texture_default();
    struct texture_table table;
    uint32_t number = NO_INDEX;

    texture.is_data = mtl_maps[map].is_data;
    if (texture_table_init(&table, scene))
        number = texture_table_add(&table, path, &texture, &origin);
    texture_table_free(&table);
    return number;
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
    if (!(kelvin >= 0 && kelvin <= BLACKBODY_MAX)) {
        warnings_add(p->report, "temperatures out of range",
                     "%s:%" PRIu64
                     ": found %.*s %g, expected kelvins from 0 to "
                     "%g: taken as 0",
                     p->path, p->lex.line, (int)key.length, key.start, kelvin,
                     BLACKBODY_MAX);
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

/* Returns the map of a statement, or MTL_MAPS. */
static enum mtl_map find_map(const struct parser *p, struct word key)
{
    for (int i = 0; i < MTL_MAPS; i++) {
        const struct mtl_map_kind *m = &mtl_maps[i];
        bool has_second = !m->is_second_of_blender || p->dialect != MTL_CLASSIC;

        for (int k = 0; k < MTL_MAP_KEYS && m->keys[k] != NULL; k++)
            if (word_is(key, m->keys[k]) && (k == 0 || has_second))
                return (enum mtl_map)i;
    }
    return MTL_MAPS;
}

static bool read_property(struct parser *p, struct word key)
{
    struct material_values *s = &p->source;
    const struct mtl_property *property = find_property(p, key);
    enum mtl_map map = find_map(p, key);

    if (word_is(key, "Ke"))
        return read_light(p, key);
    if (word_is(key, "Ke_blackbody"))
        return read_blackbody(p, key);
    if (property != NULL) {
        void *member = (char *)s + property->member;

        return property->is_color ? read_color(p, key, member)
                                  : read_number(p, key, member);
    }
    if (map != MTL_MAPS)
        return read_map(p, key, mtl_maps[map].is_data, &s->maps[map],
                        material_values_map_scale(s, map));
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
