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
 * Errors:    NULL; stb_failure() has the calling thread's reason
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

/* Limits the memory that decoders in this thread may have at any time from now
 * on, as a small file can ask for gigabytes. Also forgets the last failure. */
void stb_limit(size_t size_bytes);

/* Why the last decoder since then has failed; NULL: for want of memory. */
const char *stb_failure(void);

/* Three channels a pixel: bytes for PNG, or floats for HDR. */
struct stb_picture {
    int width, height;
    const uint8_t *bytes; /* NULL: floats */
    const float *floats;
};

/* Encodes the picture in the format of its numbers. False when memory is out.
 */
bool stb_encode(const struct stb_picture *picture, stbi_write_func *write,
                void *context);

/* False for a JPEG file with a Huffman table of more than 256 codes, which
 * stb_image 2.27 and before write behind its end: such files must not reach
 * it, not even for their size. */
bool stb_is_safe(const unsigned char *data, size_t size_bytes);

#endif
