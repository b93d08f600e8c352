// SPDX-License-Identifier: MIT
/* test_truth_rooms.c - light after many bounces: furnaces, mirrors, a radiosity
 * box */
#include "tests/unit/check.h"
#include "tests/unit/facets.h"
#include "tests/unit/lambert.h"
#include "tests/unit/truth.h"

enum { WALL, THING, LAMP, OTHER };

/* Where lamps meet in a corner, light samples have infinite variance. */
#define CORNERS (1 << DIRECT_LIGHTS)

/* Returns a claim about a room that emits everywhere; the seed chooses the
 * ray. */
static struct claim claim_within(double truth, uint64_t *seed)
{
    double at[6];

    for (int i = 0; i < 6; i++)
        at[i] = check_random(seed) - 0.5;
    return (struct claim){.eye = v3((float)at[0], (float)at[1], (float)at[2]),
                          .at = v3((float)at[3], (float)at[4], (float)at[5]),
                          .truth = GREY(truth),
                          .paths = 256,
                          .without = CORNERS};
}

/* The radiance is E (1 + rho + ... + rho^(d-1)) with d vertices, E / (1 - rho)
 * without a limit (1000 vertices suffice). */
static void closed_rooms_show_their_series(void **state)
{
    const double rhos[] = {0, 0.3, 0.8, 0.95};
    const uint32_t depths[] = {1, 2, 3, 7, 1000};
    uint64_t seed = 4;

    (void)state;
    for (size_t k = 0; k < sizeof rhos / sizeof *rhos; k++)
        for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
            double rho = rhos[k];
            struct claim c =
                claim_within(2 * (1 - pow(rho, depths[i])) / (1 - rho), &seed);
            struct lit_mesh s = {0};

            s.mesh.materials[WALL] =
                mesh_material(MATERIAL_DIFFUSE, (float)rho);
            s.mesh.materials[WALL].emission = v3(2, 2, 2);
            mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), WALL);
            s.mesh.world.settings.max_vertices = depths[i];
            lit_mesh_finish(&s);
            check_claim(&s, c);
            lit_mesh_free(&s);
        }
}

static const struct {
    uint32_t kind;
    float alpha;
} white_things[] = {{MATERIAL_METAL, 0.2f},   {MATERIAL_METAL, 0.6f},
                    {MATERIAL_PLASTIC, 0},    {MATERIAL_PLASTIC, 0.5f},
                    {MATERIAL_GLASS, 0},      {MATERIAL_GLASS, 0.5f},
                    {MATERIAL_THIN_GLASS, 0}, {MATERIAL_ROUGH_DIFFUSE, 1}};

#define THINGS (sizeof white_things / sizeof *white_things)

static struct material white_thing(size_t k)
{
    struct material m = mesh_material(white_things[k].kind, 1);

    m.alpha = white_things[k].alpha;
    m.specular = v3(0.04f, 0.04f, 0.04f);
    return m;
}

/* Energy tables are right to 3e-3 per use, and a path uses some four before a
 * wall ends it. */
#define TABLES 1.2e-2

/* White objects of all kinds are invisible in such a room. From inside glass,
 * radiance is its index squared times as great. */
static void white_things_vanish_in_rooms(void **state)
{
    (void)state;
    for (size_t k = 0; k < 2 * THINGS; k++) {
        bool within = k % 2 != 0;
        struct lit_mesh s = {0};

        if (within && white_things[k / 2].kind != MATERIAL_GLASS)
            continue;
        s.mesh.materials[WALL] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
        s.mesh.materials[WALL].emission = v3(2, 2, 2);
        s.mesh.materials[THING] = white_thing(k / 2);
        mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), WALL);
        mesh_add_sphere(&s.mesh, v3(0.1f, 0, 0.2f), 0.6f, 12, 20, THING);
        lit_mesh_finish(&s);
        check_claim(&s,
                    ((struct claim){.eye = within ? v3(0.2f, 0.1f, 0.2f)
                                                  : v3(-0.9f, 0.3f, -0.2f),
                                    .at = v3(0.1f, -0.2f, 0.1f),
                                    .truth = GREY(within ? 4 * 1.5 * 1.5 : 4),
                                    .systematic = TABLES,
                                    .paths = 512,
                                    .without = CORNERS}));
        lit_mesh_free(&s);
    }
}

