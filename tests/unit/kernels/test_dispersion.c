// SPDX-License-Identifier: MIT
/*
 * test_dispersion.c - indices of glass at wavelengths, wavelengths of paths,
 * and what dispersive glass reflects and transmits
 */
#include "tests/unit/facets.h"
#include "tests/unit/truth.h"

#include "kernels/dispersion.h"

enum { GLASS, LAMP, BLACK };

static struct material glass_of(double ior, double abbe)
{
    struct material m = mesh_material(MATERIAL_GLASS, 1);

    m.ior = (float)ior;
    m.dispersion = (float)((ior - 1) / abbe);
    return m;
}

static double channel(struct vec3 v, int k)
{
    return (double)(k == 0 ? v.x : k == 1 ? v.y : v.z);
}

/* Angle between light before and after a prism of 50 degrees. */
static double deviation_deg(double incidence_deg, double ior)
{
    const double apex = 50 * M_PI / 180;
    double in = incidence_deg * M_PI / 180;
    double out = asin(ior * sin(apex - asin(sin(in) / ior)));

    return (in + out - apex) * 180 / M_PI;
}

/* The numbers are of another program, by the equation of glTF. */
static void indices_are_those_of_the_equation(void **state)
{
    static const double truth[][3] = {
        /* wavelength, index, deviation at an incidence of 43.207426 degrees */
        {486.1, 1.6397082154114297, 37.73705260256697},
        {587.6, 1.619995409665631, 36.41454756870192},
        {656.3, 1.6115155613182155, 35.853378674035824},
    };
    struct material m = glass_of(1.62, 22);

    (void)state;
    for (int i = 0; i < 3; i++) {
        double ior = (double)ior_at(&m, (float)truth[i][0]);

        check_close(ior, truth[i][1], 3e-7);
        check_close(deviation_deg(43.207426, ior), truth[i][2], 3e-5);
    }
    m = glass_of(1.2, 0.5); /* never below 1 */
    check_close((double)ior_at(&m, 720), 1, 0);
}

/* Responses at two wavelengths against those of CIE's tables. */
static void responses_are_those_of_the_observer(void **state)
{
    static const struct {
        int channel, nm[2];
        double xyz[2][3];
    } cases[] = {
        {0, {650, 600}, {{.2835, .1070, 0}, {1.0622, .6310, .0008}}},
        {1, {500, 550}, {{.0049, .3230, .2720}, {.4334, .9950, .0087}}},
        {2, {500, 450}, {{.0049, .3230, .2720}, {.3362, .0380, 1.7721}}},
    };
    static const double rec709[3][3] = {{3.2405, -1.5371, -.4985},
                                        {-.9693, 1.8760, .0416},
                                        {.0556, -.2040, 1.0572}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        const double *row = rec709[cases[i].channel];
        double want[2] = {0, 0}, got[2];

        for (int w = 0; w < 2; w++) {
            uint32_t node =
                (uint32_t)(((float)cases[i].nm[w] - WAVELENGTH_MIN) /
                           WAVELENGTH_STEP);

            for (int k = 0; k < 3; k++)
                want[w] += row[k] * cases[i].xyz[w][k];
            got[w] = channel(response_node(node), cases[i].channel);
        }
        check_close(got[0] / got[1], want[0] / want[1], 0.02);
    }
}

/* Draws n wavelengths of light with this weight. *mean becomes that of their
 * weights. */
static double mean_wavelength(struct vec3 weight, int n, double mean[3])
{
    double sum = 0;

    mean[0] = mean[1] = mean[2] = 0;
    for (int i = 0; i < n; i++) {
        struct vec3 w = weight;
        float l = wavelength_draw(&w, (float)((i + 0.5) / n));

        assert_true(l >= WAVELENGTH_MIN && l <= 720);
        assert_true(w.x >= 0 && w.y >= 0 && w.z >= 0);
        check_close((double)(w.x + w.y + w.z),
                    (double)(weight.x + weight.y + weight.z), 1e-5);
        sum += (double)l / n;
        for (int k = 0; k < 3; k++)
            mean[k] += channel(w, k) / n;
    }
    return sum;
}

