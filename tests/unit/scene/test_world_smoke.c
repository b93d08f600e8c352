// SPDX-License-Identifier: MIT
/*
 * test_world_smoke.c - where the voxels of smokes are, what black bodies emit,
 * and smokes that are left out, refused or bounded
 */
#include <math.h>

#include "tests/unit/smoke_world.h"
#include "kernels/smoke.h"

/* ---- places ---- */

static const uint32_t size[3] = {11, 4, 18};
static const int32_t origin[3] = {-24, 16, 8};
static const int32_t first[3] = {2, 0, 3}, last[3] = {9, 3, 17};

/* A turned and mirrored file, of voxels that are not cubes. */
static const struct affine to_file = {
    .m = {{.3, -.4, 0, 7}, {.8, .6, .1, -3}, {0, .2, -.25, 1}}};

static struct voxel_grid turned_grid(void)
{
    float numbers[18 * 4 * 11];
    struct voxel_grid g;

    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        numbers[i] = (float)(1 + i % 5);
    g = grid_of(size, numbers);
    for (int a = 0; a < 3; a++) {
        g.origin[a] = origin[a];
        g.first[a] = origin[a] + first[a];
        g.last[a] = origin[a] + last[a];
    }
    g.to_world = to_file;
    return g;
}

/* Sets the point of a place that is counted from the first brick's, in the file
 * after its turn. */
static void file_point(const double place[3], bool up_is_z, double to[3])
{
    double p[3], q[3];

    for (int a = 0; a < 3; a++)
        p[a] = place[a] + origin[a];
    for (int a = 0; a < 3; a++)
        q[a] = to_file.m[a][0] * p[0] + to_file.m[a][1] * p[1] +
               to_file.m[a][2] * p[2] + to_file.m[a][3];
    set3(to, q[0], up_is_z ? q[2] : q[1], up_is_z ? -q[1] : q[2]);
}

/* Sets the bounds of the active voxels. */
static void file_bounds(bool up_is_z, double low[3], double high[3])
{
    for (int c = 0; c < 8; c++) {
        double place[3], p[3];

        for (int a = 0; a < 3; a++)
            place[a] = (c >> a & 1) != 0 ? last[a] + .5 : first[a] - .5;
        file_point(place, up_is_z, p);
        for (int a = 0; a < 3; a++) {
            low[a] = c == 0 ? p[a] : fmin(low[a], p[a]);
            high[a] = c == 0 ? p[a] : fmax(high[a], p[a]);
        }
    }
}

/* Voxels end up where scale, place, box and turn of the view say. */
static void voxels_are_placed(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < 40; i++) {
        struct smoke_world w;
        struct world world = {.voxels = NULL};
        struct voxel_grid grid = turned_grid();
        struct smoke_numbers *n;
        bool up_is_z = i % 2 != 0, has_box = i % 4 >= 2;
        double low[3], high[3];

        smoke_world_init(&w);
        w.scene.scale = .05 + check_random(&seed);
        set3(w.scene.center, check_random(&seed), 3, -2);
        smoke_world_add(&w, "d", &grid);
        n = smoke_world_fill(&w, "d", "", 0, 0);
        set3(n->scatter, 1, 2, 3);
        set3(n->at, check_random(&seed), -2, 4 * check_random(&seed));
        n->scale = .1 + 3 * check_random(&seed);
        w.smokes.items[0].up_is_z = up_is_z;
        for (int a = 0; has_box && a < 3; a++) {
            n->box[a] = check_random(&seed) - a;
            n->box[a + 3] = n->box[a] + .1 + 2 * check_random(&seed);
        }
        smoke_world_lend(&w, &world);
        file_bounds(up_is_z, low, high);
        for (int k = 0; k < 50; k++) {
            double place[3], p[3];
            struct vec3 got;

            set3(place, first[0] + 7 * check_random(&seed),
                 first[1] + 3 * check_random(&seed),
                 first[2] + 14 * check_random(&seed));
            file_point(place, up_is_z, p);
            for (int a = 0; a < 3; a++) {
                p[a] = has_box ? n->box[a] + (n->box[a + 3] - n->box[a]) *
                                                 (p[a] - low[a]) /
                                                 (high[a] - low[a])
                               : p[a] * n->scale + n->at[a];
                p[a] = (p[a] - w.scene.center[a]) * w.scene.scale;
            }
            got = field_point(&world.smokes[0].density,
                              v3((float)p[0], (float)p[1], (float)p[2]));
            check_close((double)got.x, place[0], 1e-3);
            check_close((double)got.y, place[1], 1e-3);
            check_close((double)got.z, place[2], 1e-3);
        }
        check_close((double)world.smokes[0].scattering.y, 2 / w.scene.scale,
                    1e-5 / w.scene.scale);
        smoke_world_free(&w);
    }
}

