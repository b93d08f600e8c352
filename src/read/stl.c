// SPDX-License-Identifier: MIT
/*
 * stl.c - both kinds of STL file
 *
 * Binary: 80 bytes of any text, a count, and for each triangle a normal, three
 * corners and 16 bits, which some programs use for a colour. The text may begin
 * with "solid", so the size decides. Programs that write a stream leave the
 * count 0 or -1; the size has it, too.
 */
#include "read/stl.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/lexer.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "base/print.h"
#include "read/face_tris.h"
#include "read/mesh_finish.h"
#include "read/scene_lists.h"
#include "read/weld.h"
#include "kernels/vec.h"

#define HEADER_BYTES 80
#define BEGIN_BYTES  84 /* header and count */
#define FACET_BYTES  50

/* Offsets in a facet: its normal comes first. */
#define CORNERS_AT   12
#define ATTRIBUTE_AT 48

/* Bytes that are searched for a NUL, which no text has. */
#define TEXT_CHECK_BYTES 1024

struct reader {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    struct error *err;
    struct face_tris tris;
    struct weld weld;
    size_t position_capacity;
    struct name_table solids; /* names of objects; 0 is "" */
    uint32_t object;
    struct vec3 *face_colors; /* sRGB, then linear; NULL: none */
};

static bool out_of_memory(const struct reader *r)
{
    return fail(r->err, "%s: out of memory for the scene", r->path);
}

static uint32_t load_u32(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;

    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 |
           (uint32_t)b[3] << 24;
}

static uint32_t load_u16(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;

    return (uint32_t)b[0] | (uint32_t)b[1] << 8;
}

static double load_float(const char *p)
{
    uint32_t bits = load_u32(p);
    float x;

    memcpy(&x, &bits, sizeof x);
    return (double)x;
}

static uint64_t binary_bytes(const char *bytes)
{
    return BEGIN_BYTES + (uint64_t)FACET_BYTES * load_u32(bytes + HEADER_BYTES);
}

static bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Returns true for a text that begins with "solid", in any letter case. */
static bool is_text(const char *bytes, size_t size_bytes)
{
    size_t checked, i = 0;

    lexer_trim(&bytes, &size_bytes);
    checked = size_bytes < TEXT_CHECK_BYTES ? size_bytes : TEXT_CHECK_BYTES;
    while (i < checked && is_space(bytes[i]))
        i++;
    return checked >= i + 6 && strncasecmp(bytes + i, "solid", 5) == 0 &&
           is_space(bytes[i + 5]) && memchr(bytes, '\0', checked) == NULL;
}

/* The size of a text is never that of binary data: its count would have the
 * bytes of letters and be above 500 million. */
static bool is_binary_by_size(const char *bytes, size_t size_bytes)
{
    return size_bytes > BEGIN_BYTES && binary_bytes(bytes) == size_bytes;
}

bool stl_matches(const char *bytes, size_t size_bytes)
{
    return is_binary_by_size(bytes, size_bytes) || is_text(bytes, size_bytes);
}

/* ---- triangles ---- */

/* Returns in *v the vertex at a position, which is added if it is new. */
static bool add_vertex(struct reader *r, const double p[3], uint32_t *v)
{
    struct scene *s = r->scene;
    void *positions = s->file_positions;

    if (s->position_count == NO_INDEX - 1 ||
        !grow_array(&positions, &r->position_capacity,
                    (size_t)s->position_count + 1, 3 * sizeof *p))
        return out_of_memory(r);
    s->file_positions = positions;
    memcpy(s->file_positions + 3 * (size_t)s->position_count, p, 3 * sizeof *p);
    if (!weld_add(&r->weld, s->file_positions, s->position_count, v))
        return out_of_memory(r);
    s->position_count += *v == s->position_count;
    return true;
}

static bool add_facet(struct reader *r, double corners[3][3],
                      struct file_place place)
{
    struct face_tris *f = &r->tris;

    if (f->face_count == NO_INDEX - 1 || !face_tris_reserve(f, 3))
        return out_of_memory(r);
    for (int k = 0; k < 3; k++) {
        uint32_t v;

        if (!add_vertex(r, corners[k], &v))
            return false;
        f->corners[k] = (struct corner){v, NO_INDEX, NO_INDEX};
        memcpy(f->points + 3 * k, corners[k], 3 * sizeof *f->points);
    }
    f->corner_count = 3;
    if (!face_tris_add(f, r->object, MESH_MATERIAL, place))
        return out_of_memory(r);
    f->face_count++;
    return true;
}

/* ---- binary ---- */

