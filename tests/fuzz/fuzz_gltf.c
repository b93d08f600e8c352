// SPDX-License-Identifier: MIT
/*
 * A glTF file of any bytes gives a scene that can be rendered, or one line, at
 * rest and posed by an animation. Its memory is at most a multiple of the
 * file's size: libFuzzer limits it.
 */
#include "fuzz_tris.h"
#include "mutate_gltf.h"
#include "read/gltf/gltf.h"

static bool parse_posed(struct scene *scene, const char *bytes,
                        size_t size_bytes, const char *path,
                        struct warnings *report, struct error *err)
{
    scene->choice = (struct scene_choice){.has_time = true, .time_s = 0.5};
    return gltf_parse(scene, bytes, size_bytes, path, report, err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(gltf_parse, "none/fuzz.gltf", data, size);
    fuzz_check_scene(parse_posed, "none/fuzz.gltf", data, size);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed);

    mutation_gltf(&m);
    return m.size;
}
