// SPDX-License-Identifier: MIT
#include "base/json.h"

#include <inttypes.h>

#include "base/print.h"

void json_write_string(FILE *to, const char *text)
{
    fputc('"', to);
    while (*text) {
        size_t length = utf8_length(text);
        uint32_t code = length == 0 ? 0xfffd : utf8_code(text, length);

        if (length == 0 || !print_shows(code))
            fprintf(to, "\\u%04" PRIx32, code);
        else if (*text == '"' || *text == '\\')
            fprintf(to, "\\%c", *text);
        else
            fwrite(text, 1, length, to);
        text += length > 0 ? length : 1;
    }
    fputc('"', to);
}
