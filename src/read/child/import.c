// SPDX-License-Identifier: MIT
#include "read/child/import.h"

#include <stdlib.h>
#include <string.h>

#include "base/library_child.h"
#include "read/child/assimp_api.h"
#include "read/child/import_stream.h"

/* Formats of libassimp 5.2, without those that glim reads, those of animations
 * alone, and endings of other kinds of files, such as .xml. */
const char import_endings[] =
    "fbx dae 3ds x3d x3db x blend off lwo lxo lws ase ask dxf ac acc ac3d b3d "
    "cob 3mf amf irr irrmesh md2 md3 mdl mdc md5mesh ms3d ogex q3o q3s smd nff "
    "enff iqm pmx ndo sib hmp 3d uc xgl zgl zae bsp pk3 ifc assbin";

/* libassimp reads 5 to 50 MB/s, and a scene is up to 40 times its file. */
#define BYTES_A_SECOND   1000000
#define MEMORY_OF_A_BYTE 60

bool import_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                  const char *path, struct warnings *report, struct error *err)
{
    struct library_task task = {
        .library = "libassimp",
        .program = scene->program,
        .option = "--import",
        .path = path,
        .size_bytes = size_bytes,
        .bytes_a_second = BYTES_A_SECOND,
        .memory_of_a_byte = MEMORY_OF_A_BYTE,
    };
    struct child_result result;
    struct error own;
    bool ok;

    (void)bytes;
    if (strcmp(path, "-") == 0 || scene->program == NULL)
        return fail(err,
                    "%s: found a format that only the program glim reads, and "
                    "only from a file",
                    path);
    ok = library_child_run(&task, &result, &own)
             ? import_stream_read(scene, result.output, result.size_bytes, path,
                                  report, err)
             : fail(err, "%s: %s", path, own.text);
    free(result.output);
    return ok;
}

const char *import_missing(void)
{
    struct error ignored;

    return assimp_api_open(&ignored) != NULL ? NULL : ASSIMP_PACKAGE;
}
