// SPDX-License-Identifier: MIT
/*
 * test_medium.c - media that scatter: densities against quadrature, sampled
 * distances against the law of Beer, and light through media against closed
 * forms
 */
#include "tests/unit/files.h"
#include "tests/unit/lambert.h"
#include "tests/unit/truth.h"

#include "world/camera_media.h"

static double channel(struct vec3 v, int k)
{
    return (double)(k == 0 ? v.x : k == 1 ? v.y : v.z);
}

/* ---- the phase function ---- */

static const float cosines[] = {0,      1e-4f,  0.3f,  0.85f,
                                0.999f, -1e-4f, -0.6f, -0.999f};

#define COSINES (sizeof cosines / sizeof cosines[0])

/* Sampled directions are unit vectors whose cosines have the mean g and the
 * mean square (1 + 2 g^2) / 3 of Henyey and Greenstein. */
static void directions_have_the_moments(void **state)
{
    const int n = 512;

    (void)state;
    for (size_t i = 0; i < COSINES; i++) {
        struct medium m = {.anisotropy = cosines[i]};
        double g = (double)cosines[i], mean = 0, square = 0;
        struct vec3 d = v3_unit(v3(0.3f, -0.8f, 0.5f));
        double sum[3] = {0};

        for (int k = 0; k < n * n; k++) {
            struct vec2 u = {((float)(k % n) + 0.5f) / (float)n,
                             ((float)(k / n) + 0.5f) / (float)n};
            struct vec3 wi = phase_sample(&m, d, u);
            double cosine = (double)v3_dot(d, wi);

            check_close((double)v3_length(wi), 1, 1e-6);
            mean += cosine / (n * n);
            square += cosine * cosine / (n * n);
            for (int x = 0; x < 3; x++)
                sum[x] += channel(wi, x) / (n * n);
        }
        check_close(mean, g, 1e-4);
        check_close(square, (1 + 2 * g * g) / 3, 2e-4);
        for (int x = 0; x < 3; x++)
            check_close(sum[x], g * channel(d, x), 1e-3);
    }
}

/* The density's integral is 1, also in peaks: the substitution x = (1 - c)^.25
 * resolves them. */
static void densities_integrate_to_1(void **state)
{
    const int n = 200000;

    (void)state;
    for (size_t i = 0; i < COSINES; i++) {
        struct medium m = {.anisotropy = cosines[i]};
        double sum = 0, sign = cosines[i] < 0 ? -1 : 1;

        for (int k = 0; k < n; k++) {
            double x = pow(2, 0.25) * (k + 0.5) / n;
            double less = x * x * x * x; /* 1 - |cosine to the peak| */
            double sine = sqrt(less * (2 - less));
            struct vec3 wi = v3((float)sine, 0, (float)(sign * (1 - less)));

            sum += 2 * M_PI * (double)phase_density(&m, v3(0, 0, 1), wi) * 4 *
                   x * x * x * pow(2, 0.25) / n;
        }
        /* the vectors are rounded */
        check_close(sum, 1, fabs((double)cosines[i]) > 0.99 ? 0.02 : 1e-4);
    }
}

/* ---- distances ---- */

/* The means of the weights are the shares of light that pass and that are
 * scattered, in each channel, and no weight is above the sum of all. */
