// SPDX-License-Identifier: MIT
/*
 * progress_panel.h - the progress of the render: samples, noise, speed, load of
 * the threads, ranks of a cluster, and plots over the time, drawn twice a
 * second
 *
 * The number of columns is constant, and that of lines depends on the number of
 * ranks alone, so that the text stays in place. Plots are made of the dots of
 * braille characters, or of ASCII where the terminal has no Unicode.
 *
 * Units:     terminal columns; nanoseconds of clock_ns()
 * Ownership: text goes to the caller's memory; progress_panel_free() frees; a
 *            zeroed struct is switched off
 * Threads:   any for texts, main only for the panel
 */
#ifndef GLIM_PROGRESS_PANEL_H
#define GLIM_PROGRESS_PANEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "render/progress.h"
#include "render/render_loop.h"
#include "session/live_render.h"
#include "terminal/screen.h"

/* ---- plots ---- */

#define PLOT_COLS       30
#define PLOT_BYTES      (3 * PLOT_COLS + 1)
#define PLOT_SPEED_ROWS 3
#define PLOT_ERROR_ROWS 4

/* Formats the speeds as bars from below, two in a column. The highest is `top`.
 */
void plot_speeds(char rows[PLOT_SPEED_ROWS][PLOT_BYTES],
                 const struct speeds *speeds, double top, bool has_unicode);

/* Formats the errors so far as a line, and their expected continuation to the
 * target as dots; both axes are logarithmic. The rows are blank while fewer
 * than two errors are known. `target` is the error that the render goes to, and
 * `target_s` the time when it is expected; 0: unknown. */
void plot_errors(char rows[PLOT_ERROR_ROWS][PLOT_BYTES],
                 const struct error_history *history, double target,
                 double target_s, bool has_unicode);

/* ---- text ---- */

/*
 * The number of columns is constant, and that of lines depends on the number of
 * ranks alone, so that the text stays in place.
 * The diagrams use Unicode, or ASCII where the terminal has no Unicode.
 */

#define PROGRESS_TEXT_COLS PLOT_COLS

/* Ranks that have a line: the late ones first, then the slow ones. */
#define PROGRESS_TEXT_RANKS 8

/* Lines of one process with the errors, and most lines, with those of ranks and
 * their title. */
#define PROGRESS_TEXT_USUAL_ROWS (12 + 5)
#define PROGRESS_TEXT_ROWS       (PROGRESS_TEXT_USUAL_ROWS + 1 + PROGRESS_TEXT_RANKS)

/* Size of a line: characters of the diagrams take three bytes in UTF-8. */
#define PROGRESS_TEXT_BYTES PLOT_BYTES

struct progress_text_facts {
    const struct render_progress *progress;
    const struct speeds *speeds;
    const struct error_history *errors;
    const double *loads; /* load of each thread, from 0 to 1 */
    int load_count;      /* 0 if an OpenCL device renders */
    bool has_unicode;
    const struct rank_progress *ranks;
    int rank_count; /* 0 without a cluster */
};

/* Line of the gauge, which the text leaves blank. */
#define PROGRESS_TEXT_GAUGE 1

/* Returns the number of lines. */
int progress_text_format(char lines[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES],
                         const struct progress_text_facts *facts);

/* Formats a number with three digits and a unit: 950, 9.50 k, 12.3 M, 123 G. */
void progress_text_number(char *text, size_t size_bytes, double value);

/* ---- the panel ---- */

struct progress_panel {
    bool is_on;      /* over the picture */
    bool leaves_bar; /* the person has removed it from the bar */
    uint64_t due_ns; /* time of the next update; 0 means at once */
    struct thread_load load;
    uint64_t load_ns; /* time when the measurement of the load began */
};

/* Returns the time of the next update of a panel that is shown, or UINT64_MAX
 * if nothing will change. */
uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct live_render *control);

/* Updates the text: in a bar beside or below the picture, as many lines as it
 * has (NULL: there is none), and in the window, which is opened first. */
void progress_panel_draw(struct progress_panel *panel,
                         const struct live_render *control,
                         struct screen *screen, const struct window_rect *bar,
                         uint64_t now_ns);

void progress_panel_free(struct progress_panel *panel);

#endif
