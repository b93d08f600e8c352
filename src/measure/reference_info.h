// SPDX-License-Identifier: MIT
/*
 * reference_info.h - the error of a reference picture, from the JSON file
 * beside it: NAME.json for NAME.pfm
 *
 * Units:     as struct picture_error
 * Threads:   any
 */
#ifndef GLIM_REFERENCE_INFO_H
#define GLIM_REFERENCE_INFO_H

#include <stdbool.h>

/* All 0 if there is no file with an error. */
struct reference_info {
    bool is_known;
    double mse, relmse;
    double first_seed, seed_count; /* seeds that glim used; count 0: unknown */
};

/* Reads the members mse, relmse, first_seed and seeds, as `glim reference`
 * writes them. A missing file, or one without an error, is none. */
struct reference_info reference_info_read(const char *picture_path);

#endif
