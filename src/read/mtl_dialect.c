// SPDX-License-Identifier: MIT
#include "read/mtl_dialect.h"

#include <stdio.h>
#include <string.h>

#include "base/lexer.h"

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
