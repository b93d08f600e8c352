// SPDX-License-Identifier: MIT
#include "read/ply_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "base/print.h"
#include "read/scene_lists.h"

/* ---- header ---- */

/*
 * * ply_header.c - the header of a PLY file (Turk 1994)
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

/* ---- properties ---- */

static const struct {
    const char *name;
    enum ply_role role;
} role_names[] = {
    {"x", PLY_X},
    {"y", PLY_Y},
    {"z", PLY_Z},
    {"nx", PLY_NX},
    {"ny", PLY_NY},
    {"nz", PLY_NZ},
    {"normal_x", PLY_NX},
    {"normal_y", PLY_NY},
    {"normal_z", PLY_NZ},
    {"red", PLY_RED},
    {"green", PLY_GREEN},
    {"blue", PLY_BLUE},
    {"r", PLY_RED},
    {"g", PLY_GREEN},
    {"b", PLY_BLUE},
    {"diffuse_red", PLY_RED},
    {"diffuse_green", PLY_GREEN},
    {"diffuse_blue", PLY_BLUE},
    {"s", PLY_U},
    {"t", PLY_V},
    {"u", PLY_U},
    {"v", PLY_V},
    {"texture_u", PLY_U},
    {"texture_v", PLY_V},
    {"texture_s", PLY_U},
    {"texture_t", PLY_V},
    {"s0", PLY_U},
    {"t0", PLY_V},
    {"texnumber", PLY_TEXTURE},
};

static void find_list(struct ply_table *t, uint32_t number)
{
    struct word name = t->items[number].name;

    if ((word_is(name, "vertex_indices") || word_is(name, "vertex_index")) &&
        t->lists[PLY_LIST_VERTICES] == NO_INDEX)
        t->lists[PLY_LIST_VERTICES] = number;
    else if (word_is(name, "texcoord") && t->lists[PLY_LIST_UVS] == NO_INDEX)
        t->lists[PLY_LIST_UVS] = number;
}

static void find_number(struct ply_table *t, uint32_t number)
{
    struct word name = t->items[number].name;

    for (size_t i = 0; i < sizeof role_names / sizeof role_names[0]; i++)
        if (t->numbers[role_names[i].role] == NO_INDEX &&
            word_is(name, role_names[i].name))
            t->numbers[role_names[i].role] = number;
}

bool ply_table_init(struct ply_table *t, const struct ply_header *header,
                    const struct ply_element *element, const char *path,
                    struct error *err)
{
    *t = (struct ply_table){.element = element,
                            .count = (uint32_t)element->count};
    if (element->property_count > 0)
        t->items = header->properties + element->first_property;
    if (element->count >= NO_INDEX)
        return fail(err,
                    "%s:%" PRIu64 ": found %" PRIu64 " %s, expected fewer "
                    "than 4294967295",
                    path, element->line, element->count,
                    word_cut(element->name).text);
    memset(t->numbers, 0xff, sizeof t->numbers);
    memset(t->lists, 0xff, sizeof t->lists);
    for (uint32_t i = 0; i < element->property_count; i++) {
        if (t->items[i].count_type != PLY_NONE)
            find_list(t, i);
        else
            find_number(t, i);
    }
    return true;
}

bool ply_table_has(const struct ply_table *t, enum ply_role first, int count)
{
    for (int i = 0; i < count; i++)
        if (t->numbers[(int)first + i] == NO_INDEX)
            return false;
    return true;
}

/* Returns the largest number of a colour's property: 1 for fractions. */
static float white_of(const struct ply_table *t)
{
    switch (t->items[t->numbers[PLY_RED]].type) {
    case PLY_INT8: return INT8_MAX;
    case PLY_UINT8: return UINT8_MAX;
    case PLY_INT16: return INT16_MAX;
    case PLY_UINT16: return UINT16_MAX;
    case PLY_INT32: return (float)INT32_MAX;
    case PLY_UINT32: return (float)UINT32_MAX;
    default: return 1.0f;
    }
}

void ply_table_decode(const struct ply_table *t, struct vec3 *colors)
{
    float white = white_of(t);

    vertex_colors_decode(colors, t->count,
                         white > 1.0f ? white
                                      : vertex_colors_white(colors, t->count));
}

/* ---- numbers ---- */

/* Largest whole number that is read: doubles above it skip some. */
#define WHOLE_MAX ((double)(INT64_C(1) << 53))

