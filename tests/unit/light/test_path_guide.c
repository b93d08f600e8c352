// SPDX-License-Identifier: MIT
/*
 * test_path_guide.c - sampling of a random guide: its density, its samples, and
 * means of pictures, which no guide changes
 */
#include "tests/unit/light/guide_lookup.h"
#include "tests/unit/truth.h"
#include "world/light/path_guide.h"

/* The sphere is divided into rows of equal cos(theta) and columns of phi. */
#define ROWS    12
#define COLUMNS 24

/* A grid of 2 x 2 x 2 cells on [-1, 1]^3. The last cell has no table, and
 * neither have surfaces that face down. Half of the bins are empty; the others
 * differ by up to 100 times. */
struct table {
    struct guide_cell cells[8 * GUIDE_FACINGS];
    float sums[7 * GUIDE_BINS];
    struct path_guide guide;
};

static void table_init(struct table *t, double share, uint64_t seed)
{
    for (uint32_t cell = 0; cell < 7; cell++) {
        double flux[GUIDE_BINS], total = 0, sum = 0;

        for (int i = 0; i < GUIDE_BINS; i++) {
            double u = check_random(&seed);

            flux[i] = u < 0.5 ? 0 : pow(100, check_random(&seed));
            total += flux[i];
        }
        for (int i = 0; i < GUIDE_BINS; i++) {
            sum += flux[i];
            t->sums[cell * GUIDE_BINS + (uint32_t)i] =
                (float)(sum / total * share);
        }
    }
    for (uint32_t i = 0; i < 8 * GUIDE_FACINGS; i++) {
        bool has_none = i / GUIDE_FACINGS == 7 || i % GUIDE_FACINGS == 3;
        uint32_t first = i / GUIDE_FACINGS * GUIDE_BINS;

        t->cells[i] =
            has_none ? guide_cell_none() : (struct guide_cell){first, first};
    }
    t->guide = (struct path_guide){
        .grid = {.lo = {-1, -1, -1}, .cells_per_unit = 1, 2, 2, 2, 7},
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

/* Integrates the density over each part by midpoints. */
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

static void samples_follow_the_density(void **state)
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
    path_guide_lend(&t.guide, &w);
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
    /* The limit of 5 standard deviations is exceeded by one choice of seeds in
     * a million, twice that for the skewness. The quadrature's error is below a
     * tenth of one. */
    check_at_most(chi2, degrees + 5 * sqrt(2.0 * degrees));
}

/* Every cell has its own table. A point outside the grid uses the nearest
 * cell. */
static void each_cell_has_its_own_table(void **state)
{
    struct vec3 up = v3_unit(v3(.3f, .5f, -.4f));
    struct world w = {.settings = {.seed = 0}};
    struct table t;

    (void)state;
    assert_int_equal(scatter_table_at(&w, v3(0, 0, 0), up), NO_INDEX);
    table_init(&t, 0.5, 1);
    path_guide_lend(&t.guide, &w);
    assert_int_equal(scatter_table_at(&w, v3(-.5f, -.5f, -.5f), up), 0);
    assert_int_equal(scatter_table_at(&w, v3(.5f, -.5f, -.5f), up), GUIDE_BINS);
    assert_int_equal(scatter_table_at(&w, v3(-.5f, .5f, -.5f), up),
                     2 * GUIDE_BINS);
    assert_int_equal(scatter_table_at(&w, v3(-.5f, -.5f, .5f), up),
                     4 * GUIDE_BINS);
    assert_int_equal(scatter_table_at(&w, v3(.5f, .5f, .5f), up), NO_INDEX);
    assert_int_equal(scatter_table_at(&w, v3(9, -9, -9), up), GUIDE_BINS);
    assert_int_equal(scatter_table_at(&w, v3(9, -9, -9), v3_neg(up)), NO_INDEX);
    assert_int_equal(scatter_table_at(&w, v3(9, -9, -9), v3(-.8f, -.6f, 0)),
                     GUIDE_BINS);
}

/* Draws light samples of a sky of radiance 1, by the cosine or by the table of
 * its image, with and without a random guide. Compares moments over the upper
 * hemisphere. */
static void light_samples_of_a_flat_sky_are_unbiased(void **state)
{
    enum { SAMPLES = 400000 };
    const struct receiver r = {{-.5f, -.5f, -.5f}, {.6f, .8f, 0}, false, false};
    const double truths[3] = {M_PI, 2 * M_PI / 3, 0};
    struct vec3 image[8];
    struct world w = {.settings = {.sky = {.color = {1, 1, 1},
                                           .rotation_cos = 1}},
                      .sky_texels = image};
    struct sky_table tables[2] = {{.sums = NULL}};
    struct table t;
    struct error err;
    uint64_t random = 11;

    (void)state;
    table_init(&t, 0.4, 7);
    path_guide_lend(&t.guide, &w);
    for (int i = 0; i < 8; i++)
        image[i] = v3(1, 1, 1);
    check_or_say(sky_table_build(&tables[1], image, 4, 2, SKY_ALONE, &err),
                 err.text);
    for (int way = 0; way < 4; way++) {
        bool guided = way % 2 == 1;
        double sums[3] = {0, 0, 0}, squares[3] = {0, 0, 0};

        w.settings.sky.width = way < 2 ? 0 : 4;
        w.settings.sky.height = way < 2 ? 0 : 2;
        sky_table_lend(&tables[way / 2], &w);
        for (int i = 0; i < SAMPLES; i++) {
            struct vec2 u[2];
            struct light_sample s;
            double x[3];

            for (int k = 0; k < 2; k++)
                u[k] = v2((float)check_random(&random) * 0.999999f,
                          (float)check_random(&random) * 0.999999f);
            if (!light_sample(&w, &r, guided ? sky_at(&w, r.p, r.n) : NO_INDEX,
                              u[0], u[1], &s) ||
                v3_dot(s.wi, r.n) < 0.0f)
                continue; /* below the surface */
            x[0] = (double)s.radiance.x / (double)s.pdf *
                   (double)v3_dot(s.wi, r.n);
            x[1] = x[0] * (double)v3_dot(s.wi, r.n);
            x[2] = x[0] * (double)s.wi.z;
            for (int k = 0; k < 3; k++) {
                sums[k] += x[k];
                squares[k] += x[k] * x[k];
            }
        }
        /* The limit of 5 standard deviations is exceeded once in 300,000
         * choices of seeds. */
        for (int k = 0; k < 3; k++) {
            double mean = sums[k] / SAMPLES;
            double variance = fmax(squares[k] / SAMPLES - mean * mean, 0);

            check_close(mean, truths[k], 5 * sqrt(variance / SAMPLES) + 1e-5);
        }
    }
    sky_table_free(&tables[1]);
}

/* In a closed box with emission 1 and albedo a the radiance is 1 / (1 - a) for
 * any guide, so a random one finds it too. */
static void random_tables_keep_the_mean(void **state)
{
    struct lit_mesh s = {.mesh = {.positions = NULL}};
    struct claim c = {.eye = {.2f, .1f, .4f},
                      .at = {-.3f, -1, .1f},
                      .truth = GREY(2),
                      .paths = 2000,
                      /* near corners light samples have infinite variance */
                      .without = 1 << DIRECT_LIGHTS};
    struct table t;

    (void)state;
    for (int i = 0; i < MESH_MATERIALS; i++)
        s.mesh.materials[i] = mesh_material(MATERIAL_DIFFUSE, .5f);
    s.mesh.materials[0].emission = v3(1, 1, 1);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), 0);
    lit_mesh_finish(&s);
    table_init(&t, 0.7, 3);
    path_guide_lend(&t.guide, &s.mesh.world);
    check_claim(&s, c);
    lit_mesh_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_follow_the_density),
        cmocka_unit_test(light_samples_of_a_flat_sky_are_unbiased),
        cmocka_unit_test(each_cell_has_its_own_table),
        cmocka_unit_test(random_tables_keep_the_mean),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
