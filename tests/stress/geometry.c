// SPDX-License-Identifier: MIT
/*
 * geometry - pictures of geometry that is known to break ray tracers
 *
 * Most rows are in a closed room of albedo 1/2 and emission 1/2, where radiance
 * is 1 / 2 / (1 - 1 / 2) = 1 for all shapes. A leak, self-shadowing or lost
 * light makes it darker.
 *
 * usage: geometry [opencl]
 */
#include "lamp.h"
#include "tests/unit/check.h"

#define ROOM "Kd .5 .5 .5\nKe .5 .5 .5"

/* Adds the room's faces, from (-1, -1, -1) to (1, 1, 1). */
static void put_room(struct stress_scene *s)
{
    put_material(s, "room", ROOM);
    put_box(s, (double[]){-1, -1, -1}, (double[]){1, 1, 1});
}

static const struct shot inside = {.eye = {0.1, 0.2, 0.9},
                                   .at = {0.1, 0, 0},
                                   .fovy_deg = 90};

/* G1: faces with three equal corners, two equal ones, or all on a line; black
 * if visible. */
static void degenerate_room(struct stress_scene *s, double number)
{
    (void)number;
    put_room(s);
    put_material(s, "black", "Kd 0 0 0");
    for (int i = 0; i < 100; i++) {
        double x = i * 0.01 - 0.5;
        const double point[3] = {x, x, x}, other[3] = {x, -x, 0};
        const double middle[3] = {x, 0, x / 2};

        put_tri(s, (const double[3][3]){{x, x, x}, {x, x, x}, {x, x, x}});
        put_tri(s, (const double[3][3]){{point[0], point[1], point[2]},
                                        {point[0], point[1], point[2]},
                                        {other[0], other[1], other[2]}});
        put_tri(s, (const double[3][3]){{point[0], point[1], point[2]},
                                        {middle[0], middle[1], middle[2]},
                                        {other[0], other[1], other[2]}});
    }
}

/* G2: vertices with NaN. */
static void room_with_nan(struct stress_scene *s, double number)
{
    static const char *const bad[] = {"nan", "inf", "-inf", "1e999"};

    (void)number;
    put_room(s);
    for (int i = 0; i < 4; i++)
        fprintf(s->obj, "v %s 0 0\nv 0 %s 0\nv 0 0 1\nf -3 -2 -1\n", bad[i],
                bad[i]);
}

static void put_hill(struct stress_scene *s, int i, int j)
{
    put_vertex(s, i / 6.0 - 1, sin(i * 1.3) * cos(j * 0.9) / 4, j / 6.0 - 1);
}

/* G3: hills whose faces have four separate vertices each (1), or shared
 * vertices with unrelated ones between them (0). */
static void hills(struct stress_scene *s, double is_split)
{
    const int side = 13;

    put_material(s, "hills", "Kd .8 .8 .8");
    for (int k = 0; k < side * side && is_split == 0; k++) {
        put_hill(s, k / side, k % side);
        put_vertex(s, 1e30, -1e30, 1e30);
    }
    for (int i = 0; i + 1 < side; i++)
        for (int j = 0; j + 1 < side; j++) {
            const int k = 2 * (i * side + j) + 1;

            if (is_split == 0) {
                fprintf(s->obj, "f %d %d %d %d\n", k, k + 2, k + 2 * side + 2,
                        k + 2 * side);
                continue;
            }
            put_hill(s, i, j);
            put_hill(s, i, j + 1);
            put_hill(s, i + 1, j + 1);
            put_hill(s, i + 1, j);
            fprintf(s->obj, "f -4 -3 -2 -1\n");
        }
}

/* G4, G19: needles. */
static void needle_room(struct stress_scene *s, double width)
{
    uint64_t seed = 1;

    put_room(s);
    for (int i = 0; i < 300; i++) {
        double p[3][3];

        for (int k = 0; k < 3; k++) {
            p[0][k] = check_random(&seed) - 0.5;
            p[1][k] = check_random(&seed) - 0.5;
            p[2][k] = p[0][k] + width * (check_random(&seed) - 0.5);
        }
        put_tri(s, (const double(*)[3])p);
    }
}

/* G5: this many white faces at one place, under an open sky. */
static void coincident(struct stress_scene *s, double count)
{
    put_material(s, "white", "Kd .9 .9 .9");
    for (int i = 0; i < count; i++)
        put_quad(s, 1, 0, (double[]){-1, -1}, (double[]){1, 1});
    put_box(s, (double[]){-0.3, 0.2, -0.3}, (double[]){0.3, 0.8, 0.3});
}

/* G6: a bright face (number 0) or a black one comes first, at the same
 * place. */
