// SPDX-License-Identifier: MIT
#include "inspect/view_modes.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "film/film_error.h"
#include "image/frame.h"
#include "inspect/aov_picture.h"
#include "inspect/false_color.h"
#include "render/error_text.h"
#include "render/filtered_picture.h"
#include "render/projection.h"
#include "world/world.h"
#include "kernels/tone.h"

/* Sample kind and legend of each view. */
static const struct {
    enum sample_kind sample;
    const char *legend;
} kinds[SHOW_KINDS] = {
    [SHOW_LIGHT] = {SAMPLE_LIGHT, ""},
    [SHOW_PREVIEW] = {SAMPLE_PREVIEW,
                      "PREVIEW  colours as they are, lit from the eye"},
    [SHOW_NORMALS] = {SAMPLE_NORMAL,
                      "NORMALS  for shading: x red, y green, z blue"},
    [SHOW_FACES] = {SAMPLE_FACE,
                    "FACES  normals as wound: x red, y green, z blue"},
    [SHOW_UVS] = {SAMPLE_UV, "UVS  u red, v green; grey: none"},
    [SHOW_DEPTH] = {SAMPLE_DEPTH, "DEPTH"},
    [SHOW_MATERIALS] = {SAMPLE_MATERIAL, "MATERIALS  a colour for each"},
    [SHOW_COST] = {SAMPLE_PREVIEW, "COST"},
    [SHOW_SAMPLES] = {SAMPLE_LIGHT, "SAMPLES"},
    [SHOW_ERROR] = {SAMPLE_LIGHT, "ERROR"},
};

void view_mode_init(struct view_mode *s, struct session *session)
{
    *s = (struct view_mode){.session = session};
}

enum sample_kind view_mode_sample(enum show_kind kind)
{
    return kinds[kind].sample;
}

static struct develop develop_of(const struct view_mode *s)
{
    return s->kind == SHOW_PREVIEW ? develop_linear(0)
                                   : session_develop(s->session);
}

static bool find_world(const struct view_mode *s, struct world *w,
                       struct error *err)
{
    struct session *of = s->session;

    return world_lend(&of->engine.world, &of->engine.scene, &of->edit.now.view,
                      of->options->seed, w, err);
}

bool view_mode_world(const struct view_mode *s, struct world *w)
{
    struct error ignored;

    return find_world(s, w, &ignored);
}

bool view_mode_traced(struct view_mode *s, struct world *w, struct error *err)
{
    return find_world(s, w, err) &&
           world_ensure_tree(&s->session->engine.world, w, view_mode_pool(s),
                             err);
}

struct camera view_mode_camera(const struct view_mode *s,
                               const struct camera *camera,
                               const struct frame *frame)
{
    struct rect r = s->session->engine.crop;
    struct projection_part part = {r.x,      r.y,          r.width,
                                   r.height, frame->width, frame->height};

    return projection_camera(camera, &part);
}

bool view_mode_scaled(struct view_mode *s, int width, int height,
                      struct world *w, struct error *err)
{
    const struct frame frame = {.width = width, .height = height};

    if (!view_mode_traced(s, w, err))
        return false;
    w->settings.camera = view_mode_camera(s, &w->settings.camera, &frame);
    return true;
}

struct pool *view_mode_pool(struct view_mode *s)
{
    if (!s->pool)
        s->pool = world_pool(&s->session->engine.world);
    return s->pool;
}

/* Sets the legend, the line below the picture, if it has changed. */
static void __attribute__((format(printf, 2, 3)))
set_legend(struct view_mode *s, const char *format, ...)
{
    char text[sizeof s->legend];
    va_list values;

    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    s->legend_is_new |= strcmp(text, s->legend) != 0;
    memcpy(s->legend, text, strlen(text) + 1);
}

bool view_mode_set(struct view_mode *s, enum show_kind kind, struct error *err)
{
    struct world w;
    bool ok = kind != SHOW_COST || view_mode_traced(s, &w, err);

    s->kind = ok ? kind : SHOW_LIGHT;
    s->error_spp = 0; /* other views use its numbers */
    set_legend(s, "%s", kinds[s->kind].legend);
    return ok;
}

