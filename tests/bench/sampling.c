// SPDX-License-Identifier: MIT
/*
 * sampling - the costs of a random point, a light sample and its density for
 * increasing numbers of lights, and the time to build their tree
 *
 * usage: sampling
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "world/light/lights.h"
#include "world/light/sky_table.h"

#include "kernels/light.h"
#include "kernels/rng.h"

#define SAMPLES 1000000

static double ns_since(uint64_t begin_ns)
{
    return (double)(clock_ns() - begin_ns) / SAMPLES;
}

static struct vec2 point(uint32_t i, uint32_t dimension)
{
    return random_2d(sampler_start(i, 0, 0, 0), dimension);
}

/* It is printed, so that the compiler keeps the work. */
static float total;

static double time_points(void)
{
    uint64_t begin_ns = clock_ns();

    for (uint32_t i = 0; i < SAMPLES; i++)
        total += random_2d(sampler_start(1, 2, i, 0), 10).x;
    return ns_since(begin_ns);
}

static double time_samples(const struct world *w, double *pdf_ns)
{
    static struct light_sample samples[SAMPLES];
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false};
    uint64_t begin_ns = clock_ns();
    double sample_ns;

    for (uint32_t i = 0; i < SAMPLES; i++) {
        struct vec2 u = point(i, 10);

        r.p = v3(u.x, 0, u.y);
        if (light_sample(w, &r, NO_INDEX, u, point(i, 11), &samples[i]))
            total += samples[i].pdf;
    }
    sample_ns = ns_since(begin_ns);
    begin_ns = clock_ns();
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float pdf;

        r.p = v3(samples[i].wi.x, 0, samples[i].wi.y);
        if (samples[i].tri != NO_INDEX)
            pdf = light_pdf_at(w, &r, samples[i].tri, samples[i].p);
        else
            sky_light_terms(w, &r, NO_INDEX, samples[i].wi, &pdf);
        total += pdf;
    }
    *pdf_ns = ns_since(begin_ns);
    return sample_ns;
}

/* Makes small triangles above the receivers. */
static bool bench_lights(uint32_t count, struct error *err)
{
    struct material lamp = {.emission = {1, 1, 1},
                            .opacity = 1,
                            .color_texture = NO_INDEX,
                            .emission_texture = NO_INDEX};
    struct vec3 *positions = alloc_array(3 * (size_t)count, sizeof *positions);
    struct tri *tris = alloc_array(count, sizeof *tris);
    struct world w = {.positions = positions,
                      .tris = tris,
                      .materials = &lamp,
                      .settings.tri_count = count,
                      .settings.material_count = 1};
    struct lights lights = {.lights = NULL};
    bool ok = positions != NULL && tris != NULL;

    for (uint32_t i = 0; ok && i < count; i++) {
        struct vec2 a = point(i, 0), b = point(i, 1), c = point(i, 2);
        struct vec3 p = v3(a.x, 0.1f + b.x, a.y);
        struct vec3 e = v3(c.x - 0.5f, c.y - 0.5f, b.y - 0.5f);

        positions[3 * i] = p;
        positions[3 * i + 1] = v3_add(p, v3_scale(e, 0.01f));
        positions[3 * i + 2] = v3_add(p, v3(0.01f * e.y, 0, 0.01f * e.x));
        tris[i] = (struct tri){{3 * i, 3 * i + 1, 3 * i + 2},
                               {NO_INDEX, NO_INDEX, NO_INDEX},
                               {NO_INDEX, NO_INDEX, NO_INDEX},
                               0,
                               {0, 0, 0}};
        triangle_normal(positions[3 * i], positions[3 * i + 1],
                        positions[3 * i + 2], &tris[i].ng);
    }
    uint64_t begin_ns = clock_ns();
    ok = ok ? lights_build(&lights, &w, err) : fail(err, "out of memory");
    double build_ms = (double)(clock_ns() - begin_ns) * 1e-6;
    if (ok) {
        double pdf_ns, sample_ns;

        lights_lend(&lights, &w);
        sample_ns = time_samples(&w, &pdf_ns);
        printf("%9u lights %8.1f %8.1f   built in %.1f ms\n", count, sample_ns,
               pdf_ns, build_ms);
    }
    lights_free(&lights);
    free(positions);
    free(tris);
    return ok;
}

static bool bench_sky(uint32_t width, struct error *err)
{
    uint32_t height = width / 2;
    struct vec3 *texels = alloc_array((size_t)width * height, sizeof *texels);
    struct world w = {
        .settings.sky = {{1, 1, 1}, width, height, 0, 1, 0},
        .sky_texels = texels,
    };
    struct sky_table table = {NULL};
    bool ok = texels != NULL;

    for (uint32_t i = 0; ok && i < width * height; i++) {
        struct vec2 u = point(i, 0);

        texels[i] = v3(u.x, u.y, u.x > 0.999f ? 1000 : 0);
    }
    uint64_t begin_ns = clock_ns();
    ok = ok ? sky_table_build(&table, texels, width, height, SKY_WITH_MIS, err)
            : fail(err, "out of memory");
    double build_ms = (double)(clock_ns() - begin_ns) * 1e-6;
    if (ok) {
        double pdf_ns, sample_ns;

        sky_table_lend(&table, &w);
        sample_ns = time_samples(&w, &pdf_ns);
        printf("sky %5ux%-5u  %8.1f %8.1f   built in %.1f ms\n", width, height,
               sample_ns, pdf_ns, build_ms);
    }
    sky_table_free(&table);
    free(texels);
    return ok;
}

int main(void)
{
    struct error err;
    bool ok = true;

    printf("a point: %.1f ns\n", time_points());
    printf("ns for                 a sample   a pdf   (two points included)\n");
    for (uint32_t count = 1; ok && count <= 1000000; count *= 10)
        ok = bench_lights(count, &err);
    for (uint32_t width = 64; ok && width <= 4096; width *= 8)
        ok = bench_sky(width, &err);
    if (!ok)
        fprintf(stderr, "sampling: %s\n", err.text);
    return ok && total >= 0 ? 0 : 1;
}
