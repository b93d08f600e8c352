// SPDX-License-Identifier: MIT
/*
 * test_subsurface.c - walks below surfaces: thick bodies have the color of
 * their surface, white ones keep the light, and open meshes lose it
 */
#include "base/thread_pool.h"
#include "render/cpu_dispatch.h"

#include "tests/unit/files.h"
#include "tests/unit/lambert.h"
#include "tests/unit/truth.h"

static struct material skin(struct vec3 color, float path, float g)
{
    struct material m = mesh_material(MATERIAL_DIFFUSE, 0);

    m.color = color;
    m.subsurface = 1;
    m.medium.extinction = v3(1 / path, 2 / path, 0.5f / path);
    m.medium.anisotropy = g;
    return m;
}

/* The albedo of scattering gives a half space its color: by Chandrasekhar's
 * solution, A = 1 - 2 sqrt(1 - w) times the integral of H(mu) mu. H is found by
 * the iteration of its equation, 1 / H = sqrt(1 - w) + w / 2 times the integral
 * of x H(x) / (mu + x). */
static void albedos_give_the_color(void **state)
{
    enum { N = 400 };
    static const double colors[] = {0.05, 0.2, 0.5, 0.8, 0.95};

    (void)state;
    for (int i = 0; i < 5; i++) {
        double w = (double)medium_albedo_of((float)colors[i], 0);
        double h[N], sum = 0;

        for (int k = 0; k < N; k++)
            h[k] = 1;
        for (int round = 0; round < 200; round++)
            for (int k = 0; k < N; k++) {
                double mu = (k + 0.5) / N, integral = 0;

                for (int j = 0; j < N; j++)
                    integral += (j + 0.5) / N * h[j] / (mu + (j + 0.5) / N) / N;
                h[k] = 1 / (sqrt(1 - w) + w / 2 * integral);
            }
        for (int k = 0; k < N; k++)
            sum += h[k] * (k + 0.5) / N / N;
        check_close(1 - 2 * sqrt(1 - w) * sum, colors[i], 0.003);
    }
}

/* Checks the light of a body under a white sky. */
static void check_body(const struct material *m, bool is_ball, struct claim c)
{
    struct lit_mesh s = {0};

    s.mesh.materials[0] = *m;
    s.mesh.world.settings.sky.color = v3(1, 1, 1);
    if (is_ball)
        mesh_add_sphere(&s.mesh, v3(0, 0, 0), 0.5f, 40, 60, 0);
    else
        mesh_add_box(&s.mesh, v3(-3, -2, -3), v3(3, 0, 3), 0);
    lit_mesh_finish(&s);
    check_claim(&s, c);
    lit_mesh_free(&s);
}

/* A thick body under a white sky has its color, whatever the mean free paths,
 * seen from any direction. */
static void thick_bodies_have_their_color(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct material m =
            skin(v3(0.8f, 0.5f, 0.2f), 0.01f, i == 2 ? 0.5f : 0);

        check_body(&m, false,
                   (struct claim){.eye = {0, i == 0 ? 2 : 0.7f,
                                          0.5f * (float)i},
                                  .truth = {0.8, 0.5, 0.2},
                                  .systematic = 0.006,
                                  .paths = 2000});
    }
}

/* A body that absorbs next to nothing is as bright as the sky. Its color is
 * kept below 1, and its walks are cut after very many steps. */
static void white_bodies_keep_the_light(void **state)
{
    struct material m = skin(v3(1, 1, 1), 0.2f, 0);

    (void)state;
    check_body(&m, true,
               (struct claim){.eye = {0.1f, 0.2f, 2},
                              .truth = GREY(1),
                              .systematic = 0.004,
                              .paths = 1000});
}

/* What does not enter is that of the surface: half of the weight each. */
static void weights_mix(void **state)
{
    struct material m = skin(v3(0.8f, 0.5f, 0.2f), 0.01f, 0);

    (void)state;
    m.subsurface = 0.5f;
    check_body(&m, false,
               (struct claim){.eye = {0, 2, 0},
                              .truth = {0.8, 0.5, 0.2},
                              .systematic = 0.005,
                              .paths = 2000});
}

static struct material polished(float grey, float path, float alpha)
{
    struct material m = skin(v3(grey, grey, grey), path, 0);

    m.kind = MATERIAL_PLASTIC;
    m.specular = v3(0.04f, 0.04f, 0.04f);
    m.alpha = alpha;
    return m;
}

/* Below a highlight the body has what the highlight leaves: a white body is
 * white. */
static void highlights_take_their_share(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct material m = polished(1, 0.05f, i == 0 ? 0.3f : 0);

        check_body(&m, true,
                   (struct claim){.eye = {0, 1, 1},
                                  .truth = GREY(1),
                                  .systematic = 0.006,
                                  .paths = 3000,
                                  .without = 1 << DIRECT_LIGHTS});
    }
}

