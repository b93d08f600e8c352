// SPDX-License-Identifier: MIT
/* Texts of all formats with a byte order mark, and with NULs at their end. */
#include "tests/unit/read/meshes.h"

static const struct {
    const char *path, *text;
} files[] = {
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
              "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
              "property float y\nproperty float z\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n"
              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"a.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],"
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
     "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
     "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
     "\"buffers\":[{\"byteLength\":36,"
     "\"uri\":\"data:application/octet-stream;base64,"
     "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}"},
};

/* The name has another ending, so that the bytes show the format, except for
 * OBJ, which is what they show if nothing else. */
static void marks_and_nuls_are_no_text(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        for (int kind = 0; kind < 4; kind++) {
            struct mesh_file m;
            struct bytes b = {.size = 0};

            if (kind & 1)
                add_text(&b, "\xef\xbb\xbf");
            add_text(&b, files[i].text);
            if (kind & 2)
                add_bits(&b, 0, 5);
            m = parse_good("a.dat", b.data, b.size);
            assert_int_equal(m.scene.tri_count, 1);
            assert_int_equal(m.report.entry_count, 0);
            assert_string_equal(scene_format_of("a.dat", b.data, b.size)->name,
                                scene_format_of(files[i].path, "", 0)->name);
            mesh_file_free(&m);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_and_nuls_are_no_text),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