static bool is_little_endian(void)
{
    const uint16_t one = 1;

    return *(const unsigned char *)&one == 1;
}

struct ply_data ply_data_begin(const struct ply_header *header,
                               const char *bytes, size_t size_bytes,
                               const char *path, struct warnings *report,
                               struct error *err)
{
    return (struct ply_data){
        .path = path,
        .report = report,
        .err = err,
        .start = bytes,
        .p = bytes + header->size_bytes,
        .end = bytes + size_bytes,
        .is_ascii = header->encoding == PLY_ASCII,
        .is_swapped =
            (header->encoding == PLY_LITTLE_ENDIAN) != is_little_endian(),
        .line = header->line_count + 1,
    };
}

struct file_place ply_data_place(const struct ply_data *d)
{
    return (struct file_place){d->is_ascii ? d->line : 0,
                               (uint64_t)(d->p - d->start)};
}

bool ply_data_fail(const struct ply_data *d, const char *found,
                   const char *expected)
{
    return fail(d->err, "%s%s: found %s, expected %s", d->path,
                file_place_text(ply_data_place(d)).text, found, expected);
}

/* Returns the least number of bytes of a row. In ascii each number has at least
 * one digit and a blank, which the last number of a file may lack. */
static uint64_t least_row_bytes(const struct ply_data *d,
                                const struct ply_header *h,
                                const struct ply_element *e)
{
    uint64_t bytes = 0;

    if (d->is_ascii)
        return 2 * (uint64_t)e->property_count;
    for (uint32_t i = 0; i < e->property_count; i++) {
        const struct ply_property *p = &h->properties[e->first_property + i];

        bytes +=
            ply_type_bytes(p->count_type != PLY_NONE ? p->count_type : p->type);
    }
    return bytes;
}

bool ply_data_expect(const struct ply_data *d, const struct ply_header *h,
                     const struct ply_element *e)
{
    uint64_t left = (uint64_t)(d->end - d->p) + d->is_ascii;
    uint64_t row_bytes = least_row_bytes(d, h, e);

    return row_bytes == 0 || e->count <= left / row_bytes ||
           fail(d->err,
                "%s:%" PRIu64 ": found element %s %" PRIu64 " time%s, expected "
                "at most %" PRIu64 " in the rest of the file",
                d->path, e->line, word_cut(e->name).text, e->count,
                print_plural(e->count), left / row_bytes);
}

/* ---- ascii ---- */

static bool is_space(char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' ||
           c == '\f';
}

/* Moves to the next number and counts lines, which end with LF, CRLF or CR. */
static void skip_space(struct ply_data *d)
{
    for (; d->p < d->end && is_space(*d->p); d->p++)
        if (*d->p == '\n' ||
            (*d->p == '\r' && (d->p + 1 == d->end || d->p[1] != '\n')))
            d->line++;
}

static bool read_text(struct ply_data *d, double *value)
{
    struct lexer lex;

    skip_space(d);
    lex = (struct lexer){d->p, d->end, d->line};
    if (d->p < d->end && lexer_number(&lex, value)) {
        d->p = lex.p;
        return true;
    }
    return ply_data_fail(d,
                         d->p == d->end ? "the end of the file"
                                        : word_quote(lexer_word(&lex)).text,
                         "a number");
}

/* Reads digits with an optional '-', which most indices are. Returns false,
 * with d->p at the number, for all others. */
static bool read_digits(struct ply_data *d, int64_t *value)
{
    const char *p, *first;
    bool is_negative;
    int64_t n = 0;

    skip_space(d);
    p = d->p;
    is_negative = p < d->end && *p == '-';
    first = p += is_negative;
    for (; p < d->end && *p >= '0' && *p <= '9' && p < first + 18; p++)
        n = n * 10 + (*p - '0');
    if (p == first || (p < d->end && !is_space(*p)))
        return false;
    *value = is_negative ? -n : n;
    d->p = p;
    return true;
}

/* ---- binary ---- */

static uint64_t load_bits(const char *p, unsigned bytes, bool is_swapped)
{
    uint8_t b1;
    uint16_t b2;
    uint32_t b4;
    uint64_t b8;

    switch (bytes) {
    case 1: memcpy(&b1, p, 1); return b1;
    case 2: memcpy(&b2, p, 2); return is_swapped ? __builtin_bswap16(b2) : b2;
    case 4: memcpy(&b4, p, 4); return is_swapped ? __builtin_bswap32(b4) : b4;
    default: memcpy(&b8, p, 8); return is_swapped ? __builtin_bswap64(b8) : b8;
    }
}

