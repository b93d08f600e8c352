// SPDX-License-Identifier: MIT
/*
 * test_path_guide_build.c - the guide built for a scene: it leads to windows,
 * and exists only where it helps
 */
#include "tests/unit/light/guide_lookup.h"
#include "tests/unit/truth.h"
#include "world/light/path_guide.h"
#include "world/light/triangle_cdf.h"

/* Returns the lights that the world uses. */
static const struct lights *lent_lights(const struct lit_mesh *s)
{
    static const struct lights none = {.light_count = 0};

    return s->mesh.world.settings.light_count > 0 ? &s->lights : &none;
}

static void build_guide(struct lit_mesh *s, float sky, struct path_guide *g)
{
    struct error err;

    path_guide_outdate(g);
    check_or_say(path_guide_update(g, &s->mesh.world, lent_lights(s),
                                   (double)sky, NULL, &err),
                 err.text);
}

/* The room is [-1, 1]^3. Its wall at x = -1 has a window with these ranges of y
 * and z. */
static const float window[2][2] = {{-.2f, .5f}, {-.4f, .4f}};

static void add_wall(struct mesh *m, float y0, float y1, float z0, float z1,
                     uint32_t material)
{
    mesh_add_quad(m, v3(-1, y0, z0), v3(-1, y0, z1), v3(-1, y1, z1),
                  v3(-1, y1, z0), material);
}

/* Makes the room: material 0 is that of walls, 1 of the pane, 2 of the lamp. */
static void make_room(struct lit_mesh *s, bool has_pane)
{
    struct mesh *m = &s->mesh;
    const float *y = window[0], *z = window[1];

    *s = (struct lit_mesh){.mesh = {.positions = NULL}};
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, .5f);
    m->materials[1] = mesh_material(MATERIAL_THIN_GLASS, 1);
    m->materials[2] = mesh_material(MATERIAL_DIFFUSE, 0);
    m->materials[2].emission = v3(1, 1, 1);
    for (int k = -1; k <= 1; k += 2) {
        float e = (float)k;

        mesh_add_quad(m, v3(-1, e, -1), v3(-1, e, 1), v3(1, e, 1), v3(1, e, -1),
                      0);
        mesh_add_quad(m, v3(-1, -1, e), v3(-1, 1, e), v3(1, 1, e), v3(1, -1, e),
                      0);
    }
    mesh_add_quad(m, v3(1, -1, -1), v3(1, -1, 1), v3(1, 1, 1), v3(1, 1, -1), 0);
    add_wall(m, -1, y[0], -1, 1, 0);
    add_wall(m, y[1], 1, -1, 1, 0);
    add_wall(m, y[0], y[1], -1, z[0], 0);
    add_wall(m, y[0], y[1], z[1], 1, 0);
    if (has_pane)
        add_wall(m, y[0], y[1], z[0], z[1], 1);
    mesh_add_quad(m, v3(0, .9f, 0), v3(0, .9f, .1f), v3(.1f, .9f, .1f),
                  v3(.1f, .9f, 0), 2);
}

/* Returns whether a ray from p leaves through the window, with a tolerance of a
 * bin and a cell. */
static bool leaves_by_window(struct vec3 p, struct vec3 d)
{
    float t = (-1 - p.x) / d.x, y = p.y + t * d.y, z = p.z + t * d.z;
    float near = (.2f + .13f * t) / -d.x;

    return d.x < 0 && y > window[0][0] - near && y < window[0][1] + near &&
           z > window[1][0] - near && z < window[1][1] + near;
}

/* Returns the share of guided directions for p that lead to the window, or -1
 * if p has no table. */
static double share_to_window(const struct world *w, uint32_t cell,
                              struct vec3 p)
{
    uint64_t random = 1;
    double part = 0;

    if (cell == NO_INDEX)
        return -1;
    for (int i = 0; i < 1000; i++) {
        float u = (float)check_random(&random) * .999f * guide_share(w, cell);

        part +=
            leaves_by_window(p,
                             guide_sample(w, cell,
                                          v2(u, (float)check_random(&random))))
                ? .001
                : 0;
    }
    return part;
}

/* All over the floor and the opposite wall, directions lead to the window:
 * those of light samples, or with a pane, at which shadow rays end, those of
 * paths. */
