// SPDX-License-Identifier: MIT
#include "studio/editor_panel.h"

#include <string.h>

#include "base/clock.h"
#include "base/min_max.h"
#include "studio/panel_draw.h"
#include "terminal/gauge.h"

#define ENTER     '\r'
#define ESCAPE    27
#define BACKSPACE 127

/* First gesture of the panel for edit_begin_gesture(); lower ones are the
 * camera's. */
#define GESTURES 1000u

/* Number of steps of the keys for a large change. */
#define MANY_STEPS 10

/* More rows than a list has. */
#define ALL_ROWS (1 << 29)

static struct edit *edit_of(const struct editor_panel *p)
{
    return &p->control->session->edit;
}

void editor_panel_init(struct editor_panel *p, struct live_render *control,
                       struct screen *screen)
{
    *p = (struct editor_panel){.control = control, .screen = screen};
    selection_init(&p->selection, &control->session->edit,
                   &control->session->engine.scene,
                   &control->session->engine.world);
}

void editor_panel_free(struct editor_panel *p)
{
    image_folder_free(&p->images);
    outline_free(&p->outline);
    material_ball_free(&p->ball);
    frame_free(&p->ball_frame);
    cells_free(&p->ball_cells);
    selection_free(&p->selection);
}

/* ---- the ball of the selected material ---- */

bool editor_panel_is_busy(const struct editor_panel *p)
{
    return p->is_open && p->shows_ball && !material_ball_is_done(&p->ball);
}

static bool open_ball(struct editor_panel *p, struct error *err)
{
    return p->ball_frame.rgb ||
           (frame_init(&p->ball_frame, BALL_PIXELS, BALL_PIXELS, err) &&
            cells_init(&p->ball_cells, BALL_COLS, BALL_ROWS, err));
}

bool editor_panel_step(struct editor_panel *p)
{
    const struct session *s = p->control->session;
    uint64_t textures = s->engine.world.versions[WORLD_TEXTURES];
    uint32_t material = selection_material(&p->selection);
    bool is_new = p->is_open && p->textures != textures;
    bool has_samples = false;
    struct world w;
    struct error err;

    p->textures = textures;
    if (!p->is_open || !p->shows_ball ||
        material >= s->engine.world.material_count)
        return is_new;
    w = world_arrays(&s->engine.world, &s->engine.scene);
    if (!open_ball(p, &err) ||
        !material_ball_add(&p->ball, &w, textures,
                           &s->engine.world.materials[material], &has_samples,
                           &err)) {
        live_render_say_error(p->control, err.text);
        p->shows_ball = false;
    }
    return is_new || has_samples;
}

void editor_panel_renew(struct editor_panel *p,
                        const struct selection_names *names)
{
    if (selection_renew(&p->selection, names))
        return;
    p->is_typing = false;
    p->is_in_parameters = false;
    p->parameter = p->parameter_top = 0;
    image_folder_free(&p->images);
}

void editor_panel_select(struct editor_panel *p, const struct pick *pick)
{
    struct selection *s = &p->selection;

    s->index[PAGE_MATERIALS] = pick->material;
    s->index[PAGE_OBJECTS] = pick->object;
    if (s->page == PAGE_LIGHT)
        s->page = PAGE_MATERIALS;
    selection_settle(s);
}

/* ---- the outline of what is selected ---- */

void editor_panel_outline(struct editor_panel *p, const struct camera *camera,
                          struct frame *frame)
{
    const struct session *s = p->control->session;
    enum selection_page page = p->is_open ? p->selection.page : PAGE_OBJECTS;
    struct outline_choice choice = {page == PAGE_OBJECTS,
                                    p->selection.index[page]};
    struct world w = world_arrays(&s->engine.world, &s->engine.scene);

    if ((p->is_open && p->is_in_parameters) || w.nodes == NULL ||
        p->control->progress.spp_done == 0 || !selection_has_one(&p->selection))
        return;
    w.settings.camera = *camera;
    outline_find(&p->outline, &w, &s->engine.scene,
                 s->engine.world.versions[WORLD_TRIS], choice, frame);
    outline_draw(&p->outline, frame);
}

/* ---- changes ---- */

/* Reports a change, so that the picture and the panel show it. */
static void take_change(struct editor_panel *p)
{
    p->control->has_changed = true;
}

static bool may_change(struct editor_panel *p)
{
    return live_render_may_edit(p->control, "materials change");
}

/* Returns the selected parameter; its id is -1 if there is none. */
static struct parameter selected(struct editor_panel *p)
{
    struct parameter list[PARAMETERS_MAX];

    if (panel_parameters(p, list) > 0)
        return list[p->parameter];
    return (struct parameter){.id = -1,
                              .fraction = -1,
                              .map = MTL_MAPS,
                              .lamp = NO_INDEX};
}

