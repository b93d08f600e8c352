// SPDX-License-Identifier: MIT
/*
 * filter.h - arithmetic of the denoising filter
 *
 * The filter is an edge-avoiding a-trous wavelet transform (Dammertz et al.
 * 2010) of two half pictures a and b with independent samples. Each half is
 * filtered with weights from the other half (cross filtering, Rousselle et al.
 * 2012, "Adaptive rendering with non-local means filtering"), so that noise
 * does not choose its own weights. Light is divided by the albedo before and
 * multiplied by it afterwards. A pixel p averages the pixels q at distances of
 * 1, 2, 4, ... pixels in FILTER_LEVELS turns.
 *
 * A level computes, for each pixel p and each of eight pixels q,
 *     filter_pixel_distance() of their light, summed over the 3x3 pixels around
 *         p, and filter_light_distance() of the sum;
 *     filter_feature_distance() of squared differences of features;
 *     filter_weight() of both.
 * All are the same for q and p. Pixels outside of the picture have weight 0.
 * Variances and squared differences are sums over three channels.
 *
 * Light that changes evenly over a surface differs by more than its noise,
 * although the mean of the pixels q and r on opposite sides of p is that of p.
 * So both get a weight in common as well, from second differences,
 * u(q) + u(r) - 2 u(p), of light and of features: filter_opposite_distance(),
 * summed in the same way, and filter_opposite_features().
 * Where p lies at an edge between two surfaces, the mean of q and r is that of
 * their light times albedo, so filter_opposite_share() divides the weight by
 * albedo. Else noise of a black surface would be dots at the edge of a white
 * one. filter_joined_weight() is the weight of q from both. First-order
 * regression (Bitterli et al. 2016, "Nonlinearly weighted first-order
 * regression for denoising Monte Carlo renderings") has the same aim.
 *
 * Before all that, the features themselves are averaged in
 * FILTER_FEATURE_LEVELS levels with filter_weight() of
 * filter_pixel_distance() of their own noise. Where samples meet one surface or
 * another by chance, at partial coverage or glass, features have noise that the
 * product of light and albedo would have as well. Features without noise have a
 * distance without limit unless they are equal, so edges stay as they are.
 *
 * Before the levels, light of a half that is lone, more than all of both halves
 * of the 5x5 pixels around it, is limited by filter_lone_factor(). That is what
 * one sample in many hundreds leaves, of a glint of the sun in glass for
 * example; averages would spread it over the picture. Where light is really
 * there, the pixel's other half has it as well.
 *
 * Units: light scaled by a power of two so that its greatest number is about
 *        2^FILTER_TOP; features divided by the differences that are edges
 */
#ifndef KERNELS_FILTER_H
#define KERNELS_FILTER_H

#include "kernels/vec.h"

#define FILTER_LEVELS 6

/* Levels of the features. */
#define FILTER_FEATURE_LEVELS 3

/* Exponent of the greatest light: its squares, and sums of 25 of them, are
 * finite, and differences down to 2^-100 of it have squares above 0. */
#define FILTER_TOP 55

/* Least variance, and sum of albedos. It only prevents a division of 0 by 0. */
#define FILTER_VARIANCE_MIN 0x1p-120f

/* Squared number of standard deviations that count as noise. */
#define FILTER_NOISE (1.6f * 1.6f)

/* The same for second differences: glass needs less than 1.5, and even light
 * more than 1. */
#define FILTER_OPPOSITE_NOISE 1.25f

/* Factor of second differences of features: with 1 they stop too late where
 * surfaces bend, with 16 too early. */
#define FILTER_BEND_SCALE 4.0f

/* Weight of the pixel itself. Its eight neighbours have 1/8 and 1/16. */
#define FILTER_CENTRE 0.25f

/* Added to the albedo by which light is divided. */
#define FILTER_ALBEDO_MIN 1e-3f

/* Inverse differences of features that are edges: of albedos, of normals, and
 * of depths as fractions of the picture's mean depth. */
