// SPDX-License-Identifier: MIT
/*
 * generate.c - writes the scenes of this folder: `make scenes`
 *
 * A test compares the output with the files in the repository, so scenes are
 * changed here only. The first comment of each OBJ file describes the scene.
 */
#include "glasses.h"
#include "images.h"
#include "media.h"
#include "mesh.h"
#include "models.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char *folder;

/* --- cornell: box data of Cornell University Program of Computer Graphics
 * --- */

static const double cornell_quads[][4][3] = {
    /* floor, back wall, right wall, left wall */
    {{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}},
    {{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}},
    {{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}},
    {{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}},
    /* ceiling, around the light */
    {{556, 548.8, 0},
     {556, 548.8, 559.2},
     {343, 548.8, 332},
     {343, 548.8, 227}},
    {{556, 548.8, 559.2},
     {0, 548.8, 559.2},
     {213, 548.8, 332},
     {343, 548.8, 332}},
    {{0, 548.8, 559.2}, {0, 548.8, 0}, {213, 548.8, 227}, {213, 548.8, 332}},
    {{0, 548.8, 0}, {556, 548.8, 0}, {343, 548.8, 227}, {213, 548.8, 227}},
    {{343, 548.8, 227},
     {343, 548.8, 332},
     {213, 548.8, 332},
     {213, 548.8, 227}},
    /* short block */
    {{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}},
    {{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}},
    {{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}},
    {{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}},
    {{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}},
    /* tall block */
    {{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}},
    {{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}},
    {{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}},
    {{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}},
    {{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}},
};

static void cornell_part(struct mesh *m, const char *object,
                         const char *material, int first, int count)
{
    mesh_object(m, object, material);
    for (int i = first; i < first + count; i++) {
        const double(*q)[3] = cornell_quads[i];

        fprintf(m->file, "v %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\n",
                q[0][0], q[0][1], q[0][2], q[1][0], q[1][1], q[1][2], q[2][0],
                q[2][1], q[2][2], q[3][0], q[3][1], q[3][2]);
        fprintf(m->file, "f -4 -3 -2 -1\n");
    }
}

static void make_cornell(void)
{
    struct mesh m =
        mesh_open(folder, "cornell",
                  "The Cornell box as measured: light that comes from walls.");

    cornell_part(&m, "floor", "white", 0, 1);
    cornell_part(&m, "back_wall", "white", 1, 1);
    cornell_part(&m, "right_wall", "green", 2, 1);
    cornell_part(&m, "left_wall", "red", 3, 1);
    cornell_part(&m, "ceiling", "white", 4, 4);
    cornell_part(&m, "light", "light", 8, 1);
    cornell_part(&m, "short_block", "white", 9, 5);
    cornell_part(&m, "tall_block", "white", 14, 5);
    mesh_close(&m);
    mesh_text(folder, "cornell", "mtl",
              "newmtl white\nKd .725 .71 .68\nillum 1\n"
              "newmtl red\nKd .63 .065 .05\nillum 1\n"
              "newmtl green\nKd .14 .45 .091\nillum 1\n"
              "newmtl light\nKd .78 .78 .78\nKe 17 12 4\nillum 1\n");
    mesh_text(folder, "cornell", "view",
              "eye 278 273 -800\nat 278 273 0\nup 0 1 0\nfovy 39.3077\n"
              "res 600 600\nexposure 1\n");
}

/* --- materials ------------------------------------------------------------ */

