// SPDX-License-Identifier: MIT
#include "terminal/pixel_graphics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "terminal/kitty.h"
#include "terminal/sixel.h"

/* Rows of images. With images of SIXEL_WIDTH_MAX a window of 1900 pixels has
 * 16: xterm keeps no more, and shows what is below when it forgets one. */
#define IMAGE_ROWS 4

/* Most bytes of a jump to any cell. */
#define JUMP_BYTES 24

/* Numbers of kitty's images: those of 256 colours that tmux does not change. */
#define ID_FIRST 16
#define ID_LAST  255

/* First guess of the bytes of a pixel: base64 of three bytes. Sixels have as
 * many in a picture with some noise. */
#define PIXEL_BYTES 4

/* At rest a frame may take so many times as long as while the camera moves. */
#define REST_SHARE 4

/* Most rows of cells in an image. */
static int image_rows_max(const struct pixel_graphics *g)
{
    return int_min((g->shape.rows + IMAGE_ROWS - 1) / IMAGE_ROWS,
                   KITTY_ROWS_MAX);
}

/* Remembers an image of kitty that is to be removed. */
static void retire(struct pixel_graphics *g, int id)
{
    if (id > 0 && g->old_count < PIXEL_GRAPHICS_OLD)
        g->old_images[g->old_count++] = id;
}

bool pixel_graphics_init(struct pixel_graphics *g,
                         const struct pixel_graphics_shape *shape,
                         const struct pixel_graphics *before, struct error *err)
{
    size_t rows_px;

    assert(shape->kind != PIXEL_GRAPHICS_NONE);
    *g = (struct pixel_graphics){
        .shape = *shape,
        .is_stale = true,
        .pixel_bytes = PIXEL_BYTES,
        .width_px = shape->cols * shape->cell_width_px,
        .height_px = shape->rows * shape->cell_height_px,
    };
    g->last_id = before->last_id;
    for (int i = 0; i < before->old_count; i++)
        retire(g, before->old_images[i]);
    for (int i = 0; i < before->image_count; i++)
        retire(g, before->images[i].id);
    rows_px = (size_t)image_rows_max(g) * (size_t)shape->cell_height_px;
    g->pixels = alloc_array(3 * rows_px, SIXEL_WIDTH_MAX);
    g->numbers = alloc_array(2 * rows_px, SIXEL_WIDTH_MAX);
    if (g->pixels && g->numbers &&
        frame_init(&g->shown, g->width_px, g->height_px, err) &&
        color_cut_init(&g->cut, err))
        return true;
    pixel_graphics_free(g);
    return fail(err, "out of memory for a picture of %dx%d cells as pixels",
                shape->cols, shape->rows);
}

void pixel_graphics_free(struct pixel_graphics *g)
{
    free(g->pixels);
    free(g->numbers);
    frame_free(&g->shown);
    color_cut_free(&g->cut);
    *g = (struct pixel_graphics){0};
}

void pixel_graphics_invalidate(struct pixel_graphics *g)
{
    g->is_stale = true;
}

/* ---- places of the images ---- */

/* Finds the images that show what no window covers. Rows that are covered alike
 * are of one image, if it does not become too high. Returns their number. */
static int find_images(const struct pixel_graphics *g,
                       const struct ansi_diff_draw *how,
                       struct ansi_diff_rect rects[PIXEL_GRAPHICS_IMAGES])
{
    int cols_max = SIXEL_WIDTH_MAX / g->shape.cell_width_px;
    int rows_max = image_rows_max(g);
    int count = 0;

    for (int row = 0; row < g->shape.rows; row++) {
        int col = ansi_diff_uncovered(how, 0, row);

        while (col < g->shape.cols) {
            int last = int_min(g->shape.cols, col + cols_max);
            int end = col + 1, i = 0;

            while (end < last && ansi_diff_uncovered(how, end, row) == end)
                end++;
            while (i < count &&
                   !(rects[i].col == col && rects[i].cols == end - col &&
                     rects[i].row + rects[i].rows == row &&
                     rects[i].rows < rows_max))
                i++;
            if (i < count)
                rects[i].rows++;
            else if (count < PIXEL_GRAPHICS_IMAGES)
                rects[count++] =
                    (struct ansi_diff_rect){col, row, end - col, 1};
            col = ansi_diff_uncovered(how, end, row);
        }
    }
    return count;
}

