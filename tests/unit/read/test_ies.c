// SPDX-License-Identifier: MIT
/*
 * test_ies.c - IES files: lamps of known shape against closed forms, symmetry,
 * what their text may look like, and messages
 */
#include <stdarg.h>

#include "read/ies.h"
#include "read/view_file.h"
#include "tests/unit/files.h"
#include "tests/unit/truth.h"
#include "world/light/daylight.h"

#define ALBEDO 0.5

/* Text of a file that is being written. */
struct text {
    char *text;
    size_t size_bytes;
    FILE *to;
};

static void open_text(struct text *t)
{
    t->to = open_memstream(&t->text, &t->size_bytes);
    assert_non_null(t->to);
}

static struct profile *close_text(struct text *t)
{
    struct error err;
    struct profile *p;

    fclose(t->to);
    p = ies_parse(t->text, t->size_bytes, "a.ies", &err);
    check_or_say(p != NULL, err.text);
    free(t->text);
    return p;
}

/* Begins a file of this many angles, whose value 1 is intensity 1. */
static void write_header(struct text *t, int vertical, int horizontal)
{
    fprintf(t->to,
            "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n"
            "1 1000 %g %d %d 1 2 0 0 0\n1 1 100\n",
            DAYLIGHT_UNIT, vertical, horizontal);
}

/* A lamp of cos^n straight down, in steps of a degree. */
static struct profile *make_power_of_cosine(int n)
{
    struct text t;

    open_text(&t);
    write_header(&t, 91, 1);
    for (int i = 0; i <= 90; i++)
        fprintf(t.to, "%d%c", i, i % 9 == 8 ? '\n' : ' ');
    fputs("\n0\n", t.to);
    for (int i = 0; i <= 90; i++)
        fprintf(t.to, "%.9g\n", pow(fabs(cos(i * M_PI / 180)), n));
    return close_text(&t);
}

/* A lamp at this place, with the profile around an axis straight down. */
static struct point_light lamp_at(struct vec3 p, const struct profile *profile)
{
    return (struct point_light){
        .p = p,
        .axis = {0, -1, 0},
        .cone_offset = 1,
        .emission = {3, 3, 3},
        .profile = 1,
        .profile_columns = profile->columns,
        .side = {1, 0, 0},
    };
}

static void set_lamp(struct world *w, const struct point_light *lamp,
                     const struct profile *profile)
{
    w->point_lights = lamp;
    w->settings.point_light_count = 1;
    w->profiles = profile->values;
    w->settings.profile_value_count = profile_value_count(profile);
}

/* E = I cos^n cos / d^2. Interpolation between degrees is too low by at most
 * n^2 / 8 of a degree's square, for the angles here. */
static void powers_of_cosines_light_the_floor(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n += 3) {
        struct profile *profile = make_power_of_cosine(n);

        for (int i = 0; i < 3; i++) {
            struct vec3 p = {.4f * (float)i, 1, -.3f * (float)i};
            struct point_light lamp = lamp_at(p, profile);
            double square = (double)v3_dot(p, p), cosine = 1 / sqrt(square);
            struct lit_mesh s = {.lights = {.lights = NULL}};

            s.mesh.materials[0] =
                mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
            add_receiver(&s.mesh, v3(0, 0, 0), v3(0, 1, 0));
            set_lamp(&s.mesh.world, &lamp, profile);
            lit_mesh_finish(&s);
            check_claim(
                &s, ((struct claim){.eye = eye_over(v3(0, 0, 0), v3(0, 1, 0)),
                                    .at = {0, 0, 0},
                                    .truth = GREY(ALBEDO / M_PI * 3 *
                                                  pow(cosine, n + 1) / square),
                                    .systematic = 4e-5 * n * n,
                                    .paths = 64,
                                    .without = 1 << DIRECT_BSDF}));
            lit_mesh_free(&s);
        }
        profile_release(profile);
    }
}

/* The flux of cos^n is 2 pi I / (n + 1); the power of a surface with this flux
 * is 1 / 2 pi of it. A spot has the part of its cone. */
