// SPDX-License-Identifier: MIT
/*
 * light - pictures of materials, lights and skies at the ends of their ranges
 *
 * usage: light [opencl]
 */
#include "lamp.h"

/* Bound for clear glass with shading normals that differ from those of the
 * faces, by up to 7 degrees on these balls. Total reflection keeps this part of
 * the paths inside until they are cut. */
#define LEANING 1.3e-3

/* The BSDFs' tables differ from white by less than this; see test_path and
 * test_energy. */
#define TABLES 3e-3

/* Adds a ball of radius 0.5 with its own normals, scaled, or wrong; see the
 * enum. */
enum normals {
    NORMALS_NONE,
    NORMALS_UNIT,
    NORMALS_LONG,
    NORMALS_INWARDS,
    NORMALS_ZERO,
    NORMALS_NAN
};

static void put_ball(struct stress_scene *s, double radius,
                     enum normals normals)
{
    static const double lengths[] = {0, 1, 1e3, -1, 0, 0};
    const int rows = 16, columns = 24;

    for (int i = 0; i <= rows; i++)
        for (int j = 0; j < columns; j++) {
            double theta = M_PI * i / rows, phi = 2 * M_PI * j / columns;
            double wide = i % rows == 0 ? 0 : sin(theta);
            double n[3] = {wide * cos(phi), cos(theta), -wide * sin(phi)};
            double l = lengths[normals];

            put_vertex(s, radius * n[0], radius * n[1], radius * n[2]);
            if (normals == NORMALS_NAN)
                fprintf(s->obj, "vn nan %g inf\n", n[1]);
            else
                fprintf(s->obj, "vn %.17g %.17g %.17g\n", l * n[0], l * n[1],
                        l * n[2]);
        }
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            /* Quads at the poles are triangles. */
            const int first = i == 0 ? 1 : 0, last = i == rows - 1 ? 2 : 3;
            const int of_all = (rows + 1) * columns;
            int k[4] = {i * columns + (j + 1) % columns, i * columns + j,
                        (i + 1) * columns + j,
                        (i + 1) * columns + (j + 1) % columns};

            fprintf(s->obj, "f");
            for (int c = first; c <= last; c++)
                if (normals == NORMALS_NONE)
                    fprintf(s->obj, " %d", k[c] - of_all);
                else
                    fprintf(s->obj, " %d//%d", k[c] - of_all, k[c] - of_all);
            fprintf(s->obj, "\n");
        }
}

/* M1, M2: normals of all kinds. */
static void ball_with_normals(struct stress_scene *s, double normals)
{
    put_material(s, "white", "Kd 1 1 1");
    put_ball(s, 0.5, (enum normals)normals);
}

/* M1: a mirror. */
static void mirror_ball(struct stress_scene *s, double alpha)
{
    put_material(s, "white",
                 alpha > 0 ? "illum 3\nKs 1 1 1\nPr .5"
                           : "illum 3\nKs 1 1 1\nPr 0");
    put_ball(s, 0.5, NORMALS_UNIT);
}

static void glass_ball(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "white", "illum 7\nNi 1.5");
    put_ball(s, 0.5, NORMALS_UNIT);
}

/* White objects in a white sky are invisible. */
static const struct {
    const char *name, *what, *lines;
    double bias;
    bool warns;
} white_things[] = {
    {"M3", "glass of ior 1", "illum 7\nNi 1", 0, false},
    {"M3", "glass of ior 1.0001", "illum 7\nNi 1.0001", 0, false},
    {"M3", "glass of ior .75", "illum 7\nNi .75", 0, false},
    {"M3", "glass of ior 1e6", "illum 7\nNi 1e6", 0, false},
    {"M3", "glass of ior 0", "illum 7\nNi 0", 0, true},
    {"M3", "glass of ior -1", "illum 7\nNi -1", 0, true},
    {"M3", "glass of ior NaN", "illum 7\nNi nan", 0, true},
    {"M4", "metal of alpha 0", "illum 3\nKs 1 1 1\nPr 0", 0, false},
    {"M4", "metal of alpha 1e-8", "illum 3\nKs 1 1 1\nPr 1e-4", 0, false},
    {"M4", "metal of alpha 1e-4", "illum 3\nKs 1 1 1\nPr 1e-2", 0, false},
    {"M4", "metal of alpha 1e-3", "illum 3\nKs 1 1 1\nPr .0316", TABLES, false},
    {"M4", "metal of alpha 1", "illum 3\nKs 1 1 1\nPr 1", TABLES, false},
    {"M4", "glass of alpha 1e-8", "illum 7\nNi 1.5\nPr 1e-4", 0, false},
    {"M4", "glass of alpha 1", "illum 7\nNi 1.5\nPr 1", 4 * TABLES, false},
    {"M5", "albedo 1", "Kd 1 1 1", 0, false},
    {"M5", "albedo 2", "Kd 2 2 2", 0, true},
};

