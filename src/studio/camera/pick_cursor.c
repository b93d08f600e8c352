// SPDX-License-Identifier: MIT
#include "studio/camera/pick_cursor.h"

#include <stdio.h>

#include "base/clock.h"
#include "base/min_max.h"

#define TEXT_BYTES 256

/* An arrow key that repeats within HELD_NS is held. After every HELD_CELLS
 * repeats its step grows by a cell. */
#define HELD_NS    UINT64_C(150000000)
#define HELD_CELLS 8

struct rect pick_cursor_shown_rect(const struct pick_cursor *cursor)
{
    const struct session *s = cursor->control->session;

    return s->options->has_crop ? s->options->crop
                                : (struct rect){0, 0, s->edit.now.view.width_px,
                                                s->edit.now.view.height_px};
}

const char *pick_cursor_object_name(const struct pick_cursor *cursor,
                                    uint32_t object)
{
    const char *name =
        cursor->control->session->engine.scene.object_names[object];

    return *name ? name : "no name";
}

static void describe(const struct pick_cursor *cursor, const struct pick *pick,
                     char text[TEXT_BYTES])
{
    const struct edit *edit = &cursor->control->session->edit;
    const char *material = edit->names[pick->material];

    snprintf(text, TEXT_BYTES, "%.60s / %.60s, face %u, %.4g away",
             pick_cursor_object_name(cursor, pick->object),
             *material ? material : "no material", pick->face + 1,
             pick->distance);
}

/* ---- finding surfaces ---- */

bool pick_cursor_point(const struct cells_rect *fit, int width_px,
                       int height_px, int col, int row, double point_px[2])
{
    if (col < fit->col || col >= fit->col + fit->cols || row < fit->row ||
        row >= fit->row + fit->rows)
        return false;
    point_px[0] = (col - fit->col + 0.5) * width_px / fit->cols;
    point_px[1] = (row - fit->row + 0.5) * height_px / fit->rows;
    return true;
}

static struct surfaces surfaces_of(const struct pick_cursor *cursor)
{
    const struct session *s = cursor->control->session;

    return (struct surfaces){&s->engine.scene, &s->engine.world};
}

static bool pick_cell(const struct pick_cursor *cursor, int col, int row,
                      struct pick *pick)
{
    const struct session *s = cursor->control->session;
    struct surfaces surfaces = surfaces_of(cursor);
    struct rect r = pick_cursor_shown_rect(cursor);
    double point_px[2];

    return pick_cursor_point(&cursor->screen->fit, r.width, r.height, col, row,
                             point_px) &&
           surfaces_pick(&surfaces, &s->edit.now.view, r.x + point_px[0],
                         r.y + point_px[1], pick);
}

static bool pick_under_cursor(const struct pick_cursor *cursor,
                              struct pick *pick)
{
    const struct screen *screen = cursor->screen;

    return pick_cell(cursor, screen->fit.col + screen->cursor_col,
                     screen->fit.row + screen->cursor_row, pick);
}

bool pick_cursor_find_center(const struct pick_cursor *cursor,
                             struct pick *pick)
{
    const struct session *s = cursor->control->session;
    struct surfaces surfaces = surfaces_of(cursor);
    struct rect r = pick_cursor_shown_rect(cursor);

    return surfaces_pick(&surfaces, &s->edit.now.view, r.x + r.width / 2.0,
                         r.y + r.height / 2.0, pick);
}

void pick_cursor_step(struct pick_cursor *cursor)
{
    struct pick pick;
    char text[TEXT_BYTES];

    if (!cursor->is_outdated)
        return;
    cursor->is_outdated = false;
    if (pick_under_cursor(cursor, &pick))
        describe(cursor, &pick, text);
    else
        snprintf(text, sizeof text, "nothing but the sky");
    live_render_say_long(cursor->control, "%s", text);
}

/* ---- moving ---- */

static void set_shown(struct pick_cursor *cursor, bool is_shown)
{
    cursor->screen->has_cursor = is_shown;
    cursor->is_outdated = is_shown;
    cursor->control->has_changed = true;
}

void pick_cursor_show(struct pick_cursor *cursor)
{
    struct screen *screen = cursor->screen;

    if (screen->cursor_col == 0 && screen->cursor_row == 0) {
        screen->cursor_col = screen->fit.cols / 2;
        screen->cursor_row = screen->fit.rows / 2;
    }
    set_shown(cursor, true);
}

void pick_cursor_hide(struct pick_cursor *cursor)
{
    set_shown(cursor, false);
    live_render_clear_message(cursor->control);
}

void pick_cursor_move(struct pick_cursor *cursor, int right, int down)
{
    struct screen *screen = cursor->screen;
    uint64_t now_ns = clock_ns();
    bool is_held = right == cursor->held_right && down == cursor->held_down &&
                   now_ns - cursor->held_ns < HELD_NS;
    int cells;

    cursor->held_count = is_held ? cursor->held_count + 1 : 0;
    cursor->held_right = right;
    cursor->held_down = down;
    cursor->held_ns = now_ns;
    cells = 1 + cursor->held_count / HELD_CELLS;
    screen->cursor_col =
        index_clamp(screen->cursor_col + cells * right, screen->fit.cols);
    screen->cursor_row =
        index_clamp(screen->cursor_row + cells * down, screen->fit.rows);
    set_shown(cursor, true);
}

/* ---- picking ---- */

static void set_pick(struct pick_cursor *cursor, const struct pick *pick)
{
    char text[TEXT_BYTES];

    cursor->pick = *pick;
    cursor->has_pick = cursor->is_pick_new = true;
    set_shown(cursor, false);
    describe(cursor, pick, text);
    live_render_say(cursor->control,
                    "%s (%s edits, %s orbit, %s focus, %s frame)", text,
                    live_render_key(cursor->control, ACTION_PANEL).text,
                    live_render_key(cursor->control, ACTION_ORBIT).text,
                    live_render_key(cursor->control, ACTION_FOCUS).text,
                    live_render_key(cursor->control, ACTION_FRAME).text);
}

bool pick_cursor_pick(struct pick_cursor *cursor)
{
    struct pick pick;

    if (pick_under_cursor(cursor, &pick)) {
        set_pick(cursor, &pick);
        return true;
    }
    live_render_say(cursor->control, "nothing but the sky");
    return false;
}

bool pick_cursor_click(struct pick_cursor *cursor, int col, int row)
{
    struct pick pick;

    if (!pick_cell(cursor, col, row, &pick))
        return false;
    set_pick(cursor, &pick);
    return true;
}

bool pick_cursor_need_pick(struct pick_cursor *cursor)
{
    if (cursor->screen->has_cursor)
        return pick_cursor_pick(cursor);
    if (cursor->has_pick)
        return true;
    live_render_say(cursor->control,
                    "nothing is picked: %s shows a cursor, %s picks",
                    live_render_key(cursor->control, ACTION_CURSOR).text,
                    live_render_key(cursor->control, ACTION_START).text);
    return false;
}
