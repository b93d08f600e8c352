// SPDX-License-Identifier: MIT
#include "read/obj_runs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/geometry.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "kernels/vec.h"

/* Bytes of a block: what it holds stays in the cache until it is taken. */
#define BLOCK_BYTES ((size_t)256 << 10)

/* Blocks that are read at once, for each thread. */
#define BLOCKS_EACH 4

/* Lines without a plain one between them after which the rest of the block is
 * left to the parser. */
#define ODD_LINES 16

/* Most digits of an index, which then is below all limits. */
#define INDEX_DIGITS 9

/* ---- parts of lines ---- */

static const char *skip_spaces(const char *p, const char *end)
{
    while (p < end && *p == ' ')
        p++;
    return p;
}

/* Returns true behind the last word of a line that does not end the text. *p
 * moves to the next line. */
static bool take_line_end(const char **p, const char *end)
{
    const char *q = skip_spaces(*p, end);

    q += end - q > 1 && *q == '\r';
    if (q == end || *q != '\n')
        return false;
    *p = q + 1;
    return true;
}

/* Reads finite numbers, of which each has blanks before it. */
static bool take_numbers(const char **p, const char *end, int count,
                         double *numbers)
{
    const char *q = *p;

    for (int i = 0; i < count; i++) {
        const char *first = skip_spaces(q, end);

        if (first == q)
            return false;
        q = first;
        if (!decimal_parse(&q, end, &numbers[i]) || !isfinite(numbers[i]))
            return false;
    }
    *p = q;
    return true;
}

/* Reads an index from 1 on. */
static bool take_index(const char **p, const char *end, uint32_t *index)
{
    const char *q = *p;
    uint32_t value = 0;

    for (; q < end && *q >= '0' && *q <= '9'; q++)
        value = q - *p < INDEX_DIGITS ? value * 10 + (uint32_t)(*q - '0') : 0;
    *p = q;
    *index = value - 1;
    return value > 0;
}

/* Reads v, v/vt, v//vn or v/vt/vn. */
static bool take_corner(const char **p, const char *end, struct corner *c)
{
    *c = (struct corner){NO_INDEX, NO_INDEX, NO_INDEX};
    if (!take_index(p, end, &c->v))
        return false;
    if (*p == end || **p != '/')
        return true;
    ++*p;
    if (*p < end && **p != '/' && !take_index(p, end, &c->vt))
        return false;
    if (*p == end || **p != '/')
        return c->vt != NO_INDEX;
    ++*p;
    return take_index(p, end, &c->vn);
}

/* ---- lines ---- */

static bool read_position(struct obj_block *b, const char **p)
{
    void *array = b->positions;
    double xyz[3];

    if (!take_numbers(p, b->end, 3, xyz) || !take_line_end(p, b->end) ||
        !grow_array(&array, &b->position_capacity, b->counts[OBJ_V] + 1u,
                    sizeof xyz))
        return false;
    b->positions = array;
    memcpy(b->positions + 3 * (size_t)b->counts[OBJ_V]++, xyz, sizeof xyz);
    return true;
}

/* A third number is ignored. */
static bool read_uv(struct obj_block *b, const char **p)
{
    void *array = b->uvs;
    double uvw[3];

    if (!take_numbers(p, b->end, 2, uvw) ||
        !(take_line_end(p, b->end) ||
          (take_numbers(p, b->end, 1, uvw + 2) && take_line_end(p, b->end))) ||
        !grow_array(&array, &b->uv_capacity, b->counts[OBJ_VT] + 1u,
                    sizeof *b->uvs))
        return false;
    b->uvs = array;
    b->uvs[b->counts[OBJ_VT]++] =
        v2(texture_coordinate(uvw[0]), texture_coordinate(uvw[1]));
    return true;
}

static bool read_normal(struct obj_block *b, const char **p)
{
    void *array = b->normals;
    double n[3];

    if (!take_numbers(p, b->end, 3, n) || !take_line_end(p, b->end) ||
        !vec3d_normalize(n) ||
        !grow_array(&array, &b->normal_capacity, b->counts[OBJ_VN] + 1u,
                    sizeof *b->normals))
        return false;
    b->normals = array;
    b->normals[b->counts[OBJ_VN]++] = v3((float)n[0], (float)n[1], (float)n[2]);
    return true;
}

/* Raises what a run needs to what an index of one of its lines does. */
static void need(const struct obj_block *b, struct obj_run *run, int list,
                 uint32_t index)
{
    int64_t own = b->counts[list] - run->first[list];

    if (index != NO_INDEX && index + 1 - own > run->needed[list])
        run->needed[list] = index + 1 - own;
}

