// SPDX-License-Identifier: MIT
/*
 * screen_draft.h - the size of the draft for a screen
 *
 * The filter needs a draft of the size that screen_filter.h gives.
 *
 * Threads:   main only
 */
#ifndef GLIM_SCREEN_DRAFT_H
#define GLIM_SCREEN_DRAFT_H

#include "studio/render_control.h"
#include "terminal/screen.h"

/* Sets the draft's size for a picture in these cells, before tty_open(). */
void screen_draft_expect(struct session *s, const struct cells_rect *fit);

/* Sets the draft's size for the present layout of the screen. The present draft
 * is resampled until the next restart; a young picture restarts at once. */
void screen_draft_fit(struct render_control *control,
                      const struct screen *screen);

#endif