static void powers_are_those_of_the_flux(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        struct profile *profile = make_power_of_cosine(n);
        struct point_light lamp = lamp_at(v3(0, 1, 0), profile);
        struct world w = {.positions = NULL};

        set_lamp(&w, &lamp, profile);
        check_close(point_light_power(&w, &lamp), 3.0 / (n + 1), 2e-3);
        profile_release(profile);
    }
}

/* Brightness by angles, the same on both sides of the planes of an enum
 * symmetry. */
enum symmetry { BOTH_PLANES, PLANE_OF_0, PLANE_OF_90 };

static double shape(enum symmetry symmetry, double vertical, double horizontal)
{
    double angle = horizontal * M_PI / 180;
    double wave = symmetry == BOTH_PLANES  ? cos(2 * angle)
                  : symmetry == PLANE_OF_0 ? cos(angle)
                                           : sin(angle);

    return (1 + .5 * wave) * (1 + vertical / 180);
}

static struct profile *make_shape(enum symmetry symmetry, int first, int last,
                                  int step)
{
    struct text t;

    open_text(&t);
    write_header(&t, 5, (last - first) / step + 1);
    fputs("0,45,90 135\t180\n", t.to);
    for (int i = first; i <= last; i += step)
        fprintf(t.to, "%d ", i);
    for (int i = first; i <= last; i += step)
        for (int k = 0; k <= 180; k += 45)
            fprintf(t.to, "\r\n%.9g", shape(symmetry, k, i));
    return close_text(&t);
}

static void symmetric_files_are_like_full_ones(void **state)
{
    static const int ranges[][2] = {[BOTH_PLANES] = {0, 90},
                                    [PLANE_OF_0] = {0, 180},
                                    [PLANE_OF_90] = {90, 270}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        enum symmetry symmetry = (enum symmetry)i;
        struct profile *full = make_shape(symmetry, 0, 360, 5);
        struct profile *p = make_shape(symmetry, ranges[i][0], ranges[i][1], 5);

        assert_true(full->columns > 1);
        assert_int_equal(p->columns, full->columns);
        for (uint32_t k = 0; k < profile_value_count(p); k++)
            check_close((double)p->values[k], (double)full->values[k], 1e-6);
        profile_release(p);
        profile_release(full);
    }
}

/* A circle in equal steps need not repeat its first angle at 360 degrees, and
 * may begin anywhere. */
static void open_circles_are_closed(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        enum symmetry symmetry = (enum symmetry)i;
        struct profile *full = make_shape(symmetry, 0, 360, 5);
        struct profile *open = make_shape(symmetry, 0, 355, 5);
        struct profile *fine = make_shape(symmetry, 0, 360, 1);
        struct profile *later = make_shape(symmetry, 1, 359, 2);

        assert_int_equal(open->columns, full->columns);
        for (uint32_t k = 0; k < profile_value_count(open); k++)
            check_close((double)open->values[k], (double)full->values[k], 1e-6);
        /* steps of two degrees are off by .5 * (pi / 180)^2 of the second
         * derivative at most, which is 4 */
        for (uint32_t k = 0; k < profile_value_count(later); k++)
            check_close((double)later->values[k], (double)fine->values[k],
                        1e-3);
        profile_release(full);
        profile_release(open);
        profile_release(fine);
        profile_release(later);
    }
}

/* Horizontal angle 0 is towards +x, 90 towards -z: counter-clockwise seen from
 * above. */