/* Makes a grid of one brick with a number everywhere, beside which this
 * background is active. */
static struct voxel_grid wide_grid(float number, float background)
{
    struct voxel_grid g;
    float numbers[512];

    for (int i = 0; i < 512; i++)
        numbers[i] = number;
    g = grid_of((const uint32_t[3]){8, 8, 8}, numbers);
    g.background = background;
    for (int i = 0; i < BRICK_VOXELS; i++)
        g.values[i] = background;
    g.first[0] = -20;
    g.last[1] = 30;
    free(g.majorants);
    assert_true(voxel_grid_bound(&g));
    return g;
}

/* Active voxels outside of a file's bricks have the background. */
static void voxels_beside_bricks_are_background(void **state)
{
    static const float backgrounds[] = {0, -3, 2};

    (void)state;
    for (int i = 0; i < 3; i++) {
        struct voxel_grid grid = wide_grid(5, backgrounds[i]);
        struct smoke_world w;
        struct world world = {.voxels = NULL};
        const struct voxel_field *f;
        double sum[2] = {0};
        const int n = 41;

        smoke_world_init(&w);
        smoke_world_add(&w, "d", &grid);
        set3(smoke_world_fill(&w, "d", "", 0, 0)->absorb, 1, 1, 1);
        smoke_world_lend(&w, &world);
        f = &world.smokes[0].density;
        for (int k = 0; k < n * n; k++) {
            struct vec3 p =
                v3((float)(k % n) - 25.3f, (float)(k / n) + .2f, 4.6f);
            bool is_far = p.x < -1 || p.y > 9;

            if (field_has(f, p))
                sum[is_far] +=
                    (double)field_value(&world, f, field_point(f, p)) /
                    (is_far ? 1 : 72);
        }
        assert_true(sum[0] > 3);
        assert_true(backgrounds[i] > 0 ? sum[1] > 1000 : sum[1] <= 0);
        for (uint32_t k = 0; k < world.settings.voxel_place_count; k++)
            assert_in_range(world.voxel_places[k].brick, 0,
                            world.settings.voxel_count / BRICK_VOXELS - 1);
        smoke_world_free(&w);
    }
}

/* ---- black bodies ---- */

/* Sensitivity of the eye at a wavelength in nanometres, by the fit of Wyman,
 * Sloan and Shirley 2013, "Simple analytic approximations to the CIE XYZ color
 * matching functions", whose error is some percent. */
static double sensitivity(double nm)
{
    double a = (nm - 568.8) / (nm < 568.8 ? 46.9 : 40.5);
    double b = (nm - 530.9) / (nm < 530.9 ? 16.3 : 31.1);

    return .821 * exp(-a * a / 2) + .286 * exp(-b * b / 2);
}

/* Returns the luminance of a black body, up to a factor. */
static double luminance_of(double kelvin)
{
    double sum = 0;

    for (double nm = 380; nm < 780; nm++)
        sum += sensitivity(nm) * pow(nm / 500, -5) /
               expm1(.014387769 / (nm * 1e-9 * kelvin));
    return sum;
}

static double luminance(struct vec3 c)
{
    return .2126 * (double)c.x + .7152 * (double)c.y + .0722 * (double)c.z;
}

/* Emission at a point is that of a black body of its temperature, and the
 * hottest one has the luminance of the view. */
