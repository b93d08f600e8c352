// SPDX-License-Identifier: MIT
/*
 * test_guide.c - the table of directions: its density, its samples, that any
 * table leaves pictures as bright as they are, and that the one that is built
 * points to where caustics come from
 */
#include "glim/guide.h"
#include "truth.h"

#define BINS (GUIDE_SIDE * GUIDE_SIDE)

/* Parts of the sphere: rows of equal cos(theta), columns of phi. */
#define ROWS    12
#define COLUMNS 24

/* A table of 2 x 2 x 2 cells on [-1, 1]^3, of which the last has no sums.
 * Half of the bins are empty, the others differ by up to 100 times. */
struct table {
    uint32_t cells[8];
    float sums[7 * BINS];
    struct guide guide;
};

static void table_init(struct table *t, double share, uint64_t seed)
{
    for (uint32_t cell = 0; cell < 7; cell++) {
        double flux[BINS], total = 0, sum = 0;

        for (int i = 0; i < BINS; i++) {
            double u = check_random(&seed);

            flux[i] = u < 0.5 ? 0 : pow(100, check_random(&seed));
            total += flux[i];
        }
        for (int i = 0; i < BINS; i++) {
            sum += flux[i];
            t->sums[cell * BINS + (uint32_t)i] = (float)(sum / total * share);
        }
        t->cells[cell] = cell * BINS;
    }
    t->cells[7] = NO_INDEX;
    t->guide = (struct guide){
        .grid = {.lo = {-1, -1, -1}, .cells_a_unit = 1, 2, 2, 2, 7},
        .cells = t->cells,
        .sums = t->sums};
}

static struct vec3 direction(double z, double phi)
{
    double r = sqrt(1 - z * z);

    return v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

static int part_of(struct vec3 d)
{
    int row = (int)((1 + (double)d.z) / 2 * ROWS);
    int column =
        (int)((1 + atan2((double)d.y, (double)d.x) / M_PI) / 2 * COLUMNS);

    row = row < ROWS ? row : ROWS - 1;
    return row * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1);
}

/* The integral of the density over each part, by midpoints. */
static double integrate(const struct world *w, double parts[ROWS * COLUMNS])
{
    enum { N = 100 };
    double step = 2.0 / ROWS / N * (2 * M_PI / COLUMNS / N);
    double sum = 0;

    for (int i = 0; i < ROWS * COLUMNS; i++)
        parts[i] = 0;
    for (int i = 0; i < ROWS * N; i++)
        for (int k = 0; k < COLUMNS * N; k++) {
            struct vec3 d =
                direction(2 * (i + 0.5) / (ROWS * N) - 1,
                          2 * M_PI * (k + 0.5) / (COLUMNS * N) - M_PI);
            double x = (double)guide_pdf(w, 0, d) * step;

            parts[i / N * COLUMNS + k / N] += x;
            sum += x;
        }
    return sum;
}

static void density_and_samples(void **state)
{
    enum { SAMPLES = 400000 };
    static double parts[ROWS * COLUMNS];
    static int counts[ROWS * COLUMNS];
    double share = 0.4, chi2 = 0;
    uint64_t random = 5;
    struct world w = {.settings = {.seed = 0}};
    struct table t;
    int degrees = -1;

    (void)state;
    table_init(&t, share, 1);
    guide_lend(&t.guide, &w);
    check_close(integrate(&w, parts), share, 1e-3 * share);
    check_close((double)guide_share(&w, 0), share, 1e-6);
    memset(counts, 0, sizeof counts);
    for (int i = 0; i < SAMPLES; i++) {
        float x = (float)(check_random(&random) * share * (1 - 1e-7));
        struct vec2 u = v2(x, (float)check_random(&random) * 0.999999f);
        struct vec3 d = guide_sample(&w, 0, u);

        check_close((double)v3_length(d), 1, 1e-6);
        counts[part_of(d)]++;
    }
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        double expected = parts[i] / share * SAMPLES;

        if (expected < 5) {
            check_at_most(counts[i], 30);
            continue;
        }
        chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
        degrees++;
    }
    assert_true(degrees > 200);
    /* beyond 5 standard deviations: 1 choice of seeds in a million, twice that
     * for the skew; the quadrature is off by less than a tenth of that */
    check_at_most(chi2, degrees + 5 * sqrt(2.0 * degrees));
}

/* Every cell's own sums; beside the grid those of the nearest. */
static void cells(void **state)
{
    struct world w = {.settings = {.seed = 0}};
    struct table t;

    (void)state;
    assert_int_equal(guide_at(&w, v3(0, 0, 0)), NO_INDEX);
    table_init(&t, 0.5, 1);
    guide_lend(&t.guide, &w);
    assert_int_equal(guide_at(&w, v3(-.5f, -.5f, -.5f)), 0);
    assert_int_equal(guide_at(&w, v3(.5f, -.5f, -.5f)), BINS);
    assert_int_equal(guide_at(&w, v3(-.5f, .5f, -.5f)), 2 * BINS);
    assert_int_equal(guide_at(&w, v3(-.5f, -.5f, .5f)), 4 * BINS);
    assert_int_equal(guide_at(&w, v3(.5f, .5f, .5f)), NO_INDEX);
    assert_int_equal(guide_at(&w, v3(9, -9, -9)), BINS);
}

