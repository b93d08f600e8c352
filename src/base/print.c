// SPDX-License-Identifier: MIT
#include "base/print.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "base/memory.h"
#include "base/stop.h"

/* ---- characters of UTF-8 ---- */

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

/* ---- messages ---- */

bool print_shows(uint32_t c)
{
    bool is_control = c < 0x20 || (c >= 0x7f && c < 0xa0);
    bool ends_line = c == 0x2028 || c == 0x2029;
    bool turns = (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
    bool is_none = (c >= 0xd800 && c < 0xe000) || c > 0x10ffff;

    return !is_control && !ends_line && !turns && !is_none;
}

/* Assumes that wide characters of the C library are Unicode code points. */
struct print_character print_first(const char *text)
{
    mbstate_t state = {0};
    wchar_t c = 0;
    size_t n = mbrtowc(&c, text, strnlen(text, MB_LEN_MAX), &state);
    bool is_character = n != 0 && n != (size_t)-1 && n != (size_t)-2;
    int cols = is_character && print_shows((uint32_t)c) ? wcwidth(c) : -1;

    if (cols < 0)
        return (struct print_character){"?", 1, is_character ? n : 1, 1};
    return (struct print_character){text, n, n, cols};
}

void print_replace(char *text)
{
    char *to = text;

    while (*text != '\0') {
        struct print_character c = print_first(text);

        text += c.taken_bytes;
        memmove(to, c.bytes, c.size_bytes);
        to += c.size_bytes;
    }
    *to = '\0';
}

/* Replaces a message for which memory is out. */
static const char out_of_memory[] = "glim: out of memory\n";

/* Writes the message with one call, so that output of other programs cannot
 * come in between. */
__attribute__((format(printf, 3, 0))) static void
print(FILE *to, const char *end, const char *format, va_list values)
{
    char *text = format_list(format, values);
    char *whole = NULL;

    if (text)
        print_replace(text);
    if (text)
        whole = format_text("%s%s", text, end);
    stop_allow_begin();
    fputs(whole ? whole : out_of_memory, to);
    stop_allow_end();
    free(whole);
    free(text);
}

void print_text(FILE *to, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    print(to, "", format, values);
    va_end(values);
}

void print_line(FILE *to, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    print(to, "\n", format, values);
    va_end(values);
}

void print_lines(FILE *to, const char *text)
{
    while (*text != '\0') {
        size_t length = strcspn(text, "\n");
        char *line = strndup(text, length);

        for (size_t i = 0; line && i < length; i++)
            if (line[i] == '\t')
                line[i] = ' ';
        if (line)
            print_line(to, "%s", line);
        else
            fputs(out_of_memory, to);
        free(line);
        text += length + (text[length] == '\n');
    }
}

bool print_finish(FILE *to, struct error *err)
{
    bool ok;

    stop_allow_begin();
    ok = fflush(to) == 0 && !ferror(to);
    stop_allow_end();
    return ok || fail(err, "standard output: %s", strerror(errno));
}

const char *print_plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}