static double load_float(uint64_t bits)
{
    uint32_t bits32 = (uint32_t)bits;
    float x;

    memcpy(&x, &bits32, sizeof x);
    return (double)x;
}

static double load_double(uint64_t bits)
{
    double x;

    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Returns the whole number of the bits; those of UINT64 above INT64_MAX become
 * INT64_MAX, which is no index. */
static int64_t whole_of(enum ply_type type, uint64_t bits)
{
    switch (type) {
    case PLY_INT8: return (int8_t)bits;
    case PLY_INT16: return (int16_t)bits;
    case PLY_INT32: return (int32_t)bits;
    case PLY_UINT64: return bits > INT64_MAX ? INT64_MAX : (int64_t)bits;
    default: return (int64_t)bits;
    }
}

static bool expect_bytes(const struct ply_data *d, uint64_t count,
                         enum ply_type type)
{
    return count <= (uint64_t)(d->end - d->p) / ply_type_bytes(type) ||
           ply_data_fail(d, "the end of the file", "more numbers");
}

bool ply_data_number(struct ply_data *d, enum ply_type type, double *value)
{
    uint64_t bits;

    if (d->is_ascii)
        return read_text(d, value);
    if (!expect_bytes(d, 1, type))
        return false;
    bits = load_bits(d->p, ply_type_bytes(type), d->is_swapped);
    d->p += ply_type_bytes(type);
    if (type == PLY_FLOAT32)
        *value = load_float(bits);
    else if (type == PLY_FLOAT64)
        *value = load_double(bits);
    else if (type == PLY_UINT64)
        *value = (double)bits;
    else
        *value = (double)whole_of(type, bits);
    return true;
}

/* Reads one whole number in any type and encoding. */
static bool read_whole(struct ply_data *d, enum ply_type type, int64_t *value)
{
    struct ply_data before;
    double number = 0;

    if (d->is_ascii && read_digits(d, value))
        return true;
    before = *d;
    if (!ply_data_number(d, type, &number))
        return false;
    if (!(fabs(number) <= WHOLE_MAX))
        return ply_data_fail(&before, "no whole number", "one");
    *value = (int64_t)number;
    if (number != floor(number))
        warnings_add(d->report, "fractions in lists of vertices",
                     "%s%s: found %g, expected a whole number: taken as "
                     "%" PRId64,
                     d->path, file_place_text(ply_data_place(&before)).text,
                     number, *value);
    return true;
}

bool ply_data_integers(struct ply_data *d, enum ply_type type, uint64_t count,
                       int64_t *to)
{
    unsigned bytes = ply_type_bytes(type);

    if (d->is_ascii || type >= PLY_FLOAT32) {
        for (uint64_t i = 0; i < count; i++)
            if (!read_whole(d, type, &to[i]))
                return false;
        return true;
    }
    if (!expect_bytes(d, count, type))
        return false;
    for (uint64_t i = 0; i < count; i++, d->p += bytes)
        to[i] = whole_of(type, load_bits(d->p, bytes, d->is_swapped));
    return true;
}

bool ply_data_count(struct ply_data *d, const struct ply_property *list,
                    uint64_t *count)
{
    struct ply_data before;
    unsigned bytes = d->is_ascii ? 2 : ply_type_bytes(list->type);
    uint64_t most;
    int64_t n = 0;
    char found[64], expected[64];

    if (d->is_ascii)
        skip_space(d);
    before = *d;
    if (!ply_data_integers(d, list->count_type, 1, &n))
        return false;
    most = ((uint64_t)(d->end - d->p) + d->is_ascii) / bytes;
    if (n >= 0 && (uint64_t)n <= most) {
        *count = (uint64_t)n;
        return true;
    }
    snprintf(found, sizeof found, "a list of %" PRId64 " number%s", n,
             print_plural((uint64_t)n));
    snprintf(expected, sizeof expected,
             "at most %" PRIu64 " in the rest of the file", most);
    return ply_data_fail(&before, found, expected);
}

bool ply_data_skip(struct ply_data *d, enum ply_type type, uint64_t count)
{
    double ignored;

    if (!d->is_ascii) {
        if (!expect_bytes(d, count, type))
            return false;
        d->p += count * ply_type_bytes(type);
        return true;
    }
    for (uint64_t i = 0; i < count; i++)
        if (!read_text(d, &ignored))
            return false;
    return true;
}
