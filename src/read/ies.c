// SPDX-License-Identifier: MIT
#include "read/ies.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/decimal.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "read/text_file.h"
#include "world/light/daylight.h"

/* Columns of profiles that are not the same all around: each is 2.5 degrees. */
#define COLUMNS 144u

/* Most angles of either kind, and greatest candela value. */
#define ANGLES_MAX  1000
#define CANDELA_MAX 1e12

/* Types of photometry. */
#define TYPE_C 1

struct reader {
    const char *path;
    const char *p, *end;
    uint64_t line;
};

/* The numbers of a file. */
struct photometry {
    uint32_t vertical_count, horizontal_count;
    double factor;      /* of all candela values */
    double *vertical;   /* angles from straight down, in degrees */
    double *horizontal; /* angles around it */
    double *candelas;   /* of each horizontal angle, those of vertical ones */
};

/* Moves behind the end of the line: LF, CRLF or CR. */
static void next_line(struct reader *r)
{
    while (r->p < r->end && *r->p != '\n' && *r->p != '\r')
        r->p++;
    if (r->p + 1 < r->end && r->p[0] == '\r' && r->p[1] == '\n')
        r->p++;
    if (r->p < r->end)
        r->p++;
    r->line++;
}

static bool is_separator(char c)
{
    return c == ' ' || c == '\t' || c == ',' || c == '\n' || c == '\r';
}

/* Moves to the next word. Words may be on any line. */
static void skip_separators(struct reader *r)
{
    while (r->p < r->end && is_separator(*r->p)) {
        if (*r->p == '\n' || *r->p == '\r')
            next_line(r);
        else
            r->p++;
    }
}

static struct word word_here(const struct reader *r)
{
    struct word w = {r->p, 0};

    while (r->p + w.length < r->end && !is_separator(r->p[w.length]))
        w.length++;
    return w;
}

static bool fail_word(const struct reader *r, const char *expected,
                      struct error *err)
{
    struct word w = word_here(r);

    if (w.length == 0)
        return fail(err, "%s:%" PRIu64 ": found the end, expected %s", r->path,
                    r->line, expected);
    return fail(err, "%s:%" PRIu64 ": found %s, expected %s", r->path, r->line,
                word_quote(w).text, expected);
}

/* Reads a number in a range. `expected` describes it. */
static bool read_number(struct reader *r, double least, double most,
                        const char *expected, double *value, struct error *err)
{
    struct reader start;

    skip_separators(r);
    start = *r;
    if (decimal_parse(&r->p, r->end, value) && *value >= least &&
        *value <= most && (r->p == r->end || is_separator(*r->p)))
        return true;
    return fail_word(&start, expected, err);
}

static bool read_count(struct reader *r, const char *expected, uint32_t *count,
                       struct error *err)
{
    struct reader start;
    double value;

    skip_separators(r);
    start = *r;
    if (!read_number(r, 1, ANGLES_MAX, expected, &value, err))
        return false;
    *count = (uint32_t)value;
    return value <= *count || fail_word(&start, expected, err);
}

static bool skip_number(struct reader *r, const char *expected,
                        struct error *err)
{
    double ignored;

    return read_number(r, -CANDELA_MAX, CANDELA_MAX, expected, &ignored, err);
}

/* Moves behind the line TILT=. The lines before it are labels. */
static bool read_tilt(struct reader *r, struct error *err)
{
    struct word word;

    while (r->p < r->end && !((size_t)(r->end - r->p) >= 5 &&
                              strncasecmp(r->p, "TILT=", 5) == 0))
        next_line(r);
    if (r->p == r->end)
        return fail(err,
                    "%s: found no line that begins with TILT=, expected an IES "
                    "file",
                    r->path);
    r->p += 5;
    word = word_here(r);
    if (word.length != 4 || strncasecmp(word.start, "NONE", 4) != 0)
        return fail_word(r,
                         "NONE behind TILT=: a lamp that emits the same in "
                         "any position",
                         err);
    next_line(r);
    return true;
}

/* Reads the numbers before the angles. */
static bool read_header(struct reader *r, struct photometry *p,
                        struct error *err)
{
    struct reader at;
    double type, multiplier, ballast, lamp;

