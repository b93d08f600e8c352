// SPDX-License-Identifier: MIT
#include "studio/panel_draw.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/min_max.h"
#include "base/print.h"
#include "studio/keys_bar.h"
#include "studio/material_parameters.h"
#include "terminal/gauge.h"
#include "kernels/tone.h"

/* Rows besides list and parameters: pages, a title, hints. */
#define HINT_ROWS  2
#define OTHER_ROWS (2 + HINT_ROWS)

/* Rows of a long list, at least, and beside a ball. */
#define LIST_MIN       3
#define LIST_WITH_BALL 5

/* Columns for names that come from files. */
#define NAME_COLS   17
#define OTHER_COLS  13
#define TITLE_COLS  32
#define VALUE_COLS  20
#define NUMBER_COLS 9
#define NAME_BYTES  100

/* Column of the colour at the left of a line, with an edge at each side, and of
 * the text. */
#define SWATCH_COL  2
#define SWATCH_COLS 2
#define TEXT_COL    1

/* Right and left eighth of a cell: edges beside a swatch. */
#define EDGE_LEFT  0x2595u
#define EDGE_RIGHT 0x258fu

/* Texels across a quarter of a texture that its mean is taken of. */
#define TEXELS 8u

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
    int count = 0;

    if (selection_has_one(&p->selection))
        count = parameters_list(&p->selection, list);
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

/* Paints cells at the left of the last line, whose role is given. Their edges
 * are visible where the cells have the colour of the panel. */
static void paint_swatch(const struct sheet *s, enum text_role role,
                         const struct cell cells[SWATCH_COLS])
{
    const struct term_caps *d = &s->screen->display;
    uint32_t fg = theme_style(d->theme, d->palette, ROLE_FRAME).fg;
    uint32_t bg = theme_style(d->theme, d->palette, role).bg;
    struct cell all[SWATCH_COLS + 2] = {{fg, bg,
                                         d->has_unicode ? EDGE_LEFT : '['},
                                        cells[0],
                                        cells[1],
                                        {fg, bg,
                                         d->has_unicode ? EDGE_RIGHT : ']'}};

    windows_paint(WINDOW_PANEL, s->row - 1, SWATCH_COL, all, SWATCH_COLS + 2);
}

/* Shows a linear colour at the left of the last line. */
static void add_swatch(const struct sheet *s, enum text_role role,
                       const double rgb[3])
{
    struct cell cell = cells_of_color(srgb_of(rgb), s->screen->display.palette);

    paint_swatch(s, role, (const struct cell[]){cell, cell});
}

static void add_pages(struct sheet *s, enum selection_page page)
{
    static const char *const titles[] = {
        [PAGE_MATERIALS] = " Materials ",
        [PAGE_OBJECTS] = " Objects ",
        [PAGE_LIGHT] = " Light ",
    };
    int col = TEXT_COL;

    add_line(s, ROLE_FAINT, "");
    for (int i = 0; i <= PAGE_LIGHT; i++) {
        int cols = (int)strlen(titles[i]);

        windows_text(WINDOW_PANEL, 0, col, cols,
                     i == (int)page ? ROLE_SELECTED : ROLE_FAINT, titles[i]);
        col += cols;
    }
    windows_text(WINDOW_PANEL, 0, s->screen->panel_cols - 4, 3, ROLE_KEY,
                 "Tab");
}

/* Scrolls, so that the selected row of `count` is shown. *top is the first row
 * shown; there are no empty rows behind the last one. */
static void scroll(int *top, int selected, int rows, int count)
{
    *top = int_min(*top, int_min(selected, count - rows));
    *top = int_max(*top, selected - rows + 1);
    *top = int_max(*top, 0);
}

