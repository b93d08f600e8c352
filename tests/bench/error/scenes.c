// SPDX-License-Identifier: MIT
/*
 * scenes - writes special scenes that are not shipped, to measure the limits of
 * light sampling: plates lamps2000 sun balls sunball; some with a layer or a
 * glass of the principled surface: coat sheen grain film absorbing frosted; and
 * two to compare with other renderers: glass_box, whose glass has flat sides
 * only, and door_room
 *
 * usage: scenes FOLDER
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scenes/mesh.h"
#include "terminal/xmalloc.h"

static const char *folder;

static void write_file(const char *name, const void *data, size_t size_bytes)
{
    char *path = xformat("%s/%s", folder, name);
    struct error err;

    if (!file_write(path, data, size_bytes, false, NULL, &err)) {
        fprintf(stderr, "scenes: %s\n", err.text);
        exit(1);
    }
    free(path);
}

static void write_text(const char *name, const char *text)
{
    write_file(name, text, strlen(text));
}

/* Returns the same sequence of numbers in [0, 1) every time. */
static double next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state / 4294967296.0;
}

/* Adds a plate, 8 wide and 1.1 deep, that reflects `lamp` to `eye`, which are
 * both on x = 0. */
static void plate(struct mesh *m, struct point eye, struct point lamp, double y,
                  double z)
{
    double to_eye = atan2(eye.y - y, eye.z - z);
    double to_lamp = atan2(lamp.y - y, lamp.z - z);
    double along = (to_eye + to_lamp - 3.14159265358979323846) / 2;
    double dy = .55 * sin(along), dz = .55 * cos(along);

    mesh_quad(m, at(-4, y + dy, z + dz), at(4, y + dy, z + dz),
              at(4, y - dy, z - dz), at(-4, y - dy, z - dz), 1, 1);
}

/* After Veach 1997, figure 9.2: plates from nearly smooth to rough below lamps
 * of equal power from small to large. */
static void make_plates(void)
{
    static const char *const names[] = {"smooth", "glossy", "dull", "rough"};
    static const double places[][2] = {{-2.4, -.1},
                                       {-3.05, .9},
                                       {-3.55, 2.2},
                                       {-3.85, 3.6}};
    static const double radii[] = {.033, .1, .3, .9};
    static const char *const lamps[] = {"lamp_a", "lamp_b", "lamp_c", "lamp_d"};
    struct point eye = at(0, 2, 15);
    struct mesh m = mesh_open(folder, "plates",
                              "Glossy plates under lamps of several sizes.");

    mesh_object(&m, "room", "room");
    mesh_quad(&m, at(-10, -4.4, 20), at(10, -4.4, 20), at(10, -4.4, -2),
              at(-10, -4.4, -2), 1, 1);
    mesh_quad(&m, at(-10, -4.4, -2), at(10, -4.4, -2), at(10, 8, -2),
              at(-10, 8, -2), 1, 1);
    for (int i = 0; i < 4; i++) {
        mesh_object(&m, names[i], names[i]);
        plate(&m, eye, at(0, 0, 0), places[i][0], places[i][1]);
        mesh_object(&m, lamps[i], lamps[i]);
        mesh_sphere(&m, at(-3.75 + 2.5 * i, 0, 0), radii[i], 3);
    }
    mesh_close(&m);
    write_text("plates.mtl", "newmtl room\nKd .4 .4 .4\nillum 1\n"
                             "newmtl smooth\nKd .9 .9 .9\nPm 1\nPr .07\n"
                             "newmtl glossy\nKd .9 .9 .9\nPm 1\nPr .14\n"
                             "newmtl dull\nKd .9 .9 .9\nPm 1\nPr .22\n"
                             "newmtl rough\nKd .9 .9 .9\nPm 1\nPr .32\n"
                             "newmtl lamp_a\nKd 0 0 0\nKe 900 900 900\n"
                             "newmtl lamp_b\nKd 0 0 0\nKe 98 98 98\n"
                             "newmtl lamp_c\nKd 0 0 0\nKe 10.9 10.9 10.9\n"
                             "newmtl lamp_d\nKd 0 0 0\nKe 1.21 1.21 1.21\n");
    write_text("plates.view", "eye 0 2 15\nat 0 -2 2.5\nup 0 1 0\nfovy 24\n"
                              "res 1024 576\n");
}

