// SPDX-License-Identifier: MIT
#include "command/flip.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "kernels/vec.h"

#define PIXELS_PER_DEGREE 67.0206433f

/* Largest distance of pixels that a filter sums. */
#define RADIUS 10

/* Columns that are filtered together. */
#define TOGETHER 64

/* Exponents of differences, and the value of a color difference that is the
 * part LIMIT of the largest one; width of features in degrees. */
#define COLOR_EXPONENT   0.7f
#define FEATURE_EXPONENT 0.5f
#define LIMIT            0.4f
#define LIMIT_VALUE      0.95f
#define FEATURE_WIDTH    0.082f

/* ---- colors ---- */

/* Linear Rec.709 to XYZ in parts of that of white, and back. */
static const struct vec3 to_parts[3] = {
    {0.433895389f, 0.376242373f, 0.189862239f},
    {0.212636822f, 0.715182982f, 0.072180196f},
    {0.017752423f, 0.109465629f, 0.872781948f},
};

static const struct vec3 from_parts[3] = {
    {3.080341988f, -1.537398969f, -0.542943019f},
    {-0.921178396f, 1.875929984f, 0.045248412f},
    {0.052881293f, -0.204011206f, 1.151129913f},
};

static struct vec3 times(const struct vec3 m[3], struct vec3 v)
{
    return v3(v3_dot(m[0], v), v3_dot(m[1], v), v3_dot(m[2], v));
}

static struct vec3 shown(struct vec3 rgb)
{
    return v3_min(v3_max(rgb, v3(0.0f, 0.0f, 0.0f)), v3(1.0f, 1.0f, 1.0f));
}

/* Lightness, red against green, and yellow against blue. */
static struct vec3 opponents(struct vec3 p)
{
    return v3(116.0f * p.y - 16.0f, 500.0f * (p.x - p.y), 200.0f * (p.y - p.z));
}

static struct vec3 opponents_rgb(struct vec3 o)
{
    float y = (o.x + 16.0f) / 116.0f;

    return times(from_parts, v3(y + o.y / 500.0f, y, y - o.z / 200.0f));
}

static float lab_curve(float t)
{
    float d = 6.0f / 29.0f;

    return t > d * d * d ? cbrtf(t) : t / (3.0f * d * d) + 4.0f / 29.0f;
}

/* CIELAB, with less color in the dark (Hunt 1952). */
static struct vec3 to_lab(struct vec3 rgb)
{
    struct vec3 p = times(to_parts, rgb);
    struct vec3 o =
        opponents(v3(lab_curve(p.x), lab_curve(p.y), lab_curve(p.z)));

    return v3(o.x, 0.01f * o.x * o.y, 0.01f * o.x * o.z);
}

static float color_distance(struct vec3 a, struct vec3 b)
{
    return powf(fabsf(a.x - b.x) + hypotf(a.y - b.y, a.z - b.z),
                COLOR_EXPONENT);
}

/* The largest distance: that of green and blue. */
static float color_distance_max(void)
{
    return color_distance(to_lab(v3(0.0f, 1.0f, 0.0f)),
                          to_lab(v3(0.0f, 0.0f, 1.0f)));
}

static float color_difference(struct vec3 a, struct vec3 b, float most)
{
    float limit = LIMIT * most, d = color_distance(a, b);

    if (d < limit)
        return LIMIT_VALUE / limit * d;
    return LIMIT_VALUE + (d - limit) / (most - limit) * (1.0f - LIMIT_VALUE);
}

/* ---- filters ---- */

/* A Gaussian, or a derivative of it: weights above 0 sum to 1, those below to
 * -1. */
struct filter {
    float weights[2 * RADIUS + 1];
};

static struct filter gaussian(float sigma, int radius, int derivative)
{
    struct filter f = {{0.0f}};
    float sums[2] = {0.0f, 0.0f}; /* above and below 0 */

    for (int i = -radius; i <= radius; i++) {
        float x = (float)i / sigma;
        const float factors[] = {1.0f, -x, x * x - 1.0f};
        float weight = factors[derivative] * expf(-0.5f * x * x);

        f.weights[i + RADIUS] = weight;
        sums[weight < 0.0f] += fabsf(weight);
    }
    for (int i = 0; i <= 2 * RADIUS; i++)
        f.weights[i] /= sums[f.weights[i] < 0.0f];
    return f;
}

struct plane {
    int width, height;
    float *values, *between, *result;
};

/* Filters along columns, beyond whose ends the last pixel goes on. Columns of
 * the result are rows of the plane. */
