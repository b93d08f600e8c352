// SPDX-License-Identifier: MIT
/*
 * extremes.h - random scenes of extreme numbers, rendered by all backends
 *
 * Scene n is a function of n. It is written as text into the current folder,
 * loaded like any file, and rendered on the CPU with each instruction set, and
 * perhaps on a device. No finite numbers in a file may cause a crash, a sample
 * that is not finite, pictures with different bits, or a render of more than
 * 10 s. Nor may they cause a filtered picture or a stated error that is not
 * finite, or stated errors that are too low.
 *
 * Units:     file units, radiance
 * Ownership: extremes_close() frees all and removes the files
 * Threads:   one
 * Errors:    a failure of the machine ends the program
 */
#ifndef TESTS_EXTREMES_H
#define TESTS_EXTREMES_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "film/film_error.h"
#include "film/filter/film_filter.h"
#include "render/cpu_dispatch.h"
#include "render/opencl/backend_cl.h"
#include "render/opencl/cl_api.h"
#include "session/session.h"
#include "tests/unit/check.h"
#include "tests/unit/npy_file.h"
#include "world/world.h"

#define EXTREMES_RENDERERS 5
#define EXTREMES_SIDE      8
#define EXTREMES_SPP       2

/* Longest render, in milliseconds. */
#define EXTREMES_LIMIT_MS 10000

/* Renders of each fourth scene with seeds of their own, and samples a pixel of
 * each, to compare the stated error with their spread; and the deviations by
 * which it may be too low: chance exceeds them once in 1e6 scenes. */
#define EXTREMES_SEEDS       16
#define EXTREMES_STATED_SPP  4
#define EXTREMES_DEVIATIONS  7.5
#define EXTREMES_EACH_STATED 4

struct extremes {
    struct backend *backends[EXTREMES_RENDERERS]; /* the device is the last */
    struct render *renders[EXTREMES_RENDERERS];
    int count;
    bool has_device;
    /* counts so far */
    uint32_t scenes, refused, on_device;
    uint64_t samples, saturated;
};

static inline uint32_t one_of(uint64_t *seed, uint32_t count)
{
    return (uint32_t)(check_random(seed) * count);
}

/* Returns a number with any exponent of a float, or beyond. */
static inline double any_size(uint64_t *seed)
{
    return pow(10, -50 + 100 * check_random(seed));
}

static inline double coordinate(uint64_t *seed)
{
    static const double odd[] = {0,     -0.0,  1e-45,  -1e-45, 1.2e-38,
                                 1e-20, 1e-9,  1e6,    -1e9,   1e18,
                                 -1e19, 1e30,  -1e38,  3.4e38, -3.4e38,
                                 5e38,  1e300, -1e300, 1,      -1};
    double sign = check_random(seed) < 0.5 ? -1 : 1;

    switch (one_of(seed, 8)) {
    case 0: return odd[one_of(seed, sizeof odd / sizeof *odd)];
    case 1: return sign * any_size(seed);
    default: return 2 * check_random(seed) - 1;
    }
}

/* Returns a number from 0 on, mostly below 1. */
static inline double amount(uint64_t *seed)
{
    static const double odd[] = {0,      1,    1e-45, 1e-38, 1e-10,  0.999999,
                                 1e6,    1e10, 4e18,  1e19,  1e30,   3e38,
                                 3.4e38, 1e39, 1e300, 0.5,   1.0001, 2};

    switch (one_of(seed, 4)) {
    case 0: return odd[one_of(seed, sizeof odd / sizeof *odd)];
    case 1: return any_size(seed);
    default: return check_random(seed);
    }
}

static inline FILE *extremes_file(const char *name)
{
    FILE *f = fopen(name, "wb");

    if (f == NULL)
        exit(2);
    return f;
}

/* Writes four texels, one of them transparent, and a sky with all kinds of
 * floats. */
static inline void put_images(void)
{
    static const unsigned char tga[] = {0, 0, 2,   0,   0,   0, 0,  0,   0,
                                        0, 0, 0,   2,   0,   2, 0,  32,  8,
                                        0, 0, 0,   255, 255, 9, 99, 255, 1,
                                        2, 3, 255, 50,  60,  7, 0};
    static const float sky[] = {0, 1,     3.4e38f, 1e-45f, 1e10f, 0,
                                1, 1e-3f, 0,       3e38f,  1,     1e30f};
    FILE *f = extremes_file("t.tga");

    fwrite(tga, 1, sizeof tga, f);
    fclose(f);
    f = extremes_file("sky.pfm");
    fprintf(f, "PF\n2 2\n-1\n");
    fwrite(sky, sizeof sky, 1, f);
    fclose(f);
}

