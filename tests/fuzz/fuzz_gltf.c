// SPDX-License-Identifier: MIT
/*
 * A glTF file of any bytes gives a scene that can be rendered, or one line. Its
 * memory is at most a multiple of the file's size: libFuzzer limits it.
 */
#include "gltf/gltf.h"
#include "fuzz_tris.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(gltf_parse, "none/fuzz.gltf", data, size);
    return 0;
}
