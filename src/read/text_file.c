// SPDX-License-Identifier: MIT
#include "read/text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ZLIB_CONST
#include <zlib.h>

#include "base/machine.h"
#include "base/memory.h"

/* Value of windowBits for files of gzip: the largest window, and 16. */
#define GZIP_WINDOW (15 + 16)

/* Usual ratio of text to packed text. */
#define RATIO 4

static bool is_packed(const char *text, size_t size_bytes)
{
    return size_bytes >= 2 && memcmp(text, "\x1f\x8b", 2) == 0;
}

static bool fail_packed(const char *path, const char *reason, struct error *err)
{
    return fail(err, "%s: found a broken file of gzip (%s)", path, reason);
}

/* An unpacked text that grows, and the limit of its size. */
struct unpacked {
    char *bytes;
    size_t size, capacity, most;
};

static bool grow(const char *path, struct unpacked *u, struct error *err)
{
    void *bytes = u->bytes;

    if (u->size > u->most)
        return fail(err,
                    "%s: found more than %.1f GiB when unpacked, expected less",
                    path, (double)u->most / (1 << 30));
    if (!grow_array(&bytes, &u->capacity, u->size + 2, 1))
        return fail(err, "%s: out of memory for its %.1f MiB", path,
                    (double)u->size / (1 << 20));
    u->bytes = bytes;
    return true;
}

/* Lends zlib the part of the bytes that its counters can hold. */
static unsigned part_of(size_t size_bytes)
{
    return size_bytes > UINT_MAX ? UINT_MAX : (unsigned)size_bytes;
}

/* Unpacks all members of the file, which follow each other. What follows the
 * last one is ignored, as gzip does. */
static bool unpack_all(z_stream *z, const char *path, const char *packed,
                       size_t packed_bytes, struct unpacked *u,
                       struct error *err)
{
    size_t at = 0;
    int result = Z_STREAM_END;

    while (result != Z_STREAM_END ||
           is_packed(packed + at, packed_bytes - at)) {
        unsigned given, room;

        if (!grow(path, u, err))
            return false;
        if (result == Z_STREAM_END && inflateReset(z) != Z_OK)
            return fail_packed(path, "its state", err);
        given = part_of(packed_bytes - at);
        room = part_of(u->capacity - 1 - u->size);
        z->next_in = (const Bytef *)(packed + at);
        z->avail_in = given;
        z->next_out = (Bytef *)(u->bytes + u->size);
        z->avail_out = room;
        result = inflate(z, Z_NO_FLUSH);
        at += given - z->avail_in;
        u->size += room - z->avail_out;
        if (result == Z_BUF_ERROR && at == packed_bytes)
            return fail_packed(path, "its end is missing", err);
        if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
            return fail_packed(path, z->msg != NULL ? z->msg : "its header",
                               err);
    }
    return true;
}

bool text_file_unpack(const char *path, const char *packed, size_t packed_bytes,
                      char **text, size_t *size_bytes, struct error *err)
{
    uint64_t memory = cgroup_quota_memory("").size_bytes;
    struct unpacked u = {.most = (size_t)FILE_BYTES_MAX};
    z_stream z = {.next_in = NULL};
    void *bytes = NULL;
    bool ok;

    if (memory < u.most)
        u.most = (size_t)memory;
    if (inflateInit2(&z, GZIP_WINDOW) != Z_OK ||
        !grow_array(&bytes, &u.capacity, RATIO * packed_bytes + 2, 1)) {
        inflateEnd(&z);
        return fail(err, "%s: out of memory to unpack it", path);
    }
    u.bytes = bytes;
    ok = unpack_all(&z, path, packed, packed_bytes, &u, err);
    inflateEnd(&z);
    if (!ok) {
        free(u.bytes);
        return false;
    }
    u.bytes[u.size] = '\0';
    *text = u.bytes;
    *size_bytes = u.size;
    return true;
}

bool text_file_read(const char *path, char **text, size_t *size_bytes,
                    struct error *err)
{
    char *packed;
    size_t packed_bytes;
    bool ok;

    if (!(strcmp(path, "-") == 0 ? file_read_stdin(text, size_bytes, err)
                                 : file_read(path, text, size_bytes, err)))
        return false;
    if (!is_packed(*text, *size_bytes))
        return true;
    packed = *text;
    packed_bytes = *size_bytes;
    ok = text_file_unpack(path, packed, packed_bytes, text, size_bytes, err);
    free(packed);
    return ok;
}