static void make_lamps2000(void)
{
    uint32_t state = 2000;
    struct mesh m = mesh_open(folder, "lamps2000",
                              "2,000 lamps of powers 1 to 100 among pillars.");

    mesh_object(&m, "floor", "stone");
    mesh_quad(&m, at(-12, 0, 12), at(12, 0, 12), at(12, 0, -12),
              at(-12, 0, -12), 1, 1);
    mesh_object(&m, "pillars", "stone");
    for (int row = 0; row < 7; row++)
        for (int i = 0; i < 7; i++)
            mesh_box(&m, at(-10.5 + 3.5 * i, .001, -10.5 + 3.5 * row),
                     at(.7, 2.5, .7), 17 * (7 * row + i));
    for (int i = 0; i < 2000; i++) {
        double x = 23 * next_random(&state) - 11.5;
        double y = .2 + 2.8 * next_random(&state);
        double z = 23 * next_random(&state) - 11.5;
        double size = .02 + .04 * next_random(&state);
        double u = next_random(&state);

        mesh_object(&m, "lamp", u < .6 ? "dim" : u < .9 ? "lamp" : "bright");
        mesh_quad(&m, at(x - size, y, z - size), at(x + size, y, z - size),
                  at(x + size, y, z + size), at(x - size, y, z + size), 1, 1);
    }
    mesh_close(&m);
    write_text("lamps2000.mtl", "newmtl stone\nKd .6 .57 .52\nillum 1\n"
                                "newmtl dim\nKd 0 0 0\nKe 6 5 4\n"
                                "newmtl lamp\nKd 0 0 0\nKe 40 35 30\n"
                                "newmtl bright\nKd 0 0 0\nKe 300 250 200\n");
    write_text("lamps2000.view", "eye 2 7 17\nat 0 .6 0\nup 0 1 0\nfovy 38\n"
                                 "res 1024 576\n");
}

/* Writes a blue sky with a sun of one texel: 0.7 degrees, with five times as
 * much light as the rest. Rows of a PFM file begin at the bottom. */
static void write_sun(void)
{
    enum { W = 512, H = 256 };
    static const char header[] = "PF\n512 256\n-1\n";
    static char file[sizeof header - 1 + sizeof(float[H][W][3])];
    static float texels[H][W][3];

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int k = 0; k < 3; k++)
                texels[y][x][k] = (float)((.2 + .1 * k) *
                                          (y < H / 2 ? .4 : 1.5 - 1.0 * y / H));
    for (int k = 0; k < 3; k++)
        texels[190][150][k] = (float)(5e4 * (1 - .1 * k));
    memcpy(file, header, sizeof header - 1);
    memcpy(file + sizeof header - 1, texels, sizeof texels);
    write_file("sun.pfm", file, sizeof file);
}

static void make_sun(void)
{
    struct mesh m =
        mesh_open(folder, "sun", "Things outdoors under an image with a sun.");

    mesh_object(&m, "ground", "ground");
    mesh_quad(&m, at(-50, 0, 50), at(50, 0, 50), at(50, 0, -50),
              at(-50, 0, -50), 1, 1);
    mesh_object(&m, "box", "white");
    mesh_box(&m, at(-1.4, .001, 0), at(1.2, 2, 1.2), 25);
    mesh_object(&m, "ball", "red");
    mesh_sphere(&m, at(.9, .801, .4), .8, 6);
    mesh_object(&m, "wall", "white");
    mesh_box(&m, at(0, .001, -2.5), at(6, 1.5, .3), 0);
    mesh_close(&m);
    write_text("sun.mtl", "newmtl ground\nKd .4 .38 .3\nillum 1\n"
                          "newmtl white\nKd .75 .75 .73\nillum 1\n"
                          "newmtl red\nKd .7 .2 .15\nillum 1\n");
    write_text("sun.view", "eye 1.5 3 9\nat 0 .9 0\nup 0 1 0\nfovy 36\n"
                           "res 1024 576\nsky sun.pfm\n");
    write_sun();
}

