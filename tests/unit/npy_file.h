// SPDX-License-Identifier: MIT
/*
 * npy_file.h - NumPy files in memory, for tests
 *
 * Units:     bytes
 * Ownership: npy_file_of() returns memory for free()
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_NPY_FILE_H
#define TESTS_NPY_FILE_H

#include "tests/unit/check.h"

/* Returns a file of a version of the format, with this dictionary, which is
 * padded as NumPy pads it, and these numbers. */
static inline char *npy_file_with(int version, const char *dictionary,
                                  const void *numbers, size_t numbers_bytes,
                                  size_t *size_bytes)
{
    size_t begin = version == 1 ? 10 : 12;
    size_t whole = (begin + strlen(dictionary) + 1 + 63) / 64 * 64;
    size_t length = whole - begin;
    char *bytes = malloc(whole + numbers_bytes + 1);

    assert_non_null(bytes);
    memset(bytes, ' ', whole);
    memcpy(bytes, "\x93NUMPY", 6);
    bytes[6] = (char)version;
    bytes[7] = 0;
    for (size_t i = 8; i < begin; i++)
        bytes[i] = (char)(length >> 8 * (i - 8));
    memcpy(bytes + begin, dictionary, strlen(dictionary));
    bytes[whole - 1] = '\n';
    if (numbers_bytes > 0)
        memcpy(bytes + whole, numbers, numbers_bytes);
    *size_bytes = whole + numbers_bytes;
    return bytes;
}

/* Returns a file of floats; x is the fastest axis. */
static inline char *npy_file_of(const uint32_t size[3], const float *numbers,
                                size_t *size_bytes)
{
    char dictionary[128];

    snprintf(
        dictionary, sizeof dictionary,
        "{'descr': '<f4', 'fortran_order': False, 'shape': (%u, %u, %u), }",
        size[2], size[1], size[0]);
    return npy_file_with(1, dictionary, numbers,
                         (size_t)size[0] * size[1] * size[2] * sizeof *numbers,
                         size_bytes);
}

#endif