#define FILTER_ALBEDO_SCALE 7.0710678f /* 1 / (sqrt(2) * .1) */
#define FILTER_NORMAL_SCALE 1.7677670f /* 1 / (sqrt(2) * .4) */
#define FILTER_DEPTH_SCALE  5.0f       /* 1 / .2 */

/* Samples of a half in which one may have more light than all around. */
#define FILTER_LONE_SAMPLES 8.0f

/* Returns the factor of the light of a half with this number of samples.
 * `others` is the sum of the pixel's other half and of both halves of the 24
 * pixels around. */
static inline float filter_lone_factor(float light, float others, float samples)
{
    float most =
        others * f_max(FILTER_LONE_SAMPLES / f_max(samples, 1.0f), 1.0f);

    return light > most ? most / light : 1.0f;
}

/* Returns the variance of both halves of a pixel from the sum of samples *
 * (a - b)^2 over 5x5 pixels and the channels. `samples` of a pixel are relative
 * to the mean of all pixels: the variance of each sample is about the same in
 * the 5x5 pixels, that of the means is not. */
static inline float filter_variance(float sum, float samples)
{
    return sum * (1.0f / 50.0f) / samples;
}

/* Returns the squared difference of light at p and q without the part that
 * noise explains, in units of their variances vp and vq. If one of them is
 * larger, the light is not trusted to be the same. */
static inline float filter_pixel_distance(float square, float vp, float vq)
{
    return (square - 2.0f * f_min(vp, vq)) /
           (FILTER_VARIANCE_MIN + FILTER_NOISE * (vp + vq));
}

/* Returns the distance from the sum of pixel distances over 3x3 pixels. */
static inline float filter_light_distance(float sum)
{
    return f_max(sum * (1.0f / 9.0f), 0.0f);
}

/* Returns the distance of features whose squared difference is `square`. np and
 * nq are the variances of the means of p and q. */
static inline float filter_feature_distance(float square, float np, float nq)
{
    return f_max((square - 2.0f * f_min(np, nq)) / (1.0f + (np + nq)), 0.0f);
}

/* Returns the distance of light at p to the mean of opposite pixels, from the
 * square of its second difference, u(q) + u(q') - 2 u(p). If all three have the
 * same variance, noise explains six times of it. */
static inline float filter_opposite_distance(float square, float vp, float vq,
                                             float vr)
{
    return (square - 6.0f * f_min(f_min(vq, vr), vp)) /
           (FILTER_VARIANCE_MIN +
            FILTER_OPPOSITE_NOISE * (vq + vr + 4.0f * vp));
}

/* Returns the distance of features in the same way. */
static inline float filter_opposite_features(float square, float np, float nq,
                                             float nr)
{
    return FILTER_BEND_SCALE *
           f_max((square - 6.0f * f_min(f_min(nq, nr), np)) /
                     (1.0f + (nq + nr + 4.0f * np)),
                 0.0f);
}

/* Returns the weight of q: tap * exp(-distance), nearly, and 0 from a distance
 * of 16 on. */
static inline float filter_weight(float tap, float light, float features)
{
    float w = f_max(1.0f - (light + features) * (1.0f / 16.0f), 0.0f);

    w *= w;
    w *= w;
    w *= w;
    return tap * (w * w);
}

/* Returns the share of q in the weight that it has with the opposite pixel r,
 * from their albedos. Outside of the picture these are 0. */
static inline float filter_opposite_share(float q, float r)
{
    return q / (FILTER_VARIANCE_MIN + (q + r));
}

/* Returns the weight of q from the one in common with the opposite pixel, of
 * both of which it has this share, and its own, which counts where the other is
 * small: q and r have nearly the same weight where light is even. */
static inline float filter_joined_weight(float opposite, float share, float own,
                                         float inverse_tap)
{
    return 2.0f * opposite * share + (1.0f - opposite * inverse_tap) * own;
}

#endif