static void white_ball(struct stress_scene *s, double thing)
{
    put_material(s, "white", white_things[(int)thing].lines);
    put_ball(s, 0.5, NORMALS_NONE);
}

static void check_white_things(struct stress_scene *s)
{
    for (size_t i = 0; i < sizeof white_things / sizeof white_things[0]; i++) {
        struct truth t = {white_things[i].name,
                          white_things[i].what,
                          white_ball,
                          (double)i,
                          1,
                          white_things[i].bias,
                          {.eye = {0, 0.5, 3},
                           .at = {0, 0, 0},
                           .fovy_deg = 22,
                           .background = 1},
                          white_things[i].warns};

        check_truth(s, &t);
    }
}

/* M5: a negative albedo is black. */
static void negative_albedo(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "negative", "Kd -1 -1 -1");
    put_quad(s, 1, 0, (double[]){-9, -9}, (double[]){9, 9});
}

/* M6: a view from inside glass straight out shows the sky times ior squared,
 * less the reflected part, which leaves elsewhere. */
static void glass_cube(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "glass", "illum 7\nNi 1.5");
    put_box(s, (double[]){-1, -1, -1}, (double[]){1, 1, 1});
}

/* M6: a prism turns a view along the z axis by 90 degrees to a lamp on the
 * right. Two faces transmit 96 %, the third reflects everything. Reflected
 * light leaves the way it came, to the black sky. */
static void prism(struct stress_scene *s, double number)
{
    const double p[6][3] = {{-1, -1, 1}, {1, -1, 1}, {1, -1, -1},
                            {-1, 1, 1},  {1, 1, 1},  {1, 1, -1}};

    (void)number;
    put_material(s, "glass", "illum 7\nNi 1.5");
    for (int i = 0; i < 6; i++)
        put_vertex(s, p[i][0], p[i][1], p[i][2]);
    fprintf(s->obj, "f -6 -4 -5\nf -3 -2 -1\nf -6 -5 -2 -3\nf -5 -4 -1 -2\n"
                    "f -4 -6 -3 -1\n");
    put_shining(s, "lamp", 1);
    put_quad(s, 0, 2, (double[]){-1, -1}, (double[]){1, 1});
}

/* M7: two balls that intersect (0), two cubes that touch (1), an open sheet
 * (2). */
static void odd_glass(struct stress_scene *s, double kind)
{
    put_material(s, "glass", "illum 7\nNi 1.5");
    if (kind == 0) {
        put_ball(s, 0.5, NORMALS_NONE);
        put_ball(s, 0.4, NORMALS_NONE);
        put_box(s, (double[]){0.1, -0.3, -0.3}, (double[]){0.8, 0.3, 0.3});
    } else if (kind == 1) {
        put_box(s, (double[]){-0.5, -0.3, -0.3}, (double[]){0, 0.3, 0.3});
        put_box(s, (double[]){0, -0.3, -0.3}, (double[]){0.5, 0.3, 0.3});
    } else {
        put_quad(s, 2, 0, (double[]){-1, -1}, (double[]){1, 1});
    }
}

static void lamp_over_floor(struct stress_scene *s, double radiance)
{
    put_floor(s);
    put_shining(s, "lamp", radiance);
    put_quad(s, 1, 0.7, lamp_lo, lamp_hi);
}

/* M9: a lamp beside one of radiance 0. */
static void lamp_and_dark(struct stress_scene *s, double number)
{
    (void)number;
    lamp_over_floor(s, 1);
    put_shining(s, "dark", 0);
    put_quad(s, 1, 0.8, lamp_lo, lamp_hi);
}

