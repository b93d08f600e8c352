// SPDX-License-Identifier: MIT
#include "render/cluster/band.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "film/film.h"
#include "film/film_pack.h"

/* ---- plans ---- */

/* A band has this part of a rank's share of the rows that are left. */
#define ROWS_PART 4

/* The last of this many parts of a pass. */
#define LAST_PART 4

/* Bands of BAND_ROWS for each rank, at least. */
#define BANDS_MIN 8

static int divide_up(int a, int b)
{
    return (a + b - 1) / b;
}

struct band_plan band_plan_begin(const struct film *film,
                                 const struct pass *pass, int ranks,
                                 int most_rows)
{
    int slices =
        divide_up(BANDS_MIN * ranks, divide_up(film->height, BAND_ROWS));
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

/* ---- bands ---- */

bool band_init(struct band *b, int width, const struct band_range *range,
               bool has_surfaces, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)range->rows;
    bool has_shares = range->pass.shares != NULL;

    *b = (struct band){.range = *range};
    if (!film_init(&b->film, width, range->rows, err) ||
        (has_surfaces && !film_init_surfaces(&b->film, err)))
        return false;
    b->before = alloc_array(pixels, sizeof *b->before);
    if (has_shares)
        b->shares = alloc_array(pixels, sizeof *b->shares);
    b->range.pass.shares = b->shares;
    return (b->before != NULL && has_shares == (b->shares != NULL)) ||
           fail(err, "out of memory for %d rows of the picture", range->rows);
}

void band_take(struct band *b, const struct film *film,
               const struct band_range *range)
{
    size_t at = (size_t)range->y * (size_t)film->width;
    size_t pixels = (size_t)film->width * (size_t)range->rows;

    for (size_t i = 0; i < pixels; i++)
        b->before[i] = band_plan_before(film, range, at + i);
    if (b->shares != NULL)
        memcpy(b->shares, range->pass.shares + at, pixels * sizeof *b->shares);
}

/* Copies the rows of a band from the light of the whole film. */
static bool cut_light(const struct band *b, struct pass_light *light,
                      float **pixels, struct error *err)
{
    const struct pass_light *whole = b->range.pass.light;
    size_t count = (size_t)b->film.width * (size_t)b->film.height;
    size_t at = (size_t)b->range.y * (size_t)b->film.width;

    *light = *whole;
    if (whole->pixel_count == 0)
        return true;
    *pixels = alloc_array(count, 6 * sizeof **pixels);
    if (*pixels == NULL)
        return fail(err, "out of memory for light paths");
    for (size_t half = 0; half < 2; half++)
        memcpy(*pixels + half * 3 * count,
               whole->pixels + 3 * (half * whole->pixel_count + at),
               3 * count * sizeof **pixels);
    light->pixels = *pixels;
    light->pixel_count = count;
    return true;
}

/* Renders the pass of a band in shorter ones if it is too long for a backend.
 */
static enum pass_result render_passes(const struct band *b,
                                      const struct pass_light *light,
                                      struct backend *backend,
                                      const struct cancel *cancel,
                                      struct error *err)
{
    const struct pass *whole = &b->range.pass;
    uint64_t left = pass_mean(whole);
    enum pass_result result;

    do {
        uint64_t mean = left < PASS_MEAN_MAX ? left : PASS_MEAN_MAX;
        struct pass pass = pass_with(*whole, whole->target - left + mean, mean);

        pass.light = light;
        result = backend->pass(backend, &pass, cancel, err);
        left -= mean;
    } while (left > 0 && result == PASS_DONE);
    return result;
}

enum pass_result band_render(struct band *b, struct backend *backend,
                             const struct backend_picture *whole,
                             uint64_t first_sample, const struct cancel *cancel,
                             struct error *err)
{
    struct film *f = &b->film;
    struct backend_picture part = *whole;
    size_t pixels = (size_t)f->width * (size_t)f->height;
    bool has_light = b->range.pass.light != NULL;
    struct pass_light light;
    float *light_pixels = NULL;
    enum pass_result result;

    if (has_light && !cut_light(b, &light, &light_pixels, err))
        return PASS_FAILED;

    /* the backend goes on from these numbers of samples with sums of 0; their
     * total makes the film one that has samples */
    f->first_sample = first_sample;
    for (size_t i = 0; i < pixels; i++) {
        f->counts[i] = b->before[i];
        atomic_fetch_add(&f->samples, b->before[i]);
    }
    part.film = f;
    part.y0 += b->range.y;
    result =
        backend->begin(backend, &part, err)
            ? render_passes(b, has_light ? &light : NULL, backend, cancel, err)
            : PASS_FAILED;
    free(light_pixels);
    for (size_t i = 0; i < pixels; i++) {
        f->counts[i] -= b->before[i];
        atomic_fetch_sub(&f->samples, b->before[i]);
    }
    return result;
}

void band_free(struct band *b)
{
    film_free(&b->film);
    free(b->before);
    free(b->shares);
    *b = (struct band){0};
}

/* ---- answers ---- */

