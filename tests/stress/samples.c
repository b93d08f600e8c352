// SPDX-License-Identifier: MIT
/*
 * samples - sums, random numbers and weights over long renders
 *
 * usage: samples [opencl]
 */
#include "stress_scene.h"
#include "tests/unit/mesh.h"
#include "tests/unit/sky_pdf.h"

#include "image/color.h"
#include "world/light/lights.h"
#include "world/light/sky_table.h"
#include "world/bvh/ray_queries.h"

#include "kernels/path_lights.h"

/* Roulette of the paths in this program: glim's, a plain one from the first
 * vertex on, or none. */
static enum { ROULETTE_OURS, ROULETTE_PLAIN, ROULETTE_NONE, ROULETTES } played;

static float played_survival(struct vec3 beta, uint32_t vertex)
{
    if (played == ROULETTE_OURS)
        return roulette_survival(beta, vertex);
    if (played == ROULETTE_PLAIN)
        return f_min(v3_max_component(beta), 1.0f);
    return v3_max_component(beta) > 0.0f ? 1.0f : 0.0f;
}

#define roulette_survival played_survival
#include "kernels/path.h"

/* Adds the closed room of geometry.c, where every pixel's radiance is 1. */
static void put_room(struct stress_scene *s)
{
    stress_scene_begin(s);
    put_material(s, "room", "Kd .5 .5 .5\nKe .5 .5 .5");
    put_box(s, (double[]){-1, -1, -1}, (double[]){1, 1, 1});
    stress_scene_end(s);
}

static struct shot room_shot(int side_px, uint64_t spp, uint32_t seed)
{
    return (struct shot){.eye = {0.1, 0.2, 0.9},
                         .at = {0.1, 0, 0},
                         .fovy_deg = 90,
                         .side_px = side_px,
                         .spp = spp,
                         .seed = seed};
}

/* Returns the correlation of one picture's errors with another's, shifted. */
static double correlation(const float *one, const float *other, int side, int x,
                          int y)
{
    double sum = 0, ones = 0, others = 0;

    for (int j = y; j < side; j++)
        for (int i = x; i < side; i++) {
            double a = (double)one[3 * (j * side + i)] - 1;
            double b = (double)other[3 * ((j - y) * side + i - x)] - 1;

            sum += a * b;
            ones += a * a;
            others += b * b;
        }
    return sum / sqrt(ones * others);
}

/* C7: for 256 x 256 uncorrelated pixels 0.02 is 5 standard errors, once in 2e6
 * (two-sided). There are 14 numbers per backend. */
#define CORRELATION 0.02

static void check_streams(struct stress_scene *s)
{
    static const int shifts[][2] = {{1, 0}, {0, 1}, {1, 1}, {2, 0},
                                    {0, 2}, {8, 0}, {0, 8}};
    struct shot shots[] = {room_shot(256, 4, 0),
                           room_shot(256, 4, 0xffffffffu)};
    struct outcome o[2];

    put_room(s);
    for (int i = 0; i < 2; i++)
        o[i] = stress_scene_render(s, &shots[i], 1);
    for (size_t i = 0; i < sizeof shifts / sizeof shifts[0]; i++) {
        double r =
            correlation(o[0].rgb, o[0].rgb, 256, shifts[i][0], shifts[i][1]);

        row(fabs(r) < CORRELATION, "C7",
            "errors of pixels %d, %d apart: correlation %.4f, want 0 within "
            "%g",
            shifts[i][0], shifts[i][1], r, CORRELATION);
    }
    for (size_t i = 0; i < sizeof shifts / sizeof shifts[0]; i++) {
        double r =
            correlation(o[0].rgb, o[1].rgb, 256, i == 0 ? 0 : shifts[i][0],
                        i == 0 ? 0 : shifts[i][1]);

        row(fabs(r) < CORRELATION, "C7 C8",
            "errors of seeds 0 and 2^32-1, shift %d: correlation %.4f, want 0 "
            "within %g",
            (int)i, r, CORRELATION);
    }
    free(o[0].rgb);
    free(o[1].rgb);
}

static double squared_error(struct stress_scene *s, int side_px, uint64_t spp)
{
    struct shot shot = room_shot(side_px, spp, 1);
    struct outcome o = stress_scene_render(s, &shot, 1);
    double sum = 0;

    for (size_t i = 0; i < o.number_count; i++)
        sum += pow((double)o.rgb[i] - 1, 2) / (double)o.number_count;
    free(o.rgb);
    return sum;
}

