// SPDX-License-Identifier: MIT
/*
 * test_image_exr.c - OpenEXR files, read again by OpenEXR's own library
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "picture/image_exr.h"
#include "tests/unit/files.h"
#include "tests/unit/picture/written_films.h"

static void succeeds(exr_result_t result)
{
    assert_string_equal(exr_get_error_code_as_string(result),
                        exr_get_error_code_as_string(EXR_ERR_SUCCESS));
}

/* Decodes a block of lines and checks each channel against the layers that
 * `expected` names. */
static void has_block(exr_context_t file, int y, int width,
                      const struct exr_layer *expected, int count)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t block;
    float *values[EXR_CHANNELS_MAX];
    int channel = 0;

    succeeds(exr_read_scanline_chunk_info(file, 0, y, &block));
    succeeds(exr_decoding_initialize(file, 0, &block, &pipeline));
    for (int c = 0; c < pipeline.channel_count; c++) {
        values[c] = calloc((size_t)(width * block.height), sizeof(float));
        assert_non_null(values[c]);
        pipeline.channels[c].decode_to_ptr = (uint8_t *)values[c];
        pipeline.channels[c].user_bytes_per_element = 4;
        pipeline.channels[c].user_data_type = EXR_PIXEL_FLOAT;
        pipeline.channels[c].user_pixel_stride = 4;
        pipeline.channels[c].user_line_stride = 4 * width;
    }
    succeeds(exr_decoding_choose_default_routines(file, 0, &pipeline));
    succeeds(exr_decoding_run(file, 0, &pipeline));
    for (int i = 0; i < count; i++) {
        for (int k = 0; expected[i].letters[k] != '\0'; k++) {
            const float *from = expected[i].values + k + 3 * y * width;
            char name[40];
            int c = 0;

            snprintf(name, sizeof name, "%s%c", expected[i].prefix,
                     expected[i].letters[k]);
            while (c < pipeline.channel_count &&
                   strcmp(pipeline.channels[c].channel_name, name) != 0)
                c++;
            assert_true(c < pipeline.channel_count);
            assert_int_equal(pipeline.channels[c].data_type, EXR_PIXEL_FLOAT);
            for (int p = 0; p < width * block.height; p++)
                assert_memory_equal(&values[c][p], &from[3 * p], 4);
            channel++;
        }
    }
    assert_int_equal(pipeline.channel_count, channel);
    for (int c = 0; c < channel; c++)
        free(values[c]);
    succeeds(exr_decoding_destroy(file, &pipeline));
}

static void has_layers(const char *path, int width, int height,
                       const struct exr_layer *expected, int count)
{
    exr_context_t file;
    exr_attr_box2i_t window;
    exr_storage_t storage;
    int lines, parts;

    succeeds(exr_start_read(&file, path, NULL));
    succeeds(exr_get_count(file, &parts));
    assert_int_equal(parts, 1);
    succeeds(exr_get_storage(file, 0, &storage));
    assert_int_equal(storage, EXR_STORAGE_SCANLINE);
    succeeds(exr_get_data_window(file, 0, &window));
    assert_int_equal(window.min.x, 0);
    assert_int_equal(window.min.y, 0);
    assert_int_equal(window.max.x, width - 1);
    assert_int_equal(window.max.y, height - 1);
    succeeds(exr_get_display_window(file, 0, &window));
    assert_int_equal(window.max.x, width - 1);
    succeeds(exr_get_scanlines_per_chunk(file, 0, &lines));
    for (int y = 0; y < height; y += lines)
        has_block(file, y, width, expected, count);
    succeeds(exr_finish(&file));
}

/* Fills 3 floats a pixel: noise, one colour, or numbers at the ends of the
 * range. */
static float *pixels(int width, int height, int kind)
{
    static const float ends[] = {0,       -0.0f,    INFINITY, -INFINITY, 1e-42f,
                                 3.4e38f, -1.5e-7f, NAN,      1};
    size_t count = 3 * (size_t)width * (size_t)height;
    float *values = malloc(count * sizeof *values);
    uint64_t random = (uint64_t)(count + (size_t)kind);

    assert_non_null(values);
    for (size_t i = 0; i < count; i++)
        values[i] = kind == 0   ? (float)check_random(&random)
                    : kind == 1 ? 0.25f
                                : ends[i % 9];
    return values;
}

static void layers_are_read_bit_for_bit(void **state)
{
    static const int sizes[][2] = {{1, 1},   {1, 40}, {40, 1}, {37, 15},
                                   {37, 16}, {5, 17}, {64, 33}};

    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        float *values[3];
        struct error err;
        size_t size;

        for (int k = 0; k < 3; k++)
            values[k] = pixels(width, height, k);
        const struct exr_layer layers[] = {{"", "RGB", values[0]},
                                           {"uv.", "UV", values[1]},
                                           {"N.", "XYZ", values[2]},
                                           {"", "Z", values[0]},
                                           {"albedo.", "RGB", values[1]}};
        uint8_t *bytes =
            image_exr_encode(layers, 5, width, height, NULL, &size);
        assert_non_null(bytes);
        assert_true(file_write("l.exr", bytes, size, false, NULL, &err));
        has_layers("l.exr", width, height, layers, 5);
        free(bytes);
        for (int k = 0; k < 3; k++)
            free(values[k]);
    }
}

static void pictures_are_the_linear_film_with_its_texts(void **state)
{
    static const char *const keys[] = {"Software", "glim:scene"};
    static const char *const texts[] = {"glim", "\xc3\xa4.obj"};
    struct image_metadata metadata = {.count = 0};
    struct error err;
    struct film film;
    exr_context_t file;
    float *rgb = malloc(3 * sizeof *rgb * WIDTH * HEIGHT);

    (void)state;
    assert_non_null(rgb);
    make_film(&film, WIDTH, HEIGHT, light);
    film_linear(&film, rgb);
    for (int i = 0; i < 2; i++)
        image_metadata_add(&metadata, keys[i], "%s", texts[i]);
    assert_true(
        image_write(&film, develop_linear(3), &metadata, "Film.EXR", &err));
    has_layers("Film.EXR", WIDTH, HEIGHT, &(struct exr_layer){"", "RGB", rgb},
               1);
    succeeds(exr_start_read(&file, "Film.EXR", NULL));
    for (int i = 0; i < 2; i++) {
        int32_t length;
        const char *text;

        succeeds(exr_attr_get_string(file, 0, keys[i], &length, &text));
        assert_int_equal(length, strlen(texts[i]));
        assert_memory_equal(text, texts[i], (size_t)length);
    }
    succeeds(exr_finish(&file));
    free(rgb);
    film_free(&film);
}

/* A picture of one colour is much smaller than its floats. */
static void blocks_are_packed(void **state)
{
    float *flat = pixels(200, 100, 1);
    const struct exr_layer layer = {"", "RGB", flat};
    size_t size;
    uint8_t *bytes = image_exr_encode(&layer, 1, 200, 100, NULL, &size);

    (void)state;
    assert_non_null(bytes);
    assert_true(size < 200 * 100 * 12 / 50);
    free(bytes);
    free(flat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_read_bit_for_bit),
        cmocka_unit_test(pictures_are_the_linear_film_with_its_texts),
        cmocka_unit_test(blocks_are_packed),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
