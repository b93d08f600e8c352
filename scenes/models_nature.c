// SPDX-License-Identifier: MIT
#include "models.h"

#include <math.h>
#include <stdlib.h>

#include "surfaces.h"

/* Returns a pseudorandom number in [0, 1), the same on every machine. */
static double next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* Adds a material of one colour. */
static uint32_t add_color(struct glb *g, const char *name, const char *color,
                          double roughness)
{
    return glb_add(&g->materials,
                   "{\"name\":\"%s\",\"pbrMetallicRoughness\":"
                   "{\"baseColorFactor\":%s,\"metallicFactor\":0,"
                   "\"roughnessFactor\":%g}}",
                   name, color, roughness);
}

/* --- forest --------------------------------------------------------------- */

#define LAND 60.0 /* side of the land */

/* Returns the height of the land above the lake. */
static double height_at(double x, double z)
{
    double lake = (x + 1) * (x + 1) / 110 + (z - 8) * (z - 8) / 60;

    return 3.2 - 5.2 * exp(-lake) + 1.3 * sin(.21 * x + 1) * cos(.17 * z) +
           .5 * sin(.55 * x - .3 * z) + .25 * cos(.9 * z + .4 * x) +
           .1 * (z < -8 ? (z + 8) * (z + 8) / 8 : 0);
}

static struct point land(const void *context, double u, double v)
{
    double x = LAND * (u - .5), z = LAND * (.5 - v);

    (void)context;
    return at(x, height_at(x, z), z);
}

static const double conifer[][2] = {{0, 0},     {.05, 0},    {.05, .3},
                                    {.1, .32},  {.62, .16},  {.66, .2},
                                    {.2, .7},   {.18, .72},  {.5, .6},
                                    {.52, .64}, {.16, 1.1},  {.14, 1.12},
                                    {.4, 1.02}, {.41, 1.06}, {.11, 1.5},
                                    {.1, 1.52}, {.28, 1.44}, {.28, 1.48},
                                    {.06, 1.9}, {.02, 2.1},  {0, 2.15}};

/* A crown of leaves: a ball with bumps, on a trunk. */
static struct point crown(const void *context, double u, double v)
{
    struct point p = surface_ball(NULL, u, v);
    double r = .62 + .08 * sin(5 * p.x + 3 * p.y) * sin(7 * p.z + 2) +
               .06 * sin(11 * p.y + 4 * p.x) * cos(9 * p.z);

    (void)context;
    if (v < .12) /* the trunk */
        return at(.5 * v * p.x / fmax(cos(PI * (v - .5)), .01), 3 * v,
                  .5 * v * p.z / fmax(cos(PI * (v - .5)), .01));
    return at(r * p.x, 1.0 + 1.15 * r * p.y, r * p.z);
}

/* Adds `count` instances of a mesh where a tree can stand: above the shore, and
 * not beside another one. */
static void add_trees(struct glb *g, uint32_t mesh, int count, double size,
                      uint32_t seed)
{
    double *places = calloc((size_t)count, 3 * sizeof *places);
    double *turns = calloc((size_t)count, 4 * sizeof *turns);
    double *sizes = calloc((size_t)count, 3 * sizeof *sizes);
    uint32_t accessors[3];
    int n = 0;

    while (n < count) {
        double x = LAND * (next_random(&seed) - .5);
        double z = LAND * (next_random(&seed) - .5), y = height_at(x, z);
        double angle = PI * next_random(&seed);
        double s = size * (.6 + .8 * next_random(&seed));

        if (y < .35 || z > 20 || (z > 12 && fabs(x + 2) < z / 2 - 3) ||
            y > 8 + 2 * next_random(&seed))
            continue;
        places[3 * n] = x;
        places[3 * n + 1] = y - .05;
        places[3 * n + 2] = z;
        turns[4 * n + 1] = sin(angle);
        turns[4 * n + 3] = cos(angle);
        sizes[3 * n] = sizes[3 * n + 2] = s;
        sizes[3 * n + 1] = s * (.85 + .4 * next_random(&seed));
        n++;
    }
    accessors[0] = glb_floats(g, places, count, 3, "VEC3");
    accessors[1] = glb_floats(g, turns, count, 4, "VEC4");
    accessors[2] = glb_floats(g, sizes, count, 3, "VEC3");
    glb_root(g,
             "\"name\":\"trees\",\"mesh\":%u,\"extensions\":"
             "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":%u,"
             "\"ROTATION\":%u,\"SCALE\":%u}}}",
             mesh, accessors[0], accessors[1], accessors[2]);
    free(places);
    free(turns);
    free(sizes);
}

