// SPDX-License-Identifier: MIT
/*
 * test_thin_film.c - iridescence against Airy's sum over the CIE observer
 */
#include "tests/unit/check.h"

#include <complex.h>
#include <math.h>

#include "image/color.h"
#include "tests/unit/surfaces.h"

/* Amplitudes that a face reflects: Fresnel's equations for the field across
 * (s) and in (p) the plane of incidence, with cosines c1 and c2 on both sides
 * (Born and Wolf, Principles of Optics, 1.5.2). */
static double complex amplitude(bool is_p, double n1, double n2,
                                double complex c1, double complex c2)
{
    return is_p ? (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
                : (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
}

/* Reflectance of a base of index n3 under a film of index n2 in air at one
 * wavelength, unpolarised (Born and Wolf, 1.6.4). */
static double airy(double nm, double c, double n2, double n3, double thickness)
{
    double complex c2 = csqrt(1 - (1 - c * c) / (n2 * n2));
    double complex c3 = csqrt(1 - (1 - c * c) / (n3 * n3));
    double complex turn = cexp(4 * M_PI * I * n2 * thickness * c2 / nm);
    double sum = 0;

    for (int is_p = 0; is_p < 2; is_p++) {
        double complex a = amplitude(is_p, 1, n2, c, c2);
        double complex b = amplitude(is_p, n2, n3, c2, c3);
        double complex r = (a + b * turn) / (1 + a * b * turn);

        sum += creal(r * conj(r)) / 2;
    }
    return sum;
}

/* Colour of the reflectance in light of equal energy, relative to a white
 * surface in it. */
static void film_by_observer(double c, double n2, double n3, double thickness,
                             double rgb[3])
{
    double film[OBSERVER_COUNT], white_light[OBSERVER_COUNT];
    double xyz[3], white_rgb[3];

    for (int i = 0; i < OBSERVER_COUNT; i++) {
        film[i] = airy(OBSERVER_FIRST_NM + i * OBSERVER_STEP_NM, c, n2, n3,
                       thickness);
        white_light[i] = 1;
    }
    observer_xyz(film, xyz);
    observer_rgb(xyz, rgb);
    observer_xyz(white_light, xyz);
    observer_rgb(xyz, white_rgb);
    for (int k = 0; k < 3; k++)
        rgb[k] = fmin(fmax(rgb[k] / white_rgb[k], 0), 1);
}

static struct vec3 film_on(double c, double n2, double n3, double thickness)
{
    float f0 = (float)pow((n3 - 1) / (n3 + 1), 2);

    return film_reflectance(v3(f0, f0, f0), (float)n2, (float)thickness,
                            (float)c);
}

/* Returns the greatest error of a channel. */
static double film_error(double c, double n2, double n3, double thickness)
{
    struct vec3 got = film_on(c, n2, n3, thickness);
    double want[3];

    film_by_observer(c, n2, n3, thickness, want);
    return fmax(fabs((double)got.x - want[0]),
                fmax(fabs((double)got.y - want[1]),
                     fabs((double)got.z - want[2])));
}

static void films_have_the_colours_of_interference(void **state)
{
    const int n = 4000;
    uint64_t seed = 1;
    double mean = 0;

    (void)state;
    for (int i = 0; i < n; i++) {
        double c = check_random(&seed);
        double n2 = 1 + check_random(&seed);
        double n3 = 1.3 + 2 * check_random(&seed);
        double thickness = 100 + 900 * check_random(&seed);
        double error = film_error(c, n2, n3, thickness);

        check_at_most(error, 5e-3);
        mean += error / n;
        error = film_error(0.2 + 0.8 * c, 1.2 + 0.3 * check_random(&seed), 1,
                           thickness); /* a soap bubble */
        check_at_most(error, 5e-3);
    }
    check_at_most(mean, 2e-4);
}

/* A film without thickness, or of the index of its base, leaves the exact
 * Fresnel reflectance. */
static void films_that_are_not_there_have_no_colour(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        double c = (i % 20 + 0.5) / 20;
        double n3 = 1.05 + 0.2 * (i / 20 % 10);
        struct vec3 none = film_on(c, 1.4, n3, 0);
        struct vec3 same = film_on(c, n3, n3, 700);
        float cos_t;
        double want = (double)fresnel_dielectric((float)c, (float)n3, &cos_t);

        check_close((double)none.x, want, 2e-5);
        check_close((double)none.z, want, 2e-5);
        check_close((double)same.y, want, 2e-5);
    }
}

/* Also where the sum of Airy has a denominator near 0. */
static void reflectances_are_from_0_to_1(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < 20000; i++) {
        float c = (float)pow(10, -16 * pow(check_random(&seed), 3));
        struct vec3 f0 = v3((float)(i % 5) / 4, (float)check_random(&seed),
                            (float)(i % 3) / 2);
        struct vec3 r = film_reflectance(f0, 1 + (float)(i % 10),
                                         2000 * (float)check_random(&seed), c);

        assert_true(r.x >= 0 && r.x <= 1 && r.y >= 0 && r.y <= 1 && r.z >= 0 &&
                    r.z <= 1);
    }
}

