// SPDX-License-Identifier: MIT
#include "glim/panel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CTRL(letter) ((letter)&31)
#define TAB          '\t'
#define ENTER        '\r'
#define ESCAPE       27
#define BACKSPACE    127

/* The same knob turned again within this time is the same step of undo: longer
 * than keyboards wait before they repeat. */
#define TURN_NS UINT64_C(700000000)

/* Rows beside list and knobs: pages, a title, two of hints. */
#define OTHER_ROWS 4
#define LIST_MIN   3

#define BAR_COLS 9

/* What there is to draw on. */
struct sheet {
    struct term_line *lines;
    int count;
    struct swatches *swatches;
};

static struct edit *edit_of(const struct panel *p)
{
    return &p->work->session->edit;
}

static const struct scene *scene_of(const struct panel *p)
{
    return &p->work->session->scene;
}

void panel_init(struct panel *p, struct work *work, struct canvas *canvas)
{
    const struct scene *scene = &work->session->scene;

    *p = (struct panel){.work = work, .canvas = canvas};
    p->first_tris = xcalloc(scene->object_count + 1, sizeof *p->first_tris);
    for (uint32_t i = 0; i < scene->object_count; i++)
        p->first_tris[i] = NO_INDEX;
    for (uint32_t i = scene->tri_count; i-- > 0;)
        p->first_tris[scene->tri_objects[i]] = i;
}

void panel_free(struct panel *p)
{
    free(p->first_tris);
}

/* ---- what is selected ---- */

static uint32_t list_count(const struct panel *p)
{
    switch (p->page) {
    case KNOB_MATERIAL: return edit_of(p)->material_count;
    case KNOB_OBJECT: return edit_of(p)->object_count;
    case KNOB_LIGHT: break;
    }
    return 0;
}

/* The default material is nobody's to change, and objects without a face and
 * duplicates that were undone are not shown. */
static bool is_listed(const struct panel *p, uint32_t i)
{
    if (p->page == KNOB_MATERIAL)
        return i > 0 && edit_of(p)->now.is_there[i];
    return p->first_tris[i] != NO_INDEX;
}

static uint32_t *selected(struct panel *p)
{
    return p->page == KNOB_OBJECT ? &p->object : &p->material;
}

/* The next one in the list, or the same at its end. */
static uint32_t step_in_list(const struct panel *p, uint32_t from, int step)
{
    uint32_t count = list_count(p);

    for (int64_t i = (int64_t)from + step; i >= 0 && i < count; i += step)
        if (is_listed(p, (uint32_t)i))
            return (uint32_t)i;
    return from;
}

/* What is selected may have gone, or never been there. */
static void settle(struct panel *p)
{
    uint32_t *i = selected(p);

    if (list_count(p) == 0 || (*i < list_count(p) && is_listed(p, *i)))
        return;
    *i = step_in_list(p, *i, -1);
    if (*i >= list_count(p) || !is_listed(p, *i))
        *i = step_in_list(p, 0, 1);
}

static bool has_target(struct panel *p)
{
    return p->page == KNOB_LIGHT ||
           (*selected(p) < list_count(p) && is_listed(p, *selected(p)));
}

static struct knob_target target_of(struct panel *p)
{
    return (struct knob_target){p->page, *selected(p), p->by_hsv};
}

static int list_knobs(struct panel *p, struct knob knobs[KNOBS_MAX])
{
    struct knob_target target = target_of(p);
    int count =
        has_target(p) ? knobs_list(edit_of(p), scene_of(p), &target, knobs) : 0;

    p->knob = p->knob >= count ? count - 1 : p->knob;
    p->knob = p->knob < 0 ? 0 : p->knob;
    return count;
}

void panel_select(struct panel *p, const struct pick *pick)
{
    p->material = pick->material;
    p->object = pick->object;
    if (p->page == KNOB_LIGHT)
        p->page = KNOB_MATERIAL;
    settle(p);
}

/* ---- drawing ---- */

static void add_line(struct sheet *s, enum term_look look, const char *text)
{
    struct term_line *line = &s->lines[s->count++];

    line->look = look;
    snprintf(line->text, sizeof line->text, "%s", text);
}

static void add_pages(struct sheet *s, enum knob_page page)
{
    static const char *const titles[] = {
        [KNOB_MATERIAL] = "[Materials]  Objects   Light",
        [KNOB_OBJECT] = " Materials  [Objects]  Light",
        [KNOB_LIGHT] = " Materials   Objects  [Light]",
    };

    add_line(s, TERM_TITLE, titles[page]);
}

