// SPDX-License-Identifier: MIT
#include "studio/comparison.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "image/frame.h"
#include "render/error_text.h"
#include "terminal/dither.h"

/* ---- kept renders ---- */

/* Least width and height of a block in pixels: a sum of fewer e^2 says little
 * of the variance. */
#define BLOCK_MIN 8

/* Pixels that are read for differences, some 40 ms. */
#define PIXELS_READ (1 << 19)

/* Relative difference that rounding may cause where there is no noise. */
#define ROUNDING 1e-5

/* Pictures with a marked block although only their noise differs. */
#define FALSE_ALARMS 0.05

bool snapshot_take(struct snapshot *k, struct film *film, struct error *err)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    float *means = alloc_array(3 * count, sizeof *means);

    *k = (struct snapshot){.width = film->width, .height = film->height};
    k->pixels = alloc_array(count, sizeof *k->pixels);
    if (!means || !k->pixels) {
        free(means);
        snapshot_free(k);
        return fail(err, "out of memory to keep a render of %dx%d pixels",
                    film->width, film->height);
    }
    film_linear(film, means);
    for (size_t i = 0; i < count; i++) {
        struct snapshot_pixel *p = &k->pixels[i];
        int y = (int)(i / (size_t)film->width);

        *p = (struct snapshot_pixel){.is_known = 1.0f};
        film_lock_row(film, y);
        if (!film_pixel_error(film, i, p->mean, p->e))
            *p = (struct snapshot_pixel){
                .mean = {means[3 * i], means[3 * i + 1], means[3 * i + 2]}};
        film_unlock_row(film, y);
    }
    free(means);
    return true;
}

uint64_t snapshot_bytes(const struct snapshot *k)
{
    return (uint64_t)k->width * (uint64_t)k->height * sizeof *k->pixels;
}

void snapshot_free(struct snapshot *k)
{
    free(k->pixels);
    frame_free(&k->shown);
    *k = (struct snapshot){.pixels = NULL};
}

/* ---- painting ---- */

/* Adds what a pixel shows: linear light after the tone curve, at most 1. */
static void add_shown(const struct snapshot_pixel *p, float factor,
                      uint32_t tone, float weight, float sum[3])
{
    float rgb[4] = {factor * p->mean[0], factor * p->mean[1],
                    factor * p->mean[2], 0.0f};

    if (tone != TONE_LINEAR)
        tone_curve(tone, rgb);
    for (int c = 0; c < 3; c++)
        sum[c] += weight * f_min(rgb[c], 1.0f);
}

static void paint_pixel(const struct snapshot *k, struct develop how, int x,
                        int y, const struct frame *frame, uint8_t *bytes)
{
    struct area_walk rows = area_walk(k->height, frame->height, y, 1);
    float factor = develop_factor(how);
    float area = (float)k->width * (float)k->height;
    float sum[3] = {0.0f, 0.0f, 0.0f};

    while (area_walks(&rows)) {
        struct area_walk columns = area_walk(k->width, frame->width, x, 1);
        const struct snapshot_pixel *row =
            k->pixels + (size_t)rows.from * (size_t)k->width;
        float height = area_step(&rows);

        while (area_walks(&columns)) {
            const struct snapshot_pixel *p = row + columns.from;

            add_shown(p, factor, how.tone, height * area_step(&columns) / area,
                      sum);
        }
    }
    for (int c = 0; c < 3; c++)
        bytes[c] = (uint8_t)srgb_byte(sum[c]);
}

void snapshot_paint(const struct snapshot *k, struct develop how,
                    struct frame *frame)
{
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++)
            paint_pixel(k, how, x, y, frame,
                        frame->rgb +
                            3 * ((size_t)y * (size_t)frame->width + (size_t)x));
}

/* ---- differences ---- */

/* Sums over the pixels of a block that were read. */
struct sums {
    double difference[3]; /* of film and kept render */
    double variance[3];
    double both; /* all channels of both */
    bool is_unknown;
};

static void add_pixel(struct sums *s, const struct snapshot_pixel *before,
                      const struct film *film, size_t at)
{
    float mean[3], e[3];

    if (before->is_known == 0.0f || !film_pixel_error(film, at, mean, e)) {
        s->is_unknown = true;
        return;
    }
    for (int c = 0; c < 3; c++) {
        double v[2] = {(double)e[c], (double)before->e[c]};

        s->difference[c] += (double)mean[c] - (double)before->mean[c];
        s->variance[c] += v[0] * v[0] + v[1] * v[1];
        s->both += (double)mean[c] + (double)before->mean[c];
    }
}

static struct snapshot_block block_of(const struct sums *s, double bound)
{
    struct snapshot_block block = {0.0f, false};
    double all = 0;

