// SPDX-License-Identifier: MIT
#include "glim/lights.h"

#include <math.h>
#include <string.h>

#include "glim/footprint.h"
#include "glim/sky.h"
#include "kernels/light.h"
#include "kernels/rng.h"

#include "check.h"
#include "lambert.h"
#include "lamps.h"
#include "mesh.h"
#include "sky_pdf.h"

static double sum_of_probabilities(const struct world *w,
                                   const struct receiver *r)
{
    double sum = 0;

    for (uint32_t i = 0; i < w->settings.light_count; i++)
        sum += (double)light_tree_probability(w, r, i);
    return sum;
}

static void probabilities_add_up(void **state)
{
    const int counts[] = {1, 2, 8, 9, 100, 3000};

    (void)state;
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        uint64_t seed = 11;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k], 0.1, &seed);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, counts[k]);
        for (int i = 0; i < 20; i++) {
            struct receiver r = any_receiver(&seed);

            check_close(sum_of_probabilities(&m.world, &r), 1, 2e-5);
        }
        discard(&m, &lights);
    }
}

/* Chi-square over the lights, those with fewer than 5 expected taken together.
 * Wilson and Hilferty's cube root is normal; 20 are tried. */
static void choices_follow_probabilities(void **state)
{
    const int n = 200000;
    uint64_t seed = 5;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    add_lamps(&m, 100, 0.2, &seed);
    finish(&m, &lights);
    for (int k = 0; k < 20; k++) {
        struct receiver r = any_receiver(&seed);
        int counts[100] = {0};
        double chi = 0, rest = 0, degrees = -1;
        int rest_count = 0;

        for (int i = 0; i < n; i++) {
            uint32_t light;
            float p =
                light_tree_choose(&m.world, &r, any_choice(&seed), &light);

            assert_true(p == light_tree_probability(&m.world, &r, light));
            counts[light]++;
        }
        for (uint32_t i = 0; i < 100; i++) {
            double p = n * (double)light_tree_probability(&m.world, &r, i);

            if (p < 5) {
                rest += p;
                rest_count += counts[i];
                continue;
            }
            chi += pow(counts[i] - p, 2) / p;
            degrees++;
        }
        if (rest >= 5) {
            chi += pow(rest_count - rest, 2) / rest;
            degrees++;
        }
        check_at_most(fabs(cbrt(chi / degrees) - (1 - 2 / (9 * degrees))),
                      Z_LIMIT * sqrt(2 / (9 * degrees)));
    }
    discard(&m, &lights);
}

/* Whether some of the triangle is above the receiver's plane, and it is not
 * seen exactly edge-on. */
static bool contributes(const struct world *w, const struct receiver *r,
                        uint32_t tri)
{
    struct vec3 p[3], ng;
    float most = -1;

    for (int k = 0; k < 3; k++) {
        struct vec3 d;

        p[k] = w->positions[w->tris[tri].v[k]];
        d = v3_unit(v3_sub(p[k], r->p));
        most = f_max(most, v3_dot(d, r->n));
    }
    if (!triangle_normal(p[0], p[1], p[2], &ng))
        return false;
    return (most > 0 || r->transmits) &&
           fabsf(v3_dot(ng, v3_sub(p[0], r->p))) > 0;
}

static void no_contributing_light_is_left_out(void **state)
{
    uint64_t seed = 31;

    (void)state;
    for (int k = 0; k < 300; k++) {
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, 32, k % 3 == 0 ? 0.5 : 0.02, &seed);
        add_quads(&m, 32, k % 3 == 0 ? 0.5 : 0.02, &seed);
        finish(&m, &lights);
        for (int i = 0; i < 50; i++) {
            struct receiver r = any_receiver(&seed);

            for (uint32_t t = 0; t < m.tri_count; t++)
                if (contributes(&m.world, &r, t))
                    assert_true(light_tree_probability(&m.world, &r,
                                                       lights.tri_lights[t]) >
                                0);
        }
        discard(&m, &lights);
    }
}

/* What a child of a node is thought to shine is no less than 1 / 72 of what the
 * lamps below it do, seen from more than two of its radii away: cosines are no
 * less than a quarter of their bounds, the distance to none of the lamps is
 * less than half of that to the middle, and a quarter of the radius squared
 * counts for 1 / 16 of the middle's squared. */
