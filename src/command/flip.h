// SPDX-License-Identifier: MIT
/*
 * flip.h - how different two pictures look to a person who flips between them
 *
 * LDR-FLIP of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and
 * Fairchild 2020, "FLIP: a difference evaluator for alternating images", at 67
 * pixels per degree: a screen of .7 m and 3,840 pixels, seen from .7 m. The
 * pictures are taken as shown without a tone curve: light is cut at 0 and 1.
 *
 * Units:     0, the same, to 1, the mean of all pixels
 * Ownership: none; takes 52 bytes a pixel meanwhile
 * Threads:   any
 * Errors:    out of memory
 */
#ifndef GLIM_FLIP_H
#define GLIM_FLIP_H

#include "command/difference.h"

bool flip_mean(const struct picture_pair *pair, double *flip,
               struct error *err);

#endif
