// SPDX-License-Identifier: MIT
/*
 * test_smoke_light.c - radiance through, of and from smokes against closed
 * forms, quadrature, and the same media without grids
 */
#include "tests/unit/smoke_world.h"
#include "tests/unit/truth.h"

enum { WALL, BODY, BLACK };

static double channel(struct vec3 v, int k)
{
    return (double)(k == 0 ? v.x : k == 1 ? v.y : v.z);
}

/* A lit mesh, and smokes in it. */
struct scenery {
    struct lit_mesh lit;
    struct smoke_world parts;
};

static void open_scenery(struct scenery *s)
{
    *s = (struct scenery){.lit.mesh.tri_count = 0};
    smoke_world_init(&s->parts);
    s->lit.mesh.materials[BLACK] = mesh_material(MATERIAL_DIFFUSE, 0);
    /* a mesh has a face: this one is out of sight, and casts no shadow */
    mesh_add(&s->lit.mesh, v3(90, 90, 90), v3(90, 91, 90), v3(91, 90, 90),
             BLACK);
}

static void finish_scenery(struct scenery *s)
{
    lit_mesh_finish(&s->lit);
    smoke_world_lend(&s->parts, &s->lit.mesh.world);
}

static void close_scenery(struct scenery *s)
{
    lit_mesh_free(&s->lit);
    smoke_world_free(&s->parts);
}

/* Adds a grid of random numbers, some bricks of which are empty. */
static void add_random(struct scenery *s, const char *name, uint64_t seed)
{
    static const uint32_t size[3] = {20, 11, 17};
    float numbers[17][11][20];
    struct voxel_grid grid;

    for (int z = 0; z < 17; z++)
        for (int y = 0; y < 11; y++)
            for (int x = 0; x < 20; x++)
                numbers[z][y][x] = (x / 8 + y / 8 + z / 8) % 3 == 1
                                       ? 0
                                       : (float)(2 * check_random(&seed));
    grid = grid_of(size, &numbers[0][0][0]);
    smoke_world_add(&s->parts, name, &grid);
}

static void set_medium(struct smoke_numbers *n, struct vec3 scatter,
                       struct vec3 absorb, double anisotropy)
{
    set3(n->scatter, channel(scatter, 0), channel(scatter, 1),
         channel(scatter, 2));
    set3(n->absorb, channel(absorb, 0), channel(absorb, 1), channel(absorb, 2));
    n->anisotropy = anisotropy;
}

/* ---- truth ---- */

/* Returns the range of distances at which a ray is in the cube of this half
 * side around 0 0 0. */
static bool cube_range(const double o[3], const double d[3], double half,
                       double range[2])
{
    range[0] = 0;
    range[1] = 1e30;
    for (int a = 0; a < 3; a++) {
        double x = (-half - o[a]) / d[a], y = (half - o[a]) / d[a];

        range[0] = fmax(range[0], fmin(x, y));
        range[1] = fmin(range[1], fmax(x, y));
    }
    return range[0] < range[1];
}

/* Sets the way of a claim's ray, and returns its part in the cube. */
static void claim_range(const struct claim *c, double half, double o[3],
                        double d[3], double range[2])
{
    struct vec3 way = v3_unit(v3_sub(c->at, c->eye));

    for (int k = 0; k < 3; k++) {
        o[k] = channel(c->eye, k);
        d[k] = channel(way, k);
    }
    assert_true(cube_range(o, d, half, range));
}

static double phase(double g, double cosine)
{
    double rest = 1 + g * g - 2 * g * cosine;

    return (1 - g * g) / (4 * M_PI * rest * sqrt(rest));
}

/* ---- furnaces ---- */

/* Smokes that absorb nothing cannot be seen in an even light, whatever their
 * density and color. Fog has walls of this light, and does not reach far. */