static void clusters_are_not_underrated(void **state)
{
    uint64_t seed = 90;
    struct mesh m = {0};
    struct lights lights;
    double area = 0;
    int checked = 0;

    (void)state;
    add_lamps(&m, 400, 0.1, &seed);
    finish(&m, &lights);
    for (uint32_t t = 0; t < m.tri_count; t++) {
        const struct vec3 *p = &m.positions[3 * t];

        area += (double)v3_length(
                    v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) /
                2;
    }
    for (int k = 0; k < 50; k++) {
        struct receiver r = any_receiver(&seed);
        double(*below)[LIGHT_WIDTH] = calloc(lights.node_count, sizeof *below);

        r.transmits = false;
        assert_non_null(below);
        for (uint32_t l = 0; l < lights.light_count; l++) {
            double e =
                lambert(&m.positions[3 * lights.lights[l].tris[0]], 3, &r);

            for (uint32_t at = 0, level = 0; (at & LIGHT_LEAF) == 0; level++) {
                uint32_t i = lights.lights[l].path[0] >> 3 * level & 7;

                below[at][i] += e / area;
                at = lights.nodes[at].child[i];
            }
        }
        for (uint32_t n = 0; n < lights.node_count; n++) {
            const struct light_node *node = &lights.nodes[n];
            float sums[LIGHT_WIDTH + 1];

            light_sums(&m.world, n, &r, sums);
            for (int i = 0; i < LIGHT_WIDTH; i++) {
                struct vec3 to =
                    v3_sub(v3(node->x[i], node->y[i], node->z[i]), r.p);
                double share = (double)(sums[i + 1] - sums[i]);

                if (v3_length(to) < 2 * node->radius[i] || below[n][i] <= 0)
                    continue;
                check_at_most(below[n][i] / 72, share + 1e-6 * (double)sums[8]);
                checked++;
            }
        }
        free(below);
    }
    assert_true(checked > 5000);
    discard(&m, &lights);
}

/* Lamps of one size and distance: the one that is seen edge-on is left to
 * chance, whichever way round the others are wound. */
static void facing_counts_and_sides_do_not(void **state)
{
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false};
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    mesh_add(&m, v3(-0.5f, 1, 0), v3(-0.49f, 1, 0), v3(-0.5f, 1, 0.01f), LAMP);
    mesh_add(&m, v3(0.5f, 1, 0), v3(0.5f, 1, 0.01f), v3(0.49f, 1, 0), LAMP);
    mesh_add(&m, v3(0.5f, 1, 0), v3(0.49f, 1, 0), v3(0.5f, 1, 0.01f), LAMP);
    mesh_add(&m, v3(-0.5f, 1, 0), v3(-0.505f, 1.01f, 0), v3(-0.5f, 1, 0.01f),
             LAMP);
    finish(&m, &lights);
    for (uint32_t l = 0; l < 3; l++)
        check_close(light_tree_probability(&m.world, &r, l), 1.0 / 3, 0.02);
    check_at_most(light_tree_probability(&m.world, &r, 3), 0.02);
    discard(&m, &lights);
}

/* The second number decides the lower levels of a deep tree: one number alone
 * would run out of digits. */
static void both_numbers_choose(void **state)
{
    uint64_t seed = 70;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    add_lamps(&m, 5000, 0.01, &seed);
    finish(&m, &lights);
    for (int k = 0; k < 20; k++) {
        struct receiver r = any_receiver(&seed);
        uint32_t first, light;
        int others = 0;

        assert_true(light_tree_choose(&m.world, &r, v2(0.3f, 0), &first) > 0);
        for (int i = 1; i < 16; i++) {
            light_tree_choose(&m.world, &r, v2(0.3f, (float)i / 16), &light);
            others += light != first;
        }
        assert_true(others > 0);
    }
    discard(&m, &lights);
}

/* The density of everything that lies along a direction, found by testing all
 * triangles. */
static double density_along(const struct world *w, const struct receiver *r,
                            struct vec3 d)
{
    struct ray ray = {r->p, d, FLOAT_MAX, 0, 0};
    struct shear shear = shear_of(ray);
    double sum = 0;

    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct vec3 p0 = w->positions[w->tris[i].v[0]];
        struct vec3 p1 = w->positions[w->tris[i].v[1]];
        struct vec3 p2 = w->positions[w->tris[i].v[2]];
        struct vec3 error;
        struct hit h;

