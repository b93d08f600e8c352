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