/* Takes new places of the images. Returns true if all have to be sent. */
static bool place_images(struct pixel_graphics *g,
                         const struct ansi_diff_draw *how)
{
    struct ansi_diff_rect rects[PIXEL_GRAPHICS_IMAGES];
    int count = find_images(g, how, rects);
    bool is_other = count != g->image_count;

    for (int i = 0; i < count && !is_other; i++)
        is_other = memcmp(&rects[i], &g->images[i].rect, sizeof rects[0]) != 0;
    if (!is_other)
        return g->is_stale;
    for (int i = 0; i < g->image_count; i++)
        retire(g, g->images[i].id);
    for (int i = 0; i < count; i++)
        g->images[i] = (struct pixel_graphics_image){.rect = rects[i]};
    g->image_count = count;
    return true;
}

/* Rectangle in pixels. */
struct area {
    int x, y, width, height;
};

/* Returns the pixels of a picture of width x height that show an image. */
static struct area area_in(const struct pixel_graphics *g,
                           const struct ansi_diff_rect *r, int width,
                           int height)
{
    int x0 = r->col * width / g->shape.cols;
    int y0 = r->row * height / g->shape.rows;
    int x1 = (r->col + r->cols) * width / g->shape.cols;
    int y1 = (r->row + r->rows) * height / g->shape.rows;

    /* small frames have less than a pixel for each cell */
    x0 = x1 > x0 ? x0 : int_min(x0, width - 1);
    y0 = y1 > y0 ? y0 : int_min(y0, height - 1);
    return (struct area){x0, y0, x1 > x0 ? x1 - x0 : 1, y1 > y0 ? y1 - y0 : 1};
}

/* ---- pixels ---- */

static uint8_t *pixel_of(const struct frame *frame, int x, int y)
{
    return frame->rgb + 3 * ((size_t)y * (size_t)frame->width + (size_t)x);
}

static bool rows_close(const uint8_t *a, const uint8_t *b, size_t count,
                       int step)
{
    if (step == 0)
        return memcmp(a, b, count) == 0;
    for (size_t i = 0; i < count; i++) {
        if (abs(a[i] - b[i]) > step)
            return false;
    }
    return true;
}

/* Returns true if an image shows its part of the frame, with channel
 * differences up to `step`. */
static bool may_stay(const struct pixel_graphics *g,
                     const struct pixel_graphics_image *image,
                     const struct frame *frame, int step)
{
    struct area area = area_in(g, &image->rect, frame->width, frame->height);

    if (!image->is_fine || g->shown.width != frame->width ||
        g->shown.height != frame->height)
        return false;
    for (int y = area.y; y < area.y + area.height; y++) {
        if (!rows_close(pixel_of(&g->shown, area.x, y),
                        pixel_of(frame, area.x, y), 3 * (size_t)area.width,
                        step))
            return false;
    }
    return true;
}

/* Remembers the part of the frame that an image shows. */
static void keep_shown(struct pixel_graphics *g, const struct area *area,
                       const struct frame *frame)
{
    g->shown.width = frame->width;
    g->shown.height = frame->height;
    for (int y = area->y; y < area->y + area->height; y++)
        memcpy(pixel_of(&g->shown, area->x, y), pixel_of(frame, area->x, y),
               3 * (size_t)area->width);
}

/* Reduces an area of the frame to the mean colours of width x height blocks. */
static void reduce(const struct frame *frame, const struct area *area,
                   int width, int height, uint8_t *to)
{
    for (int y = 0; y < height; y++) {
        int y0 = area->y + y * area->height / height;
        int y1 = area->y + (y + 1) * area->height / height;

        for (int x = 0; x < width; x++, to += 3) {
            int x0 = area->x + x * area->width / width;
            int x1 = area->x + (x + 1) * area->width / width;
            int count = (x1 - x0) * (y1 - y0);
            int sum[3] = {count / 2, count / 2, count / 2};

            for (int i = y0; i < y1; i++) {
                const uint8_t *p = pixel_of(frame, x0, i);

                for (int k = 0; k < 3 * (x1 - x0); k++)
                    sum[k % 3] += p[k];
            }
            for (int c = 0; c < 3; c++)
                to[c] = (uint8_t)(sum[c] / count);
        }
    }
}

