// SPDX-License-Identifier: MIT
/*
 * show.c - prints an image file as a small colour picture of half blocks
 *
 * `make run` uses it without a terminal, where output is a log. With NO_COLOR
 * set it prints characters.
 */
#include <stdio.h>
#include <stdlib.h>

#include "terminal/ansi_diff.h"
#include "tests/unit/whole_image.h"

#define COLS        64
#define ROWS_MAX    48
#define CELL_ASPECT 2.0

/* Averages sRGB bytes, which is exact enough for a thumbnail. */
static void shrink(const struct image *image, struct frame *frame)
{
    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            int x0 = (int)((int64_t)x * image->width / frame->width);
            int x1 = (int)((int64_t)(x + 1) * image->width / frame->width);
            int y0 = (int)((int64_t)y * image->height / frame->height);
            int y1 = (int)((int64_t)(y + 1) * image->height / frame->height);
            uint64_t sum[3] = {0, 0, 0}, count = 0;

            for (int j = y0; j < y1 || j == y0; j++) {
                for (int i = x0; i < x1 || i == x0; i++) {
                    size_t at = ((size_t)j * (size_t)image->width + (size_t)i);

                    for (int k = 0; k < 3; k++)
                        sum[k] += image->rgba[at * 4 + (size_t)k];
                    count++;
                }
            }
            for (int k = 0; k < 3; k++)
                frame->rgb[(y * frame->width + x) * 3 + k] =
                    (uint8_t)(sum[k] / count);
        }
    }
}

static bool print_cells(const struct cells *cells, struct error *err)
{
    size_t size_bytes;
    char *text;

    if (!ansi_diff_lines(cells, &text, &size_bytes, err))
        return false;
    fwrite(text, 1, size_bytes, stdout);
    free(text);
    return true;
}

static bool show(const char *path, struct error *err)
{
    bool is_plain = getenv("NO_COLOR") && getenv("NO_COLOR")[0];
    struct image image = {0};
    struct frame frame = {0};
    struct cells cells = {0};
    struct cells_rect fit;
    bool is_shown = false;

    if (!image_read_8bit(&image, path, err))
        return false;
    fit = cells_fit(image.width, image.height, COLS, ROWS_MAX, CELL_ASPECT);
    if (frame_init(&frame, fit.cols, 2 * fit.rows, err) &&
        cells_init(&cells, fit.cols, fit.rows, err)) {
        shrink(&image, &frame);
        cells_from_frame(&cells, &frame,
                         is_plain ? PALETTE_MONO : PALETTE_24BIT, GLYPHS_HALF);
        is_shown = print_cells(&cells, err);
    }
    cells_free(&cells);
    frame_free(&frame);
    image_free(&image);
    return is_shown;
}

int main(int argc, char **argv)
{
    struct error err;

    if (argc != 2) {
        fprintf(stderr, "usage: show IMAGE\n");
        return 2;
    }
    if (!show(argv[1], &err)) {
        fprintf(stderr, "show: %s\n", err.text);
        return 1;
    }
    return 0;
}
