// SPDX-License-Identifier: MIT
/*
 * band.h - bands of a film's rows: the order in which ranks get them, the
 * samples that a rank renders in a film of its own, the message that it
 * answers, and the thread that renders them while its owner serves messages
 *
 * Units:     pixels, rows of a film, mean samples per pixel
 * Ownership: band_free() and band_thread_destroy() free; a zeroed struct band
 *            is empty; what a band is rendered from is borrowed until it is
 *            done; the caller frees answers
 * Threads:   one at a time
 * Errors:    out of memory, errors of the backend, damaged bytes, no thread
 */
#ifndef GLIM_BAND_H
#define GLIM_BAND_H

#include "render/backend.h"

/*
 * A pass is divided into bands of rows. Each band is a part of a rank's share
 * of the rows that are left, so that bands are large at first and small at the
 * end, and a slow rank gets fewer of them. If there are too few rows for the
 * ranks, the samples of the pass are divided, too, into slices, which are
 * handed out one after the other. Sums are integers, so the bands can be added
 * to the whole film in any order (film_merge()).
 */

/* ---- plans ---- */

/* The first row of a band is a multiple of this. */
#define BAND_ROWS 2

/* A band: rows in which the pixels get the samples of a slice. */
struct band_range {
    int y, rows;
    uint64_t first; /* samples at the beginning of the slice: as pass.target */
    struct pass pass; /* of the slice */
};

struct band_plan {
    const struct film *film;
    struct pass pass;
    int ranks;
    int most_rows; /* of a band, for the size of messages */
    int slices;
    int slice, y; /* the next band */
};

/* Begins the plan for a pass over the film, of which nobody has more. */
struct band_plan band_plan_begin(const struct film *film,
                                 const struct pass *pass, int ranks,
                                 int most_rows);

/* Takes the next band whose pixels lack samples. Returns false if there are no
 * more. */
bool band_plan_next(struct band_plan *p, struct band_range *range);

/* Returns true in the last part of the pass, where ranks would wait for one
 * that has a second band. */
bool band_plan_is_ending(const struct band_plan *p);

/* Returns true if no band is left. */
bool band_plan_is_empty(const struct band_plan *p);

/* Returns the samples of pixel `at` of the film before the slice: those that it
 * will have then, if slices before are in progress. */
uint64_t band_plan_before(const struct film *film,
                          const struct band_range *range, size_t at);

/* Returns true if the film has all samples before those of a band. */
bool band_plan_is_next(const struct film *film, const struct band_range *range);

/* ---- bands ---- */

struct band {
    struct band_range range; /* whose shares are these */
    /* the new samples alone, after band_render() */
    struct film film;
    uint64_t *before; /* samples that the pixels had in the whole film */
    uint16_t *shares; /* of adaptive sampling; NULL: none */
};

/* Makes a band of a film of this width. `before`, and `shares` if the pass has
 * some, are to be filled. */
bool band_init(struct band *b, int width, const struct band_range *range,
               bool has_surfaces, struct error *err);

/* Fills `before` and `shares` from the whole film and the pass. */
void band_take(struct band *b, const struct film *film,
               const struct band_range *range);

/* Renders the band of a picture, whose own film is not used. Its pixels begin
 * with sample first_sample. */
enum pass_result band_render(struct band *b, struct backend *backend,
                             const struct backend_picture *whole,
                             uint64_t first_sample, const struct cancel *cancel,
                             struct error *err);

void band_free(struct band *b);

/* ---- answers ---- */

/* The rows of film_pack() follow if there are samples. */
struct band_answer {
    uint32_t epoch; /* of the band */
    uint32_t has_failed;
    char error[256];
    int y, rows;
    uint64_t first; /* as in struct band_range */
    uint64_t samples, rays, non_finite, saturated, cut_paths;
};

/* Makes the answer for a band with its new samples. `error` is "" or why it
 * failed. *size is that of the message. Returns NULL without memory. */
struct band_answer *band_answer_make(struct band *b, uint32_t epoch,
                                     const char *error, size_t *size);

/* Adds the samples of an answer to the film. */
bool band_answer_add(const struct band_answer *a, size_t size,
                     struct film *film, struct error *err);

/* ---- the thread ---- */

struct band_thread;

/* A band and what it is rendered from. */
struct band_work {
    struct band *band;
    struct backend *backend;
    struct backend_picture whole; /* its film is not used */
    uint64_t first_sample;
    const struct cancel *cancel;
};

struct band_thread *band_thread_create(struct error *err);

/* Starts to render. The thread is idle. */
void band_thread_begin(struct band_thread *t, const struct band_work *work);

/* Returns the band once after it is done, with its result; NULL before. */
struct band *band_thread_end(struct band_thread *t, enum pass_result *result,
                             struct error *err);

/* Returns true between begin and end. */
bool band_thread_is_busy(const struct band_thread *t);

/* Sleeps for this time, or until a band in progress is done. */
void band_thread_wait(struct band_thread *t, long timeout_ns);

/* Waits for the band in progress, if any. */
void band_thread_destroy(struct band_thread *t);

#endif
