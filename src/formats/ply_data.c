// SPDX-License-Identifier: MIT
#include "formats/ply_data.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "base/print.h"

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
