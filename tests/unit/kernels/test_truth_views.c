// SPDX-License-Identifier: MIT
/* test_truth_views.c - pictures and light from files: images on surfaces, on
 * lamps and on the sky, and the blur of a lamp by the lens */
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"
#include "session/session.h"
#include "tests/unit/files.h"
#include "tests/unit/truth.h"
#include "world/world.h"

#define SPP 64

/* A decoded image of numbers in [0, 1]; row 0 is the top. */
struct picture {
    int width, height;
    double texels[32][64];
};

/* IEC 61966-2-1. */
static double srgb_decoded(uint8_t byte)
{
    double c = byte / 255.0;

    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* Writes grey noise as 24-bit Targa with the top row first. */
static void write_noise(const char *path, struct picture *p, uint64_t seed)
{
    uint8_t bytes[18 + 3 * 64 * 32] = {[2] = 2,
                                       [12] = (uint8_t)p->width,
                                       [14] = (uint8_t)p->height,
                                       [16] = 24,
                                       [17] = 0x20};

    for (int i = 0; i < p->width * p->height; i++) {
        uint8_t grey = (uint8_t)(256 * check_random(&seed));

        memset(bytes + 18 + 3 * i, grey, 3);
        p->texels[i / p->width][i % p->width] = srgb_decoded(grey);
    }
    put_bytes(path, bytes, (size_t)(18 + 3 * p->width * p->height));
}

/* Returns the mean over SEEDS renders of the scene with this view, and its
 * standard error, of each pixel's red. */
static void render_means(const char *scene, const char *view, double *means,
                         double *errors)
{
    struct options o = {.scene_path = scene,
                        .view_path = view,
                        .max_bounces = -1,
                        .batch = true};
    struct session s;
    struct render_job job = {.host = &s.engine.world, .limits.spp = SPP};
    struct error err;
    float *rgb;
    int count;

    check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
    for (int i = 0; i < s.engine.report.entry_count; i++)
        print_error("%s\n", s.engine.report.entries[i].text);
    assert_int_equal(s.engine.report.entry_count, 0);
    job.crop.width = s.edit.now.view.width_px;
    job.crop.height = s.edit.now.view.height_px;
    count = s.edit.now.view.width_px * s.edit.now.view.height_px;
    rgb = calloc((size_t)count * 3, sizeof *rgb);
    assert_non_null(rgb);
    memset(means, 0, (size_t)count * sizeof *means);
    memset(errors, 0, (size_t)count * sizeof *errors);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        check_or_say(world_lend(&s.engine.world, &s.engine.scene,
                                &s.edit.now.view, seed, &job.world, &err),
                     err.text);
        check_or_say(render_start(s.engine.render, &job, &err), err.text);
        assert_true(render_wait(s.engine.render, 300000));
        assert_int_equal(render_progress(s.engine.render).non_finite, 0);
        film_linear(render_film(s.engine.render), rgb);
        for (int i = 0; i < count; i++) {
            double x = (double)rgb[3 * i];

            means[i] += x / SEEDS;
            errors[i] += x * x / SEEDS;
        }
    }
    for (int i = 0; i < count; i++)
        errors[i] =
            sqrt(fmax(errors[i] - means[i] * means[i], 0) / (SEEDS - 1));
    free(rgb);
    session_close(&s);
}

/* The systematic error is relative. */
static void check_pixel(int i, double mean, double error, double truth,
                        double systematic)
{
    double allowed = T_LIMIT * error + systematic * truth;

    if (fabs(mean - truth) <= allowed)
        return;
    print_error("pixel %d: got %.7g, want %.7g, off by %.3g, allowed %.3g\n", i,
                mean, truth, fabs(mean - truth), allowed);
    _fail(__FILE__, __LINE__);
}

static double texel_wrapped(const struct picture *p, int column, int row)
{
    return p->texels[(row + 8 * p->height) % p->height]
                    [(column + 8 * p->width) % p->width];
}

/* A lamp with an image fills the picture, one texel per pixel, repeated. The
 * mean of the bilinear look-up over a texel is 1/8, 3/4, 1/8 of its neighbour,
 * itself and its other neighbour along each axis. */
