// SPDX-License-Identifier: MIT
#include "media.h"

#include <math.h>
#include <stdlib.h>

#include "bust.h"
#include "mesh.h"
#include "surfaces.h"

/* ---- fog ---- */

/* A wall of thickness .16 behind z, from x0 to x1, with an opening of this
 * rectangle. */
static void wall_around(struct mesh *m, double z, const double wall[2],
                        const double hole[4])
{
    const double deep = .16, high = 2.7, middle = z - deep / 2;
    double left = hole[0] - wall[0], right = wall[1] - hole[1];
    double over = high - hole[3], under = hole[2];

    mesh_box(m, at(wall[0] + left / 2, 0, middle), at(left, high, deep), 0);
    mesh_box(m, at(wall[1] - right / 2, 0, middle), at(right, high, deep), 0);
    mesh_box(m, at((hole[0] + hole[1]) / 2, hole[3], middle),
             at(hole[1] - hole[0], over, deep), 0);
    if (under > 0)
        mesh_box(m, at((hole[0] + hole[1]) / 2, 0, middle),
                 at(hole[1] - hole[0], under, deep), 0);
}

/* A chair that looks to +z before it is turned. */
static void chair(struct mesh *m, struct point foot, double turn_deg)
{
    double c = cos(turn_deg * M_PI / 180), s = sin(turn_deg * M_PI / 180);
    static const double boxes[][6] = {
        {0, .44, 0, .42, .035, .42},     {-.185, 0, .185, .04, .44, .04},
        {.185, 0, .185, .04, .44, .04},  {-.185, 0, -.185, .04, .95, .04},
        {.185, 0, -.185, .04, .95, .04}, {0, .6, -.185, .33, .05, .02},
        {0, .72, -.185, .33, .05, .02},  {0, .84, -.185, .33, .09, .02}};

    for (int i = 0; i < COUNT(boxes); i++) {
        const double *b = boxes[i];

        mesh_box(m,
                 at(foot.x + c * b[0] + s * b[2], foot.y + b[1],
                    foot.z + c * b[2] - s * b[0]),
                 at(b[3], b[4], b[5]), turn_deg);
    }
}

/* A room, from -2.6 to 1.6 and from -1 to 3, and a hall behind its door. */
static void fog_house(struct mesh *m)
{
    static const double walls[][2] = {{-2.6, -.7}, {-.7, 2.4}};
    static const double holes[][4] = {{-2, -1.1, .85, 2.15}, {-.1, .8, 0, 2.1}};

    mesh_object(m, "floor", "planks");
    mesh_quad(m, at(-2.6, 0, 3), at(2.4, 0, 3), at(2.4, 0, -4), at(-2.6, 0, -4),
              2.5, 3.5);
    mesh_object(m, "walls", "plaster");
    for (int i = 0; i < COUNT(walls); i++)
        wall_around(m, -1, walls[i], holes[i]);
    mesh_box(m, at(1.7, 0, 1), at(.2, 2.7, 4), 0);
    mesh_box(m, at(-2.7, 0, .92), at(.2, 2.7, 4.16), 0);
    mesh_box(m, at(-.1, 0, 3.1), at(5.4, 2.7, .2), 0);
    mesh_object(m, "hall", "paint");
    mesh_box(m, at(-.8, 0, -2.63), at(.2, 2.7, 2.94), 0);
    mesh_box(m, at(2.5, 0, -2.63), at(.2, 2.7, 2.94), 0);
    mesh_box(m, at(.8, 0, -4.1), at(3.4, 2.7, .2), 0);
    mesh_object(m, "ceiling", "plaster");
    mesh_box(m, at(-.1, 2.7, 1.02), at(5.4, .1, 4.36), 0);
    mesh_box(m, at(.85, 2.7, -2.68), at(3.5, .1, 3.04), 0);
    mesh_object(m, "window", "wood");
    for (int i = 0; i < 3; i++) {
        mesh_box(m, at(-2 + .45 * i, .85, -1.08), at(.045, 1.3, .06), 0);
        mesh_box(m, at(-1.55, .83 + .64 * i, -1.08), at(.95, .04, .05), 0);
    }
    mesh_box(m, at(-1.55, .81, -.98), at(1.1, .04, .16), 0);
    mesh_object(m, "frame", "wood");
    for (int i = 0; i < 2; i++)
        mesh_box(m, at(i ? .835 : -.135, 0, -1.08), at(.07, 2.14, .2), 0);
    mesh_box(m, at(.35, 2.1, -1.08), at(1.04, .07, .2), 0);
}

