// SPDX-License-Identifier: MIT
/* test_truth_points.c - surfaces under point, spot and directional lights
 * against closed forms and quadrature over their spheres and discs */
#include "tests/unit/check.h"
#include "tests/unit/truth.h"

#define ALBEDO 0.5

/* Ways that cannot find a light without a size. */
#define NOT_BY_CHANCE (1 << DIRECT_BSDF)

static const struct receiver receivers[] = {
    {{0, 0, 0}, {0, 1, 0}, false, false},
    {{0.3f, -0.2f, 0.1f}, {0.6f, 0.8f, 0}, false, false},
    {{-0.5f, 0.1f, 0.4f}, {0, 0.28f, -0.96f}, false, false},
};

#define RECEIVERS (sizeof receivers / sizeof *receivers)

static struct point_light point_at(struct vec3 p, float emission)
{
    struct point_light l = {.p = p,
                            .cone_offset = 1,
                            .emission = v3(emission, emission, emission)};

    return l;
}

/* A light of 1 - cosine `size`, toward the unit vector d. */
static struct directional_light direction_at(struct vec3 d, float size,
                                             float emission)
{
    struct directional_light l = {.d = d,
                                  .size = size,
                                  .emission = v3(emission, emission, emission),
                                  .sine = sqrtf(size * (2.0f - size)),
                                  .power = emission};

    return l;
}

static void set_points(struct lit_mesh *s, const struct point_light *l,
                       uint32_t count)
{
    s->mesh.world.point_lights = l;
    s->mesh.world.settings.point_light_count = count;
    s->mesh.world.settings.features |= FEATURE_POINT_LIGHTS;
}

static void set_directions(struct lit_mesh *s,
                           const struct directional_light *l, uint32_t count)
{
    s->mesh.world.directional_lights = l;
    s->mesh.world.settings.directional_light_count = count;
    s->mesh.world.settings.features |= FEATURE_DIRECTIONAL_LIGHTS;
}

static void open_receiver(struct lit_mesh *s, const struct receiver *r)
{
    *s = (struct lit_mesh){.lights = {.lights = NULL}};
    s->mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    add_receiver(&s->mesh, r->p, r->n);
}

static double cosine_to(const struct receiver *r, struct vec3 p)
{
    struct vec3 to = v3_sub(p, r->p);

    return (double)v3_dot(to, r->n) / (double)v3_length(to);
}

static double distance2_to(const struct receiver *r, struct vec3 p)
{
    struct vec3 to = v3_sub(p, r->p);

    return (double)v3_dot(to, to);
}

static void check_delta(struct lit_mesh *s, const struct receiver *r,
                        double irradiance)
{
    check_claim(s, ((struct claim){.eye = eye_over(r->p, r->n),
                                   .at = r->p,
                                   .truth = GREY(ALBEDO / M_PI * irradiance),
                                   .paths = 256,
                                   .without = NOT_BY_CHANCE}));
}

/* E = I cos / d^2. */
static void points_obey_the_inverse_square(void **state)
{
    const struct vec3 places[] = {{0.2f, 1, -0.3f},
                                  {0.4f, 0.3f, 0},
                                  {3, 20, -40}};

    (void)state;
    for (size_t i = 0; i < RECEIVERS; i++)
        for (size_t k = 0; k < 3; k++) {
            const struct receiver *r = &receivers[i];
            struct point_light l = point_at(places[k], 7);
            struct lit_mesh s;
            double cosine = fmax(cosine_to(r, l.p), 0);

            open_receiver(&s, r);
            set_points(&s, &l, 1);
            lit_mesh_finish(&s);
            check_delta(&s, r, 7 * cosine / distance2_to(r, l.p));
            lit_mesh_free(&s);
        }
}

/* Nearer than POINT_NEAR2 the light is as from there: it has a bound. */
static void near_points_are_bounded(void **state)
{
    const struct receiver *r = &receivers[0];
    const float heights[] = {1e-3f, 1.01e-4f, 5e-5f, 2e-6f};

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        struct point_light l = point_at(v3(0, heights[k], 0), 1);
        struct lit_mesh s;
        struct light_sample sample = {.pdf = 0};

        open_receiver(&s, r);
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        lit_mesh_lend(&s, DIRECT_MIS);
        assert_true(light_sample(&s.mesh.world, r, NO_INDEX, v2(0.5f, 0.5f),
                                 v2(0.5f, 0.5f), &sample));
        check_close(sample.radiance.x,
                    1 / fmax(pow((double)heights[k], 2), 1e-8),
                    1e-6 / pow((double)heights[k], 2));
        assert_true(sample.pdf == 1 && sample.is_delta);
        lit_mesh_free(&s);
    }
}

