// SPDX-License-Identifier: MIT
/*
 * mutate_text.h - changes of a target whose input is text
 *
 * A target that includes it has its LLVMFuzzerCustomMutator().
 *
 * Threads:   one
 */
#ifndef TESTS_FUZZ_MUTATE_TEXT_H
#define TESTS_FUZZ_MUTATE_TEXT_H

#include "mutate.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed);

    mutation_text(&m, 0, size);
    return m.size;
}

#endif