static inline void put_words(FILE *f, const char *key, int count,
                             double (*number)(uint64_t *), uint64_t *seed)
{
    fprintf(f, "%s", key);
    while (count-- > 0)
        fprintf(f, " %.9g", number(seed));
}

static inline void put_numbers(FILE *f, const char *key, int count,
                               double (*number)(uint64_t *), uint64_t *seed)
{
    put_words(f, key, count, number, seed);
    fprintf(f, "\n");
}

/* Returns the mean cosine of scattering, often an end of its range. */
static inline double cosine(uint64_t *seed)
{
    return fmax(-1, fmin(2.5 * check_random(seed) - 1.25, 1));
}

/* Writes what fills a body, in most cases of one without a surface. */
static inline void put_any_medium(FILE *f, uint64_t *seed)
{
    static const char *const colors[] = {"Tf_scatter", "Tf_absorb",
                                         "Tf_attenuation", "Tf_albedo",
                                         "Tf_multiscatter"};
    bool is_by_distance = check_random(seed) < 0.3;

    fprintf(f, "illum 7\n");
    if (check_random(seed) < 0.7)
        fprintf(f, "Ni 1\nTf 1\nKe 0\nd 1\n");
    for (int i = is_by_distance ? 2 : 0; i < (is_by_distance ? 5 : 2); i++)
        if (check_random(seed) < 0.8)
            put_numbers(f, colors[i], check_random(seed) < 0.5 ? 1 : 3, amount,
                        seed);
    if (is_by_distance)
        put_numbers(f, "Tf_distance", 1, amount, seed);
    put_numbers(f, "Tf_anisotropy", 1, cosine, seed);
}

/* Writes each statement of a colour or number with this probability. */
static inline void put_any_statements(FILE *f, double probability,
                                      uint64_t *seed)
{
    for (size_t i = 0; i < MTL_PROPERTIES; i++) {
        const struct mtl_property *p = &mtl_properties[i];
        bool is_cosine =
            strcmp(p->key, "Sg") == 0 || strcmp(p->key, "Tf_anisotropy") == 0;

        if (check_random(seed) < probability && strcmp(p->key, "illum") != 0)
            put_numbers(f, p->key,
                        p->is_color && check_random(seed) < 0.5 ? 3 : 1,
                        is_cosine ? cosine : amount, seed);
    }
}

static inline void put_any_material(FILE *f, int number, uint64_t *seed)
{
    static const char *const maps[] = {"map_Kd", "map_Ks",  "map_Ke",
                                       "map_Pr", "map_Pm",  "map_d",
                                       "norm",   "map_Bump"};

    fprintf(f, "newmtl m%d\nillum %d\n", number, (int)one_of(seed, 11));
    put_any_statements(f, check_random(seed) < 0.5 ? 0.15 : 0.4, seed);
    if (check_random(seed) < 0.5)
        put_numbers(f, "Ke", 3, amount, seed);
    if (check_random(seed) < 0.1)
        fprintf(f, "Ke_blackbody %g %.9g\n", 500 + 5000 * check_random(seed),
                amount(seed));
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (check_random(seed) < 0.1)
            fprintf(f, "%s -o %.9g %.9g -s %.9g %.9g t.tga\n", maps[i],
                    coordinate(seed), coordinate(seed), coordinate(seed),
                    coordinate(seed));
    if (check_random(seed) < 0.2)
        put_any_medium(f, seed);
    if (check_random(seed) < 0.1) {
        fprintf(f, "illum 2\nd 1\nPm 0\n");
        put_numbers(f, "Sf", 1, amount, seed);
        put_numbers(f, "Sr", 3, amount, seed);
    }
}

static inline void put_faces(FILE *f, int materials, int vertices,
                             uint64_t *seed)
{
    int count = 1 + (int)one_of(seed, 20);

    while (count-- > 0) {
        int corners = one_of(seed, 4) == 0 ? 4 : 3;
        uint32_t kind = one_of(seed, 4);

        fprintf(f, "usemtl m%d\nf", (int)one_of(seed, (uint32_t)materials));
        for (int i = 0; i < corners; i++) {
            int v = 1 + (int)one_of(seed, (uint32_t)vertices);

            if (kind == 0)
                fprintf(f, " %d", v);
            else if (kind == 1)
                fprintf(f, " %d//%d", v, v);
            else
                fprintf(f, " %d/%d%s", v, v, kind == 2 ? "" : "/1");
        }
        fprintf(f, "\n");
    }
}

