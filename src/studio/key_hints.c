// SPDX-License-Identifier: MIT
#include "studio/key_hints.h"

#include <stdbool.h>

#include "base/text_width.h"

#define GAP 2

const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints)
{
    int end = col + cols;

    for (; hints->does; hints++) {
        int key_cols = text_width_of(hints->key);
        int word_cols = text_width_of(hints->does);

        if (col + key_cols + 1 + word_cols > end)
            break;
        windows_text(part, row, col, key_cols, ROLE_KEY, hints->key);
        col += key_cols + 1;
        windows_text(part, row, col, word_cols, ROLE_FAINT, hints->does);
        col += word_cols + GAP;
    }
    return hints;
}