static struct bsdf smooth_with_film(float metalness, float transmission)
{
    struct bsdf m = {.color = {0.9f, 0.6f, 0.3f},
                     .specular = {0.04f, 0.04f, 0.04f},
                     .eta = 1.5f,
                     .kind = MATERIAL_PRINCIPLED,
                     .metalness = metalness,
                     .transmission = transmission,
                     .film = 1,
                     .film_ior = 1.33f,
                     .film_thickness = 350};

    return m;
}

/* Returns the mean weight of mirror reflections, or of other samples. */
static struct vec3 mirrored(const struct bsdf *m, float mu, bool is_mirrored)
{
    const int n = 20000;
    struct vec3 sum = {0, 0, 0};

    for (int i = 0; i < n; i++) {
        struct bsdf_sample s;

        if (bsdf_sample(m, direction(mu), v2(0.3f, 0.4f),
                        ((float)i + 0.5f) / (float)n, &s) &&
            (s.is_delta && s.wi.z > 0) == is_mirrored)
            sum = v3_add(sum, v3_scale(s.weight, 1.0f / (float)n));
    }
    return sum;
}

static void check_colors(struct vec3 got, struct vec3 want, double allowed)
{
    check_close((double)got.x, (double)want.x, allowed);
    check_close((double)got.y, (double)want.y, allowed);
    check_close((double)got.z, (double)want.z, allowed);
}

/* Returns the reflectance, but no less than the part of Schlick's approximation
 * that F0 does not change. */
static struct vec3 at_least_grazing(struct vec3 r, float mu, float f90)
{
    float least = f90 * schlick_weight(mu);

    return v3(f_max(r.x, least), f_max(r.y, least), f_max(r.z, least));
}

/* Mirrors of metal, plastic and glass reflect as the film does, and glass
 * transmits the rest, from both sides. */
static void mixtures_reflect_as_their_film(void **state)
{
    (void)state;
    for (float mu = 0.1f; mu <= 1; mu += 0.15f) {
        struct bsdf metal = smooth_with_film(1, 0);
        struct bsdf plastic = smooth_with_film(0, 0);
        struct bsdf glass = smooth_with_film(0, 1);
        struct vec3 want =
            film_reflectance(metal.color, metal.film_ior, 350, mu);
        float w = schlick_weight(mu);
        float cos_t, f90;

        check_colors(mirrored(&metal, mu, true), at_least_grazing(want, mu, 1),
                     1e-3);
        want = film_reflectance(plastic.specular, metal.film_ior, 350, mu);
        f90 = f_min(50 * v3_max_component(want) / (1 + 49 * w), 1);
        check_colors(mirrored(&plastic, mu, true),
                     at_least_grazing(want, mu, f90), 1e-3);
        check_colors(mirrored(&glass, mu, true), want, 1e-3);
        glass.color = white;
        check_colors(v3_add(mirrored(&glass, mu, true),
                            mirrored(&glass, mu, false)),
                     white, 1e-3);
        fresnel_dielectric(mu, 1.5f, &cos_t);
        glass.eta = 1 / 1.5f;
        check_colors(mirrored(&glass, cos_t, true), want, 1e-3);
        glass.eta = 1; /* a soap bubble */
        glass.is_thin = 1;
        want = film_reflectance(v3(0, 0, 0), metal.film_ior, 350, mu);
        check_colors(mirrored(&glass, mu, true), want, 1e-3);
    }
}

static void weak_films_are_weak(void **state)
{
    (void)state;
    for (float mu = 0.3f; mu <= 1; mu += 0.2f) {
        struct bsdf metal = smooth_with_film(1, 0);
        struct vec3 whole =
                        film_reflectance(metal.color, metal.film_ior, 350, mu),
                    bare;

        metal.film = 0;
        bare = mirrored(&metal, mu, true);
        check_colors(bare, fresnel_schlick(metal.color, mu), 1e-3);
        metal.film = 0.25f;
        check_colors(mirrored(&metal, mu, true), v3_lerp(bare, whole, 0.25f),
                     1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_have_the_colours_of_interference),
        cmocka_unit_test(films_that_are_not_there_have_no_colour),
        cmocka_unit_test(reflectances_are_from_0_to_1),
        cmocka_unit_test(mixtures_reflect_as_their_film),
        cmocka_unit_test(weak_films_are_weak),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
