// SPDX-License-Identifier: MIT
#include "inspect/overlay.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/min_max.h"
#include "base/print.h"
#include "render/projection.h"
#include "world/bvh/ray_queries.h"

/* ---- drawings ---- */

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

static bool add_box(struct level *l, const struct camera *c, struct vec3 lo,
                    struct vec3 hi)
{
    struct vec3 middle = v3_scale(v3_add(lo, hi), 0.5f);
    void *boxes = l->boxes;

    if (!grow_array(&boxes, &l->capacity, l->count + 1u, sizeof *l->boxes))
        return false;
    l->boxes = boxes;
    l->boxes[l->count++] =
        (struct near_box){lo, hi, v3_dot(v3_sub(middle, c->eye), c->forward)};
    return true;
}

static bool has_child(const struct bvh8_node *n, uint32_t i)
{
    return n->planes[0][0][i] < INFINITY;
}

/* Returns the node that the child names, or NULL if it is a leaf. */
static const struct bvh8_node *node_below(const struct world *w, uint32_t child)
{
    return (child & BVH8_LEAF) != 0 ? NULL : bvh8_node_at(w->nodes, child);
}

/* Collects the boxes of the children that are `level` nodes below a node.
 * Recursion is as deep as the tree. */
static bool collect(struct level *l, const struct camera *c,
                    const struct world *w, const struct bvh8_node *n,
                    uint32_t level)
{
    for (uint32_t i = 0; i < BVH8_CHILDREN; i++) {
        const struct bvh8_node *below = node_below(w, n->child[i]);

        if (!has_child(n, i))
            continue;
        if (level == 0) {
            if (!add_box(l, c,
                         v3(n->planes[0][0][i], n->planes[1][0][i],
                            n->planes[2][0][i]),
                         v3(n->planes[0][1][i], n->planes[1][1][i],
                            n->planes[2][1][i])))
                return false;
        } else if (below != NULL && !collect(l, c, w, below, level - 1)) {
            return false;
        }
    }
    return true;
}

static uint32_t levels_below(const struct world *w, const struct bvh8_node *n)
{
    uint32_t levels = 0;

    for (uint32_t i = 0; i < BVH8_CHILDREN; i++) {
        const struct bvh8_node *below = node_below(w, n->child[i]);

        if (below != NULL)
            levels = u32_max(levels, levels_below(w, below));
    }
    return levels + 1;
}

