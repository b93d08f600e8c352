// SPDX-License-Identifier: MIT
/*
 * test_image_exr.c - OpenEXR files that OpenEXR's own library reads, and
 * reading those that it writes
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "image/image_exr.h"
#include "tests/unit/files.h"
#include "tests/unit/film/written_films.h"
#include "tests/unit/whole_image.h"

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

static float *read_rgb(const char *path, int width, int height)
{
    struct image image;
    uint64_t clamped_count;
    struct error err;

    check_or_say(image_read_linear(&image, path, &clamped_count, &err),
                 err.text);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    return image.rgb;
}

static void pictures_are_read_again(void **state)
{
    float *values = pixels(37, 35, 0), *found;
    const struct exr_layer layers[] = {{"N.", "XYZ", values},
                                       {"", "RGB", values}};
    struct error err;
    size_t size;
    uint8_t *bytes = image_exr_encode(layers, 2, 37, 35, NULL, &size);

    (void)state;
    assert_true(file_write("r.exr", bytes, size, false, NULL, &err));
    found = read_rgb("r.exr", 37, 35);
    assert_memory_equal(found, values, 3 * 37 * 35 * sizeof *found);
    free(found);
    free(bytes);
    free(values);
}

/* Returns numbers that halves hold. Lines shrink when they are packed: the
 * library of OpenEXR 3.1.5 writes packed lines of their full length, too, which
 * readers take as not packed. */
static float step(int x, int y, int c)
{
    return (float)((x / 8 + y / 8 + c) % 5) / 8;
}

/* A file of OpenEXR's library. */
struct other {
    exr_compression_t packing;
    exr_pixel_type_t type;
    const char *channels; /* in this order */
    int tile;             /* width and height of tiles, or 0: lines */
};

/* Fills a chunk of the file from (x, y) of the picture. */
static void put_chunk(exr_encode_pipeline_t *pipeline, int x, int y,
                      float *values)
{
    int width = pipeline->chunk.width, height = pipeline->chunk.height;

    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *to = &pipeline->channels[c];
        float *plane = values + c * width * height;
        const char *name = to->channel_name;
        int k = *name == 'R' ? 0 : *name == 'B' ? 2 : 1;

        for (int i = 0; i < width * height; i++) {
            plane[i] = step(x + i % width, y + i / width, k);
            if (to->data_type == EXR_PIXEL_UINT)
                plane[i] = bits_float((uint32_t)(8 * plane[i]));
        }
        to->encode_from_ptr = (uint8_t *)plane;
        to->user_bytes_per_element = 4;
        to->user_data_type =
            to->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        to->user_pixel_stride = 4;
        to->user_line_stride = 4 * width;
    }
}

/* Writes a file with OpenEXR's library, with values of step(). */
static void write_other(const char *path, const struct other *o, int height)
{
    exr_attr_box2i_t window = {.min.x = 3,
                               .min.y = -5,
                               .max.x = 3 + WIDTH - 1,
                               .max.y = height - 6};
    exr_attr_v2f_t center = {.x = 0};
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    float *values =
        calloc((size_t)(WIDTH * height) * strlen(o->channels), sizeof *values);
    exr_context_t file;
    int part, width = o->tile, lines = o->tile;

    succeeds(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, NULL));
    succeeds(
        exr_add_part(file, "p",
                     o->tile > 0 ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE,
                     &part));
    succeeds(exr_initialize_required_attr(file, part, &window, &window, 1,
                                          &center, 1,
                                          EXR_LINEORDER_INCREASING_Y,
                                          o->packing));
    for (const char *c = o->channels; *c != '\0'; c++)
        succeeds(exr_add_channel(file, part, (char[2]){*c, 0}, o->type,
                                 EXR_PERCEPTUALLY_LINEAR, 1, 1));
    if (o->tile > 0)
        succeeds(exr_set_tile_descriptor(file, part, (uint32_t)o->tile,
                                         (uint32_t)o->tile, EXR_TILE_ONE_LEVEL,
                                         EXR_TILE_ROUND_DOWN));
    succeeds(exr_write_header(file));
    if (o->tile == 0) {
        succeeds(exr_get_scanlines_per_chunk(file, part, &lines));
        width = WIDTH;
    }
    for (int y = 0; y < height; y += lines)
        for (int x = 0; x < WIDTH; x += width) {
            bool is_first = x == 0 && y == 0;
            exr_chunk_info_t chunk;

            succeeds(
                o->tile > 0
                    ? exr_write_tile_chunk_info(file, part, x / width,
                                                y / lines, 0, 0, &chunk)
                    : exr_write_scanline_chunk_info(file, part, y - 5, &chunk));
            succeeds(
                is_first
                    ? exr_encoding_initialize(file, part, &chunk, &pipeline)
                    : exr_encoding_update(file, part, &chunk, &pipeline));
            put_chunk(&pipeline, x, y, values);
            if (is_first)
                succeeds(exr_encoding_choose_default_routines(file, part,
                                                              &pipeline));
            succeeds(exr_encoding_run(file, part, &pipeline));
        }
    succeeds(exr_encoding_destroy(file, &pipeline));
    succeeds(exr_finish(&file));
    free(values);
}