    if (!skip_number(r, "a number of lamps", err) ||
        !skip_number(r, "the lumens of a lamp", err) ||
        !read_number(r, 0, CANDELA_MAX, "a factor of candela values from 0",
                     &multiplier, err) ||
        !read_count(r, "1 to 1000 vertical angles", &p->vertical_count, err) ||
        !read_count(r, "1 to 1000 horizontal angles", &p->horizontal_count,
                    err))
        return false;
    skip_separators(r);
    at = *r;
    if (!read_number(r, 1, 3, "a type of photometry from 1 to 3", &type, err))
        return false;
    if (type > TYPE_C)
        return fail_word(&at,
                         "1, the photometry of type C; 2 and 3 are types "
                         "B and A",
                         err);
    if (!skip_number(r, "1 for feet or 2 for metres", err) ||
        !skip_number(r, "a width", err) || !skip_number(r, "a length", err) ||
        !skip_number(r, "a height", err) ||
        !read_number(r, 0, CANDELA_MAX, "a ballast factor from 0", &ballast,
                     err) ||
        !read_number(r, 0, CANDELA_MAX, "a ballast-lamp factor from 0", &lamp,
                     err) ||
        !skip_number(r, "the input watts", err))
        return false;
    p->factor = multiplier * ballast * lamp / DAYLIGHT_UNIT;
    return true;
}

/* Reads angles, each above the one before. */
static bool read_angles(struct reader *r, double most, const char *expected,
                        double *angles, uint32_t count, struct error *err)
{
    for (uint32_t i = 0; i < count; i++) {
        struct reader at;

        skip_separators(r);
        at = *r;
        if (!read_number(r, 0, most, expected, &angles[i], err))
            return false;
        if (i > 0 && angles[i] <= angles[i - 1])
            return fail_word(&at, "an angle above the one before", err);
    }
    return true;
}

/* Returns true if the angles are these degrees to a hundredth. */
static bool is_range(const struct photometry *p, double first, double last)
{
    return fabs(p->horizontal[0] - first) < .01 &&
           fabs(p->horizontal[p->horizontal_count - 1] - last) < .01;
}

/* Returns true if the angles go all around in equal steps, the last of which
 * leads to the first one. */
static bool is_circle(const struct photometry *p)
{
    double step = 360.0 / p->horizontal_count;

    for (uint32_t i = 1; i < p->horizontal_count; i++)
        if (fabs(p->horizontal[i] - p->horizontal[0] - i * step) > .01)
            return false;
    return p->horizontal_count > 1;
}

static bool check_range(const struct reader *r, const struct photometry *p,
                        struct error *err)
{
    if (p->horizontal_count == 1 || is_range(p, 0, 90) || is_range(p, 0, 180) ||
        is_range(p, 90, 270) || is_range(p, 0, 360) || is_circle(p))
        return true;
    return fail(err,
                "%s:%" PRIu64 ": found horizontal angles from %g to %g, "
                "expected 0, 0 to 90, 0 to 180, 90 to 270, 0 to 360 or equal "
                "steps of a circle",
                r->path, r->line, p->horizontal[0],
                p->horizontal[p->horizontal_count - 1]);
}

static bool read_candelas(struct reader *r, struct photometry *p,
                          struct error *err)
{
    size_t count = (size_t)p->vertical_count * p->horizontal_count;
    double most = 0;

    for (size_t i = 0; i < count; i++) {
        if (!read_number(r, 0, CANDELA_MAX, "a candela value from 0 to 1e12",
                         &p->candelas[i], err))
            return false;
        p->candelas[i] *= p->factor;
        most = fmax(most, p->candelas[i]);
    }
    return (most > 0 && most <= CANDELA_MAX) ||
           fail(err,
                "%s: found a greatest candela value of %g, expected one from "
                "above 0 to 1e12",
                r->path, most * DAYLIGHT_UNIT);
}

/* Returns true if the file has one half or one quarter of the circle. */
static bool is_symmetric(const struct photometry *p)
{
    return is_range(p, 0, 90) || is_range(p, 0, 180) || is_range(p, 90, 270);
}

/* Repeats the first angle behind the last of equal steps. */
static void close_circle(struct photometry *p)
{
    if (is_symmetric(p) || !is_circle(p))
        return;
    memcpy(p->candelas + (size_t)p->horizontal_count * p->vertical_count,
           p->candelas, p->vertical_count * sizeof *p->candelas);
    p->horizontal[p->horizontal_count++] = p->horizontal[0] + 360;
}