static bool read_face(struct obj_block *b, struct obj_run *run, const char **p)
{
    void *corners = b->corners, *faces = b->faces;
    uint32_t begin = b->corner_count, at = begin;

    while (!take_line_end(p, b->end)) {
        const char *first = skip_spaces(*p, b->end);
        bool has_blank = first > *p;

        *p = first;
        if (!has_blank || !grow_array(&corners, &b->corner_capacity, at + 1u,
                                      sizeof *b->corners))
            return false;
        b->corners = corners;
        if (!take_corner(p, b->end, &b->corners[at++]))
            return false;
    }
    if (at < begin + 3 || !grow_array(&faces, &b->face_capacity,
                                      b->face_count + 1u, sizeof *b->faces))
        return false;
    b->faces = faces;
    b->faces[b->face_count++] = (struct obj_face){at, run->line_count};
    b->corner_count = at;
    run->has_polygons |= at > begin + 3;
    for (; begin < at; begin++) {
        need(b, run, OBJ_V, b->corners[begin].v);
        need(b, run, OBJ_VT, b->corners[begin].vt);
        need(b, run, OBJ_VN, b->corners[begin].vn);
    }
    return true;
}

/* Reads a plain line and moves *p to the next one. Returns false for all
 * others. */
static bool read_line(struct obj_block *b, struct obj_run *run, const char **p)
{
    const char *q = *p;
    bool ok = false;

    if (b->end - q < 3)
        return false;
    if (q[0] == 'v' && q[1] == ' ') {
        q += 1;
        ok = read_position(b, &q);
    } else if (q[0] == 'f' && q[1] == ' ') {
        q += 1;
        ok = read_face(b, run, &q);
    } else if (q[0] == 'v' && q[1] == 't') {
        q += 2;
        ok = read_uv(b, &q);
    } else if (q[0] == 'v' && q[1] == 'n') {
        q += 2;
        ok = read_normal(b, &q);
    }
    if (ok)
        *p = q;
    return ok;
}

/* ---- blocks ---- */

/* Adds an empty run that begins at p. */
static bool begin_run(struct obj_block *b, const char *p)
{
    struct obj_run run = {.begin = p,
                          .end = p,
                          .first_face = b->face_count,
                          .first_corner = b->corner_count};
    void *runs = b->runs;

    memcpy(run.first, b->counts, sizeof run.first);
    for (int i = 0; i < OBJ_LISTS; i++)
        run.needed[i] = INT64_MIN;
    if (!grow_array(&runs, &b->run_capacity, b->run_count + 1u,
                    sizeof *b->runs))
        return false;
    b->runs = runs;
    b->runs[b->run_count] = run;
    return true;
}

/* Reads the runs of a block. The arrays of the block keep their memory. */
static void read_block(struct obj_block *b)
{
    struct lexer lex = {b->begin, b->end, 0};
    uint32_t odd_lines = 0;

    b->run_count = b->face_count = b->corner_count = 0;
    memset(b->counts, 0, sizeof b->counts);
    while (odd_lines < ODD_LINES && lex.p < b->end && begin_run(b, lex.p)) {
        struct obj_run *run = &b->runs[b->run_count];

        while (read_line(b, run, &lex.p))
            run->line_count++;
        run->end = lex.p;
        odd_lines++;
        if (run->line_count > 0) {
            b->run_count++;
            odd_lines = 0;
        }
        lexer_next_line(&lex);
    }
    if (!begin_run(b, lex.p))
        b->run_count = 0;
}

/* Returns the beginning of the first line from p on. */
static const char *line_from(const char *p, const char *end)
{
    const char *found = memchr(p, '\n', (size_t)(end - p));

    return found != NULL ? found + 1 : end;
}

/* ---- the text ---- */

/* Blocks that are taken while others are read. */
struct reader {
    struct obj_blocks taken, read;
    uint32_t capacity; /* of both */
    obj_take_blocks *take;
    void *context;
    bool ok;
};

/* Sets the blocks that are read next. */
static void begin_blocks(struct reader *r, const char *text, const char *end)
{
    r->read.count = 0;
    while (text < end && r->read.count < r->capacity) {
        struct obj_block *b = &r->read.items[r->read.count++];

        b->begin = text;
        b->end = (size_t)(end - text) > BLOCK_BYTES
                     ? line_from(text + BLOCK_BYTES, end)
                     : end;
        text = b->end;
    }
    r->read.end = text;
}

/* Takes blocks, item 0, or reads one. */
static void do_item(void *context, uint32_t item, int worker)
{
    struct reader *r = context;

    (void)worker;
    if (item > 0)
        read_block(&r->read.items[item - 1]);
    else if (r->taken.count > 0)
        r->ok = r->take(r->context, &r->taken);
}

static void free_blocks(struct obj_blocks *blocks, uint32_t capacity)
{
    for (uint32_t i = 0; blocks->items != NULL && i < capacity; i++) {
        struct obj_block *b = &blocks->items[i];

        free(b->runs);
        free(b->positions);
        free(b->uvs);
        free(b->normals);
        free(b->faces);
        free(b->corners);
    }
    free(blocks->items);
}

