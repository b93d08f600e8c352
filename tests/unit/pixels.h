// SPDX-License-Identifier: MIT
/*
 * pixels.h - decoders of sixels and of kitty's graphics, after the VT340's
 * manual, chapter 14, and kitty's graphics protocol
 *
 * Units:     pixels
 * Threads:   one
 * Errors:    bytes that break the rules end the test
 */
#ifndef TESTS_PIXELS_H
#define TESTS_PIXELS_H

#include <stdbool.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#define PIXELS_MAX (512 * 256)

struct sixels {
    int width, height;
    int number[PIXELS_MAX]; /* -1: not set */
    int percent[256][3];    /* of the colours; -1: not defined */
};

static inline const char *read_int(const char *p, int *n)
{
    char *end;

    assert_in_range(*p, '0', '9');
    *n = (int)strtol(p, &end, 10);
    return end;
}

static inline const char *expect_text(const char *p, const char *text)
{
    assert_memory_equal(p, text, strlen(text));
    return p + strlen(text);
}

/* #n chooses a colour; #n;2;r;g;b also defines it. */
static inline const char *sixel_color(const char *p, struct sixels *s, int *n)
{
    p = read_int(p, n);
    assert_in_range(*n, 0, 255);
    if (*p != ';')
        return p;
    p = expect_text(p, ";2");
    for (int c = 0; c < 3; c++) {
        p = read_int(expect_text(p, ";"), &s->percent[*n][c]);
        assert_in_range(s->percent[*n][c], 0, 100);
    }
    return p;
}

static inline void sixel_set(struct sixels *s, int x, int band, int bits, int n)
{
    for (int i = 0; i < 6; i++) {
        int y = 6 * band + i;

        if (!(bits >> i & 1))
            continue;
        assert_true(x < s->width && y < s->height && s->percent[n][0] >= 0);
        assert_int_equal(s->number[y * s->width + x], -1); /* not twice */
        s->number[y * s->width + x] = n;
    }
}

/* Reads an image that begins with ESC P. Returns a pointer behind it. */
static inline const char *sixels_read(const char *p, struct sixels *s)
{
    int band = 0, x = 0, n = -1;

    p = read_int(expect_text(p, "\033P0;1q\"1;1;"), &s->width);
    p = read_int(expect_text(p, ";"), &s->height);
    assert_true(s->width * s->height <= PIXELS_MAX);
    memset(s->number, -1, sizeof s->number);
    memset(s->percent, -1, sizeof s->percent);
    while (*p != '\033') {
        int count = 1;

        if (*p == '#') {
            p = sixel_color(p + 1, s, &n);
            continue;
        }
        if (*p == '$' || *p == '-') {
            band += *p++ == '-';
            x = 0;
            continue;
        }
        if (*p == '!')
            p = read_int(p + 1, &count);
        assert_in_range(*p, '?', '~');
        for (; count > 0; count--)
            sixel_set(s, x++, band, *p - '?', n);
        p++;
    }
    assert_true(6 * band < s->height);
    return expect_text(p, "\033\\");
}

struct kitty_pixels {
    int width, height, cols, rows, id;
    bool is_virtual; /* sent through tmux, shown by placeholders */
    uint8_t rgb[3 * PIXELS_MAX];
};

static inline int base64_digit(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnop"
                                 "qrstuvwxyz0123456789+/";
    const char *at = strchr(digits, c);

    assert_true(c != '\0' && at != NULL);
    return (int)(at - digits);
}

/* Expects the begin or end of a command, which tmux passes on if `is_virtual`.
 */
static inline const char *kitty_begin(const char *p, bool is_virtual)
{
    return expect_text(p, is_virtual ? "\033Ptmux;\033\033_G" : "\033_G");
}

static inline const char *kitty_end(const char *p, bool is_virtual)
{
    return expect_text(p, is_virtual ? "\033\033\\\033\\" : "\033\\");
}

/* Reads an image in pieces that begin with ESC. Returns a pointer behind it. */
static inline const char *kitty_read(const char *p, struct kitty_pixels *k)
{
    size_t length = 0;
    int has_more;

    k->is_virtual = p[1] == 'P';
    p = kitty_begin(p, k->is_virtual);
    p = read_int(expect_text(p, "a=T,f=24,s="), &k->width);
    p = read_int(expect_text(p, ",v="), &k->height);
    p = read_int(expect_text(p, ",c="), &k->cols);
    p = read_int(expect_text(p, ",r="), &k->rows);
    p = read_int(expect_text(p, ",i="), &k->id);
    p = expect_text(p, k->is_virtual ? ",U=1" : ",p=1,C=1");
    p = read_int(expect_text(p, ",q=2,m="), &has_more);
    for (;;) {
        const char *begin = ++p; /* behind the semicolon */

        for (; *p != '\033'; p += 4) {
            int bits = base64_digit(p[0]) << 18 | base64_digit(p[1]) << 12 |
                       base64_digit(p[2]) << 6 | base64_digit(p[3]);

            assert_true(length + 3 <= sizeof k->rgb);
            k->rgb[length++] = (uint8_t)(bits >> 16);
            k->rgb[length++] = (uint8_t)(bits >> 8);
            k->rgb[length++] = (uint8_t)bits;
        }
        assert_true(p - begin <= 4096);
        p = kitty_end(p, k->is_virtual);
        if (!has_more)
            break;
        p = kitty_begin(p, k->is_virtual);
        p = read_int(expect_text(p, "m="), &has_more);
    }
    assert_int_equal(length, 3 * k->width * k->height);
    return p;
}

#endif
