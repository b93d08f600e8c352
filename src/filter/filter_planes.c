// SPDX-License-Identifier: MIT
#include "filter/filter_planes.h"

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
