// SPDX-License-Identifier: MIT
#include "glasses.h"

#include <math.h>

#include "mesh.h"

/* ---- globe ---- */

#define GLOBE_ARC 24

/* A hollow ball of glass with an opening at the top, around the middle. */
static void glass_globe(struct mesh *m, struct point middle, double radius,
                        double thickness)
{
    double profile[2 * GLOBE_ARC][2];

    for (int i = 0; i < GLOBE_ARC; i++) {
        double turn = 165 * M_PI / 180 * i / (GLOBE_ARC - 1);
        double inner = radius - thickness;
        int back = 2 * GLOBE_ARC - 1 - i;

        profile[i][0] = radius * sin(turn);
        profile[i][1] = -radius * cos(turn);
        profile[back][0] = inner * sin(turn);
        profile[back][1] = -inner * cos(turn);
    }
    mesh_lathe(m, middle, (const double(*)[2])profile, 2 * GLOBE_ARC, 64);
}

#define ROOM_MATERIALS                                      \
    "newmtl planks\nKd 1 1 1\nmap_Kd planks.png\nillum 1\n" \
    "newmtl plaster\nKd .74 .7 .64\nillum 1\n"              \
    "newmtl wood\nKd .36 .22 .12\nillum 1\n"

/* A room of these with a table, whose top is at a height of .76. */
static void table_room(struct mesh *m)
{
    mesh_object(m, "floor", "planks");
    mesh_quad(m, at(-2.5, 0, 3), at(2.5, 0, 3), at(2.5, 0, -1.6),
              at(-2.5, 0, -1.6), 2.5, 2.3);
    mesh_object(m, "walls", "plaster");
    mesh_quad(m, at(-2.5, 0, -1.6), at(2.5, 0, -1.6), at(2.5, 2.6, -1.6),
              at(-2.5, 2.6, -1.6), 1, 1);
    mesh_quad(m, at(-2.5, 2.6, -1.6), at(2.5, 2.6, -1.6), at(2.5, 2.6, 3),
              at(-2.5, 2.6, 3), 1, 1);
    mesh_quad(m, at(-2.5, 0, 3), at(-2.5, 0, -1.6), at(-2.5, 2.6, -1.6),
              at(-2.5, 2.6, 3), 1, 1);
    mesh_quad(m, at(2.5, 0, -1.6), at(2.5, 0, 3), at(2.5, 2.6, 3),
              at(2.5, 2.6, -1.6), 1, 1);
    mesh_object(m, "table", "wood");
    mesh_box(m, at(0, .72, 0), at(2, .04, 1.1), 0);
    for (int i = 0; i < 4; i++)
        mesh_box(m, at(i % 2 ? .9 : -.9, 0, i / 2 ? .45 : -.45),
                 at(.06, .72, .06), 0);
}

static void make_globe(const char *folder)
{
    static const double tumbler[][2] = {{0, 0},      {.045, 0},  {.05, .01},
                                        {.055, .15}, {.05, .15}, {.046, .02},
                                        {0, .018}};
    struct mesh m = mesh_open(folder, "globe",
                              "A lamp in a globe of glass, the only light: a "
                              "path from the eye hardly finds it.");

    table_room(&m);
    mesh_object(&m, "globe", "glass");
    glass_globe(&m, at(-.1, 1.0002, -.05), .22, .012);
    mesh_object(&m, "lamp", "lamp");
    mesh_sphere(&m, at(-.1, 1, -.05), .03, 8);
    mesh_object(&m, "rod", "brass");
    mesh_box(&m, at(-.1, 1.03, -.05), at(.012, 1.57, .012), 0);
    mesh_object(&m, "stand", "brass");
    mesh_box(&m, at(-.1, .7601, -.05), at(.16, .02, .16), 0);
    mesh_object(&m, "tumbler", "glass");
    mesh_lathe(&m, at(.45, .7605, .2), tumbler, COUNT(tumbler), 48);
    mesh_object(&m, "books", "red");
    mesh_box(&m, at(-.6, .7601, .1), at(.3, .05, .22), 20);
    mesh_object(&m, "book", "blue");
    mesh_box(&m, at(-.59, .8102, .1), at(.27, .04, .2), 5);
    mesh_object(&m, "egg", "plaster");
    mesh_sphere(&m, at(.2, .8202, .32), .06, SEGMENTS);
    mesh_close(&m);
    mesh_text(folder, "globe", "mtl",
              ROOM_MATERIALS "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
                             "newmtl lamp\nKd 0 0 0\nKe 260 190 110\nillum 1\n"
                             "newmtl brass\nKd .85 .62 .3\nPm 1\nPr .5\n"
                             "newmtl red\nKd .5 .1 .08\nillum 1\n"
                             "newmtl blue\nKd .1 .18 .4\nillum 1\n");
    mesh_text(folder, "globe", "view",
              "eye .55 1.42 2.1\nat -.05 .93 0\nup 0 1 0\nfovy 36\n"
              "background 0 0 0\n"
              "res 1024 640\nexposure .7\ntone aces\n");
}