/* The mean over all wavelengths is the weight before, in every channel, and
 * their density is the mixture of the responses. */
static void weights_have_the_mean_of_before(void **state)
{
    static const struct vec3 weights[] = {{1, 1, 1},        {1, 0, 0},
                                          {0, 1, 0},        {0, 0, 1},
                                          {2, 1, 0},        {0, 1, 3},
                                          {0.1f, 1, 0.001f}};
    double mean[3];

    (void)state;
    for (size_t i = 0; i < sizeof weights / sizeof weights[0]; i++) {
        struct vec3 w = weights[i];
        double sum = (double)(w.x + w.y + w.z), moment = 0;
        double got = mean_wavelength(w, 100000, mean);

        for (int k = 0; k < 3; k++)
            check_close(mean[k], channel(w, k), 2e-5 * sum);
        for (uint32_t node = 0; node < RESPONSE_NODES; node++)
            moment += (double)v3_dot(w, response_node(node)) * node / sum /
                      (RESPONSE_NODES - 1);
        check_close(got,
                    (double)WAVELENGTH_MIN + (double)WAVELENGTH_STEP * moment,
                    0.05);
    }
    /* light that is black stays so */
    assert_true(isfinite(mean_wavelength(v3(0, 0, 0), 10, mean)));
    assert_true(mean[0] == 0 && mean[1] == 0 && mean[2] == 0);
}

/* Steps of integrals over the spectrum. */
#define SPECTRUM_STEPS (8 * (RESPONSE_NODES - 1))

static float step_nm(int i)
{
    return WAVELENGTH_MIN + WAVELENGTH_STEP * ((float)i + 0.5f) / 8;
}

/* Share of a step in the response of a channel. */
static double step_share(int i, int k)
{
    uint32_t node = (uint32_t)i / 8;
    float x = ((float)(i % 8) + 0.5f) / 8;

    return channel(v3_lerp(response_node(node), response_node(node + 1), x),
                   k) /
           SPECTRUM_STEPS;
}

/* Integrates the response of a channel times the light that a pane transmits,
 * in whose inside all reflections are summed. */
static double pane_transmits(const struct material *m, double cosine, int k)
{
    double sum = 0;

    for (int i = 0; i < SPECTRUM_STEPS; i++) {
        double f = fresnel_by_angles(cosine, (double)ior_at(m, step_nm(i)));

        sum += step_share(i, k) * (1 - f) / (1 + f);
    }
    return sum;
}

/* A pane before a lamp, solid or thin. Blue is reflected more than red. */
static void panes_transmit_by_wavelength(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        double cosine = i < 2 ? 1 : 0.4, sine = sqrt(1 - cosine * cosine);
        struct claim c = {.eye = v3((float)(-2 * sine), 0, (float)(2 * cosine)),
                          .paths = 4096};
        struct material m = glass_of(1.5, 2);
        struct lit_mesh s = {0};

        s.mesh.materials[GLASS] = m;
        s.mesh.materials[LAMP] = lamp_material(1);
        if (i % 2 == 0) {
            mesh_add_box(&s.mesh, v3(-50, -50, -0.4f), v3(50, 50, 0), GLASS);
        } else {
            s.mesh.materials[GLASS].kind = MATERIAL_THIN_GLASS;
            mesh_add_quad(&s.mesh, v3(-50, -50, 0), v3(50, -50, 0),
                          v3(50, 50, 0), v3(-50, 50, 0), GLASS);
        }
        mesh_add_quad(&s.mesh, v3(-60, -60, -1), v3(60, -60, -1),
                      v3(60, 60, -1), v3(-60, 60, -1), LAMP);
        lit_mesh_finish(&s);
        for (int k = 0; k < 3; k++)
            c.truth[k] = pane_transmits(&m, cosine, k);
        assert_true(c.truth[0] > c.truth[2] + 0.03);
        check_claim(&s, c);
        lit_mesh_free(&s);
    }
}

