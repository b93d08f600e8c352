// SPDX-License-Identifier: MIT
/*
 * What a copy of the program sends after libassimp has read a hostile file may
 * be any bytes: they give a scene that can be rendered, or one line.
 */
#include "fuzz_tris.h"
#include "read/child/import_stream.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(import_stream_read, "none/fuzz.fbx", data, size);
    return 0;
}