static void make_balls(void)
{
    struct mesh m =
        mesh_open(folder, "balls",
                  "A glass ball and glossy balls in a room with a lamp.");

    mesh_object(&m, "room", "white");
    mesh_quad(&m, at(-2, 0, 2), at(2, 0, 2), at(2, 0, -2), at(-2, 0, -2), 1, 1);
    mesh_quad(&m, at(-2, 0, -2), at(2, 0, -2), at(2, 3, -2), at(-2, 3, -2), 1,
              1);
    mesh_quad(&m, at(-2, 3, -2), at(2, 3, -2), at(2, 3, 2), at(-2, 3, 2), 1, 1);
    mesh_object(&m, "left", "red");
    mesh_quad(&m, at(-2, 0, 2), at(-2, 0, -2), at(-2, 3, -2), at(-2, 3, 2), 1,
              1);
    mesh_object(&m, "right", "green");
    mesh_quad(&m, at(2, 0, -2), at(2, 0, 2), at(2, 3, 2), at(2, 3, -2), 1, 1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-.4, 2.99, -.4), at(.4, 2.99, -.4), at(.4, 2.99, .4),
              at(-.4, 2.99, .4), 1, 1);
    mesh_object(&m, "glass", "glass");
    mesh_sphere(&m, at(-.9, .601, .5), .6, 8);
    mesh_object(&m, "gold", "gold");
    mesh_sphere(&m, at(.5, .601, -.7), .6, 8);
    mesh_object(&m, "plastic", "plastic");
    mesh_sphere(&m, at(1.1, .451, .7), .45, 8);
    mesh_close(&m);
    write_text("balls.mtl", "newmtl white\nKd .73 .72 .7\nillum 1\n"
                            "newmtl red\nKd .6 .1 .08\nillum 1\n"
                            "newmtl green\nKd .15 .45 .12\nillum 1\n"
                            "newmtl lamp\nKd 0 0 0\nKe 22 20 17\nillum 1\n"
                            "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
                            "newmtl gold\nKd 1 .78 .34\nPm 1\nPr .3\n"
                            "newmtl plastic\nKd .2 .3 .6\nKs .04 .04 .04\n"
                            "Ns 100\nillum 2\n");
    write_text("balls.view", "eye 0 1.5 6.5\nat 0 1.4 0\nup 0 1 0\nfovy 38\n"
                             "res 600 600\n");
}

