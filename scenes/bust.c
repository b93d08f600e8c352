// SPDX-License-Identifier: MIT
#include "bust.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh.h"

/* ---- the surface ---- */

/*
 * Ellipsoids, and rods between two places, that melt together over a length. A
 * negative one is cut out. What is beside the middle is there twice. Places are
 * from the middle of the head. The surface has the distance 0, which is about
 * that in space elsewhere.
 */
struct part {
    struct point from, to; /* radii of an ellipsoid */
    double melt;
    double radius[2]; /* of a rod at both ends; 0 for an ellipsoid */
    double tilt;      /* of x against y */
    int is_cut;
};

static const struct part parts[] = {
    /* skull, face, jaw, chin, cheeks */
    {{0, .036, -.018}, {.073, .084, .094}, 0, {0, 0}, 0, 0},
    {{0, -.024, .022}, {.057, .092, .066}, .03, {0, 0}, 0, 0},
    {{.03, -.068, .012}, {.028, .034, .042}, .03, {0, 0}, 0, 0},
    {{0, -.1, .062}, {.018, .015, .017}, .03, {0, 0}, 0, 0},
    {{.034, -.026, .058}, {.021, .022, .022}, .03, {0, 0}, 0, 0},
    /* eyes: the hollow, the ball, a lid */
    {{.03, .006, .094}, {.021, .0125, .016}, .016, {0, 0}, 0, 1},
    {{.0305, .003, .0715}, {.0155, .0115, .0135}, .004, {0, 0}, 0, 0},
    /* brows, nose, its wings and nostrils */
    {{.008, .021, .0865}, {.05, .02, .064}, .012, {.0055, .003}, 0, 0},
    {{0, .018, .0865}, {0, -.034, .1075}, .013, {.0045, .0085}, 0, 0},
    {{.0088, -.037, .0965}, {.0068, .0055, .008}, .006, {0, 0}, 0, 0},
    {{.0058, -.0435, .101}, {.0034, .003, .005}, .003, {0, 0}, 0, 1},
    /* lips and the groove between them */
    {{.007, -.0605, .0865}, {.0125, .0046, .0085}, .005, {0, 0}, -.18, 0},
    {{0, -.0712, .085}, {.0145, .0056, .0095}, .005, {0, 0}, 0, 0},
    {{0, -.0655, .0975}, {.018, -.066, .087}, .004, {.0012, .0008}, 0, 1},
    /* ears */
    {{.0765, -.012, -.006}, {.008, .031, .019}, .01, {0, 0}, .18, 0},
    /* hair: a cap, a wreath and a knot */
    {{0, .047, -.026}, {.079, .083, .095}, .006, {0, 0}, 0, 0},
    {{0, .106, .06}, {.056, .08, .046}, .01, {.011, .012}, 0, 0},
    {{.056, .08, .046}, {.083, .032, .002}, .01, {.012, .013}, 0, 0},
    {{.083, .032, .002}, {.03, -.008, -.1}, .012, {.013, .015}, 0, 0},
    {{0, .035, -.138}, {.034, .034, .034}, .014, {0, 0}, 0, 0},
    /* neck, its muscles, chest, shoulders, foot */
    {{0, -.06, -.02}, {0, -.19, -.025}, .035, {.047, .05}, 0, 0},
    {{.012, -.195, .016}, {.05, -.07, -.03}, .02, {.008, .012}, 0, 0},
    {{0, -.236, -.018}, {.1, .058, .066}, .05, {0, 0}, 0, 0},
    {{.098, -.226, -.03}, {.045, .036, .046}, .04, {0, 0}, 0, 0},
    {{0, -.27, -.02}, {0, -.34, -.02}, .04, {.032, .052}, 0, 0},
};

/* Height of the middle of the head, and what is cut off below. */
#define HEAD .34

static double melted(double a, double b, double length)
{
    double h = length > 0 ? fmax(length - fabs(a - b), 0) / length : 0;

    return fmin(a, b) - h * h * length / 4;
}

