// SPDX-License-Identifier: MIT
/* test_radiance_cells.c - pictures of paths that end at radiance cells: closed
 * forms, and paths that all go on */
#include "tests/unit/check.h"

#include <math.h>

#include "tests/unit/files.h"
#include "tests/unit/folder.h"
#include "tests/unit/square.h"

#define SIDE  48
#define SEEDS 4

/* Part of the light by which the blur of cells may change the mean of a quarter
 * of the picture. */
#define BLUR_MAX 0.004

struct result {
    double quarters[4]; /* means of all channels */
    double rays;        /* of a sample */
};

/* Renders s.obj. `is_exact`: without cells. */
static struct result render(bool is_exact, uint32_t spp, uint32_t seed)
{
    static struct session s;
    static float rgb[3 * SIDE * SIDE];
    struct options o = square_options(SIDE, seed);
    struct render_progress p;
    struct result r = {.rays = 0};

    o.gi = is_exact ? GI_EXACT : GI_CELLS;
    square_open(&s, &o);
    p = square_render(&s, spp, rgb);
    r.rays = (double)p.rays / (double)p.samples;
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            r.quarters[i % SIDE / (SIDE / 2) + i / SIDE / (SIDE / 2) * 2] +=
                (double)rgb[3 * i + c] / (3 * SIDE * SIDE / 4);
    return r;
}

static const char box[] = "v -1 -1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 -1 -1\n"
                          "v -1 1 -1\nv -1 1 1\nv 1 1 1\nv 1 1 -1\n"
                          "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\n"
                          "f 1 4 8 5\n";

/* Writes a box of the material "wall", and more faces. */
static void write_open(const char *materials, const char *more)
{
    char text[8192];

    snprintf(text, sizeof text, "mtllib s.mtl\nusemtl wall\n%s%s", box, more);
    put("s.obj", text);
    put("s.mtl", materials);
    put("s.view", "eye 0 0 3.4\nat 0 0 0\nfovy 40\nbackground 0 0 0\n");
}

static void write_closed(const char *materials, const char *more)
{
    char text[4096];

    snprintf(text, sizeof text, "f 2 6 7 3\n%s", more);
    write_open(materials, text);
    put("s.view", "eye -.8 .3 .9\nat 0 -.3 -1\nfovy 60\nbackground 0 0 0\n");
}

/* In a closed box whose walls all emit 1 and reflect `albedo`, radiance is 1 /
 * (1 - albedo) everywhere, and no blur changes it. */
static void boxes_are_even(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        double albedo = k ? .8 : .5;
        char text[256];
        struct result cells, exact;

        snprintf(text, sizeof text, "newmtl wall\nKd %g %g %g\nKe 1 1 1\n",
                 albedo, albedo, albedo);
        write_closed(text, "");
        cells = render(false, 128, 1);
        exact = render(true, 128, 1);
        print_message("rays %g, %g without\n", cells.rays, exact.rays);
        assert_true(cells.rays < .9 * exact.rays);
        for (int i = 0; i < 4; i++)
            check_close(cells.quarters[i] * (1 - albedo), 1, .01);
    }
}

/* Checks that paths to cells have the same means as paths that go on, within
 * five standard errors of what the seeds show, and the blur. */
static void check_same_means(uint32_t spp)
{
    double sums[2][4] = {{0}}, squares[2][4] = {{0}}, rays[2] = {0, 0};

    for (uint32_t seed = 1; seed <= SEEDS; seed++)
        for (int k = 0; k < 2; k++) {
            struct result r = render(k == 1, spp, seed);

            rays[k] += r.rays;
            for (int i = 0; i < 4; i++) {
                sums[k][i] += r.quarters[i] / SEEDS;
                squares[k][i] += r.quarters[i] * r.quarters[i] / SEEDS;
            }
        }
    assert_true(rays[0] < .97 * rays[1]);
    for (int i = 0; i < 4; i++) {
        double error = 0;

        for (int k = 0; k < 2; k++)
            error +=
                fmax(squares[k][i] - sums[k][i] * sums[k][i], 0) / (SEEDS - 1);
        print_message("%g by cells, %g without, error %g\n", sums[0][i],
                      sums[1][i], sqrt(error));
        check_close(sums[0][i], sums[1][i],
                    5 * sqrt(error) + BLUR_MAX * sums[1][i]);
    }
}

