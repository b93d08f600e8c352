// SPDX-License-Identifier: MIT
/*
 * test_caustic_tables.c - caustics of spheres and discs: their means against
 * closed forms, and the densities of their tables
 */
#include "light/path_guide.h"
#include "tests/unit/truth.h"
#include "kernels/caustic_table.h"

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
            assert_non_null(g.lamps.cells);
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
    assert_non_null(g.lamps.cells);
    check_floor(&s, PANE, sheet_transmittance(1) / (double)(height * height),
                60000);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* A sphere of glass under a sphere of light on a floor, with many groups. */
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
 * below a pane: tables change no mean. */
static void tables_keep_the_mean(void **state)
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
    assert_int_not_equal(caustic_table_at(&s.mesh.world, c.at, v3(0, 1, 0)),
                         NO_INDEX);
    s.mesh.world.settings.directional_light_count = 0;
    check_claim(&s, c);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* Density of a direction by a look at every bin of every group. */
static double density_of(const struct world *w, uint32_t first, struct vec3 p,
                         struct vec3 d)
{
    struct vec2 place = guide_place(d);
    double norm = (double)guide_norm(d), sum = 0;

    for (uint32_t i = first; i != NO_INDEX; i = w->caustic_groups[i].next) {
        const struct caustic_group *g = &w->caustic_groups[i];
        struct vec3 way = v3_sub(p, g->p);
        double side = ldexp(1, (int)g->level);
        double x = (double)(place.x - v3_dot(g->dx, way));
        double y = (double)(place.y - v3_dot(g->dy, way));
        float before = g->before;

        for (uint32_t k = g->first_bin; k < g->first_bin + g->bin_count; k++) {
            struct caustic_bin bin = w->caustic_bins[k];
            double column = (x + 1) / 2 * side - bin.index % (uint32_t)side;
            double row = (y + 1) / 2 * side - floor(bin.index / side);

            if (column >= 0 && column < 1 && row >= 0 && row < 1)
                sum += (double)(bin.sum - before) * side * side / 4;
            before = bin.sum;
        }
    }
    return sum / (norm * norm * norm);
}

/* Samples have the density that the table states, and the bins of a table have
 * a sum of its share. */
static void samples_have_their_density(void **state)
{
    struct path_guide g = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;
    const struct world *w = &s.mesh.world;
    uint64_t random = 1;
    int found = 0, moving = 0;

    (void)state;
    make_ball(&s, &sun);
    build(&s, &g);
    for (int i = 0; i < 400; i++) {
        struct vec3 p = v3((float)(.28 * check_random(&random) - .2), 0,
                           (float)(.26 * check_random(&random) - .13));
        uint32_t first = caustic_table_at(w, p, v3(0, 1, 0));
        int count = 0, same = 0;

        if (first == NO_INDEX)
            continue;
        found++;
        for (uint32_t k = first; k != NO_INDEX; k = w->caustic_groups[k].next)
            moving += !v3_is_zero(w->caustic_groups[k].dx);
        for (int k = 0; k < 500; k++) {
            float u =
                (float)check_random(&random) * .9999f * caustic_share(w, first);
            struct vec2 at = v2(u, (float)check_random(&random));
            double known, derived, truth;
            struct vec3 d;
            uint32_t bin;

            if (!caustic_sample(w, first, p, at, &bin, &d))
                continue;
            count++;
            known = (double)caustic_pdf(w, first, p, d, bin);
            derived = (double)caustic_pdf(w, first, p, d, NO_INDEX);
            truth = density_of(w, first, p, d);
            assert_true(known > 0);
            same += fabs(known - truth) <= 1e-3 * truth &&
                    fabs(derived - truth) <= 1e-3 * truth;
        }
        /* few samples round to the next bin */
        check_at_most(.98 * count, same);
    }
    assert_true(found > 50 && moving > 2);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* Each bin gets the samples of its part of the sums. */
static void bins_have_their_probability(void **state)
{
    const struct vec3 p = {-.06f, 0, 0}, up = {0, 1, 0};
    struct path_guide g = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;
    const struct world *w = &s.mesh.world;
    const uint32_t tries = 1u << 16;
    uint32_t first, end, *counts;

    (void)state;
    make_ball(&s, &sun);
    build(&s, &g);
    first = caustic_table_at(w, p, up);
    assert_int_not_equal(first, NO_INDEX);
    counts = calloc(g.lamps.bin_count, sizeof *counts);
    assert_non_null(counts);
    for (uint32_t i = 0; i < tries; i++) {
        float u = ((float)i + .5f) / (float)tries * caustic_share(w, first);
        struct vec3 d;
        uint32_t bin;

        caustic_sample(w, first, p, v2(u, .5f), &bin, &d);
        counts[bin]++;
    }
    for (uint32_t i = first; i != NO_INDEX; i = w->caustic_groups[i].next) {
        const struct caustic_group *group = &w->caustic_groups[i];
        float before = group->before;

        end = group->first_bin + group->bin_count;
        for (uint32_t k = group->first_bin; k < end; k++) {
            double part = (double)(w->caustic_bins[k].sum - before) /
                          (double)caustic_share(w, first);

            check_close(counts[k], part * tries, 2);
            before = w->caustic_bins[k].sum;
        }
    }
    free(counts);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

/* Tables exist only for lights that paths can meet, and go with them. */
static void tables_exist_only_with_lamps_of_a_size(void **state)
{
    struct path_guide g = {.cells = NULL};
    struct directional_light sun;
    struct lit_mesh s;

    (void)state;
    make_ball(&s, &sun);
    build(&s, &g);
    assert_true(path_guide_has_tables(&g));
    assert_int_equal(s.mesh.world.settings.caustic_cell_count,
                     g.lamps.cell_count);
    sun.size = 0;
    path_guide_outdate_lamps(&g);
    build(&s, &g);
    assert_false(path_guide_has_tables(&g));
    assert_int_equal(s.mesh.world.settings.caustic_cell_count, 0);
    path_guide_free(&g);
    lit_mesh_free(&s);
}

static void thread_counts_give_the_same_tables(void **state)
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
    assert_int_equal(alone.lamps.bin_count, together.lamps.bin_count);
    assert_memory_equal(alone.lamps.cells, together.lamps.cells,
                        alone.lamps.cell_count * sizeof *alone.lamps.cells);
    assert_memory_equal(alone.lamps.groups, together.lamps.groups,
                        alone.lamps.group_count * sizeof *alone.lamps.groups);
    assert_memory_equal(alone.lamps.bins, together.lamps.bins,
                        alone.lamps.bin_count * sizeof *alone.lamps.bins);
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
        cmocka_unit_test(tables_keep_the_mean),
        cmocka_unit_test(samples_have_their_density),
        cmocka_unit_test(bins_have_their_probability),
        cmocka_unit_test(tables_exist_only_with_lamps_of_a_size),
        cmocka_unit_test(thread_counts_give_the_same_tables),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
