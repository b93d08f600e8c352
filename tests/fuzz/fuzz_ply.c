// SPDX-License-Identifier: MIT
/*
 * A PLY file of any bytes gives a scene that can be rendered, or one line. Its
 * memory is at most a multiple of the file's size: libFuzzer limits it.
 */
#include "fuzz_tris.h"
#include "mutate.h"
#include "read/ply.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(ply_parse, "none/fuzz.ply", data, size);
    return 0;
}

/* Changes the text up to "end_header", or the bytes behind it. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    static const char last[] = "end_header";
    struct mutation m = mutation_begin(data, size, max, seed);
    uint8_t *end = memmem(data, size, last, sizeof last - 1);
    size_t text = end != NULL ? (size_t)(end - data) : size;

    if (mutation_pick(&m, 2) == 0)
        mutation_text(&m, 0, text);
    else if (mutation_pick(&m, 2) == 0)
        mutation_text(&m, text, size - text);
    else
        mutation_fixed(&m, data + text, size - text);
    return m.size;
}
