// SPDX-License-Identifier: MIT
#include "studio/pick_cursor.h"

#include <stdio.h>

#include "base/clock.h"

#define TEXT_BYTES 256

/* An arrow that comes again within this time is held; every so many cells it
 * goes a cell further at once. */
#define HELD_NS    UINT64_C(150000000)
#define HELD_CELLS 8

struct rect pick_cursor_shown_rect(const struct pick_cursor *c)
{
    const struct session *s = c->work->session;

    return s->options->has_crop
               ? s->options->crop
               : (struct rect){0, 0, s->view.width_px, s->view.height_px};
}

const char *pick_cursor_object_name(const struct pick_cursor *c,
                                    uint32_t object)
{
    const char *name = c->work->session->scene.object_names[object];

    return *name ? name : "no name";
}

static void describe(const struct pick_cursor *c, const struct pick *pick,
                     char text[TEXT_BYTES])
{
    const struct scene *scene = &c->work->session->scene;
    const char *material = scene->material_names[pick->material];

    snprintf(text, TEXT_BYTES, "%.60s, %.60s, face %u, %.4g away",
             pick_cursor_object_name(c, pick->object),
             *material ? material : "no material", pick->face + 1,
             pick->distance);
}

/* ---- looking ---- */

static bool look_at_cell(const struct pick_cursor *c, int col, int row,
                         struct pick *pick)
{
    const struct session *s = c->work->session;
    struct rect r = pick_cursor_shown_rect(c);
    double x_px, y_px;

    return pick_point_of_cell(&c->canvas->fit, r.width, r.height, col, row,
                              &x_px, &y_px) &&
           pick_at(&s->scene, &s->view, r.x + x_px, r.y + y_px, pick);
}

static bool look_under(const struct pick_cursor *c, struct pick *pick)
{
    const struct screen *canvas = c->canvas;

    return look_at_cell(c, canvas->fit.col + canvas->cursor_col,
                        canvas->fit.row + canvas->cursor_row, pick);
}

bool pick_cursor_look_ahead(const struct pick_cursor *c, struct pick *pick)
{
    const struct session *s = c->work->session;
    struct rect r = pick_cursor_shown_rect(c);

    return pick_at(&s->scene, &s->view, r.x + r.width / 2.0,
                   r.y + r.height / 2.0, pick);
}

void pick_cursor_step(struct pick_cursor *c)
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
    render_control_say_long(c->work, "%s", text);
}

/* ---- moving ---- */

static void show(struct pick_cursor *c, bool is_shown)
{
    struct screen *canvas = c->canvas;

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

static void move(struct pick_cursor *c, enum action action, int right, int down)
{
    struct screen *canvas = c->canvas;
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

static void take(struct pick_cursor *c, const struct pick *pick)
{
    char text[TEXT_BYTES];

    c->pick = *pick;
    c->has_pick = c->is_pick_new = true;
    show(c, false);
    describe(c, pick, text);
    render_control_say(c->work, "%s (%s orbit, %s focus, %s frame)", text,
                       render_control_key(c->work, ACTION_ORBIT).text,
                       render_control_key(c->work, ACTION_FOCUS).text,
                       render_control_key(c->work, ACTION_FRAME).text);
}

static bool pick_under(struct pick_cursor *c)
{
    struct pick pick;

    if (look_under(c, &pick)) {
        take(c, &pick);
        return true;
    }
    render_control_say(c->work, "nothing but the sky");
    return false;
}

bool pick_cursor_click(struct pick_cursor *c, int col, int row)
{
    struct pick pick;

    if (!look_at_cell(c, col, row, &pick))
        return false;
    take(c, &pick);
    return true;
}

bool pick_cursor_need_pick(struct pick_cursor *c)
{
    if (c->canvas->has_cursor)
        return pick_under(c);
    if (c->has_pick)
        return true;
    render_control_say(c->work,
                       "nothing is picked: %s shows a cursor, %s picks",
                       render_control_key(c->work, ACTION_CURSOR).text,
                       render_control_key(c->work, ACTION_START).text);
    return false;
}

static bool act_while_shown(struct pick_cursor *c, enum action action)
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
        render_control_be_silent(c->work);
        break;
    default: return false;
    }
    return true;
}

bool pick_cursor_act(struct pick_cursor *c, enum action action)
{
    if (c->canvas->has_cursor)
        return act_while_shown(c, action);
    if (action == ACTION_CURSOR)
        show(c, true);
    else if (action == ACTION_CANCEL)
        render_control_be_silent(c->work);
    return action == ACTION_CURSOR || action == ACTION_CANCEL;
}