static bool need_numbers(struct view_mode *s, size_t count)
{
    void *numbers = s->numbers;
    bool ok =
        grow_array(&numbers, &s->number_capacity, count, sizeof *s->numbers);

    s->numbers = numbers;
    return ok;
}

/* Scales index i of n to another length. */
static int scaled(int i, int n, int length)
{
    return (int)((int64_t)i * length / n);
}

/* Paints the frame in false colours of a picture with 3 numbers a pixel. */
static void fill(const struct view_mode *s, struct frame *frame, int width,
                 int height, struct number_range range)
{
    for (int y = 0; frame_has_row(frame, y); y++) {
        for (int x = 0; x < frame->width; x++) {
            size_t at =
                (size_t)scaled(y, frame->height, height) * (size_t)width +
                (size_t)scaled(x, frame->width, width);

            frame_dot(frame, x, y,
                      false_color(kinds[s->kind].sample, s->numbers + 3 * at,
                                  range));
        }
    }
}

/* Returns the mean number over the area of pixel (x, y) of the frame. */
static float mean_at(const struct view_mode *s, const struct frame *frame,
                     int x, int y, int width, int height)
{
    struct area_walk rows = area_walk(height, frame->height, y, 1);
    float sum = 0, whole = 0;

    while (area_walks(&rows)) {
        const float *row = s->numbers + (size_t)rows.from * (size_t)width;
        float length = area_step(&rows);
        struct area_walk cols = area_walk(width, frame->width, x, 1);

        while (area_walks(&cols)) {
            float number = row[cols.from];
            float area = length * area_step(&cols);

            sum += area * number;
            whole += area;
        }
    }
    return sum / whole;
}

/* Paints the frame in heat colours of one count a pixel, up to the largest. */
static void fill_heat(const struct view_mode *s, struct frame *frame, int width,
                      int height, float largest)
{
    for (int y = 0; frame_has_row(frame, y); y++) {
        for (int x = 0; x < frame->width; x++) {
            float mean = mean_at(s, frame, x, y, width, height);

            frame_dot(frame, x, y,
                      false_color_heat(largest > 0 ? mean / largest : 0));
        }
    }
}

static void say_depth(struct view_mode *s, struct number_range r)
{
    double scale = s->session->engine.scene.scale;

    set_legend(s, "DEPTH  from %.4g, white, to %.4g, dark", r.lo / scale,
               r.hi / scale);
}

/* Paints the frame in false colours of the numbers at this size. */
static void paint_numbers(struct view_mode *s, struct frame *frame, int width,
                          int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    struct number_range range = number_range_of(s->numbers, pixels, 3);

    fill(s, frame, width, height, range);
    if (s->kind == SHOW_DEPTH)
        say_depth(s, range);
}

static bool paint_draft(struct view_mode *s, struct film *draft,
                        struct frame *frame)
{
    if (!draft ||
        !need_numbers(s, 3 * (size_t)draft->width * (size_t)draft->height))
        return false;
    film_linear(draft, s->numbers);
    paint_numbers(s, frame, draft->width, draft->height);
    return true;
}

static bool paint_samples(struct view_mode *s, struct film *film,
                          struct frame *frame)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    struct number_range range;
    double sum = 0;

    if (!need_numbers(s, pixels))
        return false;
    film_counts(film, s->numbers);
    range = number_range_of(s->numbers, pixels, 1);
    fill_heat(s, frame, film->width, film->height, range.hi);
    for (size_t i = 0; i < pixels; i++)
        sum += s->numbers[i];
    set_legend(s, "SAMPLES  of a pixel, black 0, white %.0f; mean %.2f",
               (double)range.hi, sum / (double)pixels);
    return true;
}

/* Finds the errors again if a pass has ended. */
static bool find_errors(struct view_mode *s, struct film *film)
{
    struct session *of = s->session;
    struct render_progress p = render_progress(of->engine.render);

    if (s->error_spp == p.spp_done && s->error_restart_ns == of->restart_ns)
        return s->error_spp > 0;
    s->error_spp = 0;
    view_mode_pool(s);
    if (!p.film_error.is_known ||
        !need_numbers(s, (size_t)film->width * (size_t)film->height) ||
        !film_error_map(film, session_develop(of).exposure, s->pool,
                        s->numbers))
        return false;
    s->error_spp = p.spp_done;
    s->error_restart_ns = of->restart_ns;
    s->error = p.film_error;
    return true;
}

