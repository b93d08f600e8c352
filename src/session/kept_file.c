// SPDX-License-Identifier: MIT
#include "session/kept_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"

/* Size limit of a head: the path of a scene and a few numbers. */
#define HEAD_BYTES_MAX 16384

static const char magic[] = "glim session 1\n";
static const char scene_key[] = "scene ";

/* Numbers of the head, in their order. */
enum field {
    FIELD_LIVE,
    FIELD_EDITS,
    FIELD_RENDER_NS,
    FIELD_PARTS, /* the sizes of the parts, in the order of enum kept_part */
    FIELD_TEXTS = FIELD_PARTS + KEPT_PARTS, /* hash of all parts but the film */
    FIELD_HEAD,                             /* hash of the lines before */
    FIELDS
};

static const char *const keys[FIELDS] = {
    "live", "edits",   "render_ns", "view",  "materials",
    "mtl",  "history", "film",      "texts", "head",
};

static uint64_t hash_of(const char *bytes, size_t size_bytes)
{
    return hash_bytes(HASH_BEGIN, bytes, size_bytes);
}

/* ---- write ---- */

/* Returns the bytes of all parts, after `room` bytes that are not set. */
static char *join(const struct kept *k, size_t room, size_t *size_bytes)
{
    char *bytes;

    *size_bytes = room;
    for (int i = 0; i < KEPT_PARTS; i++)
        *size_bytes += k->sizes[i];
    bytes = malloc(*size_bytes + 1);
    if (bytes == NULL)
        return NULL;
    for (int i = 0; i < KEPT_PARTS; i++) {
        if (k->sizes[i] > 0)
            memcpy(bytes + room, k->parts[i], k->sizes[i]);
        room += k->sizes[i];
    }
    return bytes;
}

/* Returns the lines of the head, for free(). */
static char *head_of(const struct kept *k)
{
    uint64_t values[FIELDS] = {k->is_live, k->has_edits, k->render_ns};
    char *text = format_text("%s%s%s\n", magic, scene_key, k->scene);

    values[FIELD_TEXTS] = HASH_BEGIN;
    for (int i = 0; i < KEPT_PARTS; i++) {
        values[FIELD_PARTS + i] = k->sizes[i];
        if (i != KEPT_FILM && k->sizes[i] > 0)
            values[FIELD_TEXTS] =
                hash_bytes(values[FIELD_TEXTS], k->parts[i], k->sizes[i]);
    }
    for (int i = 0; i < FIELDS && text != NULL; i++) {
        char *before = text;

        if (i == FIELD_HEAD)
            values[i] = hash_of(text, strlen(text));
        text = format_text("%s%s %" PRIu64 "\n", before, keys[i], values[i]);
        free(before);
    }
    return text;
}

char *kept_bytes(const struct kept *k, size_t *size_bytes)
{
    char *head = head_of(k), *bytes;

    if (head == NULL)
        return NULL;
    bytes = join(k, strlen(head), size_bytes);
    if (bytes != NULL)
        memcpy(bytes, head, strlen(head));
    free(head);
    return bytes;
}

/* ---- read ---- */

struct reader {
    const char *path, *p;
    int line;
};

static bool fail_line(const struct reader *r, const char *expected,
                      struct error *err)
{
    return fail(err, "%s:%d: found another text, expected %s", r->path, r->line,
                expected);
}

/* Reads the line `KEY NUMBER`. A NUL is after the text. */
static bool read_number(struct reader *r, const char *key, uint64_t *value,
                        struct error *err)
{
    size_t length = strlen(key);
    const char *p;

    r->line++;
    if (strncmp(r->p, key, length) != 0 || r->p[length] != ' ' ||
        r->p[length + 1] < '0' || r->p[length + 1] > '9')
        return fail_line(r, key, err);
    p = r->p + length + 1;
    if (!digits_parse(&p, 10, UINT64_MAX, value) || *p != '\n')
        return fail_line(r, "a whole number", err);
    r->p = p + 1;
    return true;
}

static bool read_scene(struct reader *r, struct kept *k, struct error *err)
{
    size_t key = sizeof scene_key - 1, length;

    r->line++;
    length = strcspn(r->p, "\n");
    if (strncmp(r->p, scene_key, key) != 0 || r->p[key] != '/' ||
        r->p[length] == '\0')
        return fail_line(r, "the path of a scene", err);
    k->scene = format_text("%.*s", (int)(length - key), r->p + key);
    r->p += length + 1;
    return k->scene != NULL || fail(err, "%s: out of memory", r->path);
}