/* M9: the lamp as 2 side^2 triangles, and as many without area. */
static void many_lamps(struct stress_scene *s, double side)
{
    const int n = (int)side;

    put_floor(s);
    put_shining(s, "lamp", 1);
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++)
            put_vertex(s, i * 0.8 / n - 0.4, 0.7, j * 0.6 / n - 0.3);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            int k = 5 + i * (n + 1) + j; /* the floor has the first ones */

            fprintf(s->obj, "f %d %d %d %d\n", k, k + 1, k + n + 2, k + n + 1);
            if (j == 0)
                fprintf(s->obj, "f %d %d %d\n", k, k, k + 1);
        }
}

static void no_lamp(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "floor", "Kd .6 .6 .6\nKe 0 0 0");
    put_quad(s, 1, 0, (double[]){-9, -9}, (double[]){9, 9});
}

/* M11: an emitting wall, 1 high and 2 wide, on the floor. */
static void wall_lamp(struct stress_scene *s, double number)
{
    (void)number;
    put_floor(s);
    put_shining(s, "lamp", 1);
    put_quad(s, 0, 0, (double[]){0, -1}, (double[]){1, 1});
}

static double beside_wall(double distance)
{
    const struct receiver r = {.n = {0, 1, 0}};
    const float x = (float)-distance;
    const struct vec3 lamp[4] = {{x, 0, -1}, {x, 0, 1}, {x, 1, 1}, {x, 1, -1}};

    return 0.6 / M_PI * lambert(lamp, 4, &r);
}

/* M11: a floor with a lamp in its plane. */
static void flush_floor(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "floor", "Kd .6 .6 .6");
    put_quad(s, 1, 0, (double[]){-2, 0.1}, (double[]){2, 2});
    put_shining(s, "lamp", 1);
    put_quad(s, 1, 0, (double[]){-2, -2}, (double[]){2, 0});
}

/* M12: a lamp in the plane of a ceiling, before it in the file (0), after it
 * (1), or lower by this number. */
static void flush_lamp(struct stress_scene *s, double number)
{
    put_floor(s);
    for (int i = 0; i < 2; i++)
        if ((i == 0) == (number != 1)) {
            put_shining(s, "lamp", 1);
            put_quad(s, 1, 0.7 - (number < 1 ? number : 0), lamp_lo, lamp_hi);
        } else {
            put_material(s, "ceiling", "Kd 0 0 0");
            put_quad(s, 1, 0.7, (double[]){-2, -2}, (double[]){2, 2});
        }
}

/* M13: a closed room of this albedo whose emission makes the radiance 1. */
static void furnace(struct stress_scene *s, double albedo)
{
    char lines[128];
    double ke = 1 - albedo;

    snprintf(lines, sizeof lines, "Kd %.9g %.9g %.9g\nKe %.9g %.9g %.9g",
             albedo, albedo, albedo, ke, ke, ke);
    put_material(s, "room", lines);
    put_box(s, (double[]){-1, -1, -1}, (double[]){1, 1, 1});
}

/* M15: a black body of this temperature and luminance 1. */
static void black_body(struct stress_scene *s, double kelvin)
{
    char lines[64];

    snprintf(lines, sizeof lines, "Kd 0 0 0\nKe_blackbody %g", kelvin);
    put_material(s, "lamp", lines);
    put_quad(s, 1, 0, (double[]){-9, -9}, (double[]){9, 9});
}

/* M16: a bright face of a ten thousandth of a square. */
static void speck(struct stress_scene *s, double radiance)
{
    put_shining(s, "speck", radiance);
    put_quad(s, 1, 0, (double[]){-0.01, -0.01}, (double[]){0.01, 0.01});
}

/* A sky of `width` x `height` texels of radiance `rest`, except one of `hot`,
 * in Radiance HDR or in PFM, which may have invalid radiance. */
struct sky_file {
    int width, height, hot_row;
    double rest, hot;
    bool is_pfm;
};

static double sky_texel(const struct sky_file *sky, int x, int y)
{
    return y == sky->hot_row && x == sky->width / 3 ? sky->hot : sky->rest;
}

static void put_hdr_texel(FILE *f, double radiance)
{
    int exponent = 0;
    double mantissa = frexp(radiance, &exponent);
    int byte = (int)(mantissa * 256);

    putc(byte, f);
    putc(byte, f);
    putc(byte, f);
    putc(radiance > 0 ? exponent + 128 : 0, f);
}

static void put_hdr(FILE *f, const struct sky_file *sky)
{
    fprintf(f, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n",
            sky->height, sky->width);
    for (int y = 0; y < sky->height; y++)
        for (int x = 0; x < sky->width; x++)
            put_hdr_texel(f, sky_texel(sky, x, y));
}

