// SPDX-License-Identifier: MIT
#include "studio/comparison.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "render/error_text.h"
#include "terminal/dither.h"

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

void comparison_keep(struct comparison *c)
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
        c->develop.tone != how.tone || c->develop.exposure < how.exposure ||
        c->develop.exposure > how.exposure) {
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
