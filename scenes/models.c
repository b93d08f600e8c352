// SPDX-License-Identifier: MIT
#include "models.h"

#include <math.h>
#include <stdlib.h>

#include "surfaces.h"

/* Extension that a material has, as JSON. */
#define COAT(factor, roughness)                                \
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":" factor \
    ",\"clearcoatRoughnessFactor\":" roughness "}"

/* Adds a material of a colour with these extensions. */
static uint32_t add_material(struct glb *g, const char *name, const char *color,
                             double metal, double roughness,
                             const char *extensions)
{
    return glb_add(&g->materials,
                   "{\"name\":\"%s\",\"pbrMetallicRoughness\":"
                   "{\"baseColorFactor\":%s,\"metallicFactor\":%g,"
                   "\"roughnessFactor\":%g},\"extensions\":{%s}}",
                   name, color, metal, roughness, extensions);
}

/* Adds a level rectangle around the origin. */
static void add_floor(struct glb *g, double side, double y, uint32_t material)
{
    struct plane p = {at(-side / 2, y, side / 2), at(side, 0, 0),
                      at(0, 0, -side)};
    struct glb_grid grid = {1, 1, surface_plane, .context = &p};

    glb_root(g, "\"name\":\"floor\",\"mesh\":%u", glb_mesh(g, &grid, material));
}

/* Returns the shape of a lathe, for free(). */
static char *lathe_shape(struct glb *g, const double (*points)[2], int count,
                         int columns)
{
    const struct profile profile = {points, count, 0};
    const struct glb_grid grid = {.columns = columns,
                                  .rows = 2 * count + count / 2,
                                  .place = surface_lathe,
                                  .context = &profile};

    return glb_shape(g, &grid);
}

/* --- chess ---------------------------------------------------------------- */

static const double pawn[][2] = {{0, 0},     {.34, 0},   {.4, .01},
                                 {.4, .1},   {.37, .16}, {.36, .17},
                                 {.38, .22}, {.3, .27},  {.2, .34},
                                 {.15, .5},  {.12, .66}, {.12, .7},
                                 {.24, .74}, {.24, .78}, {.1, .8},
                                 {.12, .83}, {.24, .95}, {.22, 1.14},
                                 {.1, 1.22}, {0, 1.22}};
static const double rook[][2] = {
    {0, 0},     {.36, 0},   {.42, .01},  {.42, .12},  {.38, .18}, {.38, .2},
    {.4, .25},  {.32, .3},  {.24, .4},   {.21, .7},   {.19, .95}, {.2, 1.0},
    {.3, 1.06}, {.3, 1.1},  {.26, 1.12}, {.31, 1.16}, {.31, 1.4}, {.3, 1.42},
    {.2, 1.42}, {.19, 1.4}, {.19, 1.3},  {.17, 1.28}, {0, 1.28}};
static const double bishop[][2] = {{0, 0},      {.36, 0},    {.42, .01},
                                   {.42, .12},  {.38, .18},  {.38, .2},
                                   {.4, .25},   {.3, .3},    {.2, .4},
                                   {.14, .75},  {.11, 1.05}, {.12, 1.1},
                                   {.27, 1.14}, {.27, 1.18}, {.12, 1.2},
                                   {.13, 1.22}, {.24, 1.34}, {.22, 1.55},
                                   {.08, 1.7},  {.03, 1.74}, {.09, 1.78},
                                   {.07, 1.86}, {0, 1.86}};
static const double queen[][2] = {
    {0, 0},      {.38, 0},    {.45, .01},  {.45, .13},  {.4, .2},
    {.4, .22},   {.42, .28},  {.31, .33},  {.2, .46},   {.14, .9},
    {.12, 1.3},  {.13, 1.36}, {.3, 1.4},   {.3, 1.44},  {.14, 1.47},
    {.15, 1.52}, {.17, 1.7},  {.32, 1.95}, {.31, 1.99}, {.22, 1.92},
    {.12, 1.98}, {.05, 2.02}, {.11, 2.08}, {.08, 2.16}, {0, 2.16}};