/* ---- bulb ---- */

/* A shade that is open above and below, a bulb of clear glass in it, and what
 * both hang from. */
static void hanging_lamp(struct mesh *m, struct point bulb)
{
    static const double shade[][2] = {
        {.2, -.07}, {.07, .13}, {.066, .128}, {.195, -.072}, {.2, -.07}};
    static const double socket[][2] = {{0, 0},      {.012, 0},   {.024, .004},
                                       {.024, .06}, {.018, .07}, {0, .07}};

    mesh_object(m, "shade", "enamel");
    mesh_lathe(m, bulb, shade, COUNT(shade), 64);
    mesh_object(m, "bulb", "glass");
    glass_globe(m, bulb, .045, .0015);
    mesh_object(m, "filament", "filament");
    mesh_sphere(m, bulb, .008, 2);
    mesh_object(m, "socket", "brass");
    mesh_lathe(m, at(bulb.x, bulb.y + .0452, bulb.z), socket, COUNT(socket),
               32);
    mesh_object(m, "cable", "dark");
    mesh_box(m, at(bulb.x, bulb.y + .1155, bulb.z), at(.006, 1.2, .006), 0);
    for (int i = 0; i < 2; i++)
        mesh_box(m, at(bulb.x, bulb.y + .106, bulb.z),
                 i == 0 ? at(.15, .004, .004) : at(.004, .004, .15), 0);
}

static void make_bulb(const char *folder)
{
    static const double bowl[][2] = {{0, 0},      {.05, 0},    {.055, .012},
                                     {.1, .035},  {.13, .08},  {.126, .082},
                                     {.095, .04}, {.05, .018}, {0, .016}};
    struct mesh m = mesh_open(folder, "bulb",
                              "A bulb of clear glass under a shade, the only "
                              "light.");

    table_room(&m);
    hanging_lamp(&m, at(0, 1.34, 0));
    mesh_object(&m, "bowl", "china");
    mesh_lathe(&m, at(-.02, .7601, .02), bowl, COUNT(bowl), 48);
    mesh_object(&m, "apples", "red");
    mesh_sphere(&m, at(-.065, .82, .02), .042, SEGMENTS);
    mesh_sphere(&m, at(.025, .82, .058), .041, SEGMENTS);
    mesh_object(&m, "lime", "green");
    mesh_sphere(&m, at(.02, .816, -.03), .036, SEGMENTS);
    mesh_object(&m, "book", "blue");
    mesh_box(&m, at(-.42, .7601, .12), at(.24, .03, .17), 25);
    mesh_object(&m, "page", "plaster");
    mesh_box(&m, at(.36, .7601, .16), at(.21, .002, .297), -15);
    mesh_close(&m);
    mesh_text(folder, "bulb", "mtl",
              ROOM_MATERIALS
              "newmtl enamel\nKd .2 .42 .32\nillum 1\n"
              "newmtl china\nKd .8 .8 .78\nillum 1\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl filament\nKd 0 0 0\nKe 5000 4100 2900\nillum 1\n"
              "newmtl brass\nKd .85 .62 .3\nPm 1\nPr .5\n"
              "newmtl dark\nKd .03 .03 .03\nillum 1\n"
              "newmtl red\nKd .55 .08 .05\nillum 1\n"
              "newmtl green\nKd .3 .5 .08\nillum 1\n"
              "newmtl blue\nKd .1 .18 .4\nillum 1\n");
    mesh_text(folder, "bulb", "view",
              "eye .45 1.3 1.5\nat 0 1.02 0\nup 0 1 0\nfovy 36\n"
              "background 0 0 0\n"
              "res 1024 640\nexposure 1.1\ntone aces\n");
}

/* ---- lantern ---- */

#define LANTERN_ROWS 41

