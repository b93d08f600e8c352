// SPDX-License-Identifier: MIT
/* test_light_paths.c - light that comes by way of glass and mirrors: closed
 * forms of lamps that no path from the eye finds, and paths from the eye that
 * find the same light with more noise */
#include "tests/unit/check.h"

#include <math.h>
#include <stdlib.h>

#include "terminal/xmalloc.h"
#include "tests/unit/files.h"
#include "tests/unit/folder.h"
#include "tests/unit/square.h"

#define SIDE 16

/* Seeds, samples beside light paths, and without them. */
#define SEEDS    6
#define SPP      (check_is_thorough() ? 256u : 96u)
#define SPP_MANY (2 * SPP)

/* Samples where closed forms are known. */
#define SPP_CLOSED 2048

/* Mean of the picture, of each channel. */
struct means {
    double all[3];
};

/* Renders a part of the picture of s.obj. `is_alone`: by paths from the eye. */
static struct means render_part(struct rect crop, bool is_alone, uint32_t spp,
                                uint32_t seed)
{
    int pixels = crop.width * crop.height;
    static struct session s;
    static float rgb[3 * SIDE * SIDE];
    struct options o = square_options(SIDE, seed);
    struct means m = {{0, 0, 0}};

    o.has_crop = true;
    o.crop = crop;
    square_open(&s, &o);
    if (is_alone)
        light_paths_free(&s.engine.world.light_paths);
    square_render(&s, spp, rgb);
    for (int i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++)
            m.all[c] += (double)rgb[3 * i + c] / pixels;
    return m;
}

static struct means render(bool is_alone, uint32_t spp, uint32_t seed)
{
    return render_part((struct rect){0, 0, SIDE, SIDE}, is_alone, spp, seed);
}

/* A grey floor that the eye sees from above, and a quad of this material around
 * (x, y, 0). */
static void write_floor(const char *material, double x, double y,
                        const char *lamp)
{
    char *mtl =
        xformat("newmtl grey\nKd .5 .5 .5\nnewmtl pane\n%s\n", material);
    char *obj = xformat("mtllib s.mtl\n"
                        "v -9 0 -9\nv -9 0 9\nv 9 0 9\nv 9 0 -9\n"
                        "v %g %g -.1\nv %g %g .1\nv %g %g .1\nv %g %g -.1\n"
                        "usemtl grey\nf 1 2 3 4\nusemtl pane\nf 5 6 7 8\n",
                        x - .1, y, x - .1, y, x + .1, y, x + .1, y);
    char *view = xformat("eye 0 .4 0\nat 0 0 0\nup 0 0 -1\nfovy 20\n"
                         "max_bounces 2\nbackground 0 0 0\n%s\n",
                         lamp);

    put("s.mtl", mtl);
    put("s.obj", obj);
    put("s.view", view);
    free(mtl);
    free(obj);
    free(view);
}

/* Reflectance of a thin sheet of index 1.5, with all reflections inside, by
 * Fresnel's equations. */
static double sheet_reflectance(double cosine)
{
    double inside = sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
    double s = (cosine - 1.5 * inside) / (cosine + 1.5 * inside);
    double p = (1.5 * cosine - inside) / (1.5 * cosine + inside);
    double f = (s * s + p * p) / 2;

    return 2 * f / (1 + f);
}

#define SHEET "illum 4\nNi 1.5\nTf 1 1 1"

/* A sheet hangs between a point and the floor: the floor has Kd / pi times the
 * irradiance that the sheet lets through. */
static void points_shine_through_sheets(void **state)
{
    (void)state;
    for (int x = 0; x < 3; x += check_is_thorough() ? 1 : 2) {
        double square = 4 + x * x, cosine = 2 / sqrt(square);
        char *lamp = xformat("light point %d 2 0 intensity 1 1 1", x);

        write_floor(SHEET, x / 2., 1, lamp);
        check_close(render(false, SPP_CLOSED, 3).all[0],
                    .5 / M_PI * cosine / square *
                        (1 - sheet_reflectance(cosine)),
                    8e-4);
        free(lamp);
    }
}