        if (triangle_hit(ray, shear, p0, p1, p2, FLOAT_MAX, &h))
            sum +=
                (double)light_pdf_at(w, r, i, hit_point(h, p0, p1, p2, &error));
    }
    return sum;
}

/* Over the whole sphere, by midpoints of 1000 x 2000: the rim of a triangle
 * makes errors of its length times the spacing. */
static void density_integrates_to_one(void **state)
{
    const int rows = 1000;
    uint64_t seed = 77;
    struct mesh m = {0};
    struct lights lights;
    struct receiver r;
    double sum = 0;

    (void)state;
    add_lamps(&m, 6, 0.7, &seed);
    add_quads(&m, 6, 0.7, &seed);
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 12);
    r = any_receiver(&seed);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < 2 * rows; j++) {
            double z = 2 * (i + 0.5) / rows - 1;
            double phi = M_PI * (j + 0.5) / rows;
            double s = sqrt(1 - z * z);

            sum += density_along(&m.world, &r,
                                 v3((float)(s * cos(phi)),
                                    (float)(s * sin(phi)), (float)z));
        }
    check_close(sum * 4 * M_PI / (2.0 * rows * rows), 1, 3e-3);
    discard(&m, &lights);
}

static void sample_and_density_agree(void **state)
{
    const int counts[][2] = {{1, 0}, {5, 0}, {500, 0}, {0, 1}, {0, 5}, {9, 9}};
    int found = 0, seconds = 0;

    (void)state;
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        uint64_t seed = 19;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k][0], 0.3, &seed);
        add_quads(&m, counts[k][1], 0.3, &seed);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, counts[k][0] + counts[k][1]);
        for (int i = 0; i < 20000; i++) {
            struct receiver r = any_receiver(&seed);
            struct light_sample s;

            if (!light_sample(&m.world, &r, NO_INDEX, any_choice(&seed),
                              any_choice(&seed), &s))
                continue;
            found++;
            seconds += lights.lights[lights.tri_lights[s.tri]].tris[1] == s.tri;
            assert_true(s.pdf == light_pdf_at(&m.world, &r, s.tri, s.p));
            assert_true(s.pdf > 0 && s.pdf <= FLOAT_MAX);
            check_close(v3_length(s.wi), 1, 1e-6);
            check_close((double)v3_dot(s.wi, v3_unit(v3_sub(s.p, r.p))), 1,
                        1e-6);
            assert_true(s.radiance.x == 1 && s.radiance.z == 3);
        }
        discard(&m, &lights);
    }
    assert_true(found > 118000 && seconds > 20000);
}

/* Of all lamps together, from few to many. */
static void many_lamps_obey_lambert(void **state)
{
    const int counts[] = {1, 7, 60, 1000};

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        uint64_t seed = 1234;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k], 0.4 / sqrt(counts[k]), &seed);
        finish(&m, &lights);
        for (int i = 0; i < 10; i++) {
            struct receiver r = any_receiver(&seed);
            double truth = 0, error, e;

            r.transmits = false;
            for (uint32_t t = 0; t < m.tri_count; t++)
                truth += lambert(&m.positions[3 * t], 3, &r);
            e = irradiance(&m.world, &r, 200000, &seed, &error);
            check_close(e, truth, Z_LIMIT * error + 1e-6 * truth);
        }
        discard(&m, &lights);
    }
}

/* What the tree is for: the spread of single estimates, relative to the truth,
 * on a floor under a ceiling of 2500 lamps, against a choice among all alike.
 */
static void tree_finds_the_near_lights(void **state)
{
    uint64_t seed = 8;
    struct mesh m = {0};
    struct lights lights;
    double spread = 0, plain = 0;

    (void)state;
    for (int i = 0; i < 2500; i++) {
        float x = (float)(i % 50) / 25 - 1, z = (float)(i / 50) / 25 - 1;
        struct vec3 p = v3(x, 0.1f, z);

        mesh_add(&m, p, v3_add(p, v3(0.01f, 0, 0)), v3_add(p, v3(0, 0, 0.01f)),
                 LAMP);
    }
    finish(&m, &lights);
    for (int i = 0; i < 20; i++) {
        struct receiver r = {v3(between(&seed, -1, 1), 0,
                                between(&seed, -1, 1)),
                             v3(0, 1, 0), false};
        double error, truth = 0, squares = 0;

        irradiance(&m.world, &r, 2000, &seed, &error);
        for (uint32_t t = 0; t < m.tri_count; t++) {
            double e = lambert(&m.positions[3 * t], 3, &r);

            truth += e;
            squares += e * e;
        }
        spread += error / truth * sqrt(2000);
        plain += sqrt(2500 * squares / truth / truth - 1);
    }
    check_at_most(spread, plain / 4);
    discard(&m, &lights);
}

