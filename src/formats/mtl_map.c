// SPDX-License-Identifier: MIT
#include "formats/mtl_map.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Limit for the scale of bump maps; steeper heights have no use. */
#define BUMP_MAX 1e6

enum map_option {
    OPTION_OFFSET,
    OPTION_SCALE,
    OPTION_CLAMP,
    OPTION_BUMP,
    OPTION_OTHER
};

/* Map options and the number of words after each. -o, -s and -t take 1 to 3
 * numbers. */
static const struct {
    const char *name;
    enum map_option option;
    int least, most;
} options[] = {
    {"-blendu", OPTION_OTHER, 1, 1},  {"-blendv", OPTION_OTHER, 1, 1},
    {"-bm", OPTION_BUMP, 1, 1},       {"-boost", OPTION_OTHER, 1, 1},
    {"-cc", OPTION_OTHER, 1, 1},      {"-clamp", OPTION_CLAMP, 1, 1},
    {"-imfchan", OPTION_OTHER, 1, 1}, {"-mm", OPTION_OTHER, 2, 2},
    {"-o", OPTION_OFFSET, 1, 3},      {"-s", OPTION_SCALE, 1, 3},
    {"-t", OPTION_OTHER, 1, 3},       {"-texres", OPTION_OTHER, 1, 1},
    {"-type", OPTION_OTHER, 1, 1},
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

static void set_option(struct mtl_map_options *o, enum map_option option,
                       const double values[3], struct word word)
{
    if (option == OPTION_OFFSET)
        o->texture.offset = finite_pair(values, o->texture.offset);
    else if (option == OPTION_SCALE)
        o->texture.scale = finite_pair(values, o->texture.scale);
    else if (option == OPTION_BUMP)
        o->bump_scale = fabs(values[0]) <= BUMP_MAX ? values[0] : 1;
    else if (option == OPTION_CLAMP)
        o->texture.is_clamped = word_is(word, "on");
    else
        o->unknown_count++;
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
    has_numbers = options[i].most == 3 || options[i].option == OPTION_BUMP;
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
        (struct mtl_map_options){.texture = {.scale = {1, 1}}, .bump_scale = 1};
    while (read_option(lex, o) || read_unknown(lex, o))
        continue;
    name = lexer_rest(lex);
    if (name != NULL)
        cut_options(name, o);
    return name;
}
