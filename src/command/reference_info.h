// SPDX-License-Identifier: MIT
/*
 * reference_info.h - the error of a reference picture, from the JSON file
 * beside it: NAME.json for NAME.pfm
 *
 * Units:     as struct picture_error
 * Threads:   any
 * Errors:    unwritable file, memory
 */
#ifndef GLIM_REFERENCE_INFO_H
#define GLIM_REFERENCE_INFO_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

/* All 0 if there is no file with an error. */
struct reference_info {
    bool is_known;
    double mse, relmse;
    double relmse_low, relmse_high; /* 95 % interval; 0: unknown */
    double first_seed, seed_count;  /* seeds that glim used; count 0: unknown */
};

/* Description of a reference that glim has rendered. */
struct reference_origin {
    int width, height;
    uint64_t spp; /* of all seeds together */
    double mean;  /* over pixels and channels */
    double seconds;
    const char *scene_path;
    char *const *arguments; /* of the command line, ending with NULL */
};

/* Reads the members mse, relmse, first_seed and seeds, as `glim reference`
 * writes them. A missing file, or one without an error, is none. */
struct reference_info reference_info_read(const char *picture_path);

/* Returns the name of the file beside the picture, for free(); NULL if memory
 * is out. */
char *reference_info_path(const char *picture_path);

/* Writes the file. */
bool reference_info_write(const struct reference_info *info,
                          const struct reference_origin *origin,
                          const char *path, struct error *err);

#endif