/* A mirror of .04 above a dark body, seen along its normal. */
static void mirrors_lie_above_bodies(void **state)
{
    struct material m = polished(0.2f, 0.01f, 0);

    (void)state;
    check_body(&m, false,
               (struct claim){.eye = {0, 2, 0},
                              .truth = GREY(0.04 + 0.96 * 0.2),
                              .systematic = 0.006,
                              .paths = 3000});
}

/* A mixture with a body below it. */
static struct material mixed(float grey, float metalness, float transmission)
{
    struct material m = polished(grey, 0.05f, 0);

    m.kind = MATERIAL_PRINCIPLED;
    m.metalness = metalness;
    m.transmission = transmission;
    m.ior = 1.5f;
    return m;
}

/* A white mixture is white, whatever its layers, as it is without a body. */
static void white_mixtures_stay_white(void **state)
{
    (void)state;
    for (int i = 0; i < 7; i++) {
        struct material m = mixed(1, i == 1 || i == 6 ? 0.4f : 0,
                                  i == 2 || i == 3 || i == 6 ? 0.3f : 0);

        m.is_thin = i == 3;
        m.coat = i == 4 || i == 6 ? 0.7f : 0;
        m.coat_alpha = 0.2f;
        m.alpha = i == 5 || i == 6 ? 0.3f : 0;
        if (i == 5) {
            m.sheen = v3(0.5f, 0.5f, 0.5f);
            m.sheen_alpha = 0.25f;
        }
        if (i == 0) {
            m.specular = v3(0.5f, 0.5f, 0.5f);
            m.film = 1;
        }
        m.film_ior = 1.4f;
        m.film_thickness = 400;
        m.subsurface = i == 6 ? 0.5f : 1;
        check_body(&m, true,
                   (struct claim){.eye = {0, 1, 1},
                                  .truth = GREY(1),
                                  .systematic = 0.01,
                                  .paths = 3000,
                                  .without = 1 << DIRECT_LIGHTS});
    }
}

/* Seen along its normal, a mirror of .04 above a mixture of metal and plastic.
 * Only the plastic has a body. */
static void mixtures_lie_above_bodies(void **state)
{
    const float metal = 0.25f;
    const double grey = 0.2;
    struct material m = mixed((float)grey, metal, 0);
    double plastic = 0.04 + 0.96 * grey;
    double truth =
        0.04 + 0.96 * ((double)metal * grey + (1 - (double)metal) * plastic);

    (void)state;
    m.coat = 1;
    m.medium.extinction = v3(100, 100, 100);
    check_body(&m, false,
               (struct claim){.eye = {0, 2, 0},
                              .truth = GREY(truth),
                              .systematic = 0.006,
                              .paths = 3000});
}

/* What does not enter a rough diffuse surface is scaled as a whole, so that a
 * white one is white. */
static void rough_surfaces_mix(void **state)
{
    struct material m = skin(v3(1, 1, 1), 0.05f, 0);

    (void)state;
    m.kind = MATERIAL_ROUGH_DIFFUSE;
    m.alpha = 0.8f;
    m.subsurface = 0.5f;
    check_body(&m, true,
               (struct claim){.eye = {0, 1, 1},
                              .truth = GREY(1),
                              .systematic = 0.004,
                              .paths = 1000});
}

/* Traces a path whose rays below surfaces go on to the next surface. */
static struct path_sample trace_far(const struct world *w, struct ray r,
                                    struct sampler sampler)
{
    struct camera_sample start = {.ray = r, .sampler = sampler};
    struct path p;
    struct hit h;
    bool goes_on = true;

    hit_closest(w, r, &h);
    path_open(w, &p, start, NULL);
    while (goes_on) {
        struct ray far;

        goes_on = path_extend(w, &p, &h);
        far = p.ray;
        far.t_max = FLOAT_MAX;
        if (p.light.is_lit)
            path_add_light(w, &p);
        if (goes_on)
            hit_closest(w, far, &h);
    }
    return path_close(w, &p, r, NULL);
}

/* Rays that end at collisions find what longer ones find. */
static void ends_of_rays_change_nothing(void **state)
{
    struct ray r = {{0.1f, 0.2f, 2}, {0, 0, -1}, FLOAT_MAX, 0, 0};
    struct lit_mesh s = {0};
    uint32_t rays = 0;

    (void)state;
    s.mesh.materials[0] = skin(v3(0.8f, 0.5f, 0.2f), 0.1f, 0.3f);
    s.mesh.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_sphere(&s.mesh, v3(0, 0, 0), 0.5f, 10, 15, 0);
    lit_mesh_finish(&s);
    lit_mesh_lend(&s, DIRECT_MIS);
    for (uint32_t i = 0; i < 1000; i++) {
        struct sampler sampler = sampler_start(1, 1, i, 5);
        struct path_sample a = trace_path(&s.mesh.world, r, sampler, NULL);
        struct path_sample b = trace_far(&s.mesh.world, r, sampler);

        assert_memory_equal(&a, &b, sizeof a);
        rays += a.rays;
    }
    assert_true(rays > 5000);
    lit_mesh_free(&s);
}

