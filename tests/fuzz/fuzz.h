// SPDX-License-Identifier: MIT
/*
 * fuzz.h - files and checks that the fuzz targets share
 *
 * Each fuzz_X.c has one function, LLVMFuzzerTestOneInput(). libFuzzer calls it
 * with inputs that it generates; replay.c calls it with files.
 *
 * Units:     bytes
 * Ownership: paths live as long as the program
 * Threads:   one
 * Errors:    abort(), with a line that names the failure
 */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/warnings.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the program with the place and the text if the condition is false. */
#define require(condition, text)                                       \
    do {                                                               \
        if (!(condition)) {                                            \
            fprintf(stderr, "%s:%d: not %s: %s\n", __FILE__, __LINE__, \
                    #condition, text);                                 \
            abort();                                                   \
        }                                                              \
    } while (0)

/* Returns the folder for files of this process. It is in TMPDIR, which the
 * scripts set and remove. */
static inline const char *fuzz_folder(void)
{
    static char folder[256];
    const char *parent = getenv("TMPDIR");

    if (folder[0] == '\0') {
        snprintf(folder, sizeof folder, "%s/glim-fuzz-XXXXXX",
                 parent ? parent : "/tmp");
        require(mkdtemp(folder), folder);
    }
    return folder;
}

/* Writes a file into the folder, or removes it if bytes is NULL. Returns the
 * path for free(). */
static inline char *fuzz_put(const char *name, const void *bytes, size_t size)
{
    char path[512];
    FILE *f;

    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    if (bytes == NULL) {
        unlink(path);
        return strdup(path);
    }
    f = fopen(path, "wb");
    require(f != NULL, path);
    require(fwrite(bytes, 1, size, f) == size, path);
    require(fclose(f) == 0, path);
    return strdup(path);
}

/* Returns the part up to the next separator and advances *p, or returns NULL
 * after the last part. */
static inline const char *fuzz_part(const char **p, const char *end,
                                    size_t *size)
{
    static const char separator[] = "\n====\n";
    const char *part = *p;
    const char *next;

    if (part == NULL)
        return NULL;
    next = memmem(part, (size_t)(end - part), separator, strlen(separator));
    *size = (size_t)((next != NULL ? next + 1 : end) - part);
    *p = next != NULL ? next + strlen(separator) : NULL;
    return part;
}

/* Writes the files of a scene: the OBJ file, the MTL file, the view file and an
 * image, which are separated by lines "====". Absent ones are not written.
 * Returns the path of the OBJ file for free(). */
static inline char *fuzz_put_scene(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"scene.obj", "scene.mtl", "scene.view",
                                        "Maps/image.png"};
    const char *p = (const char *)data;
    char path[512];

    snprintf(path, sizeof path, "%s/Maps", fuzz_folder());
    mkdir(path, 0700);
    for (int i = 0; i < 4; i++) {
        size_t part_size = 0;
        const char *part = fuzz_part(&p, (const char *)data + size, &part_size);

        free(fuzz_put(names[i], part, part_size));
    }
    snprintf(path, sizeof path, "%s/scene.obj", fuzz_folder());
    return strdup(path);
}

/* Returns the length of the UTF-8 character at p in a text that ends with NUL,
 * or 0 if it is invalid. */
static inline int fuzz_character_bytes(const unsigned char *p)
{
    int count = *p < 0x80                  ? 1
                : *p >= 0xc2 && *p <= 0xdf ? 2
                : *p >= 0xe0 && *p <= 0xef ? 3
                : *p >= 0xf0 && *p <= 0xf4 ? 4
                                           : 0;

    for (int i = 1; i < count; i++)
        if ((p[i] & 0xc0) != 0x80)
            return 0;
    return count;
}

/* A message is one line without control characters: C0, DEL, and C1 as a
 * character or as a single byte. */
static inline void fuzz_check_message(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;

    require(*p != '\0', "an empty message");
    while (*p != '\0') {
        int count = fuzz_character_bytes(p);
        int code = count == 2 ? (*p & 0x1f) << 6 | (p[1] & 0x3f) : *p;

        require(code >= 0x20 && code != 0x7f, text);
        require(count > 2 || code < 0x80 || code > 0x9f, text);
        p += count > 0 ? count : 1;
    }
}

/* Checks each line of a report. */
static inline void fuzz_check_report(const struct warnings *report)
{
    char *text = NULL, *next;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    int count = 0;

    require(to != NULL, "memory");
    warnings_print(report, to);
    require(fclose(to) == 0, "memory");
    next = text;
    for (char *line; (line = strsep(&next, "\n")) != NULL && next; count++)
        fuzz_check_message(line);
    require(count == report->entry_count, text);
    free(text);
}

#endif
