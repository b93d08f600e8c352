// SPDX-License-Identifier: MIT
/*
 * A STL file of any bytes gives a scene that can be rendered, or one line. Its
 * memory is at most a multiple of the file's size: libFuzzer limits it.
 */
#include "fuzz_tris.h"
#include "read/stl.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(stl_parse, "none/fuzz.stl", data, size);
    return 0;
}