static const double king[][2] = {{0, 0},      {.38, 0},    {.45, .01},
                                 {.45, .13},  {.4, .2},    {.4, .22},
                                 {.42, .28},  {.31, .33},  {.2, .46},
                                 {.15, .95},  {.13, 1.42}, {.14, 1.48},
                                 {.31, 1.52}, {.31, 1.56}, {.15, 1.59},
                                 {.16, 1.64}, {.19, 1.85}, {.3, 2.05},
                                 {.27, 2.12}, {.12, 2.16}, {.05, 2.2},
                                 {.05, 2.24}, {.16, 2.3},  {.16, 2.34},
                                 {.04, 2.4},  {.04, 2.52}, {0, 2.52}};

static const struct {
    const double (*points)[2];
    int count;
} shapes[] = {{pawn, COUNT(pawn)},
              {rook, COUNT(rook)},
              {bishop, COUNT(bishop)},
              {queen, COUNT(queen)},
              {king, COUNT(king)}};

/* Squares of the pieces: P, R, B, Q and K are white; columns from a, rows from
 * the last. */
static const char *const position[8] = {"..r..rk.", ".b...ppp", "p....q..",
                                        ".p......", "...PP...", ".B...Q.P",
                                        "P....PP.", "..R..RK."};

static void add_pieces(struct glb *g, const uint32_t materials[2])
{
    static const char letters[] = "prbqkPRBQK";
    uint32_t meshes[10];

    for (int i = 0; i < 5; i++) {
        char *shape = lathe_shape(g, shapes[i].points, shapes[i].count, 32);

        meshes[i] = glb_mesh_of(g, shape, materials[0]);
        meshes[i + 5] = glb_mesh_of(g, shape, materials[1]);
        free(shape);
    }
    for (int square = 0; square < 64; square++) {
        char letter = position[square / 8][square % 8];

        for (int i = 0; i < 10; i++)
            if (letters[i] == letter)
                glb_root(g,
                         "\"name\":\"%c\",\"mesh\":%u,\"translation\":[%g,0,"
                         "%g]",
                         letter, meshes[i], square % 8 - 3.5, square / 8 - 3.5);
    }
}

/* A texture of 2x2 pixels is repeated four times on the board. */
static void add_board(struct glb *g)
{
    static const uint8_t squares[12] = {214, 186, 140, 74,  40,  22,
                                        74,  40,  22,  214, 186, 140};
    static const double frame[][2] = {{0, -.62},  {6.7, -.62},  {6.9, -.6},
                                      {6.9, -.2}, {6.75, -.08}, {6.7, 0},
                                      {6.4, 0},   {6.3, 0},     {6.2, -.005}};
    struct plane p = {at(-4, .002, 4), at(8, 0, 0), at(0, 0, -8)};
    struct glb_grid grid = {
        1, 1, surface_plane, .context = &p, .u_repeat = 1, .v_repeat = 1};
    struct profile rim = {frame, COUNT(frame), 0};
    struct glb_grid round = {96, 24, surface_lathe, .context = &rim};
    uint32_t board, wood;

    glb_use(g, "KHR_texture_transform");
    board = glb_add(
        &g->materials,
        "{\"name\":\"board\",\"pbrMetallicRoughness\":{\"baseColorTexture\":"
        "{\"index\":%u,\"extensions\":{\"KHR_texture_transform\":"
        "{\"scale\":[4,4]}}},\"metallicFactor\":0,\"roughnessFactor\":0.45},"
        "\"extensions\":{" COAT("1", "0.08") "}}",
        glb_texture(g, squares, 2, 2, 1));
    wood =
        add_material(g, "wood", "[0.14,0.06,0.03,1]", 0, .5, COAT("1", "0.15"));
    glb_root(g, "\"name\":\"board\",\"mesh\":%u", glb_mesh(g, &grid, board));
    glb_root(g, "\"name\":\"table\",\"mesh\":%u", glb_mesh(g, &round, wood));
}

