// SPDX-License-Identifier: MIT
/*
 * sgr.h - the control sequence that sets colours, and the palettes of terminals
 *
 * Threads:   any
 */
#ifndef GLIM_SGR_H
#define GLIM_SGR_H

#include <stdbool.h>

#include "terminal/cells.h"

/* ---- palettes ---- */

/* Facts known before the terminal answers; NULL if a variable is not set. */
struct palette_facts {
    const char *no_color;  /* NO_COLOR */
    const char *colorterm; /* COLORTERM */
    const char *term;      /* TERM */
    const char *sty;       /* STY, set inside screen */
    const char *tmux;      /* TMUX, set inside tmux */
    int colors;            /* from terminfo; none if less than 8 */
    bool has_rgb;          /* terminfo has RGB or Tc */
};

/* Returns the palette. *is_final is true if the terminal's answers must not
 * raise it. */
enum palette palette_guess(const struct palette_facts *facts, bool *is_final);

/* Returns the name as a person sees it. */
const char *palette_name(enum palette palette);

/* ---- parameters ---- */

/* Bytes of the longest text: 38;2;255;255;255 */
#define SGR_COLOR_BYTES 16

enum sgr_ground { SGR_FOREGROUND = 30, SGR_BACKGROUND = 40 };

/* Writes the parameters for a colour of a cell, without a final 0. Returns
 * their end. All terminals parse the form with semicolons alike. */
char *sgr_color(char *to, uint32_t color, enum palette palette,
                enum sgr_ground ground);

/* Writes a number. Returns its end. */
char *sgr_number(char *to, uint32_t n);

#endif