static void make_materials(void)
{
    static const char *const front[] = {"mirror", "silver", "gold", "copper",
                                        "steel"};
    static const char *const back[] = {"red", "glass", "frosted", "bottle",
                                       "glow"};
    struct mesh m = mesh_open(
        folder, "materials",
        "A ball of each material: metals of growing roughness in front.");

    mesh_object(&m, "floor", "tiles");
    mesh_quad(&m, at(-8, 0, 5), at(8, 0, 5), at(8, 0, -5), at(-8, 0, -5), 8, 5);
    mesh_object(&m, "wall", "wall");
    mesh_quad(&m, at(-8, 0, -5), at(8, 0, -5), at(8, 7, -5), at(-8, 7, -5), 1,
              1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-4, 6, -2), at(4, 6, -2), at(4, 6, 3), at(-4, 6, 3), 1, 1);
    for (int i = 0; i < COUNT(front); i++) {
        mesh_object(&m, front[i], front[i]);
        mesh_sphere(&m, at(-2.8 + 1.4 * i, .6001, 1), .6, SEGMENTS);
    }
    for (int i = 0; i < COUNT(back); i++) {
        mesh_object(&m, back[i], back[i]);
        mesh_sphere(&m, at(-3.5 + 1.75 * i, .8001, -1.2), .8, SEGMENTS);
    }
    mesh_close(&m);
    mesh_text(folder, "materials", "mtl",
              "newmtl tiles\nKd 1 1 1\nmap_Kd tiles.png\nillum 1\n"
              "newmtl wall\nKd .55 .58 .62\nillum 1\n"
              "newmtl lamp\nKd 0 0 0\nKe 5 4.8 4.4\nillum 1\n"
              "newmtl mirror\nKd .95 .95 .95\nPm 1\nPr 0\n"
              "newmtl silver\nKd .95 .93 .88\nPm 1\nPr .2\n"
              "newmtl gold\nKd 1 .78 .34\nPm 1\nPr .35\n"
              "newmtl copper\nKd .96 .64 .54\nPm 1\nPr .5\n"
              "newmtl steel\nKd .56 .57 .58\nPm 1\nPr .7\n"
              "newmtl red\nKd .7 .12 .1\nillum 1\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl frosted\nKd 0 0 0\nillum 7\nNi 1.5\nPr .35\n"
              "newmtl bottle\nKd 0 0 0\nillum 7\nNi 1.5\nTf .6 .9 .7\n"
              "newmtl glow\nKd 0 0 0\nKe 1.2 .65 .22\nillum 1\n");
    mesh_text(folder, "materials", "view",
              "eye 0 3.2 8\nat 0 .7 -.2\nup 0 1 0\nfovy 34\nres 1024 576\n"
              "background .25 .3 .4\n");
}

/* --- glass_mirror --------------------------------------------------------- */

static void glass_mirror_room(struct mesh *m)
{
    mesh_object(m, "floor", "tiles");
    mesh_quad(m, at(-2.5, 0, 6), at(2.5, 0, 6), at(2.5, 0, -2.5),
              at(-2.5, 0, -2.5), 2.5, 4.25);
    mesh_object(m, "walls", "white");
    mesh_quad(m, at(-2.5, 0, -2.5), at(2.5, 0, -2.5), at(2.5, 3, -2.5),
              at(-2.5, 3, -2.5), 1, 1);
    mesh_quad(m, at(-2.5, 3, -2.5), at(2.5, 3, -2.5), at(2.5, 3, 6),
              at(-2.5, 3, 6), 1, 1);
    mesh_quad(m, at(2.5, 0, 6), at(-2.5, 0, 6), at(-2.5, 3, 6), at(2.5, 3, 6),
              1, 1);
    mesh_object(m, "left_wall", "orange");
    mesh_quad(m, at(-2.5, 0, 6), at(-2.5, 0, -2.5), at(-2.5, 3, -2.5),
              at(-2.5, 3, 6), 1, 1);
    mesh_object(m, "right_wall", "blue");
    mesh_quad(m, at(2.5, 0, -2.5), at(2.5, 0, 6), at(2.5, 3, 6),
              at(2.5, 3, -2.5), 1, 1);
    mesh_object(m, "lamp", "lamp");
    mesh_quad(m, at(-1.2, 2.98, -1.4), at(1.2, 2.98, -1.4), at(1.2, 2.98, 1.2),
              at(-1.2, 2.98, 1.2), 1, 1);
}