static void guided_directions_lead_to_the_window(void **state)
{
    (void)state;
    for (int has_pane = 0; has_pane < 2; has_pane++) {
        uint32_t (*at)(const struct world *, struct vec3, struct vec3) =
            has_pane ? scatter_table_at : sky_at;
        uint32_t (*not_at)(const struct world *, struct vec3, struct vec3) =
            has_pane ? sky_at : scatter_table_at;
        struct path_guide g = {.cells = NULL};
        struct lit_mesh s;
        struct world *w = &s.mesh.world;
        int found = 0;

        make_room(&s, has_pane);
        lit_mesh_finish(&s);
        build_guide(&s, 1, &g);
        path_guide_lend(&g, w);
        for (float x = -.7f; x < .95f; x += .2f)
            for (float z = -.9f; z < .95f; z += .2f) {
                const struct vec3 p[2] = {v3(x, -1, z), v3(1, x, z)};
                const struct vec3 n[2] = {v3(0, 1, 0), v3(-1, 0, 0)};

                for (int i = 0; i < 2; i++) {
                    double part = share_to_window(w, at(w, p[i], n[i]), p[i]);

                    assert_int_equal(not_at(w, p[i], n[i]), NO_INDEX);
                    if (part >= 0) {
                        check_at_most(.97, part);
                        found++;
                    }
                }
            }
        assert_true(found > 140);
        /* Surfaces that face outwards see the sky. */
        assert_int_equal(at(w, v3(1, 0, 0), v3(1, 0, 0)), NO_INDEX);
        path_guide_free(&g);
        lit_mesh_free(&s);
    }
}

/* Returns the standard error of the floor's radiance under a sky of 1. */
static double noise(struct lit_mesh *s, const struct path_guide *g)
{
    const struct claim c = {.eye = {.6f, .1f, .4f},
                            .at = {.1f, -1, .1f},
                            .paths = 1000};

    lit_mesh_lend(s, DIRECT_MIS);
    path_guide_lend(g, &s->mesh.world);
    return claim_estimate(&s->mesh.world, &c).error[0];
}

/* The whiter the walls, the more light arrives by reflection. Then the share of
 * guided samples is smaller, and zero where it would gain little. */
static void white_rooms_are_guided_less(void **state)
{
    const struct path_guide none = {.cells = NULL};

    (void)state;
    for (int has_pane = 0; has_pane < 2; has_pane++) {
        double shares[2] = {0, 0};

        for (int is_white = 0; is_white < 2; is_white++) {
            struct vec3 p = {.1f, -1, .1f}, up = {0, 1, 0};
            struct path_guide g = {.cells = NULL};
            uint32_t first;
            struct lit_mesh s;

            make_room(&s, has_pane);
            s.mesh.materials[2].emission = v3(0, 0, 0);
            s.mesh.world.settings.sky.color = v3(1, 1, 1);
            lit_mesh_finish(&s);
            build_guide(&s, 1, &g); /* of grey walls */
            s.mesh.materials[0] =
                mesh_material(MATERIAL_DIFFUSE, is_white ? .98f : .3f);
            path_guide_recolor(&g);
            check_or_say(path_guide_update(&g, &s.mesh.world, lent_lights(&s),
                                           1, NULL, NULL),
                         "");
            path_guide_lend(&g, &s.mesh.world);
            first =
                (has_pane ? scatter_table_at : sky_at)(&s.mesh.world, p, up);
            if (first != NO_INDEX)
                shares[is_white] = (double)guide_share(&s.mesh.world, first);
            /* The standard error of a standard error of 32 means is an
             * eighth. */
            check_at_most(noise(&s, &g),
                          (is_white ? 1.5 : .9) * noise(&s, &none));
            path_guide_free(&g);
            lit_mesh_free(&s);
        }
        check_at_most(.1, shares[0]);
        check_at_most(shares[1], .5 * shares[0]);
    }
}