/* If the walls have such surfaces, d vertices collect d E. */
static void white_walls_show_each_bounce(void **state)
{
    uint64_t seed = 21;

    (void)state;
    for (size_t k = 0; k < THINGS; k++) {
        struct claim c = claim_within(5 * 2, &seed);
        struct lit_mesh s = {0};

        if (white_things[k].kind == MATERIAL_GLASS ||
            white_things[k].kind == MATERIAL_THIN_GLASS)
            continue; /* these cannot be walls */
        c.paths = 512;
        c.systematic = TABLES;
        s.mesh.materials[WALL] = white_thing(k);
        s.mesh.materials[WALL].emission = v3(2, 2, 2);
        mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), WALL);
        s.mesh.world.settings.max_vertices = 5;
        lit_mesh_finish(&s);
        check_claim(&s, c);
        lit_mesh_free(&s);
    }
}

/* Between two mirrors, after k reflections each of which keeps F(cosine) by
 * Schlick's formula. With one vertex less nothing is visible. */
static void check_corridor(uint32_t k, uint32_t max_vertices, double truth)
{
    /* The mirrors are at x = +-1/2. The ray from the middle meets the k-th at z
     * = (k - 1/2) 3/4. */
    float end = 0.75f * (float)k + 0.1f;
    struct lit_mesh s = {0};

    s.mesh.materials[WALL] = mesh_material(MATERIAL_METAL, 0.7f);
    s.mesh.materials[LAMP] = lamp_material(3);
    for (int i = 0; i < 2; i++) {
        float x = i ? 0.5f : -0.5f;

        mesh_add_quad(&s.mesh, v3(x, -1, -1), v3(x, 1, -1), v3(x, 1, end),
                      v3(x, -1, end), WALL);
    }
    mesh_add_quad(&s.mesh, v3(-2, -1, end), v3(2, -1, end), v3(2, 1, end),
                  v3(-2, 1, end), LAMP);
    s.mesh.world.settings.max_vertices = max_vertices;
    lit_mesh_finish(&s);
    check_claim(&s, ((struct claim){.at = v3(0.8f, 0, 0.6f),
                                    .truth = GREY(truth),
                                    .paths = 2048}));
    lit_mesh_free(&s);
}

static void corridors_keep_a_power(void **state)
{
    const double f = 0.7 + 0.3 * pow(1 - 0.8, 5);

    (void)state;
    check_corridor(0, 1, 3);
    for (uint32_t k = 1; k <= 8; k++) {
        check_corridor(k, k, 0);
        check_corridor(k, k + 1, 3 * pow(f, k));
        check_corridor(k, 1000, 3 * pow(f, k));
    }
}

/* A floor is at the bottom of a shaft of perfect mirrors, which makes it
 * infinitely wide, below a pane and a lamp that fills the top. The pane
 * transmits T of diffuse light and reflects the rest: rho T / (1 - rho (1 -
 * T)). A sheet of two faces transmits (1 - R) / (1 + R), solid or thin. */
static void panes_dim_floors(void **state)
{
    const uint32_t kinds[] = {MATERIAL_GLASS, MATERIAL_THIN_GLASS};
    const double rho = 0.7;
    double t = 0;

    (void)state;
    for (int i = 0; i < 10000; i++) {
        double cosine = (i + 0.5) / 10000;
        double r = fresnel_by_angles(cosine, 1.5);

        t += 2 * cosine * (1 - r) / (1 + r) / 10000;
    }
    for (size_t k = 0; k < 2; k++) {
        double truth = 2 * rho * t / (1 - rho * (1 - t));
        struct lit_mesh s = {0};

        s.mesh.materials[WALL] = mesh_material(MATERIAL_METAL, 1);
        s.mesh.materials[THING] = mesh_material(kinds[k], 1);
        s.mesh.materials[LAMP] = lamp_material(2);
        s.mesh.materials[OTHER] = mesh_material(MATERIAL_DIFFUSE, (float)rho);
        mesh_add_box(&s.mesh, v3(-0.5f, -1, -0.5f), v3(0.5f, 2, 0.5f), WALL);
        if (kinds[k] == MATERIAL_GLASS)
            mesh_add_box(&s.mesh, v3(-1, 0.4f, -1), v3(1, 0.6f, 1), THING);
        else
            mesh_add_quad(&s.mesh, v3(-1, 0.5f, -1), v3(-1, 0.5f, 1),
                          v3(1, 0.5f, 1), v3(1, 0.5f, -1), THING);
        mesh_add_quad(&s.mesh, v3(-1, 0, -1), v3(-1, 0, 1), v3(1, 0, 1),
                      v3(1, 0, -1), OTHER);
        mesh_add_quad(&s.mesh, v3(-1, 1, -1), v3(-1, 1, 1), v3(1, 1, 1),
                      v3(1, 1, -1), LAMP);
        lit_mesh_finish(&s);
        check_claim(&s, ((struct claim){.eye = {0.1f, 0.3f, 0.2f},
                                        .at = {-0.2f, 0, 0.1f},
                                        .truth = GREY(truth),
                                        .paths = 1024}));
        lit_mesh_free(&s);
    }
}