static void make_glass_mirror(void)
{
    static const double goblet[][2] = {{0, 0},     {.28, 0},    {.29, .02},
                                       {.10, .05}, {.035, .12}, {.035, .40},
                                       {.08, .46}, {.20, .55},  {.27, .70},
                                       {.28, .85}, {.26, 1.0},  {.25, 1.01},
                                       {.24, 1.0}, {.26, .85},  {.25, .71},
                                       {.18, .57}, {.08, .50},  {0, .48}};
    struct mesh m = mesh_open(folder, "glass_mirror",
                              "Glass in front of a mirror: goblet, balls, "
                              "block, light through them.");

    glass_mirror_room(&m);
    mesh_object(&m, "frame", "wood");
    mesh_box(&m, at(0, .35, -2.45), at(3.2, 2.3, .08), 0);
    mesh_object(&m, "mirror", "mirror");
    mesh_quad(&m, at(-1.5, .45, -2.4), at(1.5, .45, -2.4), at(1.5, 2.55, -2.4),
              at(-1.5, 2.55, -2.4), 1, 1);
    mesh_object(&m, "goblet", "glass");
    mesh_lathe(&m, at(.15, .0005, 1.1), goblet, COUNT(goblet), 48);
    mesh_object(&m, "glass_ball", "glass");
    mesh_sphere(&m, at(-1.1, .5005, .3), .5, SEGMENTS);
    mesh_object(&m, "frosted_ball", "frosted");
    mesh_sphere(&m, at(-.5, .2505, 1.4), .25, SEGMENTS);
    mesh_object(&m, "mirror_ball", "mirror");
    mesh_sphere(&m, at(.35, .6, -1), .6, SEGMENTS);
    mesh_object(&m, "block", "green_glass");
    mesh_box(&m, at(1.25, .0005, .3), at(.5, 1.2, .5), 30);
    mesh_close(&m);
    mesh_text(folder, "glass_mirror", "mtl",
              "newmtl tiles\nKd 1 1 1\nmap_Kd tiles.png\nillum 1\n"
              "newmtl white\nKd .75 .74 .72\nillum 1\n"
              "newmtl orange\nKd .72 .36 .14\nillum 1\n"
              "newmtl blue\nKd .18 .32 .60\nillum 1\n"
              "newmtl wood\nKd .32 .19 .10\nillum 1\n"
              "newmtl lamp\nKd 0 0 0\nKe 7 6.6 6\nillum 1\n"
              "newmtl mirror\nKd 0 0 0\nKs .95 .95 .95\nillum 5\nPr 0\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl frosted\nKd 0 0 0\nillum 7\nNi 1.5\nPr .3\n"
              "newmtl green_glass\nKd 0 0 0\nillum 7\nNi 1.5\nTf .65 .95 .8\n");
    mesh_text(folder, "glass_mirror", "view",
              "eye .2 1.5 5.6\nat 0 1.05 -.5\nup 0 1 0\nfovy 34\n"
              "res 1024 576\n");
}

/* --- interior: 5 wide, 3 high, 6 deep; a window in the left wall ---------- */

