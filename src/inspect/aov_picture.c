// SPDX-License-Identifier: MIT
#include "inspect/aov_picture.h"

#include <assert.h>

#include "kernels/traverse.h"

#include "kernels/path.h"

struct job {
    const struct world *world;
    int width;
    float *numbers;
};

static void trace_row(void *context, uint32_t y, int worker)
{
    const struct job *j = context;
    float *row = j->numbers + 3 * (size_t)y * (size_t)j->width;

    (void)worker;
    for (int x = 0; x < j->width; x++) {
        struct sample_id place = {(uint32_t)x, y, 0};
        struct path_sample sample;

        path_samples(j->world, &place, 1, &sample, NULL);
        row[3 * x] = sample.radiance.x;
        row[3 * x + 1] = sample.radiance.y;
        row[3 * x + 2] = sample.radiance.z;
    }
}

void aov_of_pixels(struct pool *pool, const struct world *world, int width,
                   int height, float *numbers)
{
    struct job j = {world, width, numbers};

    assert(world->settings.sample != SAMPLE_LIGHT);
    pool_each(pool, (uint32_t)height, trace_row, &j);
}