static const struct {
    const char *name, *color;
    int is_leafy, count;
    double size;
} kinds[] = {{"fir", "[0.03,0.085,0.04,1]", 0, 1500, .85},
             {"larch", "[0.13,0.17,0.035,1]", 0, 500, .8},
             {"maple", "[0.55,0.1,0.015,1]", 1, 240, .8},
             {"birch", "[0.62,0.36,0.03,1]", 1, 300, .85}};

void model_forest(const char *folder)
{
    struct glb g = {.size_bytes = 0};
    struct profile profile = {conifer, COUNT(conifer), .16};
    struct glb_grid ground = {.columns = 72, .rows = 72, .place = land};
    struct glb_grid fir = {27, 42, surface_lathe, .context = &profile};
    struct glb_grid leaves = {.columns = 20, .rows = 16, .place = crown};
    struct plane level = {at(-LAND / 2, 0, LAND / 2), at(LAND, 0, 0),
                          at(0, 0, -LAND)};
    struct glb_grid water = {1, 1, surface_plane, .context = &level};
    char *const made[2] = {glb_shape(&g, &fir), glb_shape(&g, &leaves)};

    glb_use(&g, "EXT_mesh_gpu_instancing");
    glb_root(&g, "\"name\":\"land\",\"mesh\":%u",
             glb_mesh(&g, &ground,
                      add_color(&g, "grass", "[0.16,0.17,0.06,1]", 1)));
    glb_root(&g, "\"name\":\"lake\",\"mesh\":%u",
             glb_mesh(&g, &water,
                      add_color(&g, "water", "[0.012,0.03,0.035,1]", 0)));
    for (int i = 0; i < COUNT(kinds); i++)
        add_trees(&g,
                  glb_mesh_of(&g, made[kinds[i].is_leafy],
                              add_color(&g, kinds[i].name, kinds[i].color, 1)),
                  kinds[i].count, kinds[i].size, 111u * (uint32_t)(i + 1));
    for (int i = 0; i < 2; i++)
        free(made[i]);
    glb_camera(&g, at(-2.5, 7.4, 27), at(-1, 1.9, 0), 35);
    glb_write(&g, folder, "forest");
    glb_free(&g);
}

/* --- jellyfish ------------------------------------------------------------ */

enum { JOINTS = 9, KEYS = 9, TENTACLES = 14 };

#define TENTACLE_LENGTH 3.2
#define PERIOD_S        2.0

static const double bell[][2] = {{0, 1.02},  {.5, 1.02},  {.95, .75},
                                 {1.12, .3}, {1.02, .06}, {.93, -.02},
                                 {.96, .12}, {1.0, .32},  {.82, .66},
                                 {.45, .9},  {0, .92}};
/* the same, contracted */
static const double pulse[][2] = {{0, 1.2},    {.42, 1.2}, {.8, .92},
                                  {.9, .4},    {.7, .02},  {.6, -.08},
                                  {.64, .06},  {.76, .38}, {.68, .8},
                                  {.38, 1.06}, {0, 1.08}};

/* The profiles go down, and so around the other way. */
static struct point bell_at(const double (*points)[2], double u, double v)
{
    struct profile p = {points, COUNT(bell), .012};

    return surface_lathe(&p, -u, v);
}

static struct point open_bell(const void *context, double u, double v)
{
    (void)context;
    return bell_at(bell, u, v);
}

static struct point closed_bell(const void *context, double u, double v)
{
    (void)context;
    return bell_at(pulse, u, v);
}

/* A tentacle hangs down from the origin. */
static struct point tentacle(const void *context, double u, double v)
{
    double a = -2 * PI * u;
    double r = (.055 + .02 * cos(50 * v)) * (1 - .8 * v) * sqrt(1 - v * v);

    (void)context;
    return at(r * cos(a), -TENTACLE_LENGTH * v, -r * sin(a));
}

/* Draws light that becomes weaker along v, from one colour to another. */
static uint32_t glow_texture(struct glb *g, const double from[3],
                             const double to[3])
{
    uint8_t rgb[2 * 32 * 3];

    for (int i = 0; i < 64; i++) {
        double v = (i / 2) / 31.0;

        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] =
                (uint8_t)((from[c] + v * (to[c] - from[c])) * 63) * 4;
    }
    return glb_texture(g, rgb, 2, 32, 0);
}

/* Adds the chain of joints of a tentacle, the first of them at the rim of the
 * bell. Returns its number. */
