// SPDX-License-Identifier: MIT
#include "render/cpu_dispatch.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/cpu_features.h"

static bool always(void)
{
    return true;
}

/* Builds of the kernel that the Makefile makes for each instruction set, from
 * the fewest features to all. */
enum { BUILDS = 10, FULL = BUILDS - 1 };

#define DECLARE(isa)                                      \
    extern const struct cpu_kernel paths_##isa##_lamps,   \
        paths_##isa##_lamps_filter, paths_##isa##_images, \
        paths_##isa##_images_filter, paths_##isa##_shiny, \
        paths_##isa##_shiny_filter, paths_##isa##_gltf,   \
        paths_##isa##_gltf_filter, paths_##isa##_light, paths_##isa
#define BUILDS_OF(isa)                                           \
    {                                                            \
        &paths_##isa##_lamps, &paths_##isa##_lamps_filter,       \
            &paths_##isa##_images, &paths_##isa##_images_filter, \
            &paths_##isa##_shiny, &paths_##isa##_shiny_filter,   \
            &paths_##isa##_gltf, &paths_##isa##_gltf_filter,     \
            &paths_##isa##_light, &paths_##isa,                  \
    }

DECLARE(plain);
DECLARE(avx2);
DECLARE(avx512);

/* Instruction sets with their builds, fastest first. */
static const struct {
    const struct cpu_kernel *builds[BUILDS];
    bool (*is_supported)(void);
} sets[] = {
#if defined(__x86_64__)
    {BUILDS_OF(avx512), cpu_has_avx512},
    {BUILDS_OF(avx2), cpu_has_avx2},
#endif
    {BUILDS_OF(plain), always},
};

enum { COUNT = sizeof sets / sizeof sets[0] };

const struct cpu_kernel *cpu_kernel_at(int i)
{
    for (int k = 0; k < COUNT; k++)
        if (sets[k].is_supported() && i-- == 0)
            return sets[k].builds[FULL];
    return NULL;
}

const struct cpu_kernel *cpu_kernel_best(void)
{
    return cpu_kernel_at(0);
}

const struct cpu_kernel *cpu_kernel_named(const char *name, struct error *err)
{
    char known[64] = "";
    const struct cpu_kernel *p;

    for (int i = 0; (p = cpu_kernel_at(i)) != NULL; i++) {
        size_t length = strlen(known);

        if (strcmp(p->name, name) == 0)
            return p;
        snprintf(known + length, sizeof known - length, "%s%s",
                 i == 0 ? "" : ", ", p->name);
    }
    fail(err, "--isa: found '%s', expected one of this processor's: %s", name,
         known);
    return NULL;
}

const struct cpu_kernel *cpu_kernel_fit(const struct cpu_kernel *paths,
                                        uint32_t features)
{
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; sets[k].builds[FULL] == paths && i < BUILDS; i++)
            if ((features & ~sets[k].builds[i]->features) == 0)
                return sets[k].builds[i];
    return paths;
}
