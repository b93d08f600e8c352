// SPDX-License-Identifier: MIT
/*
 * test_photons.c - caustics of points and of single directions: which lights
 * have photons, where their lobes aim, and their means
 */
#include "tests/unit/truth.h"
#include "world/light/path_guide.h"
#include "kernels/caustic_lobes.h"

#define ALBEDO 0.5

/* Roughness .25, as files have it. */
#define ALPHA 0.0625f

/* A ball over the floor at y = 0. */
#define RADIUS .15
static const struct vec3 middle = {0, .2f, 0};

/* Paths do not meet points. */
#define NOT_BY_CHANCE (1 << DIRECT_BSDF)

static void begin(struct lit_mesh *s, float alpha)
{
    *s = (struct lit_mesh){.mesh = {.positions = NULL}};
    s->mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    s->mesh.materials[1] = mesh_material(MATERIAL_METAL, 1);
    s->mesh.materials[1].alpha = alpha;
    mesh_add_quad(&s->mesh, v3(-.5f, 0, -.5f), v3(-.5f, 0, .5f),
                  v3(.5f, 0, .5f), v3(.5f, 0, -.5f), 0);
}

static void add_ball(struct lit_mesh *s)
{
    mesh_add_sphere(&s->mesh, middle, (float)RADIUS, 32, 64, 1);
}

static void set_points(struct lit_mesh *s, const struct point_light *points,
                       uint32_t count)
{
    s->mesh.world.point_lights = points;
    s->mesh.world.settings.point_light_count = count;
}

static void build(struct lit_mesh *s, struct path_guide *g)
{
    struct error err;

    lit_mesh_finish(s);
    lit_mesh_lend(s, DIRECT_MIS);
    check_or_say(path_guide_update(g, &s->mesh.wide_world, &s->lights, 0, NULL,
                                   &err),
                 err.text);
    path_guide_lend(g, &s->mesh.world);
}

static void end(struct lit_mesh *s, struct path_guide *g)
{
    path_guide_free(g);
    lit_mesh_free(s);
}

static struct point_light point_at(struct vec3 p, float intensity)
{
    return (struct point_light){.p = p,
                                .cone_offset = 1,
                                .emission = {intensity, intensity, intensity}};
}

/* A spot that is full to 18 degrees from the axis, and ends at 20. */
static struct point_light spot_at(struct vec3 p, float intensity,
                                  struct vec3 axis)
{
    struct point_light spot = point_at(p, intensity);
    double outer = cos(20 * M_PI / 180);
    double scale = 1 / (cos(18 * M_PI / 180) - outer);

    spot.axis = axis;
    spot.cone_scale = (float)scale;
    spot.cone_offset = (float)(-outer * scale);
    return spot;
}

static bool has_lobes(float alpha, const struct point_light *point,
                      const struct directional_light *direction,
                      const float *profile)
{
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;
    bool has;

    begin(&s, alpha);
    add_ball(&s);
    set_points(&s, point, point != NULL ? 1 : 0);
    s.mesh.world.directional_lights = direction;
    s.mesh.world.settings.directional_light_count = direction != NULL ? 1 : 0;
    s.mesh.world.profiles = profile;
    s.mesh.world.settings.profile_value_count =
        profile != NULL ? PROFILE_ROWS : 0;
    build(&s, &g);
    has = path_guide_has_tables(&g);
    assert_int_equal(s.mesh.world.settings.caustic_lobe_count > 0, has);
    end(&s, &g);
    return has;
}

/* Light samples do not take mirrors, so photons by way of one are of no use. */
static void points_have_lobes_by_rough_metal_only(void **state)
{
    const struct vec3 beside = {.5f, .5f, 0};
    struct point_light point = point_at(beside, 1);
    struct point_light spot =
        spot_at(beside, 1, v3_unit(v3_sub(middle, beside)));
    struct directional_light sun = {.d = {0, 1, 0},
                                    .emission = {1, 1, 1},
                                    .power = 1};

    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        float alpha = rough ? ALPHA : 0;

        assert_int_equal(has_lobes(alpha, &point, NULL, NULL), rough);
        assert_int_equal(has_lobes(alpha, &spot, NULL, NULL), rough);
        assert_int_equal(has_lobes(alpha, NULL, &sun, NULL), rough);
    }
}

