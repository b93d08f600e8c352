// SPDX-License-Identifier: MIT
/*
 * film_file.h - files of films: the sums of samples, from which a render goes
 * on to the same bits
 *
 * After the head (film_header.h) come bands of rows, each with its size and
 * CRC-32, both 32 bits with the lowest byte first, and packed with zlib. A band
 * has the 64-bit words of its pixels as planes: the lowest bytes of the first
 * word of all pixels, their second bytes, and so on, since high bytes are
 * alike. The shares of adaptive sampling are the last band, if they are
 * decided.
 *
 * Ownership: film_file_free() frees; a zeroed struct is empty
 * Threads:   one at a time; film_file_write() reads a film that others add to
 * Errors:    the path, with what is wrong
 */
#ifndef GLIM_FILM_FILE_H
#define GLIM_FILM_FILE_H

#include "picture/film.h"
#include "picture/film_header.h"

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