static void collisions_keep_the_light(void **state)
{
    static const struct medium media[] = {
        {{2, 1, 0.5f}, {1.8f, 0.5f, 0.4f}, 0, 0, 0},
        {{16, 4, 1}, {16, 4, 1}, 0, 0, 0},
        {{3, 3, 3}, {0.3f, 3, 0}, 0, 0, 0},
        {{5, 0, 1}, {4, 0, 0}, 0, 0, 0},
        {{1e30f, 1e-30f, 0}, {1e30f, 1e-30f, 0}, 0, 0, 0},
    };
    const struct vec3 betas[] = {{1, 1, 1}, {0.01f, 1, 5}, {0, 0, 1}};
    const int n = 1 << 16;
    struct ray r = {{0, 0, 0}, {0, 0, 1}, FLOAT_MAX, 0, 0};

    (void)state;
    for (size_t i = 0; i < sizeof media / sizeof media[0]; i++) {
        for (int b = 0; b < 3; b++) {
            const struct medium *m = &media[i];
            struct sampler s = sampler_start(3, (uint32_t)i, 0, 7);
            double scattered[3] = {0}, passed[3] = {0};
            const float end = 0.7f;

            for (int k = 0; k < n; k++) {
                struct collision c;

                s.reversed_index = reverse_bits((uint32_t)k);
                c = medium_collide(m, betas[b], r, end, random_2d(s, 0));
                assert_true(c.t >= 0 && c.t <= end);
                for (int x = 0; x < 3; x++) {
                    double weight = channel(c.weight, x) * channel(betas[b], x);
                    double most = channel(betas[b], 0) + channel(betas[b], 1) +
                                  channel(betas[b], 2);

                    assert_true(isfinite(weight));
                    if (c.is_there)
                        check_at_most(weight, most * 1.0001);
                    *(c.is_there ? &scattered[x] : &passed[x]) += weight / n;
                }
            }
            for (int x = 0; x < 3; x++) {
                double beta = channel(betas[b], x);
                double e = channel(m->extinction, x);
                double left = exp(-e * (double)end);
                double albedo = e > 0 ? channel(m->scattering, x) / e : 0;

                check_close(passed[x], beta * left, 0.01 * beta + 1e-9);
                check_close(scattered[x], beta * albedo * (1 - left),
                            0.01 * beta + 1e-9);
            }
        }
    }
}

/* Returns the density of a fog at a height. */
static double density_at(const struct medium *m, double y)
{
    double above = (y - (double)m->base) / (double)m->falloff;

    return above > 0 ? exp(-above) : 1;
}

/* The depth of a fog that thins out is the integral of its density, and
 * distances are the inverse of depths. */
static void fog_thins_out(void **state)
{
    uint64_t seed = 4;
    const int n = 20000;

    (void)state;
    for (int i = 0; i < 300; i++) {
        struct medium m = {.base = (float)check_random(&seed),
                           .falloff = (float)exp(6 * check_random(&seed) - 4)};
        float slope =
            (float)(2 * check_random(&seed) - 1) * (i % 3 == 0 ? 1e-4f : 1);
        struct ray r = {{0, (float)(4 * check_random(&seed) - 2), 0},
                        {sqrtf(1 - slope * slope), slope, 0},
                        FLOAT_MAX,
                        0,
                        0};
        float t = (float)exp(4 * check_random(&seed) - 2), depth;
        double want = 0;

        for (int k = 0; k < n; k++)
            want += (double)t / n *
                    density_at(&m, (double)r.o.y + (double)slope * (double)t *
                                                       (k + 0.5) / n);
        depth = medium_depth(&m, r, t);
        check_close((double)depth, want, 2e-3 * want + 1e-6);
        if (density_at(&m, (double)(r.o.y + slope * t)) > 0.05)
            check_close((double)medium_distance(&m, r, depth), (double)t,
                        0.01 * (double)t);
    }
}

/* Rays into infinity have a depth: the whole of what is above, or no end. */
static void fog_has_an_end_above(void **state)
{
    struct medium m = {.extinction = {2, 0, 1}, .falloff = 0.5f};
    struct ray up = {{0, 1, 0}, {0.6f, 0.8f, 0}, FLOAT_MAX, 0, 0};
    struct ray down = {{0, 1, 0}, {0.6f, -0.8f, 0}, FLOAT_MAX, 0, 0};
    struct vec3 left;

    (void)state;
    check_close((double)medium_depth(&m, up, FLOAT_MAX),
                0.5 * exp(-2) / (double)0.8f, 1e-6);
    assert_true(isinf(medium_distance(&m, up, 1)));
    left = attenuated(v3(1, 1, 1), &m, down, FLOAT_MAX);
    assert_true(left.x == 0 && left.y == 1 && left.z == 0);
}

/* ---- which medium ---- */

static void bodies_are_left_in_any_order(void **state)
{
    struct media s = {0};

    (void)state;
    for (uint32_t i = 0; i < MEDIA_MAX + 3; i++)
        media_enter(&s, i);
    assert_int_equal(s.count, MEDIA_MAX);
    media_leave(&s, 3);
    media_leave(&s, 99); /* of an open mesh */
    assert_int_equal(s.count, MEDIA_MAX - 1);
    assert_int_equal(s.at[2], 2);
    assert_int_equal(s.at[3], 4);
    media_enter(&s, 4);
    media_leave(&s, 4); /* the one that was entered last */
    assert_int_equal(s.at[3], 4);
}

enum { OUTER, INNER, LAMP, FLOOR };