/* Walls of albedo .7 that emit .3 under a sky of 1 have radiance 1. */
static void guided_rooms_keep_the_mean(void **state)
{
    (void)state;
    for (int has_pane = 0; has_pane < 2; has_pane++) {
        struct path_guide g = {.cells = NULL};
        struct claim c = {.eye = {.6f, .1f, .4f},
                          .at = {.1f, -1, .1f},
                          .truth = GREY(1),
                          .paths = 2000,
                          /* behind panes light samples see no sky */
                          .without = 1 << DIRECT_LIGHTS};
        struct lit_mesh s;

        make_room(&s, has_pane);
        s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, .7f);
        s.mesh.materials[0].emission = v3(.3f, .3f, .3f);
        s.mesh.world.settings.sky.color = v3(1, 1, 1);
        lit_mesh_finish(&s);
        build_guide(&s, 1, &g); /* as if only the sky emitted light */
        assert_true(g.grid.table_count > 0);
        path_guide_lend(&g, &s.mesh.world);
        check_claim(&s, c);
        path_guide_free(&g);
        lit_mesh_free(&s);
    }
}

static void tables_exist_only_where_the_sky_is_hidden(void **state)
{
    struct path_guide g = {.cells = NULL};
    struct error err;
    struct lit_mesh s;

    (void)state;
    make_room(&s, false);
    lit_mesh_finish(&s);
    build_guide(&s, 0, &g);
    assert_null(g.cells);
    check_or_say(path_guide_update(&g, &s.mesh.world, lent_lights(&s), 1, NULL,
                                   &err),
                 err.text);
    assert_non_null(g.cells);
    check_or_say(path_guide_update(&g, &s.mesh.world, lent_lights(&s), 0, NULL,
                                   &err),
                 err.text);
    assert_null(g.cells);
    lights_lend(&s.lights, &s.mesh.world);
    build_guide(&s, 1, &g);
    assert_non_null(g.cells);
    build_guide(&s, 1e-4f, &g); /* the lamp is much brighter */
    assert_null(g.cells);
    lit_mesh_free(&s);

    make_room(&s, true);
    s.mesh.materials[1] = mesh_material(MATERIAL_DIFFUSE, .5f);
    lit_mesh_finish(&s);
    build_guide(&s, 1, &g); /* an opaque pane */
    assert_null(g.cells);
    lit_mesh_free(&s);

    s = (struct lit_mesh){.mesh = {.positions = NULL}};
    s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, .5f);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_quad(&s.mesh, v3(-9, -1, -9), v3(-9, -1, 9), v3(9, -1, 9),
                  v3(9, -1, -9), 0);
    lit_mesh_finish(&s);
    build_guide(&s, 1, &g);
    for (uint32_t i = 0; i < s.mesh.world.settings.tri_count; i++) {
        struct vec3 p[3];

        tri_corners(&s.mesh.world, i, p);
        path_guide_lend(&g, &s.mesh.world);
        assert_int_equal(sky_at(&s.mesh.world, p[0], v3(0, 1, 0)), NO_INDEX);
    }
    path_guide_free(&g);
    lit_mesh_free(&s);
}

static void thread_counts_give_the_same_tables(void **state)
{
    struct error err;
    struct pool *pool = pool_create(3, &err);

    (void)state;
    assert_non_null(pool);
    for (int has_pane = 0; has_pane < 2; has_pane++) {
        struct path_guide alone = {.cells = NULL}, together = {.cells = NULL};
        struct lit_mesh s;

        make_room(&s, has_pane);
        lit_mesh_finish(&s);
        build_guide(&s, 1, &alone);
        check_or_say(path_guide_update(&together, &s.mesh.world,
                                       lent_lights(&s), 1, pool, &err),
                     err.text);
        assert_non_null(alone.cells);
        assert_int_equal(alone.grid.table_count, together.grid.table_count);
        assert_memory_equal(alone.cells, together.cells,
                            guide_cell_count(&alone.grid) *
                                sizeof *alone.cells);
        assert_memory_equal(alone.sums, together.sums,
                            alone.grid.table_count * GUIDE_BINS *
                                sizeof *alone.sums);
        path_guide_free(&alone);
        path_guide_free(&together);
        lit_mesh_free(&s);
    }
    pool_destroy(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thread_counts_give_the_same_tables),
        cmocka_unit_test(guided_directions_lead_to_the_window),
        cmocka_unit_test(white_rooms_are_guided_less),
        cmocka_unit_test(guided_rooms_keep_the_mean),
        cmocka_unit_test(tables_exist_only_where_the_sky_is_hidden),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
