// SPDX-License-Identifier: MIT
#include "studio/status_line.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/text_width.h"
#include "render/error_text.h"
#include "render/render_left.h"

#define FIELD_BYTES 48

/* Longest time to an error that is shown: 100 hours. */
#define TARGET_NS_MAX 3.6e14

enum field {
    FIELD_MODE,
    FIELD_FILES,
    FIELD_SAMPLES,
    FIELD_PERCENT,
    FIELD_NOISE,
    FIELD_TARGET, /* ends the field of noise */
    FIELD_ELAPSED,
    FIELD_LEFT,
    FIELD_SPEED,
    FIELD_MACHINE,
    FIELD_SIZE,
    FIELD_COLORS,
    FIELDS
};

/* Fields in the order in which they are left out if there is no room. The first
 * ones are known or shown elsewhere, as in the progress panel; the last ones
 * tell the effect of a key. */
static const enum field dispensable[] = {FIELD_MACHINE, FIELD_SIZE,
                                         FIELD_SPEED,   FIELD_LEFT,
                                         FIELD_ELAPSED, FIELD_PERCENT,
                                         FIELD_TARGET,  FIELD_NOISE,
                                         FIELD_COLORS,  FIELD_SAMPLES};

void status_line_duration(char *text, size_t size_bytes, uint64_t ns)
{
    uint64_t s = ns / 1000000000u;

    if (s < 60)
        snprintf(text, size_bytes, "%" PRIu64 " s", s);
    else if (s < 3600)
        snprintf(text, size_bytes, "%" PRIu64 ":%02" PRIu64, s / 60, s % 60);
    else
        snprintf(text, size_bytes, "%" PRIu64 ":%02" PRIu64 ":%02" PRIu64,
                 s / 3600, s / 60 % 60, s % 60);
}

static const char *mode_word(const struct status_line *s)
{
    switch (s->progress->state) {
    case RENDER_FAILED: return "FAILED";
    case RENDER_DONE: return s->is_live ? "LIVE" : "NORMAL done";
    case RENDER_IDLE:
    case RENDER_RUNNING: break;
    }
    if (s->is_live)
        return s->is_halted ? "LIVE paused" : "LIVE";
    if (!s->is_started)
        return "NORMAL ready";
    return s->is_halted ? "NORMAL paused" : "NORMAL";
}

/* Formats a time to come, rounded up, so that 0 s means done. */
static void format_left(char *text, size_t size_bytes, double ns)
{
    status_line_duration(text, size_bytes,
                         ns < 1e18 ? (uint64_t)ns + 999999999u
                                   : UINT64_C(1000000000000000000));
}

bool status_line_left(char *text, size_t size_bytes,
                      const struct render_progress *p)
{
    struct render_left left = render_left(p);

    if (left.limit == RENDER_LIMIT_NONE)
        return false;
    format_left(text, size_bytes, left.ns);
    return true;
}

static void format_samples(char text[FIELD_BYTES],
                           const struct render_progress *p)
{
    if (p->spp_limit > 0)
        snprintf(text, FIELD_BYTES, "%" PRIu64 "/%" PRIu64 " spp", p->spp_done,
                 p->spp_limit);
    else
        snprintf(text, FIELD_BYTES, "%" PRIu64 " spp", p->spp_done);
}

static void format_left_fields(char text[FIELDS][FIELD_BYTES],
                               const struct render_progress *p)
{
    struct render_left left = render_left(p);
    char duration[24];

    if (left.limit == RENDER_LIMIT_NONE)
        return;
    snprintf(text[FIELD_PERCENT], FIELD_BYTES, "%d %%",
             (int)(100.0 * left.part));
    /* the time to an error is in the field of the target */
    if (p->state != RENDER_RUNNING || left.limit == RENDER_LIMIT_ERROR)
        return;
    format_left(duration, sizeof duration, left.ns);
    snprintf(text[FIELD_LEFT], FIELD_BYTES, "left %s", duration);
}

/* Formats the error and the time to the limit of -e or, without one, to a round
 * error, unless another limit comes before. */
