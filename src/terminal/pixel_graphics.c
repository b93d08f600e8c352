// SPDX-License-Identifier: MIT
#include "terminal/pixel_graphics.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "terminal/kitty.h"
#include "terminal/sixel.h"

/* Columns of a tile. Few enough for the budget of a slow line, enough to
 * outweigh the 200 bytes or so of colour definitions that an image needs. */
#define TILE_COLS 16

/* Most bytes of a jump to any cell. */
#define JUMP_BYTES 24

static bool init_frame(struct frame *frame,
                       const struct pixel_graphics_shape *shape,
                       struct error *err)
{
    return frame_init(frame, shape->cols * shape->cell_width_px,
                      shape->rows * shape->cell_height_px, err);
}

bool pixel_graphics_init(struct pixel_graphics *g,
                         const struct pixel_graphics_shape *shape,
                         struct error *err)
{
    int most = SIXEL_WIDTH_MAX / shape->cell_width_px;

    assert(shape->kind != PIXEL_GRAPHICS_NONE);
    *g = (struct pixel_graphics){.shape = *shape};
    g->tile_cols = most < 1 ? 1 : most < TILE_COLS ? most : TILE_COLS;
    g->tiles_across = (shape->cols + g->tile_cols - 1) / g->tile_cols;
    g->tiles = alloc_array((size_t)g->tiles_across * (size_t)shape->rows,
                           sizeof g->tiles[0]);
    g->numbers =
        alloc_array((size_t)g->tile_cols * (size_t)shape->cell_width_px,
                    (size_t)shape->cell_height_px);
    if (g->tiles && g->numbers && init_frame(&g->wanted, shape, err) &&
        init_frame(&g->shown, shape, err) && dither_init(&g->dither, err))
        return true;
    pixel_graphics_free(g);
    return fail(err, "out of memory for a picture of %dx%d cells as pixels",
                shape->cols, shape->rows);
}

void pixel_graphics_free(struct pixel_graphics *g)
{
    free(g->tiles);
    free(g->numbers);
    frame_free(&g->wanted);
    frame_free(&g->shown);
    dither_free(&g->dither);
    *g = (struct pixel_graphics){0};
}

void pixel_graphics_invalidate(struct pixel_graphics *g,
                               struct ansi_diff_rect rect)
{
    int count = g->tiles_across * g->shape.rows;

    for (int i = 0; i < count; i++) {
        int row = i / g->tiles_across;
        int begin = i % g->tiles_across * g->tile_cols;

        if (row >= rect.row && row < rect.row + rect.rows &&
            begin < rect.col + rect.cols && begin + g->tile_cols > rect.col)
            g->tiles[i].is_known = false;
    }
}

const char *pixel_graphics_eraser(enum pixel_graphics_kind kind)
{
    return kind == PIXEL_GRAPHICS_KITTY ? KITTY_ERASE_ALL : NULL;
}

/* Returns the first run of columns of a tile that no window covers. Every
 * window of glim is wider than a tile, so none leaves both ends free. */
static struct pixel_graphics_tile wanted_tile(const struct pixel_graphics *g,
                                              int index,
                                              const struct ansi_diff_draw *how)
{
    int row = index / g->tiles_across;
    int first = index % g->tiles_across * g->tile_cols;
    int last = first + g->tile_cols;
    struct pixel_graphics_tile tile = {.is_known = true};

    last = last < g->shape.cols ? last : g->shape.cols;
    tile.begin = ansi_diff_uncovered(how, first, row);
    if (tile.begin >= last)
        return (struct pixel_graphics_tile){.is_known = true};
    for (tile.end = tile.begin + 1;
         tile.end < last &&
         ansi_diff_uncovered(how, tile.end, row) == tile.end;)
        tile.end++;
    return tile;
}

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

/* Rectangle of a tile in pixels. */
struct area {
    int x, y, width, height;
};

static struct area area_of(const struct pixel_graphics *g, int row,
                           const struct pixel_graphics_tile *tile)
{
    const struct pixel_graphics_shape *s = &g->shape;

    return (struct area){tile->begin * s->cell_width_px,
                         row * s->cell_height_px,
                         (tile->end - tile->begin) * s->cell_width_px,
                         s->cell_height_px};
}

/* Returns true if the tile is shown already, with channel differences up to
 * `step`. */