    if (s->is_unknown)
        return block;
    for (int c = 0; c < 3; c++) {
        all += s->difference[c];
        if (fabs(s->difference[c]) >
            bound * sqrt(s->variance[c]) + ROUNDING * s->both)
            block.is_significant = true;
    }
    if (s->both > 0)
        block.difference = (float)(2 * all / s->both);
    return block;
}

static bool alloc_blocks(struct snapshot_blocks *b, const struct snapshot *k,
                         int cols, int rows, struct error *err)
{
    int most_cols = k->width / BLOCK_MIN, most_rows = k->height / BLOCK_MIN;

    cols = cols < most_cols ? cols : most_cols;
    rows = rows < most_rows ? rows : most_rows;
    snapshot_blocks_free(b);
    b->cols = cols > 0 ? cols : 1;
    b->rows = rows > 0 ? rows : 1;
    b->blocks =
        alloc_array((size_t)b->cols * (size_t)b->rows, sizeof *b->blocks);
    return b->blocks != NULL || fail(err, "out of memory for differences");
}

bool snapshot_differences(const struct snapshot *k, struct film *film, int cols,
                          int rows, struct snapshot_blocks *b,
                          struct error *err)
{
    size_t pixels = (size_t)k->width * (size_t)k->height;
    int step = 1 + (int)(pixels / PIXELS_READ);
    struct sums *sums;
    double bound;
    int count;

    if (!alloc_blocks(b, k, cols, rows, err))
        return false;
    count = b->cols * b->rows;
    sums = alloc_array((size_t)count, sizeof *sums);
    if (!sums)
        return fail(err, "out of memory for differences");
    for (int y = 0; y < k->height; y += step) {
        struct sums *row =
            sums + (size_t)(y * b->rows / k->height) * (size_t)b->cols;

        film_lock_row(film, y);
        for (int x = 0; x < k->width; x++) {
            size_t at = (size_t)y * (size_t)k->width + (size_t)x;

            add_pixel(&row[x * b->cols / k->width], &k->pixels[at], film, at);
        }
        film_unlock_row(film, y);
    }
    /* the tail of a normal distribution is below exp(-bound^2 / 2) */
    bound = sqrt(2 * log(3 * count / FALSE_ALARMS));
    b->significant_count = 0;
    b->is_unknown = true;
    for (int i = 0; i < count; i++) {
        b->is_unknown = b->is_unknown && sums[i].is_unknown;
        b->blocks[i] = block_of(&sums[i], bound);
        b->significant_count += b->blocks[i].is_significant;
    }
    free(sums);
    return true;
}

void snapshot_blocks_free(struct snapshot_blocks *b)
{
    free(b->blocks);
    *b = (struct snapshot_blocks){.blocks = NULL};
}

/* ---- comparison ---- */

#define WIPE_STEP 0.05

/* Most memory of all kept renders; one is kept whatever it takes. */
#define BYTES_MAX (UINT64_C(512) << 20)

/* Time between two searches for differences. */
#define SEARCH_NS UINT64_C(500000000)

/* Width of a kept render in the strip, as a part of the frame's. */
#define STRIP_PART 8

#define LINE_COLOR   0xffffffu
#define CHOSEN_COLOR 0xff9a2eu
#define OTHER_COLOR  0x808080u

/* Brightness of the picture behind the differences. */
#define BEHIND 0.4

/* Relative difference that has the full colour. */
#define FULL 0.25

void comparison_init(struct comparison *c, struct live_render *control)
{
    *c = (struct comparison){.control = control, .wipe = 0.5};
}

static void forget_painted(struct comparison *c)
{
    for (int i = 0; i < COMPARISON_KEPT_MAX; i++) {
        frame_free(&c->painted[i]);
        frame_free(&c->thumbs[i]);
    }
    c->width = c->height = 0;
    c->blocks_ns = 0;
}

/* Removes kept render i. */
static void drop(struct comparison *c, int i)
{
    snapshot_free(&c->kept[i]);
    memmove(&c->kept[i], &c->kept[i + 1],
            (size_t)(c->count - i - 1) * sizeof c->kept[0]);
    c->kept[--c->count] = (struct snapshot){.pixels = NULL};
    if (c->chosen >= i && c->chosen > 0)
        c->chosen--;
    forget_painted(c);
}

static struct film *film_of(const struct comparison *c)
{
    return render_film(c->control->session->engine.render);
}

/* Removes renders of another size, as a reload may leave them. */
static void drop_others(struct comparison *c)
{
    const struct film *film = film_of(c);

    for (int i = c->count - 1; i >= 0; i--)
        if (c->kept[i].width != film->width ||
            c->kept[i].height != film->height)
            drop(c, i);
    if (c->count == 0)
        c->mode = COMPARISON_OFF;
}

