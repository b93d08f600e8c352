// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <inttypes.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/print.h"
#include "engine/engine_film.h"
#include "inspect/path_text.h"
#include "render/light_block.h"
#include "render/render_metadata.h"
#include "session/session_film.h"

/* Returns the value of a key in the picture's texts, or NULL. */
static const char *text_of(const struct options *o, const char *key)
{
    return o->picture != NULL ? image_metadata_value(o->picture, key) : NULL;
}

/* Returns the samples that pixels of the picture have, from `first` up to, and
 * without, `end`; 0: unknown. */
static struct film_range samples_of(const struct options *o)
{
    struct film_range r = {session_film_first(o), 0};
    const char *first = text_of(o, "glim:first_sample");

    if (first != NULL)
        digits_parse(&first, 10, FILM_SPP_MAX, &r.first);
    if (o->has_spp)
        r.end = r.first + session_film_limits(o).spp;
    return r;
}

/* Returns true if pixels may have further samples, or fewer. */
static bool counts_differ(const struct options *o)
{
    const char *stopped_by = text_of(o, "glim:stopped_by");

    return options_adaptive(o) ||
           (o->picture != NULL &&
            (stopped_by == NULL || strcmp(stopped_by, "time") == 0));
}

static bool check_sample(const struct options *o, struct error *err)
{
    struct film_range range = samples_of(o);
    uint64_t index = o->trace.index;

    if (options_adaptive(o) && range.end > ADAPTIVE_FIRST)
        range.end = ADAPTIVE_FIRST;
    if (index >= range.first && (range.end == 0 || index < range.end))
        return true;
    if (index < range.first || !counts_differ(o))
        return fail(err,
                    "--trace: found sample %" PRIu64 ", expected %" PRIu64
                    " to %" PRIu64 ", which the picture has",
                    index, range.first, range.end - 1);
    print_line(stderr,
               "glim: warning: --trace: found sample %" PRIu64
               ", but some pixels only have %" PRIu64 " to %" PRIu64,
               index, range.first, range.end - 1);
    return true;
}

static bool check_pixel(const struct session *s, struct error *err)
{
    struct sample_id id = s->options->trace;
    struct rect r = s->engine.crop;

    return (id.x < (uint32_t)r.width && id.y < (uint32_t)r.height) ||
           fail(err,
                "--trace: found pixel %" PRIu32 ",%" PRIu32
                ", expected one of the picture, which has %dx%d pixels",
                id.x, id.y, r.width, r.height);
}

/* Fails if the scene is not as it was when the picture was rendered. */
static bool check_scene(struct session *s, const struct view *view,
                        struct error *err)
{
    const struct options *o = s->options;
    const char *seed = text_of(o, "glim:seed");
    struct film_identity now, then;
    uint64_t number;

    if (o->picture == NULL)
        return true;
    if (text_of(o, "glim:denoised") != NULL)
        print_line(stderr,
                   "glim: warning: %s: the sample is of the picture before the "
                   "filter",
                   o->picture_path);
    if (!engine_film_identify(&s->engine, view, &now, err))
        return false;
    then = now;
    if (seed != NULL && digits_parse(&seed, 10, UINT32_MAX, &number))
        then.seed = (uint32_t)number;
    if (render_metadata_identity(o->picture, &then))
        return film_identity_check(&then, o->picture_path, &now, o->scene_path,
                                   err);
    print_line(stderr,
               "glim: warning: %s: its texts do not tell whether the scene has "
               "changed",
               o->picture_path);
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

    return check_pixel(s, err) && check_sample(s->options, err) &&
           check_scene(s, &view, err) &&
           engine_prepare(&s->engine, &view, &job, err) &&
           world_ensure_tree(&s->engine.world, &job.world,
                             s->engine.backends.cpu->pool, err) &&
           print_path(s, &job, err);
}
