// SPDX-License-Identifier: MIT
#include "studio/panel_draw.h"

#include <stdio.h>
#include <string.h>

#include "base/text_width.h"
#include "studio/material_parameters.h"
#include "kernels/tone.h"

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

/* Column of the colour at the left of a line, and of the text. */
#define SWATCH_COL  2
#define SWATCH_COLS 2
#define TEXT_COL    1

/* Bytes of a line: its columns in characters of several bytes. */
#define LINE_BYTES 256

/* The panel, filled from the top. */
struct sheet {
    const struct screen *screen;
    int row;
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

static void add_line(struct sheet *s, enum text_role role, const char *text)
{
    windows_text(WINDOW_PANEL, s->row++, TEXT_COL,
                 s->screen->panel_cols - TEXT_COL, role, text);
}

static struct rgb srgb_of(const double linear[3])
{
    return (struct rgb){(int)srgb_byte((float)linear[0]),
                        (int)srgb_byte((float)linear[1]),
                        (int)srgb_byte((float)linear[2])};
}

/* Shows a linear colour at the left of the last line. */
static void add_swatch(const struct sheet *s, const double rgb[3])
{
    struct cell cell = cells_of_color(srgb_of(rgb), s->screen->display.palette);
    struct cell cells[SWATCH_COLS] = {cell, cell};

    windows_paint(WINDOW_PANEL, s->row - 1, SWATCH_COL, cells, SWATCH_COLS);
}

static void add_pages(struct sheet *s, enum parameter_page page)
{
    static const char *const titles[] = {
        [PARAMETER_MATERIAL] = "[Materials]  Objects   Light",
        [PARAMETER_OBJECT] = " Materials  [Objects]  Light",
        [PARAMETER_LIGHT] = " Materials   Objects  [Light]",
    };

    add_line(s, ROLE_TITLE, titles[page]);
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
    char text[LINE_BYTES], name[NAME_BYTES], other[NAME_BYTES];
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
    add_line(s,
             !is_selected          ? ROLE_TEXT
             : p->is_in_parameters ? ROLE_PICKED
                                   : ROLE_SELECTED,
             text);
    add_swatch(s, rgb);
}

static void add_list(struct editor_panel *p, struct sheet *s, int rows)
{
    const struct selection *sel = &p->selection;

    scroll(&p->list_top, sel->row, rows);
    for (int row = p->list_top; row < p->list_top + rows; row++) {
        if (row < sel->listed_count)
            add_item(p, s, sel->listed[row]);
        else
            add_line(s, ROLE_TEXT, "");
    }
}

static void add_title(const struct editor_panel *p, struct sheet *s)
{
    const struct selection *sel = &p->selection;
    const struct edit *e = &sel->session->edit;
    uint32_t i = sel->index[sel->page];
    char text[LINE_BYTES], name[NAME_BYTES];

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
    add_line(s, ROLE_TITLE, text);
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
    char text[LINE_BYTES], value[NAME_BYTES];
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
    add_line(s, is_selected ? ROLE_SELECTED : ROLE_TEXT, text);
    if (v->has_color)
        add_swatch(s, v->color);
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
            add_line(s, ROLE_TEXT, "");
    }
}

static void add_hints(const struct editor_panel *p, struct sheet *s)
{
    char text[64];

    if (!p->control->is_live) {
        add_line(s, ROLE_TITLE, " Normal mode: only to look at");
        snprintf(text, sizeof text, " %s goes to live mode to edit",
                 render_control_key(p->control, ACTION_MODE).text);
        add_line(s, ROLE_TITLE, text);
    } else if (p->is_typing) {
        add_line(s, ROLE_FAINT, " number, #rrggbb, r g b or 3000K");
        add_line(s, ROLE_FAINT, " Enter takes it   Esc leaves it");
    } else if (p->is_in_parameters) {
        add_line(s, ROLE_FAINT,
                 p->selection.page == PARAMETER_LIGHT
                     ? " Left Right change  n new  N remove"
                     : " Left Right change  [ ] tenfold  Esc");
        add_line(s, ROLE_FAINT, " type a value  h HSV  u undo  ^S save");
    } else {
        add_line(s, ROLE_FAINT, " Enter values  n copy  x compare");
        add_line(s, ROLE_FAINT, " Tab page  u undo  ^S save  Esc close");
    }
}

void panel_draw(struct editor_panel *p)
{
    struct sheet s = {p->screen, 0};
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
    screen_begin_panel(p->screen);
    add_pages(&s, p->selection.page);
    add_list(p, &s, p->list_rows);
    add_title(p, &s);
    add_parameters(p, &s, p->parameter_rows);
    add_hints(p, &s);
}