/* Adds a material with its kind, or an object with its material. */
static void add_item(struct editor_panel *p, struct sheet *s, uint32_t i)
{
    const struct selection *sel = &p->selection;
    bool is_object = sel->page == PAGE_OBJECTS;
    bool is_selected = i == sel->index[sel->page];
    uint32_t material = is_object ? selection_material_of(sel, i) : i;
    const struct material_values *source =
        &edit_shown(sel->edit)->sources[material];
    char text[LINE_BYTES], name[NAME_BYTES], other[NAME_BYTES];
    enum text_role role = !is_selected          ? ROLE_TEXT
                          : p->is_in_parameters ? ROLE_PICKED
                                                : ROLE_SELECTED;
    const char *kind;
    double rgb[3];

    text_width_fit(name, sizeof name, selection_name(sel, sel->page, i),
                   NAME_COLS);
    kind = material_parameters_summary(source, sel->world, rgb);
    text_width_cut(other, sizeof other,
                   is_object ? selection_name(sel, PAGE_MATERIALS, material)
                             : kind,
                   OTHER_COLS);
    snprintf(text, sizeof text, "%s    %s %s", is_selected ? ">" : " ", name,
             other);
    add_line(s, role, text);
    add_swatch(s, role, rgb);
}

static void add_list(struct editor_panel *p, struct sheet *s)
{
    const struct selection *sel = &p->selection;

    scroll(&p->list_top, sel->row, p->list_rows, sel->listed_count);
    for (int row = 0; row < p->list_rows; row++)
        add_item(p, s, sel->listed[p->list_top + row]);
    for (int row = 0; row < p->list_rows && p->list_rows < sel->listed_count;
         row++) {
        int at = row * sel->listed_count / p->list_rows;
        bool is_marked = at >= p->list_top && at < p->list_top + p->list_rows;

        windows_text(WINDOW_PANEL, s->row - p->list_rows + row,
                     s->screen->panel_cols - 1, 1,
                     is_marked ? ROLE_SELECTED : ROLE_TEXT, "");
    }
}

/* Formats what the title says after the name: what differs from the files. */
static const char *title_note(const struct selection *sel)
{
    const struct edit *e = sel->edit;
    bool is_saved = sel->page == PAGE_LIGHT ? !edit_has_unsaved_view(e)
                    : sel->page == PAGE_MATERIALS
                        ? edit_is_saved(e, sel->index[sel->page])
                        : true;

    return is_saved ? "" : " *";
}

/* Formats the name of what is edited: an object with its material. */
static void format_title(char text[LINE_BYTES], const struct selection *sel)
{
    uint32_t i = sel->index[sel->page];
    char object[NAME_BYTES], material[NAME_BYTES];

    if (sel->edit->is_comparing) {
        snprintf(text, LINE_BYTES, " as saved: \\ goes back ");
    } else if (sel->page == PAGE_LIGHT) {
        snprintf(text, LINE_BYTES, " Sky and picture%s ", title_note(sel));
    } else if (!selection_has_one(sel)) {
        snprintf(text, LINE_BYTES, " nothing to edit ");
    } else if (sel->page == PAGE_OBJECTS) {
        text_width_cut(object, sizeof object,
                       selection_name(sel, PAGE_OBJECTS, i), NAME_COLS);
        text_width_cut(material, sizeof material,
                       selection_name(sel, PAGE_MATERIALS,
                                      selection_material_of(sel, i)),
                       OTHER_COLS);
        snprintf(text, LINE_BYTES, " %s / %s ", object, material);
    } else {
        text_width_cut(material, sizeof material,
                       selection_name(sel, PAGE_MATERIALS, i), TITLE_COLS);
        snprintf(text, LINE_BYTES, " %s%s ", material, title_note(sel));
    }
}

static void add_title(const struct editor_panel *p, struct sheet *s)
{
    int room = s->screen->panel_cols - TEXT_COL;
    char text[LINE_BYTES];
    int cols;

    format_title(text, &p->selection);
    cols = text_width_of(text);
    windows_rule(WINDOW_PANEL, s->row, TEXT_COL, room);
    windows_text(WINDOW_PANEL, s->row, TEXT_COL + 1,
                 cols < room - 1 ? cols : room - 1, ROLE_TITLE, text);
    if (p->selection.page != PAGE_LIGHT && p->selection.listed_count > 0) {
        snprintf(text, sizeof text, " %d of %d ", p->selection.row + 1,
                 p->selection.listed_count);
        if (cols + text_width_of(text) + 2 < room)
            windows_text(WINDOW_PANEL, s->row,
                         TEXT_COL + room - text_width_of(text),
                         text_width_of(text), ROLE_FAINT, text);
    }
    s->row++;
}