static void make_fog(const char *folder)
{
    static const double vase[][2] = {{0, 0},     {.05, 0},   {.09, .06},
                                     {.1, .13},  {.06, .22}, {.03, .27},
                                     {.04, .31}, {.03, .31}, {.02, .27},
                                     {0, .26}};
    struct mesh m = mesh_open(folder, "fog",
                              "Evening fog in a house: a lamp behind a door, "
                              "and the blue of a window.");

    fog_house(&m);
    mesh_object(&m, "lamp", "lamp");
    mesh_sphere(&m, at(.5, 1.62, -2.7), .11, SEGMENTS);
    mesh_object(&m, "cord", "black");
    mesh_box(&m, at(.5, 1.725, -2.7), at(.012, .985, .012), 0);
    mesh_object(&m, "chair", "wood");
    chair(&m, at(.16, 0, -.15), 215);
    mesh_object(&m, "table", "wood");
    mesh_box(&m, at(-1.55, .7, -.45), at(1.1, .04, .6), 0);
    for (int i = 0; i < 4; i++)
        mesh_box(&m, at(i % 2 ? -1.06 : -2.04, 0, i / 2 ? -.21 : -.69),
                 at(.06, .7, .06), 0);
    mesh_object(&m, "vase", "china");
    mesh_lathe(&m, at(-1.3, .7401, -.45), vase, COUNT(vase), 32);
    mesh_close(&m);
    mesh_text(folder, "fog", "mtl",
              "newmtl planks\nKd .9 .85 .8\nmap_Kd planks.png\nillum 1\n"
              "newmtl plaster\nKd .45 .43 .42\nillum 1\n"
              "newmtl wood\nKd .22 .13 .08\nillum 1\n"
              "newmtl china\nKd .75 .75 .73\nillum 1\n"
              "newmtl paint\nKd .3 .24 .2\nillum 1\n"
              "newmtl black\nKd .03 .03 .03\nillum 1\n"
              "newmtl lamp\nKd 0 0 0\nKe 240 135 60\nillum 1\n");
    mesh_text(folder, "fog", "view",
              "eye .35 1.4 2.9\nat -.35 1.12 -1\nup 0 1 0\nfovy 44\n"
              "background .5 1.05 2.5\n"
              "fog scatter .2 .2 .2 absorb 0 0 0 anisotropy .6 height 1.6 "
              "falloff 1.5\n"
              "res 1024 576\nexposure .4\ntone aces\n");
}

/* ---- busts ---- */

static void add_level(struct glb *g, const char *name, double half, double y,
                      const char *material)
{
    struct plane p = {at(-half, y, half), at(2 * half, 0, 0),
                      at(0, 0, -2 * half)};
    const struct glb_grid grid = {1, 1, surface_plane, .context = &p};

    glb_root(g, "\"name\":\"%s\",\"mesh\":%u", name,
             glb_mesh(g, &grid, glb_add(&g->materials, "%s", material)));
}

/* Writes six faces of a box around the middle of its bottom. */
static void add_block(struct glb *g, struct point foot, struct point size,
                      uint32_t material)
{
    static const double faces[6][9] = {/* corner, u, v */
                                       {-.5, 0, .5, 1, 0, 0, 0, 1, 0},
                                       {.5, 0, .5, 0, 0, -1, 0, 1, 0},
                                       {.5, 0, -.5, -1, 0, 0, 0, 1, 0},
                                       {-.5, 0, -.5, 0, 0, 1, 0, 1, 0},
                                       {-.5, 1, .5, 1, 0, 0, 0, 0, -1},
                                       {-.5, 0, -.5, 1, 0, 0, 0, 0, 1}};

    for (int i = 0; i < 6; i++) {
        const double *f = faces[i];
        const struct plane p = {at(foot.x + f[0] * size.x,
                                   foot.y + f[1] * size.y,
                                   foot.z + f[2] * size.z),
                                at(f[3] * size.x, f[4] * size.y, f[5] * size.z),
                                at(f[6] * size.x, f[7] * size.y,
                                   f[8] * size.z)};
        const struct glb_grid grid = {1, 1, surface_plane, .context = &p};

        glb_root(g, "\"name\":\"plinth\",\"mesh\":%u",
                 glb_mesh(g, &grid, material));
    }
}