/* C7: the error falls at least as fast as 1 / n. The mean of 64 squares of
 * normal numbers has a standard error of sqrt(2 / 64), and chance exceeds 4.9
 * of these once in 1e6. */
static void check_slope(struct stress_scene *s)
{
    const double slack = 1 + 4.9 * sqrt(2 / 64.0);
    double begin, end;

    put_room(s);
    begin = squared_error(s, 64, 16) * 16;
    end = squared_error(s, 8, 100000) * 100000;
    row(end <= begin * slack, "C7",
        "variance times samples: %.4g at 16, %.4g at 100000, want at most %.4g",
        begin, end, begin * slack);
}

static void check_seeds(struct stress_scene *s)
{
    struct shot shot = room_shot(SIDE_PX, 64, 0xfffffffau);
    struct outcome o;

    put_room(s);
    o = stress_scene_render(s, &shot, SEEDS);
    row(fabs(o.mean - 1) <= T_LIMIT * o.error && o.last.non_finite == 0, "C8",
        "seeds from 2^32-6 over 0 to 5: %.6g, want 1, off by %.2g of %.2g",
        o.mean, fabs(o.mean - 1), T_LIMIT * o.error);
    free(o.rgb);
}

/* Makes the same room for single paths. */
static void make_furnace(struct mesh *m)
{
    *m = (struct mesh){0};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m->materials[0].emission = v3(0.5f, 0.5f, 0.5f);
    mesh_add_box(m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_finish(m);
}

static double path_error(const struct world *w, uint64_t index)
{
    struct ray r = {v3(0.1f, 0.2f, 0.3f), v3_unit(v3(1, 0.3f, 0.2f)), FLOAT_MAX,
                    0, 0};

    return (double)path_trace(
               w, (struct camera_sample){r, sampler_start(3, 5, index, 0), 0},
               NULL)
               .radiance.x -
           1;
}

/* C8: samples around and beyond number 2^32 have the right mean, and differ
 * from those that begin at 0. */
static void check_late_samples(void)
{
    const int count = 200000;
    const uint64_t first = ((uint64_t)1 << 32) - (uint64_t)(count / 2);
    struct mesh m;
    double sum = 0, squares = 0, product = 0, others = 0, mean, error, r;

    make_furnace(&m);
    for (int i = 0; i < count; i++) {
        double late = path_error(&m.world, first + (uint64_t)i);
        double early = path_error(
            &m.world, (uint64_t)i + (uint64_t)(i < count / 2 ? 0 : -count / 2));

        sum += late;
        squares += late * late;
        others += early * early;
        product += late * early;
    }
    mean = sum / count;
    error = sqrt(squares / count / count);
    r = product / sqrt(squares * others);
    row(fabs(mean) < 4.9 * error, "C8",
        "samples around number 2^32: %.5f, want 1, off by %.2g of %.2g",
        1 + mean, fabs(mean), 4.9 * error);
    row(fabs(r) < 4.9 / sqrt(count), "C8",
        "and those from 0 on: correlation %.4f, want 0 within %.4f", r,
        4.9 / sqrt(count));
    mesh_free(&m);
}

/* C6: sums of many samples are exact. */
static void check_sums(void)
{
    const int more = 1 << 25;

    for (int power = 0; power <= 40; power += power == 0 ? 24 : 8) {
        uint64_t count = power == 0 ? 0 : (uint64_t)1 << power;
        struct sum s = {0, count}; /* this many samples of 1 */
        double mean, want;

        for (int i = 0; i < more; i++)
            sum_add(&s, 3.0f);
        mean = (double)sum_float(s) / ((double)count + more);
        want = ((double)count + 3.0 * more) / ((double)count + more);
        row(fabs(mean / want - 1) < 0x1p-22, "C6",
            "2^25 samples of 3 after 2^%d of 1: mean %.9g, want %.9g", power,
            mean, want);
    }
}

/* C6: a film with 2^40 samples per pixel can add more. */
static void check_film(void)
{
    const uint64_t count = (uint64_t)1 << 40;
    const struct sum sums[3] = {{0, count}, {0, count}, {0, count}};
    struct path_sample samples[8];
    struct film film;
    struct error err;
    float rgb[3];

    if (!film_init(&film, 1, 1, &err))
        stress_scene_stop(err.text);
    film_store_row(&film, (struct film_pixels){0, 0, 1, 1}, sums, sums, NULL,
                   &count);
    for (int i = 0; i < 8; i++)
        samples[i] = (struct path_sample){.radiance = {1, 1, 1}};
    film_add_row(&film, (struct film_pixels){0, 0, 1, 1}, samples, NULL,
                 (const int[]){8});
    film_linear(&film, rgb);
    row(film_count(&film, 0, 0) == count + 8 && rgb[0] == 1, "C6",
        "a pixel of 2^40 and 8 samples has %llu, mean %.9g, want 1",
        (unsigned long long)film_count(&film, 0, 0), (double)rgb[0]);
    film_free(&film);
}

/* C9: floats of all 2^32 words are in [0, 1). */
static void check_unit_floats(void)
{
    uint64_t outside = 0;
    float most = 0;

    for (uint64_t bits = 0; bits < (uint64_t)1 << 32; bits++) {
        float u = unit_float((uint32_t)bits);

        outside += !(u >= 0.0f && u < 1.0f);
        most = f_max(most, u);
    }
    row(outside == 0, "C9",
        "numbers of 2^32 words: outside [0, 1): %llu, want 0; the greatest is "
        "1 - %g",
        (unsigned long long)outside, 1 - (double)most);
}

static bool is_fine(struct bsdf_sample s)
{
    float sum = s.weight.x + s.weight.y + s.weight.z + s.wi.x + s.wi.y + s.wi.z;

    return isfinite(sum) && v3_max_component(s.weight) >= 0.0f &&
           (s.is_delta || (isfinite(s.pdf) && s.pdf > 0.0f));
}

/* Ends of the range of random numbers. */
static const float ends[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-23f, 1 - 0x1p-24f};

/* C9: BSDFs at the ends of random numbers, at grazing and normal incidence. */
static void check_extremes(void)
{
    static const uint32_t kinds[] = {MATERIAL_DIFFUSE,   MATERIAL_ROUGH_DIFFUSE,
                                     MATERIAL_METAL,     MATERIAL_PLASTIC,
                                     MATERIAL_GLASS,     MATERIAL_THIN_GLASS,
                                     MATERIAL_PRINCIPLED};
    static const float heights[] = {1e-6f, 1e-3f, 0.5f, 1};
    static const float alphas[] = {0, ALPHA_SMOOTH, 0.1f, 1};
    int bad = 0, drawn = 0;

    for (int i = 0; i < 7 * 4 * 4 * 125; i++) {
        float z = heights[i / 125 % 4];
        struct vec3 wo = v3(sqrtf(1 - z * z), 0, z);
        struct bsdf b = {.color = {1, 1, 1},
                         .specular = {0.04f, 0.04f, 0.04f},
                         .alpha = alphas[i / 500 % 4],
                         .kind = kinds[i / 2000],
                         .eta = 1.5f,
                         .metalness = 0.3f,
                         .transmission = 0.4f,
                         .coat = 0.5f,
                         .coat_alpha = alphas[(i / 500 + 1) % 4]};
        struct bsdf_sample s;

        if (!bsdf_sample(&b, wo, v2(ends[i % 5], ends[i / 5 % 5]),
                         ends[i / 25 % 5], &s))
            continue;
        drawn++;
        bad += !is_fine(s);
    }
    row(bad == 0 && drawn > 6000, "C9 M4",
        "BSDFs at the ends of random numbers: %d drawn, not finite or "
        "negative: %d, want 0",
        drawn, bad);
}

/* Makes lamps of sizes from 1 to 1e-8, and a sky of few texels, one of them
 * black. */
static void make_lights(struct mesh *m, struct lights *lights,
                        struct sky_table *table)
{
    static const struct vec3 texels[8] = {{1, 1, 1}, {2, 2, 2}, {0, 0, 0},
                                          {3, 3, 3}, {4, 4, 4}, {1, 1, 1},
                                          {9, 9, 9}, {1, 1, 1}};
    struct error err;

    *m = (struct mesh){0};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0);
    m->materials[0].emission = v3(1, 1, 1);
    for (int i = 0; i < 9; i++) {
        float size = powf(10, (float)-i), x = (float)i / 4 - 1;

        mesh_add(m, v3(x, 0, 0), v3(x + size, 0, 0), v3(x, 0, size), 0);
    }
    mesh_finish(m);
    *lights = (struct lights){.lights = NULL};
    *table = (struct sky_table){NULL};
    m->world.settings.sky = (struct sky){{1, 1, 1}, 4, 2, 0, 1, 0};
    m->world.sky_texels = texels;
    if (!lights_build(lights, &m->world, &err) ||
        !sky_table_build(table, texels, 4, 2, SKY_ALONE, &err))
        stress_scene_stop(err.text);
    lights_lend(lights, &m->world);
    sky_table_lend(table, &m->world);
}

