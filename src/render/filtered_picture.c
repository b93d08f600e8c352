// SPDX-License-Identifier: MIT
#include "render/filtered_picture.h"

#include "base/min_max.h"
#include "film/filter/screen_filter.h"
#include "render/cpu_dispatch.h"

/* Samples of a pixel of the draft: both of its halves have some. */
#define SPP 3

struct job {
    const struct world *world;
    const struct cpu_kernel *kernel;
    struct film *draft;
    const struct cancel *cancel;
};

static bool is_cancelled(const struct cancel *cancel)
{
    return cancel != NULL && cancel_requested(cancel);
}

static void render_row(void *context, uint32_t y, int worker)
{
    static const int counts[SAMPLE_BLOCK] = {SPP, SPP, SPP, SPP,
                                             SPP, SPP, SPP, SPP};
    const struct job *j = context;
    struct sample_id ids[SAMPLE_BLOCK * SPP];
    struct path_sample samples[SAMPLE_BLOCK * SPP];
    struct first_surface surfaces[SAMPLE_BLOCK * SPP];

    (void)worker;
    for (int x = 0; x < j->draft->width && !is_cancelled(j->cancel);
         x += SAMPLE_BLOCK) {
        int pixels = int_min(j->draft->width - x, SAMPLE_BLOCK);

        for (int i = 0; i < pixels * SPP; i++)
            ids[i] = (struct sample_id){(uint32_t)(x + i / SPP), y,
                                        (uint64_t)i % SPP};
        j->kernel->samples(j->world, ids, (uint32_t)pixels * SPP, samples,
                           surfaces, NULL);
        film_add_row(j->draft, (struct film_pixels){x, (int)y, 1, pixels},
                     samples, surfaces, counts);
    }
}

bool filtered_picture_draft(struct film *draft, const struct world *world,
                            int width, int height, struct pool *pool,
                            const struct cancel *cancel, struct error *err)
{
    static const struct cancel never;
    struct world w = *world;
    struct job j = {&w, NULL, draft, cancel};

    w.settings.order = ORDER_DRAFT_HALVES;
    w.settings.features |= FEATURE_FILTER;
    j.kernel = cpu_kernel_fit(cpu_kernel_best(), w.settings.features);
    if (!film_init(draft, width, height, err) ||
        !film_init_surfaces(draft, err))
        return false;
    pool_run(pool, (uint32_t)height, render_row, &j,
             cancel != NULL ? cancel : &never);
    return !is_cancelled(cancel) || fail(err, "the filter was cancelled");
}

bool filtered_picture_paint(struct film *film, struct film *draft,
                            struct develop how, struct frame *frame,
                            struct error *err)
{
    struct screen_filter filter = {.memory = NULL};
    bool ok =
        screen_filter_show(&filter, &(struct screen_films){film, draft, NULL},
                           how, FILTER_FULL, frame);

    screen_filter_free(&filter);
    return ok || fail(err, "out of memory to filter a picture of %dx%d",
                      frame->width, frame->height);
}
