// SPDX-License-Identifier: MIT
/*
 * test_path_guide.c - the table of directions: its density, its samples, that
 * any table leaves pictures as bright as they are, and that the one that is
 * built points to where caustics come from, and to windows
 */
#include "light/path_guide.h"
#include "light/triangle_cdf.h"
#include "tests/unit/truth.h"

/* The sphere is divided into rows of equal cos(theta) and columns of phi. */
#define ROWS    12
#define COLUMNS 24

/* A grid of 2 x 2 x 2 cells on [-1, 1]^3. The last cell has no table, and
 * neither have surfaces that face down. Half of the bins are empty; the others
 * differ by up to 100 times. */
struct table {
    struct guide_cell each_cell_has_its_own_table[8 * GUIDE_FACINGS];
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

        t->each_cell_has_its_own_table[i] =
            has_none ? guide_cell_none() : (struct guide_cell){first, first};
    }
    t->guide = (struct path_guide){
        .grid = {.lo = {-1, -1, -1}, .cells_per_unit = 1, 2, 2, 2, 7},
        .each_cell_has_its_own_table = t->each_cell_has_its_own_table,
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

static uint32_t scatter_table_at(const struct world *w, struct vec3 p,
                                 struct vec3 n)
{
    return guide_at(w, p, n).scatter;
}

static uint32_t sky_at(const struct world *w, struct vec3 p, struct vec3 n)
{
    return guide_at(w, p, n).sky;
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
    const struct receiver r = {{-.5f, -.5f, -.5f}, {.6f, .8f, 0}, false};
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
    struct stage s = {.mesh = {.positions = NULL}};
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
    stage_finish(&s);
    table_init(&t, 0.7, 3);
    path_guide_lend(&t.guide, &s.mesh.world);
    check_claim(&s, c);
    stage_free(&s);
}

/* Makes a small lamp beside a wall of this kind, above a floor. */
static void make_lamp_and_wall(struct stage *s, enum material_kind kind)
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

/* Returns the lights that the world uses. */
static const struct lights *lent_lights(const struct stage *s)
{
    static const struct lights none = {.light_count = 0};

    return s->mesh.world.settings.light_count > 0 ? &s->lights : &none;
}

static void build_guide(struct stage *s, float sky, struct path_guide *g)
{
    struct error err;

    path_guide_outdate(g);
    check_or_say(path_guide_update(g, &s->mesh.wide_world, lent_lights(s),
                                   (double)sky, NULL, &err),
                 err.text);
}

/* On the floor, light reflected by the mirror comes from the lamp's image. */
static void mirrors_guide_to_the_lamp_s_image(void **state)
{
    struct vec3 image = {-.62f, .41f, 0};
    struct path_guide g = {.each_cell_has_its_own_table = NULL};
    struct stage s;
    int found = 0;

    (void)state;
    make_lamp_and_wall(&s, MATERIAL_METAL);
    s.mesh.materials[1].alpha = 0;
    build_guide(&s, 0, &g);
    path_guide_lend(&g, &s.mesh.world);
    for (float x = -.4f; x < .45f; x += .1f) {
        struct vec3 p = v3(x, 0, 0);
        uint32_t cell = scatter_table_at(&s.mesh.world, p, v3(0, 1, 0));
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

            /* A bin is .25 wide, and a cell of .1 subtends less. */
            sure += v3_dot(way, d) > cosf(.35f) ? .001 : 0;
        }
        check_at_most(.9, sure);
        found++;
    }
    assert_true(found >= 6);
    path_guide_free(&g);
    stage_free(&s);
}