/* Returns the mean colour of a quarter of a texture: (0, 0) is the upper left
 * one. Few texels are enough. */
static struct rgb quarter_of(const struct host_world *w,
                             const struct texture *t, int right, int down)
{
    uint32_t sums[3] = {0, 0, 0}, count = TEXELS * TEXELS;

    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = t->width * (2 * (i % TEXELS) + 1) / (4 * TEXELS) +
                     (uint32_t)right * t->width / 2;
        uint32_t y = t->height * (2 * (i / TEXELS) + 1) / (4 * TEXELS) +
                     (uint32_t)down * t->height / 2;
        uint32_t texel = w->texels[t->first + y * t->width + x];

        for (int c = 0; c < 3; c++)
            sums[c] += texel >> 8 * c & 255;
    }
    return (struct rgb){(int)(sums[0] / count), (int)(sums[1] / count),
                        (int)(sums[2] / count)};
}

/* Shows a texture as four dots at the left of the last line. */
static void add_texture(const struct editor_panel *p, const struct sheet *s,
                        enum text_role role, uint32_t texture)
{
    const struct host_world *w = &p->control->session->engine.world;
    const struct term_caps *d = &s->screen->display;
    const struct texture *t = texture < w->texture_count
                                  ? &w->textures[texture]
                                  : NULL; /* not rendered yet */
    struct cell cells[SWATCH_COLS];

    if (t == NULL || t->width == 0 || t->height == 0)
        return;
    for (int i = 0; i < SWATCH_COLS; i++) {
        struct cell upper = cells_of_color(quarter_of(w, t, i, 0), d->palette);
        struct cell lower = cells_of_color(quarter_of(w, t, i, 1), d->palette);

        cells[i] = upper;
        if (d->has_unicode && d->palette != PALETTE_MONO)
            cells[i] = (struct cell){upper.bg, lower.bg, CELL_UPPER};
    }
    paint_swatch(s, role, cells);
}

/* Shows where a number is on its scale. The slider of a channel has the colours
 * that it can make. */
static void add_slider(const struct editor_panel *p, const struct sheet *s,
                       const struct parameter *v)
{
    const struct term_caps *d = &s->screen->display;
    struct cell cells[PANEL_SLIDER_COLS];
    double rgb[3];
    int room = s->screen->panel_cols - PANEL_SLIDER_COL;
    int cols = room < PANEL_SLIDER_COLS ? room : PANEL_SLIDER_COLS;

    if (cols <= 0)
        return;
    if (d->palette != PALETTE_MONO &&
        parameter_color_at(&p->selection, v->id, 0, rgb)) {
        for (int i = 0; i < cols; i++) {
            parameter_color_at(&p->selection, v->id, gauge_fraction(i, cols),
                               rgb);
            cells[i] = cells_of_color(srgb_of(rgb), d->palette);
        }
        gauge_handle(cells, cols, v->fraction, d->palette, d->has_unicode);
    } else {
        gauge_cells(cells, cols, v->fraction,
                    theme_style(d->theme, d->palette, ROLE_GAUGE),
                    d->has_unicode);
    }
    windows_paint(WINDOW_PANEL, s->row - 1, PANEL_SLIDER_COL, cells, cols);
}

static void add_parameter(struct editor_panel *p, struct sheet *s,
                          const struct parameter *v, bool is_selected)
{
    char text[LINE_BYTES], value[NAME_BYTES];
    size_t length = strlen(p->typed);
    bool is_typed = is_selected && p->is_typing;
    enum text_role role = is_selected    ? ROLE_SELECTED
                          : v->heads > 0 ? ROLE_TITLE
                                         : ROLE_TEXT;
    char label[NAME_BYTES];

    snprintf(label, sizeof label, v->heads > 0 ? "%.20s %u" : "%.20s", v->label,
             v->heads);
    text_width_cut(value, sizeof value, v->text,
                   v->fraction >= 0 ? NUMBER_COLS : VALUE_COLS);
    if (is_typed)
        snprintf(text, sizeof text, "     %-10s %.18s_", label,
                 length > 18 ? p->typed + length - 18 : p->typed);
    else
        snprintf(text, sizeof text, "     %-10s %s", label, value);
    if (is_selected)
        text[0] = '>';
    add_line(s, role, text);
    if (v->has_color)
        add_swatch(s, role, v->color);
    if (v->texture != NO_INDEX)
        add_texture(p, s, role, v->texture);
    if (v->fraction >= 0 && !is_typed)
        add_slider(p, s, v);
}