/* Lamps are numbered apart from triangles: five points at a place, past the
 * number of triangles, are as bright as one. */
static void many_points_shine_through_sheets(void **state)
{
    const char *fifth = "light point 0 2 0 intensity .2 .2 .2";
    char *lamps =
        xformat("%s\n%s\n%s\n%s\n%s", fifth, fifth, fifth, fifth, fifth);

    (void)state;
    write_floor(SHEET, 0, 1, lamps);
    check_close(render(false, SPP_CLOSED, 3).all[0],
                .5 / M_PI / 4 * (1 - sheet_reflectance(1)), 8e-4);
    free(lamps);
}

/* The floor under the eye is 40 degrees off the axis of a wide lens, in the
 * middle of two pixels. */
static void splats_are_right_off_the_axis(void **state)
{
    (void)state;
    write_floor(SHEET, 0, 1,
                "at .33564 0 0\nfovy 100\n"
                "light point 0 2 0 intensity 1 1 1");
    check_close(
        render_part((struct rect){2, 7, 1, 2}, false, SPP_CLOSED, 3).all[0],
        .5 / M_PI / 4 * (1 - sheet_reflectance(1)), 3e-3);
}

/* A mirror hangs over a spot that shines up: the floor has the light of its
 * image, which is at height 1.5. */
static void points_shine_by_mirrors(void **state)
{
    (void)state;
    write_floor("Kd .9 .9 .9\nPm 1\nPr 0", 2 / 3., 1,
                "light spot 1 .5 0 at 1 1 0 intensity 1 1 1 inner 60 outer 80");
    check_close(render(false, SPP_CLOSED, 3).all[0],
                .5 / M_PI * .9 * (1.5 / sqrt(3.25)) / 3.25, 8e-4);
}

/* A sun without a size shines through the sheet from above. */
static void suns_shine_through_sheets(void **state)
{
    (void)state;
    write_floor(SHEET, 0, .5,
                "light directional 0 90 irradiance 3 3 3 angle 0");
    check_close(render(false, SPP_CLOSED, 3).all[0],
                .5 / M_PI * 3 * (1 - sheet_reflectance(1)), 9e-3);
}

/* Two lamps in a globe of glass that light a box of these materials: light
 * paths, and paths from the eye with many more samples. */
static void write_globe(const char *globe, const char *box)
{
    char *mtl = xformat("newmtl grey\nKd .6 .5 .4\n%s\nnewmtl globe\n%s\n"
                        "newmtl lamp\nKd 0 0 0\nKe 30 30 30\n"
                        "newmtl dim\nKd 0 0 0\nKe 2 4 2\n",
                        box, globe);
    char text[16384];
    size_t at;

    at = (size_t)snprintf(text, sizeof text,
                          "mtllib s.mtl\nusemtl grey\n"
                          "v -1 -1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 -1 -1\n"
                          "v -1 1 -1\nv -1 1 1\nv 1 1 1\nv 1 1 -1\n"
                          "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\n"
                          "f 1 4 8 5\nusemtl lamp\n"
                          "v -.1 .2 -.1\nv .1 .2 -.1\nv 0 .2 .12\nf -3 -2 -1\n"
                          "usemtl dim\nv .1 .3 .1\nv .1 .1 .1\n"
                          "v -.1 .2 .2\nf -3 -2 -1\n"
                          "usemtl globe\n");
    /* an octahedron, whose faces are wound outwards */
    snprintf(text + at, sizeof text - at,
             "v .4 .2 0\nv -.4 .2 0\nv 0 .6 0\nv 0 -.2 0\n"
             "v 0 .2 .4\nv 0 .2 -.4\n"
             "f -6 -4 -2\nf -2 -4 -5\nf -5 -4 -1\nf -1 -4 -6\n"
             "f -2 -3 -6\nf -5 -3 -2\nf -1 -3 -5\nf -6 -3 -1\n");
    put("s.mtl", mtl);
    put("s.obj", text);
    put("s.view", "eye 0 -.2 3\nat 0 -.6 -1\nfovy 20\nmax_bounces 12\n"
                  "background 0 0 0\n");
    free(mtl);
}