static void texels_fill_their_pixels(void **state)
{
    enum { WIDTH = 16, HEIGHT = 6 };
    const double shares[3] = {1.0 / 8, 3.0 / 4, 1.0 / 8};
    static double means[WIDTH * HEIGHT], errors[WIDTH * HEIGHT];
    struct picture p = {.width = 8, .height = 4};

    (void)state;
    write_noise("noise.tga", &p, 17);
    put("noise.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n"
                     "map_Ke noise.tga\n");
    /* u is from 0 to 2, v from -1/2 at the bottom to 1. */
    put("noise.obj", "mtllib noise.mtl\nv 2 4 0\nv 18 4 0\nv 18 10 0\n"
                     "v 2 10 0\nvt 0 -.5\nvt 2 -.5\nvt 2 1\nvt 0 1\n"
                     "usemtl lamp\nf 1/1 2/2 3/3 4/4\n");
    put("noise.view", "eye 10 7 3\nat 10 7 0\nup 0 1 0\nfovy 90\nres 16 6\n");
    render_means("noise.obj", "noise.view", means, errors);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double truth = 0;

        for (int k = 0; k < 9; k++)
            truth +=
                shares[k % 3] * shares[k / 3] *
                texel_wrapped(&p, i % WIDTH + k % 3 - 1, i / WIDTH + k / 3 - 1);
        check_pixel(i, means[i], errors[i], truth, 1e-5);
    }
}

/* Bilinear look-up at u to the right and v down in texels from the upper left
 * corner of the image. Columns repeat; rows repeat or end. */
static double look_up(const struct picture *p, double u, double v, bool ends)
{
    double column = floor(u - 0.5), row = floor(v - 0.5);
    double sum = 0;

    for (int k = 0; k < 4; k++) {
        double dx = u - 0.5 - column, dy = v - 0.5 - row;
        int x = (int)column + k % 2, y = (int)row + k / 2;

        if (ends)
            y = y < 0 ? 0 : y < p->height ? y : p->height - 1;
        sum += (k % 2 ? dx : 1 - dx) * (k / 2 ? dy : 1 - dy) *
               texel_wrapped(p, x, y);
    }
    return sum;
}

static void write_dome(const char *path, struct picture *p)
{
    static float bytes[3 * 64 * 32];
    FILE *f = fopen(path, "wb");

    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            double l = 1.6 + 0.6 * sin(2 * M_PI * x / p->width) +
                       0.3 * cos(4 * M_PI * (x + 3) / p->width) +
                       3 * exp(-pow(x - 20, 2) / 9.0 - pow(y - 9, 2) / 4.0) -
                       0.02 * y;

            p->texels[y][x] = (double)(float)l;
            /* a PFM begins with the bottom row */
            for (int k = 0; k < 3; k++)
                bytes[3 * ((p->height - 1 - y) * p->width + x) + k] = (float)l;
        }
    assert_non_null(f);
    fprintf(f, "PF\n%d %d\n-1\n", p->width, p->height);
    fwrite(bytes, 12, (size_t)(p->width * p->height), f);
    assert_int_equal(fclose(f), 0);
}

/* Returns the sky's radiance in a direction of the world: +y is up, the image's
 * middle column looks along -z, columns grow towards +x, and the sky is rotated
 * about +y. */
static double dome_radiance(const struct picture *p, const double d[3],
                            double angle)
{
    double x = cos(angle) * d[0] - sin(angle) * d[2];
    double z = sin(angle) * d[0] + cos(angle) * d[2];
    double r = hypot(hypot(x, z), d[1]);

    return look_up(p, (0.5 + atan2(x, -z) / (2 * M_PI)) * p->width,
                   acos(d[1] / r) / M_PI * p->height, true);
}

/* A view along an axis with fovy 90 degrees; `up` is another axis. */
struct axis_view {
    double at[3], right[3], up[3];
};

