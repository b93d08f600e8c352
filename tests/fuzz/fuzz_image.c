// SPDX-License-Identifier: MIT
/*
 * Images of every kind as texture and as sky, with the limits of scenes. Images
 * that are accepted have all pixels, and radiance is finite.
 */
#include <math.h>

#include "fuzz.h"
#include "mutate_exr.h"
#include "tests/unit/whole_image.h"

static void check_size(const struct image *image)
{
    require(image->width >= 1 && image->width <= IMAGE_SIDE_MAX &&
                image->height >= 1 && image->height <= IMAGE_SIDE_MAX &&
                (uint64_t)image->width * (uint64_t)image->height <=
                    IMAGE_PIXELS_MAX,
            "within the limits");
}

static size_t pixels_of(const struct image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static void check_8bit(const char *path)
{
    struct image image;
    struct error err = {""};
    volatile uint8_t last;

    if (image_read_8bit(&image, path, &err)) {
        check_size(&image);
        last = image.rgba[4 * pixels_of(&image) - 1];
        (void)last;
    } else {
        fuzz_check_message(err.text);
    }
    image_free(&image);
}

static void check_linear(const char *path)
{
    struct image image;
    struct error err = {""};
    uint64_t clamped_count;

    if (image_read_linear(&image, path, &clamped_count, &err)) {
        check_size(&image);
        for (size_t i = 0; i < 3 * pixels_of(&image); i++)
            require(image.rgb[i] >= 0 && isfinite(image.rgb[i]), "light");
    } else {
        fuzz_check_message(err.text);
    }
    image_free(&image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *path = fuzz_put("image", data, size);

    check_8bit(path);
    check_linear(path);
    free(path);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed);

    mutation_image(&m);
    return m.size;
}