/* Colour of the facets that have none of their own: Materialise Magics writes
 * it behind COLOR= into the header. */
static bool find_magics_color(const char *header, struct vec3 *color)
{
    const char *p = memmem(header, HEADER_BYTES, "COLOR=", 6);
    const unsigned char *b;

    if (p == NULL || p + 10 > header + HEADER_BYTES)
        return false;
    b = (const unsigned char *)p + 6;
    *color = v3((float)b[0] / 255, (float)b[1] / 255, (float)b[2] / 255);
    return true;
}

/* Returns the colour of three times five bits, of which red are the lowest. */
static struct vec3 color_of(uint32_t bits)
{
    return v3((float)(bits & 31) / 31, (float)(bits >> 5 & 31) / 31,
              (float)(bits >> 10 & 31) / 31);
}

static struct vec3 turned(struct vec3 c)
{
    return v3(c.z, c.y, c.x);
}

/* Reads the colours of all facets if there are any. In Magics' files bit 15 is
 * clear in facets with a colour of their own, whose lowest bits are red; if all
 * attributes are 0, no facet has one. In those of VisCAM and SolidView it is
 * set, and the lowest bits are blue. */
static bool read_colors(struct reader *r, const char *bytes, uint32_t count)
{
    struct vec3 common = mesh_clay();
    bool is_magics = find_magics_color(bytes, &common);
    uint32_t own = is_magics ? 0 : 0x8000, seen = 0;

    for (uint32_t i = 0; i < count; i++)
        seen |= load_u16(bytes + BEGIN_BYTES + (size_t)i * FACET_BYTES +
                         ATTRIBUTE_AT);
    if (!is_magics && (seen & 0x8000) == 0)
        return true;
    r->face_colors = alloc_array(count, sizeof *r->face_colors);
    if (r->face_colors == NULL)
        return out_of_memory(r);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits = load_u16(bytes + BEGIN_BYTES + (size_t)i * FACET_BYTES +
                                 ATTRIBUTE_AT);
        bool has_own = seen != 0 && (bits & 0x8000) == own;

        r->face_colors[i] = !has_own    ? common
                            : is_magics ? color_of(bits)
                                        : turned(color_of(bits));
    }
    vertex_colors_decode(r->face_colors, count, 1.0f);
    return true;
}

/* Finds the count of facets: that of the header, or, if that is 0 or -1, the
 * one that the size has. */
static bool find_count(const struct reader *r, const char *bytes,
                       size_t size_bytes, uint32_t *count)
{
    uint32_t written;
    size_t room;

    if (size_bytes < BEGIN_BYTES)
        return fail(r->err,
                    "%s: not an STL file: found %zu byte%s, expected a text "
                    "that begins with 'solid' or at least %d bytes",
                    r->path, size_bytes, print_plural(size_bytes), BEGIN_BYTES);
    room = size_bytes - BEGIN_BYTES;
    *count = written = load_u32(bytes + HEADER_BYTES);
    if ((written == 0 || written == UINT32_MAX) && room >= FACET_BYTES &&
        room % FACET_BYTES == 0 && room / FACET_BYTES < NO_INDEX) {
        *count = (uint32_t)(room / FACET_BYTES);
        warnings_add(r->report, "counts of 0",
                     "%s: byte %d: found %s triangles and room for %" PRIu32
                     ": read them",
                     r->path, HEADER_BYTES, written == 0 ? "0" : "-1", *count);
    }
    return *count <= room / FACET_BYTES ||
           fail(r->err,
                "%s: byte %d: found %" PRIu32 " triangles, expected at most "
                "%zu in the rest of the file",
                r->path, HEADER_BYTES, *count, room / FACET_BYTES);
}

static bool read_binary(struct reader *r, const char *bytes, size_t size_bytes)
{
    uint32_t count = 0;

    if (!find_count(r, bytes, size_bytes, &count))
        return false;
    /* a closed mesh has half as many vertices as triangles */
    if (!weld_init(&r->weld, count / 2) ||
        !face_tris_reserve_tris(&r->tris, count))
        return out_of_memory(r);
    for (uint32_t i = 0; i < count; i++) {
        const char *facet = bytes + BEGIN_BYTES + (size_t)i * FACET_BYTES;
        double corners[3][3];

        for (int k = 0; k < 9; k++)
            corners[k / 3][k % 3] = load_float(facet + CORNERS_AT + 4 * k);
        if (!add_facet(r, corners,
                       (struct file_place){.byte = (uint64_t)(facet - bytes)}))
            return false;
    }
    return read_colors(r, bytes, count);
}

