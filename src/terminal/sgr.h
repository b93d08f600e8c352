// SPDX-License-Identifier: MIT
/*
 * sgr.h - parameters of the control sequence that sets colours
 *
 * Threads:   any
 */
#ifndef GLIM_SGR_H
#define GLIM_SGR_H

#include "terminal/cells.h"

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
