// SPDX-License-Identifier: MIT
/* PLY files in all encodings, and the messages for wrong ones. */
#include "read/ply.h"

#include "tests/unit/read/meshes.h"

#define HEADER   "ply\nformat ascii 1.0\n"
#define POSITION "property float x\nproperty float y\nproperty float z\n"
#define FACE     "property list uchar int vertex_indices\n"
#define TRIANGLE                                          \
    "element vertex 3\n" POSITION "element face 1\n" FACE \
    "end_header\n0 0 0\n1 0 0\n0 1 0\n"

static struct mesh_file parse(const char *text)
{
    return parse_good("a.ply", text, strlen(text));
}

static void check_tri(const struct scene *s, uint32_t i, uint32_t a, uint32_t b,
                      uint32_t c)
{
    const uint32_t want[3] = {a, b, c};

    for (int k = 0; k < 3; k++)
        check_close(s->tris[i].v[k], want[k], 0);
}

static void ascii_is_read(void **state)
{
    struct mesh_file m = parse(HEADER TRIANGLE "3 0 1 2\n");

    (void)state;
    assert_int_equal(m.scene.position_count, 3);
    assert_int_equal(m.scene.tri_count, 1);
    check_position(&m.scene, 1, 1, 0, 0);
    check_tri(&m.scene, 0, 0, 1, 2);
    assert_string_equal(m.scene.object_names[0], "");
    assert_string_equal(m.scene.material_names[m.scene.tris[0].material],
                        "clay");
    assert_false(m.scene.up_is_z);
    mesh_file_free(&m);
}

/* Writes x as double, y as short, z as uchar, a list that is skipped, and
 * colours as ushort; the face has its indices as 64-bit numbers behind a flag.
 */
static void write_binary(struct bytes *b, bool is_big)
{
    *b = (struct bytes){.is_big = is_big};
    add_text(b, "ply\nformat ");
    add_text(b, is_big ? "binary_big_endian" : "binary_little_endian");
    add_text(b, " 1.0\ncomment made by hand\nobj_info none\n"
                "element vertex 3\nproperty list ushort float32 weights\n"
                "property uint8 z\nproperty int16 y\nproperty float64 x\n"
                "property ushort red\nproperty ushort green\n"
                "property ushort blue\nproperty uchar alpha\n"
                "element edge 2\nproperty int a\n"
                "element face 1\nproperty char flag\n"
                "property list uint64 int64 vertex_index\nend_header\n");
    for (int i = 0; i < 3; i++) {
        add_bits(b, (uint64_t)i, 2);
        for (int k = 0; k < i; k++)
            add_float(b, 0.5f);
        add_bits(b, (uint64_t)(200 + i), 1);
        add_bits(b, (uint64_t)(i - 2), 2);
        add_double(b, 1e-3 * i);
        add_bits(b, 65535, 2);
        add_bits(b, 32768, 2);
        add_bits(b, 0, 2);
        add_bits(b, 7, 1);
    }
    add_bits(b, 1, 4);
    add_bits(b, 2, 4);
    add_bits(b, 255, 1);
    add_bits(b, 3, 8);
    for (int i = 0; i < 3; i++)
        add_bits(b, (uint64_t)(2 - i), 8);
}

static void binary_is_read_in_both_orders(void **state)
{
    (void)state;
    for (int is_big = 0; is_big < 2; is_big++) {
        struct mesh_file m;
        struct bytes b;

        write_binary(&b, is_big);
        m = parse_good("a.ply", b.data, b.size);
        for (uint32_t i = 0; i < 3; i++) {
            check_position(&m.scene, i, 1e-3 * i, (int)i - 2, 200 + i);
            check_color(m.scene.colors[i], 1, linear(32768 / 65535.), 0);
        }
        assert_int_equal(m.scene.tri_count, 1);
        check_tri(&m.scene, 0, 2, 1, 0);
        mesh_file_free(&m);
        for (size_t size = 0; size < b.size; size++) {
            m = parse_bytes("a.ply", b.data, size);
            assert_false(m.ok);
            mesh_file_free(&m);
        }
    }
}

/* Writes a file of the form that most programs write: faces have a count of one
 * byte and three numbers of four. Its last face has the given corners. */