/* Makes a palette for g->pixels, and the numbers of an image of the terminal's
 * pixels, which repeats them. A repeated pixel is dithered as one. Returns the
 * numbers. */
static const uint8_t *fill_numbers(struct pixel_graphics *g,
                                   const struct area *area, int width,
                                   int height)
{
    uint8_t *to = g->numbers + (size_t)width * (size_t)height;
    struct color_cut_image image = {g->pixels, width, height,
                                    area->x * width / area->width,
                                    area->y * height / area->height};

    color_cut(&g->cut, &image, g->shape.colors, g->numbers);
    if (width == area->width && height == area->height)
        return g->numbers;
    for (int y = 0; y < area->height; y++) {
        const uint8_t *from = g->numbers + y * height / area->height * width;

        for (int x = 0; x < area->width; x++)
            to[y * area->width + x] = from[x * width / area->width];
    }
    return to;
}

/* ---- sending ---- */

/* Returns the width in terminal's pixels of a square pixel for which a number
 * of these fits into the bytes. There is one pixel a cell at least, so that
 * something can be recognised. Pixels of sixels divide a band of them, or
 * consist of bands: others would take more bytes. */
static double block_of(const struct pixel_graphics *g, double pixels,
                       double size_bytes)
{
    double cell = (double)g->shape.cell_width_px * g->shape.cell_height_px;
    double most = fmax(size_bytes / g->pixel_bytes, pixels / cell);
    double block = fmax(sqrt(pixels / most), 1);

    if (g->shape.kind == PIXEL_GRAPHICS_SIXEL)
        block = block > 3 ? 6 * ceil(block / 6) : ceil(block);
    return block;
}

static bool is_id_used(const struct pixel_graphics *g, int id)
{
    for (int i = 0; i < g->image_count; i++) {
        if (g->images[i].id == id)
            return true;
    }
    for (int i = 0; i < g->old_count; i++) {
        if (g->old_images[i] == id)
            return true;
    }
    return false;
}

/* Returns a number for a new image. Fewer are in use
 * than there are. */
static int next_id(struct pixel_graphics *g)
{
    int id = g->last_id;

    do
        id = id < ID_FIRST || id >= ID_LAST ? ID_FIRST : id + 1;
    while (is_id_used(g, id));
    g->last_id = id;
    return id;
}

static void erase(struct pixel_graphics *g, struct ansi_diff *a, int id)
{
    struct kitty_image image = {.id = id, .is_virtual = g->shape.is_in_tmux};

    a->length += kitty_erase(&image, a->bytes + a->length);
}

/* Appends g->pixels as an image of kitty, and the removal of the one before. */
static void put_kitty(struct pixel_graphics *g, struct ansi_diff *a,
                      struct pixel_graphics_image *image, int width, int height,
                      const struct ansi_diff_draw *how)
{
    int before = image->id;
    struct kitty_image kitty = {.id = next_id(g),
                                .is_virtual = g->shape.is_in_tmux,
                                .cols = image->rect.cols,
                                .rows = image->rect.rows,
                                .width = width,
                                .height = height,
                                .rgb = g->pixels,
                                .stride_bytes = 3 * (size_t)width};

    a->length += kitty_encode(&kitty, a->bytes + a->length);
    for (int row = 0; kitty.is_virtual && row < kitty.rows; row++) {
        ansi_diff_jump(a, how->row + image->rect.row + row,
                       how->col + image->rect.col);
        a->length += kitty_cells(&kitty, row, a->bytes + a->length);
    }
    if (before > 0)
        erase(g, a, before);
    image->id = kitty.id;
}

/* Most bytes of an image with its jumps. */
static size_t image_bytes_max(const struct pixel_graphics *g,
                              const struct pixel_graphics_image *image,
                              const struct area *screen, int width, int height)
{
    size_t cells = (size_t)image->rect.rows *
                   (JUMP_BYTES + kitty_cells_bytes_max(image->rect.cols));

    return JUMP_BYTES + (g->shape.kind == PIXEL_GRAPHICS_KITTY
                             ? kitty_bytes_max(width, height) + cells
                             : sixel_bytes_max(screen->width, screen->height));
}