static uint32_t material_of_object(const struct panel *p, uint32_t object)
{
    uint32_t assigned = edit_shown(edit_of(p))->assigned[object];

    if (assigned != NO_INDEX)
        return assigned;
    return scene_of(p)->file_materials != NULL
               ? scene_of(p)->file_materials[p->first_tris[object]]
               : scene_of(p)->tris[p->first_tris[object]].material;
}

static const char *shown_name(const char *name)
{
    return *name != '\0' ? name : "(no name)";
}

/* A material with its kind, or an object with its material. */
static void add_item(struct panel *p, struct sheet *s, uint32_t i)
{
    const struct edit *e = edit_of(p);
    bool is_object = p->page == KNOB_OBJECT;
    uint32_t material = is_object ? material_of_object(p, i) : i;
    const struct mtl_source *source = &edit_shown(e)->sources[material];
    bool is_selected = i == *selected(p);
    char text[64];
    double rgb[3];

    snprintf(text, sizeof text, "%s    %-17.17s %.13s", is_selected ? ">" : " ",
             shown_name(is_object ? scene_of(p)->object_names[i] : e->names[i]),
             is_object ? shown_name(e->names[material]) : look_kind(source));
    look_swatch(source, rgb);
    swatches_set(s->swatches, s->count, rgb);
    add_line(s, is_selected && !p->is_in_knobs ? TERM_SELECTED : TERM_PLAIN,
             text);
}

/* Part of the list, with what is selected in it. */
static void add_list(struct panel *p, struct sheet *s, int rows)
{
    uint32_t count = list_count(p);
    int number = 0, chosen = 0, shown = 0;

    for (uint32_t i = 0; i < count && i < *selected(p); i++)
        chosen += is_listed(p, i);
    if (p->list_top > chosen)
        p->list_top = chosen;
    if (p->list_top < chosen - rows + 1)
        p->list_top = chosen - rows + 1;
    for (uint32_t i = 0; i < count && shown < rows; i++) {
        if (!is_listed(p, i) || number++ < p->list_top)
            continue;
        add_item(p, s, i);
        shown++;
    }
    for (; shown < rows; shown++)
        add_line(s, TERM_PLAIN, "");
}

static void add_title(struct panel *p, struct sheet *s)
{
    const struct edit *e = edit_of(p);
    char text[64];

    if (e->is_comparing)
        snprintf(text, sizeof text, " as saved: x goes back");
    else if (p->page == KNOB_LIGHT)
        snprintf(text, sizeof text, " Sky and picture%s",
                 edit_has_unsaved_view(e) ? " *" : "");
    else if (!has_target(p))
        snprintf(text, sizeof text, " nothing to edit");
    else if (p->page == KNOB_OBJECT)
        snprintf(text, sizeof text, " %.34s",
                 shown_name(scene_of(p)->object_names[p->object]));
    else
        snprintf(text, sizeof text, " %.32s%s", e->names[p->material],
                 edit_is_saved(e, p->material) ? "" : " *");
    add_line(s, TERM_TITLE, text);
}

static void format_bar(char bar[BAR_COLS + 1], double place)
{
    int filled = (int)(place * BAR_COLS + 0.5);

    for (int i = 0; i < BAR_COLS; i++)
        bar[i] = place < 0 ? ' ' : i < filled ? '=' : '.';
    bar[BAR_COLS] = '\0';
}

static void add_knob(struct panel *p, struct sheet *s, const struct knob *k,
                     bool is_selected)
{
    char bar[BAR_COLS + 1];
    char text[64];
    size_t length = strlen(p->typed);

    format_bar(bar, k->place);
    if (is_selected && p->is_typing)
        snprintf(text, sizeof text, "     %-10s %.18s_", k->label,
                 length > 18 ? p->typed + length - 18 : p->typed);
    else if (k->place >= 0)
        snprintf(text, sizeof text, "     %-10s %-10.10s %s", k->label, k->text,
                 bar);
    else
        snprintf(text, sizeof text, "     %-10s %.20s", k->label, k->text);
    if (is_selected)
        text[0] = '>';
    if (k->has_color)
        swatches_set(s->swatches, s->count, k->color);
    add_line(s, is_selected ? TERM_SELECTED : TERM_PLAIN, text);
}

