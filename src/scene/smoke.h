// SPDX-License-Identifier: MIT
/*
 * smoke.h - media whose density is a grid of a file, as a view places them
 *
 * A point of the grid's own space is turned from z up to y up if the grid has z
 * up, multiplied by `scale` and moved by `at`; or else the box of the grid's
 * active voxels is fitted into `box`. The density there is a factor of the
 * coefficients. Where it absorbs, it emits what a black body of the temperature
 * there emits, of which the brightest has the luminance `glow`.
 *
 * Units:     coefficients per unit of length of the scene; luminance as
 *            emission of materials has it
 * Ownership: smokes_free() frees; a zeroed list is empty
 * Threads:   one thread at a time
 * Errors:    false when memory is out
 */
#ifndef GLIM_SMOKE_H
#define GLIM_SMOKE_H

#include <stdbool.h>
#include <stdint.h>

struct smoke_numbers {
    double scatter[3], absorb[3];
    double anisotropy; /* mean cosine of scattering; above 0: forward */
    double kelvin;     /* of 1 in the grid of temperatures */
    double glow;
    double at[3], scale;
    double box[6]; /* lowest corner, highest corner; zeros: no box */
};

struct smoke {
    char *path;
    char *grid;        /* its name; "": the default of read/vdb.h */
    char *temperature; /* name of the grid of temperatures; "": none */
    bool up_is_z;
    struct smoke_numbers numbers;
};

extern const struct smoke_numbers smoke_defaults;

bool smoke_has_box(const struct smoke_numbers *s);

struct smokes {
    struct smoke *items;
    uint32_t count;
};

/* Appends a copy. */
bool smokes_add(struct smokes *smokes, const struct smoke *smoke);

/* Replaces the contents of `to`; leaves them unchanged when memory is out. */
bool smokes_copy(struct smokes *to, const struct smokes *from);
bool smokes_equal(const struct smokes *a, const struct smokes *b);
void smokes_free(struct smokes *smokes);

#endif