static void interior_walls(struct mesh *m)
{
    mesh_object(m, "floor", "planks");
    mesh_quad(m, at(0, 0, 6), at(5, 0, 6), at(5, 0, 0), at(0, 0, 0), 3, 3);
    mesh_object(m, "ceiling", "white");
    mesh_quad(m, at(0, 3, 0), at(5, 3, 0), at(5, 3, 6), at(0, 3, 6), 1, 1);
    mesh_object(m, "back_wall", "paper");
    mesh_quad(m, at(0, 0, 0), at(5, 0, 0), at(5, 3, 0), at(0, 3, 0), 5, 3);
    mesh_object(m, "right_wall", "paper");
    mesh_quad(m, at(5, 0, 0), at(5, 0, 6), at(5, 3, 6), at(5, 3, 0), 6, 3);
    mesh_object(m, "front_wall", "white");
    mesh_quad(m, at(5, 0, 6), at(0, 0, 6), at(0, 3, 6), at(5, 3, 6), 1, 1);
    /* The window spans .8 to 2.6 in height and 1 to 4.5 in depth. The wall
     * around it has four pieces that meet at corners only. */
    mesh_object(m, "left_wall", "white");
    mesh_quad(m, at(0, 0, 6), at(0, 0, 0), at(0, .8, 1), at(0, .8, 4.5), 1, 1);
    mesh_quad(m, at(0, 0, 0), at(0, 3, 0), at(0, 2.6, 1), at(0, .8, 1), 1, 1);
    mesh_quad(m, at(0, 3, 0), at(0, 3, 6), at(0, 2.6, 4.5), at(0, 2.6, 1), 1,
              1);
    mesh_quad(m, at(0, 3, 6), at(0, 0, 6), at(0, .8, 4.5), at(0, 2.6, 4.5), 1,
              1);
    mesh_object(m, "window_bars", "white");
    for (int i = 0; i < 4; i++)
        mesh_box(m, at(-.02, .78, 1 + 3.5 * i / 3), at(.1, 1.84, .07), 0);
    mesh_box(m, at(-.02, .74, 2.75), at(.16, .06, 3.6), 0);
    mesh_box(m, at(-.02, 1.7, 2.75), at(.08, .06, 3.5), 0);
    mesh_box(m, at(-.02, 2.6, 2.75), at(.1, .06, 3.6), 0);
}

static void interior_furniture(struct mesh *m)
{
    static const double legs[][2] = {{-1, -1}, {-1, 1}, {1, -1}, {1, 1}};

    mesh_object(m, "rug", "rug");
    mesh_quad(m, at(.9, .01, 3.3), at(3.7, .01, 3.3), at(3.7, .01, 1.3),
              at(.9, .01, 1.3), 1, 1);
    mesh_object(m, "table", "wood");
    mesh_box(m, at(2.3, .72, 2.2), at(1.7, .05, .95), 0);
    for (int i = 0; i < 4; i++)
        mesh_box(m, at(2.3 + .76 * legs[i][0], .016, 2.2 + .38 * legs[i][1]),
                 at(.07, .704, .07), 0);
    mesh_object(m, "bench", "wood");
    mesh_box(m, at(3.9, .42, 1.9), at(.4, .05, 1.5), 12);
    mesh_box(m, at(3.8, 0, 1.45), at(.3, .42, .06), 12);
    mesh_box(m, at(4, 0, 2.35), at(.3, .42, .06), 12);
    mesh_object(m, "picture_frame", "black");
    mesh_box(m, at(2.4, 1.25, .02), at(1.5, 1.15, .05), 0);
    mesh_object(m, "picture", "painting");
    mesh_quad(m, at(1.72, 1.32, .05), at(3.08, 1.32, .05), at(3.08, 2.33, .05),
              at(1.72, 2.33, .05), 1, 1);
}

