// SPDX-License-Identifier: MIT
#include "glim/inside.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/drawing.h"
#include "glim/legend.h"
#include "glim/projection.h"
#include "glim/sketch.h"
#include "kernels/vec.h"

#define TEXT_BYTES 256

/* What is rendered for a view, and what is said of it. */
static const struct {
    enum sample_kind sample;
    const char *legend;
} views[INSIDE_VIEWS] = {
    [INSIDE_LIGHT] = {SAMPLE_LIGHT, ""},
    [INSIDE_PREVIEW] = {SAMPLE_PREVIEW,
                        "PREVIEW  colours as they are, lit from the eye"},
    [INSIDE_NORMALS] = {SAMPLE_NORMAL,
                        "NORMALS  for shading: x red, y green, z blue"},
    [INSIDE_FACES] = {SAMPLE_FACE,
                      "FACES  normals as wound: x red, y green, z blue"},
    [INSIDE_UVS] = {SAMPLE_UV, "UVS  u red, v green; grey: none"},
    [INSIDE_DEPTH] = {SAMPLE_DEPTH, "DEPTH"},
    [INSIDE_MATERIALS] = {SAMPLE_MATERIAL, "MATERIALS  a colour for each"},
    [INSIDE_COST] = {SAMPLE_PREVIEW, "COST"},
    [INSIDE_SAMPLES] = {SAMPLE_LIGHT, "SAMPLES"},
};

static struct session *session_of(const struct inside *in)
{
    return in->work->session;
}

/* As it is rendered, but with the tree of this file. */
static bool find_world(const struct inside *in, struct world *w)
{
    const struct session *s = session_of(in);
    struct error err;

    if (!scene_world(&s->scene, &s->view, s->options->seed, w, &err))
        return false;
    w->nodes = in->bvh.nodes;
    w->leaf_tris = in->bvh.leaf_tris;
    return true;
}

static struct camera frame_camera(const struct inside *in,
                                  const struct camera *camera,
                                  const struct frame *frame)
{
    struct rect r = session_of(in)->crop;
    struct projection_part part = {r.x,      r.y,          r.width,
                                   r.height, frame->width, frame->height};

    return projection_camera(camera, &part);
}

static bool need_tree(struct inside *in)
{
    struct world w;
    struct error err;

    if (in->has_bvh)
        return true;
    in->has_bvh = find_world(in, &w) && bvh_build(&in->bvh, &w, NULL, &err);
    if (!in->has_bvh)
        work_say(in->work, "no memory for a tree to be drawn");
    return in->has_bvh;
}

static bool need_pool(struct inside *in)
{
    int threads = session_of(in)->options->thread_count;
    struct error err;

    if (!in->pool)
        in->pool = pool_create(threads != 0 ? threads : usable_threads(), &err);
    if (!in->pool)
        work_say_error(in->work, err.text);
    return in->pool != NULL;
}

/* ---- views ---- */

static bool need_numbers(struct inside *in, size_t count)
{
    return grow_array((void **)&in->numbers, &in->number_capacity, count,
                      sizeof *in->numbers);
}

/* Pixel i of n in the other's length, from 0. */
static int scaled(int i, int n, int length)
{
    return (int)((int64_t)i * length / n);
}

/* The frame in false colours of the numbers of a picture, 3 a pixel. */
static void fill(const struct inside *in, struct frame *frame, int width,
                 int height, struct number_range range)
{
    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            size_t at =
                (size_t)scaled(y, frame->height, height) * (size_t)width +
                (size_t)scaled(x, frame->width, width);

            drawing_dot(frame, x, y,
                        false_color(views[in->view].sample,
                                    in->numbers + 3 * at, range));
        }
    }
}

/* The mean of what pixel (x, y) of the frame covers. */
static float mean_at(const struct inside *in, const struct frame *frame, int x,
                     int y, int width, int height)
{
    int x0 = scaled(x, frame->width, width);
    int y0 = scaled(y, frame->height, height);
    int x1 = scaled(x + 1, frame->width, width);
    int y1 = scaled(y + 1, frame->height, height);
    float sum = 0;
    int count = 0;

    for (int j = y0; j < y1 || j == y0; j++) {
        for (int i = x0; i < x1 || i == x0; i++) {
            sum += in->numbers[(size_t)j * (size_t)width + (size_t)i];
            count++;
        }
    }
    return sum / (float)count;
}