static void add_parameters(struct editor_panel *p, struct sheet *s)
{
    struct parameter list[PARAMETERS_MAX];
    int count = panel_parameters(p, list);

    scroll(&p->parameter_top, p->parameter, p->parameter_rows, count);
    for (int i = 0; i < p->parameter_rows; i++) {
        int row = p->parameter_top + i;

        add_parameter(p, s, &list[row],
                      p->is_in_parameters && row == p->parameter);
    }
}

/* Shows the ball, as far as it is rendered, in the middle of the panel. */
static void add_ball(struct editor_panel *p, struct sheet *s)
{
    const struct term_caps *d = &s->screen->display;
    int col = TEXT_COL + (s->screen->panel_cols - TEXT_COL - BALL_COLS) / 2;

    if (p->ball.spp > 0) {
        material_ball_paint(&p->ball, &p->ball_frame);
        cells_from_frame(&p->ball_cells, &p->ball_frame, d->palette,
                         GLYPHS_HALF);
        for (int y = 0; y < BALL_ROWS; y++)
            windows_paint(WINDOW_PANEL, s->row + y, col,
                          p->ball_cells.cell + (size_t)y * BALL_COLS,
                          BALL_COLS);
    }
    s->row += BALL_ROWS;
}

/* Lists the images that can be chosen, by their paths from the scene's. */
static void add_images(struct editor_panel *p, struct sheet *s, int rows)
{
    const char *scene = p->control->session->engine.scene.path;
    char text[LINE_BYTES];

    snprintf(text, sizeof text, " %s of %.60s", mtl_maps[p->image_map].keys[0],
             selection_name(&p->selection, PAGE_MATERIALS,
                            selection_material(&p->selection)));
    add_line(s, ROLE_TITLE, text);
    scroll(&p->image_top, p->image, rows, p->images.count);
    for (int i = p->image_top; i < p->images.count && i < p->image_top + rows;
         i++) {
        const char *name = p->images.paths[i] + (path_name(scene) - scene);

        snprintf(text, sizeof text, "%s %.200s", i == p->image ? ">" : " ",
                 name);
        add_line(s, i == p->image ? ROLE_SELECTED : ROLE_TEXT, text);
    }
}

/* Keys of the panel's states, the most useful first. */
static const struct key_hint hints_images[] = {{"Enter", "takes it"},
                                               {"Esc", "back"},
                                               {NULL, NULL}};
static const struct key_hint hints_map[] = {
    {"Enter", "images"}, {"Left Right", "change"}, {"Esc", "back"},
    {"u", "undo"},       {"^S", "save"},           {NULL, NULL}};
static const struct key_hint hints_parameters[] = {
    {"Left Right", "change"}, {"( )", "tenfold"}, {"Esc", "back"},
    {"0-9 #", "type"},        {"h", "HSV"},       {"u", "undo"},
    {"^S", "save"},           {NULL, NULL}};
static const struct key_hint hints_color[] = {
    {"Enter", "types it"}, {"h", "HSV"},   {"Esc", "back"},
    {"u", "undo"},         {"^S", "save"}, {NULL, NULL}};
static const struct key_hint hints_light[] = {{"Left Right", "change"},
                                              {"Ins Del", "new, remove"},
                                              {"Esc", "close"},
                                              {"0-9 #", "type"},
                                              {"h", "HSV"},
                                              {"u", "undo"},
                                              {"^S", "save"},
                                              {NULL, NULL}};
static const struct key_hint hints_list[] = {
    {"Enter", "values"}, {"/", "find"},   {"\\", "compare"},
    {"Esc", "close"},    {"u", "undo"},   {"^S", "save"},
    {"Ins", "copy"},     {"Tab", "page"}, {NULL, NULL}};