static void make_interior(void)
{
    static const double vase[][2] = {{0, 0},     {.09, 0},   {.11, .02},
                                     {.16, .12}, {.17, .20}, {.13, .30},
                                     {.07, .37}, {.06, .42}, {.09, .47},
                                     {.08, .47}, {.05, .42}, {.05, .38},
                                     {0, .36}};
    static const double bowl[][2] = {{0, 0},     {.08, 0},   {.09, .02},
                                     {.16, .06}, {.22, .13}, {.21, .135},
                                     {.15, .08}, {.08, .04}, {0, .03}};
    static const double shade[][2] = {{0, 0},     {.12, .02}, {.20, .08},
                                      {.22, .16}, {.18, .24}, {.10, .29},
                                      {0, .30}};
    struct mesh m = mesh_open(
        folder, "interior",
        "A room with textures, daylight through a window and a lamp.");

    interior_walls(&m);
    interior_furniture(&m);
    mesh_object(&m, "vase", "glaze");
    mesh_lathe(&m, at(1.85, .7705, 2.2), vase, COUNT(vase), 32);
    mesh_object(&m, "bowl", "brass");
    mesh_lathe(&m, at(2.75, .7705, 2.3), bowl, COUNT(bowl), 32);
    mesh_object(&m, "glass_ball", "glass");
    mesh_sphere(&m, at(2.32, .8705, 2.4), .1, 6);
    mesh_object(&m, "lamp", "lamp");
    mesh_lathe(&m, at(3.6, 2.2, 2.4), shade, COUNT(shade), 32);
    mesh_object(&m, "lamp_cord", "black");
    mesh_box(&m, at(3.6, 2.5, 2.4), at(.015, .5, .015), 0);
    mesh_close(&m);
    mesh_text(folder, "interior", "mtl",
              "newmtl planks\nKd 1 1 1\nmap_Kd planks.png\nillum 1\n"
              "newmtl paper\nKd 1 1 1\nmap_Kd paper.png\nillum 1\n"
              "newmtl rug\nKd 1 1 1\nmap_Kd rug.png\nillum 1\n"
              "newmtl painting\nKd 1 1 1\nmap_Kd painting.png\nillum 1\n"
              "newmtl wood\nKd .8 .7 .6\nmap_Kd planks.png\nillum 1\n"
              "newmtl white\nKd .82 .81 .78\nillum 1\n"
              "newmtl black\nKd .04 .04 .04\nillum 1\n"
              "newmtl glaze\nKd .35 .55 .75\nPm 1\nPr .3\n"
              "newmtl brass\nKd .91 .78 .42\nPm 1\nPr .4\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl lamp\nKd 0 0 0\nKe 9 6.5 3.6\nillum 1\n");
    mesh_text(folder, "interior", "view",
              "eye 4.5 1.65 5.7\nat 2.2 1.1 1.2\nup 0 1 0\nfovy 46\n"
              "res 1024 576\nbackground 5 6 7.5\n");
}

/* --- skylit --------------------------------------------------------------- */

static void make_skylit(void)
{
    static const double ring[][2] = {{.70, 0},   {.84, .04}, {.94, .14},
                                     {.98, .28}, {.94, .42}, {.84, .52},
                                     {.70, .56}, {.56, .52}, {.46, .42},
                                     {.42, .28}, {.46, .14}, {.56, .04},
                                     {.70, 0}};
    static const double pawn[][2] = {{0, 0},      {.50, 0},    {.52, .08},
                                     {.46, .18},  {.34, .26},  {.22, .50},
                                     {.17, .85},  {.30, .92},  {.30, .97},
                                     {.18, 1.02}, {.27, 1.1},  {.33, 1.25},
                                     {.30, 1.42}, {.20, 1.53}, {0, 1.58}};
    struct mesh m = mesh_open(folder, "skylit",
                              "Objects outdoors, lit by an image of the sky.");

    mesh_object(&m, "ground", "ground");
    mesh_quad(&m, at(-400, 0, 400), at(400, 0, 400), at(400, 0, -400),
              at(-400, 0, -400), 1, 1);
    mesh_object(&m, "terrace", "tiles");
    mesh_box(&m, at(0, 0, 0), at(7, .12, 5), 0);
    mesh_object(&m, "ring", "gold");
    mesh_lathe(&m, at(1.4, .1205, .9), ring, COUNT(ring), 64);
    mesh_object(&m, "pawn", "ivory");
    mesh_lathe(&m, at(-1.5, .1205, .5), pawn, COUNT(pawn), 48);
    mesh_object(&m, "cube", "red");
    mesh_box(&m, at(-.1, .1205, -1.2), at(1.2, 1.2, 1.2), 25);
    mesh_object(&m, "ball", "mirror");
    mesh_sphere(&m, at(-.1, 1.8205, -1.2), .5, SEGMENTS);
    mesh_object(&m, "glass_ball", "glass");
    mesh_sphere(&m, at(-.15, .5205, 1.3), .4, SEGMENTS);
    mesh_object(&m, "tall_box", "blue");
    mesh_box(&m, at(2.2, .1205, -1.4), at(.8, 2.2, .8), -20);
    mesh_close(&m);
    mesh_text(folder, "skylit", "mtl",
              "newmtl ground\nKd .36 .40 .26\nillum 1\n"
              "newmtl tiles\nKd 1 1 1\nmap_Kd tiles.png\nillum 1\n"
              "newmtl ivory\nKd .82 .78 .68\nillum 1\n"
              "newmtl red\nKd .66 .13 .10\nillum 1\n"
              "newmtl blue\nKd .14 .24 .52\nillum 1\n"
              "newmtl gold\nKd 1 .78 .34\nPm 1\nPr .3\n"
              "newmtl mirror\nKd .95 .95 .95\nPm 1\nPr 0\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n");
    mesh_text(folder, "skylit", "view",
              "eye -1.2 2.3 7.4\nat .15 .75 0\nup 0 1 0\nfovy 36\n"
              "res 1024 576\nsky sky.hdr\nsky_strength 1\nsky_rotation 0\n"
              "exposure -.5\n");
}