static void filter_columns(const float *from, float *to, int width, int height,
                           const struct filter *f)
{
    for (int y = 0; y < height; y++)
        for (int begin = 0; begin < width; begin += TOGETHER) {
            int count = width - begin < TOGETHER ? width - begin : TOGETHER;
            float sums[TOGETHER] = {0.0f};

            for (int i = -RADIUS; i <= RADIUS; i++) {
                const float *row =
                    from + (ptrdiff_t)index_clamp(y + i, height) * width;

                for (int x = 0; x < count; x++)
                    sums[x] += f->weights[i + RADIUS] * row[begin + x];
            }
            for (int x = 0; x < count; x++)
                to[(ptrdiff_t)(begin + x) * height + y] = sums[x];
        }
}

static void filter_both(const struct plane *p, const struct filter *x,
                        const struct filter *y)
{
    filter_columns(p->values, p->between, p->width, p->height, y);
    filter_columns(p->between, p->result, p->height, p->width, x);
}

/* ---- pictures ---- */

/* A pixel as the eye sees it. */
struct look {
    float color[3];    /* opponents after the filters of the eye */
    float edge, point; /* contrast of features */
};

/* Gaussians of the contrast sensitivity: channel, height and width. Gaussians
 * of a channel stand together, and sum to 1. */
static const struct {
    int channel;
    float a, b;
} eye[] = {{0, 1.0f, 0.0047f},
           {1, 1.0f, 0.0053f},
           {2, 34.1f, 0.04f},
           {2, 13.5f, 0.025f}};

static void set_channel(const struct plane *p, const float *rgb, int channel)
{
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        struct vec3 c = shown(v3(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]));
        struct vec3 o = opponents(times(to_parts, c));
        const float channels[] = {o.x, o.y, o.z};

        p->values[i] = channels[channel];
    }
}

static void see_colors(struct look *looks, const float *rgb,
                       const struct plane *p)
{
    struct filter filters[4];
    float integrals[4], sums[3] = {0.0f, 0.0f, 0.0f};

    for (int k = 0; k < 4; k++) {
        float sigma = PIXELS_PER_DEGREE * sqrtf(eye[k].b / 2.0f) / PI, peak;

        filters[k] = gaussian(sigma, RADIUS, 0);
        peak = filters[k].weights[RADIUS];
        integrals[k] = eye[k].a * sqrtf(PI / eye[k].b) / (peak * peak);
        sums[eye[k].channel] += integrals[k];
    }
    for (int k = 0; k < 4; k++) {
        if (k == 0 || eye[k].channel != eye[k - 1].channel)
            set_channel(p, rgb, eye[k].channel);
        filter_both(p, &filters[k], &filters[k]);
        for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++)
            looks[i].color[eye[k].channel] +=
                integrals[k] / sums[eye[k].channel] * p->result[i];
    }
}

static void see_features(struct look *looks, const float *rgb,
                         const struct plane *p)
{
    float sigma = 0.5f * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    struct filter filters[3];

    for (int k = 0; k < 3; k++)
        filters[k] = gaussian(sigma, (int)ceilf(3.0f * sigma), k);
    set_channel(p, rgb, 0);
    for (int k = 0; k < 4; k++) {
        const struct filter *f = &filters[1 + k / 2];

        filter_both(p, k % 2 ? f : &filters[0], k % 2 ? &filters[0] : f);
        for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
            float *to = k < 2 ? &looks[i].edge : &looks[i].point;

            *to = hypotf(*to, p->result[i] / 116.0f);
        }
    }
}

static struct vec3 seen_lab(const struct look *l)
{
    return to_lab(
        shown(opponents_rgb(v3(l->color[0], l->color[1], l->color[2]))));
}

static double difference(const struct look *a, const struct look *b, float most)
{
    float feature = f_max(fabsf(a->edge - b->edge), fabsf(a->point - b->point));
    float part = powf(feature / sqrtf(2.0f), FEATURE_EXPONENT);

    return (double)powf(color_difference(seen_lab(a), seen_lab(b), most),
                        1.0f - f_min(part, 1.0f));
}

bool flip_mean(const struct picture_pair *pair, double *flip, struct error *err)
{
    size_t count = (size_t)pair->width * (size_t)pair->height;
    struct look *looks = alloc_array(2 * count, sizeof *looks);
    float *values = alloc_array(3 * count, sizeof *values);
    bool ok = looks != NULL && values != NULL;
    float most = color_distance_max();
    double sum = 0;

    for (int k = 0; ok && k < 2; k++) {
        const float *rgb = k == 0 ? pair->rgb : pair->reference;
        struct plane p = {pair->width, pair->height, values, values + count,
                          values + 2 * count};

        see_colors(looks + (size_t)k * count, rgb, &p);
        see_features(looks + (size_t)k * count, rgb, &p);
    }
    for (size_t i = 0; ok && i < count; i++)
        sum += difference(&looks[i], &looks[count + i], most);
    *flip = sum / (double)count;
    free(looks);
    free(values);
    return ok || fail(err, "out of memory to compare %dx%d pixels", pair->width,
                      pair->height);
}