static void angles_have_their_directions(void **state)
{
    struct profile *profile;
    struct point_light lamp;
    struct world w = {.positions = NULL};
    struct text t;

    (void)state;
    open_text(&t);
    write_header(&t, 3, 5);
    fputs("0 90 180\n0 90 180 270 360\n"
          "1 2 6\n1 3 6\n1 4 6\n1 5 6\n1 2 6\n",
          t.to);
    profile = close_text(&t);
    lamp = lamp_at(v3(0, 0, 0), profile);
    set_lamp(&w, &lamp, profile);
    check_close((double)profile_at(&w, 0, v3(0, -1, 0)), 1, 1e-5);
    check_close((double)profile_at(&w, 0, v3(1, 0, 0)), 2, 1e-5);
    check_close((double)profile_at(&w, 0, v3(0, 0, -1)), 3, 1e-5);
    check_close((double)profile_at(&w, 0, v3(-1, 0, 0)), 4, 1e-5);
    check_close((double)profile_at(&w, 0, v3(0, 0, 1)), 5, 1e-5);
    /* between the angles */
    for (int degrees = 1; degrees < 90; degrees += 11) {
        double angle = (degrees + 0.37) * M_PI / 180;

        check_close((double)profile_at(&w, 0,
                                       v3((float)cos(angle), 0,
                                          (float)-sin(angle))),
                    2 + (degrees + 0.37) / 90, 1e-4);
    }
    check_close((double)profile_at(&w, 0, v3(0, 1, 0)), 6, 1e-5);
    check_close((double)profile_at(&w, 0, v3_unit(v3(1, 0, -1))), 2.5, 1e-3);
    check_close((double)profile_at(&w, 0, v3_unit(v3(1, -1, 0))), 1.5, 1e-3);
    profile_release(profile);
}

/* Directions without values are dark; the first format has no first line. */
static void missing_angles_are_dark(void **state)
{
    struct profile *profile;
    struct text t;

    (void)state;
    open_text(&t);
    fprintf(t.to,
            "a lamp\rTILT=NONE\r1 0 %g 2 1 1 1 0 0 0\r2 .25 0\r"
            "90 180\r0\r2 2\r",
            DAYLIGHT_UNIT);
    profile = close_text(&t);
    assert_int_equal(profile->columns, 1);
    check_close((double)profile->values[89], 0, 0);
    check_close((double)profile->values[90], 1, 1e-6);
    check_close((double)profile->values[180], 1, 1e-6);
    profile_release(profile);
}

static void broken_files_have_their_message(void **state)
{
#define HEAD "IESNA91\nTILT=NONE\n"
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "a.ies: found no line that begins with TILT=, expected an IES "
             "file"},
        {"P6\n1 1\n", "a.ies: found no line that begins with TILT=, expected "
                      "an IES file"},
        {"TILT=INCLUDE\n1\n",
         "a.ies:1: found 'INCLUDE', expected NONE behind TILT=: a lamp that "
         "emits the same in any position"},
        {"x\nTILT=\n", "a.ies:2: found the end, expected NONE behind TILT=: a "
                       "lamp that emits the same in any position"},
        {HEAD, "a.ies:3: found the end, expected a number of lamps"},
        {HEAD "1 2 x", "a.ies:3: found 'x', expected a factor of candela "
                       "values from 0"},
        {HEAD "1 2 3 0", "a.ies:3: found '0', expected 1 to 1000 vertical "
                         "angles"},
        {HEAD "1 2 3 2.5", "a.ies:3: found '2.5', expected 1 to 1000 vertical "
                           "angles"},
        {HEAD "1 2 3 1\n1001", "a.ies:4: found '1001', expected 1 to 1000 "
                               "horizontal angles"},
        {HEAD "1 2 3 1 1 2", "a.ies:3: found '2', expected 1, the photometry "
                             "of type C; 2 and 3 are types B and A"},
        {HEAD "1 2 3 2 1 1 1 0 0 0 1 1 1\n90 0",
         "a.ies:4: found '0', expected an angle above the one before"},
        {HEAD "1 2 3 1 1 1 1 0 0 0 1 1 1\n-90",
         "a.ies:4: found '-90', expected a vertical angle from 0 to 180"},
        {HEAD "1 2 3 1 2 1 1 0 0 0 1 1 1\n0\n0 45\n1 1",
         "a.ies:5: found horizontal angles from 0 to 45, expected 0, 0 to 90, "
         "0 to 180, 90 to 270, 0 to 360 or equal steps of a circle"},
        {HEAD "1 2 3 1 3 1 1 0 0 0 1 1 1\n0\n0 120 230\n1 1 1",
         "a.ies:5: found horizontal angles from 0 to 230, expected 0, 0 to 90, "
         "0 to 180, 90 to 270, 0 to 360 or equal steps of a circle"},
        {HEAD "1 2 3 1 1 1 1 0 0 0 1 1 1\n0 0 -1",
         "a.ies:4: found '-1', expected a candela value from 0 to 1e12"},
        {HEAD "1 2 3 1 1 1 1 0 0 0 1 1 1\n0 0 nan",
         "a.ies:4: found 'nan', expected a candela value from 0 to 1e12"},
        {HEAD "1 2 3 1 1 1 1 0 0 0 1 1 1\n0 0 0",
         "a.ies: found a greatest candela value of 0, expected one from above "
         "0 to 1e12"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct error err = {""};

        assert_null(
            ies_parse(cases[i].text, strlen(cases[i].text), "a.ies", &err));
        assert_string_equal(err.text, cases[i].message);
    }
}