static void tables_exist_only_with_caustics(void **state)
{
    struct path_guide g = {.each_cell_has_its_own_table = NULL},
                      again = {.each_cell_has_its_own_table = NULL};
    struct stage s;
    size_t count;

    (void)state;
    make_lamp_and_wall(&s, MATERIAL_DIFFUSE);
    build_guide(&s, 0, &g);
    assert_true(g.each_cell_has_its_own_table == NULL && g.sums == NULL);
    s.mesh.materials[1] = mesh_material(MATERIAL_METAL, .9f);
    s.mesh.materials[1].alpha = 1;
    build_guide(&s, 0, &g);
    assert_null(g.each_cell_has_its_own_table);
    s.mesh.materials[1].alpha = 0;
    build_guide(&s, 0, &g);
    build_guide(&s, 0, &again);
    count = (size_t)g.grid.table_count * GUIDE_BINS;
    assert_true(count > 0);
    assert_memory_equal(&g.grid, &again.grid, sizeof g.grid);
    assert_memory_equal(g.sums, again.sums, count * sizeof *g.sums);
    s.mesh.world.settings.light_count = 0;
    build_guide(&s, 0, &g);
    assert_null(g.each_cell_has_its_own_table);
    path_guide_free(&again);
    stage_free(&s);
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
static void make_room(struct stage *s, bool has_pane)
{
    struct mesh *m = &s->mesh;
    const float *y = window[0], *z = window[1];

    *s = (struct stage){.mesh = {.positions = NULL}};
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
        struct path_guide g = {.each_cell_has_its_own_table = NULL};
        struct stage s;
        struct world *w = &s.mesh.world;
        int found = 0;

        make_room(&s, has_pane);
        stage_finish(&s);
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
        stage_free(&s);
    }
}

/* Returns the standard error of the floor's radiance under a sky of 1. */
static double noise(struct stage *s, const struct path_guide *g)
{
    const struct claim c = {.eye = {.6f, .1f, .4f},
                            .at = {.1f, -1, .1f},
                            .paths = 1000};

    stage_gather(s, DIRECT_MIS);
    path_guide_lend(g, &s->mesh.world);
    return claim_estimate(&s->mesh.world, &c).error[0];
}

/* The whiter the walls, the more light arrives by reflection. Then the share of
 * guided samples is smaller, and zero where it would gain little. */
static void white_rooms_are_guided_less(void **state)
{
    const struct path_guide none = {.each_cell_has_its_own_table = NULL};

    (void)state;
    for (int has_pane = 0; has_pane < 2; has_pane++) {
        double shares[2] = {0, 0};

        for (int is_white = 0; is_white < 2; is_white++) {
            struct vec3 p = {.1f, -1, .1f}, up = {0, 1, 0};
            struct path_guide g = {.each_cell_has_its_own_table = NULL};
            uint32_t first;
            struct stage s;

            make_room(&s, has_pane);
            s.mesh.materials[2].emission = v3(0, 0, 0);
            s.mesh.world.settings.sky.color = v3(1, 1, 1);
            stage_finish(&s);
            build_guide(&s, 1, &g); /* of grey walls */
            s.mesh.materials[0] =
                mesh_material(MATERIAL_DIFFUSE, is_white ? .98f : .3f);
            path_guide_recolor(&g);
            check_or_say(path_guide_update(&g, &s.mesh.wide_world,
                                           lent_lights(&s), 1, NULL, NULL),
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
            stage_free(&s);
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
        struct path_guide g = {.each_cell_has_its_own_table = NULL};
        struct claim c = {.eye = {.6f, .1f, .4f},
                          .at = {.1f, -1, .1f},
                          .truth = GREY(1),
                          .paths = 2000,
                          /* behind panes light samples see no sky */
                          .without = 1 << DIRECT_LIGHTS};
        struct stage s;

        make_room(&s, has_pane);
        s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, .7f);
        s.mesh.materials[0].emission = v3(.3f, .3f, .3f);
        s.mesh.world.settings.sky.color = v3(1, 1, 1);
        stage_finish(&s);
        build_guide(&s, 1, &g); /* as if only the sky emitted light */
        assert_true(g.grid.table_count > 0);
        path_guide_lend(&g, &s.mesh.world);
        check_claim(&s, c);
        path_guide_free(&g);
        stage_free(&s);
    }
}

static void tables_exist_only_where_the_sky_is_hidden(void **state)
{
    struct path_guide g = {.each_cell_has_its_own_table = NULL};
    struct error err;
    struct stage s;

    (void)state;
    make_room(&s, false);
    stage_finish(&s);
    build_guide(&s, 0, &g);
    assert_null(g.each_cell_has_its_own_table);
    check_or_say(path_guide_update(&g, &s.mesh.wide_world, lent_lights(&s), 1,
                                   NULL, &err),
                 err.text);
    assert_non_null(g.each_cell_has_its_own_table);
    check_or_say(path_guide_update(&g, &s.mesh.wide_world, lent_lights(&s), 0,
                                   NULL, &err),
                 err.text);
    assert_null(g.each_cell_has_its_own_table);
    lights_lend(&s.lights, &s.mesh.world);
    build_guide(&s, 1, &g);
    assert_non_null(g.each_cell_has_its_own_table);
    build_guide(&s, 1e-4f, &g); /* the lamp is much brighter */
    assert_null(g.each_cell_has_its_own_table);
    stage_free(&s);

    make_room(&s, true);
    s.mesh.materials[1] = mesh_material(MATERIAL_DIFFUSE, .5f);
    stage_finish(&s);
    build_guide(&s, 1, &g); /* an opaque pane */
    assert_null(g.each_cell_has_its_own_table);
    stage_free(&s);

    s = (struct stage){.mesh = {.positions = NULL}};
    s.mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, .5f);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_quad(&s.mesh, v3(-9, -1, -9), v3(-9, -1, 9), v3(9, -1, 9),
                  v3(9, -1, -9), 0);
    stage_finish(&s);
    build_guide(&s, 1, &g);
    for (uint32_t i = 0; i < s.mesh.world.settings.tri_count; i++) {
        struct vec3 p[3];

        tri_corners(&s.mesh.world, i, p);
        path_guide_lend(&g, &s.mesh.world);
        assert_int_equal(sky_at(&s.mesh.world, p[0], v3(0, 1, 0)), NO_INDEX);
    }
    path_guide_free(&g);
    stage_free(&s);
}

