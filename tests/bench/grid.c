// SPDX-License-Identifier: MIT
/*
 * grid - prints a wavy grid of COLUMNS x ROWS squares of two triangles
 *
 * usage: grid COLUMNS ROWS [obj|ply|stl]
 *
 * obj is the default, in the form of exporters: v, vt, vn, f v/vt/vn. ply and
 * stl are binary, for machines of little-endian order.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct grid {
    long columns, rows;
};

/* Returns the position of a corner; its texture coordinates are u and v. */
static void corner(const struct grid *g, long x, long y, double p[3], double *u,
                   double *v)
{
    *u = (double)x / (double)g->columns;
    *v = (double)y / (double)g->rows;
    p[0] = 2 * *u - 1;
    p[1] = 0.1 * sin(9 * *u) * cos(7 * *v);
    p[2] = 1 - 2 * *v;
}

static void print_obj(const struct grid *g)
{
    for (long y = 0; y <= g->rows; y++)
        for (long x = 0; x <= g->columns; x++) {
            double p[3], u, v;

            corner(g, x, y, p, &u, &v);
            printf("v %.6f %.6f %.6f\nvt %.6f %.6f\nvn %.4f %.4f %.4f\n", p[0],
                   p[1], p[2], u, v, -0.9 * cos(9 * u) * cos(7 * v), 1.0,
                   0.7 * sin(9 * u) * sin(7 * v));
        }
    for (long y = 0; y < g->rows; y++)
        for (long x = 0; x < g->columns; x++) {
            long a = y * (g->columns + 1) + x + 1;
            long b = a + g->columns + 1;

            printf("f %ld/%ld/%ld %ld/%ld/%ld %ld/%ld/%ld\n", a, a, a, a + 1,
                   a + 1, a + 1, b + 1, b + 1, b + 1);
            printf("f %ld/%ld/%ld %ld/%ld/%ld %ld/%ld/%ld\n", a, a, a, b + 1,
                   b + 1, b + 1, b, b, b);
        }
}

static void put(const void *bytes, size_t size_bytes)
{
    fwrite(bytes, 1, size_bytes, stdout);
}

static void put_corner(const struct grid *g, long x, long y)
{
    double p[3], u, v;

    corner(g, x, y, p, &u, &v);
    put(&(float[3]){(float)p[0], (float)p[1], (float)p[2]}, 12);
}

static void print_ply(const struct grid *g)
{
    printf("ply\nformat binary_little_endian 1.0\nelement vertex %ld\n"
           "property float x\nproperty float y\nproperty float z\n"
           "element face %ld\nproperty list uchar int vertex_indices\n"
           "end_header\n",
           (g->columns + 1) * (g->rows + 1), 2 * g->columns * g->rows);
    for (long y = 0; y <= g->rows; y++)
        for (long x = 0; x <= g->columns; x++)
            put_corner(g, x, y);
    for (long y = 0; y < g->rows; y++)
        for (long x = 0; x < g->columns; x++) {
            int32_t a = (int32_t)(y * (g->columns + 1) + x);
            int32_t b = a + (int32_t)g->columns + 1;
            const int32_t faces[2][3] = {{a, a + 1, b + 1}, {a, b + 1, b}};

            for (int i = 0; i < 2; i++) {
                put(&(unsigned char){3}, 1);
                put(faces[i], sizeof faces[i]);
            }
        }
}

static void print_stl(const struct grid *g)
{
    static const char zeros[80] = "";
    uint32_t count = (uint32_t)(2 * g->columns * g->rows);

    put(zeros, 80);
    put(&count, 4);
    for (long y = 0; y < g->rows; y++)
        for (long x = 0; x < g->columns; x++)
            for (int i = 0; i < 2; i++) {
                put(zeros, 12);
                put_corner(g, x, y);
                put_corner(g, x + 1, y + i);
                put_corner(g, x + (i == 0), y + 1);
                put(zeros, 2);
            }
}

int main(int argc, char **argv)
{
    struct grid g = {argc > 1 ? strtol(argv[1], NULL, 10) : 0,
                     argc > 2 ? strtol(argv[2], NULL, 10) : 0};
    const char *format = argc > 3 ? argv[3] : "obj";

    if (g.columns < 1 || g.rows < 1) {
        fprintf(stderr, "usage: grid COLUMNS ROWS [obj|ply|stl]\n");
        return 2;
    }
    if (strcmp(format, "ply") == 0)
        print_ply(&g);
    else if (strcmp(format, "stl") == 0)
        print_stl(&g);
    else
        print_obj(&g);
    return 0;
}