void model_chess(const char *folder)
{
    struct glb g = {.size_bytes = 0};
    const struct point middle = at(0, .6, 0);
    uint32_t ivory, ebony;

    glb_use(&g, "KHR_materials_clearcoat");
    ivory = add_material(&g, "ivory", "[0.8,0.68,0.5,1]", 0, .5,
                         COAT("0.8", "0.12"));
    ebony = add_material(&g, "ebony", "[0.018,0.014,0.013,1]", 0, .4,
                         COAT("1", "0.1"));
    add_board(&g);
    add_pieces(&g, (const uint32_t[2]){ebony, ivory});
    surface_softbox(&g, at(-7, 7, -5), middle, 6, 5,
                    surface_lamp(&g, "[1,0.78,0.55]", 9));
    glb_light(&g, at(9, 6, 2), middle,
              "\"type\":\"spot\",\"color\":[0.5,0.7,1],\"intensity\":60,"
              "\"spot\":{\"innerConeAngle\":0.3,\"outerConeAngle\":0.6}");
    glb_camera(&g, at(3, 3.6, 9.4), at(.2, .3, .3), 32);
    glb_write(&g, folder, "chess");
    glb_free(&g);
}

/* --- bottles -------------------------------------------------------------- */

static const double tall[][2] = {
    {0, 0},      {.5, 0},     {.6, .02},  {.6, .2},   {.6, .7},   {.6, 1.1},
    {.58, 1.3},  {.3, 1.5},   {.2, 1.6},  {.18, 1.8}, {.18, 2.1}, {.26, 2.12},
    {.26, 2.22}, {.14, 2.24}, {.12, 2.1}, {.12, 1.8}, {.14, 1.6}, {.24, 1.48},
    {.5, 1.28},  {.52, 1.1},  {.52, .7},  {.52, .24}, {.46, .14}, {0, .16}};
static const double flask[][2] = {
    {0, 0},      {.3, 0},    {.5, .02},  {.75, .2},   {.85, .5},  {.75, .85},
    {.4, 1.05},  {.2, 1.15}, {.16, 1.4}, {.16, 1.55}, {.3, 1.6},  {.28, 1.66},
    {.14, 1.62}, {.1, 1.5},  {.1, 1.35}, {.14, 1.16}, {.35, .98}, {.68, .8},
    {.77, .5},   {.68, .24}, {.45, .1},  {0, .1}};
static const double cup[][2] = {{0, 0},      {.4, 0},    {.45, .02},
                                {.4, .06},   {.1, .1},   {.07, .3},
                                {.07, .6},   {.12, .7},  {.45, .85},
                                {.58, 1.2},  {.5, 1.65}, {.47, 1.66},
                                {.44, 1.62}, {.52, 1.2}, {.4, .9},
                                {.15, .8},   {0, .78}};

enum { TALL, FLASK, CUP };

static const struct {
    int shape;
    double x, z, size;
    const char *color; /* of white light after 0.1 */
} vessels[] = {
    {TALL, -1.4, -.4, 1, "[0.25,0.72,0.32]"},
    {FLASK, -.15, .45, .95, "[0.95,0.5,0.12]"},
    {TALL, 1.15, -.6, .85, "[0.12,0.3,0.85]"},
    {CUP, 2.05, .35, 1, "[0.9,0.45,0.6]"},
    {CUP, -2.45, .55, .9, "[0.6,0.85,0.9]"},
};

/* Floor and wall of a studio without a corner. */
static struct point sweep(const void *context, double u, double v)
{
    double x = 16 * (u - .5), along = 16 * v, turn = along - 6;

    (void)context;
    if (turn < 0)
        return at(x, 0, 4 - along);
    if (turn < PI) /* a quarter of a circle of radius 2 */
        return at(x, 2 - 2 * cos(turn / 2), -2 - 2 * sin(turn / 2));
    return at(x, 2 + turn - PI, -4);
}