static void add_knobs(struct panel *p, struct sheet *s, int rows)
{
    struct knob knobs[KNOBS_MAX];
    int count = list_knobs(p, knobs);

    if (p->knob_top > p->knob)
        p->knob_top = p->knob;
    if (p->knob_top < p->knob - rows + 1)
        p->knob_top = p->knob - rows + 1;
    for (int i = 0; i < rows; i++) {
        int k = p->knob_top + i;

        if (k < count)
            add_knob(p, s, &knobs[k], p->is_in_knobs && k == p->knob);
        else
            add_line(s, TERM_PLAIN, "");
    }
}

static void add_hints(const struct panel *p, struct sheet *s)
{
    if (p->is_typing) {
        add_line(s, TERM_HINT, " number, #rrggbb, r g b or 3000K");
        add_line(s, TERM_HINT, " Enter takes it   Esc leaves it");
    } else if (p->is_in_knobs) {
        add_line(s, TERM_HINT, " Left Right change  [ ] tenfold  Esc");
        add_line(s, TERM_HINT, " type a value  h HSV  u undo  ^S save");
    } else {
        add_line(s, TERM_HINT, " Enter values  n copy  x compare");
        add_line(s, TERM_HINT, " Tab page  u undo  ^S save  Esc close");
    }
}

void panel_draw(struct panel *p)
{
    struct sheet s = {.swatches = &p->canvas->swatches};
    struct knob knobs[KNOBS_MAX];
    int rows = term_size().rows - 1;
    int list_rows, knob_rows;

    if (!p->is_open || p->canvas->is_too_small)
        return;
    settle(p);
    knob_rows = list_knobs(p, knobs);
    list_rows = list_count(p) == 0 ? 0 : LIST_MIN;
    if (knob_rows > rows - OTHER_ROWS - list_rows)
        knob_rows = rows - OTHER_ROWS - list_rows;
    list_rows = p->page == KNOB_LIGHT ? 0 : rows - OTHER_ROWS - knob_rows;
    knob_rows = rows - OTHER_ROWS - list_rows;
    s.lines = xcalloc((size_t)rows, sizeof *s.lines);
    swatches_clear(s.swatches);
    add_pages(&s, p->page);
    add_list(p, &s, list_rows);
    add_title(p, &s);
    add_knobs(p, &s, knob_rows);
    add_hints(p, &s);
    canvas_show_panel(p->canvas, s.lines, s.count);
    free(s.lines);
}

/* ---- changes ---- */

/* After any change: what follows from it for picture and panel. */
static void take_change(struct panel *p)
{
    if (session_take_edit(p->work->session))
        p->work->must_restart = true;
    p->work->has_changed = true;
}

static bool may_change(struct panel *p)
{
    if (!p->work->is_live) {
        work_say(p->work, "materials change in live mode: space goes there");
        return false;
    }
    edit_of(p)->is_comparing = false;
    return true;
}

static void turn(struct panel *p, int steps)
{
    struct knob knobs[KNOBS_MAX];
    struct knob_target target = target_of(p);
    uint64_t now_ns = clock_ns();

    if (list_knobs(p, knobs) == 0 || !may_change(p))
        return;
    if (knobs[p->knob].id != p->turned_id || now_ns - p->turned_ns > TURN_NS)
        edit_break(edit_of(p));
    p->turned_id = knobs[p->knob].id;
    p->turned_ns = now_ns;
    knob_turn(edit_of(p), &target, p->turned_id, steps);
    take_change(p);
}

static void take_typed(struct panel *p)
{
    struct knob knobs[KNOBS_MAX];
    struct knob_target target = target_of(p);
    struct error err;

    if (list_knobs(p, knobs) == 0 || !may_change(p))
        return;
    edit_break(edit_of(p));
    if (knob_type(edit_of(p), &target, knobs[p->knob].id, p->typed, &err)) {
        p->is_typing = false;
        edit_break(edit_of(p));
        take_change(p);
    } else {
        work_say(p->work, err.text);
    }
}

static void travel(struct panel *p, bool is_back)
{
    if (!may_change(p))
        return;
    if (!(is_back ? edit_undo(edit_of(p)) : edit_redo(edit_of(p))))
        work_say(p->work, is_back ? "nothing to undo" : "nothing to do again");
    take_change(p);
}

