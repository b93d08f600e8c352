// SPDX-License-Identifier: MIT
#include "studio/panel_draw.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_width.h"
#include "terminal/xmalloc.h"
#include "studio/material_parameters.h"

/* Rows besides list and parameters: pages, a title, two hints. */
#define OTHER_ROWS 4
#define LIST_MIN   3

#define BAR_COLS 9

/* Columns for names that come from files. */
#define NAME_COLS  17
#define OTHER_COLS 13
#define TITLE_COLS 32
#define VALUE_COLS 20
#define NAME_BYTES 100

/* Lines of the panel, with a colour swatch at the left of each. */
struct sheet {
    struct window_line *lines;
    int count;
    struct swatches *swatches;
};

int panel_parameters(struct editor_panel *p,
                     struct parameter list[PARAMETERS_MAX])
{
    struct parameter_target target = selection_target(&p->selection);
    int count = 0;

    if (selection_has_one(&p->selection))
        count = parameters_list(&target, list);
    p->parameter = p->parameter >= count ? count - 1 : p->parameter;
    p->parameter = p->parameter < 0 ? 0 : p->parameter;
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

/* Scrolls, so that the selected row is shown. *top is the first row shown. */
static void scroll(int *top, int selected, int rows)
{
    if (*top > selected)
        *top = selected;
    if (*top < selected - rows + 1)
        *top = selected - rows + 1;
}

/* Adds a material with its kind, or an object with its material. */
static void add_item(struct editor_panel *p, struct sheet *s, uint32_t i)
{
    const struct selection *sel = &p->selection;
    bool is_object = sel->page == PARAMETER_OBJECT;
    bool is_selected = i == sel->index[sel->page];
    uint32_t material = is_object ? selection_material_of(sel, i) : i;
    const struct mtl_source *source =
        &edit_shown(&sel->session->edit)->sources[material];
    char text[WINDOW_LINE_BYTES], name[NAME_BYTES], other[NAME_BYTES];
    const char *kind;
    double rgb[3];

    text_width_fit(name, sizeof name, selection_name(sel, sel->page, i),
                   NAME_COLS);
    kind = material_parameters_summary(source, rgb);
    text_width_cut(other, sizeof other,
                   is_object ? selection_name(sel, PARAMETER_MATERIAL, material)
                             : kind,
                   OTHER_COLS);
    snprintf(text, sizeof text, "%s    %s %s", is_selected ? ">" : " ", name,
             other);
    swatches_set(s->swatches, s->count, rgb);
    add_line(s,
             is_selected && !p->is_in_parameters ? WINDOW_SELECTED
                                                 : WINDOW_PLAIN,
             text);
}

static void add_list(struct editor_panel *p, struct sheet *s, int rows)
{
    const struct selection *sel = &p->selection;

    scroll(&p->list_top, sel->row, rows);
    for (int row = p->list_top; row < p->list_top + rows; row++) {
        if (row < sel->listed_count)
            add_item(p, s, sel->listed[row]);
        else
            add_line(s, WINDOW_PLAIN, "");
    }
}

static void add_title(const struct editor_panel *p, struct sheet *s)
{
    const struct selection *sel = &p->selection;
    const struct edit *e = &sel->session->edit;
    uint32_t i = sel->index[sel->page];
    char text[WINDOW_LINE_BYTES], name[NAME_BYTES];

    if (e->is_comparing) {
        snprintf(text, sizeof text, " as saved: x goes back");
    } else if (sel->page == PARAMETER_LIGHT) {
        snprintf(text, sizeof text, " Sky and picture%s",
                 edit_has_unsaved_view(e) ? " *" : "");
    } else if (!selection_has_one(sel)) {
        snprintf(text, sizeof text, " nothing to edit");
    } else {
        text_width_cut(name, sizeof name, selection_name(sel, sel->page, i),
                       TITLE_COLS);
        snprintf(text, sizeof text, " %s%s", name,
                 sel->page == PARAMETER_MATERIAL && !edit_is_saved(e, i) ? " *"
                                                                         : "");
    }
    add_line(s, WINDOW_TITLE, text);
}

static void format_bar(char bar[BAR_COLS + 1], double fraction)
{
    int filled = (int)(fraction * BAR_COLS + 0.5);

    for (int i = 0; i < BAR_COLS; i++)
        bar[i] = fraction < 0 ? ' ' : i < filled ? '=' : '.';
    bar[BAR_COLS] = '\0';
}

static void add_parameter(struct editor_panel *p, struct sheet *s,
                          const struct parameter *v, bool is_selected)
{
    char bar[BAR_COLS + 1];
    char text[WINDOW_LINE_BYTES], value[NAME_BYTES];
    size_t length = strlen(p->typed);

    format_bar(bar, v->fraction);
    text_width_cut(value, sizeof value, v->text, VALUE_COLS);
    if (is_selected && p->is_typing)
        snprintf(text, sizeof text, "     %-10s %.18s_", v->label,
                 length > 18 ? p->typed + length - 18 : p->typed);
    else if (v->fraction >= 0)
        snprintf(text, sizeof text, "     %-10s %-10.10s %s", v->label, v->text,
                 bar);
    else
        snprintf(text, sizeof text, "     %-10s %s", v->label, value);
    if (is_selected)
        text[0] = '>';
    if (v->has_color)
        swatches_set(s->swatches, s->count, v->color);
    add_line(s, is_selected ? WINDOW_SELECTED : WINDOW_PLAIN, text);
}

static void add_parameters(struct editor_panel *p, struct sheet *s, int rows)
{
    struct parameter list[PARAMETERS_MAX];
    int count = panel_parameters(p, list);

    scroll(&p->parameter_top, p->parameter, rows);
    for (int row = p->parameter_top; row < p->parameter_top + rows; row++) {
        if (row < count)
            add_parameter(p, s, &list[row],
                          p->is_in_parameters && row == p->parameter);
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
    } else if (p->is_in_parameters) {
        add_line(s, WINDOW_HINT,
                 p->selection.page == PARAMETER_LIGHT
                     ? " Left Right change  n new  N remove"
                     : " Left Right change  [ ] tenfold  Esc");
        add_line(s, WINDOW_HINT, " type a value  h HSV  u undo  ^S save");
    } else {
        add_line(s, WINDOW_HINT, " Enter values  n copy  x compare");
        add_line(s, WINDOW_HINT, " Tab page  u undo  ^S save  Esc close");
    }
}

void panel_draw(struct editor_panel *p)
{
    struct sheet s = {.swatches = &p->screen->swatches};
    struct parameter list[PARAMETERS_MAX];
    int rows = term_size().rows - 1 - OTHER_ROWS;

    if (!p->is_open || p->screen->is_too_small)
        return;
    selection_settle(&p->selection);
    p->parameter_rows = panel_parameters(p, list);
    if (p->parameter_rows > rows - LIST_MIN)
        p->parameter_rows = rows - LIST_MIN;
    if (p->selection.page == PARAMETER_LIGHT)
        p->parameter_rows = rows;
    p->list_rows = rows - p->parameter_rows;
    s.lines = xcalloc((size_t)rows + OTHER_ROWS, sizeof *s.lines);
    swatches_clear(s.swatches);
    add_pages(&s, p->selection.page);
    add_list(p, &s, p->list_rows);
    add_title(p, &s);
    add_parameters(p, &s, p->parameter_rows);
    add_hints(p, &s);
    screen_show_panel(p->screen, s.lines, s.count);
    free(s.lines);
}
