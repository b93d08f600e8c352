// SPDX-License-Identifier: MIT
/*
 * film_file.h - files of films: the sums of samples, from which a render goes
 * on to the same bits
 *
 * The head is text: a line for each key, in a fixed order, and a checksum. Two
 * films whose identities are equal have samples of the same picture, bit for
 * bit. After the head come bands of rows, each with its size and CRC-32, both
 * 32 bits with the lowest byte first, and packed with zlib. A band has the
 * 64-bit words of its pixels as planes: the lowest bytes of the first word of
 * all pixels, their second bytes, and so on, since high bytes are alike. The
 * shares of adaptive sampling are the last band, if they are decided.
 *
 * Units:     samples per pixel, pixels, nanoseconds
 * Ownership: film_header_free() and film_file_free() free; zeroed structs are
 *            empty
 * Threads:   one at a time; film_file_write() reads a film that others add to
 * Errors:    the path, with what is wrong; one line that names what differs
 */
#ifndef GLIM_FILM_FILE_H
#define GLIM_FILM_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "film/film.h"

/* ---- head ---- */

/*
 * It is text: a line for each key, in a fixed order, and a checksum. Two films
 * whose identities are equal have samples of the same picture, bit for bit.
 */

/* Most samples per pixel of a file. */
#define FILM_SPP_MAX ((uint64_t)1 << 48)

/* Size of the text about the view. */
#define FILM_VIEW_BYTES 2048

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
    /* how the scene was opened: engine_metadata.h; or "" */
    char view[FILM_VIEW_BYTES];
    uint32_t tone; /* enum tone */
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

/* ---- bands ---- */

/*
 * After the head (film_header.h) come bands of rows, each with its size and
 * CRC-32, both 32 bits with the lowest byte first, and packed with zlib. A band
 * has the 64-bit words of its pixels as planes: the lowest bytes of the first
 * word of all pixels, their second bytes, and so on, since high bytes are
 * alike. The shares of adaptive sampling are the last band, if they are
 * decided.
 */

struct film_file {
    struct film_header header;
    struct film film;
    uint16_t *shares;    /* of adaptive sampling; NULL: not decided */
    bool is_within_pass; /* some pixels have more samples than their ranges */
};

/* Returns the bytes of a file, for free(), or NULL. Rows are copied one by one
 * while others may add to them, so the ranges of the header are those before
 * the call. The shares are asked for at the end. */
typedef const uint16_t *film_file_shares(void *context);
char *film_file_bytes(const struct film_header *header, struct film *film,
                      film_file_shares *shares, void *context,
                      size_t *size_bytes, struct error *err);

/* Writes these bytes to a file. */
bool film_file_write(const char *path, const struct film_header *header,
                     struct film *film, film_file_shares *shares, void *context,
                     struct error *err);

/* Reads a file. The caller frees after a failure, too. */
bool film_file_read(struct film_file *f, const char *path, struct error *err);

/* Parses the bytes of a file. `path` is for messages. */
bool film_file_parse(struct film_file *f, const char *path, const char *bytes,
                     size_t size_bytes, struct error *err);

/* Adds the samples of another file of the same picture. Both have equally many
 * samples in each of their pixels. */
bool film_file_join(struct film_file *f, const char *path,
                    const struct film_file *more, const char *more_path,
                    struct error *err);

/* Reads such a file and adds its samples. */
bool film_file_join_read(struct film_file *f, const char *path,
                         const char *more_path, struct error *err);

void film_file_free(struct film_file *f);

#endif
