// SPDX-License-Identifier: MIT
#include "picture/blackbody.h"

#include <math.h>

/* Second radiation constant of Planck's law in metre kelvins (CODATA 2018). */
#define PLANCK_C2 0.014387769

#define FIRST_NM 380
#define STEP_NM  10

/* Colour-matching functions of the CIE 1931 2 degree standard observer (CIE
 * 018, ISO/CIE 11664-1), every 10 nm from 380 to 780. The numbers are those of
 * the standard, read from colour-science/colour's data (BSD-3-Clause).
 * Chromaticities differ by 1.5e-4 at most from those with steps of 1 nm. */
static const double observer[][3] = {
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

#define ROW_COUNT ((int)(sizeof observer / sizeof *observer))

/* Returns the spectral radiance by Planck's law, times a factor that is the
 * same for all wavelengths. The factor holds the exponential of the last
 * wavelength, so that nothing overflows. */
static double planck(double nm, double kelvin)
{
    double last = (FIRST_NM + (ROW_COUNT - 1) * STEP_NM) * 1e-9;
    double wavelength = nm * 1e-9;
    double x = PLANCK_C2 / (wavelength * kelvin);

    return pow(nm / FIRST_NM, -5) * exp(PLANCK_C2 / (last * kelvin) - x) /
           -expm1(-x);
}

void blackbody_xyz(double kelvin, double xyz[3])
{
    double sums[3] = {0, 0, 0};

    for (int i = 0; i < ROW_COUNT; i++) {
        double radiance = planck(FIRST_NM + i * STEP_NM, kelvin);

        for (int k = 0; k < 3; k++)
            sums[k] += radiance * observer[i][k];
    }
    for (int k = 0; k < 3; k++)
        xyz[k] = sums[k] / sums[1];
}

void blackbody_rgb(double kelvin, double rgb[3])
{
    /* IEC 61966-2-1: XYZ to linear Rec.709 with white D65 */
    static const double matrix[3][3] = {{3.2406255, -1.5372080, -0.4986286},
                                        {-0.9689307, 1.8757561, 0.0415175},
                                        {0.0557101, -0.2040211, 1.0569959}};
    double least = 0;
    double xyz[3];

    blackbody_xyz(kelvin, xyz);
    for (int k = 0; k < 3; k++) {
        rgb[k] = matrix[k][0] * xyz[0] + matrix[k][1] * xyz[1] +
                 matrix[k][2] * xyz[2];
        least = fmin(least, rgb[k]);
    }
    /* move towards white, which is 1 1 1 at this luminance, until the least
     * channel is 0 */
    for (int k = 0; k < 3; k++)
        rgb[k] = fmax((rgb[k] - least) / (1 - least), 0);
}
