// SPDX-License-Identifier: MIT
/*
 * film_header.h - the head of a film file: which picture its samples are of,
 * and how many there are
 *
 * It is text: a line for each key, in a fixed order, and a checksum. Two films
 * whose identities are equal have samples of the same picture, bit for bit.
 *
 * Units:     samples per pixel, pixels, nanoseconds
 * Ownership: film_header_free() frees; a zeroed struct is empty
 * Threads:   one at a time
 * Errors:    one line that names what differs or is wrong
 */
#ifndef GLIM_FILM_HEADER_H
#define GLIM_FILM_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Most samples per pixel of a file. */
#define FILM_SPP_MAX ((uint64_t)1 << 48)

/* Greatest exposure of a picture, in stops, and the least one below 0. */
#define EXPOSURE_MAX 100

/* The hashed parts of what decides the bits of samples. */
enum film_part {
    FILM_KERNELS, /* source text of the kernels */
    FILM_GEOMETRY,
    FILM_MATERIALS,
    FILM_TEXTURES,
    FILM_LIGHT,
    FILM_CAMERA,
    FILM_LIMITS, /* limits of paths, and estimators */
    FILM_GUIDE,  /* path guide, made of the parts above */
    FILM_PARTS
};

struct film_identity {
    uint64_t hashes[FILM_PARTS];
    uint32_t seed;
    int picture_width, picture_height;
    int x, y, width, height; /* the film as a part of the picture */
    int has_surfaces;        /* 0 or 1, */
    int is_adaptive;         /* likewise */
    /* of the float; shares of adaptive sampling depend on it */
    uint32_t exposure_bits;
};

/* Samples with indices from `first` up to, and without, `end`. */
struct film_range {
    uint64_t first, end;
};

struct film_header {
    struct film_identity identity;
    char version[32]; /* of the program */
    char scene[256];  /* end of the scene's path */
    uint32_t tone;    /* enum tone */
    /* sorted and disjoint, with gaps between them. All pixels have these
     * samples; those of the last range may have more, in a film that was saved
     * within a pass. */
    struct film_range *ranges;
    size_t range_count;
    uint64_t total; /* samples of the whole picture, of which the ranges may be
                       a share; 0: unknown */
    uint64_t render_ns;
    uint64_t samples, rays, non_finite, saturated, cut_paths; /* counters */
};

/* Returns the text, for free(), or NULL if memory is out. */
char *film_header_text(const struct film_header *h, size_t *size_bytes);

/* Parses the text at the start of a file of this size. *used is the size of the
 * text. `path` is for messages. The caller frees after a failure, too. */
bool film_header_parse(struct film_header *h, const char *path,
                       const char *bytes, size_t size_bytes, size_t *used,
                       struct error *err);

/* Returns the key of a hashed part in the text. */
const char *film_part_name(enum film_part part);

/* Fails if the samples of the file `path` are not of the same picture as those
 * of `other`, the name of another file or of a scene. */
bool film_identity_check(const struct film_identity *found, const char *path,
                         const struct film_identity *expected,
                         const char *other, struct error *err);

/* Returns the number of samples in all ranges. */
uint64_t film_header_spp(const struct film_header *h);

/* Adds the ranges of another film. Fails if both have a sample. */
bool film_header_join(struct film_header *h, const char *path,
                      const struct film_header *more, const char *more_path,
                      struct error *err);

/* Finds the next range that is missing up to the total, from *at on, and moves
 * *at behind it. Returns false if there is none. */
bool film_header_gap(const struct film_header *h, uint64_t *at,
                     struct film_range *gap);

void film_header_free(struct film_header *h);

#endif
