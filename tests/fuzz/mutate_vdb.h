// SPDX-License-Identifier: MIT
/*
 * mutate_vdb.h - changes of OpenVDB files: their numbers, and their values
 * behind zlib
 *
 * Threads:   one
 */
#ifndef TESTS_FUZZ_MUTATE_VDB_H
#define TESTS_FUZZ_MUTATE_VDB_H

#include <zlib.h>

#include "mutate.h"

/* Bytes before packed values, which say their size. */
#define VDB_PACKED_HEAD 8

/* Bytes at the beginning, in which places of grids are. */
#define VDB_HEAD 4096

/* Most bytes of values: those of the largest node. */
#define VDB_VALUES (4 * 32768)

/* Moves the places behind this one, which the list of grids has. */
static inline void mutation_vdb_move(struct mutation *m, size_t place,
                                     size_t before)
{
    size_t most = place < VDB_HEAD ? place : VDB_HEAD;

    for (size_t i = 0; m->size != before && i + 8 <= most; i++) {
        uint64_t to = mutation_get(m, i, 8);

        if (to > place && to <= before)
            mutation_put(m, i, 8, to + m->size - before);
    }
}

/* Changes packed values and packs them again. Returns false if none are at the
 * place. */
static inline bool mutation_vdb_values(struct mutation *m, size_t at)
{
    static uint8_t values[VDB_VALUES], packed[VDB_VALUES + 1024];
    uint64_t length = mutation_get(m, at, VDB_PACKED_HEAD);
    uLongf count = sizeof values, size = sizeof packed;
    size_t before = m->size;

    at += VDB_PACKED_HEAD;
    if (length == 0 || length > m->size - at || m->data[at] != 0x78 ||
        uncompress(values, &count, m->data + at, (uLong)length) != Z_OK)
        return false;
    mutation_fixed(m, values, count);
    require(compress(packed, &size, values, count) == Z_OK, "packed");
    if (mutation_replace(m, at, (size_t)length, packed, size)) {
        mutation_put(m, at - VDB_PACKED_HEAD, VDB_PACKED_HEAD, size);
        mutation_vdb_move(m, at, before);
    }
    return true;
}

/* Changes an OpenVDB file. */
static inline void mutation_vdb(struct mutation *m)
{
    size_t kind = mutation_pick(m, 8);

    if (kind < 4 && m->size > VDB_PACKED_HEAD)
        for (size_t i = mutation_pick(m, m->size);
             i + VDB_PACKED_HEAD < m->size; i++)
            if (mutation_vdb_values(m, i))
                return;
    if (kind > 5)
        m->size = LLVMFuzzerMutate(m->data, m->size, m->max);
    else if (m->size > 8)
        mutation_number(m, m->data + mutation_pick(m, m->size - 8), 8);
}

#endif