/* The falloff of KHR_lights_punctual, at angles on a circle around a spot. */
static void spots_fall_off_as_in_gltf(void **state)
{
    const double cones[][2] = {{0, 45}, {20, 30}, {29.9, 30}, {0, 90}};
    const double angles[] = {0, 10, 24.9, 29.95, 31, 44, 46, 80};

    (void)state;
    for (size_t i = 0; i < 32; i++) {
        double inner = cos(cones[i / 8][0] * M_PI / 180);
        double outer = cos(cones[i / 8][1] * M_PI / 180);
        double angle = angles[i % 8] * M_PI / 180;
        /* the specification's lightAngleScale and lightAngleOffset */
        double scale = 1 / fmax(0.001, inner - outer);
        double part = fmin(fmax(cos(angle) * scale - outer * scale, 0), 1);
        struct vec3 d = {(float)sin(angle), (float)-cos(angle), 0};
        struct point_light l = point_at(v3(0.1f, 0.5f, 0.2f), 3);
        struct receiver r = {v3_add(l.p, v3_scale(d, 2)), v3_neg(d), false,
                             false};
        struct lit_mesh s;

        l.axis = v3(0, -1, 0);
        l.cone_scale = (float)scale;
        l.cone_offset = (float)(-outer * scale);
        open_receiver(&s, &r);
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        check_claim(&s, ((struct claim){.eye = eye_over(r.p, r.n),
                                        .at = r.p,
                                        .truth = GREY(ALBEDO / M_PI * 3 * part *
                                                      part / 4),
                                        .systematic = 2e-4 * scale,
                                        .paths = 64,
                                        .without = NOT_BY_CHANCE}));
        lit_mesh_free(&s);
    }
}

/* Quadrature of the cosine over a cone around the unit vector d. */
static double cone_irradiance(const struct receiver *r, struct vec3 d,
                              double size)
{
    const int n = 2000;
    struct vec3 t, b;
    double sum = 0;

    frame_around(d, &t, &b);
    for (int i = 0; i < n; i++) {
        double z = 1 - size * (i + 0.5) / n;
        double width = sqrt(1 - z * z);

        for (int k = 0; k < n; k++) {
            double phi = 2 * M_PI * (k + 0.5) / n;
            double cosine = z * (double)v3_dot(d, r->n) +
                            width * (cos(phi) * (double)v3_dot(t, r->n) +
                                     sin(phi) * (double)v3_dot(b, r->n));

            sum += fmax(cosine, 0);
        }
    }
    return sum / n / n * 2 * M_PI * size;
}

/* Spheres above, and cut by, the horizon of a receiver, and around it. Above it
 * the form factor is r^2 cos / d^2. */
static void spheres_have_their_form_factor(void **state)
{
    const float radii[] = {0.3f, 0.6f, 1.5f};
    const struct vec3 middle = {0.2f, 0.7f, 0.3f};

    (void)state;
    for (size_t i = 0; i < 3 * RECEIVERS; i++) {
        const struct receiver *r = &receivers[i / 3];
        struct point_light l = point_at(middle, 4);
        double square = pow((double)radii[i % 3], 2) / distance2_to(r, l.p);
        double cosine = cosine_to(r, l.p);
        struct lit_mesh s;
        double e = M_PI;

        if (square < 1)
            e = cosine > sqrt(square)
                    ? M_PI * square * cosine
                    : cone_irradiance(r, v3_unit(v3_sub(l.p, r->p)),
                                      1 - sqrt(1 - square));
        l.radius = radii[i % 3];
        open_receiver(&s, r);
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        /* the eye is inside of spheres that cover the receiver */
        check_claim(&s, ((struct claim){.eye = eye_over(r->p, r->n),
                                        .at = r->p,
                                        .truth = GREY(ALBEDO / M_PI * 4 * e),
                                        .systematic = 1e-4,
                                        .paths = 8192}));
        lit_mesh_free(&s);
    }
}

/* A camera sees a sphere with its radiance, in front of other light. */
static void spheres_are_seen_and_hide_nothing(void **state)
{
    const struct receiver *r = &receivers[0];
    struct point_light l[2] = {point_at(v3(0, 1, 0), 4),
                               point_at(v3(0, 2, 0), 100)};
    struct lit_mesh s;

    (void)state;
    l[0].radius = 0.25f;
    open_receiver(&s, r);
    s.mesh.world.settings.sky.color = v3(2, 2, 2);
    set_points(&s, l, 2);
    lit_mesh_finish(&s);
    /* through the sphere to the sky, and past it */
    check_claim(&s, ((struct claim){.eye = {0.2f, 1, -5},
                                    .at = {0.2f, 1, 0},
                                    .truth = GREY(6),
                                    .paths = 4}));
    check_claim(&s, ((struct claim){.eye = {0.26f, 1, -5},
                                    .at = {0.26f, 1, 0},
                                    .truth = GREY(2),
                                    .paths = 4}));
    /* the floor has the light of the sphere, of the point behind it, and of the
     * sky */
    check_claim(&s, ((struct claim){.eye = eye_over(r->p, r->n),
                                    .at = r->p,
                                    .truth = GREY(
                                        ALBEDO / M_PI *
                                        (4 * M_PI / 16 + 100.0 / 4 + 2 * M_PI)),
                                    .paths = 8192,
                                    .without = NOT_BY_CHANCE}));
    lit_mesh_free(&s);
}

