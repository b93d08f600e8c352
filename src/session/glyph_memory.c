// SPDX-License-Identifier: MIT
#include "session/glyph_memory.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

/* Terminals that are remembered. */
#define TERMINALS_MAX 50

/* Returns the contents of the file for free(), empty if there is none. */
static char *read_lines(const char *path)
{
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;

    if (path && file_read(path, &text, &size_bytes, &ignored))
        return text;
    return xstrdup("");
}

/* Splits a line into its words and returns the next line. *mode and *terminal
 * are NULL in lines of another form. */
static char *next_line(char *line, const char **mode, const char **terminal)
{
    char *end = line + strcspn(line, "\n");
    char *next = end + (*end == '\n');
    char *blank;

    *end = '\0';
    blank = strchr(line, ' ');
    *mode = blank ? line : NULL;
    *terminal = blank ? blank + 1 : NULL;
    if (blank)
        *blank = '\0';
    return next;
}

static enum glyph_mode mode_named(const char *name)
{
    for (int i = 0; term_caps_glyph_names[i]; i++) {
        if (strcmp(name, term_caps_glyph_names[i]) == 0)
            return (enum glyph_mode)i;
    }
    return GLYPH_AUTO;
}

enum glyph_mode glyph_memory_read(const char *terminal)
{
    char *path = xdg_state_path("glyphs");
    char *text = read_lines(path);
    enum glyph_mode found = GLYPH_AUTO;
    const char *mode, *name;

    for (char *line = text; *line != '\0' && found == GLYPH_AUTO;) {
        line = next_line(line, &mode, &name);
        if (mode && strcmp(name, terminal) == 0)
            found = mode_named(mode);
    }
    free(text);
    free(path);
    return found;
}

void glyph_memory_write(const char *terminal, enum glyph_mode mode)
{
    char *path = xdg_state_path("glyphs");
    char *before = read_lines(path);
    char *text =
        mode == GLYPH_AUTO
            ? xstrdup("")
            : xformat("%s %s\n", term_caps_glyph_names[mode], terminal);
    const char *old, *name;
    struct error ignored;
    int count = 1;

    for (char *line = before; *line != '\0' && count < TERMINALS_MAX;) {
        line = next_line(line, &old, &name);
        if (!old || strcmp(name, terminal) == 0)
            continue;
        char *longer = xformat("%s%s %s\n", text, old, name);

        free(text);
        text = longer;
        count++;
    }
    if (path)
        file_write(path, text, strlen(text), false, NULL, &ignored);
    free(text);
    free(before);
    free(path);
}
