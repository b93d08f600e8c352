// SPDX-License-Identifier: MIT
/*
 * grid - prints a wavy grid of COLUMNS x ROWS squares of two triangles
 *
 * usage: grid COLUMNS ROWS [obj|ply|stl|glb]
 *
 * obj is the default, in the form of exporters: v, vt, vn, f v/vt/vn. The
 * others are binary, for machines of little-endian order; glb has normals.
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

/* Returns the normal of a corner, not of unit length. */
static void corner_normal(double u, double v, double n[3])
{
    n[0] = -0.9 * cos(9 * u) * cos(7 * v);
    n[1] = 1;
    n[2] = 0.7 * sin(9 * u) * sin(7 * v);
}

/* Returns the corners of the two triangles of a square. */
static void square(const struct grid *g, long x, long y, int32_t faces[2][3])
{
    int32_t a = (int32_t)(y * (g->columns + 1) + x);
    int32_t b = a + (int32_t)g->columns + 1;

    memcpy(faces, (const int32_t[2][3]){{a, a + 1, b + 1}, {a, b + 1, b}},
           sizeof(int32_t[2][3]));
}

static void print_obj(const struct grid *g)
{
    for (long y = 0; y <= g->rows; y++)
        for (long x = 0; x <= g->columns; x++) {
            double p[3], n[3], u, v;

            corner(g, x, y, p, &u, &v);
            corner_normal(u, v, n);
            printf("v %.6f %.6f %.6f\nvt %.6f %.6f\nvn %.4f %.4f %.4f\n", p[0],
                   p[1], p[2], u, v, n[0], n[1], n[2]);
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
            int32_t faces[2][3];

            square(g, x, y, faces);
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

static void put_normal(const struct grid *g, long x, long y)
{
    double p[3], n[3], u, v, length;

    corner(g, x, y, p, &u, &v);
    corner_normal(u, v, n);
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    put(&(float[3]){(float)(n[0] / length), (float)(n[1] / length),
                    (float)(n[2] / length)},
        12);
}

/* Prints the document of a grid. Returns its length. */
static int print_json(const struct grid *g, char *to, size_t size_bytes)
{
    long corners = (g->columns + 1) * (g->rows + 1);
    long indices = 6 * g->columns * g->rows;

    return snprintf(
        to, size_bytes,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"NORMAL\":1},\"indices\":2}]}],\"buffers\":[{\"byteLength\":%ld}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%ld},"
        "{\"buffer\":0,\"byteOffset\":%ld,\"byteLength\":%ld},"
        "{\"buffer\":0,\"byteOffset\":%ld,\"byteLength\":%ld}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":%ld,\"type\":\"VEC3\",\"min\":[-1,-0.1,-1],"
        "\"max\":[1,0.1,1]},{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":%ld,\"type\":\"VEC3\"},{\"bufferView\":2,"
        "\"componentType\":5125,\"count\":%ld,\"type\":\"SCALAR\"}]}",
        24 * corners + 4 * indices, 12 * corners, 12 * corners, 12 * corners,
        24 * corners, 4 * indices, corners, corners, indices);
}

static void print_glb(const struct grid *g)
{
    char json[2048];
    uint32_t json_bytes = (uint32_t)print_json(g, json, sizeof json);
    uint32_t padded = (json_bytes + 3) / 4 * 4;
    uint32_t data = (uint32_t)(24 * (g->columns + 1) * (g->rows + 1) +
                               24 * g->columns * g->rows);

    memset(json + json_bytes, ' ', padded - json_bytes);
    put("glTF", 4);
    put((const uint32_t[4]){2, 28 + padded + data, padded, 0x4e4f534a}, 16);
    put(json, padded);
    put((const uint32_t[2]){data, 0x004e4942}, 8);
    for (long y = 0; y <= g->rows; y++)
        for (long x = 0; x <= g->columns; x++)
            put_corner(g, x, y);
    for (long y = 0; y <= g->rows; y++)
        for (long x = 0; x <= g->columns; x++)
            put_normal(g, x, y);
    for (long y = 0; y < g->rows; y++)
        for (long x = 0; x < g->columns; x++) {
            int32_t faces[2][3];

            square(g, x, y, faces);
            put(faces, sizeof faces);
        }
}

int main(int argc, char **argv)
{
    struct grid g = {argc > 1 ? strtol(argv[1], NULL, 10) : 0,
                     argc > 2 ? strtol(argv[2], NULL, 10) : 0};
    const char *format = argc > 3 ? argv[3] : "obj";

    if (g.columns < 1 || g.rows < 1) {
        fprintf(stderr, "usage: grid COLUMNS ROWS [obj|ply|stl|glb]\n");
        return 2;
    }
    if (strcmp(format, "ply") == 0)
        print_ply(&g);
    else if (strcmp(format, "stl") == 0)
        print_stl(&g);
    else if (strcmp(format, "glb") == 0)
        print_glb(&g);
    else
        print_obj(&g);
    return 0;
}
