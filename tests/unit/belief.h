// SPDX-License-Identifier: MIT
/*
 * belief.h - a child process that runs glim reports the screen it expects
 *
 * Each time before it waits, the child describes its screen in shared memory,
 * writes the string "told" to the terminal, and continues when the parent has
 * compared it. The linker replaces glim's functions by
 * __wrap_workspace_next_ns() and __wrap_tty_read() (see tests.mk).
 *
 * Units:     cells, row 0 at the top
 * Ownership: the test maps `shared`
 * Threads:   the child's main thread
 */
#ifndef TESTS_BELIEF_H
#define TESTS_BELIEF_H

#include <curses.h>
#include <malloc.h>
#include <semaphore.h>
#include <stdbool.h>
#include <string.h>

#include "studio/workspace.h"
#include "tests/unit/vt.h"

/* Longest pause of the child, so that the parent always gets an answer. */
#define WAKE_NS UINT64_C(20000000)

enum belief { BELIEF_TEXT, BELIEF_PICTURE, BELIEF_UNKNOWN };

struct belief_cell {
    enum belief kind;
    struct vt_cell text;
    struct cell picture;
};

static struct shared {
    sem_t go; /* the parent has compared the screen */
    unsigned told;
    unsigned long taken_bytes; /* bytes of keys */
    bool is_whole;             /* curses has written everything */
    int cols, rows;
    bool wants_memory; /* the child measures its memory each time */
    long allocated_bytes;
    struct belief_cell cell[VT_ROWS_MAX][VT_COLS_MAX];
} * shared;

static bool is_child;

int __real_tty_read(void *bytes, size_t size_bytes);
uint64_t __real_workspace_next_ns(const struct workspace *workspace,
                                  uint64_t now_ns);
int __wrap_tty_read(void *bytes, size_t size_bytes);
uint64_t __wrap_workspace_next_ns(const struct workspace *workspace,
                                  uint64_t now_ns);

int __wrap_tty_read(void *bytes, size_t size_bytes)
{
    int count = __real_tty_read(bytes, size_bytes);

    if (is_child && count > 0)
        shared->taken_bytes += (unsigned long)count;
    return count;
}

static void tell_text(void)
{
    for (int y = 0; y < shared->rows; y++) {
        for (int x = 0; x < shared->cols; x++) {
            const struct window_cell *shown = windows_shown(x, y);
            struct belief_cell *cell = &shared->cell[y][x];
            struct vt_cell *text = &cell->text;

            memset(cell, 0, sizeof *cell);
            if (shown->kind == WINDOW_CELL_SPARED) {
                cell->text = (struct vt_cell){.fg = CELL_DEFAULT,
                                              .bg = CELL_DEFAULT,
                                              .glyph = ' '};
                continue;
            }
            text->fg = shown->style.fg;
            text->bg = shown->style.bg;
            text->glyph = shown->kind == WINDOW_CELL_TAIL
                              ? VT_TAIL
                              : (uint32_t)shown->text[0];
            for (int i = 0; i < VT_COMBINED_MAX && text->glyph != VT_TAIL; i++)
                text->combined[i] = (uint32_t)shown->text[i + 1];
            if (shown->kind == WINDOW_CELL_LINE)
                text->glyph = vt_line_drawing(text->glyph);
            if (shown->style.attributes & TEXT_BOLD)
                text->attributes |= VT_BOLD;
            if (shown->style.attributes & TEXT_DIM)
                text->attributes |= VT_DIM;
            if (shown->style.attributes & TEXT_REVERSE)
                text->attributes |= VT_REVERSE;
        }
    }
}

static void tell_cells(const struct ansi_diff *a, const struct cells_rect *fit)
{
    for (int y = fit->row; y < fit->row + fit->rows; y++) {
        for (int x = fit->col; x < fit->col + fit->cols; x++) {
            const struct cell *shown = ansi_diff_shown(a, x, y);
            struct belief_cell *cell = &shared->cell[y][x];

            cell->kind = shown->glyph == 0 ? BELIEF_UNKNOWN : BELIEF_PICTURE;
            cell->picture = *shown;
        }
    }
}

static void tell_picture(const struct screen *screen)
{
    struct belief_cell under[VT_ROWS_MAX][VT_COLS_MAX];
    const struct ansi_diff_rect *r = &screen->window;

    memcpy(under, shared->cell, sizeof under);
    tell_cells(&screen->ansi, &screen->fit);
    for (int y = r->row; y < r->row + r->rows; y++)
        for (int x = r->col; x < r->col + r->cols; x++)
            shared->cell[screen->fit.row + y][screen->fit.col + x] =
                under[screen->fit.row + y][screen->fit.col + x];
    if (screen_is_hidden(screen))
        memcpy(shared->cell, under, sizeof under);
    if (screen->has_status)
        memcpy(shared->cell[shared->rows - 1], under[shared->rows - 1],
               sizeof under[0]);
}

/* Returns the bytes that are allocated in all arenas, by the sums that the C
 * library writes behind those of each. */
static long allocated_bytes(void)
{
    char *text = NULL;
    size_t size_bytes;
    FILE *to = open_memstream(&text, &size_bytes);
    long fast, rest, mapped, all, sum = 0;

    malloc_info(0, to);
    fclose(to);
    for (const char *p = text; (p = strstr(p, "</heap>")) != NULL; p++)
        if (sscanf(p,
                   "</heap> <total type=\"fast\" count=\"%*d\" size=\"%ld\"/> "
                   "<total type=\"rest\" count=\"%*d\" size=\"%ld\"/> "
                   "<total type=\"mmap\" count=\"%*d\" size=\"%ld\"/> "
                   "<system type=\"current\" size=\"%ld\"/>",
                   &fast, &rest, &mapped, &all) == 4)
            sum = all + mapped - fast - rest;
    free(text);
    return sum;
}

static void tell(const struct screen *screen)
{
    shared->is_whole = !screen->must_update && screen->has_all_answers;
    shared->cols = COLS;
    shared->rows = LINES;
    if (shared->is_whole)
        tell_text();
    if (shared->is_whole && !screen->is_too_small)
        tell_picture(screen);
    if (shared->wants_memory)
        shared->allocated_bytes = allocated_bytes();
    shared->told++;
    tty_write("\033]told\033\\", 8);
    while (sem_wait(&shared->go) != 0) {
        /* interrupted by a signal */
    }
}

uint64_t __wrap_workspace_next_ns(const struct workspace *workspace,
                                  uint64_t now_ns)
{
    uint64_t next_ns = __real_workspace_next_ns(workspace, now_ns);

    if (!is_child)
        return next_ns;
    tell(&workspace->screen);
    return next_ns < now_ns + WAKE_NS ? next_ns : now_ns + WAKE_NS;
}

#endif
