// SPDX-License-Identifier: MIT
#include "inspect/traversal_cost.h"

/* Counters of the current ray of this thread. */
static _Thread_local struct traversal_cost counted;

#define COUNT_NODE()  (counted.nodes++)
#define COUNT_BLOCK() (counted.blocks++)

#include "world/bvh/ray_queries.h"

#include "kernels/camera.h"

struct job {
    const struct world *world;
    int width;
    struct traversal_cost *costs;
};

static void count_row(void *context, uint32_t y, int worker)
{
    const struct job *j = context;
    struct traversal_cost *row = j->costs + (size_t)y * (size_t)j->width;

    (void)worker;
    for (int x = 0; x < j->width; x++) {
        struct ray r = camera_ray(j->world->settings.camera, (uint32_t)x, y,
                                  v2(0.5f, 0.5f));
        struct hit h;

        counted = (struct traversal_cost){0};
        hit_closest(j->world, r, &h);
        row[x] = counted;
    }
}

void traversal_cost_of_pixels(struct pool *pool, const struct world *world,
                              int width, int height,
                              struct traversal_cost *costs)
{
    struct job j = {world, width, costs};

    pool_each(pool, (uint32_t)height, count_row, &j);
}