static void add_vessels(struct glb *g)
{
    char *const made[] = {lathe_shape(g, tall, COUNT(tall), 44),
                          lathe_shape(g, flask, COUNT(flask), 44),
                          lathe_shape(g, cup, COUNT(cup), 44)};

    for (int i = 0; i < COUNT(vessels); i++) {
        double size = vessels[i].size;
        char glass[300];

        snprintf(glass, sizeof glass,
                 "\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                 "\"KHR_materials_volume\":{\"thicknessFactor\":0.1,"
                 "\"attenuationDistance\":0.1,\"attenuationColor\":%s}",
                 vessels[i].color);
        glb_root(g,
                 "\"name\":\"vessel\",\"mesh\":%u,\"translation\":[%g,0.001,"
                 "%g],\"scale\":[%g,%g,%g]",
                 glb_mesh_of(g, made[vessels[i].shape],
                             add_material(g, "glass", "[1,1,1,1]", 0, 0,
                                          glass)),
                 vessels[i].x, vessels[i].z, size, size, size);
    }
    for (int i = 0; i < COUNT(made); i++)
        free(made[i]);
}

void model_bottles(const char *folder)
{
    struct glb g = {.size_bytes = 0};
    struct glb_grid paper = {.columns = 1, .rows = 64, .place = sweep};
    const struct point middle = at(0, 1, 0);

    glb_use(&g, "KHR_materials_transmission");
    glb_use(&g, "KHR_materials_volume");
    glb_root(&g, "\"name\":\"paper\",\"mesh\":%u",
             glb_mesh(&g, &paper,
                      add_material(&g, "paper", "[0.72,0.68,0.62,1]", 0, 1,
                                   "")));
    add_vessels(&g);
    surface_softbox(&g, at(-5, 4.5, 1.5), middle, 2.5, 3.5,
                    surface_lamp(&g, "[1,0.95,0.88]", 6));
    surface_softbox(&g, at(6, 3, 3), middle, 1, 4,
                    surface_lamp(&g, "[0.85,0.92,1]", 6));
    /* a small lamp behind the glass, for its caustics */
    surface_softbox(&g, at(4, 5, -2.6), at(0, 0, .2), .5, .5,
                    surface_lamp(&g, "[1,0.9,0.75]", 420));
    glb_camera(&g, at(0, 2.1, 8.2), at(-.2, .75, 0), 27);
    glb_write(&g, folder, "bottles");
    glb_free(&g);
}

/* --- bubbles -------------------------------------------------------------- */

/* Draws how thick the soap is: it runs down, in swirls. */
static void draw_film(uint8_t *rgb, int width, int height)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double u = 2 * PI * x / width, v = (y + .5) / height;
            double swirl = .06 * sin(3 * u + 9 * v) + .05 * sin(7 * v - 2 * u) +
                           .03 * sin(5 * u - 14 * v);
            double thick = fmin(fmax(v + swirl, 0), 1);

            for (int c = 0; c < 3; c++)
                rgb[3 * (y * width + x) + c] = (uint8_t)(64 * thick) * 3;
        }
}

/* Water that drops have fallen on. */
static struct point ripples(const void *context, double u, double v)
{
    static const double drops[][3] = {{-2.2, .6, .03}, {2.4, -1.2, .025}};
    double x = 24 * (u - .5), z = 10 - 24 * v, y = 0;

    (void)context;
    for (int i = 0; i < COUNT(drops); i++) {
        double d = sqrt(pow(x - drops[i][0], 2) + pow(z - drops[i][1], 2));

        y += drops[i][2] * cos(7 * d) * exp(-.45 * d);
    }
    return at(x, y, z);
}