/* Returns the id of the selected parameter, or -1 if there is none or it may
 * not change now. */
static int changeable_id(struct editor_panel *p)
{
    int id = selected(p).id;

    return id < 0 || !may_change(p) ? -1 : id;
}

static void change_by(struct editor_panel *p, int steps)
{
    int id = changeable_id(p);

    if (id < 0)
        return;
    if (!selected(p).has_steps) {
        live_render_say(p->control, "Enter types a colour; the arrows change "
                                    "the rows below");
        return;
    }
    edit_begin_gesture(edit_of(p), GESTURES + (uint32_t)id, clock_ns());
    parameter_step(&p->selection, id, steps);
    take_change(p);
}

/* Sets the selected parameter to the place of a slider that is at this column
 * of the panel. */
static void drag_to(struct editor_panel *p, int col)
{
    int id = changeable_id(p);

    if (id < 0)
        return;
    edit_begin_gesture(edit_of(p), GESTURES + (uint32_t)id, clock_ns());
    parameter_set_fraction(&p->selection, id,
                           gauge_fraction(col - PANEL_SLIDER_COL,
                                          PANEL_SLIDER_COLS));
    take_change(p);
}

/* Lists the images beside the scene, for a map. */
static void choose_image(struct editor_panel *p, enum mtl_map map)
{
    const char *scene = p->control->session->engine.scene.path;

    if (!may_change(p))
        return;
    image_folder_list(&p->images, scene);
    p->image = p->image_top = 0;
    p->image_map = map;
    if (p->images.count == 0)
        live_render_say(p->control, "found no image beside %.100s", scene);
}

static void take_image(struct editor_panel *p)
{
    struct session *s = p->control->session;
    struct error err;

    if (!may_change(p))
        return;
    if (!session_set_map(s, selection_material(&p->selection), p->image_map,
                         p->images.paths[p->image], &err)) {
        live_render_say_error(p->control, err.text);
        return;
    }
    if (s->engine.scene.uv_count == 0)
        live_render_say(p->control, "the scene has no texture coordinates: "
                                    "one texel is shown everywhere");
    image_folder_free(&p->images);
    take_change(p);
}

static void take_typed(struct editor_panel *p)
{
    int id = changeable_id(p);
    struct error err;

    if (id < 0)
        return;
    edit_end_step(edit_of(p));
    if (parameter_set_text(&p->selection, id, p->typed, &err)) {
        p->is_typing = false;
        edit_end_step(edit_of(p));
        take_change(p);
    } else {
        live_render_say(p->control, "%s", err.text);
    }
}

static void compare(struct editor_panel *p)
{
    if (!may_change(p))
        return;
    edit_compare(edit_of(p), !edit_of(p)->is_comparing);
    take_change(p);
}

/* Selects the first parameter of a lamp, or the last of all. */
static void select_lamp(struct editor_panel *p, uint32_t lamp)
{
    struct parameter list[PARAMETERS_MAX];
    int count = parameters_list(&p->selection, list);

    for (p->parameter = 0; p->parameter < count - 1; p->parameter++)
        if (list[p->parameter].lamp == lamp)
            break;
}

void editor_panel_add_lamp(struct editor_panel *p)
{
    struct edit *e = edit_of(p);
    struct lamp lamp;

    if (!may_change(p))
        return;
    if (e->now.view.lamps.count >= PARAMETER_LAMPS) {
        live_render_say(p->control, "the panel lists %d lights at most",
                        PARAMETER_LAMPS);
        return;
    }
    lamp = parameter_new_lamp(&p->selection, selected(p).lamp);
    edit_end_step(e);
    select_lamp(p, edit_add_lamp(e, &lamp));
    edit_end_step(e);
    take_change(p);
}

static void remove_lamp(struct editor_panel *p)
{
    uint32_t lamp = selected(p).lamp;

    if (lamp == NO_INDEX) {
        live_render_say(p->control, "select a value of the light to remove "
                                    "on the page of light");
        return;
    }
    if (!may_change(p))
        return;
    edit_end_step(edit_of(p));
    edit_remove_lamp(edit_of(p), lamp);
    edit_end_step(edit_of(p));
    take_change(p);
}

/* Copies the selected material. On the page of objects, the object gets the
 * copy. */