/* The ground is 40 times as wide as the caustic. */
static void make_sunball(void)
{
    struct mesh m = mesh_open(folder, "sunball", "A glass ball under the sun.");

    mesh_object(&m, "ground", "ground");
    mesh_quad(&m, at(-25, 0, 25), at(25, 0, 25), at(25, 0, -25),
              at(-25, 0, -25), 1, 1);
    mesh_object(&m, "ball", "glass");
    mesh_sphere(&m, at(0, .701, 0), .7, 8);
    mesh_object(&m, "box", "ground");
    mesh_box(&m, at(-1.6, .001, -.6), at(.8, 1.2, .8), 25);
    mesh_close(&m);
    write_text("sunball.mtl", "newmtl ground\nKd .4 .38 .35\nillum 1\n"
                              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n");
    write_text("sunball.view", "eye .5 2.6 5\nat 0 .4 0\nup 0 1 0\nfovy 36\n"
                               "res 400 300\nsun -50 40\n");
}

/* Writes a ball, or a pane before a wall, of this surface under a lamp. */
static void make_surface(const char *name, const char *statements, bool is_pane)
{
    struct mesh m = mesh_open(folder, name, "One surface under a lamp.");
    char *mtl = xformat("newmtl white\nKd .73 .72 .7\nillum 1\n"
                        "newmtl lamp\nKd 0 0 0\nKe 22 20 17\n"
                        "newmtl surface\n%s",
                        statements);
    char *mtl_name = xformat("%s.mtl", name);
    char *view_name = xformat("%s.view", name);

    mesh_object(&m, "floor", "white");
    mesh_quad(&m, at(-4, 0, 4), at(4, 0, 4), at(4, 0, -2), at(-4, 0, -2), 1, 1);
    mesh_quad(&m, at(-4, 0, -2), at(4, 0, -2), at(4, 4, -2), at(-4, 4, -2), 1,
              1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-.4, 2.99, -.4), at(.4, 2.99, -.4), at(.4, 2.99, .4),
              at(-.4, 2.99, .4), 1, 1);
    mesh_object(&m, "surface", "surface");
    if (is_pane)
        mesh_quad(&m, at(-1, .001, .8), at(1, .001, .8), at(1, 1.6, .8),
                  at(-1, 1.6, .8), 1, 1);
    else
        mesh_sphere(&m, at(0, .801, 0), .8, 8);
    mesh_close(&m);
    write_text(mtl_name, mtl);
    write_text(view_name, "eye 0 1.5 6.5\nat 0 1 0\nup 0 1 0\nfovy 32\n"
                          "res 600 600\nbackground .1 .1 .1\n");
    free(view_name);
    free(mtl_name);
    free(mtl);
}

static void make_surfaces(void)
{
    make_surface("coat", "Kd .6 .1 .05\nKs .5\nPr .5\nPc 1\nPcr .1\n", false);
    make_surface("sheen", "Kd .1 .1 .3\nPs 1\n", false);
    make_surface("grain", "Kd .9 .8 .6\nPm 1\nPr .4\naniso .8\n", false);
    make_surface("film",
                 "Kd .05 .05 .05\nKs .5\nPr .2\nPf 1\nPf_thickness 400\n",
                 false);
    make_surface("absorbing", "illum 7\nNi 1.5\nTf .3 .7 .5\nTf_distance .5\n",
                 false);
    make_surface("frosted", "illum 4\nNi 1.5\nTf .9 .95 1\nPr .4\n", true);
}

static void make_glass_box(void)
{
    struct mesh m =
        mesh_open(folder, "glass_box", "A room with a block of glass.");

    mesh_object(&m, "room", "white");
    mesh_quad(&m, at(-2, 0, 2), at(2, 0, 2), at(2, 0, -2), at(-2, 0, -2), 1, 1);
    mesh_quad(&m, at(-2, 0, -2), at(2, 0, -2), at(2, 4, -2), at(-2, 4, -2), 1,
              1);
    mesh_quad(&m, at(-2, 4, -2), at(2, 4, -2), at(2, 4, 2), at(-2, 4, 2), 1, 1);
    mesh_object(&m, "left", "red");
    mesh_quad(&m, at(-2, 0, 2), at(-2, 0, -2), at(-2, 4, -2), at(-2, 4, 2), 1,
              1);
    mesh_object(&m, "right", "green");
    mesh_quad(&m, at(2, 0, -2), at(2, 0, 2), at(2, 4, 2), at(2, 4, -2), 1, 1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-.5, 3.99, -.5), at(.5, 3.99, -.5), at(.5, 3.99, .5),
              at(-.5, 3.99, .5), 1, 1);
    mesh_object(&m, "block", "white");
    mesh_box(&m, at(-.7, .001, -.7), at(1.2, 2.4, 1.2), 17);
    mesh_object(&m, "glass", "glass");
    mesh_box(&m, at(.7, .2, .6), at(1.1, 1.4, 1.1), -17);
    mesh_close(&m);
    write_text("glass_box.mtl", "newmtl white\nKd .73 .72 .7\nillum 1\n"
                                "newmtl red\nKd .6 .1 .08\nillum 1\n"
                                "newmtl green\nKd .15 .45 .12\nillum 1\n"
                                "newmtl lamp\nKd 0 0 0\nKe 17 15 12\nillum 1\n"
                                "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
                                "Tf 1 1 1\n");
    write_text("glass_box.view", "eye 0 2 8\nat 0 2 0\nup 0 1 0\nfovy 37\n"
                                 "res 256 256\nbackground 0 0 0\n"
                                 "max_bounces 64\n");
}