static const struct key_hint *hints_of(struct editor_panel *p)
{
    struct parameter list[PARAMETERS_MAX];

    if (p->images.count > 0)
        return hints_images;
    if (!p->is_in_parameters)
        return hints_list;
    if (panel_parameters(p, list) == 0)
        return hints_parameters;
    if (p->selection.page == PAGE_LIGHT && list[p->parameter].has_steps)
        return hints_light;
    return list[p->parameter].map != MTL_MAPS ? hints_map
           : !list[p->parameter].has_steps    ? hints_color
                                              : hints_parameters;
}

/* Adds keys while a text is typed, and which text is taken. */
static void add_typing_hints(struct editor_panel *p, struct sheet *s)
{
    static const struct key_hint value[] = {{"Enter", "takes it"},
                                            {"Esc", "leaves it"},
                                            {NULL, NULL}};
    static const struct key_hint found[] = {{"Enter", "next"},
                                            {"Esc", "ends"},
                                            {NULL, NULL}};
    struct parameter list[PARAMETERS_MAX];
    int room = s->screen->panel_cols - TEXT_COL - 1;
    char text[LINE_BYTES];

    if (p->is_finding)
        snprintf(text, sizeof text, "find: %.24s_", p->typed);
    else
        snprintf(text, sizeof text, "%s",
                 panel_parameters(p, list) > 0 ? list[p->parameter].takes : "");
    windows_text(WINDOW_PANEL, s->row++, TEXT_COL + 1, room,
                 p->is_finding ? ROLE_TITLE : ROLE_FAINT, text);
    key_hints_draw(WINDOW_PANEL, s->row++, TEXT_COL + 1, room,
                   p->is_finding ? found : value);
}

static void add_hints(struct editor_panel *p, struct sheet *s)
{
    struct keymap_name mode = live_render_key(p->control, ACTION_MODE);
    const struct key_hint to_live[] = {{mode.text, "live mode, to edit"},
                                       {"Esc", "close"},
                                       {NULL, NULL}};
    const struct key_hint *hints = p->control->is_live ? hints_of(p) : to_live;

    if (p->is_typing || p->is_finding) {
        add_typing_hints(p, s);
        return;
    }
    for (int row = 0; row < HINT_ROWS; row++)
        hints = key_hints_draw(WINDOW_PANEL, s->row++, TEXT_COL + 1,
                               s->screen->panel_cols - TEXT_COL - 1, hints);
}

/* Half blocks and colours make the ball. */
static bool has_room_for_ball(const struct editor_panel *p, int rows)
{
    const struct term_caps *d = &p->screen->display;

    return d->has_unicode && d->palette != PALETTE_MONO &&
           p->selection.listed_count > 0 &&
           rows >=
               BALL_ROWS + int_min(p->selection.listed_count, LIST_WITH_BALL) &&
           p->screen->panel_cols >= TEXT_COL + BALL_COLS;
}

/* Shares the rows: the values have those they need, the ball what it needs of
 * the rest, and the list what is left. */
static void share_rows(struct editor_panel *p, int rows)
{
    struct parameter list[PARAMETERS_MAX];
    int listed = p->selection.listed_count;

    p->parameter_rows =
        int_min(panel_parameters(p, list), rows - int_min(listed, LIST_MIN));
    rows -= p->parameter_rows;
    p->shows_ball = has_room_for_ball(p, rows);
    p->list_rows = int_min(listed, rows - (p->shows_ball ? BALL_ROWS : 0));
}

void panel_draw(struct editor_panel *p)
{
    struct sheet s = {p->screen, 0};
    int rows = term_size().rows - 1;

    if (!p->is_open || p->screen->is_too_small)
        return;
    selection_settle(&p->selection);
    share_rows(p, rows - OTHER_ROWS);
    screen_begin_panel(p->screen);
    if (p->images.count > 0) {
        p->shows_ball = false;
        add_images(p, &s, rows - HINT_ROWS - 1);
    } else {
        add_pages(&s, p->selection.page);
        add_list(p, &s);
        add_title(p, &s);
        add_parameters(p, &s);
    }
    if (p->shows_ball)
        add_ball(p, &s);
    s.row = rows - HINT_ROWS;
    add_hints(p, &s);
}
