// SPDX-License-Identifier: MIT
/*
 * sky_pdf.h - the density of light samples towards the sky
 *
 * Units:     per solid angle
 * Threads:   any
 */
#ifndef TESTS_SKY_PDF_H
#define TESTS_SKY_PDF_H

#include "kernels/light.h"

static inline float sky_light_pdf(const struct world *w,
                                  const struct receiver *r, struct vec3 wi)
{
    float pdf;

    sky_light_terms(w, r, NO_INDEX, wi, &pdf);
    return pdf;
}

#endif
