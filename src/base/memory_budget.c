// SPDX-License-Identifier: MIT
#include "base/memory_budget.h"

#include "base/cgroup_quota.h"

/* Budget of a file of any size, and what each of its bytes adds. Draco packs
 * smooth grids tightest of what people make: with all that is made of it, a
 * million triangles in 181 kB take 240 MB, 1,300 times as much. */
#define LEAST_BYTES ((uint64_t)1 << 30)
#define RATIO       1500

void memory_budget_add_file(struct memory_budget *budget, uint64_t file_bytes)
{
    struct memory_quota quota = cgroup_quota_memory("");
    uint64_t wanted;

    if (__builtin_add_overflow(budget->file_bytes, file_bytes,
                               &budget->file_bytes))
        budget->file_bytes = UINT64_MAX;
    if (__builtin_mul_overflow(budget->file_bytes, RATIO, &wanted) ||
        __builtin_add_overflow(wanted, LEAST_BYTES, &wanted) ||
        wanted > quota.size_bytes) {
        budget->size_bytes = quota.size_bytes;
        budget->place = quota.place;
    } else {
        budget->size_bytes = wanted;
        budget->place = "in a file of its size";
    }
}

uint64_t memory_budget_left(const struct memory_budget *budget)
{
    if (budget->size_bytes == 0)
        return UINT64_MAX;
    return budget->taken_bytes < budget->size_bytes
               ? budget->size_bytes - budget->taken_bytes
               : 0;
}

bool memory_budget_take(struct memory_budget *budget, uint64_t count,
                        uint64_t item_bytes)
{
    uint64_t size_bytes;

    if (__builtin_mul_overflow(count, item_bytes, &size_bytes) ||
        size_bytes > memory_budget_left(budget))
        return false;
    if (budget->size_bytes > 0)
        budget->taken_bytes += size_bytes;
    return true;
}