/* A lamp whose file cannot be used shines evenly, with a warning, and the view
 * is saved with the name of the file. */
static void unusable_files_shine_evenly(void **state)
{
    static const char *const lines[] = {
        "light point 1 2 3 ies broken.ies\n",
        "light point 1 2 3 ies missing.ies\n",
        "light spot 1 2 3 at 0 0 0 ies broken.ies\n",
    };

    (void)state;
    put("broken.ies", HEAD "1 2 3 1 3 1 1 0 0 0 1 1 1\n0\n0 120 230\n1 1 1");
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        struct warnings report = {0};
        const struct profile *profile;
        struct error err;
        struct view view;
        char *text;
        size_t size_bytes;

        put("v.view", lines[i]);
        view_init(&view);
        check_or_say(view_read(&view, "v.view", &report, &err), err.text);
        assert_int_equal(report.entry_count, 1);
        check_has(report.entries[0].text, ".ies:");
        check_has(report.entries[0].text, ": the light shines evenly");
        profile = view.lamps.items[0].profile;
        assert_non_null(profile);
        for (uint32_t k = 0; k < profile_value_count(profile); k++)
            check_close((double)profile->values[k], 1, 0);
        check_or_say(view_format(&view, &(struct file_bytes){"v.view", "", 0},
                                 &text, &size_bytes, &err),
                     err.text);
        assert_non_null(strstr(text, strstr(lines[i], " ies")));
        free(text);
        view_free(&view);
        warnings_free(&report);
    }
}

/* Names with blanks are the rest of the line, relative to the view file, which
 * is saved with them. */
static void view_files_name_profiles(void **state)
{
    const char *line = "light point 1 2 3 radius 0.5 ies my lamp.ies\n";
    struct warnings report = {0};
    struct view view, copy;
    struct error err;
    char *text;
    size_t size_bytes;

    (void)state;
    put("my lamp.ies", HEAD "1 1 1 1 1 1 1 0 0 0 1 1 1 0 0 30000");
    put("v.view", line);
    view_init(&view);
    view_init(&copy);
    check_or_say(view_read(&view, "v.view", &report, &err), err.text);
    assert_int_equal(view.lamps.count, 1);
    assert_non_null(view.lamps.items[0].profile);
    check_close((double)view.lamps.items[0].profile->values[0], 1, 1e-6);
    assert_true(view_copy(&copy, &view));
    assert_true(lamps_equal(&view.lamps, &copy.lamps));
    check_or_say(view_format(&view,
                             &(struct file_bytes){"v.view", line, strlen(line)},
                             &text, &size_bytes, &err),
                 err.text);
    assert_non_null(strstr(text, line));
    free(text);
    profile_release(copy.lamps.items[0].profile);
    copy.lamps.items[0].profile = NULL;
    assert_false(lamps_equal(&view.lamps, &copy.lamps));
    view_free(&view);
    view_free(&copy);
    warnings_free(&report);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(powers_of_cosines_light_the_floor),
        cmocka_unit_test(powers_are_those_of_the_flux),
        cmocka_unit_test(symmetric_files_are_like_full_ones),
        cmocka_unit_test(open_circles_are_closed),
        cmocka_unit_test(angles_have_their_directions),
        cmocka_unit_test(missing_angles_are_dark),
        cmocka_unit_test(broken_files_have_their_message),
        cmocka_unit_test_setup_teardown(unusable_files_shine_evenly,
                                        enter_folder, remove_folder),
        cmocka_unit_test_setup_teardown(view_files_name_profiles, enter_folder,
                                        remove_folder),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
