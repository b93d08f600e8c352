// SPDX-License-Identifier: MIT
#include "studio/panel_draw.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_width.h"
#include "terminal/xmalloc.h"
#include "studio/material_params.h"

/* Rows beside list and knobs: pages, a title, two of hints. */
#define OTHER_ROWS 4
#define LIST_MIN   3

#define BAR_COLS 9

/* Of the columns that foreign names have. */
#define NAME_COLS  17
#define OTHER_COLS 13
#define TITLE_COLS 32
#define VALUE_COLS 20
#define NAME_BYTES 100

/* What there is to draw on. */
struct sheet {
    struct window_line *lines;
    int count;
    struct swatches *swatches;
};

static const struct edit *edit_of(const struct editor_panel *p)
{
    return &p->control->session->edit;
}

static const struct scene *scene_of(const struct editor_panel *p)
{
    return &p->control->session->scene;
}

const char *panel_name(const char *name)
{
    return *name != '\0' ? name : "(no name)";
}

int panel_knobs(struct editor_panel *p, struct parameter knobs[PARAMETERS_MAX])
{
    int count = selection_knobs(&p->selection, knobs);

    p->knob = p->knob >= count ? count - 1 : p->knob;
    p->knob = p->knob < 0 ? 0 : p->knob;
    return count;
}

static void add_line(struct sheet *s, enum window_look look, const char *text)
{
    struct window_line *line = &s->lines[s->count++];

    line->look = look;
    snprintf(line->text, sizeof line->text, "%s", text);
}

static void add_pages(struct sheet *s, enum parameter_page page)
{
    static const char *const titles[] = {
        [PARAMETER_MATERIAL] = "[Materials]  Objects   Light",
        [PARAMETER_OBJECT] = " Materials  [Objects]  Light",
        [PARAMETER_LIGHT] = " Materials   Objects  [Light]",
    };

    add_line(s, WINDOW_TITLE, titles[page]);
}

/* A material with its kind, or an object with its material. */
static void add_item(struct editor_panel *p, struct sheet *s, uint32_t i)
{
    const struct edit *e = edit_of(p);
    bool is_object = p->selection.page == PARAMETER_OBJECT;
    uint32_t material = is_object ? selection_material_of(&p->selection, i) : i;
    const struct mtl_source *source = &edit_shown(e)->sources[material];
    bool is_selected = i == selection_index(&p->selection);
    char text[WINDOW_LINE_BYTES], name[NAME_BYTES], other[NAME_BYTES];
    double rgb[3];

    text_width_fit(name, sizeof name,
                   panel_name(is_object ? scene_of(p)->object_names[i]
                                        : e->names[i]),
                   NAME_COLS);
    text_width_cut(other, sizeof other,
                   is_object ? panel_name(e->names[material])
                             : material_params_kind(source),
                   OTHER_COLS);
    snprintf(text, sizeof text, "%s    %s %s", is_selected ? ">" : " ", name,
             other);
    material_params_swatch(source, rgb);
    swatches_set(s->swatches, s->count, rgb);
    add_line(s, is_selected && !p->is_in_knobs ? WINDOW_SELECTED : WINDOW_PLAIN,
             text);
}

/* Part of the list, with what is selected in it. */
static void add_list(struct editor_panel *p, struct sheet *s, int rows)
{
    uint32_t count = selection_count(&p->selection);
    int number = 0, chosen = 0, shown = 0;

    for (uint32_t i = 0; i < count && i < selection_index(&p->selection); i++)
        chosen += selection_is_listed(&p->selection, i);
    if (p->list_top > chosen)
        p->list_top = chosen;
    if (p->list_top < chosen - rows + 1)
        p->list_top = chosen - rows + 1;
    for (uint32_t i = 0; i < count && shown < rows; i++) {
        if (!selection_is_listed(&p->selection, i) || number++ < p->list_top)
            continue;
        add_item(p, s, i);
        shown++;
    }
    for (; shown < rows; shown++)
        add_line(s, WINDOW_PLAIN, "");
}

static void add_title(struct editor_panel *p, struct sheet *s)
{
    const struct edit *e = edit_of(p);
    char text[WINDOW_LINE_BYTES], name[NAME_BYTES];

    if (e->is_comparing)
        snprintf(text, sizeof text, " as saved: x goes back");
    else if (p->selection.page == PARAMETER_LIGHT)
        snprintf(text, sizeof text, " Sky and picture%s",
                 edit_has_unsaved_view(e) ? " *" : "");
    else if (!selection_has_one(&p->selection))
        snprintf(text, sizeof text, " nothing to edit");
    else {
        bool is_object = p->selection.page == PARAMETER_OBJECT;

        text_width_cut(name, sizeof name,
                       is_object
                           ? panel_name(
                                 scene_of(p)->object_names[p->selection.object])
                           : e->names[p->selection.material],
                       TITLE_COLS);
        snprintf(text, sizeof text, " %s%s", name,
                 is_object || edit_is_saved(e, p->selection.material) ? ""
                                                                      : " *");
    }
    add_line(s, WINDOW_TITLE, text);
}

