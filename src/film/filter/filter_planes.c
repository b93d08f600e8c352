// SPDX-License-Identifier: MIT
#include "film/filter/filter_planes.h"

#include "base/min_max.h"

#include <string.h>

void filter_extend(const struct filter_planes *p, float *plane,
                   struct filter_tile t)
{
    int left = t.x == 0 ? FILTER_COPIES : 0;
    int right = t.x + t.width == p->width ? FILTER_COPIES : 0;
    int last = t.y + t.height - 1;
    size_t size_bytes = (size_t)(left + t.width + right) * sizeof *plane;

    for (int y = t.y; y <= last; y++) {
        float *row = plane + y * p->pitch + t.x;

        for (int i = 1; i <= left; i++)
            row[-i] = row[0];
        for (int i = 0; i < right; i++)
            row[t.width + i] = row[t.width - 1];
    }
    for (int i = 1; t.y == 0 && i <= FILTER_COPIES; i++)
        memcpy(plane - i * p->pitch + t.x - left, plane + t.x - left,
               size_bytes);
    for (int i = 1; last == p->height - 1 && i <= FILTER_COPIES; i++)
        memcpy(plane + (last + i) * p->pitch + t.x - left,
               plane + last * p->pitch + t.x - left, size_bytes);
}

/* Returns the width of tiles: about the same for all, in whole cache lines. */
static int tile_width(const struct filter_planes *p)
{
    int columns = (p->width + FILTER_TILE_WIDTH - 1) / FILTER_TILE_WIDTH;
    int width = (p->width + columns - 1) / columns;

    return (width + FILTER_LINE - 1) / FILTER_LINE * FILTER_LINE;
}

uint32_t filter_tile_columns(const struct filter_planes *p)
{
    return (uint32_t)((p->width + tile_width(p) - 1) / tile_width(p));
}

uint32_t filter_tile_count(const struct filter_planes *p)
{
    return (uint32_t)((p->height + FILTER_TILE_HEIGHT - 1) /
                      FILTER_TILE_HEIGHT) *
           filter_tile_columns(p);
}

struct filter_tile filter_tile_at(const struct filter_planes *p, uint32_t i)
{
    int width = tile_width(p);
    int x = (int)(i % filter_tile_columns(p)) * width;
    int y = (int)(i / filter_tile_columns(p)) * FILTER_TILE_HEIGHT;

    return (struct filter_tile){x, y, int_min(width, p->width - x),
                                int_min(FILTER_TILE_HEIGHT, p->height - y)};
}
