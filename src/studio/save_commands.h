// SPDX-License-Identifier: MIT
/*
 * save_commands.h - what of the work becomes files: pictures, texts, the view,
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
 * current folder. The saver's event_fd says when work_finish_saving() has the
 * result. */
void work_save_picture(struct render_control *w, const char *ending);

/* Writes a picture that is no film, as STEM.png or the next free name. */
void work_save_frame(struct render_control *w, const struct frame *frame);

/* Writes a picture of ansi_text_frame_init() as text, as STEM.ans or the next
 * free name. */
void work_save_text(struct render_control *w, const struct frame *frame,
                    const struct ansi_text_style *style);

/* Waits for the picture that is being saved, if any. False if that failed. */
bool work_finish_saving(struct render_control *w);

void work_save_view(struct render_control *w);

/* Writes changed materials and light to their files. False if that failed. */
bool work_save_edit(struct render_control *w);

/* Halts, and writes a picture that somebody would miss to recent_lost_path(),
 * over the one before: for when nobody is there to save it. */
void work_keep(struct render_control *w);

#endif
