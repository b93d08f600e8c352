// SPDX-License-Identifier: MIT
/*
 * palette.h - guesses the colours of a terminal from its environment
 *
 * Threads:   any
 */
#ifndef GLIM_PALETTE_H
#define GLIM_PALETTE_H

#include <stdbool.h>

#include "terminal/cells.h"

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

#endif