static inline void put_scene(uint64_t *seed)
{
    int materials = 1 + (int)one_of(seed, 5);
    int vertices = 4 + (int)one_of(seed, 20);
    FILE *f = extremes_file("a.mtl");

    for (int i = 0; i < materials; i++)
        put_any_material(f, i, seed);
    fclose(f);
    f = extremes_file("a.obj");
    fprintf(f, "mtllib a.mtl\n");
    for (int i = 0; i < vertices; i++) {
        put_numbers(f, "v", 3, coordinate, seed);
        put_numbers(f, "vn", 3, coordinate, seed);
        put_numbers(f, "vt", 2, coordinate, seed);
    }
    put_faces(f, materials, vertices, seed);
    fclose(f);
}

/* Returns a number in the range of the view's key. */
static inline double up_to_1e30(uint64_t *seed)
{
    return fmin(amount(seed), 1e30);
}

static inline double place(uint64_t *seed)
{
    return fmax(-1e30, fmin(coordinate(seed), 1e30));
}

static inline void put_any_fog(FILE *f, uint64_t *seed)
{
    put_words(f, "fog scatter", 3, up_to_1e30, seed);
    put_words(f, " absorb", 3, up_to_1e30, seed);
    put_words(f, " anisotropy", 1, cosine, seed);
    if (check_random(seed) < 0.5) {
        put_words(f, " height", 1, place, seed);
        put_words(f, " falloff", 1, up_to_1e30, seed);
    }
    fprintf(f, "\n");
}

/* Writes a grid of at most 20 voxels on a side, in half of the cases with
 * numbers of any size. */
static inline void put_any_grid(const char *name, uint64_t *seed)
{
    uint32_t size[3] = {1 + one_of(seed, 20), 1 + one_of(seed, 12),
                        1 + one_of(seed, 3)};
    static float numbers[20 * 12 * 3];
    bool is_extreme = check_random(seed) < 0.5;
    size_t size_bytes;
    char *bytes;
    FILE *f = extremes_file(name);

    for (uint32_t i = 0; i < size[0] * size[1] * size[2]; i++)
        numbers[i] =
            (float)(is_extreme ? coordinate(seed) : check_random(seed));
    bytes = npy_file_of(size, numbers, &size_bytes);
    fwrite(bytes, 1, size_bytes, f);
    fclose(f);
    free(bytes);
}

/* Writes a smoke in a box around the middle of the scene, or anywhere. */
static inline void put_any_smoke(FILE *f, uint64_t *seed)
{
    const char *name = check_random(seed) < 0.5 ? "a.npy" : "b.npy";

    fprintf(f, "medium %s", name);
    put_any_grid(name, seed);
    put_words(f, " scatter", 3, up_to_1e30, seed);
    put_words(f, " absorb", 3, up_to_1e30, seed);
    put_words(f, " anisotropy", 1, cosine, seed);
    if (check_random(seed) < 0.5)
        fprintf(f, " up z");
    if (check_random(seed) < 0.3)
        put_words(f, " at", 3, place, seed);
    if (check_random(seed) < 0.3)
        fprintf(f, " scale %.9g", fmax(up_to_1e30(seed), 1e-30));
    if (check_random(seed) < 0.5) {
        double size = fmax(up_to_1e30(seed), 1e-6);

        fprintf(f, " box %.9g %.9g %.9g %.9g %.9g %.9g", -size, -size, -size,
                size, size, size);
    }
    fprintf(f, "\n");
}

static inline void put_view(uint64_t *seed)
{
    FILE *f = extremes_file("a.view");

    fprintf(f, "res %d %d\n", EXTREMES_SIDE, EXTREMES_SIDE);
    if (check_random(seed) < 0.3) {
        put_numbers(f, "eye", 3, place, seed);
        put_numbers(f, "at", 3, place, seed);
        put_numbers(f, "up", 3, place, seed);
    }
    if (check_random(seed) < 0.3)
        fprintf(f, "fovy %.9g\n",
                1e-6 + 179.99999 * pow(check_random(seed), 3));
    if (check_random(seed) < 0.2)
        put_numbers(f, "aperture", 1, up_to_1e30, seed);
    if (check_random(seed) < 0.2)
        put_numbers(f, "focus", 1, up_to_1e30, seed);
    if (check_random(seed) < 0.3)
        put_numbers(f, "background", 3, up_to_1e30, seed);
    if (check_random(seed) < 0.2)
        fprintf(f, "sky sky.pfm\nsky_rotation %g\n", 360 * check_random(seed));
    if (check_random(seed) < 0.2)
        put_numbers(f, "sky_strength", 1, up_to_1e30, seed);
    if (check_random(seed) < 0.3)
        fprintf(f, "max_bounces %d\n", (int)one_of(seed, 9));
    if (check_random(seed) < 0.3)
        put_any_fog(f, seed);
    if (check_random(seed) < 0.25)
        for (uint32_t count = 1 + one_of(seed, 3); count > 0; count--)
            put_any_smoke(f, seed);
    fclose(f);
}

