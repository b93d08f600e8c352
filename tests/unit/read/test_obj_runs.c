// SPDX-License-Identifier: MIT
/* test_obj_runs.c - plain lines of OBJ text, which all threads read in advance
 */
#include "read/obj_runs.h"

#include "tests/unit/read/obj_texts.h"

struct expected_line {
    const char *begin, *end;
    bool is_plain, is_taken;
};

static bool check_line(void *context, const struct obj_blocks *blocks)
{
    struct expected_line *e = context;
    const struct obj_run *run = blocks->items[0].runs;

    assert_int_equal(blocks->count, 1);
    assert_ptr_equal(blocks->end, e->end);
    if (blocks->items[0].run_count != (e->is_plain ? 1u : 0u))
        print_error("line %s", e->begin);
    assert_int_equal(blocks->items[0].run_count, e->is_plain ? 1 : 0);
    if (e->is_plain) {
        assert_ptr_equal(run->begin, e->begin);
        assert_ptr_equal(run->end, e->end);
        assert_int_equal(run->line_count, 1);
    }
    e->is_taken = true;
    return true;
}

/* Lines that are plain, and lines that are left to the parser. */
static void plain_lines_are_known(void **state)
{
    static const struct {
        const char *line;
        bool is_plain;
    } lines[] = {
        {"v 1 2 3\n", true},
        {"v  -1e3 .5 +2. \r\n", true},
        {"vt .5 1\n", true},
        {"vt .5 1 0\n", true},
        {"vn 0 0 -2\n", true},
        {"f 1 2 3\n", true},
        {"f 1/2 3/4 5/6 7/8\n", true},
        {"f 1//2 3//4 5//6  \n", true},
        {"f 1/2/3 4/5/6 7/8/9\n", true},
        {"v 1 2 3", false},
        {"v 1 2\n", false},
        {"v 1 2 x\n", false},
        {"v 1 2 3x\n", false},
        {"v 1 2 nan\n", false},
        {"v 1 2 1e400\n", false},
        {"v 1 2 1.#INF\n", false},
        {"v 1 2 3 1\n", false},
        {"v 1 2 3 1 0 0\n", false},
        {"v 1 2 3 # c\n", false},
        {"v 1 2 \\\n3\n", false},
        {"v\t1 2 3\n", false},
        {"v 1 2 3\r#\n", false},
        {"vt .5\n", false},
        {"vt .5 1 0 0\n", false},
        {"vn 0 0 0\n", false},
        {"f 1 2\n", false},
        {"f 1 2 0\n", false},
        {"f 1 2 -1\n", false},
        {"f 1 2 3/\n", false},
        {"f 1 2 3//\n", false},
        {"f 1 2 3/4/\n", false},
        {"f 1 2 3/4/5/6\n", false},
        {"f 1 2 3,4\n", false},
        {"f 1 2 1000000000\n", false},
        {"# v 1 2 3\n", false},
        {"\n", false},
        {"g 1\n", false},
        {" v 1 2 3\n", false},
        {"vp 1 2 3\n", false},
        {"fo 1 2 3\n", false},
    };

    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        const char *text = lines[i].line, *end = text + strlen(text);
        struct expected_line e = {text, end, lines[i].is_plain, false};

        assert_true(obj_runs_read(text, end, NULL, check_line, &e));
        assert_true(e.is_taken);
    }
}

/* ---- a long file ---- */

/* A grid of SIDE x SIDE squares, whose lines are many blocks long. */
#define SIDE 400u

static const char *const odd_lines[] = {"",      "# a comment",  "s 1",
                                        "l 1 2", "v\t7 7 \\\n7", "vt .5",
                                        "#\\"};

/* Writes a row of vertices, of which the first has a comment. */
static void write_vertices(FILE *to, uint32_t y)
{
    fprintf(to, "%s\n", odd_lines[y % 4]);
    for (uint32_t x = 0; x <= SIDE; x++)
        fprintf(to, "v %u.25 %u -.5%s\n", x, y, x == 0 ? " # first" : "");
}

/* Writes a row of squares: as two triangles, as a square, and with indices that
 * count backwards. */
