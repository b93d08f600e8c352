// SPDX-License-Identifier: MIT
/*
 * test_caustic_lobes.c - caustics of spheres and discs: their means and
 * directions against closed forms, and the densities of lobes
 */
#include "tests/bench/median.h"
#include "tests/unit/truth.h"
#include "world/light/path_guide.h"
#include "kernels/caustic_lobes.h"

#define ALBEDO 0.5

/* Reflectance of glass of index 1.5 at normal incidence. */
#define REFLECTANCE 0.04

/* Light samples do not pass glass. */
#define NOT_BY_LIGHTS (1 << DIRECT_LIGHTS)

/* Glass between the floor at y = 0 and the light. */
enum caster { NOTHING, PANE, SLAB };

static void make_floor(struct lit_mesh *s, enum caster caster)
{
    struct mesh *m = &s->mesh;

    *s = (struct lit_mesh){.mesh = {.positions = NULL}};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    m->materials[1] =
        mesh_material(caster == PANE ? MATERIAL_THIN_GLASS : MATERIAL_GLASS, 1);
    m->materials[1].ior = 1.5f;
    mesh_add_quad(m, v3(-.5f, 0, -.5f), v3(-.5f, 0, .5f), v3(.5f, 0, .5f),
                  v3(.5f, 0, -.5f), 0);
    if (caster == PANE)
        mesh_add_quad(m, v3(-.5f, .3f, -.5f), v3(-.5f, .3f, .5f),
                      v3(.5f, .3f, .5f), v3(.5f, .3f, -.5f), 1);
    if (caster == SLAB)
        mesh_add_box(m, v3(-.5f, .3f, -.5f), v3(.5f, .4f, .5f), 1);
}

static void build(struct lit_mesh *s, struct path_guide *g)
{
    struct error err;

    lit_mesh_lend(s, DIRECT_MIS);
    check_or_say(path_guide_update(g, &s->mesh.wide_world, &s->lights, 0, NULL,
                                   &err),
                 err.text);
    path_guide_lend(g, &s->mesh.world);
}

/* The sun: a disc of .533 degrees, at this angle from the vertical. */
static struct directional_light sun_at(double angle, double irradiance)
{
    double half_rad = .2665 * M_PI / 180;
    double sine = sin(half_rad);
    float radiance = (float)(irradiance / (M_PI * sine * sine));

    return (struct directional_light){
        .d = {(float)sin(angle), (float)cos(angle), 0},
        .size = (float)(2 * pow(sin(half_rad / 2), 2)),
        .sine = (float)sine,
        .emission = {radiance, radiance, radiance},
        .power = (float)irradiance,
    };
}

static void set_sun(struct lit_mesh *s, const struct directional_light *sun)
{
    s->mesh.world.directional_lights = sun;
    s->mesh.world.settings.directional_light_count = 1;
}

static void set_sphere(struct lit_mesh *s, const struct point_light *sphere)
{
    s->mesh.world.point_lights = sphere;
    s->mesh.world.settings.point_light_count = 1;
}

/* Fresnel reflectance of a surface of index 1.5, and by reflections between its
 * two sides the transmittance of a sheet. */
static double sheet_transmittance(double cosine)
{
    double sine = sqrt(1 - cosine * cosine) / 1.5;
    double inside = sqrt(1 - sine * sine);
    double rs = (cosine - 1.5 * inside) / (cosine + 1.5 * inside);
    double rp = (1.5 * cosine - inside) / (1.5 * cosine + inside);

    return ((1 - rs * rs) / (1 + rs * rs) + (1 - rp * rp) / (1 + rp * rp)) / 2;
}

/* Radiance of the floor by direct light through the glass. The slab sends
 * REFLECTANCE^2 of it around once more, which the limit of vertices cuts. */
static void check_floor(struct lit_mesh *s, enum caster caster,
                        double irradiance, int paths)
{
    const struct claim c = {
        .eye = {.03f, .1f, .02f},
        .at = {0, 0, 0},
        .truth = GREY(ALBEDO / M_PI * irradiance),
        .systematic = caster == SLAB ? 2 * REFLECTANCE * REFLECTANCE : 0,
        .paths = paths,
        .without = NOT_BY_LIGHTS,
    };

    s->mesh.world.settings.max_vertices = caster == SLAB ? 4 : 3;
    check_claim(s, c);
}

static void suns_shine_through_glass(void **state)
{
    (void)state;
    for (int caster = PANE; caster <= SLAB; caster++)
        for (int i = 0; i < 2; i++) {
            double angle = i * .5;
            struct directional_light sun = sun_at(angle, 2);
            struct path_guide g = {.cells = NULL};
            struct lit_mesh s;

            make_floor(&s, (enum caster)caster);
            set_sun(&s, &sun);
            lit_mesh_finish(&s);
            build(&s, &g);
            assert_non_null(g.lamps.nodes);
            check_floor(&s, (enum caster)caster,
                        2 * cos(angle) * sheet_transmittance(cos(angle)), 8000);
            path_guide_free(&g);
            lit_mesh_free(&s);
        }
}