/* PFM rows begin at the bottom. */
static void put_pfm(FILE *f, const struct sky_file *sky)
{
    fprintf(f, "PF\n%d %d\n-1\n", sky->width, sky->height);
    for (int y = sky->height - 1; y >= 0; y--)
        for (int x = 0; x < sky->width; x++) {
            float radiance = (float)sky_texel(sky, x, y);

            for (int c = 0; c < 3; c++)
                fwrite(&radiance, sizeof radiance, 1, f);
        }
}

static void write_sky(const struct sky_file *sky)
{
    FILE *f = fopen("sky", "wb");

    if (f == NULL)
        stress_scene_stop("cannot write the sky");
    if (sky->is_pfm)
        put_pfm(f, sky);
    else
        put_hdr(f, sky);
    if (fclose(f) != 0)
        stress_scene_stop("cannot write the sky");
}

/* Returns the irradiance of level ground. Radiance is bilinear between centres
 * of texels, so the hot one is a tent over two columns and two rows. */
static double hot_irradiance(const struct sky_file *sky)
{
    const int steps = 20000;
    double hot = fmax(sky->hot, 0); /* negative radiance is clamped */
    double sum = 0;

    for (int i = 0; i < steps; i++) {
        double y = 2 * (i + 0.5) / steps - 1; /* rows from its centre */
        double theta = M_PI * (sky->hot_row + 0.5 + y) / sky->height;

        sum += (1 - fabs(y)) * sin(theta) * cos(theta);
    }
    return sky->rest * M_PI + (hot - sky->rest) * sum * 2 / steps *
                                  (M_PI / sky->height) *
                                  (2 * M_PI / sky->width);
}

static void ground(struct stress_scene *s, double number)
{
    (void)number;
    put_material(s, "ground", "Kd .5 .5 .5");
    put_quad(s, 1, 0, (double[]){-9, -9}, (double[]){9, 9});
}

static void check_skies(struct stress_scene *s)
{
    static const struct {
        const char *what;
        struct sky_file file;
    } skies[] = {
        {"a black sky", {64, 32, 0, 0, 0, false}},
        {"one texel", {1, 1, 0, 0.5, 0.5, false}},
        {"16384 columns", {16384, 8, 0, 0.5, 0.5, false}},
        {"one hot texel of 2048 in the dark", {64, 32, 9, 0, 8192, false}},
        {"one hot texel of a million, 1e6 times as bright",
         {1414, 707, 200, 0.25, 262144, false}},
        {"one negative texel of 128", {16, 8, 2, 0.25, -1e6, true}},
    };

    for (size_t i = 0; i < sizeof skies / sizeof skies[0]; i++) {
        struct truth t = {"M10",
                          skies[i].what,
                          ground,
                          0,
                          0.5 / M_PI * hot_irradiance(&skies[i].file),
                          1e-4, /* solid angles of texels in float */
                          {.eye = {0.3, 2, 0.2},
                           .at = {0, 0, 0.1},
                           .fovy_deg = 40,
                           .sky = "sky"},
                          skies[i].file.hot < 0};

        write_sky(&skies[i].file);
        check_truth(s, &t);
    }
}

static void check_sky_of_nan(struct stress_scene *s)
{
    const struct sky_file file = {8, 4, 0, 0.25, NAN, true};
    const struct shot up = {.at = {0, 1, 0}, .fovy_deg = 40, .sky = "sky"};
    const char *want = "sky: found a pixel that is not a number";
    struct outcome o;

    write_sky(&file);
    stress_scene_begin(s);
    ground(s, 0);
    stress_scene_end(s);
    o = stress_scene_render(s, &up, 1);
    row(o.is_refused && strcmp(o.err.text, want) == 0, "M10",
        "one texel that is NaN: \"%s\", want \"%s\"",
        o.is_refused ? o.err.text : "rendered", want);
    free(o.rgb);
}

/* M8: nothing overflows, and samples that are too bright for the sum are
 * counted. */
