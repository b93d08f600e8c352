// SPDX-License-Identifier: MIT
#include "base/text_width.h"

#include <string.h>

#include "base/print.h"

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
