// SPDX-License-Identifier: MIT
#include "studio/key_hints.h"

#include <stdbool.h>

#include "base/text_width.h"

#define GAP 2

const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints)
{
    bool is_status = part == WINDOW_STATUS;
    enum text_role key = is_status ? ROLE_STATUS_KEY : ROLE_KEY;
    enum text_role word = is_status ? ROLE_STATUS_FAINT : ROLE_FAINT;
    int end = col + cols;

    for (; hints->does; hints++) {
        int key_cols = text_width_of(hints->key);
        int word_cols = text_width_of(hints->does);

        if (col + key_cols + 1 + word_cols > end)
            break;
        windows_text(part, row, col, key_cols, key, hints->key);
        col += key_cols + 1;
        windows_text(part, row, col, word_cols, word, hints->does);
        col += word_cols + GAP;
    }
    return hints;
}
