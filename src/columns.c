// SPDX-License-Identifier: MIT
#include "glim/columns.h"

#include <stdbool.h>
#include <string.h>
#include <wchar.h>

/* A character of the text as it is shown. */
struct shown {
    const char *bytes;
    size_t size_bytes;  /* of what is shown */
    size_t taken_bytes; /* of the text */
    int cols;
};

static struct shown next_shown(const char *text)
{
    mbstate_t state = {0};
    wchar_t c;
    size_t n = mbrtowc(&c, text, strlen(text), &state);
    bool is_character = n != 0 && n != (size_t)-1 && n != (size_t)-2;
    int cols = is_character ? wcwidth(c) : -1;

    if (cols < 0)
        return (struct shown){"?", 1, is_character ? n : 1, 1};
    return (struct shown){text, n, n, cols};
}

int columns_of(const char *text)
{
    int cols = 0;

    while (*text != '\0') {
        struct shown s = next_shown(text);

        cols += s.cols;
        text += s.taken_bytes;
    }
    return cols;
}

int columns_cut(char *to, size_t size_bytes, const char *text, int cols)
{
    int used = 0;

    while (*text != '\0') {
        struct shown s = next_shown(text);

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

void columns_fit(char *to, size_t size_bytes, const char *text, int cols)
{
    int used = columns_cut(to, size_bytes, text, cols);
    size_t length = strlen(to);

    for (; used < cols && length + 1 < size_bytes; used++)
        to[length++] = ' ';
    to[length] = '\0';
}
