// SPDX-License-Identifier: MIT
#include "read/vdb_bytes.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define ZLIB_CONST
#include <zlib.h>

#include "base/library_child.h"

/* ---- numbers ---- */

uint32_t vdb_u32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
           (uint32_t)p[3] << 24;
}

static uint64_t u64(const uint8_t *p)
{
    return vdb_u32(p) | (uint64_t)vdb_u32(p + 4) << 32;
}

float vdb_float(const uint8_t *p)
{
    uint32_t bits = vdb_u32(p);
    float number;

    memcpy(&number, &bits, sizeof number);
    return number;
}

float vdb_half(const uint8_t *p)
{
    int bits = p[0] | p[1] << 8;
    int exponent = bits >> 10 & 31;
    float fraction = (float)(bits & 1023);
    float number;

    if (exponent == 31)
        number = fraction == 0 ? INFINITY : NAN;
    else if (exponent == 0)
        number = ldexpf(fraction, -24);
    else
        number = ldexpf(1024 + fraction, exponent - 25);
    return (bits & 0x8000) != 0 ? -number : number;
}

/* ---- parts of the file ---- */

const uint8_t *vdb_take(struct vdb_reader *r, uint64_t size_bytes)
{
    const uint8_t *p = r->bytes + r->at;

    if (size_bytes > r->size - r->at) {
        fail(r->err,
             "found its end at byte %" PRIu64 ", expected %" PRIu64
             " more bytes",
             r->size, size_bytes - (r->size - r->at));
        return NULL;
    }
    r->at += size_bytes;
    return p;
}

bool vdb_take_u8(struct vdb_reader *r, uint32_t *to)
{
    const uint8_t *p = vdb_take(r, 1);

    if (p != NULL)
        *to = p[0];
    return p != NULL;
}

bool vdb_take_u32(struct vdb_reader *r, uint32_t *to)
{
    const uint8_t *p = vdb_take(r, 4);

    if (p != NULL)
        *to = vdb_u32(p);
    return p != NULL;
}

bool vdb_take_i64(struct vdb_reader *r, int64_t *to)
{
    const uint8_t *p = vdb_take(r, 8);

    if (p != NULL)
        *to = (int64_t)u64(p);
    return p != NULL;
}

bool vdb_take_float(struct vdb_reader *r, float *to)
{
    const uint8_t *p = vdb_take(r, 4);

    if (p != NULL)
        *to = vdb_float(p);
    return p != NULL;
}

bool vdb_take_doubles(struct vdb_reader *r, double *to, int count)
{
    const uint8_t *p = vdb_take(r, 8 * (uint64_t)count);

    for (int i = 0; p != NULL && i < count; i++) {
        uint64_t bits = u64(p + 8 * i);

        memcpy(&to[i], &bits, sizeof bits);
    }
    return p != NULL;
}

bool vdb_take_ints(struct vdb_reader *r, int32_t to[3])
{
    const uint8_t *p = vdb_take(r, 12);

    for (int i = 0; p != NULL && i < 3; i++)
        to[i] = (int32_t)vdb_u32(p + 4 * i);
    return p != NULL;
}

bool vdb_take_text(struct vdb_reader *r, struct word *to)
{
    uint32_t length;
    const uint8_t *p;

    if (!vdb_take_u32(r, &length))
        return false;
    p = vdb_take(r, length);
    *to = (struct word){(const char *)p, length};
    return p != NULL;
}

/* ---- packed values ---- */

#define BLOSC_LIBRARY "libblosc.so.1"

/* Bytes at the beginning of packed values, which say their sizes. */
#define BLOSC_HEAD 16

static bool open_blosc(struct vdb_reader *r)
{
    static const struct library_function function = {"blosc_decompress_ctx",
                                                     offsetof(struct vdb_reader,
                                                              unblosc)};
    const char *missing;

    if (r->unblosc != NULL ||
        dynamic_library_load(BLOSC_LIBRARY, &function, 1, r, &missing))
        return true;
    if (missing != NULL)
        return fail(r->err, "%s has no %s", BLOSC_LIBRARY, missing);
    return fail(r->err,
                "found values that blosc has packed, and no %s "
                "(Debian's package: %s)",
                BLOSC_LIBRARY, BLOSC_PACKAGE);
}

static bool fail_packed(struct vdb_reader *r, uint64_t at, const char *by,
                        uint32_t expected)
{
    return fail(r->err,
                "byte %" PRIu64 ": found broken values, expected %" PRIu32
                " bytes that %s has packed",
                at, expected, by);
}

static bool unpack_blosc(struct vdb_reader *r, const uint8_t *packed,
                         uint64_t packed_bytes, void *to, uint32_t size_bytes)
{
    uint64_t at = (uint64_t)(packed - r->bytes);

    /* the library believes these sizes */
    if (packed_bytes < BLOSC_HEAD || vdb_u32(packed + 4) != size_bytes ||
        vdb_u32(packed + 12) != packed_bytes)
        return fail_packed(r, at, "blosc", size_bytes);
    return open_blosc(r) &&
           (r->unblosc(packed, to, size_bytes, 1) == (int)size_bytes ||
            fail_packed(r, at, "blosc", size_bytes));
}

static bool unpack_zip(struct vdb_reader *r, const uint8_t *packed,
                       uint64_t packed_bytes, void *to, uint32_t size_bytes)
{
    uLongf length = size_bytes;

    return (uncompress(to, &length, packed, (uLong)packed_bytes) == Z_OK &&
            length == size_bytes) ||
           fail_packed(r, (uint64_t)(packed - r->bytes), "zlib", size_bytes);
}

bool vdb_take_packed(struct vdb_reader *r, uint32_t flags, void *to,
                     uint32_t size_bytes)
{
    int64_t packed_bytes = -(int64_t)size_bytes;
    uint64_t at = r->at;
    const uint8_t *p;

    if ((flags & (VDB_ZIP | VDB_BLOSC)) != 0 && !vdb_take_i64(r, &packed_bytes))
        return false;
    /* values that did not become shorter are not packed */
    if (packed_bytes <= 0 && packed_bytes != -(int64_t)size_bytes)
        return fail(r->err,
                    "byte %" PRIu64 ": found %" PRId64
                    " as size of packed values, expected -%" PRIu32
                    " or more than 0",
                    at, packed_bytes, size_bytes);
    p = vdb_take(r, packed_bytes > 0 ? (uint64_t)packed_bytes : size_bytes);
    if (p == NULL)
        return false;
    if (packed_bytes <= 0) {
        memcpy(to, p, size_bytes);
        return true;
    }
    return (flags & VDB_BLOSC) != 0
               ? unpack_blosc(r, p, (uint64_t)packed_bytes, to, size_bytes)
               : unpack_zip(r, p, (uint64_t)packed_bytes, to, size_bytes);
}
