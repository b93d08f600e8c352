// SPDX-License-Identifier: MIT
/*
 * gltf - pictures of glTF scenes beside those of Cycles and Mitsuba
 *
 * usage: gltf [SCENE...]
 *
 * The scenes are those of ../shared/scenes-gltf, or $GLIM_SHARED/scenes-gltf,
 * in which both renderers mean the same. A row has the worst of the 4x4 regions
 * and 3 channels beside each of them, for information: Mitsuba's metals lose
 * the light of multiple scattering, and Cycles loses light in cornell. The
 * tolerance is that of the scene, beside the picture that it trusts.
 */
#include <stdlib.h>
#include <unistd.h>

#include "rows.h"
#include "tests/unit/regions.h"

#define SEEDS   6
#define SIDE_PX 256
#define SPP     64

/* Multiple of our standard error that is allowed: Student's t with 5 degrees of
 * freedom exceeds it once in 7,000. The seeds are fixed. */
#define T_LIMIT 9.0

/* Returns the worst difference from these means, or the interval between two,
 * relative to the lower one. */
static double worst(const struct region_truth *t, const struct region_sums *s,
                    const double low[REGIONS], const double high[REGIONS])
{
    double most = 0;

    for (int i = 0; i < REGIONS; i++) {
        double mean = region_mean(s, i);
        double difference = (fmax(mean - high[i], 0) - fmax(low[i] - mean, 0)) /
                            fmax(low[i], t->least);

        if (fabs(difference) > fabs(most))
            most = difference;
    }
    return most;
}

static double worst_error(const struct region_truth *t,
                          const struct region_sums *s)
{
    double most = 0;

    for (int i = 0; i < REGIONS; i++)
        most =
            fmax(most, region_error(s, i) / fmax(region_mean(s, i), t->least));
    return most;
}

static void check_scene(const char *root, const char *name)
{
    char *scene = xformat("%s/scenes-gltf/%s/%s.glb", root, name, name);
    char *regions = xformat("%s/scenes-gltf/%s/regions.json", root, name);
    struct region_sums sums = {.count = 0};
    struct region_truth t;
    int misses;

    region_truth_read(regions, &t);
    for (uint32_t seed = 1; seed <= SEEDS; seed++)
        region_render(scene, &t, SIDE_PX, SPP, seed, &sums);
    misses = region_misses(&t, &sums, T_LIMIT);
    row(misses == 0, "gltf",
        "%s: Cycles %+.2f %%, Mitsuba %+.2f %%, own error %.2f %%; tolerance "
        "%.1f %%, missed by %d of %d",
        name, 100 * worst(&t, &sums, t.cycles, t.cycles_high),
        100 * worst(&t, &sums, t.mitsuba, t.mitsuba),
        100 * worst_error(&t, &sums), 100 * t.tolerance, misses, REGIONS);
    region_truth_free(&t);
    free(regions);
    free(scene);
}

int main(int argc, char **argv)
{
    static const char *const all[] = {"alpha_emission", "cornell",      "glass",
                                      "lights",         "macross_city", "metal",
                                      "textured"};
    const char *root = getenv("GLIM_SHARED");

    root = root != NULL ? root : "../shared";
    if (access(root, R_OK) != 0) {
        printf("skip gltf (no %s)\n", root);
        return 0;
    }
    for (int i = 1; i < argc; i++)
        check_scene(root, argv[i]);
    for (size_t i = 0; argc == 1 && i < sizeof all / sizeof all[0]; i++)
        check_scene(root, all[i]);
    return rows_status();
}