static void light_is_kept(void **state)
{
    static const struct {
        struct vec3 a, b, fog;
        struct vec3 eye;
        uint32_t has_boundaries;
    } cases[] = {
        {{8, 2, 1}, {0, 0, 0}, {0, 0, 0}, {.2f, .1f, 2}, 0},
        {{9, 0, 4}, {0, 0, 0}, {0, 0, 0}, {.2f, .1f, 2}, 0},
        {{3, 2, 1}, {1, 3, 4}, {.5f, 1, .2f}, {.2f, .1f, 2}, 0},
        {{3, 0, 1}, {0, 3, 0}, {0, 0, 1}, {.1f, .2f, 0}, 1},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct claim c = {.eye = cases[i].eye, .truth = GREY(1), .paths = 3000};
        struct scenery s;

        if (!v3_is_zero(cases[i].fog)) /* walls are near the fog */
            c.without = 1 << DIRECT_LIGHTS;
        open_scenery(&s);
        add_random(&s, "a", 1);
        add_random(&s, "b", 2);
        set_medium(smoke_world_fill(&s.parts, "a", "", -.5, .5), cases[i].a,
                   v3(0, 0, 0), .6);
        set_medium(smoke_world_fill(&s.parts, "b", "", -.2, .7), cases[i].b,
                   v3(0, 0, 0), -.3);
        s.lit.mesh.materials[WALL] = lamp_material(1);
        if (v3_is_zero(cases[i].fog))
            s.lit.mesh.world.settings.sky.color = v3(1, 1, 1);
        else
            mesh_add_box(&s.lit.mesh, v3(-3, -1, -3), v3(3, 3, 3), WALL);
        s.lit.mesh.world.settings.fog =
            (struct medium){cases[i].fog, cases[i].fog, .2f, 0, .3f};
        s.lit.mesh.world.settings.has_boundaries = cases[i].has_boundaries;
        finish_scenery(&s);
        check_claim(&s.lit, c);
        close_scenery(&s);
    }
}

/* Smokes as hot as the sky around them cannot be seen, whatever they absorb and
 * scatter: all are in equilibrium. */
static void equilibrium_is_kept(void **state)
{
    static const struct {
        struct vec3 scatter, absorb;
    } cases[] = {
        {{0, 0, 0}, {1, 3, 6}},
        {{4, 2, 0}, {1, 3, 5}},
        {{2, 6, 1}, {2, 0, .1f}},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct claim c = {.eye = i == 1 ? v3(.1f, .2f, .1f) : v3(.2f, .1f, 2),
                          .paths = 800};
        struct scenery s;

        open_scenery(&s);
        add_random(&s, "a", 3);
        add_random(&s, "b", 4);
        smoke_world_add_even(&s.parts, "hot", 20, 4000);
        set_medium(smoke_world_fill(&s.parts, "a", "hot", -.5, .5),
                   cases[i].scatter, cases[i].absorb, .5);
        set_medium(smoke_world_fill(&s.parts, "b", "hot", -.2, .7),
                   cases[i].absorb, cases[(i + 1) % 3].absorb, 0);
        finish_scenery(&s);
        for (int k = 0; k < 3; k++) {
            c.truth[k] = channel(s.parts.host.glows[GLOW_ENTRIES - 1], k);
            assert_true(c.truth[k] > .1);
        }
        s.lit.mesh.world.settings.sky.color =
            s.parts.host.glows[GLOW_ENTRIES - 1];
        c.systematic = 1e-4;
        check_claim(&s.lit, c);
        close_scenery(&s);
    }
}

/* ---- absorption and emission ---- */

/* Returns the integral of a smoke's density along a ray. */
static double depth_of(const struct scenery *s, uint32_t smoke,
                       const struct claim *c)
{
    const struct world *w = &s->lit.mesh.world;
    const struct voxel_field *f = &w->smokes[smoke].density;
    struct vec3 d = v3_unit(v3_sub(c->at, c->eye));
    const int n = 20000;
    double sum = 0;

    for (int i = 0; i < n; i++) {
        struct vec3 p = v3_add(c->eye, v3_scale(d, 4 * ((float)i + .5f) / n));

        if (field_has(f, p))
            sum += 4. / n * (double)field_value(w, f, field_point(f, p));
    }
    return sum;
}