static inline void extremes_add(struct extremes *x, struct backend *backend,
                                struct error *err)
{
    struct render *render = backend ? render_create(backend, err) : NULL;

    if (render == NULL) {
        printf("extremes: %s\n", err->text);
        exit(2);
    }
    x->backends[x->count] = backend;
    x->renders[x->count++] = render;
}

/* Call this in an empty folder. Without a device it prints a line and goes
 * on. */
static inline void extremes_open(struct extremes *x, bool on_device)
{
    struct cl_request request = {.features = FEATURES_ALL};
    const struct cpu_kernel *paths;
    struct backend *device;
    struct error err;
    char *log = NULL;

    *x = (struct extremes){.count = 0};
    put_images();
    for (int i = 0; (paths = cpu_kernel_at(i)) != NULL; i++)
        extremes_add(x, backend_cpu_create(1, paths, &err), &err);
    if (!on_device)
        return;
    cl_environment_prepare(0);
    device = backend_cl_create(&request, &log, &err);
    free(log);
    x->has_device = device != NULL;
    if (device != NULL)
        extremes_add(x, device, &err);
    else
        printf("skip: %s\n", err.text);
}

static inline void extremes_close(struct extremes *x)
{
    static const char *const files[] = {"a.obj",   "a.mtl", "a.view", "t.tga",
                                        "sky.pfm", "a.npy", "b.npy"};

    for (int i = 0; i < x->count; i++) {
        render_destroy(x->renders[i]);
        x->backends[i]->destroy(x->backends[i]);
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        unlink(files[i]);
}

#define EXTREMES_NUMBERS ((size_t)3 * EXTREMES_SIDE * EXTREMES_SIDE)

/* Returns false, with a line, if the picture is wrong. `first` is the picture
 * of the first renderer. */
static inline bool extremes_render(struct extremes *x, struct session *s,
                                   int which, uint32_t number, float *first)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = s->engine.crop,
                             .limits.spp = EXTREMES_SPP};
    struct render *render = x->renders[which];
    float rgb[EXTREMES_NUMBERS];
    struct render_progress p;
    struct error err;

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view,
                    number, &job.world, &err))
        return true; /* the camera is out of the world's range */
    if (!render_start(render, &job, &err) ||
        !render_wait(render, EXTREMES_LIMIT_MS)) {
        printf("scene %u: does not end\n", number);
        exit(2);
    }
    p = render_progress(render);
    film_linear(render_film(render), rgb);
    render_halt(render);
    if (which == 0) {
        memcpy(first, rgb, sizeof rgb);
        x->samples += p.samples;
        x->saturated += p.saturated;
    }
    if (p.state == RENDER_DONE && p.non_finite == 0 &&
        memcmp(first, rgb, sizeof rgb) == 0)
        return true;
    printf("scene %u, renderer %d: %s, %llu samples are not finite, %s\n",
           number, which, p.state == RENDER_DONE ? "done" : p.error.text,
           (unsigned long long)p.non_finite,
           memcmp(first, rgb, sizeof rgb) == 0 ? "the same picture"
                                               : "another picture");
    return false;
}

static inline bool are_finite(const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(numbers[i] >= 0 && isfinite(numbers[i])))
            return false;
    return true;
}

/* Filters the film and estimates its error. Returns false, with a line, if a
 * number is not finite. */
static inline bool extremes_conclude(struct film *film, uint32_t number)
{
    float rgb[EXTREMES_NUMBERS] = {0}, map[EXTREMES_NUMBERS / 3];
    struct film_error e;
    struct film filtered;
    struct error err;

    if (!film_filter_applies(film) ||
        !film_filter_copy(film, 1, &filtered, &err) ||
        !film_error(film, 0, NULL, NULL, &e, &err) ||
        !film_error_map(film, 0, NULL, map)) {
        printf("scene %u: is not filtered\n", number);
        return false;
    }
    film_linear(&filtered, rgb);
    film_free(&filtered);
    if (are_finite(rgb, EXTREMES_NUMBERS) &&
        are_finite(map, EXTREMES_NUMBERS / 3) && isfinite(e.error) &&
        isfinite(e.low) && isfinite(e.high))
        return true;
    printf("scene %u: a filtered pixel or the error is not finite\n", number);
    return false;
}