/* ---- text ---- */

/* Words are known in any letter case, whatever lines they are on. Names stand
 * alone on the rest of a line. */
struct text {
    struct reader *reader;
    struct lexer lex;
};

/* Returns the next word of the text, over the ends of lines; its length is 0 at
 * the end. */
static struct word next_word(struct text *t)
{
    struct word word = lexer_word(&t->lex);

    while (word.length == 0 && t->lex.p < t->lex.end) {
        lexer_next_line(&t->lex);
        word = lexer_word(&t->lex);
    }
    return word;
}

static bool is_keyword(struct word word, const char *keyword)
{
    return word.length == strlen(keyword) &&
           strncasecmp(word.start, keyword, word.length) == 0;
}

static bool expected(const struct text *t, struct word found, const char *what)
{
    return fail(t->reader->err, "%s:%" PRIu64 ": found %s, expected %s",
                t->reader->path, t->lex.line,
                found.length > 0 ? word_quote(found).text
                                 : "the end of the file",
                what);
}

static bool expect_keyword(struct text *t, const char *keyword)
{
    struct word word = next_word(t);

    return is_keyword(word, keyword) || expected(t, word, keyword);
}

static bool read_corner(struct text *t, double p[3])
{
    if (!expect_keyword(t, "vertex"))
        return false;
    for (int k = 0; k < 3; k++) {
        struct lexer start = t->lex;

        if (lexer_number(&t->lex, &p[k]))
            continue;
        t->lex = start;
        return expected(t, next_word(t), "a number");
    }
    return true;
}

/* Reads the rest of a facet behind its first word. */
static bool read_facet(struct text *t)
{
    struct file_place place = {.line = t->lex.line};
    double corners[3][3];

    lexer_next_line(&t->lex); /* the normal */
    if (!expect_keyword(t, "outer") || !expect_keyword(t, "loop"))
        return false;
    for (int k = 0; k < 3; k++)
        if (!read_corner(t, corners[k]))
            return false;
    return expect_keyword(t, "endloop") && expect_keyword(t, "endfacet") &&
           add_facet(t->reader, corners, place);
}

/* Reads the name behind "solid". */
static bool read_name(struct text *t)
{
    struct reader *r = t->reader;
    char *name = lexer_rest(&t->lex);

    r->object = name == NULL ? NO_NAME : name_table_add(&r->solids, name);
    free(name);
    lexer_next_line(&t->lex);
    return r->object != NO_NAME || out_of_memory(r);
}

static bool read_text(struct reader *r, const char *bytes, size_t size_bytes)
{
    struct text t = {.reader = r};
    struct word word;

    lexer_init(&t.lex, bytes, size_bytes);
    if (!weld_init(&r->weld, 0) || name_table_add(&r->solids, "") == NO_NAME)
        return out_of_memory(r);
    while ((word = next_word(&t)).length > 0) {
        bool ok = true;

        if (is_keyword(word, "facet"))
            ok = read_facet(&t);
        else if (is_keyword(word, "solid"))
            ok = read_name(&t);
        else if (is_keyword(word, "endsolid"))
            lexer_next_line(&t.lex);
        else
            ok = expected(&t, word, "facet, solid or endsolid");
        if (!ok)
            return false;
    }
    return true;
}

/* Gives the names of solids to the scene. */
static void take_names(struct reader *r)
{
    struct scene *s = r->scene;

    if (r->solids.count == 0)
        return;
    free(s->object_names[0]);
    free(s->object_names);
    s->object_names = r->solids.items;
    s->object_count = r->solids.count;
    r->solids.items = NULL;
    r->solids.count = 0;
}

bool stl_parse(struct scene *scene, const char *bytes, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err)
{
    static const struct mesh_textures no_textures = {.count = 0};
    struct reader r = {
        .scene = scene,
        .path = path,
        .report = report,
        .err = err,
        .tris = {.scene = scene, .path = path, .report = report},
    };
    bool is_of_text =
        !is_binary_by_size(bytes, size_bytes) && is_text(bytes, size_bytes);
    bool ok = mesh_begin(scene, path, err) &&
              (is_of_text ? read_text(&r, bytes, size_bytes)
                          : read_binary(&r, bytes, size_bytes));

    take_names(&r);
    scene->up_is_z = true;
    ok = ok && mesh_finish(scene, r.face_colors, &no_textures, report, err);
    name_table_free(&r.solids);
    weld_free(&r.weld);
    face_tris_free(&r.tris);
    free(r.face_colors);
    return ok;
}