static void write_triangles(struct bytes *b, bool is_big, unsigned count,
                            const uint32_t last[4])
{
    static const uint32_t first[3] = {2, 0, 1};

    *b = (struct bytes){.is_big = is_big};
    add_text(b, "ply\nformat ");
    add_text(b, is_big ? "binary_big_endian" : "binary_little_endian");
    add_text(b, " 1.0\nelement vertex 4\n" POSITION "element face 2\n" FACE
                "end_header\n");
    for (int i = 0; i < 4; i++) {
        add_float(b, i % 2 == 1 ? 1.5f : 0);
        add_float(b, i / 2 == 1 ? 1.5f : 0);
        add_float(b, 0);
    }
    add_bits(b, 3, 1);
    for (int k = 0; k < 3; k++)
        add_bits(b, first[k], 4);
    add_bits(b, count, 1);
    for (unsigned k = 0; k < count; k++)
        add_bits(b, last[k], 4);
}

static void triangles_are_read_at_once(void **state)
{
    static const uint32_t last[4] = {1, 3, 2, 0};

    (void)state;
    for (int i = 0; i < 4; i++) {
        unsigned count = 3 + (unsigned)i / 2;
        struct mesh_file m;
        struct bytes b;

        write_triangles(&b, i % 2 == 1, count, last);
        m = parse_good("a.ply", b.data, b.size);
        assert_int_equal(m.scene.tri_count, count - 1);
        check_tri(&m.scene, 0, 2, 0, 1);
        if (count == 3)
            check_tri(&m.scene, 1, 1, 3, 2);
        for (uint32_t k = 0; k < m.scene.tri_count; k++) {
            assert_int_equal(m.scene.tri_faces[k], k > 0);
            assert_int_equal(m.scene.tris[k].material, 1);
        }
        mesh_file_free(&m);
    }
}

static void wrong_triangles_are_refused(void **state)
{
    static const uint32_t last[4] = {1, 4, 2, 0};
    struct mesh_file m;
    struct bytes b;

    (void)state;
    write_triangles(&b, false, 3, last);
    m = parse_bytes("a.ply", b.data, b.size);
    assert_false(m.ok);
    check_has(m.err.text, "found vertex 4 in a face, expected 0 to 3");
    mesh_file_free(&m);
}

#define MANY 100001

/* Vertices of binary files are read by several threads, here with a property
 * between the others that has no meaning. Only the last one has a normal. */
static void many_vertices_are_read_by_threads(void **state)
{
    static const char tail[] = "\3\1\0\0\0\2\0\0\0\3\0\0";
    const size_t row_bytes = 25;
    struct scene scene = {.thread_count = 3};
    struct warnings report = {0};
    struct error err;
    char *bytes = malloc(300 + MANY * row_bytes + sizeof tail);
    char *at = bytes;

    (void)state;
    assert_non_null(bytes);
    at += sprintf(at,
                  "ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
                  "property float x\nproperty float y\nproperty uchar other\n"
                  "property float z\nproperty float nx\nproperty float ny\n"
                  "property float nz\nelement face 1\n" FACE "end_header\n",
                  MANY);
    for (int i = 0; i < MANY; i++) {
        const float row[6] = {(float)i, (float)(i % 7), (float)(i % 11), 0,
                              0,        i == MANY - 1};

        memcpy(at, row, 8);
        at[8] = (char)i;
        memcpy(at + 9, row + 2, 16);
        at += row_bytes;
    }
    memcpy(at, tail, sizeof tail);
    check_or_say(ply_parse(&scene, bytes, (size_t)(at - bytes) + 13, "a.ply",
                           &report, &err),
                 err.text);
    assert_int_equal(scene.position_count, MANY);
    assert_int_equal(scene.normal_count, MANY);
    for (uint32_t i = 0; i < MANY; i++) {
        check_position(&scene, i, i, i % 7, i % 11);
        assert_true(scene.normals[i].z == (i == MANY - 1 ? 1 : 0));
    }
    scene_free(&scene);
    warnings_free(&report);
    free(bytes);
}

