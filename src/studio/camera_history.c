// SPDX-License-Identifier: MIT
#include "studio/camera_history.h"

#include <stdlib.h>

#include "terminal/xmalloc.h"

/* One more than the steps: the pose that the last undo has left. */
static void grow(struct camera_history *h)
{
    if (h->at + 1 < h->capacity)
        return;
    h->capacity = h->capacity > 0 ? 2 * h->capacity : 64;
    h->poses = xrealloc(h->poses, (size_t)h->capacity * sizeof h->poses[0]);
}

void camera_history_add(struct camera_history *h, const struct pose *before)
{
    grow(h);
    h->poses[h->at++] = *before;
    h->count = h->at;
}

bool camera_history_undo(struct camera_history *h, struct pose *pose)
{
    if (h->at == 0)
        return false;
    h->poses[h->at] = *pose;
    *pose = h->poses[--h->at];
    return true;
}

bool camera_history_redo(struct camera_history *h, struct pose *pose)
{
    if (h->at == h->count)
        return false;
    h->poses[h->at] = *pose;
    *pose = h->poses[++h->at];
    return true;
}

void camera_history_free(struct camera_history *h)
{
    free(h->poses);
    *h = (struct camera_history){0};
}