static const double bubbles[][4] = {
    /* x, y, z, radius */
    {0, 1.75, 0, 1.15},     {-2.05, 1.2, .5, .72},  {1.9, 1.1, .7, .62},
    {-1.35, 2.95, -.6, .5}, {1.55, 2.75, -.5, .42}, {-3.15, 2.4, -.8, .38},
    {3.05, 2.25, -.3, .45}, {-.7, .42, 1.55, .34},  {.75, .34, 1.8, .22},
    {-2.95, .38, 1.0, .28}, {2.75, .5, 1.3, .24},   {.1, 3.35, -.4, .2},
    {-.85, 3.6, -.2, .12},  {2.3, 3.3, 0, .15},     {-2.3, 3.45, 0, .17},
    {1.15, .9, 1.5, .13},   {-1.45, .7, 1.9, .12},  {3.7, 3.0, -1, .2},
    {-3.8, 1.3, -.2, .22},  {.35, .9, 2.0, .09}};

void model_bubbles(const char *folder)
{
    enum { WIDTH = 64, HEIGHT = 64 };
    static uint8_t thickness[WIDTH * HEIGHT * 3];
    struct glb g = {.size_bytes = 0};
    struct glb_grid ball = {64, 32, surface_ball, .u_repeat = 1, .v_repeat = 1};
    struct glb_grid water = {.columns = 72, .rows = 72, .place = ripples};
    const struct point middle = at(0, 1.6, 0);
    uint32_t film, mesh;

    glb_use(&g, "KHR_materials_transmission");
    glb_use(&g, "KHR_materials_iridescence");
    glb_use(&g, "KHR_materials_ior");
    draw_film(thickness, WIDTH, HEIGHT);
    film = glb_add(
        &g.materials,
        "{\"name\":\"soap\",\"doubleSided\":true,\"pbrMetallicRoughness\":"
        "{\"metallicFactor\":0,\"roughnessFactor\":0},\"extensions\":"
        "{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
        "\"KHR_materials_ior\":{\"ior\":1.33},\"KHR_materials_iridescence\":"
        "{\"iridescenceFactor\":1,\"iridescenceIor\":1.5,"
        "\"iridescenceThicknessMinimum\":520,"
        "\"iridescenceThicknessMaximum\":110,"
        "\"iridescenceThicknessTexture\":{\"index\":%u}}}}",
        glb_texture(&g, thickness, WIDTH, HEIGHT, 0));
    mesh = glb_mesh(&g, &ball, film);
    for (int i = 0; i < COUNT(bubbles); i++)
        glb_root(&g,
                 "\"name\":\"bubble\",\"mesh\":%u,\"translation\":[%g,%g,%g],"
                 "\"scale\":[%g,%g,%g]",
                 mesh, bubbles[i][0], bubbles[i][1], bubbles[i][2],
                 bubbles[i][3], bubbles[i][3], bubbles[i][3]);
    glb_root(&g, "\"name\":\"water\",\"mesh\":%u",
             glb_mesh(&g, &water,
                      add_material(&g, "water", "[0.004,0.012,0.02,1]", 0, .02,
                                   "")));
    surface_softbox(&g, at(-6, 5, 4), middle, 5, 7,
                    surface_lamp(&g, "[1,0.93,0.85]", 9));
    surface_softbox(&g, at(6, 4, 3), middle, 4, 7,
                    surface_lamp(&g, "[0.8,0.9,1]", 9));
    surface_softbox(&g, at(.5, 8, -5), middle, 12, 4,
                    surface_lamp(&g, "[0.95,0.88,1]", 8));
    glb_camera(&g, at(0, 2, 10.5), at(0, 1.72, 0), 26);
    glb_write(&g, folder, "bubbles");
    glb_free(&g);
}

/* --- knot ----------------------------------------------------------------- */

static struct point knot_line(double t)
{
    double a = 2 * PI * t, r = 1 + .42 * cos(3 * a);

    return at(r * cos(2 * a), .52 * sin(3 * a), -r * sin(2 * a));
}

/* Tube around a torus knot, in the frame of its tangent and its distance from
 * the axis. */
