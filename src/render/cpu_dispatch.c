// SPDX-License-Identifier: MIT
#include "render/cpu_dispatch.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/machine.h"

/* BUILDS(X) lists the builds of the kernel that the program has (kernels.mk),
 * the fastest instruction set first and, for each, the fewest features first.
 * The last build of an instruction set has all features. */
#ifndef BUILDS
#define BUILDS(X) X(paths_plain)
#endif
#define DECLARE(build) extern const struct cpu_kernel build;
#define ADDRESS(build) &(build),

BUILDS(DECLARE)
static const struct cpu_kernel *const builds[] = {BUILDS(ADDRESS)};

enum { COUNT = sizeof builds / sizeof builds[0] };

static bool is_supported(const char *isa)
{
    return strcmp(isa, "avx512") == 0 ? cpu_has_avx512()
           : strcmp(isa, "avx2") == 0 ? cpu_has_avx2()
                                      : true;
}

const struct cpu_kernel *cpu_kernel_build(int i)
{
    return i < COUNT ? builds[i] : NULL;
}

const struct cpu_kernel *cpu_kernel_at(int i)
{
    for (int k = 0; k < COUNT; k++)
        if (builds[k]->features == FEATURES_ALL &&
            is_supported(builds[k]->name) && i-- == 0)
            return builds[k];
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
                                        uint64_t features)
{
    for (int i = 0; i < COUNT; i++)
        if (strcmp(builds[i]->name, paths->name) == 0 &&
            (features & ~builds[i]->features) == 0)
            return builds[i];
    return paths;
}