static void emission_obeys_planck(void **state)
{
    float numbers[16];
    struct smoke_world w;
    struct world world = {.voxels = NULL};
    struct voxel_grid grid;
    struct smoke_numbers *n;
    const double most = 2 * 1500.;

    (void)state;
    for (int i = 0; i < 16; i++)
        numbers[i] = (float)i * 2 / 15; /* to 3000 K along x */
    grid = grid_of((const uint32_t[3]){16, 1, 1}, numbers);
    smoke_world_init(&w);
    smoke_world_add(&w, "t", &grid);
    n = smoke_world_fill(&w, "t", "t", 0, 0);
    set3(n->absorb, 1, 1, 1);
    n->kelvin = 1500;
    n->glow = 6;
    smoke_world_lend(&w, &world);
    assert_int_equal(world.settings.glow_count, GLOW_ENTRIES);
    for (int i = 0; i < 100; i++) {
        double part = .3 + .7 * i / 100, kelvin = most * part;
        struct vec3 p = v3((float)(15 * part + .5), .5f, .5f);
        struct vec3 got = smoke_emission(&world, &world.smokes[0], p);
        double want = 6 * luminance_of(kelvin) / luminance_of(most);

        check_close(luminance(got), want, .03 * want);
        assert_true(got.x >= got.y && got.y >= got.z);
    }
    check_close(luminance(world.glows[GLOW_ENTRIES - 1]), 6, 1e-3);
    assert_true(v3_is_zero(world.glows[0]));
    smoke_world_free(&w);
}

/* ---- what is left out, refused or bounded ---- */

static void smokes_without_effect_are_left_out(void **state)
{
    static const uint32_t one[3] = {1, 1, 1};
    static const float nothing = 0, less = -4, all = 1;
    struct voxel_grid zero = grid_of(one, &nothing),
                      negative = grid_of(one, &less);
    struct voxel_grid full = grid_of(one, &all), inactive = grid_of(one, &all);
    struct smoke_world w;
    struct world world = {.voxels = NULL};

    (void)state;
    smoke_world_init(&w);
    inactive.first[1] = inactive.last[1] + 1;
    for (int i = 0; i < 3; i++) { /* of files without bricks */
        struct voxel_grid none = {.first = {1, 1, 1}};

        none.index = calloc(1, sizeof *none.index);
        smoke_world_add(&w, i == 0 ? "none" : "again", &none);
    }
    smoke_world_add(&w, "zero", &zero);
    smoke_world_add(&w, "negative", &negative);
    smoke_world_add(&w, "inactive", &inactive);
    smoke_world_add(&w, "full", &full);
    set3(smoke_world_fill(&w, "none", "", 0, 0)->absorb, 1, 1, 1);
    set3(smoke_world_fill(&w, "zero", "", 0, 0)->absorb, 1, 1, 1);
    set3(smoke_world_fill(&w, "negative", "", 0, 0)->absorb, 1, 1, 1);
    set3(smoke_world_fill(&w, "inactive", "", 0, 0)->absorb, 1, 1, 1);
    smoke_world_fill(&w, "full", "", 0, 0);
    set3(smoke_world_fill(&w, "full", "", 0, 0)->absorb, 1e-40, 0, 0);
    smoke_world_lend(&w, &world);
    assert_int_equal(world.settings.smoke_count, 0);
    set3(smoke_world_fill(&w, "full", "zero", 0, 0)->absorb, 0, 1, 0);
    set3(smoke_world_fill(&w, "full", "full", 0, 0)->absorb, 0, 2, 0);
    w.smokes.items[w.smokes.count - 1].numbers.glow = 0;
    set3(smoke_world_fill(&w, "full", "full", 0, 0)->absorb, 0, 3, 0);
    w.smokes.items[w.smokes.count - 1].numbers.kelvin = .9;
    set3(smoke_world_fill(&w, "full", "full", 0, 0)->absorb, 0, 4, 0);
    w.smokes.items[w.smokes.count - 1].numbers.kelvin = 1000;
    smoke_world_lend(&w, &world);
    assert_int_equal(world.settings.smoke_count, 4);
    assert_int_equal(world.settings.glow_count, GLOW_ENTRIES);
    for (int i = 0; i < 4; i++) {
        check_close((double)world.smokes[i].extinction.y, i + 1, 0);
        assert_int_equal(world.smokes[i].first_glow, i == 3 ? 0 : NO_INDEX);
    }
    smoke_world_free(&w);
}

/* Flat grids, and those beyond floats, are refused with a line. The world keeps
 * its smokes. */