static void format_bar(char bar[BAR_COLS + 1], double place)
{
    int filled = (int)(place * BAR_COLS + 0.5);

    for (int i = 0; i < BAR_COLS; i++)
        bar[i] = place < 0 ? ' ' : i < filled ? '=' : '.';
    bar[BAR_COLS] = '\0';
}

static void add_knob(struct editor_panel *p, struct sheet *s,
                     const struct parameter *k, bool is_selected)
{
    char bar[BAR_COLS + 1];
    char text[WINDOW_LINE_BYTES], value[NAME_BYTES];
    size_t length = strlen(p->typed);

    format_bar(bar, k->place);
    text_width_cut(value, sizeof value, k->text, VALUE_COLS);
    if (is_selected && p->is_typing)
        snprintf(text, sizeof text, "     %-10s %.18s_", k->label,
                 length > 18 ? p->typed + length - 18 : p->typed);
    else if (k->place >= 0)
        snprintf(text, sizeof text, "     %-10s %-10.10s %s", k->label, k->text,
                 bar);
    else
        snprintf(text, sizeof text, "     %-10s %s", k->label, value);
    if (is_selected)
        text[0] = '>';
    if (k->has_color)
        swatches_set(s->swatches, s->count, k->color);
    add_line(s, is_selected ? WINDOW_SELECTED : WINDOW_PLAIN, text);
}

static void add_knobs(struct editor_panel *p, struct sheet *s, int rows)
{
    struct parameter knobs[PARAMETERS_MAX];
    int count = panel_knobs(p, knobs);

    if (p->knob_top > p->knob)
        p->knob_top = p->knob;
    if (p->knob_top < p->knob - rows + 1)
        p->knob_top = p->knob - rows + 1;
    for (int i = 0; i < rows; i++) {
        int k = p->knob_top + i;

        if (k < count)
            add_knob(p, s, &knobs[k], p->is_in_knobs && k == p->knob);
        else
            add_line(s, WINDOW_PLAIN, "");
    }
}

static void add_hints(const struct editor_panel *p, struct sheet *s)
{
    char text[64];

    if (!p->control->is_live) {
        add_line(s, WINDOW_TITLE, " Normal mode: only to look at");
        snprintf(text, sizeof text, " %s goes to live mode to edit",
                 render_control_key(p->control, ACTION_MODE).text);
        add_line(s, WINDOW_TITLE, text);
    } else if (p->is_typing) {
        add_line(s, WINDOW_HINT, " number, #rrggbb, r g b or 3000K");
        add_line(s, WINDOW_HINT, " Enter takes it   Esc leaves it");
    } else if (p->is_in_knobs) {
        add_line(s, WINDOW_HINT, " Left Right change  [ ] tenfold  Esc");
        add_line(s, WINDOW_HINT, " type a value  h HSV  u undo  ^S save");
    } else {
        add_line(s, WINDOW_HINT, " Enter values  n copy  x compare");
        add_line(s, WINDOW_HINT, " Tab page  u undo  ^S save  Esc close");
    }
}

void panel_draw(struct editor_panel *p)
{
    struct sheet s = {.swatches = &p->screen->swatches};
    struct parameter knobs[PARAMETERS_MAX];
    int rows = term_size().rows - 1;
    int list_rows, knob_rows;

    if (!p->is_open || p->screen->is_too_small)
        return;
    selection_settle(&p->selection);
    knob_rows = panel_knobs(p, knobs);
    list_rows = selection_count(&p->selection) == 0 ? 0 : LIST_MIN;
    if (knob_rows > rows - OTHER_ROWS - list_rows)
        knob_rows = rows - OTHER_ROWS - list_rows;
    list_rows = p->selection.page == PARAMETER_LIGHT
                    ? 0
                    : rows - OTHER_ROWS - knob_rows;
    knob_rows = rows - OTHER_ROWS - list_rows;
    s.lines = xcalloc((size_t)rows, sizeof *s.lines);
    swatches_clear(s.swatches);
    p->list_rows = list_rows;
    p->knob_rows = knob_rows;
    add_pages(&s, p->selection.page);
    add_list(p, &s, list_rows);
    add_title(p, &s);
    add_knobs(p, &s, knob_rows);
    add_hints(p, &s);
    screen_show_panel(p->screen, s.lines, s.count);
    free(s.lines);
}