uint32_t overlay_levels(const struct world *w)
{
    return w->nodes != NULL ? levels_below(w, w->nodes) : 0;
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
                       const struct world *w, uint32_t level)
{
    struct level l = {0};
    uint32_t first;

    if (w->nodes == NULL || !collect(&l, camera, w, w->nodes, level)) {
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

/* ---- tables ---- */

#define MATERIAL_COLS  10
#define LOBES_COLS     40 /* width of the material's name on its line */
#define MATERIAL_BYTES 160
#define EVENT_COLS     24 /* and in a sentence */
#define PLACE_COLS     17
#define PDF_COLS       6
#define WEIGHT_BYTES   32

const char *overlay_material(const struct overlay_names *names,
                             uint32_t material)
{
    const char *name = names->materials[material];

    return *name ? name : "no material";
}

const char *overlay_material_of(const struct overlay_names *names, uint32_t tri)
{
    const struct world *w = names->world;

    return overlay_material(names, tri_material(w, tri, instance_of(w, tri)));
}

static char *next_line(struct overlay_text *l)
{
    return l->lines[l->count++];
}

/* True if the step ends at a surface, and not in the sky or in a medium. */
static bool is_at_surface(const struct path_record_step *s)
{
    return s->hit.tri != NO_INDEX;
}

static const char *way_name(const struct path_record_step *s)
{
    switch (s->way) {
    case PATH_RECORD_SKY: return "sky";
    case PATH_RECORD_ENDED: return "end";
    case PATH_RECORD_LIMIT: return "limit";
    case PATH_RECORD_CELL: return "cell";
    case PATH_RECORD_ROULETTE: return "roulette";
    case PATH_RECORD_SCATTERED: return "scatter";
    case PATH_RECORD_REFLECTED: return "reflect";
    case PATH_RECORD_TRANSMITTED: break;
    }
    return "transmit";
}

/* Returns a coordinate in file units; rounding errors around 0 become 0. */
static double file_coordinate(const struct scene *scene, float x, int axis)
{
    double from_file = x / scene->scale + scene->center[axis];

    return fabs(from_file) * scene->scale < 1e-6 ? 0 : from_file;
}

void overlay_place(const struct scene *scene, struct vec3 p, double place[3])
{
    place[0] = file_coordinate(scene, p.x, 0);
    place[1] = file_coordinate(scene, p.y, 1);
    place[2] = file_coordinate(scene, p.z, 2);
}

void overlay_numbers(char text[OVERLAY_NUMBERS_BYTES], const double *values,
                     int count, int cols)
{
    int length = cols + 1;

    for (int digits = cols > PLACE_COLS ? 4 : 3; digits > 0 && length > cols;
         digits--) {
        length = 0;
        for (int i = 0; i < count; i++)
            length += snprintf(text + length,
                               (size_t)(OVERLAY_NUMBERS_BYTES - length),
                               i > 0 ? " %.*g" : "%.*g", digits, values[i]);
    }
}

static void add_step(struct overlay_text *l, const struct scene *scene,
                     const struct overlay_names *names,
                     const struct path_record_step *s, int number)
{
    bool goes_on = s->way >= PATH_RECORD_SCATTERED;
    double pdf = (double)s->pdf;
    double place[3];
    char place_text[OVERLAY_NUMBERS_BYTES] = "";
    char pdf_text[OVERLAY_NUMBERS_BYTES] = "";
    char material[MATERIAL_BYTES];

    overlay_place(scene, s->to, place);
    if (s->way != PATH_RECORD_SKY)
        overlay_numbers(place_text, place, 3, PLACE_COLS);
    if (goes_on && pdf > 0)
        overlay_numbers(pdf_text, &pdf, 1, PDF_COLS);
    else if (goes_on)
        snprintf(pdf_text, sizeof pdf_text, "delta");
    text_width_fit(material, sizeof material,
                   is_at_surface(s) ? overlay_material_of(names, s->hit.tri)
                                    : "",
                   MATERIAL_COLS);
    snprintf(next_line(l), OVERLAY_TEXT_BYTES,
             "%2d %s %-*s %-8s %4.2f %4.2f %4.2f %-*s %.2g %.2g %.2g", number,
             material, PLACE_COLS, place_text, way_name(s),
             (double)s->throughput.x, (double)s->throughput.y,
             (double)s->throughput.z, PDF_COLS, pdf_text, (double)s->light.x,
             (double)s->light.y, (double)s->light.z);
}

static double luminance(struct vec3 c)
{
    return 0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;
}

/* Formats the factor of a step. It is above 1 where the direction was chosen
 * less often than light goes there. */
static void format_weight(char text[WEIGHT_BYTES], double factor)
{
    if (factor < 1.005)
        snprintf(text, WEIGHT_BYTES, ", keeps %.0f %%", 100 * factor);
    else
        snprintf(text, WEIGHT_BYTES, ", counts %.2g times", factor);
}

/* Says what happens at the end of a step. `next` is the throughput after it, or
 * NULL if that is unknown. */
static void add_event(struct overlay_text *l, const struct overlay_names *names,
                      const struct path_record_step *s, const struct vec3 *next,
                      int number)
{
    static const char *const ends[] = {
        [PATH_RECORD_SKY] = "leaves the scene for the sky",
        [PATH_RECORD_ENDED] = "ends there",
        [PATH_RECORD_LIMIT] = "ends by the limit",
        [PATH_RECORD_CELL] = "ends at a cell of light",
        [PATH_RECORD_ROULETTE] = "ends by Russian roulette",
        [PATH_RECORD_SCATTERED] = "is scattered",
        [PATH_RECORD_REFLECTED] = "is reflected",
        [PATH_RECORD_TRANSMITTED] = "goes through",
    };
    double before = luminance(s->throughput);
    char material[MATERIAL_BYTES], keeps[WEIGHT_BYTES] = "";
    const char *light = luminance(s->light) > 0 ? ", finds light" : "";

    if (!is_at_surface(s)) {
        snprintf(next_line(l), OVERLAY_TEXT_BYTES, "%2d  %s%s", number,
                 ends[s->way], light);
        return;
    }
    text_width_cut(material, sizeof material,
                   overlay_material_of(names, s->hit.tri), EVENT_COLS);
    if (next && before > 0)
        format_weight(keeps, luminance(*next) / before);
    snprintf(next_line(l), OVERLAY_TEXT_BYTES, "%2d  hits %s%s%s, %s", number,
             material, light, keeps, ends[s->way]);
}

void overlay_text_path(struct overlay_text *l, const struct scene *scene,
                       const struct overlay_names *names,
                       const struct path_record *path, int count)
{
    int room = OVERLAY_TEXT_STEPS;

    l->count = 0;
    if (scene)
        snprintf(next_line(l), OVERLAY_TEXT_BYTES,
                 "%2s %-10s %-17s %-8s %-14s %-6s %s", "#", "material",
                 "position", "way", "throughput", "pdf", "light");
    for (int i = count > room ? count - room : 0; i < count; i++) {
        const struct path_record_step *step = &path->steps[i];
        const struct vec3 *next =
            i + 1 < path->count ? &path->steps[i + 1].throughput : NULL;

        if (scene)
            add_step(l, scene, names, step, i + 1);
        else
            add_event(l, names, step, next, i + 1);
    }
    snprintf(next_line(l), OVERLAY_TEXT_BYTES,
             "step %d of %d; the path brings light %.3g %.3g %.3g", count,
             path->vertices, (double)path->radiance.x, (double)path->radiance.y,
             (double)path->radiance.z);
}

static void add_direction(struct overlay_text *l, const char *name,
                          struct vec3 d)
{
    /* + 0 turns -0 into 0 */
    snprintf(next_line(l), OVERLAY_TEXT_BYTES, "%-22s %6.3f %6.3f %6.3f", name,
             (double)d.x + 0, (double)d.y + 0, (double)d.z + 0);
}

void overlay_text_lobes(struct overlay_text *l,
                        const struct overlay_names *names,
                        const struct path_record_lobes *lobes)
{
    struct vec3 sum = v3(0.0f, 0.0f, 0.0f);
    float cosine = f_min(v3_dot(lobes->wo, lobes->n), 1.0f);
    float lo = 0.0f, hi = 0.0f;
    char material[MATERIAL_BYTES];
    int deltas = 0;

    l->count = 0;
    for (int i = 0; i < lobes->count; i++) {
        float pdf = lobes->pdf[i];

        sum = v3_add(sum, lobes->weight[i]);
        hi = f_max(hi, pdf);
        lo = i == 0 ? pdf : f_min(lo, pdf);
        deltas += pdf == 0.0f ? 1 : 0;
    }
    text_width_cut(material, sizeof material,
                   overlay_material_of(names, lobes->tri), LOBES_COLS);
    snprintf(next_line(l), OVERLAY_TEXT_BYTES, "%s, seen %.1f degrees off n",
             material, angle_deg(acos((double)cosine)));
    add_direction(l, "n normal, green", lobes->n);
    add_direction(l, "t tangent, red", lobes->t);
    add_direction(l, "b bitangent, blue", lobes->b);
    snprintf(next_line(l), OVERLAY_TEXT_BYTES,
             "%d of %d samples go on, %d as deltas; pdf %.3g to %.3g",
             lobes->count, PATH_RECORD_LOBES, deltas, (double)lo, (double)hi);
    add_direction(l, "mean weight",
                  v3_scale(sum, 1.0f / (float)PATH_RECORD_LOBES));
}