static uint32_t add_joints(struct glb *g, double x, double z)
{
    uint32_t first = g->nodes.count;

    for (int i = 0; i < JOINTS; i++) {
        char child[32] = "";

        if (i + 1 < JOINTS)
            snprintf(child, sizeof child, ",\"children\":[%u]",
                     first + (uint32_t)i + 1);
        if (i == 0)
            glb_add(&g->nodes, "{\"translation\":[%.4f,0.04,%.4f]%s}", x, z,
                    child);
        else
            glb_add(&g->nodes, "{\"translation\":[0,%.5f,0]%s}",
                    -TENTACLE_LENGTH / (JOINTS - 1), child);
    }
    glb_add(&g->roots, "%u", first);
    return first;
}

static uint32_t add_skin(struct glb *g, uint32_t first, uint32_t inverse)
{
    char joints[200] = "";
    size_t used = 0;

    for (uint32_t i = 0; i < JOINTS; i++)
        used += (size_t)snprintf(joints + used, sizeof joints - used, "%s%u",
                                 i > 0 ? "," : "", first + i);
    return glb_add(&g->skins, "{\"joints\":[%s],\"inverseBindMatrices\":%u}",
                   joints, inverse);
}

/* What all jellyfish share. */
struct parts {
    struct glb *g;
    struct glb_list channels, samplers; /* of the animation */
    uint32_t times, inverse;            /* accessors */
    uint32_t bell, tentacle, lobe;      /* meshes */
};

/* Adds a channel to the animation. */
static void add_channel(struct parts *p, uint32_t node, const char *path,
                        uint32_t values)
{
    glb_add(&p->channels,
            "{\"sampler\":%u,\"target\":{\"node\":%u,\"path\":\"%s\"}}",
            glb_add(&p->samplers, "{\"input\":%u,\"output\":%u}", p->times,
                    values),
            node, path);
}

/* Adds the waves of a tentacle to the animation: each joint swings about a
 * level axis, later than the one above. */
static void add_waves(struct parts *p, uint32_t first, double angle,
                      double phase)
{
    for (int joint = 0; joint < JOINTS; joint++) {
        double turns[4 * KEYS] = {0};

        for (int k = 0; k < KEYS; k++) {
            double time = 2 * PI * k / (KEYS - 1) - .85 * joint + phase;
            double swing =
                .15 * sin(time + 1.7 * angle) + (joint == 0 ? .12 : -.015);
            double side = .1 * cos(time + 2.9 * angle);
            double x = cos(angle) * side - sin(angle) * swing;
            double z = sin(angle) * side + cos(angle) * swing;
            double length = sqrt(x * x + z * z + 1);

            turns[4 * k] = x / length;
            turns[4 * k + 2] = z / length;
            turns[4 * k + 3] = 1 / length;
        }
        add_channel(p, first + (uint32_t)joint, "rotation",
                    glb_floats(p->g, turns, KEYS, 4, "VEC4"));
    }
}

static uint32_t tentacle_mesh(struct glb *g)
{
    const double rose[3] = {.95, .2, .45}, violet[3] = {.12, .03, .5};
    struct glb_grid grid = {.columns = 9,
                            .rows = 96,
                            .place = tentacle,
                            .joint_count = JOINTS,
                            .u_repeat = 1,
                            .v_repeat = 1};

    return glb_mesh(
        g, &grid,
        glb_add(&g->materials,
                "{\"name\":\"tentacle\",\"pbrMetallicRoughness\":"
                "{\"baseColorFactor\":[0.5,0.12,0.3,1],\"metallicFactor\":0,"
                "\"roughnessFactor\":0.4},\"emissiveFactor\":[1,1,1],"
                "\"emissiveTexture\":{\"index\":%u},\"extensions\":"
                "{\"KHR_materials_emissive_strength\":"
                "{\"emissiveStrength\":0.45}}}",
                glow_texture(g, rose, violet)));
}

static uint32_t bell_mesh(struct glb *g)
{
    const double violet[3] = {.5, .14, .85}, blue[3] = {.05, .12, .5};
    struct glb_grid grid = {.columns = 64,
                            .rows = 44,
                            .place = open_bell,
                            .target = closed_bell,
                            .u_repeat = 1,
                            .v_repeat = 1};

    return glb_mesh(
        g, &grid,
        glb_add(&g->materials,
                "{\"name\":\"bell\",\"doubleSided\":true,"
                "\"pbrMetallicRoughness\":{\"baseColorFactor\":"
                "[0.75,0.65,1,1],\"metallicFactor\":0,"
                "\"roughnessFactor\":0.12},\"emissiveFactor\":"
                "[0.05,0.05,0.05],\"emissiveTexture\":{\"index\":%u},"
                "\"extensions\":{\"KHR_materials_transmission\":"
                "{\"transmissionFactor\":0.85},\"KHR_materials_iridescence\":"
                "{\"iridescenceFactor\":0.8,"
                "\"iridescenceThicknessMaximum\":420}}}",
                glow_texture(g, violet, blue)));
}

