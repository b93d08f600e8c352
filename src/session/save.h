// SPDX-License-Identifier: MIT
/*
 * save.h - commands that write files: pictures, text, the view, edits
 *
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_SAVE_H
#define GLIM_SAVE_H

#include <stdbool.h>

#include "session/live_render.h"
#include "terminal/ansi_diff.h"

/* Starts to save the film as STEM.ENDING, or the next free name, in the current
 * folder. A thread writes the file. The saver's event_fd becomes readable when
 * save_finish() can be called. */
void save_picture(struct live_render *control, const char *ending);

/* The same as PNG, filtered, if that is done before the picture changes. The
 * world has its tree, and a camera with the film's pixels. */
void save_filtered(struct live_render *control, const struct world *world);

/* The same for a frame of the film's size, which it takes over. */
void save_frame(struct live_render *control, struct frame *frame);

/* Writes a frame of ansi_text_frame_init() as coloured text, STEM.ans or the
 * next free name. */
void save_text(struct live_render *control, const struct frame *frame,
               const struct ansi_text_style *style);

/* Waits for a picture that is being saved, if any, and reports the result.
 * Returns false if saving failed. */
bool save_finish(struct live_render *control);

/* Writes the view file. */
void save_view(struct live_render *control);

/* Writes changed materials, assignments and light to their files. Returns
 * false, with a message, on errors. */
bool save_edit(struct live_render *control);

#endif
