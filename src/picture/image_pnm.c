// SPDX-License-Identifier: MIT
#include "picture/image_pnm.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/image_header.h"

#define VALUE_MAX 65535

/* Position in the text of a header, or of numbers. */
struct cursor {
    const char *p, *end;
};

static bool is_text(const struct image_file *f)
{
    return f->data[1] == '2' || f->data[1] == '3';
}

bool image_pnm_is(const struct image_file *f)
{
    return f->size_bytes > 2 && f->data[0] == 'P' &&
           memchr("2356", f->data[1], 4) != NULL &&
           memchr(" \t\r\n#", f->data[2], 5) != NULL;
}

/* Reads a number behind white space and comments. Returns false if there is
 * none, or for one above VALUE_MAX. */
static bool read_number(struct cursor *c, uint32_t *number)
{
    bool is_comment = false;
    const char *first;

    for (; c->p < c->end; c->p++) {
        if (is_comment ? *c->p == '\n' || *c->p == '\r' : *c->p == '#')
            is_comment = !is_comment;
        else if (!is_comment && memchr(" \t\r\n", *c->p, 4) == NULL)
            break;
    }
    first = c->p;
    *number = 0;
    for (; c->p < c->end && *c->p >= '0' && *c->p <= '9'; c->p++) {
        *number = 10 * *number + (uint32_t)(*c->p - '0');
        if (*number > VALUE_MAX)
            return false;
    }
    return c->p > first;
}

static size_t values_of(const struct image_file *f)
{
    return (size_t)f->width * (size_t)f->height * (size_t)f->channels;
}

bool image_pnm_header(struct image_file *f, struct error *err)
{
    struct cursor c = {f->data + 2, f->data + f->size_bytes};
    uint32_t width, height;
    size_t found, needed;

    if (!read_number(&c, &width) || !read_number(&c, &height) ||
        !read_number(&c, &f->value_max) || f->value_max == 0 || c.p == c.end)
        return fail(err,
                    "%s: expected width, height and largest value up to %d "
                    "after 'P%c'",
                    f->path, VALUE_MAX, f->data[1]);
    f->width = (int)width;
    f->height = (int)height;
    f->channels = f->data[1] == '3' || f->data[1] == '6' ? 3 : 1;
    f->pixels_at = (size_t)(c.p + 1 - f->data);
    if (!image_expect_limits(f, err))
        return false;
    found = f->size_bytes - f->pixels_at;
    /* a value of text is a digit and a blank, without one behind the last */
    needed = is_text(f) ? 2 * values_of(f) - 1
                        : values_of(f) * (f->value_max > 255 ? 2 : 1);
    return found >= needed ||
           fail(err, "%s: found %zu bytes, expected more for %dx%d pixels",
                f->path, f->size_bytes, f->width, f->height);
}

/* Reads the next value. Returns false if it is malformed. */
static bool read_value(const struct image_file *f, struct cursor *c,
                       uint32_t *value)
{
    const unsigned char *b = (const unsigned char *)c->p;

    if (is_text(f))
        return read_number(c, value) && *value <= f->value_max;
    *value = f->value_max > 255 ? (uint32_t)b[0] << 8 | b[1] : b[0];
    c->p += f->value_max > 255 ? 2 : 1;
    return *value <= f->value_max;
}

uint8_t *image_pnm_decode(const struct image_file *f, struct error *err)
{
    struct cursor c = {f->data + f->pixels_at, f->data + f->size_bytes};
    size_t pixels = (size_t)f->width * (size_t)f->height;
    uint8_t *rgba = alloc_array(pixels, 4);
    uint32_t value = 0;

    if (rgba == NULL) {
        fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
             f->height);
        return NULL;
    }
    for (size_t i = 0; i < pixels; i++) {
        for (int k = 0; k < 3; k++) {
            if (k < f->channels && !read_value(f, &c, &value)) {
                fail(err, "%s: found a bad value, expected %zu up to %u",
                     f->path, values_of(f), f->value_max);
                free(rgba);
                return NULL;
            }
            rgba[4 * i + (size_t)k] =
                (uint8_t)((value * 255 + f->value_max / 2) / f->value_max);
        }
        rgba[4 * i + 3] = 255;
    }
    return rgba;
}