static bool read_photometry(struct reader *r, struct photometry *p,
                            struct error *err)
{
    if (!read_tilt(r, err) || !read_header(r, p, err))
        return false;
    p->vertical = alloc_array(p->vertical_count, sizeof *p->vertical);
    p->horizontal = alloc_array(p->horizontal_count + 1, sizeof *p->horizontal);
    p->candelas =
        alloc_array((size_t)p->vertical_count * (p->horizontal_count + 1),
                    sizeof *p->candelas);
    if (p->vertical == NULL || p->horizontal == NULL || p->candelas == NULL)
        return fail(err, "%s: out of memory", r->path);
    if (!read_angles(r, 180, "a vertical angle from 0 to 180", p->vertical,
                     p->vertical_count, err) ||
        !read_angles(r, 360, "a horizontal angle from 0 to 360", p->horizontal,
                     p->horizontal_count, err) ||
        !check_range(r, p, err) || !read_candelas(r, p, err))
        return false;
    close_circle(p);
    return true;
}

/* Finds the place of an angle among others: *low is the index before it, and
 * the result how far it is to the next. Outside it is the nearer end. */
static double find_place(const double *angles, uint32_t count, double angle,
                         uint32_t *low)
{
    uint32_t i = 0;

    while (i + 2 < count && angles[i + 1] <= angle)
        i++;
    *low = i;
    if (count < 2)
        return 0;
    return fmin(fmax((angle - angles[i]) / (angles[i + 1] - angles[i]), 0), 1);
}

/* The angle of the file that stands for one of the full circle. */
static double fold(const struct photometry *p, double angle)
{
    if (p->horizontal_count == 1)
        return 0;
    if (is_range(p, 0, 90))
        angle = fabs(fmod(angle + 90, 180) - 90);
    else if (is_range(p, 0, 180))
        angle = angle > 180 ? 360 - angle : angle;
    else if (is_range(p, 90, 270))
        angle = angle < 90 ? 180 - angle : angle > 270 ? 540 - angle : angle;
    else if (angle < p->horizontal[0])
        angle += 360;
    return angle;
}

static double value_at(const struct photometry *p, double vertical,
                       double horizontal)
{
    uint32_t row, column, next;
    double down, right;
    const double *low, *high;

    if (vertical < p->vertical[0] ||
        vertical > p->vertical[p->vertical_count - 1])
        return 0;
    down = find_place(p->vertical, p->vertical_count, vertical, &row);
    right = find_place(p->horizontal, p->horizontal_count, fold(p, horizontal),
                       &column);
    next = column + 1 < p->horizontal_count ? 1 : 0;
    low = p->candelas + (size_t)column * p->vertical_count + row;
    high = low + (size_t)next * p->vertical_count;
    next = row + 1 < p->vertical_count ? 1 : 0;
    return (1 - right) * ((1 - down) * low[0] + down * low[next]) +
           right * ((1 - down) * high[0] + down * high[next]);
}

static struct profile *make_profile(const struct photometry *p,
                                    const char *path, struct error *err)
{
    uint32_t columns = p->horizontal_count == 1 ? 1 : COLUMNS;
    struct profile *made = profile_create(path, columns);

    if (made == NULL) {
        fail(err, "%s: out of memory", path);
        return NULL;
    }
    for (uint32_t row = 0; row < PROFILE_ROWS; row++)
        for (uint32_t i = 0; i < columns; i++)
            made->values[row * columns + i] =
                (float)value_at(p, row * 180.0 / (PROFILE_ROWS - 1),
                                i * 360.0 / columns);
    return made;
}

struct profile *ies_parse(const char *text, size_t size_bytes, const char *path,
                          struct error *err)
{
    struct reader r = {path, text, text + size_bytes, 1};
    struct photometry p = {.vertical = NULL};
    struct profile *profile =
        read_photometry(&r, &p, err) ? make_profile(&p, path, err) : NULL;

    free(p.vertical);
    free(p.horizontal);
    free(p.candelas);
    return profile;
}

struct profile *ies_read(const char *path, struct error *err)
{
    struct profile *profile;
    size_t size_bytes;
    char *text;

    if (!text_file_read(path, &text, &size_bytes, err))
        return NULL;
    profile = ies_parse(text, size_bytes, path, err);
    free(text);
    return profile;
}