/* Renders with the features of the filter, filters, and estimates the error.
 * Returns false, with a line, if something is wrong. */
static inline bool extremes_filter(struct extremes *x, struct session *s,
                                   uint32_t number)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = s->engine.crop,
                             .limits.spp = EXTREMES_SPP};
    struct error err;

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view,
                    number, &job.world, &err))
        return true; /* the camera is out of the world's range */
    job.world.settings.features |= FEATURE_FILTER;
    if (!render_start(x->renders[0], &job, &err) ||
        !render_wait(x->renders[0], EXTREMES_LIMIT_MS)) {
        printf("scene %u: does not end\n", number);
        exit(2);
    }
    return extremes_conclude(render_film(x->renders[0]), number);
}

/* Adds up the squares of a film's errors, by its own estimate, and copies its
 * means. */
static inline double extremes_stated(const struct film *film, float *means)
{
    double sum = 0;

    for (size_t i = 0; i < EXTREMES_NUMBERS / 3; i++) {
        float e[3];

        if (!film_pixel_error(film, i, means + 3 * i, e))
            return 0;
        for (int c = 0; c < 3; c++)
            sum += (double)e[c] * (double)e[c];
    }
    return sum;
}

/* Returns by how many of its standard deviations the mean of `stated` exceeds
 * that of the squared differences between each render and the mean of all. */
static inline double extremes_excess(const double stated[EXTREMES_SEEDS],
                                     float (*means)[EXTREMES_NUMBERS])
{
    const double n = EXTREMES_SEEDS;
    double excess[EXTREMES_SEEDS], sum = 0, squares = 0;

    memcpy(excess, stated, sizeof excess);
    for (size_t i = 0; i < EXTREMES_NUMBERS; i++) {
        double mean = 0;

        for (int k = 0; k < EXTREMES_SEEDS; k++)
            mean += (double)means[k][i] / n;
        for (int k = 0; k < EXTREMES_SEEDS; k++)
            excess[k] -= pow((double)means[k][i] - mean, 2) * n / (n - 1);
    }
    for (int k = 0; k < EXTREMES_SEEDS; k++)
        sum += excess[k] / n;
    for (int k = 0; k < EXTREMES_SEEDS; k++)
        squares += pow(excess[k] - sum, 2);
    return squares > 0 ? sum / sqrt(squares / n / (n - 1)) : 0;
}

/* Renders with many seeds. Returns false, with a line, if the errors that they
 * state are below their true ones by more than chance. */
static inline bool extremes_state(struct extremes *x, struct session *s,
                                  uint32_t number)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = s->engine.crop,
                             .limits.spp = EXTREMES_STATED_SPP};
    static float means[EXTREMES_SEEDS][EXTREMES_NUMBERS];
    double stated[EXTREMES_SEEDS], excess;
    struct error err;

    for (uint32_t k = 0; k < EXTREMES_SEEDS; k++) {
        if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view,
                        k, &job.world, &err))
            return true; /* the camera is out of the world's range */
        if (!render_start(x->renders[0], &job, &err) ||
            !render_wait(x->renders[0], EXTREMES_LIMIT_MS)) {
            printf("scene %u: does not end\n", number);
            exit(2);
        }
        stated[k] = extremes_stated(render_film(x->renders[0]), means[k]);
        render_halt(x->renders[0]);
    }
    excess = extremes_excess(stated, means);
    if (excess > -EXTREMES_DEVIATIONS)
        return true;
    printf("scene %u: the stated error is too low by %.3g deviations\n", number,
           -excess);
    return false;
}

/* Checks scene `number`, with on_device also on the device. Returns false, with
 * a line, if something is wrong. */
static inline bool extremes_check(struct extremes *x, uint32_t number,
                                  bool on_device)
{
    uint64_t seed = number * UINT64_C(0x100000001b3) + 1;
    int count = x->count - (x->has_device && !on_device);
    float first[EXTREMES_NUMBERS] = {0};
    struct options options;
    struct session s;
    struct error err;
    bool ok = true;

    put_scene(&seed);
    put_view(&seed);
    options_init(&options);
    options.scene_path = "a.obj";
    options.thread_count = 1;
    x->scenes++;
    if (session_load(&s, &options, 0, &err)) {
        x->on_device += x->has_device && on_device;
        for (int i = 0; i < count; i++)
            ok = extremes_render(x, &s, i, number, first) && ok;
        ok = extremes_filter(x, &s, number) && ok;
        if (number % EXTREMES_EACH_STATED == 0)
            ok = extremes_state(x, &s, number) && ok;
    } else {
        x->refused++;
    }
    session_close(&s);
    return ok;
}

#endif
