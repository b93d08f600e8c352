// SPDX-License-Identifier: MIT
#include "inspect/overlay.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/projection.h"
#include "kernels/traverse.h"

#define BOX_COLOR   0x40ff60u
#define BOX_DIMMEST 0.25

#define TRAIL_COLOR  0xb0b0b0u
#define STEP_COLOR   0xffff40u
#define VERTEX_COLOR 0xff4040u

/* Pixels of a dash, and the part of the way to a point within which a surface
 * hides it. */
#define DASH   3
#define NEARER 0.999f

#define NORMAL_COLOR  0x40ff40u
#define TANGENT_COLOR 0xff4040u
#define BINORMAL      0x4080ffu
#define EYE_COLOR     0xff9020u

/* Length relative to the distance from the eye, which gives a constant size on
 * the screen. */
#define LOBE_LENGTH 0.15f

static void line(struct frame *f, const struct camera *c, struct vec3 a,
                 struct vec3 b, uint32_t rgb)
{
    struct projected p[2];

    if (projection_line(c, a, b, p))
        frame_line(f, p[0].x, p[0].y, p[1].x, p[1].y, rgb);
}

/* ---- boxes ---- */

struct near_box {
    struct vec3 lo, hi;
    float depth; /* depth of its centre */
};

struct level {
    struct near_box *boxes;
    size_t capacity;
    uint32_t count;
};

static bool add_box(struct level *l, const struct camera *c,
                    const struct node *n)
{
    struct vec3 middle = v3_scale(v3_add(n->lo, n->hi), 0.5f);
    void *boxes = l->boxes;

    if (!grow_array(&boxes, &l->capacity, l->count + 1u, sizeof *l->boxes))
        return false;
    l->boxes = boxes;
    l->boxes[l->count++] =
        (struct near_box){n->lo, n->hi,
                          v3_dot(v3_sub(middle, c->eye), c->forward)};
    return true;
}

/* Collects the boxes of a level. Nodes are in depth-first order, so a stack of
 * right children suffices. */
static bool collect(struct level *l, const struct camera *c,
                    const struct bvh *bvh, uint32_t level)
{
    struct {
        uint32_t node, level;
    } pile[128] = {{0, 0}};
    int depth = bvh->node_count > 0 ? 1 : 0;

    while (depth > 0) {
        uint32_t at = pile[--depth].node;
        uint32_t here = pile[depth].level;
        const struct node *n = &bvh->nodes[at];

        if (here == level) {
            if (!add_box(l, c, n))
                return false;
        } else if (n->count == 0) {
            pile[depth].node = n->next;
            pile[depth++].level = here + 1;
            pile[depth].node = at + 1;
            pile[depth++].level = here + 1;
        }
    }
    return true;
}

static int farther_first(const void *a, const void *b)
{
    float x = ((const struct near_box *)a)->depth;
    float y = ((const struct near_box *)b)->depth;

    return x > y ? -1 : x < y;
}

/* Returns corner i, which has hi on axis k if bit k of i is set. */
static struct vec3 corner(const struct near_box *b, int i)
{
    return v3(i & 1 ? b->hi.x : b->lo.x, i & 2 ? b->hi.y : b->lo.y,
              i & 4 ? b->hi.z : b->lo.z);
}

static void draw_box(struct frame *f, const struct camera *c,
                     const struct near_box *b, uint32_t rgb)
{
    for (int i = 0; i < 8; i++) {
        for (int axis = 1; axis < 8; axis *= 2) {
            if ((i & axis) == 0)
                line(f, c, corner(b, i), corner(b, i | axis), rgb);
        }
    }
}

