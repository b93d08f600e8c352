// SPDX-License-Identifier: MIT
/* Pictures of libglim in the light of the sun. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "glim/glim.h"
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#define SUN_RADIUS (0.2665 * M_PI / 180)

/* Height of the plate above the floor. */
#define PLATE 10.0

#define COLS 8
#define ROWS 64

/* Part of the sun's radius between the places where a quarter and three
 * quarters of its disc are behind a straight edge: twice the root of
 * acos(h) - h sqrt(1 - h^2) = pi / 4. */
#define QUARTILES (2 * 0.403973)

/* Writes a floor and a plate above it, which covers z below `edge`, or x if it
 * is turned. The camera looks down and sees `side` on either side of z = 0. */
static void write_scene(double edge, double side, bool is_turned)
{
    const double corners[4][2] = {{-50, -50},
                                  {-50, edge},
                                  {50, edge},
                                  {50, -50}};
    FILE *f = fopen("sun.obj", "w");

    assert_non_null(f);
    fprintf(f, "v -50 0 -50\nv -50 0 50\nv 50 0 50\nv 50 0 -50\nf 1 2 3 4\n");
    for (int i = 0; i < 4; i++)
        fprintf(f, "v %.17g %g %.17g\n", corners[i][is_turned], PLATE,
                corners[i][!is_turned]);
    fprintf(f, "f 5 6 7 8\n");
    fclose(f);
    f = fopen("sun.view", "w");
    assert_non_null(f);
    fprintf(f,
            "eye 0 1 0\nat 0 0 0\nup 0 0 -1\nfovy %.17g\nres %d %d\n"
            "max_bounces 1\n",
            2 * atan(side) * 180 / M_PI, COLS, ROWS);
    fclose(f);
}

/* Renders and sets the means of the rows. */
static void render(double azimuth, double elevation, uint64_t spp,
                   double rows[ROWS])
{
    struct glim_sun sun = {azimuth, elevation};
    struct glim_open_options how = {.sun = &sun, .turbidity = 2.5};
    struct glim_error err;
    struct glim *g = glim_open("sun.obj", &how, &err);
    float rgb[3 * COLS * ROWS];

    check_or_say(g != NULL, err.text);
    assert_int_equal(glim_render(g, spp, 0, NULL, NULL, &err), GLIM_DONE);
    assert_true(glim_read_floats(g, rgb, sizeof rgb / sizeof *rgb, &err));
    for (int y = 0; y < ROWS; y++) {
        rows[y] = 0;
        for (int x = 0; x < COLS; x++)
            rows[y] += (double)rgb[3 * (y * COLS + x) + 1] / COLS;
    }
    glim_close(g);
}

/* Returns the row at which the light from dark to bright passes a part of the
 * way; rows brighten from row 0 on. */
static double row_of(const double rows[ROWS], double part)
{
    double want = rows[0] + part * (rows[ROWS - 1] - rows[0]);
    int y = 0;

    while (y + 1 < ROWS && rows[y + 1] < want)
        y++;
    return y + (want - rows[y]) / (rows[y + 1] - rows[y]);
}

/* The shadow's edge is as wide as half a degree makes it. */
static void penumbras_are_half_a_degree_wide(void **state)
{
    static const double elevations[] = {90, 60, 40};

    (void)state;
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        double angle = elevations[i] * M_PI / 180;
        double radius = PLATE * tan(SUN_RADIUS) / (sin(angle) * sin(angle));
        double rows[ROWS], width, middle;

        write_scene(PLATE / tan(angle), 4 * radius, false);
        render(180, elevations[i], 1024, rows);
        width = (row_of(rows, 0.75) - row_of(rows, 0.25)) * 8 * radius / ROWS;
        middle = (row_of(rows, 0.5) + 0.5) * 8 * radius / ROWS - 4 * radius;
        check_close(width / (QUARTILES * radius), 1, 0.03);
        check_close(middle / radius, 0, 0.05);
    }
}

/* The azimuth is clockwise from -z: the sun in the south shines below a plate
 * that covers the north, the sun in the east below one that covers the west. */
static void the_azimuth_is_clockwise_from_north(void **state)
{
    static const struct {
        double azimuth;
        bool is_turned, is_bright;
    } cases[] = {{180, false, true},  {-150, false, true}, {0, false, false},
                 {360, false, false}, {90, true, true},    {-300, true, true},
                 {-90, true, false},  {240, true, false}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double rows[ROWS];

        write_scene(0, 1, cases[i].is_turned);
        render(cases[i].azimuth, 60, 64, rows);
        assert_int_equal(rows[ROWS / 2] > 0.5, cases[i].is_bright);
    }
}

static void impossible_suns_are_refused(void **state)
{
    struct glim_sun sun = {0, 91};
    struct glim_error err;

    (void)state;
    write_scene(0, 1, false);
    assert_null(
        glim_open("sun.obj", &(struct glim_open_options){.sun = &sun}, &err));
    check_has(err.text, "sun: found 0,91, expected an azimuth");
    sun.elevation_deg = (double)NAN;
    assert_null(
        glim_open("sun.obj", &(struct glim_open_options){.sun = &sun}, &err));
    sun.elevation_deg = 90;
    assert_null(glim_open("sun.obj",
                          &(struct glim_open_options){.sun = &sun,
                                                      .turbidity = (double)NAN},
                          &err));
    assert_null(glim_open("sun.obj",
                          &(struct glim_open_options){.turbidity = 3}, &err));
    check_has(err.text, "turbidity: found no sun");
}

/* Lines of the view go over its file: the picture is that of another file. */
static void lines_of_the_view_replace_the_sun(void **state)
{
    const struct glim_sun sun = {0, 45};
    const struct glim_open_options how = {
        .sun = &sun, .view_lines = "background 0.25 0.5 1\neye 0 9 0\n"};
    struct glim_error err;
    struct glim *g;

    (void)state;
    write_scene(0, 1, false);
    g = glim_open("sun.obj", &how, &err);
    assert_non_null(g);
    assert_true(glim_get_camera(g).eye[1] == 9);
    glim_close(g);
    assert_null(glim_open("sun.obj",
                          &(struct glim_open_options){.view_lines = "fovy x"},
                          &err));
    assert_string_equal(err.text, "view options:1: found 'x', expected an "
                                  "angle above 0 and below 180 degrees for "
                                  "fovy");
    assert_null(
        glim_open("sun.obj", &(struct glim_open_options){.camera = "2"}, &err));
    check_has(err.text, "sun.obj: found no camera '2', expected a numbered");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(penumbras_are_half_a_degree_wide),
        cmocka_unit_test(the_azimuth_is_clockwise_from_north),
        cmocka_unit_test(impossible_suns_are_refused),
        cmocka_unit_test(lines_of_the_view_replace_the_sun),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