/* Light goes where the cone or the profile sends it: down to the ball, or up.
 */
static void photons_obey_cones_and_profiles(void **state)
{
    const struct vec3 beside = {.5f, .5f, 0};
    const struct vec3 down = v3_unit(v3_sub(middle, beside));
    float profile[PROFILE_ROWS];

    (void)state;
    for (int has = 0; has < 2; has++) {
        struct point_light spot =
            spot_at(beside, 1, v3_scale(down, has ? 1 : -1));
        struct point_light lamp = point_at(beside, 1);

        lamp.axis = v3(0, -1, 0);
        lamp.side = v3(1, 0, 0);
        lamp.profile = 1;
        lamp.profile_columns = 1;
        for (int row = 0; row < PROFILE_ROWS; row++)
            profile[row] = (row <= 90) == has;
        assert_int_equal(has_lobes(ALPHA, &spot, NULL, NULL), has);
        assert_int_equal(has_lobes(ALPHA, &lamp, NULL, profile), has);
    }
}

/* The place of the ball where it shows a lamp to p: its normal is between the
 * ways to both. */
static struct vec3 highlight(struct vec3 p, struct vec3 lamp)
{
    struct vec3 n = v3(0, 1, 0), at = middle;

    for (int i = 0; i < 100; i++) {
        at = v3_add(middle, v3_scale(n, (float)RADIUS));
        n = v3_unit(v3_add(v3_unit(v3_sub(lamp, at)), v3_unit(v3_sub(p, at))));
    }
    return at;
}

static bool meets_ball(struct vec3 p, struct vec3 d)
{
    struct vec3 to = v3_sub(middle, p);
    double along = (double)v3_dot(to, d);

    return along > 0 &&
           (double)v3_dot(to, to) - along * along < RADIUS * RADIUS;
}

/* Beside a point of the same intensity a spot has little power, but all of it
 * is on the ball. Lobes are denser at both highlights than the cosine's 1 / pi,
 * and their samples go to the ball. */
static void lobes_aim_at_all_highlights(void **state)
{
    const struct vec3 up = {0, 1, 0},
                      at[2] = {{.5f, .5f, .4f}, {-.5f, .5f, .4f}};
    const struct point_light lamps[2] = {
        point_at(at[0], 1), spot_at(at[1], 1, v3_unit(v3_sub(middle, at[1])))};
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;
    const struct world *w = &s.mesh.world;
    uint64_t random = 1;
    int places = 0, found[2] = {0, 0}, on_ball = 0, samples = 0;

    (void)state;
    begin(&s, ALPHA);
    add_ball(&s);
    set_points(&s, lamps, 2);
    build(&s, &g);
    for (int i = 0; i < 1000; i++) {
        struct vec3 p = v3((float)(.2 * check_random(&random) - .1), 0,
                           (float)(.2 + .1 * check_random(&random)));
        uint32_t leaf = caustic_leaf_at(w, p, up);
        struct vec3 d;

        if (leaf == NO_INDEX)
            continue;
        places++;
        for (int k = 0; k < 2; k++) {
            d = v3_unit(v3_sub(highlight(p, at[k]), p));
            found[k] +=
                caustic_pdf(w, leaf, p, d) > caustic_share(w, leaf) * 1 / PI;
        }
        for (int k = 0; k < 10; k++) {
            float u = (float)check_random(&random) * caustic_share(w, leaf);

            if (!caustic_sample(w, leaf, p, v2(u, (float)check_random(&random)),
                                &d))
                continue;
            samples++;
            on_ball += meets_ball(p, d);
        }
    }
    assert_true(places > 900);
    for (int k = 0; k < 2; k++)
        check_at_most(.85 * places, found[k]);
    check_at_most(.85 * samples, on_ball);
    end(&s, &g);
}

