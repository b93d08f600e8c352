// SPDX-License-Identifier: MIT
#include "studio/pick_cursor.h"

#include <stdio.h>

#define TEXT_BYTES 256

/* An arrow that comes again within this time is held; every so many cells it
 * goes a cell further at once. */
#define HELD_NS    UINT64_C(150000000)
#define HELD_CELLS 8

struct rect cursor_shown_rect(const struct cursor *c)
{
    const struct session *s = c->work->session;

    return s->options->has_crop
               ? s->options->crop
               : (struct rect){0, 0, s->view.width_px, s->view.height_px};
}

const char *cursor_object_name(const struct cursor *c, uint32_t object)
{
    const char *name = c->work->session->scene.object_names[object];

    return *name ? name : "no name";
}

static void describe(const struct cursor *c, const struct pick *pick,
                     char text[TEXT_BYTES])
{
    const struct scene *scene = &c->work->session->scene;
    const char *material = scene->material_names[pick->material];

    snprintf(text, TEXT_BYTES, "%.60s, %.60s, face %u, %.4g away",
             cursor_object_name(c, pick->object),
             *material ? material : "no material", pick->face + 1,
             pick->distance);
}

/* ---- looking ---- */

static bool look_at_cell(const struct cursor *c, int col, int row,
                         struct pick *pick)
{
    const struct session *s = c->work->session;
    struct rect r = cursor_shown_rect(c);
    double x_px, y_px;

    return pick_point_of_cell(&c->canvas->fit, r.width, r.height, col, row,
                              &x_px, &y_px) &&
           pick_at(&s->scene, &s->view, r.x + x_px, r.y + y_px, pick);
}

static bool look_under(const struct cursor *c, struct pick *pick)
{
    const struct canvas *canvas = c->canvas;

    return look_at_cell(c, canvas->fit.col + canvas->cursor_col,
                        canvas->fit.row + canvas->cursor_row, pick);
}

bool cursor_look_ahead(const struct cursor *c, struct pick *pick)
{
    const struct session *s = c->work->session;
    struct rect r = cursor_shown_rect(c);

    return pick_at(&s->scene, &s->view, r.x + r.width / 2.0,
                   r.y + r.height / 2.0, pick);
}

void cursor_step(struct cursor *c)
{
    struct pick pick;
    char text[TEXT_BYTES];

    if (!c->must_look)
        return;
    c->must_look = false;
    if (look_under(c, &pick))
        describe(c, &pick, text);
    else
        snprintf(text, sizeof text, "nothing but the sky");
    work_say_long(c->work, "%s", text);
}

/* ---- moving ---- */

static void show(struct cursor *c, bool is_shown)
{
    struct canvas *canvas = c->canvas;

    if (is_shown && canvas->cursor_col == 0 && canvas->cursor_row == 0) {
        canvas->cursor_col = canvas->fit.cols / 2;
        canvas->cursor_row = canvas->fit.rows / 2;
    }
    canvas->has_cursor = is_shown;
    c->must_look = is_shown;
    c->work->has_changed = true;
}

static int within(int x, int count)
{
    return x < 0 ? 0 : x >= count ? count - 1 : x;
}

static void move(struct cursor *c, enum action action, int right, int down)
{
    struct canvas *canvas = c->canvas;
    uint64_t now_ns = clock_ns();
    bool is_held = action == c->held && now_ns - c->held_ns < HELD_NS;
    int cells;

    c->held_count = is_held ? c->held_count + 1 : 0;
    c->held = action;
    c->held_ns = now_ns;
    cells = 1 + c->held_count / HELD_CELLS;
    canvas->cursor_col =
        within(canvas->cursor_col + cells * right, canvas->fit.cols);
    canvas->cursor_row =
        within(canvas->cursor_row + cells * down, canvas->fit.rows);
    show(c, true);
}

/* ---- picking ---- */

static void take(struct cursor *c, const struct pick *pick)
{
    char text[TEXT_BYTES];

    c->pick = *pick;
    c->has_pick = c->is_pick_new = true;
    show(c, false);
    describe(c, pick, text);
    work_say(c->work, "%s (%s orbit, %s focus, %s frame)", text,
             work_key(c->work, ACTION_ORBIT).text,
             work_key(c->work, ACTION_FOCUS).text,
             work_key(c->work, ACTION_FRAME).text);
}

static bool pick_under(struct cursor *c)
{
    struct pick pick;

    if (look_under(c, &pick)) {
        take(c, &pick);
        return true;
    }
    work_say(c->work, "nothing but the sky");
    return false;
}

bool cursor_click(struct cursor *c, int col, int row)
{
    struct pick pick;

    if (!look_at_cell(c, col, row, &pick))
        return false;
    take(c, &pick);
    return true;
}

bool cursor_need_pick(struct cursor *c)
{
    if (c->canvas->has_cursor)
        return pick_under(c);
    if (c->has_pick)
        return true;
    work_say(c->work, "nothing is picked: %s shows a cursor, %s picks",
             work_key(c->work, ACTION_CURSOR).text,
             work_key(c->work, ACTION_START).text);
    return false;
}

static bool act_while_shown(struct cursor *c, enum action action)
{
    switch (action) {
    case ACTION_LOOK_LEFT: move(c, action, -1, 0); break;
    case ACTION_LOOK_RIGHT: move(c, action, 1, 0); break;
    case ACTION_LOOK_UP: move(c, action, 0, -1); break;
    case ACTION_LOOK_DOWN: move(c, action, 0, 1); break;
    case ACTION_START: pick_under(c); break;
    case ACTION_CURSOR:
    case ACTION_CANCEL:
        show(c, false);
        work_be_silent(c->work);
        break;
    default: return false;
    }
    return true;
}

bool cursor_act(struct cursor *c, enum action action)
{
    if (c->canvas->has_cursor)
        return act_while_shown(c, action);
    if (action == ACTION_CURSOR)
        show(c, true);
    else if (action == ACTION_CANCEL)
        work_be_silent(c->work);
    return action == ACTION_CURSOR || action == ACTION_CANCEL;
}
