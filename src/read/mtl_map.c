// SPDX-License-Identifier: MIT
#include "read/mtl_map.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "read/scene_lists.h"

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