/* Shares that pass two smokes and a fog are multiplied. */
static void smokes_absorb_their_part(void **state)
{
    static const struct vec3 a = {.8f, 2, 0}, b = {1, .1f, .4f};
    static const struct vec3 fog = {.1f, .2f, .3f};
    struct claim c = {.eye = {.3f, .2f, 2},
                      .at = {.1f, .05f, 0},
                      .paths = 2000};
    struct scenery s;

    (void)state;
    open_scenery(&s);
    add_random(&s, "a", 5);
    add_random(&s, "b", 6);
    set_medium(smoke_world_fill(&s.parts, "a", "", -.5, .5), v3(0, 0, 0), a, 0);
    set_medium(smoke_world_fill(&s.parts, "b", "", -.2, .7), v3(0, 0, 0), b, 0);
    s.lit.mesh.world.settings.fog.extinction = fog;
    mesh_add_quad(&s.lit.mesh, v3(-4, -4, -2), v3(4, -4, -2), v3(4, 4, -2),
                  v3(-4, 4, -2), WALL);
    s.lit.mesh.materials[WALL] = lamp_material(2);
    finish_scenery(&s);
    for (int k = 0; k < 3; k++) {
        double way = 4 / fabs(channel(v3_unit(v3_sub(c.at, c.eye)), 2));

        c.truth[k] = 2 * exp(-channel(a, k) * depth_of(&s, 0, &c) -
                             channel(b, k) * depth_of(&s, 1, &c) -
                             channel(fog, k) * way);
    }
    c.systematic = 1e-4; /* of the quadrature */
    check_claim(&s.lit, c);
    close_scenery(&s);
}

/* An even cube of one temperature emits (1 - exp(-absorb d)) of a black body.
 * Fog before and in it takes its share, whether it absorbs or scatters. */
static void hot_cubes_glow(void **state)
{
    static const struct vec3 absorb = {3, .7f, 1.5f};
    static const struct medium fogs[] = {
        {{0, 0, 0}, {0, 0, 0}, 0, 0, 0},
        {{.2f, .1f, .4f}, {0, 0, 0}, 0, 0, 0},
        {{.2f, .1f, .4f}, {.1f, .1f, .2f}, 0, 0, 0},
    };

    (void)state;
    for (int i = 0; i < 3; i++) {
        struct claim c = {.eye = {.3f, .2f, 2}, .at = {0, 0, 0}, .paths = 2000};
        double o[3], d[3], range[2];
        struct scenery s;

        open_scenery(&s);
        smoke_world_add_even(&s.parts, "d", 9, 2);
        smoke_world_add_even(&s.parts, "hot", 9, 3000);
        set_medium(smoke_world_fill(&s.parts, "d", "hot", -.5, .5), v3(0, 0, 0),
                   v3_scale(absorb, .5f), 0);
        s.parts.smokes.items[0].numbers.glow = 7;
        s.lit.mesh.world.settings.fog = fogs[i];
        s.lit.mesh.world.settings.max_vertices = 1;
        finish_scenery(&s);
        claim_range(&c, .5, o, d, range);
        for (int k = 0; k < 3; k++) {
            double a = channel(absorb, k), f = channel(fogs[i].extinction, k);
            double glow = channel(s.parts.host.glows[GLOW_ENTRIES - 1], k);

            c.truth[k] = glow * a / (a + f) * exp(-f * range[0]) *
                         (1 - exp(-(a + f) * (range[1] - range[0])));
        }
        c.systematic = 1e-4;
        check_claim(&s.lit, c);
        close_scenery(&s);
    }
}

/* ---- scattering ---- */

#define HALF 0.5

static const struct vec3 cube_scatter = {.9f, 2, .3f};
static const struct vec3 cube_absorb = {.1f, 0, 1};
static const double cube_cosine = .6;

static void add_cube(struct scenery *s)
{
    smoke_world_add_even(&s->parts, "d", 17, .5f);
    set_medium(smoke_world_fill(&s->parts, "d", "", -HALF, HALF),
               v3_scale(cube_scatter, 2), v3_scale(cube_absorb, 2),
               cube_cosine);
}