static void lines_may_end_in_any_way(void **state)
{
    static const char text[] = HEADER TRIANGLE "3 0 1 2\n";
    static const char *const ends[] = {"\r\n", "\r"};

    (void)state;
    for (int i = 0; i < 2; i++) {
        char other[2 * sizeof text] = "";
        struct mesh_file m;

        for (const char *p = text; *p != '\0'; p++) {
            size_t length = strlen(other);

            snprintf(other + length, sizeof other - length, "%.*s",
                     *p == '\n' ? 2 : 1, *p == '\n' ? ends[i] : p);
        }
        m = parse(other);
        assert_int_equal(m.scene.tri_count, 1);
        mesh_file_free(&m);
    }
}

static void faces_may_come_first_and_be_polygons(void **state)
{
    struct mesh_file m =
        parse(HEADER "element face 2\n" FACE "element vertex 5\n" POSITION
                     "end_header\n5 0 1 2 3 4\n2 0 1\n"
                     "0 0 0\n2 0 0\n2 1 0\n1 2 0\n0 1 0\n");

    (void)state;
    assert_int_equal(m.scene.tri_count, 3);
    assert_int_equal(m.report.entry_count, 1);
    assert_string_equal(m.report.entries[0].text,
                        "a.ply:11: found a face with 2 corners, expected 3 or "
                        "more: face dropped");
    mesh_file_free(&m);
}

/* The winding of a strip alternates, so that all triangles face one side:
 * here the positive z of a row of squares. */