/* A lamp behind a rough pane, off the axis, is as bright in each channel with
 * light samples as without. */
static void rough_panes_are_lit_at_the_wavelength(void **state)
{
    struct claim c = {.eye = {0, 0, 2}, .paths = 1 << 14};
    struct lit_mesh s = {0};
    struct estimate by[2];

    (void)state;
    s.mesh.materials[GLASS] = glass_of(1.5, 2);
    s.mesh.materials[GLASS].alpha = 0.3f;
    s.mesh.materials[LAMP] = lamp_material(1);
    mesh_add_box(&s.mesh, v3(-50, -50, -0.4f), v3(50, 50, 0), GLASS);
    mesh_add_quad(&s.mesh, v3(0.2f, -1, -1), v3(2, -1, -1), v3(2, 1, -1),
                  v3(0.2f, 1, -1), LAMP);
    lit_mesh_finish(&s);
    for (int i = 0; i < 2; i++) {
        lit_mesh_lend(&s, i == 0 ? DIRECT_MIS : DIRECT_BSDF);
        by[i] = claim_estimate(&s.mesh.world, &c);
    }
    for (int k = 0; k < 3; k++) {
        check_at_most(by[0].error[k] + by[1].error[k], 0.02 * by[0].mean[k]);
        check_close(by[0].mean[k], by[1].mean[k],
                    T_LIMIT * hypot(by[0].error[k], by[1].error[k]));
    }
    lit_mesh_free(&s);
}

/* ---- a prism, whose section has its apex at the origin ---- */

#define HALF_APEX (25 * M_PI / 180)
#define INCIDENCE (43.207426 * M_PI / 180)
#define SCREEN_X  3

/* Returns what goes straight through the prism. *y becomes the height at which
 * it meets the screen. Light enters the middle of the left face; angles are
 * those to the x axis. */
static double prism_transmits(double ior, double *y)
{
    double x = -0.5 * sin(HALF_APEX), inside, in, angle, length;

    *y = -0.5 * cos(HALF_APEX);
    inside = asin(sin(INCIDENCE) / ior) - HALF_APEX;
    in = HALF_APEX - inside;
    angle = HALF_APEX - asin(ior * sin(in));
    /* up to the right face, x = -y tan(HALF_APEX) */
    length = -(x + *y * tan(HALF_APEX)) /
             (cos(inside) + sin(inside) * tan(HALF_APEX));
    x += length * cos(inside);
    *y += length * sin(inside);
    *y += (SCREEN_X - x) * tan(angle);
    return (1 - fresnel_by_angles(cos(INCIDENCE), ior)) *
           (1 - fresnel_by_angles(cos(in), 1 / ior));
}

/* A lamp stands where light of less than 560 nm leaves a prism. Its base is
 * black, so that nothing comes back from it. */
static void prisms_part_light_by_wavelength(void **state)
{
    const float s = (float)sin(HALF_APEX), c = (float)cos(HALF_APEX);
    const float angle = (float)(INCIDENCE - HALF_APEX);
    struct material m = glass_of(1.62, 22);
    struct claim claim = {.paths = 4096};
    struct lit_mesh l = {0};
    double edge, y;

    (void)state;
    prism_transmits((double)ior_at(&m, 560), &edge);
    claim.at = v3(-0.5f * s, -0.5f * c, 0);
    claim.eye = v3_sub(claim.at, v3(cosf(angle), sinf(angle), 0));
    l.mesh.materials[GLASS] = m;
    l.mesh.materials[LAMP] = lamp_material(1);
    l.mesh.materials[BLACK] = mesh_material(MATERIAL_DIFFUSE, 0);
    mesh_add_quad(&l.mesh, v3(0, 0, 1), v3(0, 0, -1), v3(-s, -c, -1),
                  v3(-s, -c, 1), GLASS);
    mesh_add_quad(&l.mesh, v3(0, 0, -1), v3(0, 0, 1), v3(s, -c, 1),
                  v3(s, -c, -1), GLASS);
    mesh_add_quad(&l.mesh, v3(-s, -c, 1), v3(-s, -c, -1), v3(s, -c, -1),
                  v3(s, -c, 1), BLACK);
    mesh_add_quad(&l.mesh, v3(SCREEN_X, (float)edge - 0.4f, -1),
                  v3(SCREEN_X, (float)edge - 0.4f, 1),
                  v3(SCREEN_X, (float)edge, 1), v3(SCREEN_X, (float)edge, -1),
                  LAMP);
    lit_mesh_finish(&l);
    for (int i = 0; i < SPECTRUM_STEPS; i++) {
        double light = prism_transmits((double)ior_at(&m, step_nm(i)), &y);

        for (int k = 0; k < 3; k++)
            claim.truth[k] += y < edge ? step_share(i, k) * light : 0;
    }
    check_claim(&l, claim);
    lit_mesh_free(&l);
}

