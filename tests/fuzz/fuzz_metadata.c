// SPDX-License-Identifier: MIT
/* Texts in the files of pictures. Those that are found can be written and found
 * again. */
#include <string.h>

#include "fuzz.h"
#include "image/image_metadata.h"

static const unsigned char png_begin[8] = {0x89, 'P',  'N',  'G',
                                           '\r', '\n', 0x1a, '\n'};

static unsigned char written[sizeof png_begin + IMAGE_METADATA_BYTES];
static struct image_metadata found, again;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t length;

    image_metadata_find(&found, data, size);
    memcpy(written, png_begin, sizeof png_begin);
    length = image_metadata_png(&found, written + sizeof png_begin);
    image_metadata_find(&again, written, sizeof png_begin + length);
    require(again.count == found.count, "count");
    for (int i = 0; i < found.count; i++) {
        require(strcmp(again.texts[i].key, found.texts[i].key) == 0, "keys");
        require(strcmp(again.texts[i].value, found.texts[i].value) == 0,
                "values");
    }
    return 0;
}
