// SPDX-License-Identifier: MIT
#include "glim/text.h"

#include "glim/ansi.h"

bool text_of_film(struct film *film, struct develop how,
                  const struct text_style *style, char **text,
                  size_t *size_bytes, struct error *err)
{
    struct glyph_grid grid = glyphs_grid(style->glyphs);
    struct frame frame = {0};
    struct cells cells = {0};
    bool ok = frame_init(&frame, grid.across * style->cols,
                         grid.down * style->rows, err) &&
              cells_init(&cells, style->cols, style->rows, err);

    if (ok) {
        film_preview(film, NULL, how, &frame);
        cells_from_frame(&cells, &frame, style->palette, style->glyphs);
        ok = ansi_lines(&cells, text, size_bytes, err);
    }
    cells_free(&cells);
    frame_free(&frame);
    return ok;
}