/* A ball of this material at the origin in a white sky. */
static void open_furnace(struct mesh *m, struct material material)
{
    *m = (struct mesh){0};
    m->materials[GLASS] = material;
    m->world.settings.sky.color = v3(1, 1, 1);
    m->world.settings.features = FEATURES_ALL;
    mesh_add_sphere(m, v3(0, 0, 0), 0.5f, 60, 100, GLASS);
    mesh_finish(m);
}

static struct path_sample furnace_path(const struct mesh *m, uint64_t index,
                                       struct first_surface *surface)
{
    struct ray r = {v3(0.2f, 0.1f, 2), v3(0, 0, -1), FLOAT_MAX, 0, 0};

    return trace_path(&m->world, r, sampler_start(1, 1, index, 5), surface);
}

/* White stays white: no channel gains or loses light, in rough glass no more
 * than without dispersion. */
static void furnaces_are_white(void **state)
{
    enum { PATHS = 1 << 15 };

    (void)state;
    for (int i = 0; i < 3; i++) {
        double means[2][3] = {{0}};

        for (int has_dispersion = 0; has_dispersion < 2; has_dispersion++) {
            struct material m = glass_of(1.8, has_dispersion ? 10 : 1e9);
            struct mesh furnace;

            m.alpha = i == 1 ? 0.2f : 0;
            if (i == 2) {
                m.kind = MATERIAL_PRINCIPLED;
                m.transmission = 1;
            }
            open_furnace(&furnace, m);
            for (uint64_t p = 0; p < PATHS; p++) {
                struct first_surface surface;
                struct path_sample s = furnace_path(&furnace, p, &surface);

                for (int k = 0; k < 3; k++)
                    means[has_dispersion][k] += channel(s.radiance, k) / PATHS;
            }
            mesh_free(&furnace);
        }
        for (int k = 0; k < 3; k++)
            check_close(means[1][k], means[0][k], 0.006);
        if (i != 1)
            check_close(means[0][0], 1, 1e-5);
    }
}

/* Glass of an index that is matched at n_d only counts as clear. */
static void first_surfaces_have_no_wavelength(void **state)
{
    struct material m = glass_of(1.0005, 0.2);
    struct mesh furnace;

    (void)state;
    m.alpha = 0.3f;
    open_furnace(&furnace, m);
    for (uint64_t i = 0; i < 200; i++) {
        struct first_surface s;

        furnace_path(&furnace, i, &s);
        assert_int_equal(s.state, SURFACE_AHEAD);
    }
    mesh_free(&furnace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_are_those_of_the_equation),
        cmocka_unit_test(responses_are_those_of_the_observer),
        cmocka_unit_test(weights_have_the_mean_of_before),
        cmocka_unit_test(panes_transmit_by_wavelength),
        cmocka_unit_test(rough_panes_are_lit_at_the_wavelength),
        cmocka_unit_test(prisms_part_light_by_wavelength),
        cmocka_unit_test(furnaces_are_white),
        cmocka_unit_test(first_surfaces_have_no_wavelength),
    };

    return cmocka_run_group_tests_name("dispersion", tests, NULL, NULL);
}