static void two_materials(struct stress_scene *s, double first)
{
    for (int i = 0; i < 2; i++) {
        bool is_bright = (i == 0) == (first == 0);

        put_material(s, is_bright ? "bright" : "black",
                     is_bright ? "Kd 0 0 0\nKe 1 1 1" : "Kd 0 0 0");
        put_quad(s, 1, 0, (double[]){-9, -9}, (double[]){9, 9});
    }
}

/* G6: triangles in slanted planes, bright (0) or black (1). Unless 2 is added,
 * each is followed in the file by a copy of the other colour, which begins at
 * another corner or has the opposite winding. */
static void slanted(struct stress_scene *s, double number)
{
    static const char *const orders[] = {"-3 -2 -1", "-2 -1 -3", "-1 -3 -2",
                                         "-3 -1 -2", "-1 -2 -3", "-2 -3 -1"};
    static const char *const names[] = {"bright", "black"};
    const int first = (int)number % 2, copies = number < 2 ? 2 : 1;
    uint64_t seed = 3;

    put_shining(s, names[0], 1);
    put_material(s, names[1], "Kd 0 0 0");
    for (int i = 0; i < 60; i++) {
        double x = (i % 10 - 5) / 5.0, z = (i / 10 - 3) / 5.0;
        double lean = check_random(&seed) / 5, turn = check_random(&seed) / 5;

        put_vertex(s, x, 0, z);
        put_vertex(s, x + 0.18, lean, z + turn / 9);
        put_vertex(s, x, turn, z + 0.18);
        for (int k = 0; k < copies; k++)
            fprintf(s->obj, "usemtl %s\nf %s\n", names[(first + k) % 2],
                    orders[k * i % 6]);
    }
}

/* G7: boxes around one point. */
static void nested_room(struct stress_scene *s, double count)
{
    put_room(s);
    for (int i = 1; i <= count; i++) {
        double a = 0.5 * i / count;

        put_box(s, (double[]){-a, -a / 2, -a}, (double[]){a, a / 2, a});
    }
}

/* Adds a floor and this many lamps above it. */
static void lamps_over_floor(struct stress_scene *s, double count)
{
    put_floor(s);
    put_shining(s, "lamp", 1);
    for (int i = 0; i < count; i++)
        put_quad(s, 1, 0.7, lamp_lo, lamp_hi);
}

/* G9: each box is half as large as the one before. */
static void chain_room(struct stress_scene *s, double count)
{
    put_room(s);
    for (int k = 0; k < count; k++) {
        double x = ldexp(0.5, -k);

        put_tri(s, (const double[3][3]){{x, 0, 0}, {x, x, false}, {x, 0, x}});
    }
}

/* G10: no visible face (0) or one triangle (1). */
static void one_or_none(struct stress_scene *s, double count)
{
    put_material(s, "lamp", "Kd 0 0 0\nKe 1 1 1");
    put_vertex(s, -1, 0, 0);
    put_vertex(s, 1, 0, 0);
    put_vertex(s, 0, 1, 0);
    fprintf(s->obj, count > 0 ? "f 1 2 3\n" : "p 1\nl 1 2 3\n");
}

/* G12: a long corridor of perfect mirrors. A path to its end meets walls and
 * edges 10 to 150 times. */
static void mirror_corridor(struct stress_scene *s, double length)
{
    put_material(s, "mirror", "illum 3\nKs 1 1 1");
    put_box(s, (double[]){-1, -1, -length}, (double[]){1, 1, 1});
    put_material(s, "end", "Kd 0 0 0\nKe 1 1 1");
    put_quad(s, 2, 0.01 - length, (double[]){-1, -1}, (double[]){1, 1});
}

/* G14: all faces are in one plane across this axis. */
static void flat_scene(struct stress_scene *s, double axis)
{
    put_material(s, "lamp", "Kd .5 .5 .5\nKe 1 1 1");
    put_quad(s, (int)axis, 0, (double[]){-9, -9}, (double[]){9, 9});
}

/* G15, G18: the room is beside something so far away that its coordinates have
 * few digits. */
static void room_far_off(struct stress_scene *s, double distance)
{
    const double x = distance, y = distance / 3;

    put_room(s);
    put_tri(s, (const double[3][3]){{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 1}});
}

/* G18: a lamp over a floor of this size, of two triangles. */
static void huge_floor(struct stress_scene *s, double size)
{
    lamps_over_floor(s, 1);
    put_material(s, "wide", "Kd 0 0 0");
    put_quad(s, 1, -1, (double[]){-size, -size}, (double[]){size, size});
}