static const struct vec3 lamp_at = {.4f, 1.5f, .3f};

/* Light that an even cube scatters once, from a point in a fog that absorbs, or
 * from one direction, by quadrature along the eye's ray. */
static void cubes_scatter_light_of_lamps(void **state)
{
    const struct point_light point = {.p = lamp_at,
                                      .cone_offset = 1,
                                      .emission = {5, 5, 5}};
    struct directional_light sun = {.d = v3_unit(lamp_at),
                                    .emission = {5, 5, 5},
                                    .power = 5};
    const struct vec3 fog = {.1f, .2f, .05f};
    const int n = 4000;

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct claim c = {.eye = {.3f, .2f, 2},
                          .at = {.05f, .1f, 0},
                          .paths = 1500,
                          .without = 1 << DIRECT_BSDF};
        double o[3], d[3], range[2];
        struct scenery s;

        open_scenery(&s);
        add_cube(&s);
        s.lit.mesh.world.settings.max_vertices = 2;
        if (i == 0) {
            s.lit.mesh.world.point_lights = &point;
            s.lit.mesh.world.settings.point_light_count = 1;
            s.lit.mesh.world.settings.fog.extinction = fog;
        } else {
            s.lit.mesh.world.directional_lights = &sun;
            s.lit.mesh.world.settings.directional_light_count = 1;
        }
        finish_scenery(&s);
        claim_range(&c, HALF, o, d, range);
        for (int j = 0; j < n; j++) {
            double way = (range[1] - range[0]) * (j + .5) / n, p[3], to[3];
            double square = 0, cosine = 0, inside[2];

            for (int a = 0; a < 3; a++) {
                p[a] = o[a] + d[a] * (range[0] + way);
                to[a] = i == 0 ? channel(lamp_at, a) - p[a] : channel(sun.d, a);
                square += to[a] * to[a];
            }
            for (int a = 0; a < 3; a++) {
                to[a] /= sqrt(square);
                cosine += to[a] * d[a];
            }
            assert_true(cube_range(p, to, HALF, inside));
            for (int k = 0; k < 3; k++)
                c.truth[k] +=
                    5 / (i == 0 ? square : 1) * phase(cube_cosine, cosine) *
                    channel(cube_scatter, k) * (range[1] - range[0]) / n *
                    exp(-(channel(cube_scatter, k) + channel(cube_absorb, k)) *
                            (way + inside[1]) -
                        (i == 0 ? channel(fog, k) : 0) *
                            (range[0] + way + sqrt(square)));
        }
        c.systematic = 1e-4;
        check_claim(&s.lit, c);
        close_scenery(&s);
    }
}

/* Makes the estimate of other means the truth of a claim. */
static void take_estimate(struct claim *c, struct estimate e)
{
    c->systematic = 0;
    for (int k = 0; k < 3; k++) {
        c->truth[k] = e.mean[k];
        c->systematic = fmax(c->systematic, T_LIMIT * e.error[k] / e.mean[k]);
    }
}

/* An even cube of smoke is a body of the same medium without a surface, under
 * lamps of all kinds and after many collisions. */