static void check_brightest(struct stress_scene *s)
{
    const double want = 0x1p63 / 64; /* sums of 64 samples saturate at 2^63 */
    struct outcome o;

    stress_scene_begin(s);
    lamp_over_floor(s, 1e38);
    stress_scene_end(s);
    o = stress_scene_render(s, &at_floor, 1);
    row(!o.is_refused && fabs(o.mean / want - 1) < ROUNDING &&
            o.last.non_finite == 0 && o.last.saturated == o.last.samples,
        "M8",
        "a lamp of 1e38: mean %g, want %g, what the sum holds; %llu of %llu "
        "samples counted as saturated",
        o.mean, want, (unsigned long long)o.last.saturated,
        (unsigned long long)o.last.samples);
    free(o.rgb);
}

static void check_normals(struct stress_scene *s)
{
    const struct shot shot = {.eye = {1, 2, 3},
                              .at = {0, 0, 0},
                              .fovy_deg = 20,
                              .background = 1};
    const struct twins twins[] = {
        {"M2", "normals of length 1000, or unit", ball_with_normals,
         NORMALS_LONG, NORMALS_UNIT, shot},
        {"M2", "normals inwards, or outwards", ball_with_normals,
         NORMALS_INWARDS, NORMALS_UNIT, shot},
        {"M2", "normals of length 0, or none", ball_with_normals, NORMALS_ZERO,
         NORMALS_NONE, shot},
        {"M2", "normals that are NaN, or none", ball_with_normals, NORMALS_NAN,
         NORMALS_NONE, shot},
    };

    for (size_t i = 0; i < sizeof twins / sizeof twins[0]; i++)
        check_twins(s, &twins[i]);
}

