// SPDX-License-Identifier: MIT
/*
 * smoke.h - media whose density is a grid of a file, as a view places them
 *
 * A point of the grid's own space is multiplied by `scale` and moved by `at`.
 * The density there is a factor of the coefficients.
 *
 * Units:     coefficients per unit of length of the scene
 * Ownership: smokes_free() frees; a zeroed list is empty
 * Threads:   one thread at a time
 * Errors:    false when memory is out
 */
#ifndef GLIM_SMOKE_H
#define GLIM_SMOKE_H

#include <stdbool.h>
#include <stdint.h>

struct smoke {
    char *path;
    char *grid; /* its name; "": the default of read/vdb.h */
    double scatter[3], absorb[3];
    double anisotropy; /* mean cosine of scattering; above 0: forward */
    double at[3], scale;
};

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