/* G18: a closed slab that is this much wider than high. */
static void wide_slab(struct stress_scene *s, double width)
{
    put_material(s, "room", ROOM);
    put_box(s, (double[]){-width, -1, -width}, (double[]){width, 1, width});
}

/* G17: this many clear sheets at distances of 1e-5 before a lamp. */
static void thin_sheets(struct stress_scene *s, double count)
{
    put_material(s, "lamp", "Kd 0 0 0\nKe 1 1 1");
    put_quad(s, 2, -1, (double[]){-1, -1}, (double[]){1, 1});
    put_material(s, "glass", "illum 7\nNi 1.5");
    for (int i = 0; i < count; i++)
        put_box(s, (double[]){-1, -1, -0.2 * i - 1e-5},
                (double[]){1, 1, -0.2 * i});
}

/* G20: the lamp in 1024 tiles, in order (0) or shuffled. */
static void tiled_lamp(struct stress_scene *s, double is_shuffled)
{
    lamps_over_floor(s, 0);
    for (int i = 0; i < 1024; i++) {
        int k = is_shuffled != 0 ? i * 389 % 1024 : i;
        double z = k % 32 * 0.6 / 32 - 0.3, x = k / 32 * 0.8 / 32 - 0.4;

        put_quad(s, 1, 0.7, (double[]){z, x},
                 (double[]){z + 0.6 / 32, x + 0.8 / 32});
    }
}

static void plain_room(struct stress_scene *s, double number)
{
    (void)number;
    put_room(s);
}

/* Closed forms hold for moved and scaled scenes. */
static void moved_and_scaled(struct stress_scene *s)
{
    static const double moves[] = {1e4, 1e5, 1e6};
    static const double scales[] = {1e-6, 1e-5, 1e-4, 1e4, 1e6};
    struct truth room = {"G15 moved room", "",   plain_room, 0, 1, 0,
                         inside,           false};
    struct truth lamp = {"G15 moved lamp", "",   lamps_over_floor, 1, 0, 0,
                         at_floor,         false};
    char what[64];

    lamp.want = lit_floor();
    room.what = lamp.what = what;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            s->move[k] = moves[i] * (k == 1 ? -1 : 1);
        snprintf(what, sizeof what, "by %g", moves[i]);
        check_truth(s, &room);
        check_truth(s, &lamp);
    }
    memset(s->move, 0, sizeof s->move);
    room.name = "G16 scaled room";
    lamp.name = "G16 scaled lamp";
    for (int i = 0; i < 5; i++) {
        s->scale = scales[i];
        snprintf(what, sizeof what, "by %g", scales[i]);
        check_truth(s, &room);
        check_truth(s, &lamp);
    }
    s->scale = 1;
}

