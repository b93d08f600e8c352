// SPDX-License-Identifier: MIT
/*
 * screen_filter.h - the denoising filter for the screen of live mode
 *
 * The filter works at the size of the draft, which is at most that of the
 * screen, on the mean of draft and film over each pixel of the draft. Features
 * are those of the draft's first surfaces; the film needs none. Direct and
 * indirect light are filtered together.
 *
 * A picture whose film is young is filtered in fewer levels, which is faster.
 *
 * A frame with more pixels than the draft shows the enlarged result, to which
 * the film's detail is added (screen_halves.h).
 *
 * Lamps and the sky are shown without the filter, as the draft's pixels see
 * them. Pixels that the filter hardly changes, with their neighbours, are shown
 * as film_preview() shows them; so the filter ends as noise vanishes. Without a
 * film they show the draft.
 *
 * Ownership: screen_filter_free() frees; a zeroed struct is empty
 * Threads:   one at a time; the films' rows are locked one by one
 * Errors:    out of memory
 */
#ifndef GLIM_SCREEN_FILTER_H
#define GLIM_SCREEN_FILTER_H

#include "film/filter/filter.h"
#include "film/filter/screen_halves.h"

struct screen_filter {
    struct filter filter;
    struct screen_halves halves;
    struct screen_detail detail;   /* of a frame with more pixels */
    int width, height;             /* of the draft; 0: no memory yet */
    int shown_width, shown_height; /* of the frame, or of a smaller film */
    float *memory;
    /* for each pixel: the share of light that is seen, and the change by the
     * filter in steps of 255 */
    float *seen, *change;
    /* 3 numbers for each pixel: unfiltered, filtered, and half the difference
     * of the filtered halves */
    float *raw, *rgb, *difference;
    double error; /* of the last frame, estimated; see SCREEN_FILTER_ERROR */
    /* the row that is processed */
    float *rows;
    float *changes, *shares, *largest;
    uint8_t *raw_bytes, *filtered_bytes;
};

/* Most pixels of a draft that is worth its time for the screen. */
#define SCREEN_FILTER_PIXELS (400 * 240)

/*
 * The error of a filtered picture is what noise leaves in it, which the
 * difference of its halves tells, and what the filter blurs, which nothing
 * tells. Of five scenes (cornell, interior, glass_mirror, skylit, materials), 0
 * to 64 samples a pixel, the root mean square of both was 1.3 to 2.3 times that
 * of the noise, both relative as in film_error.h. The estimate is that noise
 * times this factor. Light that is seen has no error.
 */
#define SCREEN_FILTER_ERROR 1.8

/* Sets the size of a draft for a frame of pixels, which is that of the frame or
 * a smaller one of nearly its shape with `most` pixels at most. */
void screen_filter_draft_size(int frame_width, int frame_height, int most,
                              int *width, int *height);

/* The films of a picture on the screen. */
struct screen_films {
    struct film *film;
    /* the draft with surfaces, each pixel of which has a sample, or NULL; its
     * light counts in the filtered picture */
    struct film *surfaces;
    struct film *draft; /* the same or NULL, as for film_preview() */
};

/* Fills a frame as film_preview() does, but filtered. Returns false and leaves
 * the frame as it is without memory, or if `surfaces` has more pixels than the
 * frame along an axis. Blocks. */
bool screen_filter_show(struct screen_filter *f,
                        const struct screen_films *films, struct develop how,
                        enum filter_form form, struct frame *frame);

void screen_filter_free(struct screen_filter *f);

#endif