/* Reads the head. The sizes of the parts must make up the rest of the file,
 * which has size_bytes. */
static bool read_head(struct reader *r, struct kept *k, size_t size_bytes,
                      uint64_t *texts, struct error *err)
{
    const char *begin = r->p;
    uint64_t values[FIELDS], expected = 0, rest;

    if (strncmp(r->p, magic, sizeof magic - 1) != 0)
        return fail(err, "%s: found another kind of file, expected a session",
                    r->path);
    r->p += sizeof magic - 1;
    r->line = 1;
    if (!read_scene(r, k, err))
        return false;
    for (int i = 0; i < FIELDS; i++) {
        expected = hash_of(begin, (size_t)(r->p - begin));
        if (!read_number(r, keys[i], &values[i], err))
            return false;
    }
    if (values[FIELD_HEAD] != expected)
        return fail(err, "%s: found damaged lines, expected a session",
                    r->path);
    k->is_live = values[FIELD_LIVE] != 0;
    k->has_edits = values[FIELD_EDITS] != 0;
    k->render_ns = values[FIELD_RENDER_NS];
    *texts = values[FIELD_TEXTS];
    rest = size_bytes - (size_t)(r->p - begin);
    for (int i = 0; i < KEPT_PARTS; i++) {
        uint64_t size = values[FIELD_PARTS + i];

        if (size > rest)
            return fail(err, "%s: found the end of the file, expected more",
                        r->path);
        k->sizes[i] = (size_t)size;
        rest -= size;
    }
    return rest == 0 ||
           fail(err, "%s: found more bytes, expected the end", r->path);
}

/* Copies the parts, and checks them. */
static bool take_parts(struct kept *k, const struct reader *r, uint64_t texts,
                       struct error *err)
{
    const char *p = r->p;
    uint64_t found = HASH_BEGIN;

    for (int i = 0; i < KEPT_PARTS; i++) {
        k->parts[i] = malloc(k->sizes[i] + 1);
        if (k->parts[i] == NULL)
            return fail(err, "%s: out of memory", r->path);
        memcpy(k->parts[i], p, k->sizes[i]);
        k->parts[i][k->sizes[i]] = '\0';
        if (i != KEPT_FILM)
            found = hash_bytes(found, p, k->sizes[i]);
        p += k->sizes[i];
    }
    return found == texts ||
           fail(err, "%s: found damaged bytes, expected a session", r->path);
}

static bool parse(struct kept *k, const char *path, const char *bytes,
                  size_t size_bytes, bool has_parts, struct error *err)
{
    struct reader r = {.path = path, .p = bytes};
    uint64_t texts = 0;

    *k = (struct kept){.scene = NULL};
    return read_head(&r, k, size_bytes, &texts, err) &&
           (!has_parts || take_parts(k, &r, texts, err));
}

bool kept_parse(struct kept *k, const char *path, const char *bytes,
                size_t size_bytes, struct error *err)
{
    return parse(k, path, bytes, size_bytes, true, err);
}

bool kept_read(struct kept *k, const char *path, struct error *err)
{
    char *bytes;
    size_t size;
    bool ok;

    *k = (struct kept){.scene = NULL};
    if (!file_read(path, &bytes, &size, err))
        return false;
    ok = kept_parse(k, path, bytes, size, err);
    free(bytes);
    return ok;
}

bool kept_read_head(struct kept *k, const char *path, struct error *err)
{
    char bytes[HEAD_BYTES_MAX + 1];
    struct file_identity file = file_identify(path);
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    ssize_t count;

    *k = (struct kept){.scene = NULL};
    count = fd >= 0 ? read(fd, bytes, HEAD_BYTES_MAX) : -1;
    if (count < 0)
        fail(err, "%s: %s", path, strerror(errno));
    if (fd >= 0)
        close(fd);
    if (count < 0)
        return false;
    bytes[count] = '\0';
    if ((off_t)count > file.size_bytes)
        return fail(err, "%s: found a file that changes", path);
    return parse(k, path, bytes, (size_t)file.size_bytes, false, err);
}

void kept_free(struct kept *k)
{
    free(k->scene);
    for (int i = 0; i < KEPT_PARTS; i++)
        free(k->parts[i]);
    *k = (struct kept){.scene = NULL};
}
