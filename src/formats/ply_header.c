// SPDX-License-Identifier: MIT
/*
 * ply_header.c - the header of a PLY file (Turk 1994)
 *
 *     ply
 *     format binary_little_endian 1.0
 *     element vertex 8
 *     property float x
 *     element face 6
 *     property list uchar int vertex_indices
 *     end_header
 *
 * Lines end with LF or CRLF, or with CR if the first one does: what follows
 * end_header may be binary data that begin with the byte of a line end.
 */
#include "formats/ply_header.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Limit of counts: above all that fit into a file, and far from overflow. */
#define COUNT_MAX UINT64_C(1000000000000000)

struct parser {
    struct ply_header *header;
    const char *path;
    struct error *err;
    const char *bytes, *end;
    const char *p; /* start of the next line */
    char line_end;
    uint64_t line;
    const char *word; /* rest of the present line */
    const char *word_end;
};

bool ply_matches(const char *bytes, size_t size_bytes)
{
    lexer_trim(&bytes, &size_bytes);
    return size_bytes > 3 && memcmp(bytes, "ply", 3) == 0 &&
           (bytes[3] == '\n' || bytes[3] == '\r' || bytes[3] == ' ');
}

unsigned ply_type_bytes(enum ply_type type)
{
    static const unsigned char bytes[] = {
        [PLY_NONE] = 0,   [PLY_INT8] = 1,    [PLY_UINT8] = 1,  [PLY_INT16] = 2,
        [PLY_UINT16] = 2, [PLY_INT32] = 4,   [PLY_UINT32] = 4, [PLY_INT64] = 8,
        [PLY_UINT64] = 8, [PLY_FLOAT32] = 4, [PLY_FLOAT64] = 8};

    return bytes[type];
}

/* Takes the next line. Returns false at the end of the file. */
static bool next_line(struct parser *p)
{
    const char *q;

    if (p->p >= p->end)
        return false;
    q = memchr(p->p, p->line_end, (size_t)(p->end - p->p));
    p->word = p->p;
    p->word_end = q != NULL ? q : p->end;
    p->p = q != NULL ? q + 1 : p->end;
    p->line++;
    return true;
}

static struct word next_word(struct parser *p)
{
    const char *start;

    while (p->word < p->word_end && lexer_is_blank(*p->word))
        p->word++;
    start = p->word;
    while (p->word < p->word_end && !lexer_is_blank(*p->word) &&
           *p->word != '\r')
        p->word++;
    return (struct word){start, (size_t)(p->word - start)};
}

/* Returns the rest of the line without blanks around it. */
static struct word rest_of_line(struct parser *p)
{
    struct word word = next_word(p);
    const char *end = p->word_end;

    while (end > word.start && (lexer_is_blank(end[-1]) || end[-1] == '\r'))
        end--;
    return (struct word){word.start, (size_t)(end - word.start)};
}

static bool expected(const struct parser *p, struct word found,
                     const char *what)
{
    return fail(p->err, "%s:%" PRIu64 ": found %s, expected %s", p->path,
                p->line, word_quote(found).text, what);
}

static bool out_of_memory(const struct parser *p)
{
    return fail(p->err, "%s:%" PRIu64 ": out of memory for the header", p->path,
                p->line);
}

static bool read_format(struct parser *p)
{
    static const char *const names[] = {[PLY_ASCII] = "ascii",
                                        [PLY_LITTLE_ENDIAN] =
                                            "binary_little_endian",
                                        [PLY_BIG_ENDIAN] = "binary_big_endian"};
    struct word word = next_word(p);

    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (word_is(word, names[i])) {
            p->header->encoding = (enum ply_encoding)i;
            return true;
        }
    }
    return expected(p, word,
                    "the format ascii, binary_little_endian or "
                    "binary_big_endian");
}

static bool parse_count(struct word word, uint64_t *count)
{
    *count = 0;
    for (size_t i = 0; i < word.length; i++) {
        if (word.start[i] < '0' || word.start[i] > '9' || *count >= COUNT_MAX)
            return false;
        *count = *count * 10 + (uint64_t)(word.start[i] - '0');
    }
    return word.length > 0;
}

static bool read_element(struct parser *p)
{
    struct ply_header *h = p->header;
    struct ply_element e = {.name = next_word(p),
                            .line = p->line,
                            .first_property = h->property_count};
    struct word count = next_word(p);
    void *elements = h->elements;

    if (e.name.length == 0)
        return expected(p, e.name, "the name of an element");
    if (!parse_count(count, &e.count))
        return expected(p, count, "a count of elements");
    if (!grow_array(&elements, &h->element_capacity,
                    (size_t)h->element_count + 1, sizeof *h->elements))
        return out_of_memory(p);
    h->elements = elements;
    h->elements[h->element_count++] = e;
    return true;
}