/* --- lights200 ------------------------------------------------------------ */

/* Returns a pseudorandom number in [0, 1), the same on every machine. */
static double next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static void lights200_pillars(struct mesh *m)
{
    mesh_object(m, "floor", "floor");
    mesh_quad(m, at(-14, 0, 14), at(14, 0, 14), at(14, 0, -14), at(-14, 0, -14),
              1, 1);
    mesh_object(m, "pillars", "stone");
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++)
            mesh_box(m, at(4.0 * i - 8, 0, 4.0 * j - 8), at(.9, 3.2, .9),
                     18 * i + 31 * j);
    mesh_object(m, "walls", "stone");
    mesh_box(m, at(-3, 0, 2), at(4.5, 1.6, .2), 70);
    mesh_box(m, at(4, 0, -2), at(5, 1.6, .2), -35);
}

static void make_lights200(void)
{
    static const char *const colors[] = {"warm", "amber", "rose", "cyan"};
    uint32_t state = 200;
    struct mesh m = mesh_open(
        folder, "lights200",
        "200 small lights, powers 1 to 100, among pillars that hide most.");

    lights200_pillars(&m);
    for (int i = 0; i < 200; i++) {
        double x = 22 * next_random(&state) - 11;
        double y = .25 + 2.6 * next_random(&state);
        double z = 22 * next_random(&state) - 11;
        const char *color = colors[(int)(4 * next_random(&state))];
        double u = next_random(&state);
        char object[32], material[32];

        snprintf(object, sizeof object, "light_%03d", i);
        snprintf(material, sizeof material, "%s_%c", color,
                 u < .6   ? 'a'
                 : u < .9 ? 'b'
                          : 'c');
        mesh_object(&m, object, material);
        mesh_sphere(&m, at(x, y, z), .05 + .07 * u, 1);
    }
    mesh_close(&m);
    mesh_text(folder, "lights200", "mtl",
              "newmtl floor\nKd .62 .62 .60\nillum 1\n"
              "newmtl stone\nKd .58 .54 .48\nillum 1\n"
              "newmtl warm_a\nKd 0 0 0\nKe 10 8 5\n"
              "newmtl warm_b\nKd 0 0 0\nKe 60 48 30\n"
              "newmtl warm_c\nKd 0 0 0\nKe 300 240 150\n"
              "newmtl amber_a\nKd 0 0 0\nKe 10 5 1\n"
              "newmtl amber_b\nKd 0 0 0\nKe 60 30 6\n"
              "newmtl amber_c\nKd 0 0 0\nKe 300 150 30\n"
              "newmtl rose_a\nKd 0 0 0\nKe 9 3 5\n"
              "newmtl rose_b\nKd 0 0 0\nKe 54 18 30\n"
              "newmtl rose_c\nKd 0 0 0\nKe 270 90 150\n"
              "newmtl cyan_a\nKd 0 0 0\nKe 2 8 10\n"
              "newmtl cyan_b\nKd 0 0 0\nKe 12 48 60\n"
              "newmtl cyan_c\nKd 0 0 0\nKe 60 240 300\n");
    mesh_text(folder, "lights200", "view",
              "eye 2 6.5 17\nat 0 .6 0\nup 0 1 0\nfovy 38\nres 1024 576\n"
              "background .04 .05 .08\n");
}