static void duplicate(struct editor_panel *p)
{
    struct selection *s = &p->selection;
    struct edit *e = edit_of(p);
    uint32_t object = s->index[PAGE_OBJECTS];
    uint32_t *material = &s->index[PAGE_MATERIALS];

    if (s->page == PAGE_LIGHT) {
        editor_panel_add_lamp(p);
        return;
    }
    if (!selection_has_one(s) || !may_change(p))
        return;
    edit_end_step(e);
    if (s->page == PAGE_OBJECTS) {
        *material = edit_duplicate(e, selection_material_of(s, object));
        edit_assign(e, object, *material);
        live_render_say(p->control, "%.40s has its own material now: %.40s",
                        selection_name(s, PAGE_OBJECTS, object),
                        e->names[*material]);
    } else {
        *material = edit_duplicate(e, *material);
        live_render_say(p->control, "%.60s: Tab goes to the objects for it",
                        e->names[*material]);
    }
    edit_end_step(e);
    selection_settle(s);
    take_change(p);
}

/* ---- pages, rows ---- */

void editor_panel_open(struct editor_panel *p)
{
    p->is_open = true;
    p->is_in_parameters = p->selection.page == PAGE_LIGHT;
    selection_settle(&p->selection);
}

void editor_panel_close(struct editor_panel *p)
{
    image_folder_free(&p->images);
    p->is_open = false;
    p->is_typing = p->is_finding = false;
}

void editor_panel_show(struct editor_panel *p, enum selection_page page)
{
    p->selection.page = page;
    selection_settle(&p->selection);
    p->is_in_parameters = page == PAGE_LIGHT;
    p->parameter = p->parameter_top = p->list_top = 0;
    image_folder_free(&p->images);
}

static void move(struct editor_panel *p, int step)
{
    if (p->images.count > 0)
        p->image = int_max(int_min(p->image + step, p->images.count - 1), 0);
    else if (p->is_in_parameters)
        p->parameter += step; /* panel_parameters() keeps it in bounds */
    else
        selection_move(&p->selection, step);
}

/* Begins to type the value of the selected parameter. Enter changes a parameter
 * that takes no text by one step. */
static void begin_typing(struct editor_panel *p, int key)
{
    struct parameter parameter = selected(p);

    if (parameter.id < 0)
        return;
    if (!parameter.takes_text) {
        if (key == ENTER && parameter.map != MTL_MAPS)
            choose_image(p, parameter.map);
        else if (key == ENTER)
            change_by(p, 1);
        else
            live_render_say(p->control,
                            "this is changed with the arrows, or Enter");
        return;
    }
    p->is_typing = true;
    p->typed[0] = (char)(key == ENTER ? '\0' : key);
    p->typed[1] = '\0';
}

static void type_letter(struct editor_panel *p, int key)
{
    size_t length = strlen(p->typed);

    if ((key == BACKSPACE || key == '\b') && length > 0) {
        p->typed[length - 1] = '\0';
    } else if (key >= ' ' && key < 256 && key != BACKSPACE &&
               length + 1 < sizeof p->typed) {
        p->typed[length] = (char)key;
        p->typed[length + 1] = '\0';
    }
}

static void type(struct editor_panel *p, int key)
{
    if (key == ENTER)
        take_typed(p);
    else if (key == ESCAPE)
        p->is_typing = false;
    else
        type_letter(p, key);
}

/* Selects the next entry whose name has the text that is typed, from the
 * selected one or the one after it on, around the end of the list. */
static void find(struct editor_panel *p, bool is_next)
{
    struct selection *s = &p->selection;

    for (int i = 0; i < s->listed_count; i++) {
        int row = (s->row + is_next + i) % s->listed_count;
        const char *name = selection_name(s, s->page, s->listed[row]);

        if (strcasestr(name, p->typed) != NULL) {
            selection_move(s, row - s->row);
            return;
        }
    }
    live_render_say(p->control, "no name has '%.40s'", p->typed);
}

static void begin_finding(struct editor_panel *p)
{
    p->is_finding =
        p->selection.page != PAGE_LIGHT && p->selection.listed_count > 0;
    p->is_in_parameters = p->is_in_parameters && !p->is_finding;
    p->typed[0] = '\0';
}

static void type_name(struct editor_panel *p, int key)
{
    if (key == ESCAPE) {
        p->is_finding = false;
    } else if (key == TTY_KEY_UP || key == TTY_KEY_DOWN) {
        move(p, key == TTY_KEY_UP ? -1 : 1);
    } else {
        bool is_next = key == ENTER;

        type_letter(p, key);
        find(p, is_next);
    }
}

static void enter(struct editor_panel *p)
{
    if (p->images.count > 0)
        take_image(p);
    else if (p->is_in_parameters)
        begin_typing(p, ENTER);
    else
        p->is_in_parameters = selection_has_one(&p->selection);
}

/* Changes the selected parameter by steps. In the list, a step to the right
 * moves to the parameters. */
static void step(struct editor_panel *p, int by)
{
    if (p->is_in_parameters)
        change_by(p, by);
    else if (by > 0)
        enter(p);
}

