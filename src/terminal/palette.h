// SPDX-License-Identifier: MIT
/*
 * palette.h - which colours a terminal has, guessed from its environment
 *
 * Ownership: strings stay the caller's
 * Threads:   any
 */
#ifndef GLIM_PALETTE_H
#define GLIM_PALETTE_H

#include <stdbool.h>

#include "terminal/cells.h"

/* What there is to know before the terminal has answered; NULL: not set. */
struct palette_facts {
    const char *no_color;  /* NO_COLOR */
    const char *colorterm; /* COLORTERM */
    const char *term;      /* TERM */
    const char *sty;       /* STY: inside screen */
    const char *tmux;      /* TMUX: inside tmux */
    int colors;            /* of terminfo; less than 8: none */
    bool has_rgb;          /* terminfo: RGB or Tc */
};

/* *is_final says that no answer of the terminal may raise it. */
enum palette palette_guess(const struct palette_facts *facts, bool *is_final);

/* Its name for people. */
const char *palette_name(enum palette palette);

#endif