/* ---- legend ---- */

static void format_legend(struct comparison *c)
{
    const struct snapshot *k = &c->kept[c->chosen];
    char noise[ERROR_TEXT_BYTES], share[16] = "";

    c->legend[0] = '\0';
    if (c->mode == COMPARISON_OFF)
        return;
    error_text_noise(noise, &k->error);
    if (c->blocks.blocks)
        snprintf(share, sizeof share, " in %.1f %%",
                 100.0 * c->blocks.significant_count /
                     (c->blocks.cols * c->blocks.rows));
    if (c->mode == COMPARISON_WIPE)
        snprintf(c->legend, sizeof c->legend,
                 "COMPARE  left: kept %d of %d, %" PRIu64
                 " spp, %.40s; right: now",
                 c->chosen + 1, c->count, k->spp, noise);
    else if (c->blocks.is_unknown)
        snprintf(c->legend, sizeof c->legend,
                 "DIFFERENCES  to kept %d of %d: two samples of each pixel are "
                 "needed in both",
                 c->chosen + 1, c->count);
    else
        snprintf(
            c->legend, sizeof c->legend,
            "DIFFERENCES  to kept %d of %d%s: red is brighter, blue darker",
            c->chosen + 1, c->count, share);
}

/* Shows what has changed. */
static void change(struct comparison *c)
{
    c->blocks_ns = 0;
    snapshot_blocks_free(&c->blocks);
    format_legend(c);
    c->control->has_changed = true;
}

/* ---- actions ---- */

void comparison_keep(struct comparison *c, struct frame *shown)
{
    const struct render_progress *p = &c->control->progress;
    struct snapshot kept;
    struct error err;

    drop_others(c);
    if (p->samples == 0) {
        live_render_say(c->control, "nothing to keep yet");
        return;
    }
    if (!snapshot_take(&kept, film_of(c), &err)) {
        live_render_say_error(c->control, err.text);
        return;
    }
    while (c->count == COMPARISON_KEPT_MAX ||
           (c->count > 0 &&
            (uint64_t)(c->count + 1) * snapshot_bytes(&kept) > BYTES_MAX))
        drop(c, 0);
    kept.spp = p->spp_done;
    kept.error = p->film_error;
    kept.shown = *shown;
    kept.develop = session_develop(c->control->session);
    *shown = (struct frame){.rgb = NULL};
    c->kept[c->count] = kept;
    c->chosen = c->count++;
    c->mode = COMPARISON_WIPE;
    forget_painted(c);
    change(c);
    live_render_say(c->control, "kept render %d: %s shows differences, %s ends",
                    c->count, live_render_key(c->control, ACTION_COMPARE).text,
                    live_render_key(c->control, ACTION_CANCEL).text);
}

void comparison_next(struct comparison *c)
{
    drop_others(c);
    if (c->count == 0) {
        live_render_say(c->control,
                        "no render is kept: %s keeps the present one",
                        live_render_key(c->control, ACTION_KEEP_RENDER).text);
        return;
    }
    c->mode = (enum comparison_mode)((c->mode + 1) % COMPARISON_MODES);
    live_render_clear_message(c->control);
    change(c);
}

void comparison_wipe_to(struct comparison *c, double part)
{
    c->wipe = fmin(fmax(part, 0), 1);
    c->mode = COMPARISON_WIPE;
    change(c);
}

static void choose(struct comparison *c, int by)
{
    c->chosen = (c->chosen + by + c->count) % c->count;
    change(c);
}

bool comparison_takes(struct comparison *c, enum action action)
{
    if (c->mode == COMPARISON_OFF)
        return false;
    switch (action) {
    case ACTION_LOOK_LEFT: comparison_wipe_to(c, c->wipe - WIPE_STEP); break;
    case ACTION_LOOK_RIGHT: comparison_wipe_to(c, c->wipe + WIPE_STEP); break;
    case ACTION_LOOK_UP: choose(c, -1); break;
    case ACTION_LOOK_DOWN: choose(c, 1); break;
    case ACTION_CANCEL:
        c->mode = COMPARISON_OFF;
        live_render_clear_message(c->control);
        change(c);
        break;
    default: return false;
    }
    return true;
}

/* ---- painting ---- */

static bool is_same(struct develop a, struct develop b)
{
    return a.tone == b.tone && !(a.exposure < b.exposure) &&
           !(a.exposure > b.exposure);
}