static double size_of(struct point p)
{
    return sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

static struct point between(struct point a, struct point b)
{
    return at(b.x - a.x, b.y - a.y, b.z - a.z);
}

static double distance_of(const struct part *part, struct point p)
{
    struct point to = part->to, q = between(part->from, p);

    if (part->radius[0] > 0) {
        struct point way = between(part->from, to);
        double along = (q.x * way.x + q.y * way.y + q.z * way.z) /
                       (way.x * way.x + way.y * way.y + way.z * way.z);

        along = fmin(fmax(along, 0), 1);
        return size_of(at(q.x - along * way.x, q.y - along * way.y,
                          q.z - along * way.z)) -
               part->radius[0] - along * (part->radius[1] - part->radius[0]);
    }
    q = to.y > to.x ? at(q.x - part->tilt * q.y, q.y, q.z)
                    : at(q.x, q.y - part->tilt * q.x, q.z);
    q = at(q.x / to.x, q.y / to.y, q.z / to.z);
    return size_of(q) * (size_of(q) - 1) /
           size_of(at(q.x / to.x, q.y / to.y, q.z / to.z));
}

static double bust_distance(struct point p)
{
    struct point q = at(fabs(p.x), p.y - HEAD, p.z);
    double d = 1;

    for (int i = 0; i < COUNT(parts); i++) {
        double part = distance_of(&parts[i], q);

        d = parts[i].is_cut ? -melted(-d, part, parts[i].melt)
                            : melted(d, part, parts[i].melt);
    }
    return -melted(-d, p.y, .016); /* flat at the foot */
}

static struct point bust_normal(struct point p)
{
    const double e = 1e-4;
    struct point n = at(bust_distance(at(p.x + e, p.y, p.z)) -
                            bust_distance(at(p.x - e, p.y, p.z)),
                        bust_distance(at(p.x, p.y + e, p.z)) -
                            bust_distance(at(p.x, p.y - e, p.z)),
                        bust_distance(at(p.x, p.y, p.z + e)) -
                            bust_distance(at(p.x, p.y, p.z - e)));
    double size = size_of(n);

    return size > 0 ? at(n.x / size, n.y / size, n.z / size) : at(0, 1, 0);
}

/* ---- its triangles ---- */

/* A net over the surface (Gibson 1998, "Constrained elastic surface nets"): one
 * point in each cell of space that the surface crosses, and one quadrangle
 * around each edge. Cells are small where the face is. */
#define CELLS_MAX 96

static const struct axis {
    double lo, fine_lo, fine_hi, hi; /* where cells are fine */
    double coarse, fine;             /* sizes */
} axes[3] = {
    {-.165, -.05, .05, .165, .0096, .0052},
    {-.012, .222, .39, .49, .0096, .0052},
    {-.19, .045, .125, .135, .0096, .0052},
};

struct net {
    double at[3][CELLS_MAX]; /* planes between cells */
    int count[3];
    double *distance;
    int *points; /* number of each cell's point, or -1 */
    struct bust bust;
};

static void *allocated(size_t count, size_t size_bytes)
{
    void *memory = calloc(count, size_bytes);

    if (!memory) {
        fputs("bust: out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

static int place_planes(const struct axis *a, double planes[CELLS_MAX])
{
    double x = a->lo;
    int count = 0;

    while (count < CELLS_MAX && x < a->hi + a->coarse) {
        planes[count++] = x;
        x += x >= a->fine_lo && x < a->fine_hi ? a->fine : a->coarse;
    }
    return count;
}

/* Index of a corner or cell. */
static int in_net(const struct net *n, int x, int y, int z)
{
    return (z * n->count[1] + y) * n->count[0] + x;
}

static struct point corner_of(const struct net *n, const int cell[3], int k)
{
    return at(n->at[0][cell[0] + (k & 1)], n->at[1][cell[1] + (k >> 1 & 1)],
              n->at[2][cell[2] + (k >> 2)]);
}

static double within(double x, double lo, double hi)
{
    double edge = .05 * (hi - lo);

    return fmin(fmax(x, lo + edge), hi - edge);
}

/* Adds the point of a cell: the mean of where its edges cross the surface,
 * moved onto it, but not out of the cell. */
static void add_point(struct net *n, const int cell[3])
{
    struct bust *b = &n->bust;
    struct point lo = corner_of(n, cell, 0), hi = corner_of(n, cell, 7);
    struct point p = at(0, 0, 0), normal;
    int crossings = 0, own = in_net(n, cell[0], cell[1], cell[2]);

    n->points[own] = -1;
    for (int i = 0; i < 24; i++) { /* three edges from each corner */
        int k = i % 8, other = k | 1 << i / 8;
        double d[2], share;
        struct point a = corner_of(n, cell, k), z = corner_of(n, cell, other);

        if (k == other)
            continue;
        for (int e = 0; e < 2; e++) {
            int c = e ? other : k;

            d[e] =
                n->distance[in_net(n, cell[0] + (c & 1), cell[1] + (c >> 1 & 1),
                                   cell[2] + (c >> 2))];
        }
        if ((d[0] < 0) == (d[1] < 0))
            continue;
        share = d[0] / (d[0] - d[1]);
        p = at(p.x + a.x + share * (z.x - a.x), p.y + a.y + share * (z.y - a.y),
               p.z + a.z + share * (z.z - a.z));
        crossings++;
    }
    if (crossings == 0)
        return;
    p = at(p.x / crossings, p.y / crossings, p.z / crossings);
    for (int i = 0; i < 3; i++) {
        double d = bust_distance(p);

        normal = bust_normal(p);
        p = at(within(p.x - d * normal.x, lo.x, hi.x),
               within(p.y - d * normal.y, lo.y, hi.y),
               within(p.z - d * normal.z, lo.z, hi.z));
    }
    normal = bust_normal(p);
    for (int i = 0; i < 3; i++) {
        b->places[3 * b->point_count + i] = i == 0 ? p.x : i == 1 ? p.y : p.z;
        b->normals[3 * b->point_count + i] = i == 0   ? normal.x
                                             : i == 1 ? normal.y
                                                      : normal.z;
    }
    n->points[own] = b->point_count++;
}

static struct point place_at(const struct bust *b, int i)
{
    return at(b->places[3 * i], b->places[3 * i + 1], b->places[3 * i + 2]);
}

/* Adds the quadrangle of points around an edge, cut along its shorter
 * diagonal. */
static void add_quadrangle(struct bust *b, const int q[4])
{
    int first = size_of(between(place_at(b, q[0]), place_at(b, q[2]))) >
                        size_of(between(place_at(b, q[1]), place_at(b, q[3])))
                    ? 1
                    : 0;

    for (int t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++)
            b->corners[b->corner_count++] =
                (uint16_t)q[(first + (k == 0 ? 0 : t + k)) % 4];
}

/* Adds what is around the edges that begin at a corner of the net. */
static void add_faces(struct net *n, const int c[3])
{
    for (int axis = 0; axis < 3; axis++) {
        int u = (axis + 1) % 3, v = (axis + 2) % 3, q[4];
        int end[3] = {c[0], c[1], c[2]};
        double d = n->distance[in_net(n, c[0], c[1], c[2])];

        end[axis]++;
        if (c[u] == 0 || c[v] == 0 || end[axis] >= n->count[axis] ||
            (d < 0) == (n->distance[in_net(n, end[0], end[1], end[2])] < 0))
            continue;
        for (int k = 0; k < 4; k++) {
            int cell[3] = {c[0], c[1], c[2]};

            cell[u] -= k == 0 || k == 3;
            cell[v] -= k == 0 || k == 1;
            q[d < 0 ? k : 3 - k] =
                n->points[in_net(n, cell[0], cell[1], cell[2])];
        }
        add_quadrangle(&n->bust, q);
    }
}

struct bust bust_make(void)
{
    struct net n = {.distance = NULL};
    size_t count = 1;

    for (int i = 0; i < 3; i++) {
        n.count[i] = place_planes(&axes[i], n.at[i]);
        count *= (size_t)n.count[i];
    }
    n.distance = allocated(count, sizeof *n.distance);
    n.points = allocated(count, sizeof *n.points);
    n.bust.places = allocated(count, 3 * sizeof(double));
    n.bust.normals = allocated(count, 3 * sizeof(double));
    n.bust.corners = allocated(count, 18 * sizeof(uint16_t));
    for (size_t i = 0; i < count; i++) {
        int x = (int)i % n.count[0], y = (int)i / n.count[0] % n.count[1];

        n.distance[i] =
            bust_distance(at(n.at[0][x], n.at[1][y],
                             n.at[2][(int)i / n.count[0] / n.count[1]]));
    }
    for (int pass = 0; pass < 2; pass++)
        for (int z = 0; z + 1 < n.count[2]; z++)
            for (int y = 0; y + 1 < n.count[1]; y++)
                for (int x = 0; x + 1 < n.count[0]; x++) {
                    if (pass == 0)
                        add_point(&n, (const int[3]){x, y, z});
                    else
                        add_faces(&n, (const int[3]){x, y, z});
                }
    free(n.distance);
    free(n.points);
    return n.bust;
}

void bust_free(struct bust *b)
{
    free(b->places);
    free(b->normals);
    free(b->corners);
}
