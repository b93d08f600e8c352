// SPDX-License-Identifier: MIT
#include "studio/medium_parameters.h"

#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "scene/material.h"
#include "kernels/medium.h"

double medium_density(const struct fog *m)
{
    double most = 0;

    for (int c = 0; c < 3; c++)
        most = fmax(most, m->scatter[c] + m->absorb[c]);
    return most;
}

void medium_set_density(struct fog *m, double density)
{
    double before = medium_density(m);

    for (int c = 0; c < 3; c++) {
        double scatter = before > 0 ? m->scatter[c] / before : 1;
        double absorb = before > 0 ? m->absorb[c] / before : 0;

        m->scatter[c] = decimal_shortened(scatter * density);
        m->absorb[c] = decimal_shortened(absorb * density);
    }
}

bool medium_is_alike(struct fog a, struct fog b)
{
    const double tolerance = 1e-4;
    double most = 0;

    if (!(medium_density(&a) > 0) || !(medium_density(&b) > 0))
        return medium_density(&a) <= 0 && medium_density(&b) <= 0;
    medium_set_density(&a, 1);
    medium_set_density(&b, 1);
    for (int c = 0; c < 3; c++) {
        most = fmax(most, fabs(a.scatter[c] - b.scatter[c]));
        most = fmax(most, fabs(a.absorb[c] - b.absorb[c]));
    }
    return most <= tolerance;
}

static float cosine_of(const struct fog *m)
{
    return medium_anisotropy(m->anisotropy);
}

static void read_color(const struct fog *m, double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double extinction = m->scatter[c] + m->absorb[c];

        rgb[c] = extinction > 0
                     ? (double)seen_color((float)(m->scatter[c] / extinction),
                                          cosine_of(m))
                     : 0;
    }
}

static void change_triple(double triple[3], const double to[3])
{
    for (int c = 0; c < 3; c++)
        triple[c] = decimal_shortened(to[c]);
}

/* Divides the extinction between scattering and absorption. */
static void change_color(struct fog *m, const double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double extinction = m->scatter[c] + m->absorb[c];
        double albedo = (double)medium_albedo_of((float)rgb[c], cosine_of(m));

        m->scatter[c] = decimal_shortened(extinction * albedo);
        m->absorb[c] = decimal_shortened(extinction * (1 - albedo));
    }
}

bool medium_read(const struct fog *m, size_t which, struct value *v)
{
    v->number = 0;
    switch ((enum medium_value)which) {
    case MEDIUM_DENSITY: v->number = medium_density(m); return true;
    case MEDIUM_COLOR: read_color(m, v->rgb); break;
    case MEDIUM_SCATTER: memcpy(v->rgb, m->scatter, sizeof v->rgb); break;
    case MEDIUM_ABSORB: memcpy(v->rgb, m->absorb, sizeof v->rgb); break;
    }
    return medium_density(m) > 0;
}

void medium_change(struct fog *m, size_t which, const struct value *v)
{
    switch ((enum medium_value)which) {
    case MEDIUM_DENSITY: medium_set_density(m, v->number); break;
    case MEDIUM_COLOR: change_color(m, v->rgb); break;
    case MEDIUM_SCATTER: change_triple(m->scatter, v->rgb); break;
    case MEDIUM_ABSORB: change_triple(m->absorb, v->rgb); break;
    }
}