/* Tables for caustics and for windows have the same bits. */
static void thread_counts_give_the_same_tables(void **state)
{
    struct error err;
    struct pool *pool = pool_create(3, &err);

    (void)state;
    assert_non_null(pool);
    for (int sky = 0; sky < 2; sky++) {
        struct path_guide alone = {.each_cell_has_its_own_table = NULL},
                          together = {.each_cell_has_its_own_table = NULL};
        struct stage s;

        if (sky == 1) {
            make_room(&s, false);
            stage_finish(&s);
        } else {
            make_lamp_and_wall(&s, MATERIAL_METAL);
        }
        build_guide(&s, (float)sky, &alone);
        check_or_say(path_guide_update(&together, &s.mesh.wide_world,
                                       lent_lights(&s), sky, pool, &err),
                     err.text);
        assert_non_null(alone.each_cell_has_its_own_table);
        assert_int_equal(alone.grid.table_count, together.grid.table_count);
        assert_memory_equal(alone.each_cell_has_its_own_table,
                            together.each_cell_has_its_own_table,
                            guide_cell_count(&alone.grid) *
                                sizeof *alone.each_cell_has_its_own_table);
        assert_memory_equal(alone.sums, together.sums,
                            alone.grid.table_count * GUIDE_BINS *
                                sizeof *alone.sums);
        path_guide_free(&alone);
        path_guide_free(&together);
        stage_free(&s);
    }
    pool_destroy(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thread_counts_give_the_same_tables),
        cmocka_unit_test(samples_follow_the_density),
        cmocka_unit_test(light_samples_of_a_flat_sky_are_unbiased),
        cmocka_unit_test(each_cell_has_its_own_table),
        cmocka_unit_test(random_tables_keep_the_mean),
        cmocka_unit_test(mirrors_guide_to_the_lamp_s_image),
        cmocka_unit_test(tables_exist_only_with_caustics),
        cmocka_unit_test(guided_directions_lead_to_the_window),
        cmocka_unit_test(white_rooms_are_guided_less),
        cmocka_unit_test(guided_rooms_keep_the_mean),
        cmocka_unit_test(tables_exist_only_where_the_sky_is_hidden),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
