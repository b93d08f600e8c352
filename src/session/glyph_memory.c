// SPDX-License-Identifier: MIT
#include "session/glyph_memory.h"

#include <stdlib.h>
#include <string.h>

#include "session/state_list.h"
#include "terminal/xmalloc.h"

/* Returns the name of the terminal, which follows the kind of glyphs. */
static const char *terminal_of(const char *line)
{
    const char *blank = strchr(line, ' ');

    return blank ? blank + 1 : NULL;
}

static const struct state_list_file file = {"glyphs", 50, terminal_of};

static enum glyph_mode mode_of(const char *line)
{
    size_t length = strcspn(line, " ");

    for (int i = 0; term_caps_glyph_names[i]; i++) {
        if (strlen(term_caps_glyph_names[i]) == length &&
            strncmp(line, term_caps_glyph_names[i], length) == 0)
            return (enum glyph_mode)i;
    }
    return GLYPH_AUTO;
}

enum glyph_mode glyph_memory_read(const char *terminal)
{
    struct state_list list;
    enum glyph_mode found = GLYPH_AUTO;

    state_list_read(&list, &file);
    for (int i = 0; i < list.count; i++) {
        if (strcmp(list.keys[i], terminal) == 0)
            found = mode_of(list.lines[i]);
    }
    state_list_free(&list);
    return found;
}

void glyph_memory_write(const char *terminal, enum glyph_mode mode)
{
    char *line = xformat("%s %s", term_caps_glyph_names[mode], terminal);

    state_list_put(&file, line);
    free(line);
}
