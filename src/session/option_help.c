// SPDX-License-Identifier: MIT
#include "session/option_help.h"

#include <stdbool.h>
#include <string.h>

#include "base/print.h"
#include "session/option_rules.h"
#include "session/sub_command.h"

/* Columns of the names of options, and of a line. */
#define NAME_COLS 16
#define LINE_COLS 79

/* Columns before the text beside a name. */
#define TEXT_COL (2 + NAME_COLS + 1)

/* Returns the bytes of the first words of a text that fit in a line. */
static int words_that_fit(const char *text, int cols)
{
    int length = (int)strlen(text), fit = cols;

    if (length <= cols)
        return length;
    while (fit > 0 && text[fit] != ' ')
        fit--;
    return fit > 0 ? fit : length;
}

/* Prints a name with the text beside it. */
static void print_row(FILE *to, const char *name, const char *text)
{
    bool fits = strlen(name) <= NAME_COLS;

    if (!fits)
        print_line(to, "  %s", name);
    for (bool is_first = true; *text != '\0'; is_first = false) {
        int length = words_that_fit(text, LINE_COLS - TEXT_COL);

        print_line(to, "  %-*s %.*s", NAME_COLS, is_first && fits ? name : "",
                   length, text);
        text += length;
        text += strspn(text, " ");
    }
}

static void print_option(FILE *to, const struct option_rule *rule)
{
    bool needs_blank = rule->argument && !option_value_is_optional(rule);
    char name[64];

    snprintf(name, sizeof name, "%s%s%s%s", rule->name[1] == '\0' ? "-" : "--",
             rule->name, needs_blank ? " " : "",
             rule->argument ? rule->argument : "");
    print_row(to, name, rule->help);
}

void option_help_print(FILE *to)
{
    const struct sub_command_rule *command;

    print_line(to, "usage: glim [options] scene.obj");
    print_line(to, "       glim -b [options] [-o picture.png] scene.obj");
    for (int i = 0; (command = sub_command_rule(i)) != NULL; i++)
        print_line(to, "       glim%s %s", command->name, command->operands);
    print_lines(to, "\n"
                    "Path traces an OBJ, glTF, PLY or STL scene, live in the "
                    "terminal or, with -b, to\n"
                    "a file. On the screen, ? shows the keys and q quits.\n"
                    "\n"
                    "commands\n");
    for (int i = 0; (command = sub_command_rule(i)) != NULL; i++)
        print_row(to, command->name + 1, command->help);
    for (const struct option_section *s = option_sections; s->title; s++) {
        print_line(to, "%s", "");
        print_line(to, "%s", s->title);
        for (size_t i = 0; i < s->rule_count; i++)
            if (s->rules[i].help)
                print_option(to, &s->rules[i]);
    }
    print_row(to, "--", "end of the options");
}