/* A floor of albedo .5 that emits .5 has radiance 1 where all else has: a white
 * ball loses no light, and lobes change no mean. */
static void lobes_keep_the_mean(void **state)
{
    struct point_light point = point_at(v3(.2f, .8f, 0), 1);
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;
    struct claim c = {.eye = {.23f, .1f, .02f},
                      .at = {.2f, 0, 0},
                      .truth = GREY(1),
                      .paths = 4000};
    struct error err;

    (void)state;
    begin(&s, ALPHA);
    add_ball(&s);
    s.mesh.materials[0].emission = v3(.5f, .5f, .5f);
    s.mesh.world.settings.sky.color = v3(1, 1, 1);
    set_points(&s, &point, 1);
    build(&s, &g);
    assert_int_not_equal(caustic_leaf_at(&s.mesh.world, c.at, v3(0, 1, 0)),
                         NO_INDEX);
    set_points(&s, NULL, 0);
    lights_free(&s.lights);
    check_or_say(lights_build(&s.lights, &s.mesh.world, &err), err.text);
    check_claim(&s, c);
    end(&s, &g);
}

/* Irradiance at the origin of the floor from a wall of rough metal at x = .3,
 * which a point of intensity 1 lights: the integral over the wall. */
static double wall_irradiance(struct vec3 lamp, double height, double width)
{
    const struct bsdf metal = {.color = {1, 1, 1},
                               .alpha = ALPHA,
                               .kind = MATERIAL_METAL,
                               .eta = 1};
    const int steps = 500;
    double sum = 0;

    for (int i = 0; i < steps; i++)
        for (int k = 0; k < steps; k++) {
            struct vec3 p = v3(.3f, (float)(height * (i + .5) / steps),
                               (float)(width * ((k + .5) / steps - .5)));
            struct vec3 to_lamp = v3_sub(lamp, p), wi = v3_unit(to_lamp);
            struct vec3 wo = v3_unit(v3_neg(p));
            float pdf;
            /* the normal is -x */
            double f = (double)bsdf_terms(&metal, v3(wo.z, wo.y, -wo.x),
                                          v3(wi.z, wi.y, -wi.x), &pdf)
                           .x;
            double there = f / (double)v3_dot(to_lamp, to_lamp);

            sum += there * (double)(-wo.y * -wo.x) / (double)v3_dot(p, p);
        }
    return sum * height * width / (steps * steps);
}

static void rough_walls_light_the_floor(void **state)
{
    const double height = .6, width = .8;
    const struct vec3 lamp = {-.1f, .5f, .1f};
    const struct point_light point = point_at(lamp, 1);
    double square = (double)v3_dot(lamp, lamp);
    double direct = (double)lamp.y / (square * sqrt(square));
    struct path_guide g = {.cells = NULL};
    struct lit_mesh s;
    struct claim c = {
        .eye = {-.03f, .1f, .02f},
        .at = {0, 0, 0},
        .truth = GREY(ALBEDO / M_PI *
                      (direct + wall_irradiance(lamp, height, width))),
        .paths = 4000,
        .without = NOT_BY_CHANCE,
    };

    (void)state;
    begin(&s, ALPHA);
    mesh_add_quad(&s.mesh, v3(.3f, 0, -.4f), v3(.3f, 0, .4f), v3(.3f, .6f, .4f),
                  v3(.3f, .6f, -.4f), 1);
    set_points(&s, &point, 1);
    build(&s, &g);
    s.mesh.world.settings.max_vertices = 3;
    check_claim(&s, c);
    end(&s, &g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_lobes_by_rough_metal_only),
        cmocka_unit_test(photons_obey_cones_and_profiles),
        cmocka_unit_test(lobes_aim_at_all_highlights),
        cmocka_unit_test(lobes_keep_the_mean),
        cmocka_unit_test(rough_walls_light_the_floor),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