static void make_parts(struct parts *p, struct glb *g)
{
    struct glb_grid ball = {.columns = 24, .rows = 16, .place = surface_ball};
    double times[KEYS], inverse[16 * JOINTS] = {0};

    *p = (struct parts){.g = g};
    for (int i = 0; i < KEYS; i++)
        times[i] = PERIOD_S * i / (KEYS - 1);
    for (int i = 0; i < JOINTS; i++) {
        for (int k = 0; k < 4; k++)
            inverse[16 * i + 5 * k] = 1;
        inverse[16 * i + 13] = TENTACLE_LENGTH * i / (JOINTS - 1);
    }
    p->times = glb_floats(g, times, KEYS, 1, "SCALAR");
    p->inverse = glb_floats(g, inverse, JOINTS, 16, "MAT4");
    p->bell = bell_mesh(g);
    p->tentacle = tentacle_mesh(g);
    p->lobe = glb_mesh(g, &ball, surface_lamp(g, "[1,0.42,0.2]", 2.2));
}

/* Adds the bell with its pulse, and what glows inside: four lobes. */
static void add_bell(struct parts *p, double phase)
{
    uint32_t node = glb_root(p->g, "\"name\":\"bell\",\"mesh\":%u", p->bell);
    double weights[KEYS];

    for (int i = 0; i < KEYS; i++)
        weights[i] = .5 - .5 * cos(2 * PI * i / (KEYS - 1) + phase);
    add_channel(p, node, "weights",
                glb_floats(p->g, weights, KEYS, 1, "SCALAR"));
    for (int i = 0; i < 4; i++) {
        double a = PI / 2 * i + .5;

        glb_root(p->g,
                 "\"name\":\"lobe\",\"mesh\":%u,\"translation\":"
                 "[%.4f,0.66,%.4f],\"scale\":[0.2,0.1,0.2]",
                 p->lobe, .3 * cos(a), .3 * sin(a));
    }
}

static void add_tentacles(struct parts *p, double phase)
{
    for (int i = 0; i < TENTACLES; i++) {
        double angle = 2 * PI * i / TENTACLES;
        double radius = i % 2 ? .82 : .55;
        uint32_t first =
            add_joints(p->g, radius * cos(angle), -radius * sin(angle));

        glb_root(p->g, "\"name\":\"tentacle\",\"mesh\":%u,\"skin\":%u",
                 p->tentacle, add_skin(p->g, first, p->inverse));
        add_waves(p, first, angle, phase);
    }
}

/* Adds a jellyfish under a node that places it, leaning to one side. */
static void add_jellyfish(struct parts *p, struct point place, double size,
                          double lean, double phase)
{
    struct glb_list roots = p->g->roots, children;

    p->g->roots = (struct glb_list){NULL, 0, 0};
    add_bell(p, phase);
    add_tentacles(p, phase);
    children = p->g->roots;
    p->g->roots = roots;
    glb_root(p->g,
             "\"name\":\"jellyfish\",\"translation\":[%g,%g,%g],\"scale\":"
             "[%g,%g,%g],\"rotation\":[0,0,%.4f,%.4f],\"children\":[%s]",
             place.x, place.y, place.z, size, size, size, sin(lean / 2),
             cos(lean / 2), children.text);
    free(children.text);
}

void model_jellyfish(const char *folder)
{
    struct glb g = {.size_bytes = 0};
    struct parts p;

    glb_use(&g, "KHR_materials_transmission");
    glb_use(&g, "KHR_materials_iridescence");
    glb_use(&g, "KHR_materials_emissive_strength");
    make_parts(&p, &g);
    add_jellyfish(&p, at(.35, .35, 0), 1, -.18, 0);
    add_jellyfish(&p, at(-2.9, -.1, -3), .75, .3, 2.2);
    add_jellyfish(&p, at(3.3, 1.0, -5), .7, -.4, 4.1);
    glb_animation(&g, "swim", &p.channels, &p.samplers);
    surface_softbox(&g, at(-1.5, 6, 1), at(0, 0, 0), 5, 4,
                    surface_lamp(&g, "[0.45,0.7,1]", 12));
    surface_softbox(&g, at(7, 0, -3), at(0, -1, 0), 2, 6,
                    surface_lamp(&g, "[0.3,0.5,1]", 8));
    surface_softbox(&g, at(-7, -1, 2), at(0, -1, 0), 1, 6,
                    surface_lamp(&g, "[0.8,0.5,1]", 4));
    glb_camera(&g, at(0, -.6, 9.6), at(0, -.65, 0), 29);
    glb_write(&g, folder, "jellyfish");
    glb_free(&g);
    free(p.channels.text);
    free(p.samplers.text);
}
