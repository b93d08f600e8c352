// SPDX-License-Identifier: MIT
#include "picture/color.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/decimal.h"
#include "picture/blackbody.h"

double color_decoded(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92
                              : pow((encoded + 0.055) / 1.055, 2.4);
}

double color_encoded(double linear)
{
    return linear <= 0.0031308 ? linear * 12.92
                               : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static double within_unit(double x)
{
    return x > 0 ? fmin(x, 1) : 0;
}

/* Converts as A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978. */
void color_to_hsv(const double rgb[3], double hsv[3])
{
    double c[3], most, range;
    int largest = 0;

    for (int i = 0; i < 3; i++) {
        c[i] = color_encoded(within_unit(rgb[i]));
        largest = c[i] > c[largest] ? i : largest;
    }
    most = c[largest];
    range = most - fmin(c[0], fmin(c[1], c[2]));
    hsv[0] = 0;
    if (range > 0)
        hsv[0] = 60 * (2 * largest +
                       (c[(largest + 1) % 3] - c[(largest + 2) % 3]) / range);
    if (hsv[0] < 0)
        hsv[0] += 360;
    hsv[1] = most > 0 ? range / most : 0;
    hsv[2] = most;
}

void color_from_hsv(const double hsv[3], double rgb[3])
{
    for (int i = 0; i < 3; i++) {
        /* distance from the hue of this channel, in sixths of the circle */
        double d = fabs(remainder(hsv[0] / 60 - 2 * i, 6));
        double part = within_unit(2 - d);

        rgb[i] = color_decoded(hsv[2] * (1 - hsv[1] * (1 - part)));
    }
}

void color_to_hex(const double rgb[3], char text[COLOR_HEX_BYTES])
{
    unsigned byte[3];

    for (int i = 0; i < 3; i++)
        byte[i] = (unsigned)(color_encoded(within_unit(rgb[i])) * 255 + 0.5);
    snprintf(text, COLOR_HEX_BYTES, "#%02x%02x%02x", byte[0] & 255u,
             byte[1] & 255u, byte[2] & 255u);
}

static int hex_digit(char c)
{
    static const char digits[] = "0123456789abcdef";
    const char *found = c == '\0' ? NULL : strchr(digits, c | 32);

    return found == NULL ? -1 : (int)(found - digits);
}

static bool parse_hex(const char *text, double rgb[3])
{
    size_t length = strlen(text);

    if (length != 3 && length != 6)
        return false;
    for (int i = 0; i < 3; i++) {
        int high = hex_digit(length == 3 ? text[i] : text[2 * i]);
        int low = hex_digit(length == 3 ? text[i] : text[2 * i + 1]);

        if (high < 0 || low < 0)
            return false;
        rgb[i] = color_decoded((16 * high + low) / 255.0);
    }
    return true;
}

bool color_parse(const char *text, double rgb[3], double *kelvin)
{
    const char *end = text + strlen(text);
    const char *p = text;
    double largest;

    *kelvin = 0;
    if (*text == '#')
        return parse_hex(text + 1, rgb);
    if (decimal_parse(&p, end, kelvin) && end - p == 1 && (*p | 32) == 'k' &&
        *kelvin >= BLACKBODY_LEAST && *kelvin <= BLACKBODY_GREATEST) {
        blackbody_rgb(*kelvin, rgb);
        largest = color_largest(rgb);
        for (int i = 0; i < 3; i++)
            rgb[i] /= largest;
        return true;
    }
    *kelvin = 0;
    p = text;
    for (int i = 0; i < 3; i++) {
        p += strspn(p, " ");
        if (!decimal_parse(&p, end, &rgb[i]) || !(rgb[i] >= 0) ||
            !isfinite(rgb[i]))
            return false;
    }
    return *p == '\0';
}
