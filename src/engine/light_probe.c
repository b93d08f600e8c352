// SPDX-License-Identifier: MIT
#include "engine/light_probe.h"

#include <math.h>

#include "base/thread_pool.h"
#include "film/film.h"
#include "render/cpu_dispatch.h"

/* Pixels of the small picture, samples of each, and bounces of a path. */
#define PROBE_PIXELS  1024
#define PROBE_SAMPLES 4
#define PROBE_BOUNCES 6
#define PROBE_SIDE    256

/* Luminance from which a pixel is not black: 16 of 255 in sRGB. */
#define SHOWN_LUMINANCE 0.005

/* Light suffices if it shows a quarter of what the added light would show, or
 * makes a sixteenth of the luminance. A diode on a board does neither; a lamp
 * in a hall shows much, dimly, and a spot light little, brightly. */
#define SHOWN_SHARE (1 / 4.0)
#define MEAN_SHARE  (1 / 16.0)

struct probe_job {
    struct bvh8_world w;
    const struct cpu_kernel *kernel;
    int width;
    double exposure;
    bool counts_seen;
    struct light_probe rows[PROBE_SIDE]; /* sums */
};

static void add_pixel(const struct probe_job *j, uint32_t x, uint32_t y,
                      struct light_probe *sum)
{
    struct sample_id places[PROBE_SAMPLES];
    struct path_sample samples[PROBE_SAMPLES];
    struct first_surface surfaces[PROBE_SAMPLES];
    double luminance = 0;

    for (uint32_t i = 0; i < PROBE_SAMPLES; i++)
        places[i] = (struct sample_id){x, y, i};
    j->kernel->samples(&j->w.world, places, PROBE_SAMPLES, samples, surfaces);
    for (int i = 0; i < PROBE_SAMPLES; i++) {
        struct vec3 c = j->counts_seen
                            ? samples[i].radiance
                            : v3_sub(samples[i].radiance, surfaces[i].seen);
        double y_of =
            0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;

        luminance += fmax(0, fmin(y_of * j->exposure, 1)) / PROBE_SAMPLES;
    }
    sum->mean += luminance;
    sum->shown += luminance >= SHOWN_LUMINANCE;
}

static void probe_row(void *context, uint32_t y, int worker)
{
    struct probe_job *j = context;

    (void)worker;
    for (int x = 0; x < j->width; x++)
        add_pixel(j, (uint32_t)x, y, &j->rows[y]);
}

/* Makes a view of about PROBE_PIXELS pixels, through a pinhole. */
static struct view small_view(const struct view *view)
{
    struct view small = *view;
    double aspect = (double)view->width_px / view->height_px;
    double height = fmin(fmax(sqrt(PROBE_PIXELS / aspect), 1), PROBE_SIDE);

    small.height_px = (int)height;
    small.width_px = (int)fmin(fmax(PROBE_PIXELS / (double)small.height_px, 1),
                               PROBE_PIXELS);
    small.pose.aperture = 0;
    if (small.max_bounces < 0 || small.max_bounces > PROBE_BOUNCES)
        small.max_bounces = PROBE_BOUNCES;
    return small;
}

bool light_probe_take(struct light_probe *probe, struct host_world *host,
                      const struct scene *scene, const struct view *view,
                      bool counts_seen, struct error *err)
{
    struct view small = small_view(view);
    struct probe_job j = {.kernel = cpu_kernel_best(),
                          .width = small.width_px,
                          .exposure = exp2(view->lighting.exposure),
                          .counts_seen = counts_seen};
    struct pool *pool;
    bool ok;

    if (!world_lend(host, scene, &small, 0, &j.w.world, err))
        return false;
    pool = world_pool(host);
    ok = world_ensure_tree(host, &j.w.world, pool, err);
    if (ok) {
        j.w.tree = world_tree(host);
        j.w.world.settings.features |= FEATURE_FILTER;
        pool_each(pool, (uint32_t)small.height_px, probe_row, &j);
    }
    pool_destroy(pool);
    *probe = (struct light_probe){0, 0};
    for (int y = 0; y < small.height_px; y++) {
        probe->mean += j.rows[y].mean;
        probe->shown += j.rows[y].shown;
    }
    probe->mean /= (double)small.width_px * small.height_px;
    probe->shown /= (double)small.width_px * small.height_px;
    return ok;
}

bool light_probe_suffices(const struct light_probe *own,
                          const struct light_probe *with)
{
    return own->mean > MEAN_SHARE * with->mean ||
           own->shown > SHOWN_SHARE * with->shown;
}