/* Paints kept render i in the size of the frame, and small. */
static bool paint_kept(struct comparison *c, int i, const struct frame *frame)
{
    int width = frame->width / STRIP_PART, height = frame->height / STRIP_PART;
    struct error ignored;

    if (c->painted[i].rgb)
        return true;
    if (!frame_init(&c->painted[i], frame->width, frame->height, &ignored) ||
        !frame_init(&c->thumbs[i], width > 0 ? width : 1,
                    height > 0 ? height : 1, &ignored)) {
        frame_free(&c->painted[i]);
        return false;
    }
    if (c->kept[i].shown.rgb != NULL && is_same(c->kept[i].develop, c->develop))
        frame_scale(&c->kept[i].shown, &c->painted[i]);
    else
        snapshot_paint(&c->kept[i], c->develop, &c->painted[i]);
    snapshot_paint(&c->kept[i], c->develop, &c->thumbs[i]);
    return true;
}

static void copy_columns(const struct frame *from, struct frame *to, int x0,
                         int y0, int count)
{
    for (int y = 0; y < from->height && y0 + y < to->height; y++)
        memcpy(to->rgb +
                   3 * ((size_t)(y0 + y) * (size_t)to->width + (size_t)x0),
               from->rgb + 3 * (size_t)y * (size_t)from->width,
               3 * (size_t)count);
}

static void paint_wipe(struct comparison *c, struct frame *frame)
{
    int x = (int)(c->wipe * frame->width + 0.5);

    if (!paint_kept(c, c->chosen, frame))
        return;
    copy_columns(&c->painted[c->chosen], frame, 0, 0, x);
    if (x > 0 && x < frame->width)
        frame_line(frame, x, 0, x, frame->height - 1, LINE_COLOR);
}

static uint8_t dim_grey(const uint8_t *rgb)
{
    struct rgb c = {rgb[0], rgb[1], rgb[2]};

    return (uint8_t)(BEHIND * rgb_brightness(c));
}

/* Mixes a colour into grey. */
static void mark(uint8_t *rgb, double difference)
{
    double share = fmin(0.35 + 0.65 * fabs(difference) / FULL, 1);
    double grey = dim_grey(rgb);
    double color[3] = {difference > 0 ? 255 : 40, 60,
                       difference > 0 ? 40 : 255};

    for (int i = 0; i < 3; i++)
        rgb[i] = (uint8_t)(grey + share * (color[i] - grey));
}

static void paint_differences(struct comparison *c, struct frame *frame)
{
    uint64_t now_ns = clock_ns();
    struct error ignored;

    if (c->blocks_ns == 0 || now_ns >= c->blocks_ns + SEARCH_NS) {
        if (!snapshot_differences(&c->kept[c->chosen], film_of(c), frame->width,
                                  frame->height, &c->blocks, &ignored))
            return;
        c->blocks_ns = now_ns;
        format_legend(c);
    }
    for (int y = 0; frame_has_row(frame, y); y++) {
        for (int x = 0; x < frame->width; x++) {
            uint8_t *rgb = frame->rgb + 3 * (y * frame->width + x);
            const struct snapshot_block *b =
                &c->blocks.blocks[y * c->blocks.rows / frame->height *
                                      c->blocks.cols +
                                  x * c->blocks.cols / frame->width];

            if (b->is_significant)
                mark(rgb, (double)b->difference);
            else
                rgb[0] = rgb[1] = rgb[2] = dim_grey(rgb);
        }
    }
}

static void paint_strip(struct comparison *c, struct frame *frame)
{
    for (int i = 0; i < c->count && paint_kept(c, i, frame); i++) {
        const struct frame *thumb = &c->thumbs[i];
        int x = 1 + i * (thumb->width + 2);
        int y = frame->height - thumb->height - 1;

        if (x + thumb->width + 1 > frame->width || y < 1)
            return;
        copy_columns(thumb, frame, x, y, thumb->width);
        frame_box(frame, x - 1, y - 1, x + thumb->width, y + thumb->height,
                  i == c->chosen ? CHOSEN_COLOR : OTHER_COLOR);
    }
}

void comparison_paint(struct comparison *c, struct frame *frame)
{
    struct develop how = session_develop(c->control->session);

    drop_others(c);
    if (c->mode == COMPARISON_OFF)
        return;
    if (c->width != frame->width || c->height != frame->height ||
        !is_same(c->develop, how)) {
        forget_painted(c);
        c->width = frame->width;
        c->height = frame->height;
        c->develop = how;
    }
    if (c->mode == COMPARISON_WIPE)
        paint_wipe(c, frame);
    else
        paint_differences(c, frame);
    paint_strip(c, frame);
}

void comparison_free(struct comparison *c)
{
    forget_painted(c);
    for (int i = 0; i < c->count; i++)
        snapshot_free(&c->kept[i]);
    snapshot_blocks_free(&c->blocks);
}