static void cubes_are_like_bodies(void **state)
{
    static const struct point_light lamps[] = {
        {.p = {.4f, 1.6f, .3f},
         .radius = .3f,
         .cone_offset = 1,
         .emission = {9, 9, 9}},
        {.p = {0, 0, -1.6f},
         .radius = .2f,
         .cone_offset = 1,
         .emission = {4, 4, 4}},
    };
    static const struct directional_light disc = {.d = {0, 1, 0},
                                                  .size = .1f,
                                                  .emission = {3, 3, 3},
                                                  .sine = .4358899f,
                                                  .power = 1.8f};
    struct claim c = {.eye = {.3f, .2f, 2},
                      .at = {.05f, .1f, 0},
                      .paths = 3000};

    (void)state;
    for (int is_body = 1; is_body >= 0; is_body--) {
        struct scenery s;
        struct world *w = &s.lit.mesh.world;

        open_scenery(&s);
        s.lit.mesh.materials[WALL] = mesh_material(MATERIAL_DIFFUSE, .7f);
        mesh_add_quad(&s.lit.mesh, v3(-2, -.6f, -2), v3(-2, -.6f, 2),
                      v3(2, -.6f, 2), v3(2, -.6f, -2), WALL);
        s.lit.mesh.materials[BODY] = mesh_material(MATERIAL_GLASS, 1);
        s.lit.mesh.materials[BODY].ior = 1;
        s.lit.mesh.materials[BODY].is_boundary = 1;
        s.lit.mesh.materials[BODY].medium =
            (struct medium){v3_add(cube_scatter, cube_absorb), cube_scatter,
                            (float)cube_cosine, 0, 0};
        w->point_lights = lamps;
        w->settings.point_light_count = w->settings.sphere_count = 2;
        w->directional_lights = &disc;
        w->settings.directional_light_count = 1;
        w->settings.sky.color = v3(.1f, .2f, .3f);
        w->settings.has_boundaries = (uint32_t)is_body;
        if (is_body)
            mesh_add_box(&s.lit.mesh, v3(-.5f, -.5f, -.5f), v3(.5f, .5f, .5f),
                         BODY);
        else
            add_cube(&s);
        finish_scenery(&s);
        if (is_body) {
            lit_mesh_lend(&s.lit, DIRECT_MIS);
            take_estimate(&c, claim_estimate(w, &c));
        } else {
            check_claim(&s.lit, c);
        }
        close_scenery(&s);
    }
}

/* ---- bodies ---- */

/* A body without a surface takes the place of smoke, for the eye and for light
 * samples: only the lowest three tenths of the cube are left. */
static void bodies_have_no_smoke(void **state)
{
    const struct point_light point = {.p = {0, 1.5f, 0},
                                      .cone_offset = 1,
                                      .emission = {5, 5, 5}};

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct claim c = {.eye = eye_over(v3(0, -1, 0), v3(0, 1, 0)),
                          .at = {0, -1, 0},
                          .paths = 400,
                          .without = 1 << DIRECT_BSDF};
        struct scenery s;

        open_scenery(&s);
        smoke_world_add_even(&s.parts, "d", 9, 1);
        set_medium(smoke_world_fill(&s.parts, "d", "", -HALF, HALF),
                   v3(0, 0, 0), cube_scatter, 0);
        s.lit.mesh.materials[BODY] = mesh_material(MATERIAL_GLASS, 1);
        s.lit.mesh.materials[BODY].ior = 1;
        s.lit.mesh.materials[BODY].is_boundary = 1;
        mesh_add_box(&s.lit.mesh, v3(-1, -.2f, -1), v3(1, .8f, 1), BODY);
        s.lit.mesh.world.settings.has_boundaries = 1;
        s.lit.mesh.world.settings.max_vertices = 2;
        if (i == 0) {
            s.lit.mesh.materials[WALL] = mesh_material(MATERIAL_DIFFUSE, .6f);
            mesh_add_quad(&s.lit.mesh, v3(-.1f, -1, -.1f), v3(-.1f, -1, .1f),
                          v3(.1f, -1, .1f), v3(.1f, -1, -.1f), WALL);
            s.lit.mesh.world.point_lights = &point;
            s.lit.mesh.world.settings.point_light_count = 1;
        } else {
            c.eye = v3(.1f, -2, .2f);
            c.at = v3(.1f, 0, .2f);
            s.lit.mesh.world.settings.sky.color = v3(1, 1, 1);
        }
        finish_scenery(&s);
        for (int k = 0; k < 3; k++)
            c.truth[k] = (i == 0 ? .6 / M_PI * 5 / 6.25 : 1) *
                         exp(-.3 * channel(cube_scatter, k));
        check_claim(&s.lit, c);
        close_scenery(&s);
    }
}

/* ---- extremes ---- */

