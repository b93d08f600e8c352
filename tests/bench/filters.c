// SPDX-License-Identifier: MIT
/*
 * filters - processor time of the screen's filter in one thread, for a screen
 * of 400x240 pixels and for one of 1024x576: for a draft alone, and for a film
 * of 1024x576 pixels with 2 samples in each. Beside it the time of the frame
 * without the filter.
 *
 * usage: filters SCENE...
 */
#include <stdio.h>
#include <time.h>

#include "base/clock.h"
#include "film/filter/screen_filter.h"
#include "session/session.h"

#define ROUNDS 15

/* Processor time of this thread, in milliseconds. */
static double used_ms(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* Returns the least time of a frame. Without a filter it is not filtered. */
static double time_frame(struct session *s, struct screen_filter *filter,
                         enum filter_form form, struct frame *frame)
{
    double least = 1e9;

    for (int i = 0; i < ROUNDS; i++) {
        double begin = used_ms(), time;

        if (filter == NULL)
            film_preview(render_film(s->engine.render),
                         render_draft(s->engine.render), develop_linear(0),
                         frame);
        else
            screen_filter_show(
                filter,
                &(struct screen_films){render_film(s->engine.render),
                                       render_surfaces(s->engine.render),
                                       render_draft(s->engine.render)},
                develop_linear(0), form, frame);
        time = used_ms() - begin;
        least = time < least ? time : least;
    }
    return least;
}

static void time_frames(struct session *s, const char *what,
                        struct frame *frame)
{
    struct screen_filter filter = {.width = 0};

    printf("  %-20s %7.1f", what, time_frame(s, NULL, FILTER_FULL, frame));
    printf(" %6.1f", time_frame(s, &filter, FILTER_FAST, frame));
    printf(" %6.1f\n", time_frame(s, &filter, FILTER_FULL, frame));
    screen_filter_free(&filter);
}

/* Times frames of this size. */
static bool time_size(struct session *s, int width, int height,
                      struct error *err)
{
    struct frame frame = {0};

    if (!frame_init(&frame, width, height, err))
        return false;
    printf("  %dx%d\n", width, height);
    screen_filter_draft_size(width, height, SCREEN_FILTER_PIXELS,
                             &s->draft_width, &s->draft_height);
    if (!session_restart(s, (struct render_limits){0}, err))
        return false;
    while (render_progress(s->engine.render).samples == 0)
        render_wait(s->engine.render, 1);
    render_halt(s->engine.render);
    film_clear(render_film(s->engine.render));
    time_frames(s, "draft", &frame);
    if (!session_restart(s, (struct render_limits){0}, err))
        return false;
    while (render_progress(s->engine.render).spp_done < 2)
        render_wait(s->engine.render, 1);
    render_halt(s->engine.render);
    time_frames(s, "film of 2 samples", &frame);
    frame_free(&frame);
    return true;
}

static bool bench(const char *path, struct error *err)
{
    struct options o = {.scene_path = path,
                        .width_px = 1024,
                        .height_px = 576,
                        .max_bounces = -1};
    struct session s;
    bool ok;

    printf("%s\n  milliseconds         without   fast   full\n", path);
    ok = session_open(&s, &o, clock_ns(), err);
    s.is_filtered = true;
    ok = ok && time_size(&s, 400, 240, err) && time_size(&s, 1024, 576, err);
    session_close(&s);
    return ok;
}

int main(int argc, char **argv)
{
    struct error err;

    for (int i = 1; i < argc; i++) {
        if (!bench(argv[i], &err)) {
            fprintf(stderr, "filters: %s\n", err.text);
            return 1;
        }
    }
    return 0;
}