/* Numbers of 16 bits survive all kinds of packing but those that lose some of
 * the picture on purpose. */
static void check_other(const struct other *o)
{
    bool is_lossy = o->packing >= EXR_COMPRESSION_B44;
    float scale = o->type == EXR_PIXEL_UINT ? 8 : 1, *rgb;

    write_other("o.exr", o, 35);
    rgb = read_rgb("o.exr", WIDTH, 35);
    for (int p = 0; p < 35 * WIDTH; p++)
        for (int c = 0; c < 3; c++) {
            int k = *o->channels == 'Y' ? 1 : c;

            check_close((double)rgb[3 * p + c],
                        (double)(scale * step(p % WIDTH, p / WIDTH, k)),
                        is_lossy ? 0.03 : 0);
        }
    free(rgb);
}

static void other_files_are_read(void **state)
{
    static const exr_pixel_type_t types[] = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT,
                                             EXR_PIXEL_UINT};
    static const char *const channels[] = {"ABGR", "BGRZ", "Y"};

    (void)state;
    for (int packing = 0; packing < EXR_COMPRESSION_DWAA; packing++)
        for (int i = 0; i < 3 * 3 * 2; i++)
            check_other(&(struct other){(exr_compression_t)packing,
                                        types[i % 3], channels[i / 3 % 3],
                                        i / 9 * 16});
}

/* Files that are cut or changed anywhere are read or refused. */
static void broken_files_are_refused(void **state)
{
    float *values = pixels(9, 20, 1);
    const struct exr_layer layer = {"", "RGB", values};
    struct error err;
    struct image image;
    uint64_t clamped_count, random = 5;
    size_t size;
    uint8_t *bytes = image_exr_encode(&layer, 1, 9, 20, NULL, &size);

    (void)state;
    for (size_t cut = 0; cut < size; cut++) {
        assert_true(file_write("b.exr", bytes, cut, false, NULL, &err));
        assert_false(image_read_linear(&image, "b.exr", &clamped_count, &err));
        assert_non_null(strstr(err.text, "b.exr: "));
    }
    for (int i = 0; i < 3000; i++) {
        size_t at = (size_t)(check_random(&random) * (double)size);
        uint8_t before = bytes[at];

        bytes[at] = (uint8_t)(check_random(&random) * 256);
        if (!check_is_due(3)) {
            bytes[at] = before;
            continue;
        }
        assert_true(file_write("b.exr", bytes, size, false, NULL, &err));
        if (image_read_linear(&image, "b.exr", &clamped_count, &err))
            image_free(&image);
        bytes[at] = before;
    }
    free(bytes);
    free(values);
}

static void other_kinds_are_named(void **state)
{
    struct error err;
    struct image image;
    uint64_t clamped_count;

    (void)state;
    write_other("p.exr",
                &(struct other){EXR_COMPRESSION_ZIP, EXR_PIXEL_HALF, "A", 0},
                35);
    assert_false(image_read_linear(&image, "p.exr", &clamped_count, &err));
    assert_string_equal(err.text,
                        "p.exr: found an OpenEXR file that cannot be read (no "
                        "channels R, G and B, or Y)");
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
        cmocka_unit_test(pictures_are_read_again),
        cmocka_unit_test(other_files_are_read),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(other_kinds_are_named),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