static void check_truths(struct stress_scene *s)
{
    const double lit = lit_floor();
    const struct shot sky = {.eye = {0, 0.5, 3},
                             .at = {0, 0, 0},
                             .fovy_deg = 22,
                             .background = 1};
    const struct shot above = {.eye = {0.3, 2, 0.2},
                               .at = {0, 0, 0.1},
                               .fovy_deg = 40};
    const struct shot along_x = {.eye = {0.2, 0.1, 0},
                                 .at = {1, 0.1, 0},
                                 .fovy_deg = 0.1,
                                 .background = 1};
    const struct shot along_z = {.eye = {0.2, 0.1, 3},
                                 .at = {0.2, 0.1, 0},
                                 .fovy_deg = 0.1,
                                 .background = 1};
    const struct shot in_dark = {.eye = {0.2, 0.1, 3},
                                 .at = {0.2, 0.1, 0},
                                 .fovy_deg = 0.1};
    const struct shot room = {.eye = {0.1, 0.2, 0.9},
                              .at = {0.1, 0, 0},
                              .fovy_deg = 90};
    const struct shot at_side = {.eye = {0.5, 0, 1.2},
                                 .at = {0.5, 0, 0.2},
                                 .fovy_deg = 1e-6,
                                 .background = 0.25};
    const struct shot by_lights = {.eye = {0.1, 0.2, 0.9},
                                   .at = {0.1, 0, 0},
                                   .fovy_deg = 90,
                                   .direct = DIRECT_LIGHTS};
    const struct shot by_chance = {.eye = {0.1, 0.2, 0.9},
                                   .at = {0.1, 0, 0},
                                   .fovy_deg = 90,
                                   .direct = DIRECT_BSDF};
    const double open = 0.04 + 0.96 / (1.5 * 1.5);
    const double share = pow(0.02 / (2 * 2 * tan(2.5 * M_PI / 180)), 2);
    const struct truth truths[] = {
        {"M1", "a white ball with its normals", ball_with_normals, NORMALS_UNIT,
         1, 0, sky, false},
        {"M1", "a mirror ball with its normals", mirror_ball, 0, 1, 0, sky,
         false},
        {"M1", "a rough metal ball with its normals", mirror_ball, 0.25, 1,
         TABLES, sky, false},
        {"M1", "a glass ball with its normals", glass_ball, 0, 1, LEANING, sky,
         false},
        {"M5", "a negative albedo", negative_albedo, 0, 0, 0, above, true},
        {"M6", "the eye in a cube of glass", glass_cube, 0, 1.5 * 1.5, 0,
         along_x, false},
        {"M6", "a prism with total reflection", prism, 0, 0.96 * 0.96, 0,
         in_dark, false},
        {"M7", "balls and a box of glass in each other", odd_glass, 0, 1, 0,
         sky, false},
        {"M7", "boxes of glass that touch", odd_glass, 1, 1, 0, sky, false},
        {"M7", "an open sheet of glass", odd_glass, 2, open, 0, along_z, false},
        {"M8", "a lamp of 1e10", lamp_over_floor, 1e10, 1e10 * lit, 0, at_floor,
         false},
        {"M8", "a lamp of 1e-10", lamp_over_floor, 1e-10, 1e-10 * lit, 0,
         at_floor, false},
        {"M9", "no lamp", no_lamp, 0, 0, 0, above, false},
        {"M9", "one lamp beside one of Ke 0", lamp_and_dark, 0, lit, 0,
         at_floor, false},
        {"M9", "1e6 lamps, and 707 without area", many_lamps, 707, lit, 0,
         at_floor, true},
        {"M11", "a lamp seen edge on", lamp_over_floor, 1, 0.25, 0, at_side,
         false},
        {"M11",
         "beside a lamp that stands on it, by 0.1",
         wall_lamp,
         0,
         beside_wall(0.1),
         0,
         {.eye = {0.2, 0.1, 0}, .at = {0.1, 0, 0}, .fovy_deg = 1e-3},
         false},
        {"M11",
         "by 1e-3",
         wall_lamp,
         0,
         beside_wall(1e-3),
         0,
         {.eye = {0.101, 0.1, 0}, .at = {1e-3, 0, 0}, .fovy_deg = 1e-4},
         false},
        {"M11",
         "by 1e-5",
         wall_lamp,
         0,
         beside_wall(1e-5),
         1e-3,
         {.eye = {0.00101, 0.001, 0}, .at = {1e-5, 0, 0}, .fovy_deg = 1e-3},
         false},
        {"M11",
         "a lamp in the floor's plane",
         flush_floor,
         0,
         0,
         0,
         {.eye = {1, 1, 0}, .at = {1, 0, 0}, .fovy_deg = 1},
         false},
        {"M12", "a lamp in the ceiling, before it in the file", flush_lamp, 0,
         lit, 0, at_floor, false},
        {"M12", "after it in the file, so behind it", flush_lamp, 1, 0, 0,
         at_floor, false},
        {"M12", "below it by 1e-5", flush_lamp, 1e-5, lit, 1e-4, at_floor,
         false},
        {"M13", "roulette at albedo .1", furnace, 0.1, 1, 0, room, false},
        {"M13", "roulette at albedo .9", furnace, 0.9, 1, 0, room, false},
        {"M13", "roulette at albedo .99", furnace, 0.99, 1, 0, room, false},
        {"M14", "a room by both ways, weighed", furnace, 0.5, 1, 0, room,
         false},
        {"M14", "a room by lights alone", furnace, 0.5, 1, 0, by_lights, false},
        {"M14", "a room by chance alone", furnace, 0.5, 1, 0, by_chance, false},
        {"M15", "a black body of 0 K", black_body, 0, 0, 0, above, false},
        {"M15", "a black body of -5 K", black_body, -5, 0, 0, above, true},
        {"M16",
         "a speck of 1e6, unclamped",
         speck,
         1e6,
         1e6 * share,
         0,
         {.eye = {0, 2, 0}, .at = {0, 0, 0}, .fovy_deg = 5, .spp = 256},
         false},
    };

    for (size_t i = 0; i < sizeof truths / sizeof truths[0]; i++)
        check_truth(s, &truths[i]);
}

/* C6: the mean of many samples of one pixel is as good as its sum. */
static void check_one_pixel(struct stress_scene *s)
{
    const double count = 1e8, want = lit_floor();
    struct shot shot = at_floor;
    struct outcome o;
    double off;

    stress_scene_begin(s);
    lamp_over_floor(s, 1);
    stress_scene_end(s);
    shot.side_px = 1;
    shot.spp = (uint64_t)count;
    o = stress_scene_render(s, &shot, 1);
    off = fabs(o.mean - want);
    row(!o.is_refused && (double)o.last.samples == count && off < 1e-5 * want,
        "C6", "%g samples of one pixel: %.9g, want %.9g, off by %.1e of it",
        count, o.mean, want, off / want);
    free(o.rgb);
}

int main(int argc, char **argv)
{
    struct stress_scene s;

    (void)argv;
    if (!stress_scene_open(&s, argc > 1))
        return 0;
    check_white_things(&s);
    check_normals(&s);
    check_truths(&s);
    check_brightest(&s);
    check_skies(&s);
    check_sky_of_nan(&s);
    check_one_pixel(&s);
    stress_scene_close(&s);
    return rows_status();
}