static void write_squares(FILE *to, uint32_t y)
{
    uint32_t all = (SIDE + 1) * (SIDE + 1);

    fprintf(to, "o row%u\nusemtl m%u\n", y, y % 3);
    for (uint32_t x = 0; x < SIDE; x++) {
        uint32_t a = y * (SIDE + 1) + x + 1, b = a + SIDE + 1;

        if (y % 3 == 0)
            fprintf(to, "f %u %u %u\nf %u %u %u\n", a, a + 1, b + 1, a, b + 1,
                    b);
        else if (y % 3 == 1)
            fprintf(to, "f %u %u %u %u\n", a, a + 1, b + 1, b);
        else
            fprintf(to, "f -%u -%u -%u\nf %u %u %u\n", all + 1 - a, all - a,
                    all - b, a, b + 1, b);
    }
}

static void check_tri(const struct scene *s, uint32_t tri, const uint32_t v[3],
                      uint32_t row)
{
    char name[16];

    snprintf(name, sizeof name, "row%u", row);
    for (int k = 0; k < 3; k++)
        assert_int_equal(s->tris[tri].v[k], v[k]);
    assert_string_equal(s->object_names[s->tri_objects[tri]], name);
}

/* Rows of squares as triangles have exact corners; those of squares are split
 * along either diagonal. */
static void check_grid(const struct scene *s)
{
    assert_int_equal(s->position_count, (SIDE + 1) * (SIDE + 1));
    assert_int_equal(s->tri_count, 2 * SIDE * SIDE);
    for (uint32_t i = 0; i < s->position_count; i++) {
        assert_true(s->file_positions[3 * i] == i % (SIDE + 1) + .25);
        assert_true(s->file_positions[3 * i + 1] == i / (SIDE + 1));
        assert_true(s->file_positions[3 * i + 2] == -.5);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t y = i / SIDE, a = y * (SIDE + 1) + i % SIDE, b = a + SIDE + 1;

        if (y % 3 == 1)
            continue;
        check_tri(s, 2 * i, (const uint32_t[]){a, a + 1, b + 1}, y);
        check_tri(s, 2 * i + 1, (const uint32_t[]){a, b + 1, b}, y);
    }
}

static void long_files_are_read_line_by_line(void **state)
{
    const char bad[] = "f 1 2 999999\nv 0 0 y\n";
    struct scene scene = {.thread_count = 3};
    struct warnings report = {0};
    struct error err;
    char *text, expected[80];
    size_t size;
    FILE *to = open_memstream(&text, &size);

    (void)state;
    for (uint32_t y = 0; y <= SIDE; y++)
        write_vertices(to, y);
    for (uint32_t y = 0; y < SIDE; y++)
        write_squares(to, y);
    fputs(bad, to);
    fclose(to);
    assert_true(
        obj_parse(&scene, text, size - strlen(bad), "a.obj", &report, &err));
    check_grid(&scene);
    scene_free(&scene);
    warnings_free(&report);

    /* the lines of messages are those of the file */
    report = (struct warnings){0};
    scene = (struct scene){.thread_count = 3};
    assert_false(obj_parse(&scene, text, size, "a.obj", &report, &err));
    uint32_t lines = (SIDE + 1) * (SIDE + 2) + 2 * SIDE + 2 * SIDE * SIDE -
                     (SIDE + 1) / 3 * SIDE;
    snprintf(expected, sizeof expected,
             "a.obj:%u: found 'y' after v, expected a number", lines + 2);
    assert_string_equal(err.text, expected);
    scene_free(&scene);
    warnings_free(&report);
    free(text);
}

/* Between the runs of a long text, every kind of line has its effect. */
static void odd_lines_between_runs_have_their_effect(void **state)
{
    struct loaded l;
    uint32_t count = 0;
    char *text;
    size_t size;
    FILE *to = open_memstream(&text, &size);

    (void)state;
    for (uint32_t i = 0; i < 70000; i++) {
        fprintf(to, "v %u 0 0\n", i);
        fprintf(to, "%s\n", odd_lines[i % 7]);
        count += 1 + (i % 7 == 4);
    }
    fputs("f 1 2 3\n", to);
    fclose(to);
    l = load_bytes(text, size);
    assert_true(l.ok);
    assert_int_equal(l.scene.position_count, count);
    assert_int_equal(l.scene.uv_count, 10000);
    assert_true(l.scene.file_positions[3 * 5] == 7);
    assert_true(l.scene.file_positions[3 * (size_t)(count - 1)] == 69999);
    assert_int_equal(l.scene.tri_count, 1);
    unload(&l);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_lines_are_known),
        cmocka_unit_test(long_files_are_read_line_by_line),
        cmocka_unit_test(odd_lines_between_runs_have_their_effect),
    };

    return cmocka_run_group_tests_name("obj_runs", tests, NULL, NULL);
}