static bool is_light(const struct world *w, const struct receiver *r,
                     const struct light_sample *s)
{
    float sum = s->radiance.x + s->radiance.y + s->radiance.z;
    float again = s->tri == NO_INDEX ? sky_light_pdf(w, r, s->wi)
                                     : light_pdf_at(w, r, s->tri, s->p);

    return isfinite(sum) && sum >= 0.0f && isfinite(s->pdf) && s->pdf > 0.0f &&
           s->pdf == again && fabsf(v3_length(s->wi) - 1) < 1e-5f;
}

/* C9: lights at the ends of random numbers, seen from far, from near and from
 * their corners, from the front, the back and grazing. */
static void check_light_extremes(void)
{
    static const float distances[] = {0,     1e-30f, 1e-15f, 1e-6f,
                                      1e-3f, 1,      1e3f,   1e6f};
    static const struct vec3 normals[] = {
        {0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {1, 1e-6f, 0}, {1, -1e-6f, 0}};
    static const struct vec3 away[] = {{0, 1, 0},
                                       {1, 0, 0},
                                       {0.6f, 1e-6f, 0.8f}};
    int bad = 0, drawn = 0, of_sky = 0;
    struct sky_table table;
    struct lights lights;
    struct mesh m;

    make_lights(&m, &lights, &table);
    for (int i = 0; i < 9 * 8 * 5 * 3 * 625; i++) {
        struct vec3 from = m.positions[3 * (i / 625 % 9)];
        struct receiver r = {.n = normals[i / 45000 % 5],
                             .transmits = i % 2 == 0};
        struct light_sample s;

        r.p = v3_add(from, v3_scale(away[i / 225000], distances[i / 5625 % 8]));
        if (!light_sample(&m.world, &r, NO_INDEX,
                          v2(ends[i % 5], ends[i / 5 % 5]),
                          v2(ends[i / 25 % 5], ends[i / 125 % 5]), &s))
            continue;
        drawn++;
        of_sky += s.tri == NO_INDEX;
        bad += !is_light(&m.world, &r, &s);
    }
    row(bad == 0 && of_sky > 10000 && drawn - of_sky > 10000, "C9",
        "lights at the ends of random numbers: %d drawn, %d of them the sky; "
        "not finite, or of another density than by chance: %d, want 0",
        drawn, of_sky, bad);
    sky_table_free(&table);
    lights_free(&lights);
    mesh_free(&m);
}

/* M14: MIS weights for densities of 0 and over the whole range of floats. */
static void check_weights(void)
{
    struct world w = {.settings = {.direct = DIRECT_MIS}};
    double worst = 0;
    int count = 0;

    for (float a = 1e-35f; a < 1e35f; a *= 10)
        for (float b = 1e-35f; b < 1e35f; b *= 10) {
            double sum = (double)bsdf_mis_weight(&w, a, b) +
                         (double)light_mis_weight(&w, b, a);

            worst = fmax(worst, isfinite(sum) ? fabs(sum - 1) : INFINITY);
            count++;
        }
    row(worst < 1e-6, "M14",
        "%d pairs of densities: weights add up to 1 "
        "within %.2g, want 1e-6",
        count, worst);
    row(bsdf_mis_weight(&w, 0, 5) == 1 && bsdf_mis_weight(&w, 5, 0) == 1 &&
            light_mis_weight(&w, 5, 0) == 1,
        "M14", "one density 0: the other way weighs %g, %g and %g, want 1",
        (double)bsdf_mis_weight(&w, 0, 5), (double)bsdf_mis_weight(&w, 5, 0),
        (double)light_mis_weight(&w, 5, 0));
}

/* M13: roulette with invalid weights. */
static void check_roulette(void)
{
    struct path dead = {.vertex = 2, .beta = {0, 0, 0}};
    struct path bad = {.vertex = 2, .beta = {NAN, NAN, NAN}};
    struct path bright = {.vertex = 2, .beta = {4, 4, 4}};

    row(!path_survives(&dead, 0) && !path_survives(&bad, 0) &&
            path_survives(&bright, 1 - 0x1p-24f) && bright.beta.x == 4,
        "M13", "weights 0 and NaN end, 4 goes on with weight %g, want 4",
        (double)bright.beta.x);
}

/* Makes the furnace around clear glass, which is invisible in it: roulette
 * ignores the factor of refraction. */
static void make_glass_furnace(struct mesh *m)
{
    *m = (struct mesh){0};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m->materials[0].emission = v3(0.5f, 0.5f, 0.5f);
    m->materials[1] = mesh_material(MATERIAL_GLASS, 1);
    mesh_add_box(m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_box(m, v3(-0.5f, -0.5f, -0.6f), v3(0.5f, 0.4f, 0.6f), 1);
    mesh_finish(m);
}

/* Makes a coloured room with a lamp in a corner, for throughputs of all
 * kinds. */
static void make_lit_room(struct mesh *m)
{
    *m = (struct mesh){0};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m->materials[0].color = v3(0.9f, 0.5f, 0.1f);
    m->materials[1] = mesh_material(MATERIAL_DIFFUSE, 0);
    m->materials[1].emission = v3(1, 2, 4);
    mesh_add_box(m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_box(m, v3(0.2f, -1, -1), v3(0.9f, 0, -0.5f), 1);
    mesh_finish(m);
}

struct mean {
    double value, error;
};

/* Each path has its own pixel, so that they are independent. */
static struct mean mean_of_paths(const struct world *w, uint32_t row)
{
    const uint32_t count = 100000;
    double sum = 0, squares = 0;
    struct mean m;

    for (uint32_t i = 0; i < count; i++) {
        struct ray r = {v3(0.7f, 0.8f, 0.9f), v3_unit(v3(-1, -1.1f, -1.2f)),
                        FLOAT_MAX, 0, 0};
        struct vec3 c =
            path_trace(w,
                       (struct camera_sample){r, sampler_start(i, row, 0, 0),
                                              0},
                       NULL)
                .radiance;
        double x = ((double)c.x + (double)c.y + (double)c.z) / 3;

        sum += x;
        squares += x * x;
    }
    m.value = sum / count;
    m.error = sqrt(fmax(squares / count - m.value * m.value, 0) / count);
    return m;
}

/* M13: every roulette has the same mean. Chance exceeds 4.9 standard errors
 * once in 1e6 (two-sided), for each of 6 numbers. */
static void check_roulettes(void)
{
    static const char *const names[] = {"glim's", "a plain one", "none"};
    struct mesh furnace, room;
    struct mean lit[ROULETTES];

    make_glass_furnace(&furnace);
    make_lit_room(&room);
    /* Without roulette a path ends here, with at most 2e-6 of its weight. */
    furnace.world.settings.max_vertices = 128;
    room.world.settings.max_vertices = 128;
    for (int i = 0; i < ROULETTES; i++) {
        struct mean m;

        played = i;
        m = mean_of_paths(&furnace.world, (uint32_t)i);
        row(fabs(m.value - 1) < 4.9 * m.error + ROUNDING, "M13",
            "a furnace with glass, roulette: %s: %.5f, want 1, off by %.2g of "
            "%.2g",
            names[i], m.value, fabs(m.value - 1), 4.9 * m.error + ROUNDING);
        lit[i] = mean_of_paths(&room.world, (uint32_t)i);
    }
    played = ROULETTE_OURS;
    for (int i = 0; i < ROULETTES; i++) {
        const struct mean *a = &lit[i], *b = &lit[(i + 1) % ROULETTES];
        double allowed = 4.9 * hypot(a->error, b->error) + ROUNDING;

        row(fabs(a->value - b->value) < allowed, "M13",
            "a lit room, roulette: %s or %s: %.5f and %.5f, apart by %.2g of "
            "%.2g",
            names[i], names[(i + 1) % ROULETTES], a->value, b->value,
            fabs(a->value - b->value), allowed);
    }
    mesh_free(&furnace);
    mesh_free(&room);
}

/* M15: luminance is 1 by the weights of Rec.709, and no channel is negative. */
static void check_black_bodies(void)
{
    static const double kelvins[] = {BLACKBODY_MIN, 100, 500, 1e6,
                                     BLACKBODY_MAX};

    for (size_t i = 0; i < sizeof kelvins / sizeof kelvins[0]; i++) {
        double rgb[3], y;

        blackbody_rgb(kelvins[i], rgb);
        y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        row(rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0 && fabs(y - 1) < 1e-3,
            "M15", "%g K: %g %g %g, luminance %.5f, want 1", kelvins[i], rgb[0],
            rgb[1], rgb[2], y);
    }
}

int main(int argc, char **argv)
{
    struct stress_scene s;

    (void)argv;
    if (argc == 1) {
        check_sums();
        check_film();
        check_unit_floats();
        check_extremes();
        check_light_extremes();
        check_weights();
        check_roulette();
        check_roulettes();
        check_black_bodies();
        check_late_samples();
    }
    if (!stress_scene_open(&s, argc > 1))
        return rows_status();
    check_streams(&s);
    check_seeds(&s);
    check_slope(&s);
    stress_scene_close(&s);
    return rows_status();
}