/* --- principled ----------------------------------------------------------- */

/* A row of balls: statements of its material, of which one grows from 0 to 1.
 */
static const struct {
    const char *name, *fixed, *growing;
} lobes[] = {
    {"anisotropy", "Kd .85 .83 .8\nPm 1\nPr .45", "aniso"},
    {"transmission", "Kd .75 .9 .8\nPr .05\nNi 1.5\nillum 2", "Tf"},
    {"sheen", "Kd .12 .06 .2\nKd_roughness 1", "Ps"},
    {"coat", "Kd .6 .06 .04\nKd_roughness 1\nPcr .03", "Pc"},
    {"metal", "Kd 1 .78 .34\nPm 1", "Pr"},
};

static void make_principled(void)
{
    struct mesh m = mesh_open(folder, "principled",
                              "Five balls of each lobe, from 0 to 1.");
    char mtl[4096] = "newmtl floor\nKd .35 .35 .37\n"
                     "newmtl lamp\nKd 0 0 0\nKe 9 8.6 8\n";
    size_t used = strlen(mtl);

    mesh_object(&m, "floor", "floor");
    mesh_quad(&m, at(-9, 0, 7), at(9, 0, 7), at(9, 0, -9), at(-9, 0, -9), 1, 1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-5, 7, -2), at(-2, 7, -2), at(-2, 7, 1), at(-5, 7, 1), 1,
              1);
    for (int i = 0; i < 5 * COUNT(lobes); i++) {
        int row = i / 5, column = i % 5;
        double grown = column / 4.0;
        char name[32];

        snprintf(name, sizeof name, "%s%d", lobes[row].name, column);
        /* a single number for Tf is grey */
        used += (size_t)snprintf(mtl + used, sizeof mtl - used,
                                 "newmtl %s\n%s\n%s %g\n", name,
                                 lobes[row].fixed, lobes[row].growing, grown);
        mesh_object(&m, name, name);
        mesh_sphere(&m, at(1.3 * (column - 2), .5501, 1.5 * (row - 2)), .55, 6);
    }
    mesh_close(&m);
    mesh_text(folder, "principled", "mtl", mtl);
    mesh_text(folder, "principled", "view",
              "eye 0 6.5 8.5\nat 0 .2 0\nup 0 1 0\nfovy 36\nres 1024 768\n"
              "background .5 .55 .6\n");
}

/* --- glTF ----------------------------------------------------------------- */

/* The models have cameras; the view files have the rest. */
static void make_models(void)
{
    model_chess(folder);
    mesh_text(folder, "chess", "view",
              "res 1024 640\nbackground .03 .035 .045\ntone aces\n"
              "exposure .6\n");
    model_bottles(folder);
    mesh_text(folder, "bottles", "view",
              "res 1024 640\nbackground .05 .05 .055\ntone aces\n");
    model_bubbles(folder);
    mesh_text(folder, "bubbles", "view",
              "res 1024 640\nbackground .006 .008 .014\ntone aces\n");
    model_knot(folder);
    mesh_text(folder, "knot", "view",
              "res 1024 640\nbackground .02 .022 .028\ntone aces\n");
    model_forest(folder);
    mesh_text(folder, "forest", "view",
              "res 1024 640\nsun 285 17\nexposure 1.2\ntone aces\n");
    model_jellyfish(folder);
    mesh_text(folder, "jellyfish", "view",
              "res 1024 640\nbackground .002 .008 .022\ntone aces\n");
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: generate FOLDER\n");
        return 2;
    }
    folder = argv[1];
    make_cornell();
    make_materials();
    make_glass_mirror();
    make_interior();
    make_skylit();
    make_lights200();
    make_principled();
    glasses_write(folder);
    media_write(folder);
    make_models();
    images_write(folder);
    return 0;
}