static const double amounts[] = {0, 1e-38, 1, 1e30};
static const float densities[] = {65504, 1e30f, -5, 1e-30f, 1};
static const double sides[] = {1, 1e-20, 1e15, 1e30};

static double one_of(const double *list, size_t count, uint64_t *seed)
{
    return list[(size_t)(check_random(seed) * (double)count)];
}

/* Adds a grid that is turned and perhaps in the distance. */
static void add_turned(struct scenery *s, uint64_t *seed)
{
    static const uint32_t size[3] = {3, 9, 2};
    double scale = one_of(sides, 4, seed);
    struct voxel_grid grid;
    float numbers[54];

    for (int i = 0; i < 54; i++)
        numbers[i] = densities[(int)(5 * check_random(seed))];
    grid = grid_of(size, numbers);
    for (int a = 0; a < 3; a++) {
        grid.to_world.m[a][a] = (a == 2 ? 1 : .6) * scale;
        grid.to_world.m[a][3] = scale * (check_random(seed) - .5);
    }
    grid.to_world.m[0][1] = -.8 * scale;
    grid.to_world.m[1][0] = .8 * scale;
    smoke_world_add(&s->parts, "d", &grid);
}

/* Smokes of any numbers give finite radiance, and end. */
static void extremes_are_finite(void **state)
{
    uint64_t seed = 1;
    int lit = 0;

    (void)state;
    for (int i = 0; i < (check_is_thorough() ? 400 : 30); i++) {
        double far = check_random(&seed) < .8 ? 1 : one_of(sides, 4, &seed);
        struct smoke_numbers *n;
        struct error err = {""};
        struct scenery s;

        open_scenery(&s);
        add_turned(&s, &seed);
        n = smoke_world_fill(&s.parts, "d", i % 2 == 0 ? "d" : "", 0, 0);
        for (int k = 0; k < 3; k++) {
            n->scatter[k] = one_of(amounts, 4, &seed);
            n->absorb[k] = one_of(amounts, 4, &seed);
            n->at[k] = check_random(&seed) < .2 ? one_of(sides, 4, &seed) : 0;
        }
        n->anisotropy = (double)(i % 3 - 1);
        n->kelvin = one_of(amounts, 4, &seed);
        n->glow = one_of(amounts, 4, &seed);
        if (!world_set_smokes(&s.parts.host, &s.parts.scene, &s.parts.smokes,
                              &err)) {
            check_has(err.text, "found a grid that is flat or too far away");
            smoke_world_free(&s.parts);
            mesh_free(&s.lit.mesh);
            continue;
        }
        s.lit.mesh.world.settings.sky.color = v3(1, 2, 3);
        finish_scenery(&s);
        lit_mesh_lend(&s.lit, DIRECT_MIS);
        for (uint32_t k = 0; k < 8; k++) {
            struct ray r = {.o = v3_scale(v3((float)check_random(&seed) - .5f,
                                             .1f, .2f),
                                          (float)far),
                            .d = v3_unit(v3((float)check_random(&seed) - .5f,
                                            (float)(k % 3) - 1, .1f)),
                            .t_max = FLOAT_MAX};
            struct path_sample p = trace_path(&s.lit.mesh.world, r,
                                              sampler_start(3, k, 0, 1), NULL);

            for (int a = 0; a < 3; a++)
                assert_true(channel(p.radiance, a) >= 0 &&
                            isfinite(channel(p.radiance, a)));
            lit += p.radiance.z > 0;
        }
        close_scenery(&s);
    }
    assert_true(lit > 15);
}

/* A channel that is stopped at once makes no steps for the others, which pass
 * with their share of light. */