/* Solid angle of a triangle (Van Oosterom and Strackee 1983). */
static double solid_angle(const struct vec3 *p, struct vec3 from)
{
    struct vec3 a = v3_unit(v3_sub(p[0], from));
    struct vec3 b = v3_unit(v3_sub(p[1], from));
    struct vec3 c = v3_unit(v3_sub(p[2], from));

    return 2 * atan2(fabs((double)v3_dot(a, v3_cross(b, c))),
                     1 + (double)(v3_dot(a, b) + v3_dot(b, c) + v3_dot(c, a)));
}

/* The mean of 1 / pdf is the solid angle of what is sampled, whatever the
 * shares: of the whole sky, and of a lamp before it. */
static void sky_and_lamps_share(void **state)
{
    const float shares[][2] = {{0.5f, 0.5f}, {0.25f, 0.5f}, {0.125f, 0.25f}};
    const int n = 100000;
    uint64_t seed = 55;
    struct vec3 texels[8] = {{1, 1, 1}, {2, 2, 2}, {1, 1, 1}, {3, 3, 3},
                             {4, 4, 4}, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}};
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false};
    struct sky_table table = {NULL};
    struct error err;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    mesh_add(&m, v3(0, 1, 0), v3(0.5f, 0.9f, 0), v3(0, 0.8f, 0.6f), LAMP);
    finish(&m, &lights);
    m.world.settings.sky = (struct sky){{1, 1, 1}, 4, 2, 0, 1, 0};
    m.world.sky_texels = texels;
    assert_true(sky_build(&table, texels, 4, 2, SKY_ALONE, &err));
    sky_lend(&table, &m.world);
    assert_true(m.world.settings.sky_share == 0.5f &&
                m.world.settings.light_share == 0.5f);
    for (size_t k = 0; k < 3; k++) {
        double sums[2] = {0, 0}, squares[2] = {0, 0};
        const double truths[2] = {4 * M_PI, solid_angle(m.positions, r.p)};

        m.world.settings.sky_share = shares[k][0];
        m.world.settings.light_share = shares[k][1];
        for (int i = 0; i < n; i++) {
            struct vec2 point = any_choice(&seed);
            struct light_sample s;
            int lamp;

            if (!light_sample(&m.world, &r, NO_INDEX, point, any_choice(&seed),
                              &s))
                continue;
            lamp = s.tri != NO_INDEX ? 1 : 0;
            assert_true(s.pdf == (lamp ? light_pdf_at(&m.world, &r, s.tri, s.p)
                                       : sky_light_pdf(&m.world, &r, s.wi)));
            sums[lamp] += 1 / (double)s.pdf;
            squares[lamp] += pow((double)s.pdf, -2);
        }
        for (int i = 0; i < 2; i++) {
            double mean = sums[i] / n;

            check_close(mean, truths[i],
                        Z_LIMIT * sqrt((squares[i] / n - mean * mean) / n) +
                            1e-6);
        }
    }
    sky_free(&table);
    discard(&m, &lights);
}

/* A lamp of area 1/2 and radiance 2 before skies of ever more light. */
static void weak_lamps_are_sampled_less(void **state)
{
    struct mesh m = {0};
    struct lights lights;
    float share = 1;

    (void)state;
    mesh_add(&m, v3(0, 1, 0), v3(1, 1, 0), v3(0, 1, 1), LAMP);
    finish(&m, &lights);
    check_close(lights.glare, 2, 1e-6);
    for (float sky = 0; sky < 20; sky += 0.5f) {
        m.world.settings.sky.color = v3(sky, sky, sky);
        lights_lend(&lights, &m.world);
        assert_true(m.world.settings.light_share <= share &&
                    m.world.settings.light_share > 0);
        share = m.world.settings.light_share;
        /* the lamp's 2 pi against the square of pi times the sky */
        assert_true(sky > 2 || share == 1);
        assert_true(sky < 3 || share < 1);
    }
    check_close(share, 0.1, 1e-7);
    discard(&m, &lights);
}