/* E of a direction, and of discs above and across the horizon. */
static void directions_obey_the_cosine(void **state)
{
    const float sizes[] = {0, 1e-5f, 0.02f, 1};
    const struct vec3 d = {0.36f, 0.8f, 0.48f};

    (void)state;
    for (size_t i = 0; i < 4 * RECEIVERS; i++) {
        const struct receiver *r = &receivers[i / 4];
        float size = sizes[i % 4];
        struct directional_light l = direction_at(d, size, 5);
        double e = size > 0 ? cone_irradiance(r, d, (double)size)
                            : fmax((double)v3_dot(d, r->n), 0);
        struct lit_mesh s;

        open_receiver(&s, r);
        set_directions(&s, &l, 1);
        lit_mesh_finish(&s);
        check_claim(&s, ((struct claim){.eye = eye_over(r->p, r->n),
                                        .at = r->p,
                                        .truth = GREY(ALBEDO / M_PI * 5 * e),
                                        .systematic = 1e-3,
                                        .paths = 8192,
                                        .without =
                                            size < 0.01f ? NOT_BY_CHANCE : 0}));
        lit_mesh_free(&s);
    }
}

/* All kinds together, with a lamp and a sky: irradiances add up, also where the
 * choice has to share samples among them. */
static void all_kinds_add_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < RECEIVERS; i++) {
        const struct receiver *r = &receivers[i];
        struct point_light points[3] = {point_at(v3(0.2f, 0.7f, 0.3f), 2),
                                        point_at(v3(-1, 1, 0), 3),
                                        point_at(v3(0, 0.4f, -1), 4)};
        struct directional_light directions[2] = {
            direction_at(v3(0, 1, 0), 0.02f, 6),
            direction_at(v3(0, 0.6f, -0.8f), 0, 1)};
        double e = M_PI * 0.5 + 6 * cone_irradiance(r, v3(0, 1, 0), 0.02) +
                   fmax((double)v3_dot(directions[1].d, r->n), 0);
        struct lit_mesh s;

        points[0].radius = 0.1f;
        for (int k = 0; k < 3; k++)
            e += (double)points[k].emission.x *
                 fmax(cosine_to(r, points[k].p), 0) /
                 distance2_to(r, points[k].p) * (k == 0 ? M_PI * 0.01 : 1);
        open_receiver(&s, r);
        s.mesh.world.settings.sky.color = v3(0.5f, 0.5f, 0.5f);
        set_points(&s, points, 3);
        set_directions(&s, directions, 2);
        lit_mesh_finish(&s);
        check_claim(&s, ((struct claim){.eye = eye_over(r->p, r->n),
                                        .at = r->p,
                                        .truth = GREY(ALBEDO / M_PI * e),
                                        .systematic = 1e-3,
                                        .paths = 32768,
                                        .without = NOT_BY_CHANCE}));
        lit_mesh_free(&s);
    }
}

/* A screen hides a point behind it. A point in the plane of a screen shines to
 * both sides, and one inside of a box does not leave it. */
static void surfaces_hide_points(void **state)
{
    const float heights[] = {0.4f, 0.5f, 0.6f};

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        const struct receiver *r = &receivers[0];
        struct point_light l =
            point_at(v3(0, k < 3 ? heights[k] : 0.45f, 0), 2);
        double e = k < 2 ? 2 / pow((double)l.p.y, 2) : 0;
        struct lit_mesh s;

        open_receiver(&s, r);
        s.mesh.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0);
        if (k < 3)
            mesh_add_quad(&s.mesh, v3(-1, 0.5f, -1), v3(1, 0.5f, -1),
                          v3(1, 0.5f, 1), v3(-1, 0.5f, 1), 1);
        else
            mesh_add_box(&s.mesh, v3(-0.1f, 0.4f, -0.1f), v3(0.1f, 0.5f, 0.1f),
                         1);
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        check_delta(&s, r, e);
        lit_mesh_free(&s);
    }
}

