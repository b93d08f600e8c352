// SPDX-License-Identifier: MIT
/*
 * image_metadata.h - texts about a picture that its file carries: PNG chunks,
 * comments of Radiance HDR and attributes of OpenEXR
 *
 * The texts are UTF-8 in every locale, and their order is that of adding, so
 * that equal renders have files of equal bytes.
 *
 * Units:     bytes
 * Threads:   any
 */
#ifndef GLIM_IMAGE_METADATA_H
#define GLIM_IMAGE_METADATA_H

#include <stdbool.h>
#include <stddef.h>

#define IMAGE_METADATA_MAX 24
#define IMAGE_KEY_BYTES    32
#define IMAGE_VALUE_BYTES  2048
#define IMAGE_KEY_SOFTWARE "Software" /* of the PNG standard */

struct image_metadata {
    struct image_text {
        char key[IMAGE_KEY_BYTES];
        char value[IMAGE_VALUE_BYTES];
    } texts[IMAGE_METADATA_MAX];
    int count;
};

/* Adds a text. The key is 1 to 31 ASCII characters. In the value, a question
 * mark replaces control characters, line ends and bytes that are not UTF-8; a
 * longer value is cut after a character. */
void image_metadata_add(struct image_metadata *m, const char *key,
                        const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Room for the texts in a file: 12 bytes of each PNG chunk, 5 of iTXt. */
#define IMAGE_METADATA_BYTES \
    (IMAGE_METADATA_MAX * (12 + 5 + IMAGE_KEY_BYTES + IMAGE_VALUE_BYTES))

/* Write the texts as PNG chunks, tEXt for ASCII and iTXt for others, or as
 * comment lines `# key=value`. Return the size. */
size_t image_metadata_png(const struct image_metadata *m,
                          unsigned char to[IMAGE_METADATA_BYTES]);
size_t image_metadata_hdr(const struct image_metadata *m,
                          unsigned char to[IMAGE_METADATA_BYTES]);

/* Finds the texts in the bytes of a file of one of the three formats, as glim
 * writes them; others are skipped. There are none in a file of another kind. */
void image_metadata_find(struct image_metadata *m, const void *bytes,
                         size_t size_bytes);

/* Returns the value of a key, or NULL. */
const char *image_metadata_value(const struct image_metadata *m,
                                 const char *key);

#endif
