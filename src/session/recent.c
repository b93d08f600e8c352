// SPDX-License-Identifier: MIT
#include "session/recent.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/print.h"
#include "terminal/xmalloc.h"

/* Returns the whole line if it is the absolute path of a file that exists. */
static const char *existing(const char *line)
{
    return *line == '/' && access(line, R_OK) == 0 ? line : NULL;
}

static const struct state_list_file file = {"recent", RECENT_MAX, existing};

void recent_read(struct state_list *r)
{
    state_list_read(r, &file);
}

void recent_add(const char *path)
{
    char *whole = realpath(path, NULL);

    if (whole && !strchr(whole, '\n'))
        state_list_put(&file, whole);
    free(whole);
}

static char *path_of_answer(const struct state_list *r, const char *answer)
{
    char *end;
    unsigned long number = strtoul(answer, &end, 10);

    if (*end == '\0' && number >= 1 && number <= (unsigned long)r->count)
        return xstrdup(r->lines[number - 1]);
    return access(answer, F_OK) == 0 ? xstrdup(answer) : NULL;
}

char *recent_choose(const struct state_list *r, FILE *in, FILE *out)
{
    char *answer = NULL, *path = NULL;
    size_t capacity = 0;

    for (int i = 0; i < r->count; i++)
        print_line(out, "%3d  %s", i + 1, r->lines[i]);
    while (!path) {
        print_text(out, "number or file of a scene (Enter: 1, q: quit): ");
        fflush(out);
        if (getline(&answer, &capacity, in) < 0)
            break;
        answer[strcspn(answer, "\n")] = '\0';
        if (strcmp(answer, "q") == 0)
            break;
        path = path_of_answer(r, *answer == '\0' ? "1" : answer);
        if (!path)
            print_line(out, "%s: no such scene", answer);
    }
    free(answer);
    return path;
}