static void check_truths(struct stress_scene *s)
{
    const double lit = lit_floor(), r = 0.04;
    const struct shot above = {.eye = {0.3, 2, 0.2},
                               .at = {0, 0, 0.1},
                               .fovy_deg = 40};
    const struct shot before = {.eye = {0, 0.5, 5},
                                .at = {0, 0.5, 0},
                                .fovy_deg = 40,
                                .background = 0.25};
    /* This is the height and width of the picture at the triangle. */
    const double height = 2 * 5 * tan(20 * M_PI / 180);
    const double share = 1 / (height * height);
    const struct shot face_on = {.eye = {0.1, 0.2, 1},
                                 .at = {0.1, 0.2, 0},
                                 .fovy_deg = 0.01};
    const struct shot on_floor = {.eye = {0.1, -1, 0.3},
                                  .at = {0, 0.2, 0},
                                  .fovy_deg = 60};
    const struct shot on_edge = {.eye = {-1, -1, 0.3},
                                 .at = {0, 0.2, 0},
                                 .fovy_deg = 60};
    const struct shot on_corner = {.eye = {-1, -1, 1},
                                   .at = {0, 0, 0},
                                   .fovy_deg = 40};
    const struct shot across = {.eye = {0.1, 0.2, 0},
                                .at = {1.1, 1, -0.6},
                                .fovy_deg = 25};
    /* A ray tests all faces at one place, so there are fewer rays. */
    const struct shot few = {.eye = {0.5, 0.4, 1.2},
                             .at = {0.5, 0, 0.2},
                             .fovy_deg = 0.01,
                             .spp = 4};
    const struct shot flats[] = {
        {.eye = {2, .3, .2}, .at = {0, 0, 0}, .fovy_deg = 40},
        {.eye = {.3, 2, .2}, .at = {0, 0, 0}, .fovy_deg = 40},
        {.eye = {.3, .2, 2}, .at = {0, 0, 0}, .fovy_deg = 40}};
    const struct truth truths[] = {
        {"G1", "faces without area", degenerate_room, 0, 1, 0, inside, true},
        {"G2", "vertices that are not finite", room_with_nan, 0, 1, 0, inside,
         true},
        {"G4", "needles of 1e-4", needle_room, 1e-4, 1, 0, inside, false},
        {"G4", "needles of 1e-7", needle_room, 1e-7, 1, 0, inside, true},
        {"G6", "a bright face before a black one", two_materials, 0, 1, 0,
         above, false},
        {"G6", "a black face before a bright one", two_materials, 1, 0, 0,
         above, false},
        {"G7", "1000 boxes around one point", nested_room, 1000, 1, 0, inside,
         false},
        {"G8", "256 lamps at one place", lamps_over_floor, 256, lit, 0,
         at_floor, false},
        {"G8", "65536 lamps at one place", lamps_over_floor, 65536, lit, 0, few,
         false},
        {"G8", "70000 lamps at one place", lamps_over_floor, 70000, lit, 0, few,
         false},
        {"G9", "a chain of 200 halves", chain_room, 200, 1, 0, inside, true},
        {"G10", "one triangle", one_or_none, 1, share + 0.25 * (1 - share), 0,
         before, false},
        {"G10", "points and lines", one_or_none, 0, 0.25, 0, before, false},
        {"G12", "a corridor of mirrors", mirror_corridor, 40, 1, 0, across,
         false},
        {"G14", "flat across x", flat_scene, 0, 1, 0, flats[0], false},
        {"G14", "flat across y", flat_scene, 1, 1, 0, flats[1], false},
        {"G14", "flat across z", flat_scene, 2, 1, 0, flats[2], false},
        {"G15", "room with a thing at 1e3", room_far_off, 1e3, 1, 0, inside,
         false},
        {"G15", "room with a thing at 1e4", room_far_off, 1e4, 1, 0, inside,
         false},
        {"G15", "room with a thing at 1e5", room_far_off, 1e5, 1, 0, inside,
         false},
        {"G17", "1 sheet of 1e-5", thin_sheets, 1, 1 / (1 + 2 * r / (1 - r)), 0,
         face_on, false},
        {"G17", "4 sheets of 1e-5", thin_sheets, 4, 1 / (1 + 8 * r / (1 - r)),
         0, face_on, false},
        {"G18", "lamp over a floor of 1e4", huge_floor, 1e4, lit, 0, at_floor,
         false},
        {"G18", "slab 1e2 times as wide as high", wide_slab, 1e2, 1, 0, inside,
         false},
        {"G18", "slab 1e4 times as wide as high", wide_slab, 1e4, 1, 0, inside,
         false},
        {"G20", "1024 lamps in order", tiled_lamp, 0, lit, 0, at_floor, false},
        {"G20", "1024 lamps shuffled", tiled_lamp, 1, lit, 0, at_floor, false},
        {"C4", "eye on a face", plain_room, 0, 1, 0, on_floor, false},
        {"C4", "eye on an edge", plain_room, 0, 1, 0, on_edge, false},
        {"C4", "eye on a corner", plain_room, 0, 1, 0, on_corner, false},
        {"C4",
         "eye on the face of a box in a room",
         nested_room,
         1,
         1,
         0,
         {.eye = {0.1, 0.25, 0.1}, .at = {0, 0.6, 0}, .fovy_deg = 60},
         false},
    };

    for (size_t i = 0; i < sizeof truths / sizeof truths[0]; i++)
        check_truth(s, &truths[i]);
}

static void check_pairs(struct stress_scene *s)
{
    const struct shot from_above = {.eye = {1, 2, 3},
                                    .at = {0, 0, 0},
                                    .fovy_deg = 40,
                                    .background = 1};
    const struct twins twins[] = {
        {"G3", "shared vertices among strangers, or vertices of their own",
         hills, 0, 1, from_above},
        {"G5", "200 coincident faces or one", coincident, 200, 1, from_above},
        {"G6", "bright slanted faces with black copies, or without", slanted, 0,
         2, from_above},
        {"G6", "black slanted faces with bright copies, or without", slanted, 1,
         3, from_above},
        {"G5 G6", "one picture twice", two_materials, 0, 0, from_above},
    };

    for (size_t i = 0; i < sizeof twins / sizeof twins[0]; i++)
        check_twins(s, &twins[i]);
}

int main(int argc, char **argv)
{
    struct stress_scene s;

    (void)argv;
    if (!stress_scene_open(&s, argc > 1))
        return 0;
    check_truths(&s);
    check_pairs(&s);
    moved_and_scaled(&s);
    stress_scene_close(&s);
    return rows_status();
}