/* STRESS M8, M9: what no light may bring down. */
static void odd_lights_are_borne(void **state)
{
    const struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, z = {0, 0, 1};
    struct receiver r = {{0.2f, -0.5f, 0.2f}, {0, 1, 0}, false};
    struct light_sample s;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 0);
    assert_false(light_sample(&m.world, &r, NO_INDEX, v2(0, 0), v2(0, 0), &s));
    discard(&m, &lights);

    m = (struct mesh){0};
    mesh_add(&m, o, x, z, 0);                 /* dark */
    mesh_add(&m, o, x, v3(0.5f, 0, 0), LAMP); /* without area */
    mesh_add(&m, o, v3(1e-30f, 0, 0), v3(0, 0, 1e-30f), LAMP); /* nearly so */
    mesh_add(&m, o, x, z, LAMP);
    mesh_add(&m, o, x, z, 2);
    mesh_add(&m, o, x, z, 3);
    for (uint32_t k = 2; k < 4; k++) {
        float e = k == 2 ? 1e38f : 1e-38f;

        m.materials[k] = mesh_material(MATERIAL_DIFFUSE, 0);
        m.materials[k].emission = v3(e, e, e);
    }
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 3);
    assert_int_equal(lights.tri_lights[1], NO_INDEX);
    assert_true(light_pdf_at(&m.world, &r, 1, o) == 0);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-6);
    assert_true(
        light_sample(&m.world, &r, NO_INDEX, v2(0.3f, 0.6f), v2(0, 0), &s));
    /* at the lamp itself, and in its plane: no density that is not a number */
    r.p = s.p;
    for (int i = 0; i < 2; i++) {
        if (light_sample(&m.world, &r, NO_INDEX, v2(0.3f, 0.6f), v2(0, 0), &s))
            assert_true(s.pdf > 0 && s.pdf <= FLOAT_MAX);
        r.p.x += 3;
    }
    discard(&m, &lights);
}

/* STRESS G7 to G9: no shape of the scene makes the way to a light too long. */
static void deep_trees_fit(void **state)
{
    struct receiver r = {{0.3f, 0.2f, 0.1f}, {1, 0, 0}, true};
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    for (int i = 0; i < 60; i++) {
        struct vec3 p = v3(ldexpf(1, -i / 2), 0, 0);
        float side = ldexpf(1, -i / 2 - 2);

        mesh_add(&m, p, v3_add(p, v3(side, 0, 0)), v3_add(p, v3(0, side, 0)),
                 LAMP);
    }
    finish(&m, &lights);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-5);
    discard(&m, &lights);

    m = (struct mesh){0};
    for (int i = 0; i < 20000; i++)
        mesh_add(&m, v3(0, 0, 0), v3(0.1f, 0, 0), v3(0, 0.1f, 0), LAMP);
    finish(&m, &lights);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-3);
    for (uint32_t l = 0; l < lights.light_count; l += 977)
        check_close(light_tree_probability(&m.world, &r, l) * 20000, 1, 0.3);
    discard(&m, &lights);
}

#define TEXTURE_SIDE 128

/* A square lamp with a picture: uvs from 0 to `repeat`. */
static void add_picture(struct mesh *m, struct vec2 uvs[4], uint32_t *texels,
                        struct texture *texture, float linear[256],
                        float repeat)
{
    const uint32_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};

    for (int i = 0; i < 256; i++)
        linear[i] = (float)i / 255;
    *texture = (struct texture){.width = TEXTURE_SIDE,
                                .height = TEXTURE_SIDE,
                                .scale = {1, 1}};
    mesh_add_quad(m, v3(-0.5f, 0.5f, -0.5f), v3(0.5f, 0.5f, -0.5f),
                  v3(0.5f, 0.5f, 0.5f), v3(-0.5f, 0.5f, 0.5f), LAMP);
    for (int k = 0; k < 4; k++)
        uvs[k] = v2(k == 1 || k == 2 ? repeat : 0, k > 1 ? repeat : 0);
    for (int t = 0; t < 2; t++)
        memcpy(m->tris[t].vt, corners[t], sizeof corners[t]);
    m->materials[LAMP] = mesh_material(MATERIAL_DIFFUSE, 0);
    m->materials[LAMP].emission = v3(1, 1, 1);
    m->materials[LAMP].emission_texture = 0;
    m->world.uvs = uvs;
    m->world.textures = texture;
    m->world.texels = texels;
    m->world.linear_of_srgb = linear;
}