/*
 * The radiosity of a box with walls at +-1 and a lamp in the middle of the
 * ceiling is computed with n x n patches per wall, form factors from their
 * middles to patches in closed form (Lambert's formula), and gathering bounce
 * by bounce.
 */
#define SIDES     6
#define PATCHES   (SIDES * 16 * 16)
#define CEILING   3 /* y = 1 */
#define GLOW      4
#define LAMP_HALF 0.75 /* a border of patches */

struct patch {
    struct receiver middle;
    struct vec3 corners[4];
    double radiance[3];
    int side;
    bool shines;
};

struct box {
    int count;
    struct patch patches[PATCHES];
    double factors[PATCHES * PATCHES];
};

static const double albedos[SIDES][3] = {{0.8, 0.1, 0.5}, {0.1, 0.8, 0.5},
                                         {0.7, 0.7, 0.5}, {0.6, 0.6, 0.5},
                                         {0.5, 0.7, 0.5}, {0.3, 0.9, 0.5}};

/* Returns a point of a side: side i is at -1 (even) or 1 (odd) on axis i /
 * 2. */
static struct vec3 place(int side, double a, double b)
{
    float wall = side % 2 ? 1 : -1, x = (float)a, y = (float)b;

    return side < 2   ? v3(wall, x, y)
           : side < 4 ? v3(y, wall, x)
                      : v3(x, y, wall);
}

/* Returns this point as a receiver, whose normal points into the box. */
static struct receiver receiver_at(int side, double a, double b)
{
    float n = side % 2 ? -1 : 1;
    struct receiver r = {place(side, a, b),
                         {side / 2 == 0 ? n : 0, side / 2 == 1 ? n : 0,
                          side / 2 == 2 ? n : 0},
                         false,
                         false};

    return r;
}

/* Returns the share of light scattered by a receiver on this side that arrives
 * at a patch. */
static double form_factor(const struct receiver *r, int side,
                          const struct patch *to)
{
    return side == to->side ? 0 : lambert(to->corners, 4, r) / M_PI;
}

static void box_init(struct box *box, int n)
{
    box->count = SIDES * n * n;
    for (int i = 0; i < box->count; i++) {
        struct patch *p = &box->patches[i];
        double h = 2.0 / n;
        double a = h * (i % n) - 1, b = h * (i / n % n) - 1;

        p->side = i / (n * n);
        p->middle = receiver_at(p->side, a + h / 2, b + h / 2);
        p->corners[0] = place(p->side, a, b);
        p->corners[1] = place(p->side, a + h, b);
        p->corners[2] = place(p->side, a + h, b + h);
        p->corners[3] = place(p->side, a, b + h);
        p->shines = p->side == CEILING && fabs(a + h / 2) < LAMP_HALF &&
                    fabs(b + h / 2) < LAMP_HALF;
    }
    for (int i = 0; i < box->count; i++)
        for (int j = 0; j < box->count; j++)
            box->factors[i * PATCHES + j] =
                form_factor(&box->patches[i].middle, box->patches[i].side,
                            &box->patches[j]);
}

/* Returns the radiance of all patches after this many bounces. */
static void box_solve(struct box *box, uint32_t bounces)
{
    static double next[PATCHES][3];

    for (int i = 0; i < box->count; i++)
        for (int k = 0; k < 3; k++)
            box->patches[i].radiance[k] = box->patches[i].shines ? GLOW : 0;
    for (uint32_t n = 0; n < bounces; n++) {
        memset(next, 0, sizeof next);
        for (int i = 0; i < box->count; i++)
            for (int j = 0; j < box->count; j++)
                for (int k = 0; k < 3; k++)
                    next[i][k] += box->factors[i * PATCHES + j] *
                                  box->patches[j].radiance[k];
        for (int i = 0; i < box->count; i++)
            for (int k = 0; k < 3; k++)
                if (!box->patches[i].shines)
                    box->patches[i].radiance[k] =
                        next[i][k] * albedos[box->patches[i].side][k];
    }
}

