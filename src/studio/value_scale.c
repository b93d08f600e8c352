// SPDX-License-Identifier: MIT
#include "studio/value_scale.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/decimal.h"

#define GROWTH 1.1

const struct value_scale scale_unit = {.most = 1,
                                       .to = 1,
                                       .step = 0.01,
                                       .digits = 3,
                                       .expected = "a number from 0 to 1"};
const struct value_scale scale_hue = {.most = 360,
                                      .to = 360,
                                      .step = 1,
                                      .digits = 3,
                                      .wraps = true,
                                      .expected = "an angle from 0 to 360"};
const struct value_scale scale_light = {.most = 1e30,
                                        .from = 0.01,
                                        .to = 1e4,
                                        .digits = 4,
                                        .grows = true,
                                        .expected = "a number from 0 to 1e30"};

const struct value_scale scale_ior = {.least = 1e-6,
                                      .most = 1e6,
                                      .from = 1,
                                      .to = 3,
                                      .step = 0.01,
                                      .digits = 4,
                                      .expected = "a number above 0"};
const struct value_scale scale_rotation = {.least = -1e6,
                                           .most = 1e6,
                                           .to = 360,
                                           .step = 1,
                                           .digits = 4,
                                           .wraps = true,
                                           .expected = "an angle in degrees"};
const struct value_scale scale_exposure = {
    .least = -100,
    .most = 100,
    .from = -8,
    .to = 8,
    .step = 0.1,
    .digits = 3,
    .of = " stops",
    .expected = "a number of stops from -100 to 100"};

static double clamped(double x, double least, double most)
{
    return x < least ? least : x > most ? most : x;
}

static double grown(const struct value_scale *s, double value, int steps)
{
    double next = fmax(value, s->from) * pow(GROWTH, steps);
    double digit;

    if (next < s->from || (value < s->from && steps < 0))
        return 0;
    /* three digits are finer than a step */
    digit = pow(10, floor(log10(next)) - 2);
    return fmin(round(next / digit) * digit, fmax(s->to, value));
}

double value_scale_turned(const struct value_scale *s, double value, int steps)
{
    double next;

    if (s->grows)
        return grown(s, value, steps);
    /* on whole steps, and without digits that nobody asked for */
    next = (round(value / s->step) + steps) * s->step;
    next = round(next * 1e6) / 1e6;
    if (s->wraps)
        return fmod(next + s->to, s->to);
    /* what was typed beyond the ends stays there */
    return clamped(next, fmin(s->from, value), fmax(s->to, value));
}

double value_scale_place(const struct value_scale *s, double value)
{
    if (s->grows)
        return value < s->from
                   ? 0
                   : fmin(log(value / s->from) / log(s->to / s->from), 1);
    return clamped((value - s->from) / (s->to - s->from), 0, 1);
}

void value_scale_format(const struct value_scale *s, double value, char *text,
                        size_t size_bytes)
{
    snprintf(text, size_bytes, "%.*g%s", s->digits, value,
             s->of != NULL ? s->of : "");
}

bool value_scale_parse(const struct value_scale *s, const char *text,
                       double *value, struct error *err)
{
    const char *p = text;

    if (decimal_parse(&p, text + strlen(text), value) && *p == '\0' &&
        *value >= s->least && *value <= s->most)
        return true;
    return fail(err, "found '%s', expected %s", text, s->expected);
}
