// SPDX-License-Identifier: MIT
#include "inspect/overlay_text.h"

#include <math.h>
#include <stdio.h>

#include "base/geometry.h"
#include "base/text_width.h"

#include "kernels/instance.h"

#define MATERIAL_COLS  10
#define LOBES_COLS     40 /* width of the material's name on its line */
#define MATERIAL_BYTES 160
#define EVENT_COLS     24 /* and in a sentence */
#define PLACE_COLS     17
#define PDF_COLS       6
#define NUMBERS_BYTES  64
#define WEIGHT_BYTES   32

/* Returns the name of a triangle's material, or words for none. */
static const char *material_of(const struct overlay_names *names, uint32_t tri)
{
    const struct world *w = names->world;
    const char *name =
        names->materials[tri_material(w, tri, instance_of(w, tri))];

    return *name ? name : "no material";
}

static char *next_line(struct overlay_text *l)
{
    return l->lines[l->count++];
}

static const char *way_name(const struct path_record_step *s)
{
    switch (s->way) {
    case PATH_RECORD_SKY: return "sky";
    case PATH_RECORD_ENDED: return "end";
    case PATH_RECORD_ROULETTE: return "roulette";
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

/* Formats numbers with up to three decimals, as many as fit into `cols`
 * columns: numbers must not be cut. */
static void format_numbers(char text[NUMBERS_BYTES], const double *values,
                           int count, int cols)
{
    int length = cols + 1;

    for (int digits = 3; digits > 0 && length > cols; digits--) {
        length = 0;
        for (int i = 0; i < count; i++)
            length += snprintf(text + length, (size_t)(NUMBERS_BYTES - length),
                               i > 0 ? " %.*g" : "%.*g", digits, values[i]);
    }
}

static void add_step(struct overlay_text *l, const struct scene *scene,
                     const struct overlay_names *names,
                     const struct path_record_step *s, int number)
{
    bool goes_on =
        s->way == PATH_RECORD_REFLECTED || s->way == PATH_RECORD_TRANSMITTED;
    double pdf = (double)s->pdf;
    double place[3] = {file_coordinate(scene, s->to.x, 0),
                       file_coordinate(scene, s->to.y, 1),
                       file_coordinate(scene, s->to.z, 2)};
    char place_text[NUMBERS_BYTES] = "";
    char pdf_text[NUMBERS_BYTES] = "";
    char material[MATERIAL_BYTES];

    if (s->way != PATH_RECORD_SKY)
        format_numbers(place_text, place, 3, PLACE_COLS);
    if (goes_on && pdf > 0)
        format_numbers(pdf_text, &pdf, 1, PDF_COLS);
    else if (goes_on)
        snprintf(pdf_text, sizeof pdf_text, "delta");
    text_width_fit(material, sizeof material,
                   s->way == PATH_RECORD_SKY ? ""
                                             : material_of(names, s->hit.tri),
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
        [PATH_RECORD_ROULETTE] = "ends by Russian roulette",
        [PATH_RECORD_REFLECTED] = "is reflected",
        [PATH_RECORD_TRANSMITTED] = "goes through",
    };
    double before = luminance(s->throughput);
    char material[MATERIAL_BYTES], keeps[WEIGHT_BYTES] = "";
    const char *light = luminance(s->light) > 0 ? ", finds light" : "";

    if (s->way == PATH_RECORD_SKY) {
        snprintf(next_line(l), OVERLAY_TEXT_BYTES, "%2d  %s%s", number,
                 ends[s->way], light);
        return;
    }
    text_width_cut(material, sizeof material, material_of(names, s->hit.tri),
                   EVENT_COLS);
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
    text_width_cut(material, sizeof material, material_of(names, lobes->tri),
                   LOBES_COLS);
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
