// SPDX-License-Identifier: MIT
/*
 * square.h - square pictures of s.obj in the current folder
 *
 * Units:     pixels, radiance
 * Ownership: the session is closed by square_render()
 * Threads:   one
 * Errors:    a failure ends the test
 */
#ifndef TESTS_SQUARE_H
#define TESTS_SQUARE_H

#include "base/clock.h"
#include "session/session.h"
#include "tests/unit/check.h"

/* Returns options for two threads. */
static inline struct options square_options(int side, uint32_t seed)
{
    struct options o;

    options_init(&o);
    o.scene_path = "s.obj";
    o.width_px = o.height_px = side;
    o.thread_count = 2;
    o.seed = seed;
    o.batch = true;
    return o;
}

static inline void square_open(struct session *s, const struct options *o)
{
    struct error err = {""};

    check_or_say(session_open(s, o, clock_ns(), &err), err.text);
}

/* Renders, and returns the last progress. */
static inline struct render_progress square_render(struct session *s,
                                                   uint32_t spp, float *rgb)
{
    struct error err = {""};
    struct render_progress p;

    check_or_say(session_restart(s, (struct render_limits){.spp = spp}, &err),
                 err.text);
    render_wait(s->engine.render, -1);
    film_linear(render_film(s->engine.render), rgb);
    p = render_progress(s->engine.render);
    session_close(s);
    return p;
}

#endif