/* Irradiance under a square with a picture, by midpoints on the square. */
static double picture_irradiance(const struct world *w,
                                 const struct receiver *r, float repeat)
{
    const int side = 1000;
    double sum = 0;

    for (int i = 0; i < side * side; i++) {
        struct vec2 u = v2(((float)(i % side) + 0.5f) / (float)side,
                           ((float)(i / side) + 0.5f) / (float)side);
        struct vec3 p = v3(u.x - 0.5f, 0.5f, u.y - 0.5f);
        struct vec3 d = v3_sub(p, r->p);
        double square = (double)v3_dot(d, d);
        double cosines = (double)(f_max(v3_dot(d, r->n), 0) * fabsf(d.y));

        sum +=
            (double)texture_at(w, 0, v2(u.x * repeat, u.y * repeat)).color.x *
            cosines / (square * square);
    }
    return sum / (side * side);
}

static void pictures_shine_as_they_look(void **state)
{
    const float repeats[] = {1, 3.5f, 0.2f};

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
        uint64_t seed = 2;
        float linear[256];
        struct texture texture;
        struct vec2 uvs[4];
        struct mesh m = {0};
        struct lights lights;

        for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++)
            texels[i] = check_random(&seed) < 0.1
                            ? 0xff000000u | (uint32_t)(i % 256)
                            : 0xff000000u;
        add_picture(&m, uvs, texels, &texture, linear, repeats[k]);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, 1);
        for (int i = 0; i < 5; i++) {
            struct receiver r = {v3(between(&seed, -1, 1), 0,
                                    between(&seed, -1, 1)),
                                 v3_unit(v3(between(&seed, -1, 1), 1, 0)),
                                 false};
            double error, e;

            e = irradiance(&m.world, &r, 200000, &seed, &error);
            check_close(e, picture_irradiance(&m.world, &r, repeats[k]),
                        Z_LIMIT * error + 1e-4);
        }
        discard(&m, &lights);
    }
}

/* A lamp lets rays pass as other surfaces do: what comes from it is its share
 * of cover, and nothing from holes. */
static void holes_do_not_shine(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false};
    uint64_t seed = 23;
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct lights lights;
    int solid = 0;

    (void)state;
    /* the left half is a hole */
    for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++)
        texels[i] = i % TEXTURE_SIDE < TEXTURE_SIDE / 2 ? 0 : 0xff000000u;
    add_picture(&m, uvs, texels, &texture, linear, 1);
    texture.has_holes = 1;
    m.materials[LAMP].emission_texture = NO_INDEX;
    m.materials[LAMP].color_texture = 0;
    m.materials[LAMP].opacity = 0.25f;
    m.world.settings.features = FEATURE_COVERAGE;
    finish(&m, &lights);
    for (int i = 0; i < 1000; i++) {
        struct light_sample s = {.pdf = 0};
        struct vec2 point = any_choice(&seed);

        assert_true(
            light_sample(&m.world, &r, NO_INDEX, point, any_choice(&seed), &s));
        if (fabsf(s.p.x) > 1e-2f && fabsf(s.p.x) < 0.49f) /* clear of edges */
            assert_true(s.radiance.x == (s.p.x < 0 ? 0 : 0.25f));
        solid += s.radiance.x > 0;
    }
    check_close(solid / 1000.0, 0.5, Z_LIMIT * 0.5 / sqrt(1000) + 0.01);
    discard(&m, &lights);
}

/* Of the two halves of a square only that with light in its picture is a
 * light; it is the one below the diagonal from left bottom to right top. */
static void dark_pictures_are_no_lights(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    memset(texels, 0, sizeof texels);
    add_picture(&m, uvs, texels, &texture, linear, 1);
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 0);
    lights_free(&lights);
    /* row 0 is the top: u = 3/4, v = 1/4 */
    texels[TEXTURE_SIDE * TEXTURE_SIDE * 3 / 4 + TEXTURE_SIDE * 3 / 4] = 1;
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 1);
    assert_int_equal(lights.lights[0].tris[0], 0);
    discard(&m, &lights);
}

