// SPDX-License-Identifier: MIT
#include "inspect/path_text.h"

#include <math.h>
#include <string.h>

#include "base/print.h"

#include "kernels/vec.h"

/* Columns of the table. */
#define EVENT_COLS      16
#define MATERIAL_COLS   12
#define DISTANCE_COLS   7
#define PLACE_COLS      22
#define NORMAL_COLS     16
#define THROUGHPUT_COLS 14

#define MATERIAL_BYTES (4 * MATERIAL_COLS + 1)

/* A table that is being printed. */
struct table {
    FILE *to;
    const struct scene *scene;
    const struct overlay_names *names;
    int count;          /* printed vertices */
    float wavelength;   /* of the last one, */
    const char *medium; /* and what its ray has gone through, or "" */
};

/* Returns what happens at the end of a step. */
static const char *event_of(const struct path_record_step *s)
{
    bool is_through = s->way == PATH_RECORD_TRANSMITTED;

    switch (s->way) {
    case PATH_RECORD_SKY: return "sky";
    case PATH_RECORD_ENDED: return "absorbed";
    case PATH_RECORD_LIMIT: return "limit";
    case PATH_RECORD_CELL: return "cell";
    case PATH_RECORD_ROULETTE: return "roulette";
    case PATH_RECORD_SCATTERED:
        return s->is_below ? "scatter below" : "scatter";
    case PATH_RECORD_REFLECTED:
    case PATH_RECORD_TRANSMITTED: break;
    }
    if (s->is_boundary)
        return "boundary";
    if (s->enters)
        return "enter";
    if (s->is_below)
        return "leave";
    if (s->pdf == 0.0f)
        return is_through ? "specular through" : "specular";
    if (s->is_diffuse)
        return is_through ? "diffuse through" : "diffuse";
    return is_through ? "glossy through" : "glossy";
}

static void format(char text[OVERLAY_NUMBERS_BYTES], struct vec3 v, int cols)
{
    const double numbers[3] = {(double)v.x, (double)v.y, (double)v.z};

    overlay_numbers(text, numbers, 3, cols);
}

/* Rounding errors of a direction become 0. */
static float without_rounding(float x)
{
    return fabsf(x) < 1e-6f ? 0.0f : x;
}

static void print_light(const struct table *t, const char *name, struct vec3 v)
{
    char text[OVERLAY_NUMBERS_BYTES];

    if (v3_is_zero(v))
        return;
    format(text, v, PLACE_COLS);
    print_line(t->to, "    + %-*s %s", EVENT_COLS - 2, name, text);
}

/* Returns the name of what the step's ray has gone through, or "". */
static const char *medium_name(const struct table *t,
                               const struct path_record_step *s)
{
    if (s->medium != NO_INDEX)
        return overlay_material(t->names, s->medium);
    return v3_is_zero(t->names->world->settings.fog.extinction) ? "" : "fog";
}

/* Prints what is not in all lines: another medium, and what the ray has
 * found. */
static void print_more(struct table *t, const struct path_record_step *s)
{
    const char *medium = medium_name(t, s);

    if (strcmp(medium, t->medium) != 0)
        print_line(t->to, "      %-*s %s", EVENT_COLS - 2, "in",
                   medium[0] != '\0' ? medium : "no medium");
    t->medium = medium;
    if (s->wavelength != t->wavelength)
        print_line(t->to, "      %-*s %.1f nm", EVENT_COLS - 2, "wavelength",
                   (double)s->wavelength);
    t->wavelength = s->wavelength;
    print_light(t, "found", v3_sub(s->light, s->sampled));
    print_light(t, "lamp sample", s->sampled);
}

static void print_camera(struct table *t, const struct path_record_step *s)
{
    char place_text[OVERLAY_NUMBERS_BYTES];
    double place[3];

    print_line(t->to, "%3s %-*s %-*s %-*s %-*s %-*s %s", "#", EVENT_COLS,
               "event", MATERIAL_COLS, "material", DISTANCE_COLS, "distance",
               PLACE_COLS, "position", NORMAL_COLS, "normal", "throughput");
    overlay_place(t->scene, s->from, place);
    overlay_numbers(place_text, place, 3, PLACE_COLS);
    print_line(t->to, "%3d %-*s %-*s %-*s %s", 0, EVENT_COLS, "camera",
               MATERIAL_COLS, "", DISTANCE_COLS, "", place_text);
}

static void print_step(void *context, const struct path_record_step *s)
{
    struct table *t = context;
    bool is_surface = s->hit.tri != NO_INDEX;
    char texts[3][OVERLAY_NUMBERS_BYTES] = {"", "", ""};
    char material[MATERIAL_BYTES], distance[16] = "";
    double place[3];

    if (t->count == 0)
        print_camera(t, s);
    if (s->way != PATH_RECORD_SKY) {
        overlay_place(t->scene, s->to, place);
        overlay_numbers(texts[0], place, 3, PLACE_COLS);
        snprintf(distance, sizeof distance, "%.4g",
                 (double)v3_length(v3_sub(s->to, s->from)) / t->scene->scale);
    }
    if (is_surface)
        format(texts[1],
               v3(without_rounding(s->n.x), without_rounding(s->n.y),
                  without_rounding(s->n.z)),
               NORMAL_COLS);
    format(texts[2], s->throughput, THROUGHPUT_COLS);
    text_width_fit(material, sizeof material,
                   is_surface ? overlay_material_of(t->names, s->hit.tri)
                   : s->way == PATH_RECORD_SCATTERED ? medium_name(t, s)
                                                     : "",
                   MATERIAL_COLS);
    print_line(t->to, "%3d %-*s %s %-*s %-*s %-*s %s", ++t->count, EVENT_COLS,
               event_of(s), material, DISTANCE_COLS, distance, PLACE_COLS,
               texts[0], NORMAL_COLS, texts[1], texts[2]);
    print_more(t, s);
}

struct vec3 path_text_print(FILE *to, const struct scene *scene,
                            const struct overlay_names *names,
                            struct sample_id id)
{
    struct table t = {.to = to, .scene = scene, .names = names, .medium = ""};

    return path_record_each(names->world, id, print_step, &t);
}

void path_text_light(FILE *to, const char *name, struct vec3 light)
{
    print_line(to, "%-*s %.9g %.9g %.9g", EVENT_COLS + 4, name, (double)light.x,
               (double)light.y, (double)light.z);
}