static void channels_do_not_wait(void **state)
{
    struct ray r = {.o = {0, 0, 2}, .d = {0, 0, -1}, .t_max = FLOAT_MAX};
    uint32_t steps = 0;
    struct smoke_passage a = {r, FLOAT_MAX, {1, 1, 1}, 1, &steps};
    const double depth = 2 * HALF * 0.5;
    struct path_sample sum = {.cut = 0};
    double mean = 0;
    struct scenery s;
    struct vec3 share;

    (void)state;
    open_scenery(&s);
    smoke_world_add_even(&s.parts, "d", 9, 1);
    set_medium(smoke_world_fill(&s.parts, "d", "", -HALF, HALF), v3(0, 0, 0),
               v3(1e6f, 0.5f, 0), 0);
    s.lit.mesh.world.settings.sky.color = v3(1, 1, 1);
    finish_scenery(&s);
    lit_mesh_lend(&s.lit, DIRECT_MIS);
    for (uint64_t i = 0; i < 2000; i++) {
        struct path_sample p =
            trace_path(&s.lit.mesh.world, r, sampler_start(3, 1, i, 1), NULL);

        sum.radiance = v3_add(sum.radiance, p.radiance);
        sum.cut += p.cut;
        a.key = hash_u32((uint32_t)i);
        share = smoke_transmittance(&s.lit.mesh.world, a);
        mean += (double)share.y / 2000;
        assert_true(share.x == 0 && share.z == 1);
    }
    assert_int_equal(sum.cut, 0);
    assert_in_range(steps, 0, 2000 * 200); /* a million a ray without it */
    assert_true(sum.radiance.x == 0);
    check_close((double)sum.radiance.y / 2000, exp(-depth), 0.05);
    check_close((double)sum.radiance.z / 2000, 1, 0.05);
    check_close(mean, exp(-depth), 0.05);
    steps = 0;
    a.weights = v3(1, 0, 0); /* nothing else counts */
    assert_true(smoke_transmittance(&s.lit.mesh.world, a).x == 0);
    a.t = 1.4f;
    share = smoke_transmittance(&s.lit.mesh.world, a);
    assert_true(steps < 100 && share.x == 1 && share.y == 0);
    close_scenery(&s);
}

/* A voxel far above the others of its brick lets rays take many steps. Paths
 * and light samples that are cut are counted. */
static void cuts_are_counted(void **state)
{
    struct ray r = {.o = {0, 0, 2}, .d = {0, 0, -1}, .t_max = FLOAT_MAX};
    uint32_t cuts = 0, steps = 0;
    struct smoke_passage a = {r, FLOAT_MAX, {1, 1, 1}, 1, &steps};
    float numbers[9 * 9 * 9] = {1e6f};
    struct voxel_grid grid = grid_of((const uint32_t[3]){9, 9, 9}, numbers);
    struct scenery s;

    (void)state;
    open_scenery(&s);
    smoke_world_add(&s.parts, "d", &grid);
    set_medium(smoke_world_fill(&s.parts, "d", "", -HALF, HALF), v3(0, 0, 0),
               v3(1, 1, 1), 0);
    s.lit.mesh.world.settings.sky.color = v3(1, 1, 1);
    finish_scenery(&s);
    lit_mesh_lend(&s.lit, DIRECT_MIS);
    for (uint64_t i = 0; i < 30; i++)
        cuts +=
            trace_path(&s.lit.mesh.world, r, sampler_start(3, 1, i, 1), NULL)
                .cut;
    assert_int_equal(cuts, 30);
    assert_true(v3_is_zero(smoke_transmittance(&s.lit.mesh.world, a)));
    assert_int_equal(steps, SMOKE_STEPS_MAX + 1);
    /* the limit is that of the path, not of the ray */
    assert_true(v3_is_zero(smoke_transmittance(&s.lit.mesh.world, a)));
    assert_int_equal(steps, SMOKE_STEPS_MAX + 1);
    close_scenery(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_kept),
        cmocka_unit_test(equilibrium_is_kept),
        cmocka_unit_test(smokes_absorb_their_part),
        cmocka_unit_test(hot_cubes_glow),
        cmocka_unit_test(cubes_scatter_light_of_lamps),
        cmocka_unit_test(cubes_are_like_bodies),
        cmocka_unit_test(bodies_have_no_smoke),
        cmocka_unit_test(extremes_are_finite),
        cmocka_unit_test(channels_do_not_wait),
        cmocka_unit_test(cuts_are_counted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