static void leave(struct editor_panel *p)
{
    if (p->images.count > 0)
        image_folder_free(&p->images);
    else if (p->is_in_parameters && p->selection.page != PAGE_LIGHT)
        p->is_in_parameters = false;
    else
        editor_panel_close(p);
}

/* ---- mouse ---- */

static void click(struct editor_panel *p, int col, int row)
{
    struct selection *s = &p->selection;
    int list_row = p->list_top + row - 1;
    int parameter_row = row - 2 - p->list_rows;

    p->is_typing = p->is_finding = false;
    if (p->images.count > 0) {
        if (row > 0 && p->image_top + row - 1 < p->images.count) {
            p->image = p->image_top + row - 1;
            take_image(p);
        }
    } else if (row == 0) {
        editor_panel_show(p, col < PAGE_2   ? PAGE_MATERIALS
                             : col < PAGE_3 ? PAGE_OBJECTS
                                            : PAGE_LIGHT);
    } else if (row <= p->list_rows && list_row < s->listed_count) {
        selection_move(s, list_row - s->row);
        p->is_in_parameters = false;
    } else if (parameter_row >= 0 && parameter_row < p->parameter_rows) {
        p->parameter = p->parameter_top + parameter_row;
        p->is_in_parameters = true;
        p->is_dragging = col >= PANEL_SLIDER_COL && selected(p).fraction >= 0;
        if (p->is_dragging)
            drag_to(p, col);
    }
}

static void wheel(struct editor_panel *p, int up)
{
    if (p->is_in_parameters && p->images.count == 0)
        change_by(p, up);
    else
        move(p, -up);
}

bool editor_panel_mouse(struct editor_panel *p, const struct event *event)
{
    int col = event->x - 1 - (term_size().cols - p->screen->panel_cols);

    if (p->is_dragging && event->mouse == MOUSE_DRAG) {
        drag_to(p, col);
        return true;
    }
    if (event->mouse != MOUSE_OTHER)
        p->is_dragging = false;
    if (!p->is_open || col < 0 || event->mouse == MOUSE_RELEASE)
        return false;
    if (event->mouse == MOUSE_PRESS)
        click(p, col, event->y - 1);
    else if (event->mouse == MOUSE_WHEEL_UP)
        wheel(p, 1);
    else if (event->mouse == MOUSE_WHEEL_DOWN)
        wheel(p, -1);
    return true;
}

/* ---- keys ---- */

/* Returns the action of a key: none of the values' while an image is chosen. */
static enum panel_action chosen_action(const struct editor_panel *p, int key)
{
    enum panel_action action = keymap_panel_action(key);

    return p->images.count > 0 && action != PANEL_UP && action != PANEL_DOWN &&
                   action != PANEL_PAGE_UP && action != PANEL_PAGE_DOWN &&
                   action != PANEL_FIRST && action != PANEL_LAST &&
                   action != PANEL_ENTER && action != PANEL_LEAVE
               ? PANEL_NONE
               : action;
}

bool editor_panel_key(struct editor_panel *p, int key)
{
    if (p->is_typing || p->is_finding) {
        if (p->is_typing)
            type(p, key);
        else
            type_name(p, key);
        return true;
    }
    switch (chosen_action(p, key)) {
    case PANEL_NONE: return false;
    case PANEL_UP: move(p, -1); break;
    case PANEL_DOWN: move(p, 1); break;
    case PANEL_LESS: step(p, -1); break;
    case PANEL_MORE: step(p, 1); break;
    case PANEL_PAGE_UP: move(p, -10); break;
    case PANEL_PAGE_DOWN: move(p, 10); break;
    case PANEL_FIRST: move(p, -ALL_ROWS); break;
    case PANEL_LAST: move(p, ALL_ROWS); break;
    case PANEL_FIND: begin_finding(p); break;
    case PANEL_ENTER: enter(p); break;
    case PANEL_MUCH_LESS: change_by(p, -MANY_STEPS); break;
    case PANEL_MUCH_MORE: change_by(p, MANY_STEPS); break;
    case PANEL_TYPE:
        if (!p->is_in_parameters)
            return false;
        begin_typing(p, key);
        break;
    case PANEL_HSV: p->selection.by_hsv = !p->selection.by_hsv; break;
    case PANEL_NEXT_PAGE:
        editor_panel_show(p, (enum selection_page)((p->selection.page + 1) %
                                                   (PAGES)));
        break;
    case PANEL_COPY: duplicate(p); break;
    case PANEL_REMOVE: remove_lamp(p); break;
    case PANEL_COMPARE: compare(p); break;
    case PANEL_LEAVE: leave(p); break;
    }
    return true;
}