static struct material boundary(struct vec3 scatter, struct vec3 absorb)
{
    struct material m = mesh_material(MATERIAL_GLASS, 1);

    m.ior = 1;
    m.is_boundary = 1;
    m.medium.scattering = scatter;
    m.medium.extinction = v3_add(scatter, absorb);
    return m;
}

static void eyes_know_their_bodies(void **state)
{
    static const struct {
        struct vec3 eye;
        uint32_t count;
    } at[] = {{{0, 0, 0}, 2}, {{0.3f, 0.2f, 0}, 1}, {{2, 1, 0}, 0}};
    struct mesh m = {0};

    (void)state;
    m.materials[OUTER] = boundary(v3(1, 1, 1), v3(0, 0, 0));
    m.materials[INNER] = boundary(v3(1, 1, 1), v3(0, 0, 0));
    mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 20, 30, OUTER);
    mesh_add_box(&m, v3(-.2f, -.2f, -.2f), v3(.2f, .2f, .2f), INNER);
    mesh_finish(&m);
    for (int i = 0; i < 3; i++) {
        struct media s = camera_media(&m.world, at[i].eye);

        assert_int_equal(s.count, at[i].count);
        assert_true(s.count < 1 || s.at[0] == OUTER);
        assert_true(s.count < 2 || s.at[1] == INNER);
    }
    mesh_free(&m);
}

/* ---- pictures ---- */

/* A body that absorbs nothing cannot be seen in an even light, from outside or
 * inside, whatever is in it. */
static void light_is_kept(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct lit_mesh s = {0};
        struct claim c = {.eye = i == 3 ? v3(.1f, 0, .2f) : v3(.2f, .1f, 2),
                          .truth = GREY(1),
                          .paths = 8000};

        s.mesh.materials[OUTER] = boundary(v3(4, 2, 1), v3(0, 0, 0));
        s.mesh.materials[OUTER].medium.anisotropy = i == 1 ? 0.8f : -0.3f;
        s.mesh.materials[INNER] = boundary(v3(1, 9, 3), v3(0, 0, 0));
        s.mesh.world.settings.sky.color = v3(1, 1, 1);
        s.mesh.world.settings.has_boundaries = 1;
        mesh_add_sphere(&s.mesh, v3(0, 0, 0), 0.5f, 20, 30, OUTER);
        if (i >= 2)
            mesh_add_box(&s.mesh, v3(-.2f, -.2f, -.2f), v3(.2f, .2f, .2f),
                         INNER);
        lit_mesh_finish(&s);
        s.mesh.world.settings.camera_media = camera_media(&s.mesh.world, c.eye);
        check_claim(&s, c);
        lit_mesh_free(&s);
    }
}

/* The inner body replaces the outer one, on the way of the eye and on that of
 * light samples: a lamp behind both lights a floor. */
static void nested_bodies_absorb_their_part(void **state)
{
    const float albedo = 0.6f, size = 0.3f, height = 0.9f;
    struct claim c = {.eye = {0, 0.2f, 0}, .paths = 4096};
    struct vec3 outer = {0.3f, 1, 2}, inner = {2, 0.5f, 0};
    struct lit_mesh s = {0};
    const int n = 200;

    (void)state;
    s.mesh.materials[OUTER] = boundary(v3(0, 0, 0), outer);
    s.mesh.materials[INNER] = boundary(v3(0, 0, 0), inner);
    s.mesh.materials[LAMP] = lamp_material(2);
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, albedo);
    s.mesh.world.settings.has_boundaries = 1;
    s.mesh.world.settings.max_vertices = 2;
    mesh_add_quad(&s.mesh, v3(-.01f, 0, -.01f), v3(-.01f, 0, .01f),
                  v3(.01f, 0, .01f), v3(.01f, 0, -.01f), FLOOR);
    mesh_add_box(&s.mesh, v3(-3, .3f, -3), v3(3, .8f, 3), OUTER);
    mesh_add_box(&s.mesh, v3(-2, .5f, -2), v3(2, .6f, 2), INNER);
    mesh_add_quad(&s.mesh, v3(-size, height, -size), v3(size, height, -size),
                  v3(size, height, size), v3(-size, height, size), LAMP);
    lit_mesh_finish(&s);
    for (int i = 0; i < n * n; i++) {
        double x = (double)size * (2 * (i % n + 0.5) / n - 1);
        double z = (double)size * (2 * (i / n + 0.5) / n - 1);
        double h = (double)height, d2 = x * x + z * z + h * h;
        double form = h * h / (d2 * d2) * (double)(4 * size * size) / n / n;
        double way = sqrt(d2) / h; /* over height */

        for (int k = 0; k < 3; k++)
            c.truth[k] +=
                2 * form * (double)albedo / M_PI *
                exp(-way * (0.4 * channel(outer, k) + 0.1 * channel(inner, k)));
    }
    check_claim(&s, c);
    lit_mesh_free(&s);
}

