// SPDX-License-Identifier: MIT
/*
 * stb.h - stb_image and stb_image_write as this program uses them
 *
 * Reads PNG, JPEG, BMP and TGA; writes PNG and Radiance HDR. Debian 12 has
 * version 2.27, which in GIF, PSD, PIC and PNM files reads and writes out of
 * bounds, and never comes back from a truncated HDR file.
 *
 * Units:     bytes, pixels
 * Ownership: what the decoders return is for free()
 * Threads:   any; the limit is the calling thread's own
 * Errors:    NULL; stb_failure() has the calling thread's reason
 */
#ifndef GLIM_STB_H
#define GLIM_STB_H

#include <stdbool.h>
#include <stddef.h>

#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

/* The decoders in this thread may have no more memory at any time from now on:
 * a small file can ask for gigabytes. Also forgets the last failure. */
void stb_limit(size_t size_bytes);

/* Why the last decoder since then has failed; NULL: for want of memory. */
const char *stb_failure(void);

/* False for a JPEG file with a Huffman table of more than 256 codes, which
 * stb_image 2.27 and before write behind its end: such files must not reach
 * it, not even for their size. */
bool stb_is_safe(const unsigned char *data, size_t size_bytes);

#endif
