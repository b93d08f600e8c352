// SPDX-License-Identifier: MIT
/*
 * NumPy files. A grid has finite values, and no interpolated value exceeds the
 * majorant of its place. Nothing behind the bytes is read.
 */
#include "fuzz_grid.h"
#include "mutate.h"
#include "read/npy.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct voxel_grid grid;
    char *bytes = malloc(size + (size == 0));

    require(bytes != NULL, "memory");
    if (size > 0)
        memcpy(bytes, data, size);
    if (npy_parse(&grid, bytes, size, &err)) {
        require(npy_matches(bytes, size), "a beginning");
        fuzz_check_grid(&grid);
    } else {
        fuzz_check_message(err.text);
    }
    voxel_grid_free(&grid);
    free(bytes);
    return 0;
}

/* Bytes before the text of a file of version 1. */
#define TEXT_AT 10

/* Changes the text, with its length, or the numbers. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed);
    size_t length = (size_t)mutation_get(&m, TEXT_AT - 2, 2);

    if (size < TEXT_AT || length > size - TEXT_AT || mutation_pick(&m, 4) == 0)
        return LLVMFuzzerMutate(data, size, max);
    if (mutation_pick(&m, 2) == 0)
        mutation_put(&m, TEXT_AT - 2, 2, mutation_text(&m, TEXT_AT, length));
    else
        mutation_fixed(&m, data + TEXT_AT + length, size - TEXT_AT - length);
    return m.size;
}