/* Sends an image with pixels of this width. Returns false when memory is out.
 */
static bool put_image(struct pixel_graphics *g, struct ansi_diff *a,
                      struct pixel_graphics_image *image,
                      const struct frame *frame, double block,
                      const struct ansi_diff_draw *how)
{
    struct area from = area_in(g, &image->rect, frame->width, frame->height);
    struct area screen = area_in(g, &image->rect, g->width_px, g->height_px);
    int width = int_min((int)ceil(screen.width / block), from.width);
    int height = int_min((int)ceil(screen.height / block), from.height);
    struct sixel_image sixel = {screen.width, screen.height, g->cut.colors,
                                NULL};
    size_t before = a->length;

    if (!ansi_diff_reserve(a,
                           image_bytes_max(g, image, &screen, width, height)))
        return false;
    reduce(frame, &from, width, height, g->pixels);
    ansi_diff_jump(a, how->row + image->rect.row, how->col + image->rect.col);
    if (g->shape.kind == PIXEL_GRAPHICS_KITTY) {
        put_kitty(g, a, image, width, height, how);
    } else {
        sixel.numbers = fill_numbers(g, &screen, width, height);
        a->length += sixel_encode(&sixel, a->bytes + a->length);
    }
    g->pixel_bytes +=
        .2 * ((double)(a->length - before) / (width * height) - g->pixel_bytes);
    image->is_fine = width == from.width && height == from.height;
    if (image->is_fine)
        keep_shown(g, &from, frame);
    return true;
}

/* Sends all images. Returns true if all are fine. */
static bool put_all(struct pixel_graphics *g, struct ansi_diff *a,
                    const struct frame *frame, size_t budget_bytes,
                    const struct ansi_diff_draw *how)
{
    double block =
        block_of(g, (double)g->width_px * g->height_px, (double)budget_bytes);
    bool are_fine = true;

    for (int i = 0; i < g->image_count; i++) {
        if (!put_image(g, a, &g->images[i], frame, block, how))
            return false;
        are_fine = are_fine && g->images[i].is_fine;
    }
    for (int i = 0; i < g->old_count; i++) {
        if (!ansi_diff_reserve(a, kitty_bytes_max(0, 0)))
            return false;
        erase(g, a, g->old_images[i]);
    }
    g->old_count = 0;
    g->next = 0;
    g->is_stale = false;
    return are_fine;
}

/* Sends images that differ, as fine as the frame or as the line allows. */
static bool put_changes(struct pixel_graphics *g, struct ansi_diff *a,
                        const struct frame *frame,
                        const struct ansi_diff_draw *how)
{
    size_t before = a->length, limit = before + how->budget_bytes;

    for (int i = 0; i < g->image_count; i++) {
        int index = (g->next + i) % g->image_count;
        struct pixel_graphics_image *image = &g->images[index];
        double pixels = (double)image->rect.cols * g->shape.cell_width_px *
                        image->rect.rows * g->shape.cell_height_px;
        double block =
            block_of(g, pixels, REST_SHARE * (double)how->budget_bytes);

        if (may_stay(g, image, frame, how->step))
            continue;
        if (a->length >= limit ||
            (a->length > before && frame_is_cancelled(frame)) ||
            !put_image(g, a, image, frame, block, how)) {
            g->next = index;
            return false;
        }
        if (!image->is_fine) {
            struct area area =
                area_in(g, &image->rect, frame->width, frame->height);

            keep_shown(g, &area, frame);
            image->is_fine = true;
        }
    }
    g->next = 0;
    return true;
}

bool pixel_graphics_picture(struct pixel_graphics *g, struct ansi_diff *a,
                            const struct frame *frame,
                            enum pixel_graphics_pace pace,
                            const struct ansi_diff_draw *how)
{
    size_t share = pace == PIXEL_GRAPHICS_MOVES ? 1 : REST_SHARE;
    bool needs_all = place_images(g, how);

    if (pace == PIXEL_GRAPHICS_RESTS && !needs_all)
        return put_changes(g, a, frame, how);
    return put_all(g, a, frame, share * how->budget_bytes, how) ||
           pace != PIXEL_GRAPHICS_RESTS;
}