/* A square lamp across the y axis. */
struct square {
    float y, z, size; /* half of its side */
};

/* Adds to c->truth what fog scatters once on the eye's way, from z = 1 along -z
 * to z = 1 - far, of light of a lamp whose radiance is 3: quadrature over the
 * way and the lamp. The fog's density on the way is ground, and it falls by the
 * height. */
static void add_scattered(struct claim *c, const struct medium *m,
                          struct square lamp, double far)
{
    const int steps = 600, n = 30;
    double side = 2 * (double)lamp.size, y = (double)lamp.y;
    double falloff = (double)m->falloff;
    double ground = falloff > 0 ? exp((double)m->base / falloff) : 1;
    double mean =
        falloff > 0 ? ground * falloff * (1 - exp(-y / falloff)) / y : 1;

    for (int i = 0; i < steps * n * n; i++) {
        double t = far * (i % steps + 0.5) / steps;
        double x = side * ((i / steps % n + 0.5) / n - 0.5);
        double z = side * ((i / steps / n + 0.5) / n - 0.5) + (double)lamp.z;
        double along = z - (1 - t);
        double d2 = x * x + y * y + along * along, d = sqrt(d2);
        double cosine = -along / d;
        double g = (double)m->anisotropy, rest = 1 + g * g - 2 * g * cosine;
        double phase = (1 - g * g) / (4 * M_PI * rest * sqrt(rest));

        for (int k = 0; k < 3; k++)
            c->truth[k] +=
                3 * phase * channel(m->scattering, k) * ground * fabs(y) / d /
                d2 * exp(-channel(m->extinction, k) * (ground * t + mean * d)) *
                side * side * far / steps / n / n;
    }
}

/* Checks the light that fog scatters once on the way of the eye, from lamps
 * that it does not see: all techniques agree with quadrature. Few paths come to
 * small lamps by chance. */
static void check_scattered(struct medium fog, const struct square *lamps,
                            int count, int paths)
{
    const float far = 2;
    struct claim c = {.eye = {0, 0, 1}, .paths = paths, .systematic = 1e-3};
    struct lit_mesh s = {0};

    s.mesh.materials[LAMP] = lamp_material(3);
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, 0);
    if (lamps[0].size < 0.5f)
        c.without = 1 << DIRECT_BSDF;
    s.mesh.world.settings.fog = fog;
    s.mesh.world.settings.max_vertices = 2;
    for (int i = 0; i < count; i++) {
        float a = lamps[i].size, y = lamps[i].y, z = lamps[i].z;

        mesh_add_quad(&s.mesh, v3(-a, y, z - a), v3(a, y, z - a),
                      v3(a, y, z + a), v3(-a, y, z + a), LAMP);
        add_scattered(&c, &fog, lamps[i], (double)far);
    }
    mesh_add_quad(&s.mesh, v3(-2, -2, 1 - far), v3(2, -2, 1 - far),
                  v3(2, 2, 1 - far), v3(-2, 2, 1 - far), FLOOR);
    lit_mesh_finish(&s);
    check_claim(&s, c);
    lit_mesh_free(&s);
}

#define E             \
    {                 \
        0.5f, 1, 0.2f \
    }
#define S_S              \
    {                    \
        0.4f, 0.5f, 0.2f \
    }

/* One lamp is wide. */
static void fog_scatters_light_of_a_lamp(void **state)
{
    const struct square lamp = {1, 0, 1};

    (void)state;
    check_scattered((struct medium){E, S_S, 0.6f, 0, 0}, &lamp, 1, 8192);
}

/* The way passes two lamps, and light is sampled along it, also where the fog
 * thins out. Scattered rays find the last one, which is wide for its distance.
 */
