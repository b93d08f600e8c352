// SPDX-License-Identifier: MIT
#include "picture/blackbody.h"

#include <math.h>

#include "picture/observer.h"

/* Second radiation constant of Planck's law in metre kelvins (CODATA 2018). */
#define PLANCK_C2 0.014387769

/* Returns the spectral radiance by Planck's law, times a factor that is the
 * same for all wavelengths. The factor holds the exponential of the last
 * wavelength, so that nothing overflows. */
static double planck(double nm, double kelvin)
{
    double last =
        (OBSERVER_FIRST_NM + (OBSERVER_COUNT - 1) * OBSERVER_STEP_NM) * 1e-9;
    double wavelength = nm * 1e-9;
    double x = PLANCK_C2 / (wavelength * kelvin);

    return pow(nm / OBSERVER_FIRST_NM, -5) *
           exp(PLANCK_C2 / (last * kelvin) - x) / -expm1(-x);
}

void blackbody_xyz(double kelvin, double xyz[3])
{
    double spectrum[OBSERVER_COUNT];
    double luminance;

    for (int i = 0; i < OBSERVER_COUNT; i++)
        spectrum[i] = planck(OBSERVER_FIRST_NM + i * OBSERVER_STEP_NM, kelvin);
    observer_xyz(spectrum, xyz);
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