static bool paint_errors(struct view_mode *s, struct film *film,
                         struct frame *frame)
{
    char noise[ERROR_TEXT_BYTES];

    if (!find_errors(s, film)) {
        set_legend(s, "ERROR  unknown until each pixel has two samples");
        return false;
    }
    for (int y = 0; frame_has_row(frame, y); y++)
        for (int x = 0; x < frame->width; x++)
            frame_dot(frame, x, y,
                      error_map_color(
                          mean_at(s, frame, x, y, film->width, film->height)));
    error_text_noise(noise, &s->error);
    set_legend(s, "ERROR  " ERROR_MAP_SCALE "; %s", noise);
    return true;
}

/* Counts costs again if the camera or the frame's size has changed. */
static bool count_costs(struct view_mode *s, const struct frame *frame)
{
    uint64_t generation = s->session->engine.world.generation;
    struct error ignored;
    struct world w;

    if (!view_mode_scaled(s, frame->width, frame->height, &w, &ignored))
        return false;
    if (s->cost_generation == generation && s->cost_width == frame->width &&
        s->cost_height == frame->height &&
        memcmp(&s->cost_camera, &w.settings.camera, sizeof s->cost_camera) == 0)
        return true;
    free(s->costs);
    s->cost_width = 0;
    s->costs = alloc_array((size_t)frame->width * (size_t)frame->height,
                           sizeof *s->costs);
    if (!s->costs)
        return false;
    traversal_cost_of_pixels(s->pool, &w, frame->width, frame->height,
                             s->costs);
    s->cost_generation = generation;
    s->cost_camera = w.settings.camera;
    s->cost_width = frame->width;
    s->cost_height = frame->height;
    return true;
}

static bool paint_costs(struct view_mode *s, struct frame *frame)
{
    size_t pixels = (size_t)frame->width * (size_t)frame->height;
    struct number_range range;
    double nodes = 0, blocks = 0;

    if (!count_costs(s, frame) || !need_numbers(s, pixels))
        return false;
    for (size_t i = 0; i < pixels; i++) {
        nodes += s->costs[i].nodes;
        blocks += s->costs[i].blocks;
        s->numbers[i] = (float)(s->costs[i].nodes + s->costs[i].blocks);
    }
    range = number_range_of(s->numbers, pixels, 1);
    fill_heat(s, frame, frame->width, frame->height, range.hi);
    set_legend(s,
               "COST  tests of a camera ray, black 0, white %.0f; mean %.1f "
               "nodes, %.1f leaf blocks",
               (double)range.hi, nodes / (double)pixels,
               blocks / (double)pixels);
    return true;
}

/* Returns true if the light in the frame is filtered: fast before the film has
 * a sample in each pixel, since the camera may be moving. */
static bool paint_filtered(struct view_mode *s, struct film *film,
                           struct film *draft, struct film *surfaces,
                           struct frame *frame)
{
    uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;
    enum filter_form form =
        atomic_load(&film->samples) < pixels ? FILTER_FAST : FILTER_FULL;

    return s->kind == SHOW_LIGHT && surfaces != NULL &&
           screen_filter_show(&s->filter,
                              &(struct screen_films){film, surfaces, draft},
                              develop_of(s), form, frame);
}

/* Without a draft or memory for its numbers the film is shown as light. */
void view_mode_preview(struct view_mode *s, struct film *film,
                       struct film *draft, struct film *surfaces,
                       struct frame *frame)
{
    bool is_painted = false;

    switch (s->kind) {
    case SHOW_LIGHT:
    case SHOW_PREVIEW: break;
    case SHOW_COST: is_painted = paint_costs(s, frame); break;
    case SHOW_SAMPLES: is_painted = paint_samples(s, film, frame); break;
    case SHOW_ERROR: is_painted = paint_errors(s, film, frame); break;
    default: is_painted = paint_draft(s, draft, frame); break;
    }
    s->is_filtered = paint_filtered(s, film, draft, surfaces, frame);
    if (!is_painted && !s->is_filtered)
        film_preview(film, draft, develop_of(s), frame);
}