static void make_busts(const char *folder)
{
    static const char *const stones[] = {"marble", "jade"};
    struct glb g = {.size_bytes = 0};
    struct bust bust = bust_make();
    uint32_t plinth;
    char *shape = glb_triangles(&g, bust.places, bust.normals, bust.point_count,
                                bust.corners, bust.corner_count);

    for (int i = 0; i < 2; i++) {
        uint32_t stone = glb_add(&g.materials, "{\"name\":\"%s\"}", stones[i]);
        double half = (i == 0 ? 32 : -28) * PI / 360;

        glb_root(&g,
                 "\"name\":\"%s\",\"mesh\":%u,\"translation\":[%g,%g,%g],"
                 "\"rotation\":[0,%.6f,0,%.6f]",
                 stones[i], glb_mesh_of(&g, shape, stone), i == 0 ? -.2 : .2,
                 .0505, i == 0 ? .04 : -.06, sin(half), cos(half));
    }
    free(shape);
    bust_free(&bust);
    plinth =
        glb_add(&g.materials, "{\"name\":\"plinth\",\"pbrMetallicRoughness\":"
                              "{\"baseColorFactor\":[0.03,0.03,0.035,1],"
                              "\"metallicFactor\":0,\"roughnessFactor\":0.3}}");
    add_block(&g, at(-.2, 0, .02), at(.16, .05, .16), plinth);
    add_block(&g, at(.2, 0, -.08), at(.16, .05, .16), plinth);
    add_level(&g, "table", 3, 0,
              "{\"name\":\"table\",\"pbrMetallicRoughness\":"
              "{\"baseColorFactor\":[0.16,0.13,0.11,1],\"metallicFactor\":0,"
              "\"roughnessFactor\":0.5}}");
    surface_softbox(&g, at(-1.5, .9, .5), at(0, .3, 0), .4, .8,
                    surface_lamp(&g, "[1,0.95,0.88]", 3));
    surface_softbox(&g, at(.85, .95, -.7), at(.15, .36, 0), .25, .25,
                    surface_lamp(&g, "[1,0.86,0.68]", 200));
    surface_softbox(&g, at(-.6, 1, -.7), at(-.15, .36, 0), .2, .2,
                    surface_lamp(&g, "[1,0.9,0.75]", 160));
    glb_camera(&g, at(0, .38, 1.55), at(0, .272, 0), 20.5);
    glb_write(&g, folder, "busts");
    glb_free(&g);
    mesh_text(folder, "busts", "glb.mtl",
              "newmtl marble\nKd .86 .84 .8\nKs .5 .5 .5\nPr .3\nSf 1\n"
              "Sr .004 .003 .0023\n"
              "newmtl jade\nKd .3 .43 .33\nKs .5 .5 .5\nPr .2\nSf 1\n"
              "Sr .012 .022 .014\n");
    mesh_text(folder, "busts", "view",
              "res 1024 640\nbackground .02 .024 .03\nexposure 0\n"
              "tone aces\n");
}

/* ---- milk ---- */

/* How high the milk stands, and the inner radius there. */
#define LEVEL  .088
#define INSIDE .0344

/* A tumbler of which milk is the inner wall, up to its level: both bodies have
 * the same points there. */
static void glass_of_milk(struct mesh *m, struct point foot)
{
    /* short pieces beside what is round keep the walls flat */
    static const double glass[][2] = {{0, 0},         {.028, 0},
                                      {.029, 0},      {.0315, .0015},
                                      {.0325, .004},  {.0326, .006},
                                      {.0384, .1185}, {.03845, .1199},
                                      {.038, .1211},  {.0373, .1213},
                                      {.0366, .1211}, {.0361, .1203},
                                      {.036, .119},   {INSIDE, LEVEL}};
    static const double milk[][2] = {{0, .011},       {.023, .011},
                                     {.026, .0117},   {.0286, .0138},
                                     {.0298, .017},   {.03, .02},
                                     {INSIDE, LEVEL}, {.0338, .0875},
                                     {.0328, .0871},  {.0312, .0869},
                                     {.029, .0868},   {0, .0868}};

    mesh_object(m, "glass", "glass");
    mesh_lathe(m, foot, glass, COUNT(glass), 60);
    mesh_object(m, "milk", "milk");
    mesh_lathe(m, foot, milk, COUNT(milk), 60);
}

