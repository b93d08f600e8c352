// SPDX-License-Identifier: MIT
#include "studio/status_line.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/print.h"
#include "render/error_text.h"
#include "render/progress.h"

#define FIELD_BYTES 48

/* Longest time to an error that is shown: 100 hours. */
#define TARGET_NS_MAX 3.6e14

enum field {
    FIELD_MODE,
    FIELD_DEVICE,
    FIELD_HOW, /* the camera moves, and the picture is made */
    FIELD_KEPT,
    FIELD_FILES,
    FIELD_SAMPLES,
    FIELD_PERCENT,
    FIELD_NOISE,
    FIELD_TARGET, /* ends the field of noise */
    FIELD_ELAPSED,
    FIELD_LEFT,
    FIELDS
};

/* Fields in the order in which they are left out if there is no room; the mode
 * becomes one word. The last ones tell the effect of a key, and stay longer
 * than the hint of the help. */
static const enum field dispensable[] = {FIELD_ELAPSED, FIELD_TARGET,
                                         FIELD_PERCENT, FIELD_LEFT,
                                         FIELD_NOISE,   FIELD_HOW,
                                         FIELD_SAMPLES, FIELD_MODE,
                                         FIELD_KEPT,    FIELD_FILES};

#define BEFORE_HELP 7
#define DISPENSABLE ((int)(sizeof dispensable / sizeof dispensable[0]))

/* What follows the key of the help. */
#define HELP " help "

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

static enum text_role mode_role(const struct status_line *s)
{
    if (s->progress->state == RENDER_FAILED)
        return ROLE_FAILED;
    if (s->is_halted)
        return ROLE_PAUSED;
    return s->is_live ? ROLE_LIVE : ROLE_NORMAL;
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

/* Formats the error of what is seen. */
static void format_filtered(char text[FIELDS][FIELD_BYTES], double error)
{
    char percent[ERROR_TEXT_BYTES];

    error_text_percent(percent, error);
    snprintf(text[FIELD_NOISE], FIELD_BYTES, "error ~%.32s", percent);
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

static void format_fields(char text[FIELDS][FIELD_BYTES],
                          const struct status_line *s)
{
    const struct render_progress *p = s->progress;

    snprintf(text[FIELD_MODE], FIELD_BYTES, "%s", mode_word(s));
    snprintf(text[FIELD_HOW], FIELD_BYTES, "%s%s%s",
             s->is_orbiting ? " orbit" : "",
             s->passes_walls ? " through walls" : "",
             s->is_filtered ? " filtered" : "");
    if (s->has_device)
        snprintf(text[FIELD_DEVICE], FIELD_BYTES, "OpenCL");
    if (s->restore_key)
        snprintf(text[FIELD_KEPT], FIELD_BYTES, "kept session: %.8s",
                 s->restore_key);
    if (s->load_key)
        snprintf(text[FIELD_FILES], FIELD_BYTES, "changed: %.8s loads",
                 s->load_key);
    if (!s->is_live && !s->is_started)
        return;
    format_samples(text[FIELD_SAMPLES], p);
    format_left_fields(text, p);
    if (s->is_filtered)
        format_filtered(text, s->filtered_error);
    else
        format_noise(text, p);
    status_line_duration(text[FIELD_ELAPSED], FIELD_BYTES, p->render_ns);
}

/* Returns the blanks before a field. */
static int gap_before(int field)
{
    return field == FIELD_TARGET ? 0 : field == FIELD_HOW ? 1 : 2;
}

static int length_of(char text[FIELDS][FIELD_BYTES])
{
    int length = 0;

    for (int i = 0; i < FIELDS; i++)
        length += text[i][0] ? (int)strlen(text[i]) + gap_before(i) : 0;
    return length;
}

static void add_span(struct status_row *row, int col, int cols,
                     enum text_role role)
{
    row->spans[row->span_count++] = (struct status_span){col, cols, role};
}

/* Makes a row of blanks. All of it is set, so that rows can be compared. */
static int begin_row(struct status_row *row, int cols, enum text_role role)
{
    int room = cols < STATUS_BYTES - 1 ? cols : STATUS_BYTES - 1;

    memset(row, 0, sizeof *row);
    row->role = role;
    memset(row->text, ' ', (size_t)room);
    return room;
}

/* Marks the name of the mode, which begins in column 1. */
static void mark_mode(struct status_row *row, const struct status_line *s,
                      int length, int room)
{
    int cols = length + 2;

    add_span(row, 0, cols < room ? cols : room, mode_role(s));
}

/* Puts the hint of the help at the right end. */
static void add_help(struct status_row *row, const char *key, int col)
{
    size_t length = strlen(key);

    memcpy(row->text + col, key, length);
    memcpy(row->text + col + length, HELP, sizeof HELP - 1);
    add_span(row, col, (int)length, ROLE_STATUS_KEY);
}

void status_line_format(struct status_row *row, int cols,
                        const struct status_line *s)
{
    char fields[FIELDS][FIELD_BYTES] = {{0}};
    int room = begin_row(row, cols, ROLE_STATUS);
    int help = (int)(strlen(s->help_key) + sizeof HELP - 1);
    size_t word = strcspn(mode_word(s), " ");
    int at = -1; /* the first field has a gap as well */
    int length;

    format_fields(fields, s);
    for (int i = 0; i < DISPENSABLE; i++)
        if (1 + length_of(fields) + (i < BEFORE_HELP ? help : 0) > room)
            fields[dispensable[i]][dispensable[i] == FIELD_MODE ? word : 0] =
                '\0';
    mark_mode(row, s, (int)strlen(fields[FIELD_MODE]), room);
    for (int i = 0; i < FIELDS; i++) {
        int begin = at + gap_before(i);

        length = (int)strlen(fields[i]);
        if (length == 0 || begin + length > room)
            continue;
        memcpy(row->text + begin, fields[i], (size_t)length);
        at = begin + length;
    }
    if (at + 2 + help <= room)
        add_help(row, s->help_key, room - help);
}

void status_line_message(struct status_row *row, int cols,
                         const struct status_line *s, const char *message,
                         enum text_role role)
{
    char mode[FIELD_BYTES];
    int room = begin_row(row, cols, role);
    int rest = room - text_width_of(message);
    int length, begin = 1;

    snprintf(mode, sizeof mode, "%s%s", mode_word(s),
             s->has_device ? " OpenCL" : "");
    length = (int)strlen(mode);
    if (length + 3 > rest)
        length = (int)strcspn(mode, " ");
    if (length + 3 <= rest) {
        memcpy(row->text + 1, mode, (size_t)length);
        mark_mode(row, s, length, room);
        begin = length + 3;
    }
    if (begin >= room)
        return;
    text_width_cut(row->text + begin, sizeof row->text - (size_t)begin, message,
                   room - begin);
}
