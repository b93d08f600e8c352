// SPDX-License-Identifier: MIT
#include "image/color.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/decimal.h"

/* ---- spectra ---- */

/* Colour-matching functions of the CIE 1931 2 degree standard observer (CIE
 * 018, ISO/CIE 11664-1), every 10 nm from 380 to 780. The numbers are those of
 * the standard, read from colour-science/colour's data (BSD-3-Clause).
 * Chromaticities differ by 1.5e-4 at most from those with steps of 1 nm. */
static const double observer[OBSERVER_COUNT][3] = {
    {0.001368, 3.9e-05, 0.006450001},
    {0.004243, 0.00012, 0.02005001},
    {0.01431, 0.000396, 0.06785001},
    {0.04351, 0.00121, 0.2074},
    {0.13438, 0.004, 0.6456},
    {0.2839, 0.0116, 1.3856},
    {0.34828, 0.023, 1.74706},
    {0.3362, 0.038, 1.77211},
    {0.2908, 0.06, 1.6692},
    {0.19536, 0.09098, 1.28764},
    {0.09564, 0.13902, 0.8129501},
    {0.03201, 0.20802, 0.46518},
    {0.0049, 0.323, 0.272},
    {0.0093, 0.503, 0.1582},
    {0.06327, 0.71, 0.07824999},
    {0.1655, 0.862, 0.04216},
    {0.2904, 0.954, 0.0203},
    {0.4334499, 0.9949501, 0.008749999},
    {0.5945, 0.995, 0.0039},
    {0.7621, 0.952, 0.0021},
    {0.9163, 0.87, 0.001650001},
    {1.0263, 0.757, 0.0011},
    {1.0622, 0.631, 0.0008},
    {1.0026, 0.503, 0.00034},
    {0.8544499, 0.381, 0.00019},
    {0.6424, 0.265, 4.999999e-05},
    {0.4479, 0.175, 2e-05},
    {0.2835, 0.107, 0},
    {0.1649, 0.061, 0},
    {0.0874, 0.032, 0},
    {0.04677, 0.017, 0},
    {0.0227, 0.00821, 0},
    {0.01135916, 0.004102, 0},
    {0.005790346, 0.002091, 0},
    {0.002899327, 0.001047, 0},
    {0.001439971, 0.00052, 0},
    {0.0006900786, 0.0002492, 0},
    {0.0003323011, 0.00012, 0},
    {0.0001661505, 6e-05, 0},
    {8.307527e-05, 3e-05, 0},
    {4.150994e-05, 1.499e-05, 0},
};

void observer_xyz(const double spectrum[OBSERVER_COUNT], double xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int i = 0; i < OBSERVER_COUNT; i++) {
        for (int k = 0; k < 3; k++)
            xyz[k] += spectrum[i] * observer[i][k];
    }
}

void observer_rgb(const double xyz[3], double rgb[3])
{
    /* IEC 61966-2-1: XYZ to linear Rec.709 with white D65 */
    static const double matrix[3][3] = {{3.2406255, -1.5372080, -0.4986286},
                                        {-0.9689307, 1.8757561, 0.0415175},
                                        {0.0557101, -0.2040211, 1.0569959}};

    for (int k = 0; k < 3; k++)
        rgb[k] = matrix[k][0] * xyz[0] + matrix[k][1] * xyz[1] +
                 matrix[k][2] * xyz[2];
}

/* ---- black bodies ---- */

/* Second radiation constant of Planck's law in metre kelvins (CODATA 2018). */
#define PLANCK_C2 0.014387769

/* The last wavelength of the observer in metres. */
#define LAST_WAVELENGTH \
    ((OBSERVER_FIRST_NM + (OBSERVER_COUNT - 1) * OBSERVER_STEP_NM) * 1e-9)

/* Returns the spectral radiance by Planck's law, times a factor that is the
 * same for all wavelengths. The factor holds the exponential of the last
 * wavelength, so that nothing overflows. */
static double planck(double nm, double kelvin)
{
    double wavelength = nm * 1e-9;
    double x = PLANCK_C2 / (wavelength * kelvin);

    return pow(nm / OBSERVER_FIRST_NM, -5) *
           exp(PLANCK_C2 / (LAST_WAVELENGTH * kelvin) - x) / -expm1(-x);
}

/* Sets XYZ of planck(). */
static void planck_xyz(double kelvin, double xyz[3])
{
    double spectrum[OBSERVER_COUNT];

    for (int i = 0; i < OBSERVER_COUNT; i++)
        spectrum[i] = planck(OBSERVER_FIRST_NM + i * OBSERVER_STEP_NM, kelvin);
    observer_xyz(spectrum, xyz);
}

double blackbody_log_luminance(double kelvin)
{
    double xyz[3];

    planck_xyz(kelvin, xyz);
    return log(xyz[1]) - PLANCK_C2 / (LAST_WAVELENGTH * kelvin);
}

void blackbody_xyz(double kelvin, double xyz[3])
{
    double luminance;

    planck_xyz(kelvin, xyz);
    luminance = xyz[1];
    for (int k = 0; k < 3; k++)
        xyz[k] /= luminance;
}

void blackbody_rgb(double kelvin, double rgb[3])
{
    double least = 0;
    double xyz[3];

    blackbody_xyz(kelvin, xyz);
    observer_rgb(xyz, rgb);
    for (int k = 0; k < 3; k++)
        least = fmin(least, rgb[k]);
    /* move towards white, which is 1 1 1 at this luminance, until the least
     * channel is 0 */
    for (int k = 0; k < 3; k++)
        rgb[k] = fmax((rgb[k] - least) / (1 - least), 0);
}

/* ---- colours as text ---- */

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
        *kelvin >= BLACKBODY_MIN && *kelvin <= BLACKBODY_MAX) {
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
