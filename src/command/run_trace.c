// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <inttypes.h>

#include "base/file.h"
#include "base/print.h"
#include "inspect/path_text.h"
#include "render/light_block.h"
#include "session/session_film.h"

/* Samples that the picture has in its pixels, from `first` up to, and without,
 * `end`; 0: unknown. */
static struct film_range samples_of(const struct options *o)
{
    struct film_range r = {session_film_first(o), 0};

    if (o->has_spp)
        r.end = r.first + session_film_limits(o).spp;
    return r;
}

/* Fails if the picture has no such pixel or sample. With adaptive sampling a
 * pixel may have more or fewer. */
static bool check_place(const struct session *s, struct error *err)
{
    const struct options *o = s->options;
    const struct sample_id *id = &o->trace;
    struct rect r = s->engine.crop;
    struct film_range range = samples_of(o);

    if (id->x >= (uint32_t)r.width || id->y >= (uint32_t)r.height)
        return fail(err,
                    "--trace: found pixel %" PRIu32 ",%" PRIu32
                    ", expected one of the picture, which has %dx%d pixels",
                    id->x, id->y, r.width, r.height);
    if (options_adaptive(o) && id->index >= ADAPTIVE_FIRST)
        print_line(stderr, "glim: warning: --trace: the pixel may have fewer "
                           "samples, as they are adaptive");
    else if (id->index < range.first ||
             (range.end != 0 && id->index >= range.end))
        return fail(err,
                    "--trace: found sample %" PRIu64 ", expected %" PRIu64
                    " to %" PRIu64 ", which the picture has",
                    id->index, range.first, range.end - 1);
    return true;
}

/* Finds the light that the sample shares with others: the world of its path
 * becomes *world, and what light paths bring to the pixel by itself *shared. */
static bool find_light(struct light_block *b, const struct session *s,
                       const struct render_job *job, struct sample_id id,
                       struct world *world, struct vec3 *shared,
                       struct error *err)
{
    struct rect crop = s->engine.crop;
    struct film size = {.width = crop.width, .height = crop.height};
    struct backend_picture picture = {.host = job->host,
                                      .world = &job->world,
                                      .film = &size,
                                      .x0 = crop.x,
                                      .y0 = crop.y};
    struct pool *pool = s->engine.backends.cpu->pool;
    struct cancel never = {0};
    const float *pixel;

    if (light_block_decide(b, &picture, pool, &never, err) != PASS_DONE)
        return false;
    if (light_block_is_needed(b) &&
        light_block_find(b, &picture, id.index, pool, &never, err) != PASS_DONE)
        return false;
    *world = light_block_world(b, &job->world);
    *shared = v3(0.0f, 0.0f, 0.0f);
    if (b->light.pixel_count == 0)
        return true;
    pixel = b->light.pixels +
            3 * ((size_t)s->options->trace.y * (size_t)crop.width +
                 (size_t)s->options->trace.x +
                 (id.index & 1) * b->light.pixel_count);
    *shared = v3(pixel[0], pixel[1], pixel[2]);
    return true;
}

static void print_head(const struct session *s)
{
    const struct options *o = s->options;
    struct rect r = s->engine.crop;
    char place[32] = "";

    if (r.x != 0 || r.y != 0)
        snprintf(place, sizeof place, " at %d,%d", r.x, r.y);
    print_line(stdout,
               "%s: pixel %" PRIu32 ",%" PRIu32 " of %dx%d%s, sample %" PRIu64
               ", seed %" PRIu32,
               path_name(o->scene_path), o->trace.x, o->trace.y, r.width,
               r.height, place, o->trace.index, o->seed);
}

static bool print_path(const struct session *s, struct render_job *job,
                       struct error *err)
{
    struct sample_id id = s->options->trace;
    struct light_block block = {.means = NULL};
    struct world world;
    struct overlay_names names = {&world, s->edit.names};
    struct vec3 shared, light;
    bool ok;

    id.x += (uint32_t)s->engine.crop.x;
    id.y += (uint32_t)s->engine.crop.y;
    ok = find_light(&block, s, job, id, &world, &shared, err);
    if (ok) {
        print_head(s);
        light = path_text_print(stdout, &s->engine.scene, &names, id);
        if (block.light.pixel_count > 0)
            path_text_light(stdout, "light paths", shared);
        path_text_light(stdout, "radiance", v3_add(light, shared));
        if (light_block_is_needed(&block) && options_adaptive(s->options) &&
            id.index >= ADAPTIVE_FIRST)
            print_line(stderr,
                       "glim: warning: --trace: the picture's sample may have "
                       "other light from cells, as samples are adaptive");
    }
    light_block_free(&block);
    return ok && print_finish(stdout, err);
}

bool batch_trace_run(struct session *s, struct error *err)
{
    struct view view = edit_view(&s->edit);
    struct render_job job;

    return check_place(s, err) &&
           engine_prepare(&s->engine, &view, &job, err) &&
           world_ensure_tree(&s->engine.world, &job.world,
                             s->engine.backends.cpu->pool, err) &&
           print_path(s, &job, err);
}