uint32_t overlay_boxes(struct frame *frame, const struct camera *camera,
                       const struct bvh *bvh, uint32_t level)
{
    struct level l = {0};
    uint32_t first;

    if (!collect(&l, camera, bvh, level)) {
        free(l.boxes);
        return 0;
    }
    if (l.count > 0)
        qsort(l.boxes, l.count, sizeof *l.boxes, farther_first);
    first = l.count > OVERLAY_BOXES_MAX ? l.count - OVERLAY_BOXES_MAX : 0;
    for (uint32_t i = first; i < l.count; i++) {
        double part = (double)(i - first + 1) / (l.count - first);

        draw_box(frame, camera, &l.boxes[i],
                 frame_dim(BOX_COLOR, BOX_DIMMEST + (1 - BOX_DIMMEST) * part));
    }
    free(l.boxes);
    return l.count;
}

/* ---- paths ---- */

/* Returns true if a surface is between the eye and a point. */
static bool is_behind(const struct world *w, struct vec3 eye, struct vec3 p)
{
    struct vec3 way = v3_sub(p, eye);
    float length = v3_length(way);
    struct ray r = {.o = eye, .t_max = length * NEARER};
    struct hit h;

    if (w == NULL || !(length > 0.0f))
        return false;
    r.d = v3_scale(way, 1.0f / length);
    return hit_closest(w, r, &h);
}

/* Draws a step of a path in pieces; of those behind surfaces every other one.
 */
static void draw_step(struct frame *f, const struct camera *c,
                      const struct world *w,
                      const struct path_record_step *step, uint32_t rgb)
{
    struct vec3 way = v3_sub(step->to, step->from);
    struct projected ends[2];
    int count;

    if (!projection_line(c, step->from, step->to, ends))
        return;
    count = 1 + (int)(fmin(hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y),
                           f->width + f->height) /
                      DASH);
    for (int i = 0; i < count; i++) {
        struct vec3 a =
            v3_add(step->from, v3_scale(way, (float)i / (float)count));
        struct vec3 b =
            v3_add(step->from, v3_scale(way, (float)(i + 1) / (float)count));

        if (i % 2 == 0 || !is_behind(w, c->eye, v3_scale(v3_add(a, b), 0.5f)))
            line(f, c, a, b, rgb);
    }
}

void overlay_path(struct frame *frame, const struct camera *camera,
                  const struct world *world, const struct path_record *path,
                  int count)
{
    struct projected p;

    for (int i = 0; i < count; i++)
        draw_step(frame, camera, world, &path->steps[i],
                  i == count - 1 ? STEP_COLOR : TRAIL_COLOR);
    for (int i = 0; i < count; i++) {
        if (path->steps[i].way != PATH_RECORD_SKY &&
            projection_point(camera, path->steps[i].to, &p))
            frame_dot(frame, p.x, p.y, VERTEX_COLOR);
    }
}

/* ---- lobes ---- */

static void arrow(struct frame *f, const struct camera *c, struct vec3 p,
                  struct vec3 d, float length, uint32_t rgb)
{
    line(f, c, p, v3_add(p, v3_scale(d, length)), rgb);
}

/* Returns the hue of the weight at full brightness. */
static uint32_t color_of(struct vec3 weight)
{
    float top = f_max(weight.x, f_max(weight.y, weight.z));
    float scale = top > 0.0f ? 255.0f / top : 0.0f;

    return (uint32_t)(weight.x * scale) << 16 |
           (uint32_t)(weight.y * scale) << 8 | (uint32_t)(weight.z * scale);
}

void overlay_lobes(struct frame *frame, const struct camera *camera,
                   const struct path_record_lobes *l)
{
    float length = LOBE_LENGTH * l->distance;
    float top = 0.0f;

    for (int i = 0; i < l->count; i++)
        top = f_max(top, l->pdf[i]);
    for (int i = 0; i < l->count; i++)
        arrow(frame, camera, l->p, l->wi[i],
              length * (l->pdf[i] > 0.0f ? l->pdf[i] / top : 1.0f),
              color_of(l->weight[i]));
    arrow(frame, camera, l->p, l->wo, length, EYE_COLOR);
    arrow(frame, camera, l->p, l->t, length, TANGENT_COLOR);
    arrow(frame, camera, l->p, l->b, length, BINORMAL);
    arrow(frame, camera, l->p, l->n, length, NORMAL_COLOR);
}