static bool may_stay(const struct pixel_graphics *g, int index,
                     const struct pixel_graphics_tile *wanted, int step)
{
    const struct pixel_graphics_tile *tile = &g->tiles[index];
    struct area area = area_of(g, index / g->tiles_across, wanted);

    if (!tile->is_known || tile->begin != wanted->begin ||
        tile->end != wanted->end)
        return false;
    for (int y = area.y; area.width > 0 && y < area.y + area.height; y++) {
        if (!rows_close(pixel_of(&g->shown, area.x, y),
                        pixel_of(&g->wanted, area.x, y), 3 * (size_t)area.width,
                        step))
            return false;
    }
    return true;
}

static size_t encode_sixel(struct pixel_graphics *g, const struct area *area,
                           char *bytes)
{
    struct sixel_image image = {area->width, area->height, g->shape.palette,
                                g->numbers};
    uint8_t *number = g->numbers;

    for (int y = area->y; y < area->y + area->height; y++) {
        for (int x = area->x; x < area->x + area->width; x++) {
            const uint8_t *p = pixel_of(&g->wanted, x, y);

            *number++ = (uint8_t)dither_color(&g->dither,
                                              (struct rgb){p[0], p[1], p[2]}, x,
                                              y, g->shape.palette);
        }
    }
    return sixel_encode(&image, bytes);
}

static size_t encode_kitty(const struct pixel_graphics *g, int index,
                           const struct area *area, char *bytes)
{
    struct kitty_image image = {index + 1, area->width, area->height,
                                pixel_of(&g->wanted, area->x, area->y),
                                3 * (size_t)g->wanted.width};

    return kitty_encode(&image, bytes);
}

static size_t tile_bytes_max(const struct pixel_graphics *g,
                             const struct area *area)
{
    return JUMP_BYTES + (g->shape.kind == PIXEL_GRAPHICS_KITTY
                             ? kitty_bytes_max(area->width, area->height)
                             : sixel_bytes_max(area->width, area->height));
}

/* Sends the pixels of a tile, or removes them where a window is. Returns false
 * when memory is out. */
static bool put_tile(struct pixel_graphics *g, struct ansi_diff *a, int index,
                     const struct pixel_graphics_tile *wanted,
                     const struct ansi_diff_draw *how)
{
    bool is_kitty = g->shape.kind == PIXEL_GRAPHICS_KITTY;
    int row = index / g->tiles_across;
    struct area area = area_of(g, row, wanted);

    if (!ansi_diff_reserve(a, tile_bytes_max(g, &area)))
        return false;
    if (area.width > 0) {
        ansi_diff_jump(a, how->row + row, how->col + wanted->begin);
        char *bytes = a->bytes + a->length;
        a->length += is_kitty ? encode_kitty(g, index, &area, bytes)
                              : encode_sixel(g, &area, bytes);
    } else if (is_kitty) {
        a->length += kitty_erase(index + 1, a->bytes + a->length);
    }
    for (int y = area.y; y < area.y + area.height; y++)
        memcpy(pixel_of(&g->shown, area.x, y), pixel_of(&g->wanted, area.x, y),
               3 * (size_t)area.width);
    g->tiles[index] = *wanted;
    return true;
}

/* Repeats pixels to the size of `to`; repeated rows are copied. */
static void enlarge(const struct frame *from, struct frame *to)
{
    size_t row_bytes = 3 * (size_t)to->width;
    int before = -1;

    for (int y = 0; y < to->height; y++) {
        int from_y = (int)((int64_t)y * from->height / to->height);
        uint8_t *out = pixel_of(to, 0, y);

        if (from_y == before) {
            memcpy(out, out - row_bytes, row_bytes);
            continue;
        }
        before = from_y;
        for (int x = 0; x < to->width; x++)
            memcpy(out + 3 * x,
                   pixel_of(from, (int)((int64_t)x * from->width / to->width),
                            from_y),
                   3);
    }
}

bool pixel_graphics_picture(struct pixel_graphics *g, struct ansi_diff *a,
                            const struct frame *frame,
                            const struct ansi_diff_draw *how)
{
    const char *eraser = pixel_graphics_eraser(g->shape.kind);
    int count = g->tiles_across * g->shape.rows;
    size_t limit = how->budget_bytes > SIZE_MAX - a->length
                       ? SIZE_MAX
                       : a->length + how->budget_bytes;

    enlarge(frame, &g->wanted);
    if (!g->has_begun && eraser)
        ansi_diff_text(a, eraser);
    g->has_begun = true;
    for (int i = 0; i < count; i++) {
        int index = (g->next + i) % count;
        struct pixel_graphics_tile wanted = wanted_tile(g, index, how);

        if (may_stay(g, index, &wanted, how->step))
            continue;
        if (a->length >= limit || !put_tile(g, a, index, &wanted, how)) {
            g->next = index;
            return false;
        }
    }
    g->next = 0;
    return true;
}
