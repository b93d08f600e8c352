// SPDX-License-Identifier: MIT
#include "film/filter/filter_dispatch.h"

#include <stdbool.h>
#include <stddef.h>

#include "base/cpu_features.h"

extern const struct filter_loops filter_loops_plain, filter_loops_avx2,
    filter_loops_avx512;

static bool always(void)
{
    return true;
}

/* Instruction sets, fastest first. */
static const struct {
    const struct filter_loops *loops;
    bool (*is_supported)(void);
} sets[] = {
#if defined(__x86_64__)
    {&filter_loops_avx512, cpu_has_avx512},
    {&filter_loops_avx2, cpu_has_avx2},
#endif
    {&filter_loops_plain, always},
};

const struct filter_loops *filter_loops_at(int i)
{
    for (size_t k = 0; k < sizeof sets / sizeof sets[0]; k++)
        if (sets[k].is_supported() && i-- == 0)
            return sets[k].loops;
    return NULL;
}