static bool read_type(struct parser *p, enum ply_type *type)
{
    static const struct {
        const char *name;
        enum ply_type type;
    } types[] = {
        {"char", PLY_INT8},      {"int8", PLY_INT8},
        {"uchar", PLY_UINT8},    {"uint8", PLY_UINT8},
        {"short", PLY_INT16},    {"int16", PLY_INT16},
        {"ushort", PLY_UINT16},  {"uint16", PLY_UINT16},
        {"int", PLY_INT32},      {"int32", PLY_INT32},
        {"uint", PLY_UINT32},    {"uint32", PLY_UINT32},
        {"int64", PLY_INT64},    {"uint64", PLY_UINT64},
        {"float", PLY_FLOAT32},  {"float32", PLY_FLOAT32},
        {"double", PLY_FLOAT64}, {"float64", PLY_FLOAT64},
    };
    struct word word = next_word(p);

    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (word_is(word, types[i].name)) {
            *type = types[i].type;
            return true;
        }
    }
    return expected(p, word, "a type such as float, uchar or int");
}

/* Reads "property TYPE NAME" or "property list TYPE TYPE NAME". */
static bool read_property(struct parser *p)
{
    struct ply_header *h = p->header;
    struct ply_property property = {.count_type = PLY_NONE};
    const char *start = p->word;
    void *properties = h->properties;

    if (h->element_count == 0)
        return fail(p->err,
                    "%s:%" PRIu64 ": found a property, expected an element "
                    "before it",
                    p->path, p->line);
    if (!word_is(next_word(p), "list"))
        p->word = start;
    else if (!read_type(p, &property.count_type))
        return false;
    if (!read_type(p, &property.type))
        return false;
    if (property.count_type >= PLY_FLOAT32)
        return fail(p->err,
                    "%s:%" PRIu64 ": found a list with a count that is a "
                    "fraction, expected a whole number",
                    p->path, p->line);
    property.name = next_word(p);
    if (property.name.length == 0)
        return expected(p, property.name, "the name of a property");
    if (!grow_array(&properties, &h->property_capacity,
                    (size_t)h->property_count + 1, sizeof *h->properties))
        return out_of_memory(p);
    h->properties = properties;
    h->properties[h->property_count++] = property;
    h->elements[h->element_count - 1].property_count++;
    return true;
}

static bool begins(struct word word, const char *text)
{
    size_t length = strlen(text);

    return word.length >= length && memcmp(word.start, text, length) == 0;
}

static bool add_texture(struct parser *p, struct word name)
{
    struct ply_header *h = p->header;
    void *textures = h->textures;

    if (!grow_array(&textures, &h->texture_capacity,
                    (size_t)h->texture_count + 1, sizeof *h->textures))
        return out_of_memory(p);
    h->textures = textures;
    h->textures[h->texture_count++] = name;
    return true;
}

/* Notes a texture, as MeshLab names it, and Blender as the writer. */
static bool read_comment(struct parser *p)
{
    struct parser start = *p;
    struct word rest = rest_of_line(&start);

    p->header->is_of_blender |= begins(rest, "Created by Blender") ||
                                begins(rest, "Created in Blender");
    return !word_is(next_word(p), "TextureFile") ||
           add_texture(p, rest_of_line(p));
}

/* Reads the lines to end_header. Lines with an unknown first word are skipped:
 * writers leave out "comment". */
static bool read_lines(struct parser *p)
{
    bool has_format = false;

    while (next_line(p)) {
        struct word word = next_word(p);
        bool ok = true;

        if (word_is(word, "end_header")) {
            if (!has_format)
                return fail(p->err,
                            "%s:%" PRIu64 ": found no format before "
                            "end_header, expected a line such as 'format "
                            "ascii 1.0'",
                            p->path, p->line);
            p->header->size_bytes = (size_t)(p->p - p->bytes);
            p->header->line_count = p->line;
            return true;
        }
        if (word_is(word, "format"))
            has_format = ok = read_format(p);
        else if (word_is(word, "element"))
            ok = read_element(p);
        else if (word_is(word, "property"))
            ok = read_property(p);
        else if (word_is(word, "comment"))
            ok = read_comment(p);
        if (!ok)
            return false;
    }
    return fail(p->err,
                "%s:%" PRIu64 ": found the end of the file in the header, "
                "expected end_header",
                p->path, p->line);
}

bool ply_header_parse(struct ply_header *header, const char *bytes,
                      size_t size_bytes, const char *path, struct error *err)
{
    struct parser p = {.header = header,
                       .path = path,
                       .err = err,
                       .bytes = bytes,
                       .end = bytes + size_bytes,
                       .p = bytes,
                       .line_end = '\n'};
    const char *lf = memchr(bytes, '\n', size_bytes);
    const char *cr =
        memchr(bytes, '\r', lf != NULL ? (size_t)(lf - bytes) : size_bytes);

    if (!ply_matches(bytes, size_bytes))
        return fail(err, "%s: not a PLY file: found no 'ply' in its first line",
                    path);
    if (cr != NULL && cr + 1 != lf)
        p.line_end = '\r';
    next_line(&p);
    return read_lines(&p);
}

void ply_header_free(struct ply_header *header)
{
    free(header->elements);
    free(header->properties);
    free(header->textures);
    memset(header, 0, sizeof *header);
}
