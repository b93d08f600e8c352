// SPDX-License-Identifier: MIT
#include "render/cluster/band_plan.h"

/* A band has this part of a rank's share of the rows that are left. */
#define ROWS_PART 4

/* The last of this many parts of a pass. */
#define LAST_PART 4

/* Bands of BAND_ROWS for each rank, at least. */
#define BANDS_LEAST 8

static int divide_up(int a, int b)
{
    return (a + b - 1) / b;
}

struct band_plan band_plan_begin(const struct film *film,
                                 const struct pass *pass, int ranks,
                                 int most_rows)
{
    int slices =
        divide_up(BANDS_LEAST * ranks, divide_up(film->height, BAND_ROWS));
    int most = (int)(pass_mean(pass) / SAMPLE_BLOCK);

    if (slices > most)
        slices = most > 1 ? most : 1;
    return (struct band_plan){.film = film,
                              .pass = *pass,
                              .ranks = ranks,
                              .most_rows = most_rows,
                              .slices = slices};
}

/* Returns the samples before a slice, or after the last one. */
static uint64_t slice_begin(const struct band_plan *p, int slice)
{
    uint64_t later = (uint64_t)(p->slices - slice);

    return p->pass.target - pass_mean(&p->pass) * later / (uint64_t)p->slices;
}

/* Returns the pass of the next slice. */
static struct pass slice_pass(const struct band_plan *p)
{
    uint64_t begin = slice_begin(p, p->slice);
    uint64_t end = slice_begin(p, p->slice + 1);

    return pass_with(p->pass, end, end - begin);
}

static bool row_is_done(const struct film *f, const struct pass *pass, int y)
{
    size_t at = (size_t)y * (size_t)f->width;

    for (int x = 0; x < f->width; x++, at++)
        if (f->counts[at] < pass_target(pass, at))
            return false;
    return true;
}

/* Returns the rows of this slice and of later ones that are in no band. */
static int rows_left(const struct band_plan *p)
{
    return (p->slices - p->slice) * p->film->height - p->y;
}

/* Moves on by rows of this slice. */
static void move(struct band_plan *p, int rows)
{
    p->y += rows;
    if (p->y == p->film->height && p->slice + 1 < p->slices) {
        p->slice++;
        p->y = 0;
    }
}

/* Moves to the next row that lacks samples. */
static void skip_done(struct band_plan *p)
{
    struct pass pass = slice_pass(p);

    while (!band_plan_is_empty(p) && row_is_done(p->film, &pass, p->y)) {
        move(p, 1);
        pass = slice_pass(p);
    }
}

bool band_plan_next(struct band_plan *p, struct band_range *range)
{
    int rows;

    skip_done(p);
    if (band_plan_is_empty(p))
        return false;
    p->y -= p->y % BAND_ROWS;
    rows = rows_left(p) / (ROWS_PART * p->ranks);
    rows = rows < p->most_rows ? rows : p->most_rows;
    rows = rows < BAND_ROWS ? BAND_ROWS : rows - rows % BAND_ROWS;
    if (rows > p->film->height - p->y)
        rows = p->film->height - p->y;
    *range =
        (struct band_range){.y = p->y, .rows = rows, .pass = slice_pass(p)};
    if (p->slice > 0) /* the first begins with whatever pixels have */
        range->first = slice_begin(p, p->slice);
    move(p, rows);
    return true;
}

bool band_plan_is_ending(const struct band_plan *p)
{
    return rows_left(p) <= p->slices * p->film->height / LAST_PART;
}

bool band_plan_is_empty(const struct band_plan *p)
{
    return rows_left(p) == 0;
}

uint64_t band_plan_before(const struct film *film,
                          const struct band_range *range, size_t at)
{
    struct pass before = range->pass;
    uint64_t count = film->counts[at], target;

    before.target = range->first;
    target = pass_target(&before, at);
    return count > target ? count : target;
}

bool band_plan_is_next(const struct film *film, const struct band_range *range)
{
    size_t at = (size_t)range->y * (size_t)film->width;
    size_t end = at + (size_t)range->rows * (size_t)film->width;

    for (; at < end; at++)
        if (film->counts[at] < band_plan_before(film, range, at))
            return false;
    return true;
}
