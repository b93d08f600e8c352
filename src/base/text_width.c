// SPDX-License-Identifier: MIT
#include "base/text_width.h"

#include <string.h>

#include "base/print.h"

/* ---- UTF-8 ---- */

size_t utf8_length(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;
    size_t length = *p < 0x80                 ? 1
                    : *p >= 0xc2 && *p < 0xe0 ? 2
                    : *p >= 0xe0 && *p < 0xf0 ? 3
                    : *p >= 0xf0 && *p < 0xf5 ? 4
                                              : 0;

    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xc0) != 0x80)
            return 0; /* also at the closing NUL */
    }
    /* overlong forms, surrogates, beyond U+10FFFF */
    if ((p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xed && p[1] > 0x9f) ||
        (p[0] == 0xf0 && p[1] < 0x90) || (p[0] == 0xf4 && p[1] > 0x8f))
        return 0;
    return length;
}

uint32_t utf8_code(const char *text, size_t length)
{
    const unsigned char *p = (const unsigned char *)text;
    uint32_t code = length == 1 ? *p : *p & (0x7fu >> length);

    for (size_t i = 1; i < length; i++)
        code = code << 6 | (p[i] & 0x3fu);
    return code;
}

/* ---- columns ---- */

int text_width_of(const char *text)
{
    int cols = 0;

    while (*text != '\0') {
        struct print_character s = print_first(text);

        cols += s.cols;
        text += s.taken_bytes;
    }
    return cols;
}

int text_width_cut(char *to, size_t size_bytes, const char *text, int cols)
{
    int used = 0;

    while (*text != '\0') {
        struct print_character s = print_first(text);

        if (s.cols > cols - used || s.size_bytes >= size_bytes)
            break;
        memcpy(to, s.bytes, s.size_bytes);
        to += s.size_bytes;
        size_bytes -= s.size_bytes;
        text += s.taken_bytes;
        used += s.cols;
    }
    *to = '\0';
    return used;
}

void text_width_fit(char *to, size_t size_bytes, const char *text, int cols)
{
    int used = text_width_cut(to, size_bytes, text, cols);
    size_t length = strlen(to);

    for (; used < cols && length + 1 < size_bytes; used++)
        to[length++] = ' ';
    to[length] = '\0';
}