static void append(const char *path, const char *text)
{
    FILE *f = fopen(path, "a");

    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

/* Puts a thin sheet between the eye and the box of write_globe(). Light cells
 * want a high limit of bounces. */
static void add_pane(void)
{
    append("s.mtl", "newmtl pane\n" SHEET "\n");
    append("s.obj", "usemtl pane\nv -1 -1 1.5\nv 1 -1 1.5\nv 1 1 1.5\n"
                    "v -1 1 1.5\nf -4 -3 -2 -1\n");
    append("s.view", "max_bounces 40\n");
}

/* Checks that both have the same mean, within four standard errors of what the
 * seeds show. */
static void check_same_means(void)
{
    double sums[3][2] = {{0}}, squares[3][2] = {{0}};

    for (uint32_t seed = 1; seed <= SEEDS; seed++)
        for (int alone = 0; alone < 2; alone++) {
            struct means m = render(alone == 1, alone ? SPP_MANY : SPP, seed);

            for (int c = 0; c < 3; c++) {
                sums[c][alone] += m.all[c];
                squares[c][alone] += m.all[c] * m.all[c];
            }
        }
    for (int c = 0; c < 3; c++) {
        double mean[2], error = 0;

        for (int i = 0; i < 2; i++) {
            mean[i] = sums[c][i] / SEEDS;
            error += (squares[c][i] / SEEDS - mean[i] * mean[i]) / (SEEDS - 1);
        }
        print_message("%g by light paths, %g alone, error %g\n", mean[0],
                      mean[1], sqrt(error));
        assert_true(mean[0] > 0);
        check_close(mean[0], mean[1], 4 * sqrt(error));
    }
}

static void paths_from_the_eye_agree(void **state)
{
    static const char *const materials[][2] = {
        {"illum 7\nNi 1.5\nTf 1 1 1", "Pm 1\nPr .5"},
        {"illum 7\nNi 1.5\nTf .9 .8 .9\nTf_distance .5", ""},
        {"illum 7\nNi 1.5\nTf 1 1 1\nPr .4", ""},
        {"illum 4\nNi 1.5\nTf 1 1 1", ""},
        {"illum 7\nNi 1.7\nNi_abbe 4", ""},
        {"illum 7\nNi 1.7\nNi_abbe 4\nPr .4", ""}};

    (void)state;
    for (int i = 0; i < 6; i++) {
        write_globe(materials[i][0], materials[i][1]);
        check_same_means();
    }
}

#define SKY_ROWS 20

/* Writes an image of a sky that is black, except at the zenith. */
static void write_sky(void)
{
    FILE *f = fopen("s.hdr", "wb");

    assert_non_null(f);
    fprintf(f, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", SKY_ROWS,
            2 * SKY_ROWS);
    for (int i = 0; i < 2 * SKY_ROWS * SKY_ROWS; i++)
        fwrite(i < 2 * SKY_ROWS ? "\200\200\200\212" : "\0\0\0\0", 1, 4, f);
    assert_int_equal(fclose(f), 0);
}

/* A sheet is between the floor and the bright part of the sky, where radiance
 * is 512 up to half a row from the zenith, and 0 a row further, linear between.
 */
static void bright_skies_shine_through_sheets(void **state)
{
    const double row = M_PI / SKY_ROWS;
    double irradiance = 0;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        double angle = (i + .5) / 1000 * 1.5 * row;

        irradiance += 512 * fmin(1, 1.5 - angle / row) * cos(angle) *
                      sin(angle) * (1 - sheet_reflectance(cos(angle))) *
                      (2 * M_PI * 1.5 * row / 1000);
    }
    write_sky();
    write_floor(SHEET, 0, .15, "sky s.hdr\neye 0 .1 0\nfovy 40");
    check_close(render(false, SPP_CLOSED, 3).all[0], .5 / M_PI * irradiance,
                .002 * irradiance);
}

