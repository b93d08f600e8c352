// SPDX-License-Identifier: MIT
/* STL files, ascii and binary, their colours, and the messages for wrong ones.
 */
#include "tests/unit/read/meshes.h"

#define FACET                                                      \
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n" \
    "vertex 0 1 0\nendloop\nendfacet\n"

static struct mesh_file parse(const char *text)
{
    return parse_good("a.stl", text, strlen(text));
}

/* Appends a triangle in the plane z, with an attribute. */
static void add_facet(struct bytes *b, float z, unsigned attribute)
{
    const float corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};

    for (int k = 0; k < 3; k++)
        add_float(b, NAN);
    for (int k = 0; k < 3; k++) {
        add_float(b, corners[k][0]);
        add_float(b, corners[k][1]);
        add_float(b, z);
    }
    add_bits(b, attribute, 2);
}

/* Begins a file whose header has 10 bytes behind a text. */
static void begin(struct bytes *b, const char *header, const char *behind,
                  unsigned count)
{
    *b = (struct bytes){.is_big = false};
    add_text(b, header);
    memcpy(b->data + b->size, behind, 10);
    b->size = 80;
    add_bits(b, count, 4);
}

static void text_is_read(void **state)
{
    struct mesh_file m = parse(
        "\n  SOLID facet normal of endsolid\n" FACET "endsolid x\r\n"
        "solid\n\tFacet  Normal nan\nOUTER LOOP vertex -0 0 -0 vertex 1 0 0\n"
        "vertex -0 -1e0 0 endloop endfacet");
    const struct scene *s = &m.scene;

    (void)state;
    assert_int_equal(s->tri_count, 2);
    assert_int_equal(s->position_count, 4);
    check_position(s, s->tris[1].v[2], 0, -1, 0);
    assert_int_equal(s->tris[1].v[0], s->tris[0].v[0]);
    assert_int_equal(s->object_count, 2);
    assert_string_equal(s->object_names[s->tri_objects[0]],
                        "facet normal of endsolid");
    assert_string_equal(s->object_names[s->tri_objects[1]], "");
    assert_true(s->up_is_z);
    mesh_file_free(&m);
}

static void size_decides_what_is_binary(void **state)
{
    static const char none[10] = "";
    struct bytes b;

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct mesh_file m;

        begin(&b, "solid of a program", none, 2);
        add_facet(&b, 0, 0);
        add_facet(&b, 1, 0);
        if (i == 1)
            add_text(&b, "behind"); /* the name then has to tell it */
        assert_string_equal(
            scene_format_of(i == 0 ? "a" : "a.STL", b.data, b.size)->name,
            "STL");
        m = parse_good("a.stl", b.data, b.size);
        assert_int_equal(m.scene.tri_count, 2);
        assert_int_equal(m.scene.position_count, 6);
        assert_null(m.scene.colors);
        mesh_file_free(&m);
    }
}

/* Programs that write a stream leave the count 0 or -1. */
static void counts_of_streams_are_mended(void **state)
{
    static const char none[10] = "";
    static const struct {
        unsigned count;
        const char *message;
    } streams[] = {
        {0, "a.stl: byte 80: found 0 triangles and room for 1: read them"},
        {UINT32_MAX,
         "a.stl: byte 80: found -1 triangles and room for 1: read them"}};

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct mesh_file m;
        struct bytes b;

        begin(&b, "stream", none, streams[i].count);
        add_facet(&b, 0, 0);
        m = parse_good("a.stl", b.data, b.size);
        assert_int_equal(m.scene.tri_count, 1);
        assert_string_equal(m.report.entries[0].text, streams[i].message);
        mesh_file_free(&m);
    }
}

/* Checks the colour of the corners of a triangle. */
static void check_facet(const struct scene *s, uint32_t tri, double r, double g,
                        double b)
{
    for (int k = 0; k < 3; k++)
        check_color(s->colors[s->tris[tri].v[k]], linear(r), linear(g),
                    linear(b));
}

/* VisCAM: bit 15 set, then red, green and blue from the highest bits. */
static void colors_of_viscam_are_read(void **state)
{
    static const char none[10] = "";
    struct mesh_file m;
    struct bytes b;

    (void)state;
    begin(&b, "", none, 3);
    add_facet(&b, 0, 0x8000 | 31 << 10 | 15 << 5 | 1);
    add_facet(&b, 0, 31 << 10); /* not set */
    add_facet(&b, 1, 0x8000);
    m = parse_good("a.stl", b.data, b.size);
    check_facet(&m.scene, 0, 1, 15 / 31., 1 / 31.);
    check_facet(&m.scene, 1, .66, .6, .54); /* clay */
    check_facet(&m.scene, 2, 0, 0, 0);
    assert_int_equal(m.scene.position_count, 9);
    mesh_file_free(&m);
}

/* Magics: bit 15 clear, then blue, green and red from the highest bits, and the
 * colour of all others in the header. */
static void colors_of_magics_are_read(void **state)
{
    static const char color[10] = {'C', 'O', 'L', 'O', 'R',
                                   '=', 51,  102, 0,   (char)255};
    struct bytes b;

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct mesh_file m;

        begin(&b, "Magics ", color, 2);
        add_facet(&b, 0, i == 0 ? 31 | 15 << 5 | 1 << 10 : 0);
        add_facet(&b, 1, i == 0 ? 0x8000 : 0);
        m = parse_good("a.stl", b.data, b.size);
        if (i == 0)
            check_facet(&m.scene, 0, 1, 15 / 31., 1 / 31.);
        else
            check_facet(&m.scene, 0, .2, .4, 0);
        check_facet(&m.scene, 1, .2, .4, 0);
        mesh_file_free(&m);
    }
}

static void wrong_texts_are_refused(void **state)
{
    (void)state;
    check_refused("a.stl", "",
                  "a.stl: not an STL file: found 0 bytes, expected a text that "
                  "begins with 'solid' or at least 84 bytes");
    check_refused("a", "solid a\nvertex 1 2 3\n",
                  "a:2: found 'vertex', expected facet, solid or endsolid");
    check_refused("a", "solid a\nfacet normal 0 0 1\nouter loop\nendloop\n",
                  "a:4: found 'endloop', expected vertex");
    check_refused("a", "solid a\nfacet\nouter loop\nvertex 1 2 x\n",
                  "a:4: found 'x', expected a number");
    check_refused("a", "solid a\nfacet\nouter loop\nvertex 1 2\n",
                  "a:5: found the end of the file, expected a number");
    check_refused("a", "solid a\nfacet\n",
                  "a:3: found the end of the file, expected outer");
}

static void short_data_are_refused(void **state)
{
    static const char none[10] = "";
    struct mesh_file m;
    struct bytes b;

    (void)state;
    begin(&b, "", none, 2);
    add_facet(&b, 0, 0);
    m = parse_bytes("a.stl", b.data, b.size);
    assert_false(m.ok);
    assert_string_equal(m.err.text,
                        "a.stl: byte 80: found 2 triangles, expected at most 1 "
                        "in the rest of the file");
    mesh_file_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_read),
        cmocka_unit_test(size_decides_what_is_binary),
        cmocka_unit_test(counts_of_streams_are_mended),
        cmocka_unit_test(colors_of_viscam_are_read),
        cmocka_unit_test(colors_of_magics_are_read),
        cmocka_unit_test(wrong_texts_are_refused),
        cmocka_unit_test(short_data_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