/* Paints a preview, whose numbers are light. */
static void paint_preview(const struct view_mode *s, struct frame *frame)
{
    size_t count = 3 * (size_t)frame->width * (size_t)frame->height;

    for (size_t i = 0; i < count; i++)
        frame->rgb[i] = (uint8_t)srgb_byte(s->numbers[i]);
}

static bool fail_memory(const struct frame *frame, struct error *err)
{
    return fail(err, "out of memory for the numbers of %dx%d pixels",
                frame->width, frame->height);
}

/* Computes the numbers of a kind at the frame's own size. The world is traced,
 * and its camera that of the frame. */
static void trace_numbers(struct view_mode *s, enum sample_kind sample,
                          struct world *w, const struct frame *frame,
                          float *numbers)
{
    w->settings.sample = sample;
    w->settings.features |= FEATURE_AOV;
    aov_of_pixels(s->pool, w, frame->width, frame->height, numbers);
}

/* Computes the numbers of the view at the frame's own size. */
static bool find_numbers(struct view_mode *s, const struct frame *frame,
                         struct error *err)
{
    struct world w;

    if (!view_mode_scaled(s, frame->width, frame->height, &w, err))
        return false;
    if (!need_numbers(s, 3 * (size_t)frame->width * (size_t)frame->height))
        return fail_memory(frame, err);
    trace_numbers(s, kinds[s->kind].sample, &w, frame, s->numbers);
    return true;
}

/* Paints light, filtered if the last frame of the screen was. */
static bool paint_light(struct view_mode *s, struct film *film,
                        struct frame *frame, struct error *err)
{
    int width = int_min(frame->width, film->width);
    int height = int_min(frame->height, film->height);
    struct film draft = {.counts = NULL};
    struct world w;
    bool ok = true;

    if (s->is_filtered)
        ok = view_mode_scaled(s, width, height, &w, err) &&
             filtered_picture_draft(&draft, &w, width, height,
                                    view_mode_pool(s), NULL, err) &&
             filtered_picture_paint(film, &draft, develop_of(s), frame, err);
    else
        film_preview(film, NULL, develop_of(s), frame);
    film_free(&draft);
    return ok;
}

bool view_mode_picture(struct view_mode *s, struct film *film,
                       struct frame *frame, struct error *err)
{
    switch (s->kind) {
    case SHOW_LIGHT: return paint_light(s, film, frame, err);
    case SHOW_SAMPLES:
        return paint_samples(s, film, frame) || fail_memory(frame, err);
    case SHOW_ERROR:
        if (!paint_errors(s, film, frame))
            film_preview(film, NULL, develop_of(s), frame);
        break;
    case SHOW_COST: return paint_costs(s, frame) || fail_memory(frame, err);
    default:
        if (!find_numbers(s, frame, err))
            return false;
        if (s->kind == SHOW_PREVIEW)
            paint_preview(s, frame);
        else
            paint_numbers(s, frame, frame->width, frame->height);
        break;
    }
    return true;
}

bool view_mode_thumbnail(struct view_mode *s, const struct pose *pose,
                         struct frame *frame, struct error *err)
{
    const struct session *of = s->session;
    size_t pixels = (size_t)frame->width * (size_t)frame->height;
    struct view view = of->edit.now.view;
    struct host_world *host = &s->session->engine.world;
    float *numbers = alloc_array(pixels, 3 * sizeof *numbers);
    struct world w;
    bool ok = numbers != NULL || fail_memory(frame, err);

    view.pose = *pose;
    ok = ok &&
         world_lend(host, &of->engine.scene, &view, of->options->seed, &w,
                    err) &&
         world_ensure_tree(host, &w, view_mode_pool(s), err);
    if (ok) {
        w.settings.camera = view_mode_camera(s, &w.settings.camera, frame);
        trace_numbers(s, SAMPLE_PREVIEW, &w, frame, numbers);
        for (int y = 0; y < frame->height; y++)
            for (int x = 0; x < frame->width; x++)
                frame_dot(frame, x, y,
                          false_color(SAMPLE_PREVIEW,
                                      numbers + 3 * (y * frame->width + x),
                                      (struct number_range){0, 1}));
    }
    free(numbers);
    return ok;
}

void view_mode_free(struct view_mode *s)
{
    pool_destroy(s->pool);
    screen_filter_free(&s->filter);
    free(s->numbers);
    free(s->costs);
    *s = (struct view_mode){0};
}