static void flat_grids_are_refused(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct voxel_grid good = turned_grid(), bad = turned_grid();
        struct error err = {""};
        struct smoke_world w;
        struct smoke_numbers *n;
        struct world world = {.voxels = NULL};
        uint64_t generation;

        if (i == 0)
            bad.to_world.m[2][2] = bad.to_world.m[2][1] = 0;
        smoke_world_init(&w);
        smoke_world_add(&w, "good", &good);
        smoke_world_add(&w, "bad", &bad);
        set3(smoke_world_fill(&w, "good", "", 0, 0)->scatter, 1, 1, 1);
        smoke_world_lend(&w, &world);
        n = smoke_world_fill(&w, "bad", "", 0, 0);
        set3(n->scatter, 1, 1, 1);
        n->scale = i == 1 ? 1e-45 : 1;
        n->at[1] = i == 2 ? 1e33 : 0;
        if (i == 3)
            for (int a = 0; a < 3; a++)
                n->box[a + 3] = 1e-300;
        generation = w.host.generation;
        assert_false(world_set_smokes(&w.host, &w.scene, &w.smokes, &err));
        assert_string_equal(err.text, "smoke: found a grid that is flat or too "
                                      "far away");
        assert_int_equal(w.host.smoke_count, 1);
        assert_true(w.host.smokes == world.smokes);
        assert_true(w.host.generation == generation);
        smoke_world_free(&w);
    }
}

/* The largest extinction is 1e30, and the shares of scattering stay. */
static void coefficients_are_bounded(void **state)
{
    static const float most[] = {1e10f, 1, 1e-3f};

    (void)state;
    for (int i = 0; i < 3; i++) {
        struct voxel_grid grid =
            grid_of((const uint32_t[3]){1, 1, 1}, &most[i]);
        double limit = 1e30 / fmax(1, (double)most[i]);
        struct smoke_world w;
        struct world world = {.voxels = NULL};
        struct smoke_numbers *n;

        smoke_world_init(&w);
        w.scene.scale = 1e-3;
        smoke_world_add(&w, "d", &grid);
        n = smoke_world_fill(&w, "d", "", 0, 0);
        set3(n->scatter, 3e29, 1e10, 0);
        set3(n->absorb, 1e29, 0, 2e29);
        n->anisotropy = 1;
        smoke_world_lend(&w, &world);
        check_close((double)world.smokes[0].most, limit, 1e-5 * limit);
        check_close((double)world.smokes[0].extinction.x, limit, 1e-5 * limit);
        check_close((double)world.smokes[0].scattering.x, .75 * limit,
                    1e-5 * limit);
        check_close((double)world.smokes[0].scattering.y, limit * 1e10 / 4e29,
                    1e-5 * limit * 1e10 / 4e29);
        check_close((double)world.smokes[0].extinction.z, limit / 2,
                    1e-5 * limit);
        assert_true(world.smokes[0].scattering.z == 0);
        assert_true(world.smokes[0].anisotropy < 1);
        smoke_world_free(&w);
    }
}

/* A world is new only if its smokes are. */
static void the_same_smokes_change_nothing(void **state)
{
    struct voxel_grid grid = turned_grid(), again = turned_grid();
    struct smoke_world w;
    struct world world = {.voxels = NULL};
    struct smoke_numbers *n;
    uint64_t generation;

    (void)state;
    smoke_world_init(&w);
    assert_false(world_has_grid(&w.host, SMOKE_FILE, "d"));
    smoke_world_add(&w, "d", &grid);
    assert_true(world_has_grid(&w.host, SMOKE_FILE, "d"));
    assert_false(world_has_grid(&w.host, SMOKE_FILE, ""));
    n = smoke_world_fill(&w, "d", "d", 0, 1);
    set3(n->absorb, 1, 1, 1);
    n->kelvin = 800;
    smoke_world_lend(&w, &world);
    generation = w.host.generation;
    smoke_world_lend(&w, &world);
    assert_true(w.host.generation == generation);
    n->kelvin = 801;
    smoke_world_lend(&w, &world);
    assert_true(w.host.generation > generation);
    generation = w.host.generation;
    n->absorb[2] = 1.01;
    smoke_world_lend(&w, &world);
    assert_true(w.host.generation > generation);
    generation = w.host.generation;
    smoke_world_add(&w, "e", &again);
    assert_true(w.host.generation > generation);
    smoke_world_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(voxels_are_placed),
        cmocka_unit_test(voxels_beside_bricks_are_background),
        cmocka_unit_test(emission_obeys_planck),
        cmocka_unit_test(smokes_without_effect_are_left_out),
        cmocka_unit_test(flat_grids_are_refused),
        cmocka_unit_test(coefficients_are_bounded),
        cmocka_unit_test(the_same_smokes_change_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