/* The same for counts, one a pixel, up to the largest. */
static void fill_heat(const struct inside *in, struct frame *frame, int width,
                      int height, float largest)
{
    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            float mean = mean_at(in, frame, x, y, width, height);

            drawing_dot(frame, x, y,
                        false_color_heat(largest > 0 ? mean / largest : 0));
        }
    }
}

/* The line below the picture, if it says something new. */
static void say(struct inside *in, const char *text)
{
    in->has_news |= strcmp(text, in->legend) != 0;
    snprintf(in->legend, sizeof in->legend, "%s", text);
}

static void say_depth(struct inside *in, struct number_range r)
{
    double scale = session_of(in)->scene.scale;
    char text[TEXT_BYTES];

    snprintf(text, sizeof text, "DEPTH  from %.4g, white, to %.4g, dark",
             r.lo / scale, r.hi / scale);
    say(in, text);
}

static void paint_numbers(struct inside *in, struct film *draft,
                          struct frame *frame)
{
    size_t pixels;
    struct number_range range;

    if (!draft)
        return;
    pixels = (size_t)draft->width * (size_t)draft->height;
    if (!need_numbers(in, 3 * pixels))
        return;
    film_linear(draft, in->numbers);
    range = number_range_of(in->numbers, pixels, 3);
    fill(in, frame, draft->width, draft->height, range);
    if (in->view == INSIDE_DEPTH)
        say_depth(in, range);
}

static void paint_samples(struct inside *in, struct film *film,
                          struct frame *frame)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    struct number_range range;
    char text[TEXT_BYTES];
    double sum = 0;

    if (!need_numbers(in, pixels))
        return;
    film_counts(film, in->numbers);
    range = number_range_of(in->numbers, pixels, 1);
    fill_heat(in, frame, film->width, film->height, range.hi);
    for (size_t i = 0; i < pixels; i++)
        sum += in->numbers[i];
    snprintf(text, sizeof text,
             "SAMPLES  of a pixel, black 0, white %.0f; mean %.2f",
             (double)range.hi, sum / (double)pixels);
    say(in, text);
}

/* Counts anew what another camera or frame sees. */
static bool count_costs(struct inside *in, const struct frame *frame)
{
    struct world w;

    if (!find_world(in, &w))
        return false;
    w.settings.camera = frame_camera(in, &w.settings.camera, frame);
    if (in->cost_width == frame->width && in->cost_height == frame->height &&
        memcmp(&in->cost_camera, &w.settings.camera, sizeof in->cost_camera) ==
            0)
        return true;
    free(in->costs);
    in->cost_width = 0;
    in->costs = alloc_array((size_t)frame->width * (size_t)frame->height,
                            sizeof *in->costs);
    if (!in->costs)
        return false;
    cost_of_pixels(in->pool, &w, frame->width, frame->height, in->costs);
    in->cost_camera = w.settings.camera;
    in->cost_width = frame->width;
    in->cost_height = frame->height;
    return true;
}

static void paint_costs(struct inside *in, struct frame *frame)
{
    size_t pixels = (size_t)frame->width * (size_t)frame->height;
    struct number_range range;
    double boxes = 0, triangles = 0;
    char text[TEXT_BYTES];

    if (!count_costs(in, frame) || !need_numbers(in, pixels))
        return;
    for (size_t i = 0; i < pixels; i++) {
        boxes += in->costs[i].boxes;
        triangles += in->costs[i].triangles;
        in->numbers[i] = (float)(in->costs[i].boxes + in->costs[i].triangles);
    }
    range = number_range_of(in->numbers, pixels, 1);
    fill_heat(in, frame, frame->width, frame->height, range.hi);
    snprintf(text, sizeof text,
             "COST  tests of a camera ray, black 0, white %.0f; mean %.1f "
             "boxes, %.1f triangles",
             (double)range.hi, boxes / (double)pixels,
             triangles / (double)pixels);
    say(in, text);
}

static void paint_view(struct inside *in, struct film *film, struct film *draft,
                       struct frame *frame)
{
    switch (in->view) {
    case INSIDE_LIGHT:
    case INSIDE_PREVIEW: break;
    case INSIDE_COST: paint_costs(in, frame); break;
    case INSIDE_SAMPLES: paint_samples(in, film, frame); break;
    default: paint_numbers(in, draft, frame); break;
    }
}

