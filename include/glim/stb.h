// SPDX-License-Identifier: MIT
/*
 * stb.h - stb_image and stb_image_write as this program uses them
 *
 * Formats: PNG, JPEG, BMP, TGA, PNM and Radiance HDR; from memory, to memory.
 * GIF, PSD and PIC are left out: their decoders are the ones with a record of
 * reading out of bounds.
 *
 * Units:     bytes, pixels
 * Ownership: what the decoders return is for free()
 * Threads:   any; the limit is the calling thread's own
 * Errors:    NULL; stbi_failure_reason() has the calling thread's reason
 */
#ifndef GLIM_STB_H
#define GLIM_STB_H

#include <stddef.h>

#define STBI_NO_STDIO
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

/* No single allocation of a decoder in this thread may be greater from now on:
 * a small file can ask for gigabytes. */
void stb_limit(size_t size_bytes);

#endif
