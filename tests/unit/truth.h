// SPDX-License-Identifier: MIT
/*
 * truth.h - means of paths against independent truth
 *
 * A lit mesh is a small world with all data for light sampling. Each claim
 * about it is tested with every technique for direct light, over independent
 * seeds.
 *
 * Units:     normalised scene units, radiance
 * Ownership: lit_mesh_free() frees the arrays
 * Threads:   one
 * Errors:    a wrong claim ends the test
 */
#ifndef TESTS_TRUTH_H
#define TESTS_TRUTH_H

#include <math.h>

#include "tests/unit/mesh.h"
#include "world/light/lights.h"
#include "world/light/sky_table.h"

#include "tests/unit/paths.h"

#define SEEDS 32

/* Student's t with 31 degrees of freedom exceeds this once in 1e6 (two-sided).
 * The tests that include this make some 1,800 comparisons: one false alarm in
 * 550 choices of seeds. The seeds are fixed. */
#define T_LIMIT 6.07

/* Standard errors must be below this, or any claim would hold. */
#define PRECISION 0.01

struct lit_mesh {
    struct mesh mesh;
    struct lights lights;
    struct sky_table skies[2]; /* index: enum sky_use */
};

struct claim {
    struct vec3 eye, at; /* the ray goes from eye through at */
    double truth[3];     /* the radiance along the ray */
    double systematic;   /* relative error of tables */
    int paths;           /* for each seed */
    int without; /* 1 << enum direct: a technique that cannot converge here */
};

#define GREY(x) \
    {           \
        x, x, x \
    }

static const char *const ways[] = {"both ways", "chosen lights", "chance"};

static inline void lit_mesh_finish(struct lit_mesh *s)
{
    struct world *w = &s->mesh.world;
    struct error err;

    mesh_finish(&s->mesh);
    assert_true(lights_build(&s->lights, w, &err));
    for (int use = SKY_WITH_MIS; use <= SKY_ALONE; use++)
        assert_true(sky_table_build(&s->skies[use], w->sky_texels,
                                    w->settings.sky.width,
                                    w->settings.sky.height, (enum sky_use)use,
                                    &err));
}

static inline void lit_mesh_free(struct lit_mesh *s)
{
    sky_table_free(&s->skies[SKY_WITH_MIS]);
    sky_table_free(&s->skies[SKY_ALONE]);
    lights_free(&s->lights);
    mesh_free(&s->mesh);
}

/* Lends the tables that this technique for direct light needs. */
static inline void lit_mesh_lend(struct lit_mesh *s, enum direct direct)
{
    enum sky_use use = direct == DIRECT_LIGHTS ? SKY_ALONE : SKY_WITH_MIS;

    s->mesh.world.settings.direct = direct;
    lights_lend(&s->lights, &s->mesh.world);
    sky_table_lend(&s->skies[use], &s->mesh.world);
}

/* Returns means of n paths along the claim's ray. */
static inline void claim_means(const struct world *w, const struct claim *c,
                               uint32_t seed, double means[3])
{
    struct ray r = {c->eye, v3_unit(v3_sub(c->at, c->eye)), FLOAT_MAX, 0, 0};

    means[0] = means[1] = means[2] = 0;
    for (int i = 0; i < c->paths; i++) {
        struct path_sample s =
            trace_path(w, r, sampler_start(3, 1, (uint64_t)i, seed), NULL);

        assert_int_equal(s.cut, 0);
        means[0] += (double)s.radiance.x / c->paths;
        means[1] += (double)s.radiance.y / c->paths;
        means[2] += (double)s.radiance.z / c->paths;
    }
}

struct estimate {
    double mean[3], error[3];
};

static inline struct estimate claim_estimate(const struct world *w,
                                             const struct claim *c)
{
    struct estimate e = {{0}, {0}};

    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        double means[3];

        claim_means(w, c, seed, means);
        for (int k = 0; k < 3; k++) {
            e.mean[k] += means[k] / SEEDS;
            e.error[k] += means[k] * means[k] / SEEDS;
        }
    }
    for (int k = 0; k < 3; k++) {
        double variance = fmax(e.error[k] - e.mean[k] * e.mean[k], 0);

        e.error[k] = sqrt(variance / (SEEDS - 1));
    }
    return e;
}

static inline void check_claim_by(const struct world *w, const struct claim *c,
                                  const char *file, int line)
{
    struct estimate e = claim_estimate(w, c);

    for (int k = 0; k < 3; k++) {
        double miss = fabs(e.mean[k] - c->truth[k]);
        /* 1e-5 is some tens of roundings of floats. */
        double allowed =
            T_LIMIT * e.error[k] + (1e-5 + c->systematic) * c->truth[k];

        if (miss <= allowed && e.error[k] <= PRECISION * c->truth[k])
            continue;
        print_error("%s, channel %d: got %.7g, want %.7g, off by %.3g, "
                    "allowed %.3g; standard error %.2g\n",
                    ways[w->settings.direct], k, e.mean[k], c->truth[k], miss,
                    allowed, e.error[k]);
        _fail(file, line);
    }
}

/* Every claim is checked by all techniques in a thorough test, otherwise by
 * one, each in its turn. */
static inline void check_claim_at(struct lit_mesh *s, struct claim c,
                                  const char *file, int line)
{
    static unsigned turn;
    unsigned first = turn++;

    for (unsigned i = 0; i <= DIRECT_BSDF; i++) {
        unsigned direct = (first + i) % (DIRECT_BSDF + 1);

        if ((c.without >> direct & 1) != 0)
            continue;
        lit_mesh_lend(s, (enum direct)direct);
        check_claim_by(&s->mesh.world, &c, file, line);
        if (!check_is_thorough())
            return;
    }
}

#define check_claim(lit_mesh, claim) \
    check_claim_at(lit_mesh, claim, __FILE__, __LINE__)

static inline struct material lamp_material(float radiance)
{
    struct material m = mesh_material(MATERIAL_DIFFUSE, 0);

    m.emission = v3(radiance, radiance, radiance);
    return m;
}

/* Adds a small square of material 0 around p with normal n. */
static inline void add_receiver(struct mesh *m, struct vec3 p, struct vec3 n)
{
    struct vec3 t, b;

    frame_around(n, &t, &b);
    t = v3_scale(t, 0.01f);
    b = v3_scale(b, 0.01f);
    mesh_add_quad(m, v3_sub(v3_sub(p, t), b), v3_sub(v3_add(p, t), b),
                  v3_add(v3_add(p, t), b), v3_add(v3_sub(p, t), b), 0);
}

/* Returns an eye near p, 37 degrees off the normal. */
static inline struct vec3 eye_over(struct vec3 p, struct vec3 n)
{
    struct vec3 t, b;

    frame_around(n, &t, &b);
    return v3_add(p, v3_add(v3_scale(n, 0.04f), v3_scale(t, 0.03f)));
}

/* Checks the irradiance of a diffuse receiver. */
static inline void check_receiver(struct lit_mesh *s, const struct receiver *r,
                                  double albedo, double irradiance, int paths)
{
    check_claim(s, ((struct claim){.eye = eye_over(r->p, r->n),
                                   .at = r->p,
                                   .truth = GREY(albedo / M_PI * irradiance),
                                   .paths = paths}));
}

#endif