/* The footprint's mean against random points of the bilinear look-up: on a
 * smooth picture the rim of 2 texels that may be covered as well counts by its
 * share of the area, times the picture's contrast; .006 is 4.9 standard errors
 * of 2000 points. Never 0 where a single texel shows. */
static void footprints_miss_nothing(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    uint64_t seed = 44;
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct error err;
    int checked = 0;

    (void)state;
    add_picture(&m, uvs, texels, &texture, linear, 1);
    m.world.materials = m.materials;
    for (int k = 0; k < 600; k++) {
        bool is_smooth = k % 4 == 0;
        double size = is_smooth ? 1 : 2.0 / TEXTURE_SIDE;
        int spot = k * 3761 % (TEXTURE_SIDE * TEXTURE_SIDE);
        struct footprint_sums f = {NULL, 0, 0};
        struct vec2 uv[3];
        double truth = 0, rim = 0, area;

        for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++) {
            double x = 2 * M_PI * (i % TEXTURE_SIDE) / TEXTURE_SIDE;
            double y = 2 * M_PI * (i / TEXTURE_SIDE) / TEXTURE_SIDE;

            texels[i] =
                is_smooth ? (uint32_t)(128 + 60 * sin(x) + 60 * sin(y)) : 0;
        }
        if (!is_smooth)
            texels[spot] = 255;
        for (int i = 0; i < 3; i++) {
            /* anywhere, or within 2 texels of the one */
            float u = is_smooth ? 0.2f * (float)(k % 5)
                                : (0.5f + (float)(spot % TEXTURE_SIDE)) /
                                      TEXTURE_SIDE;
            float v = is_smooth ? 0.15f * (float)(k % 7)
                                : 1 - (0.5f + (float)(spot / TEXTURE_SIDE)) /
                                          TEXTURE_SIDE;

            uv[i] = v2(u + between(&seed, -size, size),
                       v + between(&seed, -size, size));
        }
        for (int i = 0; i < 2000; i++) {
            struct vec2 u = any_choice(&seed);
            struct hit h = triangle_point(u);
            struct vec2 at =
                v2(h.b0 * uv[0].x + h.b1 * uv[1].x + h.b2 * uv[2].x,
                   h.b0 * uv[0].y + h.b1 * uv[1].y + h.b2 * uv[2].y);

            truth += (double)texture_at(&m.world, 0, at).color.x / 2000 / 3;
        }
        assert_true(footprint_init(&f, &m.world, &m.materials[LAMP], &err));
        if (truth > 0)
            assert_true(footprint_mean(&f, uv) > 0);
        for (int i = 0; i < 3; i++)
            rim += hypot((double)(uv[(i + 1) % 3].x - uv[i].x),
                         (double)(uv[(i + 1) % 3].y - uv[i].y));
        area = fabs((double)((uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) -
                             (uv[2].x - uv[0].x) * (uv[1].y - uv[0].y)));
        if (is_smooth && area > 0.3) {
            double share = 2 * rim / TEXTURE_SIDE / (area / 2);

            check_close(footprint_mean(&f, uv), truth,
                        share / (1 + share) * 240 / 255 / 3 + 0.006);
            checked++;
        }
        footprint_free(&f);
    }
    assert_true(checked > 20);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_add_up),
        cmocka_unit_test(choices_follow_probabilities),
        cmocka_unit_test(no_contributing_light_is_left_out),
        cmocka_unit_test(clusters_are_not_underrated),
        cmocka_unit_test(facing_counts_and_sides_do_not),
        cmocka_unit_test(both_numbers_choose),
        cmocka_unit_test(density_integrates_to_one),
        cmocka_unit_test(sample_and_density_agree),
        cmocka_unit_test(many_lamps_obey_lambert),
        cmocka_unit_test(tree_finds_the_near_lights),
        cmocka_unit_test(sky_and_lamps_share),
        cmocka_unit_test(weak_lamps_are_sampled_less),
        cmocka_unit_test(odd_lights_are_borne),
        cmocka_unit_test(deep_trees_fit),
        cmocka_unit_test(pictures_shine_as_they_look),
        cmocka_unit_test(holes_do_not_shine),
        cmocka_unit_test(dark_pictures_are_no_lights),
        cmocka_unit_test(footprints_miss_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