/* In a closed box that emits 1 and has albedo a there is 1 / (1 - a) of light:
 * a table of nonsense finds that much. */
static void any_table_is_right(void **state)
{
    struct stage s = {.mesh = {.positions = NULL}};
    struct claim c = {.eye = {.2f, .1f, .4f},
                      .at = {-.3f, -1, .1f},
                      .truth = GREY(2),
                      .paths = 2000,
                      /* corners: the square of what they see is infinite */
                      .without = 1 << DIRECT_LIGHTS};
    struct table t;

    (void)state;
    for (int i = 0; i < MESH_MATERIALS; i++)
        s.mesh.materials[i] = mesh_material(MATERIAL_DIFFUSE, .5f);
    s.mesh.materials[0].emission = v3(1, 1, 1);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), 0);
    stage_finish(&s);
    table_init(&t, 0.7, 3);
    guide_lend(&t.guide, &s.mesh.world);
    check_claim(&s, c);
    stage_free(&s);
}

/* A small lamp beside a wall, which hangs above a floor; kind is the wall's. */
static void lamp_and_wall(struct stage *s, enum material_kind kind)
{
    *s = (struct stage){.mesh = {.positions = NULL}};
    s->mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, .5f);
    s->mesh.materials[1] = mesh_material((uint32_t)kind, .9f);
    s->mesh.materials[2] = mesh_material(MATERIAL_DIFFUSE, 0);
    s->mesh.materials[2].emission = v3(9, 9, 9);
    mesh_add_quad(&s->mesh, v3(-.5f, 0, -.5f), v3(-.5f, 0, .5f),
                  v3(.5f, 0, .5f), v3(.5f, 0, -.5f), 0);
    mesh_add_quad(&s->mesh, v3(-.5f, 0, -.5f), v3(-.5f, 0, .5f),
                  v3(-.5f, .9f, .5f), v3(-.5f, .9f, -.5f), 1);
    mesh_add_quad(&s->mesh, v3(-.4f, .4f, -.02f), v3(-.4f, .4f, .02f),
                  v3(-.36f, .42f, .02f), v3(-.36f, .42f, -.02f), 2);
    stage_finish(s);
    lights_lend(&s->lights, &s->mesh.world);
}

static void built(struct stage *s, struct guide *g)
{
    struct error err;

    check_or_say(guide_build(g, &s->mesh.world, &err), err.text);
}

/* On the floor the light that the mirror throws comes from the lamp's image. */
static void mirrors_point_to_images(void **state)
{
    struct vec3 image = {-.62f, .41f, 0};
    struct guide g = {.cells = NULL};
    struct stage s;
    int found = 0;

    (void)state;
    lamp_and_wall(&s, MATERIAL_METAL);
    s.mesh.materials[1].alpha = 0;
    built(&s, &g);
    guide_lend(&g, &s.mesh.world);
    for (float x = -.4f; x < .45f; x += .1f) {
        struct vec3 p = v3(x, 0, 0);
        uint32_t cell = guide_at(&s.mesh.world, p);
        struct vec3 d = v3_unit(v3_sub(image, p));
        double sure = 0;
        uint64_t random = 1;

        if (cell == NO_INDEX)
            continue;
        for (int i = 0; i < 1000; i++) {
            float u = (float)check_random(&random) * .999f *
                      guide_share(&s.mesh.world, cell);
            struct vec3 way = guide_sample(&s.mesh.world, cell,
                                           v2(u, (float)check_random(&random)));

            /* a bin is .25 wide, a cell of .1 is seen under less */
            sure += v3_dot(way, d) > cosf(.35f) ? .001 : 0;
        }
        check_at_most(.9, sure);
        found++;
    }
    assert_true(found >= 6);
    guide_free(&g);
    stage_free(&s);
}

static void only_where_it_helps(void **state)
{
    struct guide g = {.cells = NULL}, again = {.cells = NULL};
    struct stage s;
    size_t count;

    (void)state;
    lamp_and_wall(&s, MATERIAL_DIFFUSE);
    built(&s, &g);
    assert_true(g.cells == NULL && g.sums == NULL && g.grid.width == 0);
    s.mesh.materials[1] = mesh_material(MATERIAL_METAL, .9f);
    s.mesh.materials[1].alpha = 1;
    built(&s, &g);
    assert_null(g.cells);
    s.mesh.materials[1].alpha = 0;
    built(&s, &g);
    built(&s, &again);
    count = (size_t)g.grid.cell_count * BINS;
    assert_true(count > 0);
    assert_memory_equal(&g.grid, &again.grid, sizeof g.grid);
    assert_memory_equal(g.sums, again.sums, count * sizeof *g.sums);
    s.mesh.world.settings.light_count = 0;
    built(&s, &g);
    assert_null(g.cells);
    guide_free(&again);
    stage_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_and_samples),
        cmocka_unit_test(cells),
        cmocka_unit_test(any_table_is_right),
        cmocka_unit_test(mirrors_point_to_images),
        cmocka_unit_test(only_where_it_helps),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
