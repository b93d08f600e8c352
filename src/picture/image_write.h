// SPDX-License-Identifier: MIT
/*
 * image_write.h - writes a film to PNG, Radiance HDR and PFM files
 *
 * Units:     PNG: 8-bit sRGB after exposure; HDR and PFM: linear means,
 *            without exposure
 * Threads:   any; the film may be in use
 * Errors:    unwritable file, disk full, memory; nothing half-written remains
 */
#ifndef GLIM_IMAGE_WRITE_H
#define GLIM_IMAGE_WRITE_H

#include <stdbool.h>

#include "picture/film.h"

enum image_write_format {
    IMAGE_WRITE_PNG,
    IMAGE_WRITE_HDR,
    IMAGE_WRITE_PFM,
    IMAGE_WRITE_UNKNOWN
};

/* Returns the format by the ending of the name. "-" is PNG. */
enum image_write_format image_write_format_of(const char *path);

/* Fails early, before rendering, if the file could not be written: unknown
 * ending, no such folder, no permission, is a folder. */
bool image_write_check(const char *path, struct error *err);

/* Writes to a temporary file beside it, fsync, rename: the old file or the
 * new one, never half of one. "-" is standard output. */
bool image_write(struct film *film, struct develop how, const char *path,
                 struct error *err);

/* Writes STEM.ENDING, or STEM-2.ENDING, STEM-3.ENDING, ... : the first name
 * that is free; never replaces a file. The ending is one of the formats'. The
 * name is for free(). */
char *image_write_numbered(struct film *film, struct develop how,
                           const char *stem, const char *ending,
                           struct error *err);

/* The same for what is no film, as PNG. */
bool image_write_frame(const struct frame *frame, const char *path,
                       struct error *err);
char *image_write_frame_numbered(const struct frame *frame, const char *stem,
                                 struct error *err);

#endif
