// SPDX-License-Identifier: MIT
#include "batch_text.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "terminal/ansi_text.h"
#include "terminal/tty.h"
#include "terminal/xmalloc.h"

const char *batch_text_path(const struct options *o)
{
    const char *path = o->output_path;

    return path && strcmp(path, "-") != 0 ? path : NULL;
}

/* Returns the glyphs of the text. The terminal is not asked, since the text may
 * be read on another one; it is assumed to show Unicode. Without colours the
 * locale decides between braille and ASCII. */
static enum glyphs text_glyphs(const struct options *o, enum palette palette)
{
    bool may_learn;
    bool has_unicode = palette != PALETTE_MONO || tty_is_utf8(&may_learn);

    return term_caps_glyphs(o->display.glyph, palette, has_unicode);
}

static enum palette text_palette(const struct options *o)
{
    const char *no_color = getenv("NO_COLOR");

    if (o->display.color == COLOR_AUTO && no_color && no_color[0] != '\0')
        return PALETTE_MONO;
    return term_caps_palette(o->display.color);
}

bool batch_text_write(struct view_mode *show, struct film *film, char **name,
                      struct error *err)
{
    const struct session *s = show->session;
    const struct options *o = s->options;
    struct cells_rect fit =
        cells_fit(s->engine.crop.width, s->engine.crop.height, o->text_cols,
                  o->text_rows,
                  o->display.cell_aspect > 0 ? o->display.cell_aspect : 2);
    enum palette palette = text_palette(o);
    struct ansi_text_style style = {fit.cols, fit.rows, palette,
                                    text_glyphs(o, palette)};
    const char *path = batch_text_path(o);
    struct frame frame = {0};
    size_t size_bytes;
    char *text;
    bool ok = ansi_text_frame_init(&frame, &style, err) &&
              view_mode_picture(show, film, &frame, err) &&
              ansi_text_of_frame(&frame, &style, &text, &size_bytes, err);

    frame_free(&frame);
    if (!ok)
        return false;
    *name = xstrdup(path ? path : "standard output");
    ok = path ? file_write(path, text, size_bytes, false, NULL, err)
              : file_write_stdout(text, size_bytes, err);
    free(text);
    return ok;
}
