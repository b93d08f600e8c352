// SPDX-License-Identifier: MIT
#include "world/light/texture_power.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/color.h"
#include "kernels/texture.h"

/* Largest number of bands of a triangle. */
#define BANDS 64

/* Beyond these coordinates a triangle counts as showing the whole image. */
#define UV_MAX 1e6

/* Reach of a texel into its neighbours by bilinear interpolation. */
#define REACH 0.5

bool texture_power_init(struct texture_power_sums *f, const struct world *w,
                        const struct material *m, struct error *err)
{
    struct texture t = w->textures[m->emission_texture];
    size_t stride = (size_t)t.width + 1;

    f->width = t.width;
    f->height = t.height;
    f->sums = alloc_array(stride * ((size_t)t.height + 1), sizeof *f->sums);
    if (f->sums == NULL)
        return fail(err, "out of memory for the light of a texture of %ux%u",
                    t.width, t.height);
    for (uint32_t y = 0; y < t.height; y++) {
        double *above = f->sums + y * stride;
        double row = 0;

        for (uint32_t x = 0; x < t.width; x++) {
            struct vec3 c = v3_mul(m->emission, texel(w, t, x, y).color);

            row += color_mean(c);
            above[stride + x + 1] = above[x + 1] + row;
        }
    }
    return true;
}

/* The sum over texels 0 to x and 0 to y of the repeating image. */
static double sum_to(const struct texture_power_sums *f, double x, double y)
{
    double columns = floor(x / f->width);
    double rows = floor(y / f->height);
    size_t stride = (size_t)f->width + 1;
    const double *row = f->sums + (size_t)(y - rows * f->height) * stride;
    const double *last = f->sums + f->height * stride;
    size_t column = (size_t)(x - columns * f->width);

    return rows * (columns * last[f->width] + last[column]) +
           columns * row[f->width] + row[column];
}

static double sum_within(const struct texture_power_sums *f, double x0,
                         double x1, double y0, double y1)
{
    return sum_to(f, x1, y1) - sum_to(f, x0, y1) - sum_to(f, x1, y0) +
           sum_to(f, x0, y0);
}

/* Finds the least and the greatest x of the triangle between two rows. Returns
 * false if it has no part there. */
static bool extent(const double p[3][2], double y0, double y1, double *x0,
                   double *x1)
{
    *x0 = INFINITY;
    *x1 = -INFINITY;
    for (int i = 0; i < 3; i++) {
        const double *a = p[i], *b = p[(i + 1) % 3];
        double edges[2] = {y0, y1};

        if (a[1] >= y0 && a[1] <= y1) {
            *x0 = fmin(*x0, a[0]);
            *x1 = fmax(*x1, a[0]);
        }
        for (int k = 0; k < 2; k++) {
            if ((a[1] < edges[k]) == (b[1] < edges[k]))
                continue;
            double x = a[0] + (b[0] - a[0]) * (edges[k] - a[1]) / (b[1] - a[1]);
            *x0 = fmin(*x0, x);
            *x1 = fmax(*x1, x);
        }
    }
    return *x0 <= *x1;
}

double texture_power_whole(const struct texture_power_sums *f)
{
    return f->sums[((size_t)f->width + 1) * (f->height + 1) - 1] /
           ((double)f->width * f->height);
}

double texture_power_mean(const struct texture_power_sums *f,
                          const struct vec2 uv[3])
{
    double whole = texture_power_whole(f);
    double top = INFINITY, bottom = -INFINITY;
    double sum = 0, area = 0;
    double p[3][2];

    for (int i = 0; i < 3; i++) {
        double u = (double)uv[i].x, v = (double)uv[i].y;

        if (!(fabs(u) < UV_MAX && fabs(v) < UV_MAX))
            return whole;
        p[i][0] = u * f->width;
        p[i][1] = (1 - v) * f->height;
        top = fmin(top, p[i][1]);
        bottom = fmax(bottom, p[i][1]);
    }
    top = floor(top - REACH);
    bottom = floor(bottom + REACH) + 1;
    double step = ceil((bottom - top) / BANDS);
    for (int i = 0; i < BANDS; i++) {
        double y = top + i * step;
        double end = fmin(y + step, bottom);
        double x0, x1;

        if (y >= bottom)
            break;
        if (!extent((const double(*)[2])p, y - REACH, end + REACH, &x0, &x1))
            continue;
        x0 = floor(x0 - REACH);
        x1 = floor(x1 + REACH) + 1;
        sum += sum_within(f, x0, x1, y, end);
        area += (x1 - x0) * (end - y);
    }
    return area > 0 ? fmax(sum / area, 0) : whole;
}

void texture_power_free(struct texture_power_sums *f)
{
    free(f->sums);
    *f = (struct texture_power_sums){NULL, 0, 0};
}