/* A ball of paper with ribs, a lamp in it, and the cord that both hang from. */
static void paper_lantern(struct mesh *m, struct point middle)
{
    double profile[LANTERN_ROWS][2];

    for (int i = 0; i < LANTERN_ROWS; i++) {
        double turn = M_PI * i / (LANTERN_ROWS - 1);
        double radius = i % 4 == 0 ? .197 : .2;

        profile[i][0] = radius * sin(turn);
        profile[i][1] = -.9 * radius * cos(turn);
    }
    profile[0][0] = profile[LANTERN_ROWS - 1][0] = 0;
    mesh_object(m, "lantern", "paper");
    mesh_lathe(m, middle, (const double(*)[2])profile, LANTERN_ROWS, 64);
    mesh_object(m, "lamp", "lamp");
    mesh_sphere(m, middle, .03, 8);
    mesh_object(m, "cord", "dark");
    mesh_box(m, at(middle.x, middle.y + .18, middle.z), at(.006, 1.2, .006), 0);
}

/* Leaves that rise from a place and bend outwards, each of three quads, the
 * last one with a tip. */
static void leaves(struct mesh *m, struct point foot, int count)
{
    static const double side[][3] = {{.01, .01, 0},
                                     {.05, .028, .1},
                                     {.11, .026, .14},
                                     {.17, 0, .13}};

    mesh_object(m, "leaves", "leaf");
    for (int i = 0; i < count; i++) {
        double turn = 2.4 * i, size = .7 + .3 * sin(5. * i);
        double c = size * cos(turn), s = size * sin(turn);
        struct point ends[8];

        for (int k = 0; k < 8; k++) {
            const double *p = side[k / 2];
            double across = k % 2 ? p[1] : -p[1];

            ends[k] = at(foot.x + p[0] * c - across * s,
                         foot.y + (size + .5 * (i % 3)) * p[2],
                         foot.z + p[0] * s + across * c);
        }
        for (int k = 0; k < 3; k++)
            mesh_quad(m, ends[2 * k], ends[2 * k + 1], ends[2 * k + 3],
                      ends[2 * k + 2], 1, 1);
    }
}

static void make_lantern(const char *folder)
{
    static const double pot[][2] = {{0, 0},      {.045, 0},   {.06, .09},
                                    {.054, .09}, {.05, .075}, {0, .075}};
    struct mesh m =
        mesh_open(folder, "lantern", "A lamp in a ball of paper, and leaves.");

    table_room(&m);
    paper_lantern(&m, at(-.12, 1.25, -.15));
    mesh_object(&m, "pot", "china");
    mesh_lathe(&m, at(.22, .7601, .05), pot, COUNT(pot), 48);
    leaves(&m, at(.22, .832, .05), 13);
    mesh_object(&m, "book", "blue");
    mesh_box(&m, at(-.42, .7601, .18), at(.24, .03, .17), 25);
    mesh_close(&m);
    mesh_text(folder, "lantern", "mtl",
              ROOM_MATERIALS
              "newmtl paper\nKd .8 .76 .7\nTd .9 .84 .7\nTd_weight .5\n"
              "newmtl leaf\nKd .1 .3 .06\nTd .35 .6 .1\nTd_weight .45\n"
              "newmtl lamp\nKd 0 0 0\nKe 70 52 32\nillum 1\n"
              "newmtl dark\nKd .03 .03 .03\nillum 1\n"
              "newmtl china\nKd .8 .8 .78\nillum 1\n"
              "newmtl blue\nKd .1 .18 .4\nillum 1\n");
    mesh_text(folder, "lantern", "view",
              "eye .5 1.25 1.5\nat 0 1.06 0\nup 0 1 0\nfovy 36\n"
              "background .08 .1 .14\n"
              "res 1024 640\nexposure 1.5\ntone aces\n");
}

/* ---- water ---- */

/* A tumbler that is partly full. Where glass meets water, its index is that of
 * glass relative to water. */
static void glass_of_water(struct mesh *m, struct point foot)
{
    static const double glass[][2] = {{0, 0},         {.03, 0},
                                      {.032, .003},   {.038, .12},
                                      {.0372, .1215}, {.0358, .1215},
                                      {.035, .12},    {.0338, .09}};
    static const double wall[][2] = {{.0338, .09},
                                     {.0302, .016},
                                     {.027, .013},
                                     {0, .012}};
    static const double surface[][2] = {{.0338, .09}, {0, .09}};

    mesh_object(m, "glass", "glass");
    mesh_lathe(m, foot, glass, COUNT(glass), 96);
    mesh_object(m, "glass", "glass_water");
    mesh_lathe(m, foot, wall, COUNT(wall), 96);
    mesh_object(m, "glass", "water");
    mesh_lathe(m, foot, surface, COUNT(surface), 96);
}