/* A sphere straight above is small enough to be a point: E = I T / d^2. */
static void spheres_shine_through_panes(void **state)
{
    const float radius = .004f, height = .8f;
    const float radiance = 1 / (PI * radius * radius);
    struct point_light sphere = {.p = {0, height, 0},
                                 .radius = radius,
                                 .cone_offset = 1,
                                 .emission = {radiance, radiance, radiance}};
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;

    (void)state;
    make_floor(&s, PANE);
    set_sphere(&s, &sphere);
    lit_mesh_finish(&s);
    build(&s, &g);
    assert_non_null(g.lamps.nodes);
    check_floor(&s, PANE, sheet_transmittance(1) / (double)(height * height),
                60000);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* A sphere of glass on a floor under the sun. */
static void make_ball(struct lit_mesh *s, struct directional_light *sun)
{
    struct mesh *m = &s->mesh;

    make_floor(s, NOTHING);
    for (int i = 0; i < 16; i++)
        for (int k = 0; k < 8; k++) {
            struct vec3 p[4];

            for (int j = 0; j < 4; j++) {
                double a = (i + (j == 1 || j == 2)) * M_PI / 8;
                double b = (k + (j > 1)) * M_PI / 8;

                p[j] = v3((float)(.15 * sin(b) * cos(a)),
                          (float)(.2 - .15 * cos(b)),
                          (float)(.15 * sin(b) * sin(a)));
            }
            mesh_add(m, p[0], p[2], p[1], 1);
            mesh_add(m, p[0], p[3], p[2], 1);
        }
    *sun = sun_at(.3, 1);
    set_sun(s, sun);
    lit_mesh_finish(s);
}

/* A floor of albedo .5 that emits .5 has radiance 1 where all else has, also
 * below a pane: lobes change no mean. */
static void lobes_keep_the_mean(void **state)
{
    struct directional_light sun = sun_at(.2, 2);
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;
    struct claim c = {.eye = {.03f, .1f, .02f},
                      .at = {0, 0, 0},
                      .truth = GREY(1),
                      .paths = 4000,
                      .without = NOT_BY_LIGHTS};

    (void)state;
    make_floor(&s, PANE);
    s.mesh.materials[0].emission = v3(.5f, .5f, .5f);
    s.mesh.world.settings.sky.color = v3(1, 1, 1);
    set_sun(&s, &sun);
    lit_mesh_finish(&s);
    build(&s, &g);
    assert_int_not_equal(caustic_leaf_at(&s.mesh.world, c.at, v3(0, 1, 0)),
                         NO_INDEX);
    s.mesh.world.settings.directional_light_count = 0;
    check_claim(&s, c);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* A lobe with a width of .1 by .05 on the plane z = 2, whose middle is above p
 * times (1 / 4, 1 / 2). */
static struct caustic_lobe make_lobe(float sum)
{
    return (struct caustic_lobe){
        .axis = {0, 0, 1},
        .height = 2,
        .u = {10, 0, 0},
        .v = {0, 20, 0},
        .du = {10 * .75f, 0, 0},
        .dv = {0, 20 * .5f, 0},
        .scale = 200 / PI,
        .sum = sum,
    };
}

/* The density of Student's t on the plane, per solid angle. */
static void lobes_have_students_density(void **state)
{
    struct caustic_lobe lobe = make_lobe(1);
    uint64_t random = 1;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        double x = 4 * check_random(&random) - 2;
        double y = 4 * check_random(&random) - 2;
        double z = 1.5 * check_random(&random);
        double to_x = x / 4 + .4 * check_random(&random) - .2;
        double to_y = y / 2 + .4 * check_random(&random) - .2;
        double square = (to_x - x) * (to_x - x) + (to_y - y) * (to_y - y) +
                        (2 - z) * (2 - z);
        double u = (to_x - x / 4) / .1, v = (to_y - y / 2) / .05;
        double on_plane = 1 / (M_PI * .1 * .05 * pow(1 + u * u + v * v, 2));
        double truth = on_plane * square * sqrt(square) / (2 - z);
        struct vec3 p = v3((float)x, (float)y, (float)z);
        struct vec3 d = v3_unit(v3_sub(v3((float)to_x, (float)to_y, 2), p));

        check_close((double)caustic_lobe_pdf(&lobe, p, d), truth, 1e-3 * truth);
    }
    assert_true(caustic_lobe_pdf(&lobe, v3(0, 0, 0), v3(0, 0, -1)) == 0);
    assert_true(caustic_lobe_pdf(&lobe, v3(0, 0, 3), v3(0, 0, 1)) == 0);
}

/* r^2 / (1 + r^2) of the samples of a lobe are within r of its middle, and as
 * many on each side. */
static void lobes_are_sampled_in_rings(void **state)
{
    struct caustic_lobe lobe = make_lobe(1);
    const struct vec3 p = {.8f, -.4f, .5f};
    uint64_t random = 1;
    const int tries = 20000;
    int within[3] = {0, 0, 0}, sides[2] = {0, 0};
    struct vec3 d;

    (void)state;
    for (int i = 0; i < tries; i++) {
        struct vec2 at =
            v2((float)check_random(&random), (float)check_random(&random));
        double t, u, v;

        assert_true(caustic_lobe_sample(&lobe, p, at, &d));
        t = (double)((2 - p.z) / d.z);
        u = ((double)p.x + t * (double)d.x - (double)p.x / 4) / .1;
        v = ((double)p.y + t * (double)d.y - (double)p.y / 2) / .05;
        for (int k = 0; k < 3; k++)
            within[k] += u * u + v * v < (k + 1) * (k + 1);
        sides[0] += u > 0;
        sides[1] += v > 0;
    }
    for (int k = 0; k < 3; k++) {
        double square = (k + 1) * (k + 1);

        check_close(within[k], tries * square / (1 + square),
                    4 * sqrt(.25 * tries));
    }
    check_close(sides[0], .5 * tries, 4 * sqrt(.25 * tries));
    check_close(sides[1], .5 * tries, 4 * sqrt(.25 * tries));
    assert_false(caustic_lobe_sample(&lobe, v3(0, 0, 2.5f), v2(.5f, .5f), &d));
}

/* Below a pane and a slab the sun is where it would be without them. The
 * density at its middle is hardly less than that of its light. */
static void lobes_aim_at_the_sun(void **state)
{
    (void)state;
    for (int caster = PANE; caster <= SLAB; caster++) {
        struct directional_light sun = sun_at(.5, 2);
        struct path_guide g = {.cells = NULL};
        double density = 1 / (2 * M_PI * (double)sun.size), least = INFINITY;
        struct lit_mesh s;
        const struct world *w = &s.mesh.world;
        uint64_t random = 1;

        make_floor(&s, (enum caster)caster);
        set_sun(&s, &sun);
        lit_mesh_finish(&s);
        build(&s, &g);
        for (int i = 0; i < 500; i++) {
            struct vec3 p = v3((float)(.4 * check_random(&random) - .2), 0,
                               (float)(.4 * check_random(&random) - .2));
            uint32_t leaf = caustic_leaf_at(w, p, v3(0, 1, 0));

            assert_int_not_equal(leaf, NO_INDEX);
            least = fmin(least, (double)(caustic_pdf(w, leaf, p, sun.d) /
                                         caustic_share(w, leaf)));
        }
        check_at_most(.4 * density, least);
        path_guide_free(&g);
        lit_mesh_free(&s);
    }
}

struct sampled {
    double angle2; /* squared distance from the middle of the cone */
    double weight; /* share / density */
};

static int compare_sampled(const void *a, const void *b)
{
    const struct sampled *x = a, *y = b;

    return (x->angle2 > y->angle2) - (x->angle2 < y->angle2);
}

/* The mean of 1 / density over the samples in a cone is its solid angle. The
 * cone is around one sample, and has a third of the others. The median over
 * places is less disturbed by rare samples far from all lobes. */
static void samples_have_their_density(void **state)
{
    enum { SAMPLES = 3000, INSIDE = SAMPLES / 3 };
    struct path_guide g = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;
    const struct world *w = &s.mesh.world;
    struct sampled *all = calloc(SAMPLES, sizeof *all);
    uint64_t random = 1;
    double ratios[MEDIAN_MAX];
    int found = 0;

    (void)state;
    assert_non_null(all);
    make_ball(&s, &sun);
    build(&s, &g);
    for (int i = 0; found < MEDIAN_MAX && i < 100; i++) {
        struct vec3 p = v3((float)(.28 * check_random(&random) - .2), 0,
                           (float)(.26 * check_random(&random) - .13));
        uint32_t leaf = caustic_leaf_at(w, p, v3(0, 1, 0)), count = 0;
        struct vec3 middle = v3(0, 0, 0);
        double sum = 0, solid_angle;

        if (leaf == NO_INDEX)
            continue;
        for (int k = 0; k < SAMPLES; k++) {
            float u = (float)check_random(&random) * caustic_share(w, leaf);
            struct vec2 at = v2(u, (float)check_random(&random));
            struct vec3 d, way;
            double pdf;

            if (!caustic_sample(w, leaf, p, at, &d))
                continue;
            if (count == 0)
                middle = d;
            way = v3_sub(d, middle);
            pdf = (double)caustic_pdf(w, leaf, p, d);
            assert_true(pdf > 0);
            all[count++] =
                (struct sampled){(double)v3_dot(way, way),
                                 (double)caustic_share(w, leaf) / pdf};
        }
        qsort(all, count, sizeof *all, compare_sampled);
        for (int k = 0; k < INSIDE; k++)
            sum += all[k].weight / SAMPLES;
        /* half of the squared chord is 1 - cosine */
        solid_angle = M_PI * (all[INSIDE - 1].angle2 + all[INSIDE].angle2) / 2;
        ratios[found++] = sum / solid_angle;
    }
    assert_int_equal(found, MEDIAN_MAX);
    check_close(median(ratios, found), 1, .08);
    free(all);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* Each lobe gets its part of the samples. */
static void lobes_have_their_probability(void **state)
{
    struct caustic_node nodes[GUIDE_FACINGS];
    struct caustic_lobe lobes[3] = {make_lobe(.2f), make_lobe(.9f),
                                    make_lobe(1)};
    const double parts[3] = {.2, .7, .1};
    int counts[3] = {0, 0, 0};
    struct world w = {.caustic_nodes = nodes, .caustic_lobes = lobes};

    (void)state;
    for (int i = 0; i < GUIDE_FACINGS; i++)
        nodes[i] = (struct caustic_node){.25f, 3};
    w.settings.caustic_node_count = GUIDE_FACINGS;
    lobes[1].axis = v3(1, 0, 0);
    lobes[1].u = v3(0, 0, 10);
    lobes[2].axis = v3(-1, 0, 0);
    lobes[2].u = v3(0, 0, 10);
    for (int i = 0; i < 1000; i++) {
        struct vec2 u = v2(.25f * ((float)i + .5f) / 1000, .3f);
        struct vec3 d = v3(0, 0, 0), middle = v3(0, 0, 0);

        assert_true(caustic_sample(&w, 2, middle, u, &d));
        /* a long way from the middle, few cross to the side of another lobe */
        counts[fabsf(d.x) < .7f ? 0 : d.x > 0 ? 1 : 2]++;
    }
    for (int i = 0; i < 3; i++)
        check_close(counts[i], 1000 * parts[i], 12);
}

/* By glass, lobes exist only for lights that paths can meet, and go with them.
 */
static void lobes_exist_only_with_lamps_of_a_size(void **state)
{
    struct path_guide g = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;

    (void)state;
    make_ball(&s, &sun);
    build(&s, &g);
    assert_true(path_guide_has_tables(&g));
    assert_int_equal(s.mesh.world.settings.caustic_lobe_count,
                     g.lamps.lobe_count);
    sun.size = 0;
    path_guide_outdate_lamps(&g);
    build(&s, &g);
    assert_false(path_guide_has_tables(&g));
    assert_int_equal(s.mesh.world.settings.caustic_node_count, 0);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

static void thread_counts_give_the_same_lobes(void **state)
{
    struct error err;
    struct pool *pool = pool_create(3, &err);
    struct path_guide alone = {.cells = NULL}, together = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;

    (void)state;
    assert_non_null(pool);
    make_ball(&s, &sun);
    build(&s, &alone);
    check_or_say(path_guide_update(&together, &s.mesh.wide_world, &s.lights, 0,
                                   pool, &err),
                 err.text);
    assert_int_equal(alone.lamps.node_count, together.lamps.node_count);
    assert_int_equal(alone.lamps.lobe_count, together.lamps.lobe_count);
    assert_memory_equal(alone.lamps.nodes, together.lamps.nodes,
                        alone.lamps.node_count * sizeof *alone.lamps.nodes);
    assert_memory_equal(alone.lamps.lobes, together.lamps.lobes,
                        alone.lamps.lobe_count * sizeof *alone.lamps.lobes);
    path_guide_free(&alone);
    path_guide_free(&together);
    lit_mesh_free(&s);
    pool_destroy(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns_shine_through_glass),
        cmocka_unit_test(spheres_shine_through_panes),
        cmocka_unit_test(lobes_keep_the_mean),
        cmocka_unit_test(lobes_have_students_density),
        cmocka_unit_test(lobes_are_sampled_in_rings),
        cmocka_unit_test(lobes_have_their_probability),
        cmocka_unit_test(lobes_aim_at_the_sun),
        cmocka_unit_test(samples_have_their_density),
        cmocka_unit_test(lobes_exist_only_with_lamps_of_a_size),
        cmocka_unit_test(thread_counts_give_the_same_lobes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
