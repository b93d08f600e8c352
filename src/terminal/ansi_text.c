// SPDX-License-Identifier: MIT
#include "terminal/ansi_text.h"

#include "terminal/ansi_diff.h"

bool ansi_text_frame_init(struct frame *frame,
                          const struct ansi_text_style *style,
                          struct error *err)
{
    struct glyph_grid grid = glyphs_grid(style->glyphs);

    return frame_init(frame, grid.across * style->cols, grid.down * style->rows,
                      err);
}

bool ansi_text_of_frame(const struct frame *frame,
                        const struct ansi_text_style *style, char **text,
                        size_t *size_bytes, struct error *err)
{
    struct cells cells = {0};
    bool ok = cells_init(&cells, style->cols, style->rows, err);

    if (ok) {
        cells_from_frame(&cells, frame, style->palette, style->glyphs);
        ok = ansi_diff_lines(&cells, text, size_bytes, err);
    }
    cells_free(&cells);
    return ok;
}