/* A lamp behind a screen. */
static void rooms_agree(void **state)
{
    (void)state;
    write_closed(
        "newmtl wall\nKd .8 .6 .4\nnewmtl lamp\nKe 30 30 30\nKd 0 0 0\n",
        "v .2 -1 -1\nv .2 .5 -1\nv .2 .5 1\nv .2 -1 1\nf -4 -3 -2 -1\n"
        "usemtl lamp\nv .4 .9 -.3\nv .8 .9 -.3\nv .8 .9 .3\n"
        "v .4 .9 .3\nf -4 -3 -2 -1\n");
    check_same_means(128);
}

/* Flat lamps close below the ceiling: what they light above is far brighter
 * than the ceiling around it, and seen from the side only. */
static void gaps_stay_dark(void **state)
{
    (void)state;
    write_open("newmtl wall\nKd .7 .7 .7\nnewmtl lamp\nKe 10 10 10\n"
               "Kd .8 .8 .8\n",
               "usemtl lamp\nv -.8 .99 -.5\nv .8 .99 -.5\nv .8 .99 -.3\n"
               "v -.8 .99 -.3\nf -4 -3 -2 -1\nv -.8 .99 .1\n"
               "v .8 .99 .1\nv .8 .99 .3\nv -.8 .99 .3\nf -4 -3 -2 -1\n");
    check_same_means(256);
}

/* A mirror throws the light of a lamp at the ceiling, which light paths bring:
 * cells leave it out. */
static void mirrors_agree(void **state)
{
    (void)state;
    write_closed(
        "newmtl wall\nKd .7 .7 .7\nnewmtl lamp\nKe 90 90 90\nKd 0 0 0\n"
        "newmtl mirror\nKd .9 .9 .9\nPm 1\nPr 0\n",
        "usemtl mirror\nv -.8 -.98 -.8\nv -.8 -.98 .8\nv .8 -.98 .8\n"
        "v .8 -.98 -.8\nf -4 -3 -2 -1\n"
        "v -.2 -.6 -.2\nv .2 -.6 -.2\nv .2 -.6 .2\nv -.2 -.6 .2\n"
        "f -4 -3 -2 -1\nusemtl lamp\nv -.1 -.7 -.1\nv .1 -.7 -.1\n"
        "v .1 -.7 .1\nv -.1 -.7 .1\nf -4 -3 -2 -1\n");
    check_same_means(40);
}

/* Walls of colors without a channel, whose paths do not know that channel's
 * light, and plastic. */
static void colors_agree(void **state)
{
    (void)state;
    write_closed("newmtl wall\nKd .8 0 0\nnewmtl coated\nKd .5 .6 .7\n"
                 "Ks .05 .05 .05\nPr .3\nillum 2\nnewmtl lamp\nKe 9 9 9\n"
                 "Kd 0 0 0\n",
                 "usemtl coated\nv -.99 -.9 -.99\nv -.99 -.9 .99\n"
                 "v .99 -.9 .99\nv .99 -.9 -.99\nf -4 -3 -2 -1\n"
                 "v -.99 -.9 -.9\nv .99 -.9 -.9\nv .99 .9 -.9\nv -.99 .9 -.9\n"
                 "f -4 -3 -2 -1\nusemtl lamp\nv -.3 .9 -.3\nv .3 .9 -.3\n"
                 "v .3 .9 .3\nv -.3 .9 .3\nf -4 -3 -2 -1\n");
    check_same_means(128);
}

/* A curtain of other colours on each side divides the room: the lamp lights one
 * half of it through the curtain. */
static void curtains_agree(void **state)
{
    (void)state;
    write_closed("newmtl wall\nKd .8 .7 .6\nnewmtl curtain\nKd .3 .5 .7\n"
                 "Td .9 .8 .5\nTd_weight .6\nnewmtl lamp\nKe 30 30 30\n"
                 "Kd 0 0 0\n",
                 "usemtl curtain\nv .2 -1 -1\nv .2 1 -1\nv .2 1 1\nv .2 -1 1\n"
                 "f -4 -3 -2 -1\nusemtl lamp\nv .4 .9 -.3\nv .8 .9 -.3\n"
                 "v .8 .9 .3\nv .4 .9 .3\nf -4 -3 -2 -1\n");
    check_same_means(128);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_even), cmocka_unit_test(rooms_agree),
        cmocka_unit_test(gaps_stay_dark), cmocka_unit_test(mirrors_agree),
        cmocka_unit_test(colors_agree),   cmocka_unit_test(curtains_agree),
    };

    return cmocka_run_group_tests_name("radiance_cells", tests, enter_folder,
                                       remove_folder);
}