static void compare(struct panel *p)
{
    bool *is_comparing = &edit_of(p)->is_comparing;

    *is_comparing = !*is_comparing;
    take_change(p);
}

/* A copy of the material; an object gets it at once. */
static void duplicate(struct panel *p)
{
    struct edit *e = edit_of(p);
    char text[128];

    if (p->page == KNOB_LIGHT || !has_target(p) || !may_change(p))
        return;
    edit_break(e);
    if (p->page == KNOB_OBJECT) {
        p->material = edit_duplicate(e, material_of_object(p, p->object));
        edit_assign(e, p->object, p->material);
        snprintf(text, sizeof text, "%.40s has its own material now: %.40s",
                 shown_name(scene_of(p)->object_names[p->object]),
                 e->names[p->material]);
    } else {
        p->material = edit_duplicate(e, p->material);
        snprintf(text, sizeof text, "%.60s: Tab goes to the objects for it",
                 e->names[p->material]);
    }
    edit_break(e);
    work_say(p->work, text);
    take_change(p);
}

/* ---- keys ---- */

void panel_open(struct panel *p)
{
    p->is_open = true;
    p->is_in_knobs = p->page == KNOB_LIGHT;
    settle(p);
}

void panel_close(struct panel *p)
{
    p->is_open = false;
    p->is_typing = false;
}

static void next_page(struct panel *p)
{
    p->page = (enum knob_page)((p->page + 1) % (KNOB_LIGHT + 1));
    p->is_in_knobs = p->page == KNOB_LIGHT;
    p->knob = p->knob_top = p->list_top = 0;
}

static void move(struct panel *p, int step)
{
    if (p->is_in_knobs)
        p->knob += step; /* list_knobs() keeps it in bounds */
    else
        for (int i = abs(step); i > 0; i--)
            *selected(p) = step_in_list(p, *selected(p), step > 0 ? 1 : -1);
}

static void begin_typing(struct panel *p, int key)
{
    p->is_typing = true;
    p->typed[0] = (char)(key == ENTER ? '\0' : key);
    p->typed[1] = '\0';
}

static void type(struct panel *p, int key)
{
    size_t length = strlen(p->typed);

    if (key == ENTER) {
        take_typed(p);
    } else if (key == ESCAPE) {
        p->is_typing = false;
    } else if ((key == BACKSPACE || key == '\b') && length > 0) {
        p->typed[length - 1] = '\0';
    } else if (key >= ' ' && key < 256 && key != BACKSPACE &&
               length + 1 < sizeof p->typed) {
        p->typed[length] = (char)key;
        p->typed[length + 1] = '\0';
    }
}

static void enter(struct panel *p)
{
    if (p->is_in_knobs)
        begin_typing(p, ENTER);
    else
        p->is_in_knobs = has_target(p);
}

static void leave(struct panel *p)
{
    if (p->is_in_knobs && p->page != KNOB_LIGHT)
        p->is_in_knobs = false;
    else
        panel_close(p);
}

static bool begins_value(int key)
{
    return key > 0 && key < 256 && strchr("0123456789.-#", key) != NULL;
}

bool panel_key(struct panel *p, int key)
{
    if (p->is_typing) {
        type(p, key);
        return true;
    }
    switch (key) {
    case INPUT_UP: move(p, -1); break;
    case INPUT_DOWN: move(p, 1); break;
    case INPUT_PAGE_UP: move(p, -10); break;
    case INPUT_PAGE_DOWN: move(p, 10); break;
    case INPUT_LEFT:
    case INPUT_RIGHT:
        if (p->is_in_knobs)
            turn(p, key == INPUT_RIGHT ? 1 : -1);
        else if (key == INPUT_RIGHT)
            enter(p);
        break;
    case '[': turn(p, -KNOB_COARSE); break;
    case ']': turn(p, KNOB_COARSE); break;
    case TAB: next_page(p); break;
    case ENTER: enter(p); break;
    case ESCAPE: leave(p); break;
    case 'u': travel(p, true); break;
    case 'U': travel(p, false); break;
    case 'x': compare(p); break;
    case 'n': duplicate(p); break;
    case 'h': p->by_hsv = !p->by_hsv; break;
    case CTRL('S'): work_save_edit(p->work); break;
    default:
        if (!p->is_in_knobs || !begins_value(key))
            return false;
        begin_typing(p, key);
        break;
    }
    return true;
}