/* Returns the radiance of a point of a wall lit by the patches. */
static void box_shade(const struct box *box, const struct receiver *r, int side,
                      double radiance[3])
{
    radiance[0] = radiance[1] = radiance[2] = 0;
    for (int j = 0; j < box->count; j++)
        for (int k = 0; k < 3; k++)
            radiance[k] += form_factor(r, side, &box->patches[j]) *
                           box->patches[j].radiance[k] * albedos[side][k];
}

/* Adds a wall of nine quads; the middle one of the ceiling is a lamp. */
static void add_wall(struct mesh *m, int side, uint32_t material, uint32_t lamp)
{
    const double cuts[4] = {-1, -LAMP_HALF, LAMP_HALF, 1};

    for (int i = 0; i < 9; i++) {
        const double *x = &cuts[i % 3], *y = &cuts[i / 3];

        mesh_add_quad(m, place(side, x[0], y[0]), place(side, x[1], y[0]),
                      place(side, x[1], y[1]), place(side, x[0], y[1]),
                      i == 4 && side == CEILING ? lamp : material);
    }
}

/* Patches of half the size have a quarter of the error. The limit is
 * extrapolated from 8 and 16 patches per side, with a bound of its error. */
static void box_limit(struct box boxes[2], uint32_t bounces,
                      const struct receiver *r, int side, struct claim *c)
{
    double coarse[3], fine[3];

    box_shade(&boxes[0], r, side, coarse);
    box_shade(&boxes[1], r, side, fine);
    for (int k = 0; k < 3; k++) {
        c->truth[k] = fine[k] + (fine[k] - coarse[k]) / 3;
        c->systematic =
            fmax(c->systematic, fabs(fine[k] - coarse[k]) / 3 / c->truth[k]);
    }
    /* One bounce comes directly from the lamp, which is independent of the
     * patches. */
    check_at_most(c->systematic, bounces > 1 ? 2e-3 : 1e-10);
}

static void boxes_agree_with_radiosity(void **state)
{
    static struct box boxes[2];
    const uint32_t bounces[] = {1, 2, 4, 60};
    const double places[][2] = {{0.1, -0.3}, {-0.7, 0.45}, {0.3, 0.6}};
    struct lit_mesh s = {0};

    (void)state;
    box_init(&boxes[0], 8);
    box_init(&boxes[1], 16);
    for (int i = 0; i < SIDES; i++) {
        s.mesh.materials[i] = mesh_material(MATERIAL_DIFFUSE, 0);
        s.mesh.materials[i].color =
            v3((float)albedos[i][0], (float)albedos[i][1],
               (float)albedos[i][2]);
        add_wall(&s.mesh, i, (uint32_t)i, SIDES);
    }
    s.mesh.materials[SIDES] = lamp_material(GLOW);
    lit_mesh_finish(&s);
    for (size_t i = 0; i < sizeof bounces / sizeof *bounces; i++) {
        bool is_limited = bounces[i] < 60;

        box_solve(&boxes[0], bounces[i] - 1);
        box_solve(&boxes[1], bounces[i] - 1);
        s.mesh.world.settings.max_vertices = is_limited ? bounces[i] + 1 : 1000;
        for (int side = 0; side < SIDES; side += 2) {
            struct receiver r =
                receiver_at(side, places[side / 2][0], places[side / 2][1]);
            struct claim c = {.eye = {0.1f, -0.2f, 0.3f},
                              .at = r.p,
                              .paths = 2048};

            box_limit(boxes, bounces[i], &r, side, &c);
            check_claim(&s, c);
        }
    }
    lit_mesh_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_rooms_show_their_series),
        cmocka_unit_test(white_things_vanish_in_rooms),
        cmocka_unit_test(white_walls_show_each_bounce),
        cmocka_unit_test(corridors_keep_a_power),
        cmocka_unit_test(panes_dim_floors),
        cmocka_unit_test(boxes_agree_with_radiosity),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