/* Two rooms, of which the left one has a lamp. A gap in the wall between them,
 * at x = -2, is as wide as that of a door ajar. */
static void make_door_room(void)
{
    const double x0 = -5, x1 = 2, top = 3, back = -2, front = 2.2;
    struct mesh m =
        mesh_open(folder, "door_room", "A room lit through a door ajar.");

    mesh_object(&m, "room", "white");
    mesh_quad(&m, at(x0, 0, front), at(x1, 0, front), at(x1, 0, back),
              at(x0, 0, back), 1, 1);
    mesh_quad(&m, at(x0, top, back), at(x1, top, back), at(x1, top, front),
              at(x0, top, front), 1, 1);
    mesh_quad(&m, at(x0, 0, back), at(x1, 0, back), at(x1, top, back),
              at(x0, top, back), 1, 1);
    mesh_quad(&m, at(x1, 0, front), at(x0, 0, front), at(x0, top, front),
              at(x1, top, front), 1, 1);
    mesh_quad(&m, at(x0, 0, front), at(x0, 0, back), at(x0, top, back),
              at(x0, top, front), 1, 1);
    mesh_object(&m, "right", "green");
    mesh_quad(&m, at(x1, 0, back), at(x1, 0, front), at(x1, top, front),
              at(x1, top, back), 1, 1);
    mesh_object(&m, "wall", "red");
    mesh_quad(&m, at(-2, 0, -.9), at(-2, 0, back), at(-2, top, back),
              at(-2, top, -.9), 1, 1);
    mesh_quad(&m, at(-2, 0, front), at(-2, 0, -.6), at(-2, top, -.6),
              at(-2, top, front), 1, 1);
    mesh_quad(&m, at(-2, 2.2, -.6), at(-2, 2.2, -.9), at(-2, top, -.9),
              at(-2, top, -.6), 1, 1);
    mesh_object(&m, "blocks", "white");
    mesh_box(&m, at(.7, .001, -1.1), at(.8, 1.6, .8), 17);
    mesh_box(&m, at(-.5, .001, -.5), at(.7, .7, .7), -20);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-4, 2.99, -1), at(-3, 2.99, -1), at(-3, 2.99, 0),
              at(-4, 2.99, 0), 1, 1);
    mesh_close(&m);
    write_text("door_room.mtl", "newmtl white\nKd .73 .72 .7\nillum 1\n"
                                "newmtl red\nKd .6 .2 .15\nillum 1\n"
                                "newmtl green\nKd .3 .5 .3\nillum 1\n"
                                "newmtl lamp\nKd 0 0 0\nKe 60 55 45\n"
                                "illum 1\n");
    write_text("door_room.view",
               "eye .5 1.6 2.1\nat 0 1 -1\nup 0 1 0\nfovy 60\n"
               "res 256 256\nbackground 0 0 0\n"
               "max_bounces 64\n");
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: scenes FOLDER\n");
        return 2;
    }
    folder = argv[1];
    make_plates();
    make_lamps2000();
    make_sun();
    make_balls();
    make_sunball();
    make_surfaces();
    make_glass_box();
    make_door_room();
    return 0;
}
