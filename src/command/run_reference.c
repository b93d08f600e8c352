// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "command/batch_progress.h"
#include "command/reference_info.h"
#include "command/replicates.h"
#include "film/image_write.h"
#include "terminal/xmalloc.h"

#define SPP_DEFAULT 4096

/* Measurements have seeds from 0 on. */
#define SEED_DEFAULT 1000000

/* The reference in progress. */
struct making {
    const struct options *o;
    struct session session;
    char *json_path;
    struct replicates replicates;
    uint64_t spp; /* samples of each seed */
    uint64_t non_finite, saturated;
    struct batch_bar bar;
};

static uint32_t first_seed(const struct options *o)
{
    return o->has_seed ? o->seed : SEED_DEFAULT;
}

/* Finds mistakes before minutes of rendering. */
static bool check_outputs(const struct making *m, struct error *err)
{
    const char *const paths[] = {m->o->output_path, m->json_path};

    for (int i = 0; i < 2; i++)
        if (!session_check_output(&m->session, "reference", paths[i], err) ||
            !file_check(paths[i], err))
            return false;
    return true;
}

/* Renders one seed. The first one is limited by its share of the time, and the
 * others get its number of samples, since the pictures must be alike.
 * *is_complete is false after a signal. */
static bool render_seed(struct making *m, int index, bool *is_complete,
                        struct error *err)
{
    struct session *s = &m->session;
    struct render_limits limits = {.spp = m->spp};
    struct render_progress p;

    if (index == 0)
        limits.time_ns = m->o->time_ns / (uint64_t)m->o->seed_count;
    s->engine.options.seed = first_seed(m->o) + (uint32_t)index;
    if (!session_restart(s, limits, err))
        return false;
    p = batch_wait(s, &m->bar);
    if (p.state == RENDER_FAILED) {
        *err = p.error;
        return false;
    }
    *is_complete = p.state == RENDER_DONE;
    if (!*is_complete)
        return true;
    m->spp = p.spp_done;
    m->non_finite += p.non_finite;
    m->saturated += p.saturated;
    if (m->spp == 0)
        return fail(err,
                    "--time: found no complete sample in %.3g s for each "
                    "of %d seeds, expected more time",
                    seconds_between(0, limits.time_ns), m->o->seed_count);
    film_linear(render_film(s->engine.render), m->replicates.rgb[index]);
    return true;
}

static bool render(struct making *m, struct error *err)
{
    uint64_t seeds = (uint64_t)m->o->seed_count;
    uint64_t total = m->o->has_spp ? m->o->spp : SPP_DEFAULT;
    bool is_complete = true;

    m->spp = m->o->time_ns > 0 && !m->o->has_spp ? 0 /* no limit */
                                                 : (total + seeds - 1) / seeds;
    for (int i = 0; i < m->o->seed_count; i++) {
        if (!render_seed(m, i, &is_complete, err))
            return false;
        if (!is_complete)
            break;
        m->replicates.count++;
    }
    return true;
}

/* Writes the file beside the picture. If that fails, an older one, which has
 * the error of another picture, does not stay. */
static bool write_info(const struct making *m,
                       const struct reference_info *info,
                       const struct reference_origin *origin, struct error *err)
{
    if (reference_info_write(info, origin, m->json_path, err))
        return true;
    remove(m->json_path);
    return false;
}

/* Writes the picture and the file beside it. */
static bool write_all(struct making *m, uint64_t start_ns, struct error *err)
{
    struct replicates *r = &m->replicates;
    struct mean_error e;
    const float *mean = replicates_mean(r, &e);
    struct reference_info info = {
        .is_known = true,
        .mse = e.mse,
        .relmse = e.relmse,
        .relmse_low = e.relmse_low,
        .relmse_high = e.relmse_high,
        .first_seed = first_seed(m->o),
        .seed_count = r->count,
    };
    struct reference_origin origin = {
        .width = r->width,
        .height = r->height,
        .spp = m->spp * (uint64_t)r->count,
        .mean = e.mean,
        .seconds = seconds_between(start_ns, clock_ns()),
        .scene_path = m->o->scene_path,
        .arguments = m->o->arguments,
    };

    if (!image_write_floats(mean, r->width, r->height, m->o->output_path,
                            err) ||
        !write_info(m, &info, &origin, err))
        return false;
    print_line(stderr,
               "%s: %dx%d, %" PRIu64 " spp in %d seeds, relMSE %.3g (95 %%: "
               "%.3g to %.3g), %.1f s",
               m->o->output_path, r->width, r->height, origin.spp, r->count,
               e.relmse, e.relmse_low, e.relmse_high, origin.seconds);
    batch_warn_of_samples(m->non_finite, m->saturated);
    return true;
}

static bool write(struct making *m, uint64_t start_ns, struct error *err)
{
    bool ok;

    stop_hold();
    ok = write_all(m, start_ns, err);
    stop_release();
    return ok;
}

static bool prepare(struct making *m, uint64_t start_ns, struct error *err)
{
    const struct rect *crop = &m->session.engine.crop;

    m->json_path = xchecked(reference_info_path(m->o->output_path));
    /* before our signals are set: drivers put theirs over them */
    return batch_open(&m->session, m->o, start_ns, err) &&
           check_outputs(m, err) &&
           replicates_init(&m->replicates, crop->width, crop->height,
                           m->o->seed_count, err) &&
           batch_use_device(&m->session, err) && batch_catch_signals(err);
}

static bool make(struct making *m, uint64_t start_ns, struct error *err)
{
    if (!prepare(m, start_ns, err) || !render(m, err))
        return false;
    if (m->replicates.count >= REPLICATES_MIN)
        return write(m, start_ns, err);
    print_line(stderr,
               "stopped after %d of %d seeds, expected at least %d: nothing "
               "written",
               m->replicates.count, m->o->seed_count, REPLICATES_MIN);
    return true;
}

bool batch_reference_run(const struct options *o, uint64_t start_ns,
                         int *status, struct error *err)
{
    struct making m = {.o = o, .bar = batch_bar_begin()};
    bool ok = make(&m, start_ns, err);

    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    session_close(&m.session);
    replicates_free(&m.replicates);
    free(m.json_path);
    return ok;
}