/* A sheet is between the eye and the floor as well: the eye sees what light
 * cells have there. The floor is dark, so that what the sheet sends back to it
 * is too little to count. */
static void sheets_show_what_shines_through_them(void **state)
{
    double pass = 1 - sheet_reflectance(1);

    (void)state;
    write_floor(SHEET, 0, .2, "light point 0 2 0 intensity 10 10 10");
    put("s.mtl", "newmtl grey\nKd .05 .05 .05\nnewmtl pane\n" SHEET "\n");
    append("s.view", "max_bounces 40\n");
    check_close(render(false, 2 * SPP_CLOSED, 3).all[0],
                .05 / M_PI * 10 / 4 * pass * pass, 1e-4);
}

/* The globe, its room and a pane before the eye: all of it is seen through
 * glass. */
static void paths_from_the_eye_agree_behind_glass(void **state)
{
    static const char *const globes[] = {"illum 7\nNi 1.5\nTf 1 1 1",
                                         "illum 7\nNi 1.7\nNi_abbe 4"};

    (void)state;
    for (int i = 0; i < 2; i++) {
        write_globe(globes[i], "");
        add_pane();
        check_same_means();
    }
}

/* The floor is of paper, and the eye is below it, or also behind a sheet. */
static void paper_shows_what_shines_through_it(void **state)
{
    double pass = 1 - sheet_reflectance(1);

    (void)state;
    write_floor(SHEET, 0, .2, "light point 0 2 0 intensity 10 10 10");
    put("s.mtl", "newmtl grey\nKd 0 0 0\nTd .1 .1 .1\nTd_weight .5\n"
                 "newmtl pane\n" SHEET "\n");
    append("s.view", "eye 0 -.4 0\nmax_bounces 40\n");
    check_close(render(false, SPP_CLOSED, 3).all[0],
                .5 * .1 / M_PI * 10 / 4 * pass, 1e-4);
    append("s.obj", "usemtl pane\nv -.2 -.1 -.2\nv -.2 -.1 .2\n"
                    "v .2 -.1 .2\nv .2 -.1 -.2\nf -4 -3 -2 -1\n");
    check_close(render(false, 2 * SPP_CLOSED, 3).all[0],
                .5 * .1 / M_PI * 10 / 4 * pass * pass, 1e-4);
}

/* A curtain hides the globe and its room, without and with a pane before it. */
static void paths_from_the_eye_agree_behind_curtains(void **state)
{
    (void)state;
    write_globe("illum 7\nNi 1.5\nTf 1 1 1", "newmtl curtain\nKd .4 .5 .6\n"
                                             "Td .9 .7 .5\nTd_weight .7");
    append("s.obj", "usemtl curtain\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n"
                    "v -1 1 1\nf -4 -3 -2 -1\n");
    check_same_means();
    add_pane();
    check_same_means();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_shine_through_sheets),
        cmocka_unit_test(many_points_shine_through_sheets),
        cmocka_unit_test(splats_are_right_off_the_axis),
        cmocka_unit_test(points_shine_by_mirrors),
        cmocka_unit_test(suns_shine_through_sheets),
        cmocka_unit_test(paths_from_the_eye_agree),
        cmocka_unit_test(bright_skies_shine_through_sheets),
        cmocka_unit_test(sheets_show_what_shines_through_them),
        cmocka_unit_test(paths_from_the_eye_agree_behind_glass),
        cmocka_unit_test(paper_shows_what_shines_through_it),
        cmocka_unit_test(paths_from_the_eye_agree_behind_curtains),
    };

    return cmocka_run_group_tests_name("light_paths", tests, enter_folder,
                                       remove_folder);
}