static void skies_have_the_right_orientation(void **state)
{
    enum { WIDTH = 16, HEIGHT = 12, FINE = 32 };
    const struct axis_view gazes[] = {{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
                                      {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                      {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}};
    const int angles_deg[] = {0, 35, 90, -120};
    static double means[WIDTH * HEIGHT], errors[WIDTH * HEIGHT];
    struct picture p = {.width = 64, .height = 32};

    (void)state;
    write_dome("dome.pfm", &p);
    put("speck.obj", "v 9 9 9\nv 9 9 9.001\nv 9 9.001 9\nf 1 2 3\n");
    for (size_t k = 0; k < sizeof gazes / sizeof *gazes; k++) {
        const struct axis_view *g = &gazes[k];
        char view[512];

        snprintf(view, sizeof view,
                 "eye 0 0 0\nat %g %g %g\nup %g %g %g\nfovy 90\nres %d %d\n"
                 "sky dome.pfm\nsky_strength 2\nsky_rotation %d\n",
                 g->at[0], g->at[1], g->at[2], g->up[0], g->up[1], g->up[2],
                 WIDTH, HEIGHT, angles_deg[k]);
        put("dome.view", view);
        render_means("speck.obj", "dome.view", means, errors);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            double truth = 0;

            for (int j = 0; j < FINE * FINE; j++) {
                double x = i % WIDTH + (j % FINE + 0.5) / FINE;
                double y = (double)(i / WIDTH) + (j / FINE + 0.5) / FINE;
                double sx = (2 * x - WIDTH) / HEIGHT;
                double sy = 1 - 2 * y / HEIGHT;
                double d[3];

                for (int c = 0; c < 3; c++)
                    d[c] = g->at[c] + sx * g->right[c] + sy * g->up[c];
                truth += 2 * dome_radiance(&p, d, angles_deg[k] * M_PI / 180) /
                         (FINE * FINE);
            }
            check_pixel(i, means[i], errors[i], truth, 2e-4);
        }
    }
}

/* Returns the share of a disk around 0 that a square around (x, y) covers. */
static double disk_covered(double radius, double x, double y, double half)
{
    enum { FINE = 64 };
    double left = fmax(x - half, -radius), right = fmin(x + half, radius);
    double area = 0;

    for (int i = 0; left < right && i < FINE; i++) {
        double at = left + (right - left) * (i + 0.5) / FINE;
        double chord = sqrt(radius * radius - at * at);

        area += fmax(fmin(y + half, chord) - fmax(y - half, -chord), 0) *
                (right - left) / FINE;
    }
    return area / (M_PI * radius * radius);
}

/* A small square lamp is out of focus, behind and before the focal plane. Each
 * pixel sees it through the part of the lens whose rays meet it. */
static void lamps_blur_by_the_lens(void **state)
{
    enum { SIDE = 32, FINE = 16 };
    const double radius = 1, distance = 6, half = 0.25, glow = 7;
    const double lamp[2] = {1.9, -1.6}, focuses[] = {3, 10};
    static double means[SIDE * SIDE], errors[SIDE * SIDE];

    (void)state;
    put("spot.mtl", "newmtl lamp\nKd 0 0 0\nKe 7 7 7\n");
    put("spot.obj",
        "mtllib spot.mtl\nv 101.65 48.15 0\nv 102.15 48.15 0\n"
        "v 102.15 48.65 0\nv 101.65 48.65 0\nusemtl lamp\nf 1 2 3 4\n");
    for (size_t k = 0; k < 2; k++) {
        double focus = focuses[k], shrink = 1 - distance / focus;
        double truths = 0, sum = 0, variance = 0;
        char view[256];

        snprintf(view, sizeof view,
                 "eye 100 50 6\nat 100 50 0\nup 0 1 0\nfovy 60\nres %d %d\n"
                 "aperture %g\nfocus %g\n",
                 SIDE, SIDE, 2 * radius, focus);
        put("spot.view", view);
        render_means("spot.obj", "spot.view", means, errors);
        for (int i = 0; i < SIDE * SIDE; i++) {
            double truth = 0;

            for (int j = 0; j < FINE * FINE; j++) {
                double x = i % SIDE + (j % FINE + 0.5) / FINE;
                double y = (double)(i / SIDE) + (j / FINE + 0.5) / FINE;
                double half_view = tan(30 * M_PI / 180) * distance;

                /* The ray from the lens point l arrives at shrink l + this. */
                x = (2 * x / SIDE - 1) * half_view;
                y = (1 - 2 * y / SIDE) * half_view;
                truth +=
                    glow *
                    disk_covered(radius, (lamp[0] - x) / shrink,
                                 (lamp[1] - y) / shrink, fabs(half / shrink)) /
                    (FINE * FINE);
            }
            /* Below some 25 hits the noise is not normal; the sum contains
             * these pixels. */
            if (truth * SPP * SEEDS >= 25 * glow || truth == 0)
                check_pixel(i, means[i], errors[i], truth, 2e-3);
            truths += truth;
            sum += means[i];
            variance += errors[i] * errors[i];
        }
        check_pixel(-1, sum, sqrt(variance), truths, 1e-3);
        check_at_most(sqrt(variance), PRECISION * truths);
    }
}

enum { FLOOR, LAMP };

#define ALBEDO 0.6

/* Returns the irradiance from a square lamp at y = 1/2, x and z within 1/2, by
 * midpoints. The radiance is a function of the place and the direction. */
static double square_irradiance(const struct receiver *r,
                                double (*radiance)(const struct picture *p,
                                                   double x, double z,
                                                   const double d[3]),
                                const struct picture *p)
{
    enum { FINE = 600 };
    double sum = 0;

    for (int i = 0; i < FINE * FINE; i++) {
        double x = (i % FINE + 0.5) / FINE - 0.5;
        double z = ((double)(i / FINE) + 0.5) / FINE - 0.5;
        double d[3] = {x - (double)r->p.x, 0.5 - (double)r->p.y,
                       z - (double)r->p.z};
        double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        double cosine = d[0] * (double)r->n.x + d[1] * (double)r->n.y +
                        d[2] * (double)r->n.z;

        sum += radiance(p, x, z, d) * fmax(cosine, 0) * fabs(d[1]) / (d2 * d2) /
               (FINE * FINE);
    }
    return sum;
}

static void add_floor(struct mesh *m, const struct receiver *r)
{
    add_receiver(m, r->p, r->n);
    m->materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
}

static void add_square(struct mesh *m)
{
    mesh_add_quad(m, v3(-0.5f, 0.5f, -0.5f), v3(0.5f, 0.5f, -0.5f),
                  v3(0.5f, 0.5f, 0.5f), v3(-0.5f, 0.5f, 0.5f), LAMP);
    m->materials[LAMP] = lamp_material(2);
}

static void check_floor(struct lit_mesh *s, const struct receiver *r,
                        double irradiance, double systematic)
{
    check_claim(s, ((struct claim){.eye = eye_over(r->p, r->n),
                                   .at = r->p,
                                   .truth = GREY(ALBEDO / M_PI * irradiance),
                                   .systematic = systematic,
                                   .paths = 1024}));
}

static const struct receiver receivers[] = {
    {{0, 0, 0}, {0, 1, 0}, false, false},
    {{0.3f, 0.2f, -0.2f}, {-0.6f, 0.8f, 0}, false, false},
    {{0.2f, 0.9f, 0.1f}, {0, -0.8f, 0.6f}, false, false}};

#define RECEIVERS (sizeof receivers / sizeof *receivers)
#define REPEATS   1.5

static double image_radiance(const struct picture *p, double x, double z,
                             const double d[3])
{
    (void)d;
    return 2 * look_up(p, (x + 0.5) * REPEATS * p->width,
                       (1 - (z + 0.5) * REPEATS) * p->height, false);
}

/* A lamp with an image lights a floor. */
static void lamps_with_images_light_the_floor(void **state)
{
    static const struct vec2 uvs[4] = {{0, 0},
                                       {(float)REPEATS, 0},
                                       {(float)REPEATS, (float)REPEATS},
                                       {0, (float)REPEATS}};
    const struct texture texture = {.width = 8, .height = 4, .scale = {1, 1}};
    struct picture p = {.width = 8, .height = 4};
    uint32_t texels[32];
    float decoded[256];
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 256; i++)
        decoded[i] = (float)srgb_decoded((uint8_t)i);
    for (int i = 0; i < 32; i++) {
        uint32_t grey = (uint32_t)(256 * check_random(&seed));

        texels[i] = grey | grey << 8 | grey << 16 | 255u << 24;
        p.texels[i / 8][i % 8] = srgb_decoded((uint8_t)grey);
    }
    for (size_t k = 0; k < RECEIVERS; k++) {
        const uint32_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};
        struct lit_mesh s = {0};

        add_floor(&s.mesh, &receivers[k]);
        add_square(&s.mesh);
        for (int t = 0; t < 2; t++)
            memcpy(s.mesh.tris[s.mesh.tri_count - 2 + (uint32_t)t].vt,
                   corners[t], sizeof corners[t]);
        s.mesh.materials[LAMP].emission_texture = 0;
        s.mesh.world.settings.features = FEATURE_TEXTURES;
        s.mesh.world.uvs = uvs;
        s.mesh.world.textures = &texture;
        s.mesh.world.texels = texels;
        s.mesh.world.linear_of_srgb = decoded;
        lit_mesh_finish(&s);
        check_floor(&s, &receivers[k],
                    square_irradiance(&receivers[k], image_radiance, &p), 1e-4);
        lit_mesh_free(&s);
    }
}