/* ---- drawings ---- */

static void paint_drawing(struct inside *in, struct frame *frame)
{
    struct world w;
    struct camera camera;

    if (in->drawing == INSIDE_NOTHING || !find_world(in, &w))
        return;
    camera = frame_camera(in, &w.settings.camera, frame);
    if (in->drawing == INSIDE_BOXES)
        sketch_boxes(frame, &camera, &in->bvh, in->level);
    else if (in->drawing == INSIDE_LOBES && in->is_surface)
        sketch_lobes(frame, &camera, &in->lobes);
    else if (in->drawing == INSIDE_PATH)
        sketch_trail(frame, &camera, &in->trail, in->step);
}

static void paint(void *context, struct film *film, struct film *draft,
                  struct frame *frame)
{
    struct inside *in = context;

    paint_view(in, film, draft, frame);
    paint_drawing(in, frame);
}

void inside_close_panel(struct inside *in)
{
    if (in->has_panel)
        canvas_close_window(in->canvas);
    in->has_panel = false;
    in->work->has_changed = true;
}

void inside_open_panel(struct inside *in)
{
    const struct scene *scene = &session_of(in)->scene;
    const char *lines[LEGEND_LINES];
    struct legend legend;
    char title[TEXT_BYTES];

    inside_close_panel(in);
    if (in->canvas->is_too_small)
        return;
    if (in->drawing == INSIDE_LOBES && in->is_surface) {
        legend_lobes(&legend, scene, &in->lobes);
        snprintf(title, sizeof title, " directions from pixel %u %u ", in->x,
                 in->y);
    } else if (in->drawing == INSIDE_PATH) {
        legend_trail(&legend, scene, &in->trail, in->step);
        snprintf(title, sizeof title, " sample %llu of pixel %u %u - < > ",
                 (unsigned long long)in->sample, in->x, in->y);
    } else {
        return;
    }
    for (int i = 0; i < legend.count; i++)
        lines[i] = legend.lines[i];
    canvas_open_panel(in->canvas, title, lines, legend.count);
    in->has_panel = true;
}

static void say_boxes(struct inside *in)
{
    struct frame nothing = {0};
    struct camera any = {0};
    char text[TEXT_BYTES];

    snprintf(text, sizeof text,
             "boxes of level %u of %u: %u nodes; < > go up and down", in->level,
             in->bvh.depth, sketch_boxes(&nothing, &any, &in->bvh, in->level));
    work_say_long(in->work, text);
}

static bool is_new_pick(const struct inside *in)
{
    const struct cursor *c = in->cursor;

    return c->has_pick && (!in->is_picked || memcmp(in->place, c->pick.position,
                                                    sizeof in->place) != 0);
}

/* Where the pick is in the picture now, or its middle. */
static void find_pixel(struct inside *in)
{
    const struct scene *scene = &session_of(in)->scene;
    struct rect r = session_of(in)->crop;
    struct projected at;

    in->x = (uint32_t)(r.x + r.width / 2);
    in->y = (uint32_t)(r.y + r.height / 2);
    in->is_picked = in->cursor->has_pick;
    if (!in->is_picked)
        return;
    memcpy(in->place, in->cursor->pick.position, sizeof in->place);
    if (projection_point(
            &in->camera,
            v3((float)((in->place[0] - scene->center[0]) * scene->scale),
               (float)((in->place[1] - scene->center[1]) * scene->scale),
               (float)((in->place[2] - scene->center[2]) * scene->scale)),
            &at) &&
        at.x >= r.x && at.x < r.x + r.width && at.y >= r.y &&
        at.y < r.y + r.height) {
        in->x = (uint32_t)at.x;
        in->y = (uint32_t)at.y;
    }
}

static void follow(struct inside *in)
{
    struct world w;

    if (!find_world(in, &w))
        return;
    w.settings.camera = in->camera;
    trail_follow(&in->trail, &w, in->x, in->y, in->sample);
}

/* Begins to draw from what is picked. */
static void place(struct inside *in)
{
    struct world w;

    if (!find_world(in, &w))
        return;
    in->camera = w.settings.camera;
    find_pixel(in);
    in->sample = 0;
    in->step = 1;
    follow(in);
    in->is_surface = trail_scatter(&in->lobes, &w, in->x, in->y);
}

