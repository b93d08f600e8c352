// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SPHERE_POINTS_MAX 1024
#define PROFILE_MAX       64

static struct point add(struct point a, struct point b)
{
    return (struct point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static struct point subtract(struct point a, struct point b)
{
    return (struct point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct point scale(struct point a, double s)
{
    return (struct point){a.x * s, a.y * s, a.z * s};
}

static double length(struct point a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* Turns -0 into 0, so that the text does not depend on the sign of zero. */
static double shown(double x)
{
    return fabs(x) < 5e-6 ? 0.0 : x;
}

static void put_v(struct mesh *m, struct point p)
{
    fprintf(m->file, "v %.5g %.5g %.5g\n", shown(p.x), shown(p.y), shown(p.z));
    m->v++;
}

static void put_vn(struct mesh *m, struct point n)
{
    fprintf(m->file, "vn %.4g %.4g %.4g\n", shown(n.x), shown(n.y), shown(n.z));
    m->vn++;
}

struct mesh mesh_open(const char *folder, const char *name, const char *comment)
{
    struct mesh m = {.name = name};
    char path[4096];

    snprintf(path, sizeof path, "%s/%s.obj", folder, name);
    m.file = fopen(path, "w");
    if (!m.file) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        exit(1);
    }
    fprintf(m.file, "# %s\nmtllib %s.mtl\n", comment, name);
    return m;
}

void mesh_close(struct mesh *m)
{
    bool is_bad = ferror(m->file) != 0;

    if (fclose(m->file) != 0 || is_bad) {
        fprintf(stderr, "%s.obj: could not be written\n", m->name);
        exit(1);
    }
}

void mesh_object(struct mesh *m, const char *object, const char *material)
{
    fprintf(m->file, "o %s\nusemtl %s\n", object, material);
}

void mesh_quad(struct mesh *m, struct point a, struct point b, struct point c,
               struct point d, double u_repeat, double v_repeat)
{
    put_v(m, a);
    put_v(m, b);
    put_v(m, c);
    put_v(m, d);
    fprintf(m->file, "vt 0 0\nvt %.4g 0\nvt %.4g %.4g\nvt 0 %.4g\n", u_repeat,
            u_repeat, v_repeat, v_repeat);
    fprintf(m->file, "f -4/-4 -3/-3 -2/-2 -1/-1\n");
    m->vt += 4;
}

void mesh_box(struct mesh *m, struct point foot, struct point size,
              double turn_deg)
{
    static const int faces[6][4] = {{0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7},
                                    {2, 0, 4, 6}, {4, 5, 7, 6}, {2, 3, 1, 0}};
    double c = cos(turn_deg * M_PI / 180), s = sin(turn_deg * M_PI / 180);
    struct point p[8];

    for (int i = 0; i < 8; i++) { /* bit 0: right, 1: back, 2: top */
        double x = (i & 1 ? .5 : -.5) * size.x;
        double z = (i & 2 ? -.5 : .5) * size.z;

        p[i] = add(foot, (struct point){c * x + s * z, i & 4 ? size.y : 0,
                                        c * z - s * x});
    }
    for (int i = 0; i < 6; i++) {
        const int *f = faces[i];

        mesh_quad(m, p[f[0]], p[f[1]], p[f[2]], p[f[3]],
                  length(subtract(p[f[1]], p[f[0]])),
                  length(subtract(p[f[2]], p[f[1]])));
    }
}

/* Returns the number of a point and adds it if it is new: neighbouring faces of
 * the icosahedron must share the points of their common edge. */
static int find_or_add(struct point *points, int *count, struct point p)
{
    for (int i = 0; i < *count; i++)
        if (length(subtract(points[i], p)) < 1e-6)
            return i;
    assert(*count < SPHERE_POINTS_MAX);
    points[*count] = p;
    return (*count)++;
}

/* Returns the point of the unit sphere i steps from a to b and j steps on
 * towards c. */
static struct point on_sphere(const struct point corner[3], int i, int j,
                              int segments)
{
    struct point p = scale(corner[0], segments - i - j);

    p = add(p, add(scale(corner[1], i), scale(corner[2], j)));
    return scale(p, 1 / length(p));
}

static void sphere_points(const struct point corner[3], int segments,
                          struct point *points, int *point_count,
                          int (*tris)[3], int *tri_count)
{
    for (int i = 0; i < segments; i++) {
        for (int j = 0; i + j < segments; j++) {
            int at[4];

            for (int k = 0; k < 4; k++) {
                int di = i + (k & 1), dj = j + (k >> 1);

                if (di + dj <= segments)
                    at[k] = find_or_add(points, point_count,
                                        on_sphere(corner, di, dj, segments));
            }
            memcpy(tris[(*tri_count)++], (int[3]){at[0], at[1], at[2]},
                   sizeof tris[0]);
            if (i + j + 2 <= segments)
                memcpy(tris[(*tri_count)++], (int[3]){at[1], at[3], at[2]},
                       sizeof tris[0]);
        }
    }
}

void mesh_sphere(struct mesh *m, struct point center, double radius,
                 int segments)
{
    static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},   {0, 1, 7},
                                     {0, 7, 10}, {0, 10, 11}, {1, 5, 9},
                                     {5, 11, 4}, {11, 10, 2}, {10, 7, 6},
                                     {7, 1, 8},  {3, 9, 4},   {3, 4, 2},
                                     {3, 2, 6},  {3, 6, 8},   {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11},  {6, 2, 10},
                                     {8, 6, 7},  {9, 8, 1}};
    const double g = (1 + sqrt(5)) / 2;
    const struct point corners[12] = {{-1, g, 0},  {1, g, 0},   {-1, -g, 0},
                                      {1, -g, 0},  {0, -1, g},  {0, 1, g},
                                      {0, -1, -g}, {0, 1, -g},  {g, 0, -1},
                                      {g, 0, 1},   {-g, 0, -1}, {-g, 0, 1}};
    struct point points[SPHERE_POINTS_MAX];
    int tris[2 * SPHERE_POINTS_MAX][3];
    int point_count = 0, tri_count = 0;
    unsigned v = m->v + 1, vn = m->vn + 1;

    assert(10 * segments * segments + 2 <= SPHERE_POINTS_MAX);
    for (int i = 0; i < 20; i++) {
        const struct point corner[3] = {corners[faces[i][0]],
                                        corners[faces[i][1]],
                                        corners[faces[i][2]]};

        sphere_points(corner, segments, points, &point_count, tris, &tri_count);
    }
    for (int i = 0; i < point_count; i++)
        put_v(m, add(center, scale(points[i], radius)));
    for (int i = 0; i < point_count; i++)
        put_vn(m, points[i]);
    for (int i = 0; i < tri_count; i++) {
        fprintf(m->file, "f");
        for (int k = 0; k < 3; k++)
            fprintf(m->file, " %u//%u", v + (unsigned)tris[i][k],
                    vn + (unsigned)tris[i][k]);
        fprintf(m->file, "\n");
    }
}

/* Computes the normal of a profile's segment, in the plane of radius and
 * height. */
static void segment_normal(const double (*profile)[2], int segment, double n[2])
{
    double dr = profile[segment + 1][0] - profile[segment][0];
    double dy = profile[segment + 1][1] - profile[segment][1];
    double size = sqrt(dr * dr + dy * dy);

    n[0] = dy / size;
    n[1] = -dr / size;
}

/* Computes the normal at one end of a segment: the mean with the neighbour's,
 * unless there is a corner between them. */
static void end_normal(const double (*profile)[2], int count, int segment,
                       int end, double n[2])
{
    int other = end ? segment + 1 : segment - 1;
    bool is_ring = profile[0][0] == profile[count - 1][0] &&
                   profile[0][1] == profile[count - 1][1];
    double own[2], next[2], size;

    segment_normal(profile, segment, n);
    if (is_ring)
        other = (other + count - 1) % (count - 1);
    if (profile[segment + end][0] == 0) { /* a flat tip is smooth */
        if (fabs(n[1]) > .8) {
            n[0] = 0;
            n[1] = n[1] < 0 ? -1 : 1;
        }
        return;
    }
    if (other < 0 || other > count - 2)
        return;
    memcpy(own, n, sizeof own);
    segment_normal(profile, other, next);
    if (own[0] * next[0] + own[1] * next[1] < cos(50 * M_PI / 180))
        return;
    n[0] = own[0] + next[0];
    n[1] = own[1] + next[1];
    size = sqrt(n[0] * n[0] + n[1] * n[1]);
    n[0] /= size;
    n[1] /= size;
}

/* Writes the faces between two rings; a ring on the axis is a single vertex. */
static void put_band(struct mesh *m, const unsigned ring[2], unsigned vn,
                     const bool is_tip[2], int segments)
{
    unsigned n = (unsigned)segments;

    for (unsigned i = 0; i < n; i++) {
        unsigned j = (i + 1) % n;
        unsigned low[2] = {ring[0] + (is_tip[0] ? 0 : i),
                           ring[0] + (is_tip[0] ? 0 : j)};
        unsigned high[2] = {ring[1] + (is_tip[1] ? 0 : i),
                            ring[1] + (is_tip[1] ? 0 : j)};

        fprintf(m->file, "f %u//%u", low[0], vn + i);
        if (!is_tip[1])
            fprintf(m->file, " %u//%u", high[0], vn + n + i);
        fprintf(m->file, " %u//%u", high[1], vn + n + j);
        if (!is_tip[0])
            fprintf(m->file, " %u//%u", low[1], vn + j);
        fprintf(m->file, "\n");
    }
}

void mesh_lathe(struct mesh *m, struct point foot, const double (*profile)[2],
                int count, int segments)
{
    unsigned rings[PROFILE_MAX];
    bool is_tip[PROFILE_MAX];

    assert(count <= PROFILE_MAX);
    for (int k = 0; k < count; k++) {
        is_tip[k] = profile[k][0] == 0;
        rings[k] = m->v + 1;
        for (int i = 0; i < (is_tip[k] ? 1 : segments); i++) {
            double angle = 2 * M_PI * i / segments;

            put_v(m, add(foot, (struct point){profile[k][0] * cos(angle),
                                              profile[k][1],
                                              profile[k][0] * sin(angle)}));
        }
    }
    for (int k = 0; k + 1 < count; k++) {
        unsigned vn = m->vn + 1;

        for (int end = 0; end < 2; end++) {
            double n[2];

            end_normal(profile, count, k, end, n);
            for (int i = 0; i < segments; i++) {
                double angle = 2 * M_PI * i / segments;

                put_vn(m, (struct point){n[0] * cos(angle), n[1],
                                         n[0] * sin(angle)});
            }
        }
        put_band(m, &rings[k], vn, &is_tip[k], segments);
    }
}

void mesh_text(const char *folder, const char *name, const char *ending,
               const char *text)
{
    char path[4096];
    FILE *file;

    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    file = fopen(path, "w");
    if (!file || fputs(text, file) == EOF || fclose(file) != 0) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        exit(1);
    }
}
