// SPDX-License-Identifier: MIT
/*
 * test_overlay_text.c - tables of paths and surfaces, in units of the file
 */
#include "tests/unit/check.h"

#include <locale.h>
#include <string.h>

#include "inspect/overlay.h"

static char none[] = "", red_paint[] = "red paint";
static char *materials[] = {none, red_paint};
static struct tri tris[] = {{.material = 0}, {.material = 1}};
static const struct world world = {.tris = tris};
static const struct overlay_names names = {&world, materials};
static const struct scene scene = {.scale = 0.25, .center = {1, 2, 3}};

static void paths_show_their_last_steps(void **state)
{
    struct path_record trail = {.count = 9,
                                .vertices = 9,
                                .radiance = {1, 2, 3}};
    struct overlay_text l;

    (void)state;
    for (uint32_t i = 0; i < 9; i++)
        trail.steps[i] =
            (struct path_record_step){.to = {1, -0.5f, (float)i},
                                      .hit.tri = i % 2,
                                      .throughput = {1, 0.5f, 0.25f},
                                      .light = {0, 4, 0},
                                      .way = PATH_RECORD_REFLECTED,
                                      .pdf = i == 7 ? 0.0f : 0.125f};
    trail.steps[8].way = PATH_RECORD_SKY;
    trail.steps[8].hit.tri = NO_INDEX;
    overlay_text_path(&l, &scene, &names, &trail, 2);
    assert_int_equal(l.count, 4);
    check_has(l.lines[0], "throughput");
    /* The numbers are 1 / 0.25 + 1, -0.5 / 0.25 + 2 and 1 / 0.25 + 3. */
    check_has(l.lines[2], " 2 red paint  5 0 7 ");
    check_has(l.lines[2], "reflect  1.00 0.50 0.25 0.125  0 4 0");
    check_has(l.lines[1], " 1 no materia ");
    check_has(l.lines[3], "step 2 of 9; the path brings light 1 2 3");
    overlay_text_path(&l, &scene, &names, &trail, 9);
    assert_int_equal(l.count, OVERLAY_TEXT_LINES);
    check_has(l.lines[1], " 4 red paint ");
    check_has(l.lines[5], " delta ");
    check_has(l.lines[6], " 9  ");
    check_has(l.lines[6], " sky ");
}

/* A path in words: .35 of its luminance is left after the first step, and half
 * as much again is counted at the second. */
static void paths_are_told(void **state)
{
    struct path_record trail = {.count = 5,
                                .vertices = 6,
                                .radiance = {0.5f, 0.25f, 0}};
    struct overlay_text l;

    (void)state;
    trail.steps[0] = (struct path_record_step){.throughput = {1, 1, 1},
                                               .hit.tri = 1,
                                               .way = PATH_RECORD_REFLECTED};
    trail.steps[1] = (struct path_record_step){.throughput = {.35f, .35f, .35f},
                                               .light = {0, 1, 0},
                                               .hit.tri = 0,
                                               .way = PATH_RECORD_TRANSMITTED};
    trail.steps[2] = (struct path_record_step){.throughput = {.7f, .7f, .7f},
                                               .hit.tri = 1,
                                               .way = PATH_RECORD_ROULETTE};
    trail.steps[3] = (struct path_record_step){.way = PATH_RECORD_SKY,
                                               .hit.tri = NO_INDEX,
                                               .light = {1, 1, 1}};
    trail.steps[4] = (struct path_record_step){.way = PATH_RECORD_ROULETTE,
                                               .hit.tri = NO_INDEX};
    overlay_text_path(&l, NULL, &names, &trail, 5);
    assert_int_equal(l.count, 6);
    assert_string_equal(l.lines[0],
                        " 1  hits red paint, keeps 35 %, is reflected");
    assert_string_equal(l.lines[1], " 2  hits no material, finds light, counts "
                                    "2 times, goes through");
    assert_string_equal(l.lines[2],
                        " 3  hits red paint, keeps 0 %, ends by Russian "
                        "roulette");
    assert_string_equal(l.lines[3],
                        " 4  leaves the scene for the sky, finds light");
    assert_string_equal(l.lines[4], " 5  ends by Russian roulette");
    check_has(l.lines[5], "step 5 of 6; the path brings light 0.5 0.25 0");
    overlay_text_path(&l, NULL, &names, &trail, 1);
    assert_int_equal(l.count, 2);
}

/* Numbers lose digits where space is short, but are never cut off. */
static void numbers_are_not_cut(void **state)
{
    struct scene far = scene;
    struct path_record trail = {.count = 1, .vertices = 1};
    struct overlay_text l;

    (void)state;
    far.center[0] = -12400; /* (-12396, 0.00702, -0.124) with the scale */
    far.center[1] = 0.00702;
    far.center[2] = -0.124;
    trail.steps[0] = (struct path_record_step){.to = {1, 0, 0},
                                               .way = PATH_RECORD_REFLECTED,
                                               .pdf = 1230};
    overlay_text_path(&l, &far, &names, &trail, 1);
    check_has(l.lines[1], " -1e+04 0.007 -0.1 reflect ");
    check_has(l.lines[1], " 1e+03  0 0 0");
    far.center[0] = -4;
    overlay_text_path(&l, &far, &names, &trail, 1);
    check_has(l.lines[1], " 0 0.00702 -0.124  reflect ");
}

static void surfaces_show_their_frame(void **state)
{
    struct path_record_lobes lobes = {.n = {0, 0, 1},
                                      .t = {1, 0, 0},
                                      .b = {0, 1, 0},
                                      .wo = {0, 0.6f, 0.8f},
                                      .tri = 1,
                                      .count = 32};
    struct overlay_text l;

    (void)state;
    for (int i = 0; i < 32; i++) {
        lobes.weight[i].x = 1;
        lobes.pdf[i] = i == 5 ? 0 : i == 6 ? 8 : 0.5f;
    }
    overlay_text_lobes(&l, &names, &lobes);
    check_has(l.lines[0], "red paint, seen 36.9 degrees off n"); /* acos 0.8 */
    check_has(l.lines[1], "0.000  0.000  1.000");
    check_has(l.lines[4], "32 of 64 samples go on, 1 as deltas; pdf 0 to 8");
    /* The last vertex has no weight. */
    check_has(l.lines[5], "0.500  0.000  0.000");
}

/* A name is cut between characters: 20 of these take 40 columns. */
static void names_are_cut_whole(void **state)
{
    char wide[21 * 3 + 1] = "";
    char *wide_names[] = {none, wide};
    struct path_record_lobes lobes = {.n = {0, 0, 1},
                                      .wo = {0, 0, 1},
                                      .tri = 1};
    struct overlay_names named = names;
    struct overlay_text l;

    (void)state;
    for (int i = 0; i < 21; i++)
        strcat(wide, "\u5149");
    named.materials = wide_names;
    assert_non_null(setlocale(LC_CTYPE, "C.UTF-8"));
    overlay_text_lobes(&l, &named, &lobes);
    assert_int_equal(strcspn(l.lines[0], ","), 20 * strlen("\u5149"));
    check_has(l.lines[0], "\u5149, seen 0.0 degrees");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_show_their_last_steps),
        cmocka_unit_test(paths_are_told),
        cmocka_unit_test(numbers_are_not_cut),
        cmocka_unit_test(surfaces_show_their_frame),
        cmocka_unit_test(names_are_cut_whole),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
