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
    FIELD_KEPT,
    FIELD_FILES,
    FIELD_SAMPLES,
    FIELD_PERCENT,
    FIELD_NOISE,
    FIELD_TARGET, /* ends the field of noise */
    FIELD_GAUGE,
    FIELD_ELAPSED,
    FIELD_LEFT,
    FIELD_SPEED,
    FIELD_MACHINE,
    FIELD_SIZE,
    FIELD_COLORS,
    FIELDS
};

/* Fields in the order in which they are left out if there is no room; that of
 * the machine shrinks to one word, and the mode loses its last word, then all
 * but its name. The first ones are known or shown elsewhere, as in the progress
 * panel; the last ones tell the effect of a key. */
static const enum field dispensable[] = {
    FIELD_MACHINE, FIELD_SIZE,    FIELD_SPEED,  FIELD_LEFT,  FIELD_ELAPSED,
    FIELD_GAUGE,   FIELD_PERCENT, FIELD_TARGET, FIELD_NOISE, FIELD_MODE,
    FIELD_COLORS,  FIELD_MODE,    FIELD_SAMPLES};

#define GAUGE_COLS 8

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

bool status_line_part(const struct render_progress *p, double *part)
{
    struct render_left left = render_left(p);
    double ns;

    *part = left.part;
    if (left.limit != RENDER_LIMIT_NONE)
        return true;
    if (p->state != RENDER_RUNNING ||
        !render_left_to_error(p, error_text_target(p->film_error.high), &ns))
        return false;
    *part = (double)p->render_ns / ((double)p->render_ns + ns);
    return true;
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

static void format_machine(char text[FIELD_BYTES], const struct status_line *s,
                           bool is_short)
{
    if (is_short)
        snprintf(text, FIELD_BYTES, "%s", s->device ? "OpenCL" : "CPU");
    else if (s->device)
        snprintf(text, FIELD_BYTES, "OpenCL %.24s", s->device);
    else
        snprintf(text, FIELD_BYTES, "CPU %d thread%s", s->thread_count,
                 print_plural((uint64_t)s->thread_count));
}

static void format_fields(char text[FIELDS][FIELD_BYTES],
                          const struct status_line *s, double *part)
{
    const struct render_progress *p = s->progress;

    /* the coloured mode ends with a blank, and another one is between them */
    snprintf(text[FIELD_MODE], FIELD_BYTES, "%s%s%s%s%s", mode_word(s),
             s->is_orbiting || s->passes_walls || s->is_filtered ? " " : "",
             s->is_orbiting ? " orbit" : "",
             s->passes_walls ? " through walls" : "",
             s->is_filtered ? " filtered" : "");
    format_machine(text[FIELD_MACHINE], s, false);
    if (s->restore_key)
        snprintf(text[FIELD_KEPT], FIELD_BYTES, "kept: %.8s", s->restore_key);
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
    if (status_line_part(p, part))
        snprintf(text[FIELD_GAUGE], FIELD_BYTES, "%*s", GAUGE_COLS, "");
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

static void add_span(struct status_row *row, int col, int cols,
                     enum text_role role)
{
    row->spans[row->span_count++] = (struct status_span){col, cols, role};
}

/* Returns the columns of the hints with a blank at the end. */
static int hint_columns(const struct status_line *s)
{
    int cols = 0;

    for (int i = 0; i < STATUS_LINE_HINTS && s->hints[i][0]; i++)
        cols += (int)(strlen(s->hints[i][0]) + strlen(s->hints[i][1])) + 3;
    return cols > 0 ? cols - 1 : 0;
}

static void add_hints(struct status_row *row, const struct status_line *s,
                      int col)
{
    for (int i = 0; i < STATUS_LINE_HINTS && s->hints[i][0]; i++) {
        int key = (int)strlen(s->hints[i][0]);
        int word = (int)strlen(s->hints[i][1]);

        memcpy(row->text + col, s->hints[i][0], (size_t)key);
        memcpy(row->text + col + key + 1, s->hints[i][1], (size_t)word);
        add_span(row, col, key, ROLE_STATUS_KEY);
        col += key + 1 + word + 2;
    }
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

/* Leaves out a field, or a part of it. `is_last` says that of the mode only the
 * name is to stay. */
static void leave_out(char text[FIELDS][FIELD_BYTES], enum field field,
                      const struct status_line *s, bool is_last)
{
    size_t length = strlen(mode_word(s));

    if (field == FIELD_MACHINE)
        format_machine(text[field], s, true);
    else if (field != FIELD_MODE)
        text[field][0] = '\0';
    else if (is_last)
        text[field][length] = '\0';
    else if (strlen(text[field]) > length)
        *strrchr(text[field], ' ') = '\0';
}

void status_line_format(struct status_row *row, int cols,
                        const struct status_line *s)
{
    char fields[FIELDS][FIELD_BYTES] = {{0}};
    int room = begin_row(row, cols, ROLE_STATUS);
    int hint = hint_columns(s), length;
    const char *mode = mode_word(s);
    int at = -1; /* the first field has a gap as well */
    double part = 0;

    format_fields(fields, s, &part);
    for (size_t i = 0; i < sizeof dispensable / sizeof dispensable[0]; i++) {
        if (1 + length_of(fields) + hint <= room)
            break;
        leave_out(fields, dispensable[i], s, fields[FIELD_COLORS][0] == '\0');
    }
    if (1 + length_of(fields) > room) /* what renders comes before its state */
        fields[FIELD_MODE][strcspn(mode, " ")] = '\0';
    for (int i = FIELD_KEPT; i <= FIELD_FILES; i++)
        if (1 + length_of(fields) > room)
            fields[i][0] = '\0';
    length = (int)strlen(fields[FIELD_MODE]);
    mark_mode(row, s, length < (int)strlen(mode) ? length : (int)strlen(mode),
              room);
    for (int i = 0; i < FIELDS; i++) {
        int begin = at + gap_before(i);

        length = (int)strlen(fields[i]);
        if (length == 0 || begin + length > room)
            continue;
        memcpy(row->text + begin, fields[i], (size_t)length);
        at = begin + length;
        if (i == FIELD_GAUGE) {
            row->gauge_col = begin;
            row->gauge_cols = length;
            row->gauge = part;
        }
    }
    if (at + 2 + hint <= room)
        add_hints(row, s, room - hint);
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
             s->device ? " OpenCL" : "");
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
