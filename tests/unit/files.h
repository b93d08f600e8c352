// SPDX-License-Identifier: MIT
/*
 * files.h - small files for tests, written and read by the C library alone
 *
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <dirent.h>

#include "tests/unit/check.h"
#include "tests/unit/folder.h"

static inline void put_bytes(const char *path, const void *bytes,
                             size_t size_bytes)
{
    FILE *f = fopen(path, "wb");

    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size_bytes, f), size_bytes);
    assert_int_equal(fclose(f), 0);
}

static inline void put(const char *path, const char *text)
{
    put_bytes(path, text, strlen(text));
}

static inline void has(const char *path, const char *expected)
{
    char text[256] = "";
    FILE *f = fopen(path, "r");

    assert_non_null(f);
    size_t length = fread(text, 1, sizeof text - 1, f);
    text[length] = '\0';
    fclose(f);
    assert_string_equal(text, expected);
}

static inline int count_files(const char *path)
{
    DIR *d = opendir(path);
    int count = -2; /* . and .. */

    assert_non_null(d);
    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

#endif