static struct point knot(const void *context, double u, double v)
{
    struct point p = knot_line(v), q = knot_line(v + 1e-5);
    struct point o = knot_line(v - 1e-5);
    double t[3] = {q.x - o.x, q.y - o.y, q.z - o.z};
    double n[3] = {p.x, 0, p.z}, b[3], length, along;
    double c = .3 * cos(2 * PI * u), s = .3 * sin(2 * PI * u);

    (void)context;
    length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    for (int i = 0; i < 3; i++)
        t[i] /= length;
    along = n[0] * t[0] + n[2] * t[2];
    for (int i = 0; i < 3; i++)
        n[i] -= along * t[i];
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        n[i] /= length;
    b[0] = t[1] * n[2] - t[2] * n[1];
    b[1] = t[2] * n[0] - t[0] * n[2];
    b[2] = t[0] * n[1] - t[1] * n[0];
    return at(p.x + c * n[0] + s * b[0], p.y + c * n[1] + s * b[1],
              p.z + c * n[2] + s * b[2]);
}

static double power(double x, double exponent)
{
    return x < 0 ? -pow(-x, exponent) : pow(x, exponent);
}

/* A cushion with four corners, which sinks in the middle. */
static struct point cushion(const void *context, double u, double v)
{
    double a = 2 * PI * u, h = PI * (v - .5);
    double side = pow(cos(h), .8);
    double x = 2.6 * side * power(cos(a), .45);
    double z = -2.6 * side * power(sin(a), .45);
    /* the sides curve inwards between the corners, which are thin */
    double pinch = 1 - .16 * pow(sin(2 * a), 2) * side + .12 * side;
    double thick = .75 - .3 * pow(sin(2 * a), 4) * side;
    double top = sin(h) > 0 ? .35 * exp(-(x * x + z * z) / 2) : 0;

    (void)context;
    return at(x * (1.16 - pinch * .16), thick * power(sin(h), .9) - top,
              z * (1.16 - pinch * .16));
}

void model_knot(const char *folder)
{
    struct glb g = {.size_bytes = 0};
    struct glb_grid tube = {28, 168, knot, .u_repeat = 1, .v_repeat = 1};
    struct glb_grid velvet = {.columns = 72, .rows = 48, .place = cushion};
    const struct point middle = at(0, 1, 0);
    uint32_t gold, cloth, stone;

    glb_use(&g, "KHR_materials_anisotropy");
    glb_use(&g, "KHR_materials_sheen");
    glb_use(&g, "KHR_materials_clearcoat");
    gold = add_material(&g, "brushed gold", "[1,0.72,0.3,1]", 1, .32,
                        "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":"
                        "0.8,\"anisotropyRotation\":1.5708}");
    cloth = add_material(&g, "velvet", "[0.07,0.002,0.012,1]", 0, 1,
                         "\"KHR_materials_sheen\":{\"sheenColorFactor\":"
                         "[0.95,0.2,0.3],\"sheenRoughnessFactor\":0.3}");
    stone = add_material(&g, "stone", "[0.02,0.022,0.026,1]", 0, .6,
                         COAT("1", "0.06"));
    add_floor(&g, 60, -.72, stone);
    glb_root(&g, "\"name\":\"knot\",\"mesh\":%u,\"translation\":[0,1.2,0]",
             glb_mesh(&g, &tube, gold));
    glb_root(&g,
             "\"name\":\"cushion\",\"mesh\":%u,"
             "\"rotation\":[0,0.17365,0,0.98481]",
             glb_mesh(&g, &velvet, cloth));
    surface_softbox(&g, at(-5, 5, 2), middle, 3, 4,
                    surface_lamp(&g, "[1,0.92,0.82]", 10));
    surface_softbox(&g, at(5, 3.5, -4), middle, 5, 2,
                    surface_lamp(&g, "[0.7,0.82,1]", 9));
    surface_softbox(&g, at(4, 2.5, 5), middle, 1, 4,
                    surface_lamp(&g, "[1,0.95,0.9]", 4));
    glb_camera(&g, at(1.1, 4.6, 7.4), at(0, .45, 0), 33);
    glb_write(&g, folder, "knot");
    glb_free(&g);
}