static void strips_keep_their_side(void **state)
{
    struct mesh_file m =
        parse(HEADER "element vertex 6\n" POSITION "element tristrips 1\n" FACE
                     "end_header\n"
                     "0 1 0\n0 0 0\n1 1 0\n1 0 0\n2 1 0\n2 0 0\n"
                     "11 0 1 2 3 4 5 -1 0 1 2 3\n");

    (void)state;
    assert_int_equal(m.scene.tri_count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        const double *p[3];

        for (int k = 0; k < 3; k++)
            p[k] = m.scene.file_positions + 3 * m.scene.tris[i].v[k];
        assert_true((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) >
                    (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
    }
    mesh_file_free(&m);
}

static void normals_and_texture_coordinates_are_read(void **state)
{
    struct mesh_file m =
        parse(HEADER "comment TextureFile skin of it.png\n"
                     "element vertex 3\nproperty float t\n"
                     "property float nx\nproperty float ny\n"
                     "property float nz\nproperty float s\n" POSITION
                     "element face 1\n" FACE "end_header\n"
                     ".25 0 0 2 .5 0 0 0\n1 0 3 4 0 1 0 0\n0 0 0 1 0 0 1 0\n"
                     "3 0 1 2\n");
    const struct scene *s = &m.scene;

    (void)state;
    assert_int_equal(s->tris[0].vn[1], 1);
    check_color(s->normals[0], 0, 0, 1);
    check_color(s->normals[1], 0, .6, .8);
    assert_int_equal(s->tris[0].vt[0], 0);
    check_close((double)s->uvs[0].x, .5, 0);
    check_close((double)s->uvs[0].y, .25, 0);
    assert_int_equal(s->texture_count, 1);
    assert_string_equal(s->texture_paths[0], "skin of it.png");
    mesh_file_free(&m);
}

/* MeshLab writes several images, the number of each face's, and "<this>" for
 * the name of the file. */
static void faces_have_their_own_textures(void **state)
{
    struct mesh_file m =
        parse(HEADER "comment TextureFile x.png\n"
                     "comment TextureFile <this>_B.png\n"
                     "element vertex 3\n" POSITION "element face 4\n" FACE
                     "property list uchar float texcoord\n"
                     "property int texnumber\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n"
                     "3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 0\n"
                     "3 0 1 2 0 -1\n3 0 1 2 6 0 0 1 0 0 1 2\n");
    static const char *const images[] = {"a_B.png", "x.png", NULL, NULL};
    const struct scene *s = &m.scene;

    (void)state;
    assert_int_equal(s->tri_count, 4);
    for (int i = 0; i < 4; i++) {
        const struct material *f = &s->materials[s->tris[i].material];

        if (images[i] != NULL)
            assert_string_equal(s->texture_paths[f->color_texture], images[i]);
        else
            assert_int_equal(f->color_texture, NO_INDEX);
        check_close((double)f->color.x, images[i] != NULL ? 1 : .66, 1e-6);
    }
    assert_int_equal(m.report.entry_count, 1);
    assert_string_equal(m.report.entries[0].text,
                        "a.ply:20: found texture 2 of a face, expected 0 to 1 "
                        "or -1: it has none");
    mesh_file_free(&m);
}

/* trimesh cuts fractions off; Blender and libassimp read 2.5 as 2, too. */
static void fractions_in_lists_are_cut_off(void **state)
{
    struct mesh_file m = parse(HEADER TRIANGLE "3 0 1 2.5\n");

    (void)state;
    check_tri(&m.scene, 0, 0, 1, 2);
    assert_string_equal(m.report.entries[0].text,
                        "a.ply:13: found 2.5, expected a whole number: taken "
                        "as 2");
    mesh_file_free(&m);
    check_refused("a", HEADER TRIANGLE "3 0 1 inf\n",
                  "a:13: found no whole number, expected one");
}

static void corners_may_have_texture_coordinates(void **state)
{
    struct mesh_file m =
        parse(HEADER "element vertex 3\n" POSITION "element face 2\n" FACE
                     "property list uchar float texcoord\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n"
                     "3 0 1 2 6 0 .1 .2 .3 .4 .5\n3 0 1 2 0\n");
    const struct scene *s = &m.scene;

    (void)state;
    assert_int_equal(s->tri_count, 2);
    for (int k = 0; k < 3; k++) {
        check_close((double)s->uvs[s->tris[0].vt[k]].x, .2 * k, 1e-7);
        check_close((double)s->uvs[s->tris[0].vt[k]].y, .2 * k + .1, 1e-7);
        assert_int_equal(s->tris[1].vt[k], NO_INDEX);
    }
    mesh_file_free(&m);
}

/* Two faces share an edge, whose vertices then have a copy for each colour. */
static void colors_of_faces_double_vertices(void **state)
{
    struct mesh_file m =
        parse(HEADER "element vertex 4\n" POSITION "element face 3\n" FACE
                     "property uchar red\nproperty uchar green\n"
                     "property uchar blue\nend_header\n"
                     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                     "3 0 1 2 255 0 0\n3 0 2 3 0 0 51\n3 2 1 0 255 0 0\n");
    const struct scene *s = &m.scene;

    (void)state;
    assert_int_equal(s->position_count, 6);
    for (uint32_t i = 0; i < s->tri_count; i++) {
        for (int k = 0; k < 3; k++) {
            struct vec3 c = s->colors[s->tris[i].v[k]];

            check_color(c, i == 1 ? 0 : 1, 0, i == 1 ? linear(.2) : 0);
        }
    }
    check_position(s, s->tris[1].v[1], 1, 1, 0);
    mesh_file_free(&m);
}

static void fractions_are_colors_up_to_1_or_255(void **state)
{
    static const char *const numbers[] = {"0.5 1 0", "127.5 255 0"};

    (void)state;
    for (int i = 0; i < 2; i++) {
        char text[512];
        struct mesh_file m;

        snprintf(text, sizeof text,
                 HEADER "element vertex 1\n" POSITION
                        "property float r\nproperty float g\n"
                        "property float b\nelement face 1\n" FACE
                        "end_header\n0 0 0 %s\n3 0 0 0\n",
                 numbers[i]);
        m = parse(text);
        check_color(m.scene.colors[0], linear(.5), 1, 0);
        mesh_file_free(&m);
    }
}

static void z_is_up_in_files_of_blender(void **state)
{
    struct mesh_file m = parse(
        HEADER "comment Created in Blender version 4.3.2\n" TRIANGLE "3 0 1 2");

    (void)state;
    assert_true(m.scene.up_is_z);
    mesh_file_free(&m);
}

static void wrong_headers_are_refused(void **state)
{
    (void)state;
    check_refused("a.ply", "",
                  "a.ply: not a PLY file: found no 'ply' in its first line");
    check_refused("a.ply", "ply\n",
                  "a.ply:1: found the end of the file in the header, expected "
                  "end_header");
    check_refused("a", "ply\nformat binary 1.0\n",
                  "a:2: found 'binary', expected the format ascii, "
                  "binary_little_endian or binary_big_endian");
    check_refused("a", "ply\nend_header\n",
                  "a:2: found no format before end_header, expected a line "
                  "such as 'format ascii 1.0'");
    check_refused("a", HEADER "element vertex -1\n",
                  "a:3: found '-1', expected a count of elements");
    check_refused("a", HEADER "element vertex 1e3\n",
                  "a:3: found '1e3', expected a count of elements");
    check_refused("a", HEADER "element\n",
                  "a:3: found the end of the line, expected the name of an "
                  "element");
    check_refused("a", HEADER "property float x\n",
                  "a:3: found a property, expected an element before it");
    check_refused("a", HEADER "element a 1\nproperty real x\n",
                  "a:4: found 'real', expected a type such as float, uchar or "
                  "int");
    check_refused("a", HEADER "element a 1\nproperty list float int x\n",
                  "a:4: found a list with a count that is a fraction, expected "
                  "a whole number");
    check_refused("a", HEADER "element a 1\nproperty int\n",
                  "a:4: found the end of the line, expected the name of a "
                  "property");
    check_refused("a", HEADER "end_header\n",
                  "a: found no element vertex, expected one with x, y and z");
    check_refused("a",
                  HEADER "element vertex 1\nproperty int x\nend_header\n1\n",
                  "a:3: found vertices without x, y and z, expected a number "
                  "for each");
    check_refused("a",
                  HEADER "element vertex 1\n" POSITION
                         "element face 1\nproperty int x\nend_header\n"
                         "1 2 3\n4\n",
                  "a:7: found faces without the list vertex_indices");
    check_refused("a",
                  HEADER "element vertex 2\n" POSITION
                         "end_header\n1 2 3\n4 5 6\n",
                  "a: found 2 points and no face, expected faces: glim does "
                  "not draw clouds of points");
}

static void wrong_data_are_refused(void **state)
{
    (void)state;
    check_refused("a", HEADER TRIANGLE "3 0 1 3\n",
                  "a:13: found vertex 3 in a face, expected 0 to 2");
    check_refused("a", HEADER TRIANGLE "3 0 1 -1\n",
                  "a:13: found vertex -1 in a face, expected 0 to 2");
    check_refused("a", HEADER TRIANGLE "3 0 1 one\n",
                  "a:13: found 'one', expected a number");
    check_refused("a", HEADER TRIANGLE "3 0 1",
                  "a:13: found a list of 3 numbers, expected at most 2 in the "
                  "rest of the file");
    check_refused("a", HEADER TRIANGLE "-3 0 1 2",
                  "a:13: found a list of -3 numbers, expected at most 3 in the "
                  "rest of the file");
    check_refused("a",
                  HEADER "element vertex 1000000000000\n" POSITION
                         "end_header\n1 2 3\n",
                  "a:3: found element vertex 1000000000000 times, expected at "
                  "most 1 in the rest of the file");
    check_refused("a",
                  "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
                  "property char x\nproperty char y\nproperty char z\n"
                  "element face 1\n" FACE "end_header\n1 2 \4 3 0",
                  "a: byte 169: found a list of 32 numbers, expected at most 1 "
                  "in the rest of the file");
}

/* An element without properties takes no time, however many there are. */
static void empty_elements_are_skipped(void **state)
{
    struct mesh_file m =
        parse(HEADER "element nothing 1000000000000000\n" TRIANGLE "3 0 1 2\n");

    (void)state;
    assert_int_equal(m.scene.tri_count, 1);
    mesh_file_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ascii_is_read),
        cmocka_unit_test(binary_is_read_in_both_orders),
        cmocka_unit_test(triangles_are_read_at_once),
        cmocka_unit_test(wrong_triangles_are_refused),
        cmocka_unit_test(many_vertices_are_read_by_threads),
        cmocka_unit_test(lines_may_end_in_any_way),
        cmocka_unit_test(faces_may_come_first_and_be_polygons),
        cmocka_unit_test(strips_keep_their_side),
        cmocka_unit_test(normals_and_texture_coordinates_are_read),
        cmocka_unit_test(corners_may_have_texture_coordinates),
        cmocka_unit_test(colors_of_faces_double_vertices),
        cmocka_unit_test(fractions_are_colors_up_to_1_or_255),
        cmocka_unit_test(faces_have_their_own_textures),
        cmocka_unit_test(fractions_in_lists_are_cut_off),
        cmocka_unit_test(z_is_up_in_files_of_blender),
        cmocka_unit_test(wrong_headers_are_refused),
        cmocka_unit_test(wrong_data_are_refused),
        cmocka_unit_test(empty_elements_are_skipped),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