#define TURN 0.9 /* rotation of the sky in rad */

/* The radiance is linear in the direction before the rotation. */
static double linear_radiance(const double d[3])
{
    return 1 + 0.4 * d[0] + 0.3 * d[1] - 0.2 * d[2];
}

/* Returns the light of a lamp of radiance 2 less that of the sky behind it. */
static double lamp_less_sky(const struct picture *p, double x, double z,
                            const double d[3])
{
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double turned[3] = {(cos(TURN) * d[0] - sin(TURN) * d[2]) / length,
                              d[1] / length,
                              (sin(TURN) * d[0] + cos(TURN) * d[2]) / length};

    (void)p;
    (void)x;
    (void)z;
    return 2 - linear_radiance(turned);
}

/* The irradiance of a sky a + b.d is pi a + 2 pi / 3 b.n; also tests it with a
 * lamp before it. */
static void skies_light_floors_by_the_closed_form(void **state)
{
    enum { WIDTH = 256, HEIGHT = 128 };
    static struct vec3 texels[WIDTH * HEIGHT];

    (void)state;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double theta = M_PI * ((double)(i / WIDTH) + 0.5) / HEIGHT;
        double phi = 2 * M_PI * ((i % WIDTH + 0.5) / WIDTH - 0.5);
        const double d[3] = {sin(theta) * sin(phi), cos(theta),
                             -sin(theta) * cos(phi)};
        float l = (float)linear_radiance(d);

        texels[i] = v3(l, l, l);
    }
    for (size_t k = 0; k < 2 * RECEIVERS; k++) {
        const struct receiver *r = &receivers[k / 2];
        double x = (double)r->n.x, z = (double)r->n.z;
        double irradiance = M_PI + 2 * M_PI / 3 *
                                       (0.4 * (cos(TURN) * x - sin(TURN) * z) +
                                        0.3 * (double)r->n.y -
                                        0.2 * (sin(TURN) * x + cos(TURN) * z));
        struct lit_mesh s = {0};

        add_floor(&s.mesh, r);
        if (k % 2) {
            add_square(&s.mesh);
            irradiance += square_irradiance(r, lamp_less_sky, NULL);
        }
        s.mesh.world.sky_texels = texels;
        s.mesh.world.settings.sky =
            (struct sky){.color = {1, 1, 1},
                         .width = WIDTH,
                         .height = HEIGHT,
                         .rotation_sin = (float)sin(TURN),
                         .rotation_cos = (float)cos(TURN)};
        lit_mesh_finish(&s);
        /* The error is (pi / 128)^2 / 8 of the slope between four texels,
         * twice. */
        check_floor(&s, r, irradiance, 2e-4);
        lit_mesh_free(&s);
    }
}

static int remove_files(void **state)
{
    const char *const names[] = {"noise.tga",  "noise.mtl", "noise.obj",
                                 "noise.view", "dome.pfm",  "dome.view",
                                 "speck.obj",  "spot.mtl",  "spot.obj",
                                 "spot.view"};

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return leave_empty_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_fill_their_pixels),
        cmocka_unit_test(skies_have_the_right_orientation),
        cmocka_unit_test(lamps_blur_by_the_lens),
        cmocka_unit_test(lamps_with_images_light_the_floor),
        cmocka_unit_test(skies_light_floors_by_the_closed_form),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_files);
}