static void fog_scatters_light_of_lamps_that_the_ray_passes(void **state)
{
    const struct square lamps[] = {{0.07f, 0.3f, 0.06f}, {0.05f, -0.4f, 0.03f}};
    const struct square wide = {0.02f, -0.2f, 0.06f};

    (void)state;
    check_scattered((struct medium){E, S_S, 0.6f, 0, 0}, lamps, 2, 16384);
    check_scattered((struct medium){E, S_S, -0.3f, -0.5f, 0.7f}, lamps, 2,
                    16384);
    check_scattered((struct medium){E, S_S, 0.6f, 0, 0}, lamps, 1, 16384);
    check_scattered((struct medium){E, S_S, 0, 0, 0}, &wide, 1, 16384);
}

/* Distances along a segment have their density: its integral up to the sample
 * of u is u. */
static void distances_to_a_light_have_their_density(void **state)
{
    static const struct vec3 lights[] = {
        {0, 0.3f, 0.5f}, {0.01f, 0, 0.2f}, {0, 2, -3}, {1, 1, 9}, {0, 0, 0.5f}};
    static const float ends[] = {1, 1, 2, 0.5f, 1e6f};
    const int n = 400000;

    (void)state;
    for (int i = 0; i < 4; i++) {
        struct segment s = {.o = {0, 0, 0},
                            .d = {0, 0, 1},
                            .end = ends[i],
                            .is_there = true};

        for (float u = 0; u < 1; u += 0.19f) {
            double end = (double)segment_sample(&s, lights[i], u), sum = 0;

            for (int k = 0; k < n; k++)
                sum += (double)segment_density(&s, lights[i],
                                               (float)(end * (k + 0.5) / n)) *
                       end / n;
            check_close(sum, (double)u, 1e-4);
        }
        assert_true(segment_density(&s, lights[i], 1.01f * s.end) == 0.0f);
    }
    /* rays into infinity, and lights on their line */
    for (int i = 0; i < 5; i++) {
        struct segment s = {.d = {0, 0, 1}, .end = SEGMENT_END_MAX};

        for (float u = 0; u < 1; u += 0.19f) {
            float t = segment_sample(&s, lights[i], u);

            assert_true(t >= 0 && t <= s.end);
            assert_true(isfinite(segment_density(&s, lights[i], t)));
        }
    }
}

/* Features of a wall behind fog have no noise, whether the path is scattered or
 * not: the wall's as far as it is seen, and the fog's. */
static void features_fade_behind_fog(void **state)
{
    const struct medium fog = {E, S_S, 0.6f, 0, 0};
    struct ray r = {{0, 0, 0}, {0.6f, 0, 0.8f}, FLOAT_MAX, 0, 0};
    const double t = 1.25, wall = 0.7;
    double seen[3], mean = 0, z;
    struct mesh m = {0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)wall);
    m.world.settings.fog = fog;
    mesh_add_quad(&m, v3(-9, -9, 1), v3(-9, 9, 1), v3(9, 9, 1), v3(9, -9, 1),
                  0);
    mesh_finish(&m);
    m.world.settings.features |= FEATURE_FILTER;
    for (int k = 0; k < 3; k++) {
        seen[k] = exp(-channel(fog.extinction, k) * t);
        mean += seen[k] / 3;
    }
    z = -mean - (1 - mean) * 0.8;
    for (uint32_t i = 0; i < 200; i++) {
        struct first_surface s;

        trace_path(&m.world, r, sampler_start(1, 1, i, 5), &s);
        for (int k = 0; k < 3; k++)
            check_close(channel(s.albedo, k),
                        seen[k] * wall + (1 - seen[k]) *
                                             channel(fog.scattering, k) /
                                             channel(fog.extinction, k),
                        1e-5);
        check_close((double)s.normal.x, -(1 - mean) * 0.6, 1e-5);
        check_close((double)s.normal.z, z, 1e-5);
        check_close((double)s.depth, t, 1e-5);
    }
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_have_the_moments),
        cmocka_unit_test(densities_integrate_to_1),
        cmocka_unit_test(collisions_keep_the_light),
        cmocka_unit_test(fog_thins_out),
        cmocka_unit_test(fog_has_an_end_above),
        cmocka_unit_test(bodies_are_left_in_any_order),
        cmocka_unit_test(eyes_know_their_bodies),
        cmocka_unit_test(light_is_kept),
        cmocka_unit_test(nested_bodies_absorb_their_part),
        cmocka_unit_test(fog_scatters_light_of_a_lamp),
        cmocka_unit_test(fog_scatters_light_of_lamps_that_the_ray_passes),
        cmocka_unit_test(distances_to_a_light_have_their_density),
        cmocka_unit_test(features_fade_behind_fog),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