/* A round cookie with chips of chocolate. */
static void cookie(struct mesh *m, struct point foot, int first)
{
    static const double profile[][2] = {{0, 0},       {.026, 0},
                                        {.031, .003}, {.032, .006},
                                        {.029, .009}, {.02, .0115},
                                        {.01, .0125}, {0, .0127}};

    mesh_object(m, "cookie", "dough");
    mesh_lathe(m, foot, profile, COUNT(profile), 32);
    mesh_object(m, "chips", "chocolate");
    for (int i = 0; i < 7; i++) {
        double turn = 2.4 * (i + first), r = .0105 * sqrt(i + .3);

        mesh_sphere(m,
                    at(foot.x + r * cos(turn), foot.y + .0125 - 6 * r * r * .9,
                       foot.z + r * sin(turn)),
                    .0028 + .0006 * sin(7. * i), 2);
    }
}

static void make_milk(const char *folder)
{
    static const double plate[][2] = {{0, 0},        {.04, 0},
                                      {.045, .002},  {.07, .009},
                                      {.074, .0115}, {.073, .0125},
                                      {.068, .0112}, {.044, .005},
                                      {0, .005}};
    struct mesh m =
        mesh_open(folder, "milk", "A glass of milk, and cookies on a plate.");

    mesh_object(&m, "table", "planks");
    mesh_quad(&m, at(-1, 0, 1), at(1, 0, 1), at(1, 0, -1), at(-1, 0, -1), 6, 6);
    glass_of_milk(&m, at(-.035, .0002, 0));
    mesh_object(&m, "plate", "china");
    mesh_lathe(&m, at(.085, .0006, .02), plate, COUNT(plate), 48);
    cookie(&m, at(.075, .0057, .03), 0);
    cookie(&m, at(.1, .0057, -.01), 3);
    cookie(&m, at(.083, .019, .012), 7);
    mesh_object(&m, "napkin", "cloth");
    mesh_box(&m, at(.085, 0, .03), at(.2, .0004, .2), 20);
    mesh_object(&m, "wall", "wall");
    mesh_quad(&m, at(-1, 0, -.5), at(1, 0, -.5), at(1, 1, -.5), at(-1, 1, -.5),
              1, 1);
    mesh_object(&m, "lamp", "lamp");
    mesh_quad(&m, at(-.62, .24, -.1), at(-.48, .24, -.34), at(-.44, .48, -.32),
              at(-.58, .48, -.08), 1, 1);
    mesh_close(&m);
    mesh_text(folder, "milk", "mtl",
              "newmtl planks\nKd 1 1 1\nmap_Kd planks.png\nillum 1\n"
              "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
              "newmtl milk\nKd .93 .915 .86\nSf 1\nSr .005 .0042 .0032\n"
              "newmtl china\nKd .8 .8 .78\nKs .5 .5 .5\nPr .2\n"
              "newmtl cloth\nKd .2 .3 .48\nillum 1\n"
              "newmtl wall\nKd .3 .36 .36\nillum 1\n"
              "newmtl dough\nKd .62 .38 .17\nillum 1\n"
              "newmtl chocolate\nKd .07 .035 .02\nKs .4 .4 .4\nPr .4\n"
              "newmtl lamp\nKd 0 0 0\nKe 34 27 18\nillum 1\n");
    mesh_text(folder, "milk", "view",
              "eye .1 .17 .42\nat .032 .05 .0\nup 0 1 0\nfovy 25\n"
              "background .2 .23 .28\n"
              "res 1024 640\nexposure .2\ntone aces\n");
}

void media_write(const char *folder)
{
    make_fog(folder);
    make_busts(folder);
    make_milk(folder);
}