bool obj_runs_read(const char *from, const char *end, struct pool *pool,
                   obj_take_blocks *take, void *context)
{
    uint32_t threads = pool != NULL ? (uint32_t)pool_thread_count(pool) : 1;
    struct reader r = {.capacity = BLOCKS_EACH * threads,
                       .take = take,
                       .context = context};

    r.taken.items = alloc_array(r.capacity, sizeof *r.taken.items);
    r.read.items = alloc_array(r.capacity, sizeof *r.read.items);
    r.read.end = from;
    r.ok = true;
    if (r.taken.items == NULL || r.read.items == NULL)
        r.ok = take(context, &(struct obj_blocks){.end = r.read.end = end});
    while (r.ok && (r.read.end < end || r.taken.count > 0)) {
        struct obj_block *items = r.taken.items;

        begin_blocks(&r, r.read.end, end);
        pool_each(pool, 1 + r.read.count, do_item, &r);
        r.taken = r.read;
        r.read.items = items;
    }
    free_blocks(&r.taken, r.capacity);
    free_blocks(&r.read, r.capacity);
    return r.ok;
}

/* ---- runs ---- */

bool obj_run_fits(const struct obj_run *run, const struct face_tris *faces)
{
    const struct scene *s = faces->scene;
    const uint32_t counts[OBJ_LISTS] = {s->position_count, s->uv_count,
                                        s->normal_count};

    for (int i = 0; i < OBJ_LISTS; i++)
        if (run->needed[i] > counts[i] ||
            run[1].first[i] - run->first[i] >= NO_INDEX - 1 - counts[i])
            return false;
    return run[1].first_face - run->first_face <
           NO_INDEX - 1 - faces->face_count;
}

/* Appends items of a block to a list of vertices. */
static bool append(void **array, size_t *capacity, uint32_t *list_count,
                   const void *items, const uint32_t range[2],
                   size_t size_bytes)
{
    uint32_t count = range[1] - range[0];

    if (count == 0)
        return true;
    if (!grow_array(array, capacity, (size_t)*list_count + count, size_bytes))
        return false;
    memcpy((char *)*array + *list_count * size_bytes,
           (const char *)items + range[0] * size_bytes, count * size_bytes);
    *list_count += count;
    return true;
}

static bool take_vertices(const struct obj_block *b, const struct obj_run *run,
                          struct scene *s, size_t capacities[OBJ_LISTS])
{
    void *positions = s->file_positions, *uvs = s->uvs, *normals = s->normals;
    uint32_t ranges[OBJ_LISTS][2];
    bool ok;

    for (int i = 0; i < OBJ_LISTS; i++) {
        ranges[i][0] = run[0].first[i];
        ranges[i][1] = run[1].first[i];
    }
    ok = append(&positions, &capacities[OBJ_V], &s->position_count,
                b->positions, ranges[OBJ_V], 3 * sizeof *b->positions) &&
         append(&uvs, &capacities[OBJ_VT], &s->uv_count, b->uvs, ranges[OBJ_VT],
                sizeof *b->uvs) &&
         append(&normals, &capacities[OBJ_VN], &s->normal_count, b->normals,
                ranges[OBJ_VN], sizeof *b->normals);
    s->file_positions = positions;
    s->uvs = uvs;
    s->normals = normals;
    return ok;
}

/* Adds a face whose corners are `from`. */
static bool take_polygon(struct face_tris *f, const struct corner *from,
                         uint32_t count, uint32_t object, uint32_t material,
                         uint64_t line)
{
    f->corner_count = count;
    if (!face_tris_reserve(f, count))
        return false;
    memcpy(f->corners, from, count * sizeof *from);
    for (uint32_t k = 0; k < count; k++)
        memcpy(f->points + 3 * (size_t)k,
               f->scene->file_positions + 3 * (size_t)from[k].v,
               3 * sizeof *f->points);
    if (!face_tris_add(f, object, material, (struct file_place){.line = line}))
        return false;
    f->face_count++;
    return true;
}

bool obj_run_take(const struct obj_block *b, const struct obj_run *run,
                  struct face_tris *faces, size_t capacities[OBJ_LISTS],
                  struct obj_run_place at)
{
    uint32_t corner = run->first_corner, end = run[1].first_face;
    bool ok = take_vertices(b, run, faces->scene, capacities);

    if (run->first_face == end)
        return ok;
    if (!run->has_polygons)
        return ok && face_tris_add_triangles(faces, b->corners + corner,
                                             end - run->first_face, at.object,
                                             at.material);
    for (uint32_t i = run->first_face; ok && i < end; i++) {
        const struct obj_face *f = &b->faces[i];

        ok = take_polygon(faces, b->corners + corner, f->corner_end - corner,
                          at.object, at.material, at.line + f->line);
        corner = f->corner_end;
    }
    return ok;
}