static void say_drawing(struct inside *in)
{
    if (in->drawing == INSIDE_BOXES)
        say_boxes(in);
    else if (in->drawing == INSIDE_LOBES && !in->is_surface)
        work_say(in->work, "only the sky is there: v picks something else");
    inside_open_panel(in);
}

/* A path goes on from where the directions were drawn. */
static void next_drawing(struct inside *in)
{
    in->drawing = (enum inside_drawing)((in->drawing + 1) % INSIDE_DRAWINGS);
    in->work->message.until_ns = 0;
    if (in->drawing != INSIDE_NOTHING && !need_tree(in))
        in->drawing = INSIDE_NOTHING;
    if (in->drawing == INSIDE_LOBES)
        place(in);
    say_drawing(in);
}

static void change_level(struct inside *in, int by)
{
    if (by < 0 ? in->level > 0 : in->level < in->bvh.depth)
        in->level += (uint32_t)by;
    say_boxes(in);
}

/* Behind the last step comes the next sample, before the first the last. */
static void change_step(struct inside *in, int by)
{
    in->step += by;
    if (in->step < 1 && in->sample == 0) {
        in->step = 1;
    } else if (in->step < 1) {
        in->sample--;
        follow(in);
        in->step = in->trail.count;
    } else if (in->step > in->trail.count) {
        in->sample++;
        follow(in);
        in->step = 1;
    }
    inside_open_panel(in);
}

static void change(struct inside *in, int by)
{
    in->work->has_changed = true;
    if (in->drawing == INSIDE_BOXES)
        change_level(in, by);
    else if (in->drawing == INSIDE_PATH)
        change_step(in, by);
    else
        work_say(in->work, "< > go through boxes or a path: t draws them");
}

/* ---- actions ---- */

static void show(struct inside *in, enum inside_view view)
{
    struct session *s = session_of(in);
    enum sample_kind before = s->sample;

    if (view == INSIDE_COST && (!need_tree(in) || !need_pool(in)))
        view = INSIDE_LIGHT;
    in->view = view;
    s->sample = views[view].sample;
    say(in, views[view].legend);
    in->work->message.until_ns = 0;
    in->work->has_changed = true;
    if (in->work->is_live && s->sample != before)
        in->work->must_restart = true;
}

/* Normal mode renders light and nothing else. */
static void turn(struct inside *in, int by)
{
    int view = (int)in->view;

    do
        view = (view + by + INSIDE_VIEWS) % INSIDE_VIEWS;
    while (!in->work->is_live && views[view].sample != SAMPLE_LIGHT);
    show(in, (enum inside_view)view);
}

bool inside_act(struct inside *in, enum action action)
{
    switch (action) {
    case ACTION_VIEW_NEXT: turn(in, 1); break;
    case ACTION_VIEW_BACK: turn(in, -1); break;
    case ACTION_DRAWING: next_drawing(in); break;
    case ACTION_LESS: change(in, -1); break;
    case ACTION_MORE: change(in, 1); break;
    default: return false;
    }
    return true;
}

void inside_step(struct inside *in)
{
    if ((in->drawing == INSIDE_LOBES || in->drawing == INSIDE_PATH) &&
        is_new_pick(in)) {
        place(in);
        say_drawing(in);
    }
}

struct develop inside_develop(const struct inside *in)
{
    return in->view == INSIDE_PREVIEW ? develop_linear(0)
                                      : session_develop(session_of(in));
}

void inside_leave(struct inside *in)
{
    if (views[in->view].sample != SAMPLE_LIGHT)
        show(in, INSIDE_LIGHT);
}

void inside_stop_drawing(struct inside *in)
{
    inside_close_panel(in);
    in->drawing = INSIDE_NOTHING;
}

void inside_renew(struct inside *in)
{
    inside_stop_drawing(in);
    bvh_free(&in->bvh);
    in->has_bvh = false;
    in->cost_width = 0;
}

void inside_init(struct inside *in, struct work *work, struct canvas *canvas,
                 struct cursor *cursor)
{
    *in = (struct inside){.work = work, .canvas = canvas, .cursor = cursor};
    canvas->painter = (struct painter){paint, in};
}

void inside_free(struct inside *in)
{
    if (in->pool)
        pool_destroy(in->pool);
    bvh_free(&in->bvh);
    free(in->numbers);
    free(in->costs);
    *in = (struct inside){0};
}
