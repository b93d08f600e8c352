// SPDX-License-Identifier: MIT
/*
 * image_hdr.h - pictures of floats: Radiance HDR (Ward, "Real pixels", Graphics
 * Gems II, 1991) and PFM, in colour or grey
 *
 * Units:     pixels, row 0 at the top; linear Rec.709
 * Ownership: the decoders return memory for free()
 * Threads:   any
 * Errors:    a malformed header, malformed or missing pixels
 */
#ifndef GLIM_IMAGE_HDR_H
#define GLIM_IMAGE_HDR_H

#include <stdbool.h>

#include "image/image_read.h"

/* ---- Radiance ---- */

/*
 * Their header consists of lines of text. EXPOSURE and COLORCORR are factors
 * that the pixels were multiplied by, so pixels are divided by them. Pixels are
 * red, green and blue, or CIE XYZ. Rows or columns come in any of eight orders.
 */

bool image_hdr_is(const struct image_file *file);

/* Finds the sides. */
bool image_hdr_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_hdr_decode(const struct image_file *file, struct error *err);

/* ---- PFM ---- */

bool image_pfm_is(const struct image_file *file);

/* Finds the sides and the offset of the pixels. */
bool image_pfm_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_pfm_decode(const struct image_file *file, struct error *err);

#endif
