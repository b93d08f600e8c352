// SPDX-License-Identifier: MIT
/*
 * save_commands.h - files that are written: pictures, texts, the view,
 * what was edited
 *
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_SAVE_COMMANDS_H
#define GLIM_SAVE_COMMANDS_H

#include <stdbool.h>

#include "terminal/ansi_text.h"
#include "studio/render_control.h"

/* Begins to save the picture as STEM.ENDING or the next free name in the
 * current folder. The saver's event_fd says when save_finish() has the
 * result. */
void save_picture(struct render_control *control, const char *ending);

/* Writes a picture that is no film, as STEM.png or the next free name. */
void save_frame(struct render_control *control, const struct frame *frame);

/* Writes a picture of ansi_text_frame_init() as text, as STEM.ans or the next
 * free name. */
void save_text(struct render_control *control, const struct frame *frame,
               const struct ansi_text_style *style);

/* Waits for the picture that is being saved, if any. False if that failed. */
bool save_finish(struct render_control *control);

void save_view(struct render_control *control);

/* Writes changed materials and light to their files. False if that failed. */
bool save_edit(struct render_control *control);

/* Halts, and writes a picture that somebody would miss to recent_lost_path(),
 * over the one before: for when nobody is there to save it. */
void save_lost_picture(struct render_control *control);

#endif