struct band_answer *band_answer_make(struct band *b, uint32_t epoch,
                                     const char *error, size_t *size)
{
    struct film *f = &b->film;
    uint64_t samples = atomic_load(&f->samples);
    struct band_answer *a;

    *size = sizeof *a;
    a = samples > 0 ? (struct band_answer *)film_pack(f, sizeof *a, size)
                    : alloc_array(1, sizeof *a);
    if (a == NULL)
        return NULL;
    *a = (struct band_answer){.epoch = epoch,
                              .has_failed = error[0] != '\0',
                              .y = b->range.y,
                              .rows = b->range.rows,
                              .first = b->range.first,
                              .samples = samples,
                              .rays = atomic_load(&f->rays),
                              .non_finite = atomic_load(&f->non_finite),
                              .saturated = atomic_load(&f->saturated),
                              .cut_paths = atomic_load(&f->cut_paths)};
    snprintf(a->error, sizeof a->error, "%.255s", error);
    return a;
}

static void set_counters(struct film *f, const struct band_answer *a)
{
    atomic_store(&f->samples, a->samples);
    atomic_store(&f->rays, a->rays);
    atomic_store(&f->non_finite, a->non_finite);
    atomic_store(&f->saturated, a->saturated);
    atomic_store(&f->cut_paths, a->cut_paths);
}

bool band_answer_add(const struct band_answer *a, size_t size,
                     struct film *film, struct error *err)
{
    const uint8_t *from = (const uint8_t *)(a + 1);
    const uint8_t *end = (const uint8_t *)a + size;
    struct film row = {0};
    bool ok = film_init(&row, film->width, 1, err) &&
              (film->surfaces == NULL || film_init_surfaces(&row, err));

    if (ok) /* with the first row */
        set_counters(&row, a);
    for (int y = a->y; ok && y < a->y + a->rows; y++) {
        ok = film_unpack_row(&row, &from, end, err);
        if (ok)
            film_merge(film, y, &row);
        set_counters(&row, &(struct band_answer){0});
    }
    film_free(&row);
    return ok;
}

/* ---- the thread ---- */

struct band_thread {
    pthread_t thread;
    bool is_busy; /* the owner's */
    pthread_mutex_t lock;
    pthread_cond_t begin, done;
    /* guarded by lock */
    bool has_work, is_done, is_ending;
    struct band_work work;
    enum pass_result result;
    struct error error;
};

static void *run(void *argument)
{
    struct band_thread *t = argument;

    pthread_mutex_lock(&t->lock);
    for (;;) {
        struct band_work w;
        enum pass_result result;
        struct error err = {""};

        while (!t->has_work && !t->is_ending)
            pthread_cond_wait(&t->begin, &t->lock);
        if (!t->has_work)
            break;
        t->has_work = false;
        w = t->work;
        pthread_mutex_unlock(&t->lock);
        result = band_render(w.band, w.backend, &w.whole, w.first_sample,
                             w.cancel, &err);
        pthread_mutex_lock(&t->lock);
        t->result = result;
        t->error = err;
        t->is_done = true;
        pthread_cond_signal(&t->done);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

struct band_thread *band_thread_create(struct error *err)
{
    struct band_thread *t = alloc_array(1, sizeof *t);
    int reason;

    if (t == NULL) {
        fail(err, "out of memory for a thread");
        return NULL;
    }
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->begin, NULL);
    thread_condition_init(&t->done);
    reason = thread_start(&t->thread, run, t);
    if (reason == 0)
        return t;
    fail(err, "cannot start a thread: %s", strerror(reason));
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->done);
    free(t);
    return NULL;
}

void band_thread_begin(struct band_thread *t, const struct band_work *work)
{
    pthread_mutex_lock(&t->lock);
    t->work = *work;
    t->has_work = true;
    t->is_busy = true;
    pthread_cond_signal(&t->begin);
    pthread_mutex_unlock(&t->lock);
}

struct band *band_thread_end(struct band_thread *t, enum pass_result *result,
                             struct error *err)
{
    struct band *band = NULL;

    pthread_mutex_lock(&t->lock);
    if (t->is_done) {
        band = t->work.band;
        *result = t->result;
        if (t->result == PASS_FAILED)
            *err = t->error;
        t->is_done = false;
        t->is_busy = false;
    }
    pthread_mutex_unlock(&t->lock);
    return band;
}

bool band_thread_is_busy(const struct band_thread *t)
{
    return t->is_busy;
}

void band_thread_wait(struct band_thread *t, long timeout_ns)
{
    struct timespec until = clock_time_after(timeout_ns);
    int reason = 0;

    pthread_mutex_lock(&t->lock);
    while (!t->is_done && reason == 0)
        reason = pthread_cond_timedwait(&t->done, &t->lock, &until);
    pthread_mutex_unlock(&t->lock);
}

void band_thread_destroy(struct band_thread *t)
{
    if (t == NULL)
        return;
    pthread_mutex_lock(&t->lock);
    t->is_ending = true;
    pthread_cond_signal(&t->begin);
    pthread_mutex_unlock(&t->lock);
    pthread_join(t->thread, NULL);
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->done);
    free(t);
}
