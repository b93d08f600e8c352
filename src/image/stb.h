// SPDX-License-Identifier: MIT
/*
 * stb.h - stb_image and stb_image_write with limits on memory
 *
 * Reads PNG, JPEG, BMP and TGA; writes PNG and Radiance HDR. Other formats are
 * left out: version 2.27 of Debian 12 reads and writes out of bounds in GIF,
 * PSD, PIC and PNM files, and does not return from a truncated HDR file.
 *
 * Units:     bytes, pixels
 * Ownership: the decoders return memory for free()
 * Threads:   any; the limit is the calling thread's own
 * Errors:    NULL; stb_failure() returns the reason in the calling thread
 */
#ifndef GLIM_STB_H
#define GLIM_STB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

/* Limits the memory of decoders in this thread from now on, since a small file
 * can ask for gigabytes. Also clears the last failure. */
void stb_limit(size_t size_bytes);

/* Returns the reason of the last failure since stb_limit(), or NULL if memory
 * was out. */
const char *stb_failure(void);

/* Picture of three channels: bytes for PNG, or floats for HDR. */
struct stb_picture {
    int width, height;
    const uint8_t *bytes; /* NULL if the picture has floats */
    const float *floats;
};

/* Encodes bytes as PNG and floats as HDR. Returns false if memory is out. */
bool stb_encode(const struct stb_picture *picture, stbi_write_func *write,
                void *context);

/* Returns false for a JPEG file with a Huffman table of more than 256 codes.
 * stb_image up to 2.27 writes behind the end of its table there, so such files
 * must not reach it, not even for their size. */
bool stb_is_safe(const unsigned char *data, size_t size_bytes);

#endif
