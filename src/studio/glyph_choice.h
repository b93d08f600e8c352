// SPDX-License-Identifier: MIT
/*
 * glyph_choice.h - the glyphs or pixels that a person chooses for the picture,
 * which are remembered for each terminal
 *
 * Units:     nanoseconds of clock_ns()
 * Ownership: control and screen stay the caller's and outlive it
 * Threads:   main only
 */
#ifndef GLIM_GLYPH_CHOICE_H
#define GLIM_GLYPH_CHOICE_H

#include <stdbool.h>
#include <stdint.h>

#include "session/live_render.h"
#include "terminal/screen.h"

struct glyph_choice {
    struct live_render *control;
    struct screen *screen;
    enum glyph_mode before; /* Esc brings them back */
    uint64_t until_ns;      /* the end of the message that says so */

    uint64_t lack_ns; /* when the terminal's answers count as lost, and a
                         message says why no pixels are shown; 0: never */

    bool has_asked_again; /* see tty_ask_through_tmux() */
};

/* After screen_init(). */
void glyph_choice_init(struct glyph_choice *g, struct live_render *control,
                       struct screen *screen);

/* Selects the next glyphs. A layout and glyph_choice_say() must follow. */
void glyph_choice_next(struct glyph_choice *g);

/* Goes back to the glyphs before while the message of glyph_choice_say() is
 * shown, and returns true: a layout and glyph_choice_say() must follow. */
bool glyph_choice_take_back(struct glyph_choice *g);

/* Says which glyphs there are now. */
void glyph_choice_say(struct glyph_choice *g);

/* Takes the glyphs that are remembered for this terminal, unless others were
 * requested. Call it when the terminal has answered. Returns true if a layout
 * must follow. */
bool glyph_choice_recall(struct glyph_choice *g);

/* Says once why the pixels that the person has asked for are not shown. */
void glyph_choice_say_lack(struct glyph_choice *g, uint64_t now_ns);

#endif