static void make_water(const char *folder)
{
    static const double straw[][2] = {{0, 0},
                                      {.0035, 0},
                                      {.0035, .15},
                                      {0, .15}};
    struct mesh m =
        mesh_open(folder, "water", "A glass of water on a table in the sun.");

    mesh_object(&m, "table", "planks");
    mesh_quad(&m, at(-1, 0, 1), at(1, 0, 1), at(1, 0, -1), at(-1, 0, -1), 6, 6);
    glass_of_water(&m, at(0, .0002, 0));
    mesh_object(&m, "straw", "red");
    mesh_lathe(&m, at(.012, .0135, -.01), straw, COUNT(straw), 24);
    mesh_object(&m, "lemon", "yellow");
    mesh_sphere(&m, at(-.085, .0302, -.01), .03, SEGMENTS);
    mesh_object(&m, "napkin", "cloth");
    mesh_box(&m, at(.03, 0, .01), at(.3, .0001, .22), 12);
    mesh_close(&m);
    mesh_text(folder, "water", "mtl",
              "newmtl planks\nKd 1 1 1\nmap_Kd planks.png\nillum 1\n"
              "newmtl cloth\nKd .7 .69 .66\nillum 1\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl glass_water\nKd 0 0 0\nillum 7\nNi 1.126\n"
              "newmtl water\nKd 0 0 0\nillum 7\nNi 1.332\n"
              "newmtl red\nKd .6 .07 .05\nillum 1\n"
              "newmtl yellow\nKd .75 .55 .05\nillum 1\n");
    mesh_text(folder, "water", "view",
              "eye .07 .25 .38\nat .025 .04 .015\nup 0 1 0\nfovy 30\n"
              "sun 318 30\n"
              "res 1024 640\nexposure .8\ntone aces\n");
}

/* ---- prism ---- */

/* An upright prism with equal sides around the axis through `foot`, one of
 * which faces +x. */
static void glass_prism(struct mesh *m, struct point foot, double side,
                        double height)
{
    double reach = side / sqrt(3);
    struct point low[3], high[3];

    for (int i = 0; i < 3; i++) {
        double turn = M_PI / 3 + 2 * M_PI * i / 3;

        low[i] =
            at(foot.x + reach * cos(turn), foot.y, foot.z - reach * sin(turn));
        high[i] = at(low[i].x, foot.y + height, low[i].z);
    }
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;

        mesh_quad(m, low[i], low[next], high[next], high[i], 1, 1);
    }
    for (int i = 0; i < 3; i++)
        fprintf(m->file, "v %.6g %.6g %.6g\nv %.6g %.6g %.6g\n", high[i].x,
                high[i].y, high[i].z, low[i].x, low[i].y, low[i].z);
    fprintf(m->file, "f -6 -4 -2\nf -1 -3 -5\n");
    m->v += 6;
}

/* White light falls through a slit on a prism. In its middle, where the
 * deviation is least, rays are parallel to the side that they do not meet. */
static void make_prism(const char *folder)
{
    struct mesh m = mesh_open(folder, "prism",
                              "A prism of dense flint glass parts the light "
                              "that comes through a slit.");

    mesh_object(&m, "table", "wood");
    mesh_quad(&m, at(-1, 0, 1), at(1, 0, 1), at(1, 0, -1), at(-1, 0, -1), 1, 1);
    mesh_object(&m, "wall", "plaster");
    mesh_quad(&m, at(-1, 0, -.42), at(1, 0, -.42), at(1, 1, -.42),
              at(-1, 1, -.42), 1, 1);
    mesh_object(&m, "slit", "black");
    for (int i = -1; i <= 1; i += 2)
        mesh_box(&m, at(-.26, 0, .0615 * i), at(.003, .16, .117), 0);
    mesh_object(&m, "prism", "flint");
    glass_prism(&m, at(-.007, .0003, -.0225), .09, .12);
    mesh_close(&m);
    mesh_text(folder, "prism", "mtl",
              "newmtl wood\nKd .5 .4 .32\nillum 1\n"
              "newmtl plaster\nKd .8 .8 .8\nillum 1\n"
              "newmtl black\nKd .015 .015 .015\nillum 1\n"
              "newmtl flint\nKd 0 0 0\nillum 7\nNi 1.73\nNi_abbe 25\n");
    mesh_text(folder, "prism", "view",
              "eye .2 .26 .5\nat .075 .055 -.1\nup 0 1 0\nfovy 32\n"
              "background .1 .105 .115\n"
              "light spot -1.2 .075 0 at 0 .065 0 intensity 90 90 90 inner 2.5 "
              "outer 3\n"
              "res 1024 640\nexposure .3\ntone aces\n");
}

void glasses_write(const char *folder)
{
    make_globe(folder);
    make_bulb(folder);
    make_lantern(folder);
    make_water(folder);
    make_prism(folder);
}