static void format_noise(char text[FIELDS][FIELD_BYTES],
                         const struct render_progress *p)
{
    const struct film_error *e = &p->film_error;
    double target =
        p->error_limit > 0 ? p->error_limit : error_text_target(e->high);
    struct render_left left = render_left(p);
    char noise[ERROR_TEXT_BYTES], duration[24];
    double ns;

    error_text_noise(noise, e);
    snprintf(text[FIELD_NOISE], FIELD_BYTES, "%.*s", FIELD_BYTES - 1, noise);
    if (p->state != RENDER_RUNNING || !(e->high > target) ||
        !render_left_to_error(p, target, &ns) || ns > TARGET_NS_MAX ||
        (left.limit != RENDER_LIMIT_NONE && left.ns < ns))
        return;
    format_left(duration, sizeof duration, ns);
    snprintf(text[FIELD_TARGET], FIELD_BYTES, ", %g %% in %s", 100 * target,
             duration);
}

static void format_speed(char text[FIELD_BYTES],
                         const struct render_progress *p)
{
    double samples = (double)(p->samples + p->draft_samples);
    double speed =
        p->render_ns > 0 ? samples * 1e9 / (double)p->render_ns : 0.0;

    if (speed >= 1e9)
        snprintf(text, FIELD_BYTES, "%.2f Gsamples/s", speed * 1e-9);
    else if (speed >= 1e6)
        snprintf(text, FIELD_BYTES, "%.2f Msamples/s", speed * 1e-6);
    else
        snprintf(text, FIELD_BYTES, "%.0f ksamples/s", speed * 1e-3);
}

static void format_fields(char text[FIELDS][FIELD_BYTES],
                          const struct status_line *s)
{
    const struct render_progress *p = s->progress;

    snprintf(text[FIELD_MODE], FIELD_BYTES, "%s%s%s", mode_word(s),
             s->is_orbiting ? " orbit" : "", s->is_filtered ? " filtered" : "");
    if (s->device)
        snprintf(text[FIELD_MACHINE], FIELD_BYTES, "OpenCL %.24s", s->device);
    else
        snprintf(text[FIELD_MACHINE], FIELD_BYTES, "%d thread%s",
                 s->thread_count, s->thread_count == 1 ? "" : "s");
    if (s->load_key)
        snprintf(text[FIELD_FILES], FIELD_BYTES, "changed: %.8s loads",
                 s->load_key);
    snprintf(text[FIELD_SIZE], FIELD_BYTES, "%dx%d", s->width_px, s->height_px);
    snprintf(text[FIELD_COLORS], FIELD_BYTES, "%s", s->colors);
    if (!s->is_live && !s->is_started)
        return;
    format_samples(text[FIELD_SAMPLES], p);
    format_left_fields(text, p);
    format_noise(text, p);
    status_line_duration(text[FIELD_ELAPSED], FIELD_BYTES, p->render_ns);
    format_speed(text[FIELD_SPEED], p);
}

/* Returns the blanks before a field. */
static int gap_before(int field)
{
    return field == FIELD_TARGET ? 0 : 2;
}

static int length_of(char text[FIELDS][FIELD_BYTES])
{
    int length = 0;

    for (int i = 0; i < FIELDS; i++)
        length += text[i][0] ? (int)strlen(text[i]) + gap_before(i) : 0;
    return length;
}

void status_line_format(char text[STATUS_BYTES], int cols,
                        const struct status_line *s)
{
    char fields[FIELDS][FIELD_BYTES] = {{0}};
    int room = cols < STATUS_BYTES - 1 ? cols : STATUS_BYTES - 1;
    int hint = (int)strlen(s->hint);
    int at = -1; /* the first field has a gap as well */

    format_fields(fields, s);
    for (size_t i = 0; i < sizeof dispensable / sizeof dispensable[0]; i++) {
        if (1 + length_of(fields) + hint + 1 <= room)
            break;
        fields[dispensable[i]][0] = '\0';
    }
    memset(text, ' ', (size_t)room);
    text[room] = '\0';
    for (int i = 0; i < FIELDS; i++) {
        int length = (int)strlen(fields[i]);
        int begin = at + gap_before(i);

        if (length == 0 || begin + length > room)
            continue;
        memcpy(text + begin, fields[i], (size_t)length);
        at = begin + length;
    }
    if (at + 2 + hint + 1 <= room)
        memcpy(text + room - hint - 1, s->hint, (size_t)hint);
}

void status_line_message(char text[STATUS_BYTES], int cols, const char *message)
{
    if (cols > 0)
        *text++ = ' ';
    text_width_cut(text, STATUS_BYTES - 1, message, cols - 1);
}
