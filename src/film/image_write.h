// SPDX-License-Identifier: MIT
/*
 * image_write.h - writes a film to PNG, Radiance HDR, PFM and OpenEXR
 * files
 *
 * Units:     PNG: 8-bit sRGB after exposure; the others: linear means,
 *            without exposure
 * Threads:   any; the film may be in use
 * Errors:    unwritable file, disk full, out of memory; no incomplete file
 *            remains
 */
#ifndef GLIM_IMAGE_WRITE_H
#define GLIM_IMAGE_WRITE_H

#include <stdbool.h>

#include "film/film.h"
#include "image/image_exr.h"
#include "image/image_metadata.h"

enum image_write_format {
    IMAGE_WRITE_PNG,
    IMAGE_WRITE_HDR,
    IMAGE_WRITE_PFM,
    IMAGE_WRITE_EXR,
    IMAGE_WRITE_UNKNOWN
};

/* The endings, for messages. */
#define IMAGE_WRITE_ENDINGS ".png, .hdr, .pfm or .exr"

/* Returns the format by the ending of the name. "-" is PNG. */
enum image_write_format image_write_format_of(const char *path);

/* Fails before rendering if the file could not be written: unknown ending, no
 * such folder, no permission, is a folder. */
bool image_write_check(const char *path, struct error *err);

/* Writes the file atomically (file_write()), so that readers see the old file
 * or the new one. "-" is standard output. The files carry the metadata, which
 * may be NULL, except for PFM, which has no place for it. */
bool image_write(struct film *film, struct develop how,
                 const struct image_metadata *metadata, const char *path,
                 struct error *err);

/* Writes the film with further layers to an EXR file, as atomically. */
bool image_write_layers(struct film *film,
                        const struct image_metadata *metadata,
                        const struct exr_layer *layers, int layer_count,
                        const char *path, struct error *err);

/* Writes the file under the first free name of STEM.ENDING, STEM-2.ENDING,
 * STEM-3.ENDING and so on. Never replaces a file. The ending is one of the
 * formats'. Returns the name for free(), or NULL on failure. */
char *image_write_numbered(struct film *film, struct develop how,
                           const struct image_metadata *metadata,
                           const char *stem, const char *ending,
                           struct error *err);

/* Write a frame as PNG, in the same ways. The metadata may be NULL. */
bool image_write_frame(const struct frame *frame, const char *path,
                       struct error *err);
char *image_write_frame_numbered(const struct frame *frame,
                                 const struct image_metadata *metadata,
                                 const char *stem, struct error *err);

/* Writes 3 floats a pixel, row 0 at the top, as an HDR, PFM or EXR file. */
bool image_write_floats(const float *rgb, int width, int height,
                        const char *path, struct error *err);

#endif