/* Returns the rays of paths that enter a white box, which has all sides or
 * lacks one beside them. */
static uint32_t rays_in_box(bool is_closed)
{
    struct ray r = {{0.05f, -1, 0.01f}, {0, 1, 0}, FLOAT_MAX, 0, 0};
    struct mesh m = {0};
    uint32_t rays = 0;

    m.materials[0] = skin(v3(1, 1, 1), 0.02f, 0);
    mesh_add_box(&m, v3(0, 0, -0.1f), v3(0.1f, 0.1f, 0.1f), 0);
    if (!is_closed)
        m.tri_count -= 2;
    mesh_finish(&m);
    for (uint32_t i = 0; i < 1000; i++)
        rays += trace_path(&m.world, r, sampler_start(1, 1, i, 5), NULL).rays;
    mesh_free(&m);
    return rays;
}

/* Light that walks out of an open mesh is lost: at once below a lone face, soon
 * at a hole. */
static void open_meshes_lose_the_light(void **state)
{
    struct ray r = {{0.01f, 1, 0.02f}, {0, -1, 0}, FLOAT_MAX, 0, 0};
    struct mesh m = {0};

    (void)state;
    m.materials[0] = skin(v3(0.8f, 0.5f, 0.2f), 0.01f, 0);
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_quad(&m, v3(-1, 0, -1), v3(-1, 0, 1), v3(1, 0, 1), v3(1, 0, -1),
                  0);
    mesh_finish(&m);
    for (uint32_t i = 0; i < 100; i++) {
        struct path_sample s =
            trace_path(&m.world, r, sampler_start(1, 1, i, 5), NULL);

        assert_true(v3_is_zero(s.radiance));
        assert_int_equal(s.rays, 2);
        assert_int_equal(s.cut, 0);
    }
    mesh_free(&m);
    check_at_most(rays_in_box(false), 1.5 * rays_in_box(true));
}

/* A halt ends walks at once; without one the samples have the same bits. Other
 * worlds finish their samples. */
static void halts_end_walks(void **state)
{
    const struct sample_id ids[2] = {{3, 3, 0}, {3, 3, 1}};
    struct cancel cancel = {.deadline_ns = 0};
    const struct sample_options options = {.cancel = &cancel};
    const struct cpu_kernel *kernel = cpu_kernel_best();
    struct path_sample a[2], b[2];
    struct first_surface surfaces[2];
    struct lit_mesh s = {0};
    struct world *w = &s.mesh.world;

    (void)state;
    s.mesh.materials[0] = skin(v3(0.8f, 0.5f, 0.2f), 0.05f, 0);
    w->settings.sky.color = v3(1, 1, 1);
    w->settings.camera = (struct camera){.eye = {0, 0, 2},
                                         .width = 8,
                                         .height = 8,
                                         .forward = {0, 0, -1},
                                         .right = {0.1f, 0, 0},
                                         .up = {0, 0.1f, 0}};
    mesh_add_sphere(&s.mesh, v3(0, 0, 0), 0.5f, 40, 60, 0);
    lit_mesh_finish(&s);
    lit_mesh_lend(&s, DIRECT_MIS);
    w->settings.features = FEATURE_SUBSURFACE;
    assert_true(kernel->samples(w, ids, 2, a, surfaces, NULL));
    assert_true(kernel->samples(w, ids, 2, b, surfaces, &options));
    assert_true(a[0].rays > 3 && a[0].radiance.x > 0);
    assert_memory_equal(a, b, sizeof a);
    cancel_request(&cancel);
    assert_false(kernel->samples(w, ids, 2, b, surfaces, &options));
    w->settings.features = 0;
    assert_true(kernel->samples(w, ids, 2, b, surfaces, &options));
    assert_memory_equal(a, b, sizeof a);
    lit_mesh_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedos_give_the_color),
        cmocka_unit_test(thick_bodies_have_their_color),
        cmocka_unit_test(white_bodies_keep_the_light),
        cmocka_unit_test(weights_mix),
        cmocka_unit_test(highlights_take_their_share),
        cmocka_unit_test(mirrors_lie_above_bodies),
        cmocka_unit_test(white_mixtures_stay_white),
        cmocka_unit_test(mixtures_lie_above_bodies),
        cmocka_unit_test(rough_surfaces_mix),
        cmocka_unit_test(ends_of_rays_change_nothing),
        cmocka_unit_test(open_meshes_lose_the_light),
        cmocka_unit_test(halts_end_walks),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