/* A sphere behind a screen is not seen. */
static void surfaces_hide_spheres(void **state)
{
    struct point_light l = point_at(v3(0, 1, 0), 2);
    struct lit_mesh s;

    (void)state;
    l.radius = 0.3f;
    open_receiver(&s, &receivers[0]);
    s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0);
    mesh_add_quad(&s.mesh, v3(-1, 0.5f, -1), v3(1, 0.5f, -1), v3(1, 0.5f, 1),
                  v3(-1, 0.5f, 1), 0);
    set_points(&s, &l, 1);
    lit_mesh_finish(&s);
    check_claim(
        &s, ((struct claim){.eye = {0, 0.1f, 0}, .at = {0, 1, 0}, .paths = 4}));
    lit_mesh_free(&s);
}

/* In a closed box the walls absorb the power of the light, 4 pi I: the mean of
 * the radiance over the walls is known without that of any place. */
static void boxes_absorb_the_power(void **state)
{
    const double albedo = 0.6, area = 2 * (1.6 * 1 + 1 * 1.2 + 1.6 * 1.2);
    struct point_light l = point_at(v3(0.5f, -0.2f, 0.3f), 3);
    double sum = 0, squares = 0;
    const int n = 60000;

    (void)state;
    for (int radius = 0; radius < 2; radius++) {
        uint64_t seed = 4;
        struct lit_mesh s = {.lights = {.lights = NULL}};

        s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)albedo);
        mesh_add_box(&s.mesh, v3(-0.8f, -0.5f, -0.6f), v3(0.8f, 0.5f, 0.6f), 0);
        l.radius = radius == 0 ? 0 : 0.15f;
        if (radius == 1)
            l.emission = v3_scale(v3(1, 1, 1), (float)(3 / (M_PI * 0.0225)));
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        lit_mesh_lend(&s, DIRECT_MIS);
        sum = squares = 0;
        for (int i = 0; i < n; i++) {
            /* a point of a wall by area, seen from near it */
            double u = check_random(&seed) * area / 2;
            float a = (float)check_random(&seed) - 0.5f;
            float b = (float)check_random(&seed) - 0.5f;
            float side = check_random(&seed) < 0.5 ? -0.5f : 0.5f;
            struct vec3 p = u < 1.6         ? v3(a, b, side)
                            : u < 1.6 + 1.2 ? v3(side, a, b)
                                            : v3(a, side, b);
            struct vec3 wall = v3(p.x * 1.6f, p.y, p.z * 1.2f);
            struct vec3 eye = v3_scale(wall, 0.999f);
            struct ray r = {eye, v3_unit(v3_sub(wall, eye)), FLOAT_MAX, 0, 0};
            double x =
                (double)trace_path(&s.mesh.world, r,
                                   sampler_start(3, 1, (uint64_t)i, 9), NULL)
                    .radiance.x;

            sum += x;
            squares += x * x;
        }
        sum /= n;
        check_close(sum, 4 * M_PI * 3 * albedo / (1 - albedo) / M_PI / area,
                    4.9 * sqrt((squares / n - sum * sum) / n));
        check_at_most(sqrt((squares / n - sum * sum) / n), 0.01 * sum);
        lit_mesh_free(&s);
    }
}

/* Lights that are far away or without numbers leave no sample without an
 * end. */
static void extreme_lights_are_finite(void **state)
{
    const float places[] = {0, 1e-30f, 1e6f, 1e9f};
    const float emissions[] = {0, 1e-30f, 1e30f, FLOAT_MAX};
    const float radii[] = {0, 1e-6f, 1, 1e9f};

    (void)state;
    for (int i = 0; i < 64; i++) {
        const struct receiver *r = &receivers[0];
        struct point_light l =
            point_at(v3(0, places[i % 4], 0), emissions[i / 4 % 4]);
        struct ray ray = {eye_over(r->p, r->n), v3_neg(r->n), FLOAT_MAX, 0, 0};
        struct lit_mesh s;

        l.radius = radii[i / 16];
        open_receiver(&s, r);
        set_points(&s, &l, 1);
        lit_mesh_finish(&s);
        lit_mesh_lend(&s, DIRECT_MIS);
        for (uint64_t k = 0; k < 64; k++) {
            struct vec3 x =
                trace_path(&s.mesh.world, ray, sampler_start(3, 1, k, 1), NULL)
                    .radiance;

            assert_true(x.x >= 0 && x.x <= FLOAT_MAX);
        }
        lit_mesh_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_obey_the_inverse_square),
        cmocka_unit_test(near_points_are_bounded),
        cmocka_unit_test(spots_fall_off_as_in_gltf),
        cmocka_unit_test(spheres_have_their_form_factor),
        cmocka_unit_test(spheres_are_seen_and_hide_nothing),
        cmocka_unit_test(directions_obey_the_cosine),
        cmocka_unit_test(all_kinds_add_up),
        cmocka_unit_test(surfaces_hide_points),
        cmocka_unit_test(surfaces_hide_spheres),
        cmocka_unit_test(boxes_absorb_the_power),
        cmocka_unit_test(extreme_lights_are_finite),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
