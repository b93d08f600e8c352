// SPDX-License-Identifier: MIT
/*
 * grid - prints an OBJ of a wavy grid of COLUMNS x ROWS squares of two
 * triangles, in the form of exporters: v, vt, vn, f v/vt/vn
 *
 * usage: grid COLUMNS ROWS
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    long columns = argc > 1 ? strtol(argv[1], NULL, 10) : 0;
    long rows = argc > 2 ? strtol(argv[2], NULL, 10) : 0;

    if (columns < 1 || rows < 1) {
        fprintf(stderr, "usage: grid COLUMNS ROWS\n");
        return 2;
    }
    for (long y = 0; y <= rows; y++)
        for (long x = 0; x <= columns; x++) {
            double u = (double)x / (double)columns;
            double v = (double)y / (double)rows;
            double height = 0.1 * sin(9 * u) * cos(7 * v);

            printf("v %.6f %.6f %.6f\nvt %.6f %.6f\nvn %.4f %.4f %.4f\n",
                   2 * u - 1, height, 1 - 2 * v, u, v,
                   -0.9 * cos(9 * u) * cos(7 * v), 1.0,
                   0.7 * sin(9 * u) * sin(7 * v));
        }
    for (long y = 0; y < rows; y++)
        for (long x = 0; x < columns; x++) {
            long a = y * (columns + 1) + x + 1;
            long b = a + columns + 1;

            printf("f %ld/%ld/%ld %ld/%ld/%ld %ld/%ld/%ld\n", a, a, a, a + 1,
                   a + 1, a + 1, b + 1, b + 1, b + 1);
            printf("f %ld/%ld/%ld %ld/%ld/%ld %ld/%ld/%ld\n", a, a, a, b + 1,
                   b + 1, b + 1, b, b, b);
        }
    return 0;
}
