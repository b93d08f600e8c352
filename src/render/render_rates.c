// SPDX-License-Identifier: MIT
#include "render/render_rates.h"

#include <stdlib.h>

#include "base/memory.h"

void thread_load_begin(struct thread_load *l, const struct backend *b)
{
    int count = b->cpu_ns ? b->thread_count : 0;

    if (count != l->count) {
        thread_load_free(l);
        l->cpu_ns = alloc_array((size_t)count, sizeof *l->cpu_ns);
        l->count = l->cpu_ns ? count : 0;
    }
    for (int i = 0; i < l->count; i++)
        l->cpu_ns[i] = b->cpu_ns(b, i);
}

double thread_load_share(const struct thread_load *l, const struct backend *b,
                         int thread, uint64_t time_ns)
{
    double share;

    if (thread >= l->count || !b->cpu_ns || time_ns == 0)
        return 0;
    share =
        (double)(b->cpu_ns(b, thread) - l->cpu_ns[thread]) / (double)time_ns;
    return share < 1 ? share : 1; /* the two clocks are not read at once */
}

void thread_load_free(struct thread_load *l)
{
    free(l->cpu_ns);
    *l = (struct thread_load){0};
}
