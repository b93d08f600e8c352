// SPDX-License-Identifier: MIT
#include "formats/faces.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Limit for the digits of an index: above every vertex count, and far from
 * overflow. */
#define INDEX_TEXT_MAX INT64_C(1000000000000)

static const char *const corner_names[] = {"vertex", "texture vertex",
                                           "normal"};

static bool out_of_memory(const struct face_tris *f, const struct lexer *lex,
                          struct error *err)
{
    return fail(err, "%s:%" PRIu64 ": out of memory for the faces", f->path,
                lex->line);
}

/* Reads digits with an optional '-'. Returns false if there are no digits. */
static bool parse_index(const char **p, const char *end, int64_t *index)
{
    bool is_negative = *p < end && **p == '-';
    const char *first = *p + is_negative;
    const char *q = first;
    int64_t value = 0;

    for (; q < end && *q >= '0' && *q <= '9'; q++) {
        if (value < INDEX_TEXT_MAX)
            value = value * 10 + (*q - '0');
    }
    *p = q;
    *index = is_negative ? -value : value;
    return q > first;
}

/* Turns an index of the file, which counts from 1 or back from the last vertex
 * so far, into one from 0. Returns false if it is out of range. */
static bool resolve(int64_t index, uint32_t count, uint32_t *to)
{
    if (index < 0)
        index += (int64_t)count + 1;
    if (index < 1 || index > count)
        return false;
    *to = (uint32_t)(index - 1);
    return true;
}

static bool report_index(const struct face_tris *f, const struct lexer *lex,
                         const char *what, struct word index, uint32_t count)
{
    struct word_text text = word_cut(index);

    if (count == 0)
        warnings_add(
            f->report, "faces with a bad index",
            "%s:%" PRIu64
            ": found %s %s in a face, but none before it: face dropped",
            f->path, lex->line, what, text.text);
    else
        warnings_add(f->report, "faces with a bad index",
                     "%s:%" PRIu64 ": found %s %s in a face, expected 1 to "
                     "%" PRIu32 " or -1 to -%" PRIu32 ": face dropped",
                     f->path, lex->line, what, text.text, count, count);
    return false;
}

/* Reports an index into a list (normals or texture vertices) that the file does
 * not contain at all. Exporters that strip such a list may leave its indices in
 * the faces, so the face is used without them. */
static bool is_missing_list(const struct face_tris *f, const struct lexer *lex,
                            int k, int64_t index, struct word word,
                            uint32_t count)
{
    if (k == 0 || count > 0 || index < 1)
        return false;
    warnings_add(
        f->report,
        k == 1 ? "corners without their texture vertex"
               : "corners without their normal",
        "%s:%" PRIu64
        ": found %s %s in a face, but none before it: face used without",
        f->path, lex->line, corner_names[k], word_cut(word).text);
    return true;
}

static bool report_malformed(const struct face_tris *f, const struct lexer *lex,
                             struct word word)
{
    warnings_add(f->report, "malformed faces",
                 "%s:%" PRIu64
                 ": found %s in a face, expected v, v/vt, v//vn or "
                 "v/vt/vn: face dropped",
                 f->path, lex->line, word_quote(word).text);
    return false;
}

/* Reads v, v/vt, v//vn or v/vt/vn. A slash at the end is accepted. */
static bool parse_corner(const struct face_tris *f, const struct lexer *lex,
                         struct word word, struct corner *c)
{
    const uint32_t counts[] = {f->scene->position_count, f->scene->uv_count,
                               f->scene->normal_count};
    const char *p = word.start;
    const char *end = p + word.length;
    uint32_t indices[3] = {NO_INDEX, NO_INDEX, NO_INDEX};

    for (int k = 0; k < 3 && p <= end; k++) {
        const char *start = p;
        int64_t index;

        if (parse_index(&p, end, &index)) {
            struct word text = {start, (size_t)(p - start)};

            if (!resolve(index, counts[k], &indices[k]) &&
                !is_missing_list(f, lex, k, index, text, counts[k]))
                return report_index(f, lex, corner_names[k], text, counts[k]);
        } else if (k == 0 || p != start) {
            return report_malformed(f, lex, word);
        }
        if (p == end)
            break;
        if (*p != '/' || k == 2)
            return report_malformed(f, lex, word);
        p++;
    }
    *c = (struct corner){indices[0], indices[1], indices[2]};
    return true;
}

/* Reads the corners up to the end of the line. *is_good becomes false for a
 * face that was reported and has to be dropped. */
static bool read_corners(struct face_tris *f, struct lexer *lex, bool *is_good,
                         struct error *err)
{
    *is_good = true;
    f->corner_count = 0;
    while (!lexer_at_line_end(lex)) {
        uint32_t n = f->corner_count;
        struct corner *c;

        if (!face_tris_reserve(f, (size_t)n + 1))
            return out_of_memory(f, lex, err);
        c = &f->corners[n];
        if (!parse_corner(f, lex, lexer_word(lex), c)) {
            *is_good = false;
            return true;
        }
        memcpy(f->points + 3 * (size_t)n,
               f->scene->file_positions + 3 * (size_t)c->v,
               3 * sizeof *f->points);
        f->corner_count++;
    }
    return true;
}

bool faces_read(struct face_tris *f, struct lexer *lex, uint32_t object,
                uint32_t material, struct error *err)
{
    struct file_place place = {.line = lex->line};
    bool is_good;

    if (f->face_count == NO_INDEX - 1)
        return fail(err, "%s:%" PRIu64 ": found more than 4294967294 faces",
                    f->path, place.line);
    if (!read_corners(f, lex, &is_good, err))
        return false;
    if (is_good && !face_tris_add(f, object, material, place))
        return out_of_memory(f, lex, err);
    f->face_count++;
    return true;
}
