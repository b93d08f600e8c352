// SPDX-License-Identifier: MIT
#include "world/bvh/sah_splitter.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"

#include "kernels/traverse_leaf.h"

/* Depth from which nodes are split by count: 32 more levels hold any number of
 * triangles, and all of them fit TRAVERSE_STACK. */
#define SAH_DEPTH 60

_Static_assert(SAH_DEPTH + 32 < TRAVERSE_STACK, "trees are as deep");

/* Area of a large node, relative to that of all. Measured: the same from 1e-4
 * to 1e-3, with 1 % more memory instead of 7. */
#define LARGE_PART 1e-3f

/* Sizes of ranges from which every second and every fourth box chooses the
 * plane, and the most boxes that do. Measured, by nodes and blocks that rays
 * visit, over several counts of bins: bunny and sponza_part 1 % worse,
 * veach_ajar the same; 6 % worse if a thousand boxes choose, 9 % if every
 * eighth does. */
#define SAMPLED_HALF    512
#define SAMPLED_QUARTER 4096
#define SAMPLE_MAX      16384

/* Boxes of a large range that a thread takes at once. */
#define CHUNK 4096

static uint32_t chunks_of(uint32_t count)
{
    return (count + CHUNK - 1) / CHUNK;
}

static uint32_t chunk_size(uint32_t count, uint32_t chunk)
{
    uint32_t rest = count - chunk * CHUNK;

    return rest < CHUNK ? rest : CHUNK;
}

/* ---- boxes ---- */

static struct box box_of_tri(const struct world *w, uint32_t tri)
{
    const uint32_t *v = w->tris[tri].v;
    struct box box = box_of_point(w->positions[v[0]]);

    for (int k = 1; k < 3; k++) {
        struct box corner = box_of_point(w->positions[v[k]]);

        box_join(&box, &corner);
    }
    return box;
}

static void add_extent(struct extent *to, const struct box *boxes,
                       uint32_t count)
{
    struct extent e = extent_of(boxes, count);

    extent_join(to, &e);
}

static void fill_chunk(void *context, uint32_t chunk, int worker)
{
    struct splitter *s = context;
    const struct world *w = s->world;
    struct splitter_worker *own = &s->workers[worker];
    uint32_t first = chunk * CHUNK;
    uint32_t count = chunk_size(w->settings.tri_count, chunk);

    for (uint32_t i = first; i < first + count; i++) {
        s->buffers[0][i] = box_of_tri(w, i);
        box_set_tri(&s->buffers[0][i], i);
    }
    add_extent(&own->extents[0], s->buffers[0] + first, count);
}

static void clear_extents(struct splitter *s)
{
    for (uint32_t i = 0; i < s->worker_count; i++)
        for (int k = 0; k < 2; k++)
            s->workers[i].extents[k] = extent_empty();
}

static struct extent join_extents(const struct splitter *s, int side)
{
    struct extent all = s->workers[0].extents[side];

    for (uint32_t i = 1; i < s->worker_count; i++)
        extent_join(&all, &s->workers[i].extents[side]);
    return all;
}

struct range splitter_all(struct splitter *s)
{
    struct range all = {.count = s->world->settings.tri_count};

    clear_extents(s);
    pool_each(s->pool, chunks_of(all.count), fill_chunk, s);
    all.extent = join_extents(s, 0);
    s->large_area = LARGE_PART * box_area(&all.extent.bounds);
    return all;
}

/* ---- by one thread ---- */

/* Size of blocks for a range. */
static uint32_t bits_for(const struct splitter *s, const struct range *r)
{
    return box_area(&r->extent.bounds) >= s->large_area ? s->leaves->large_bits
                                                        : s->leaves->block_bits;
}

static bool is_leaf(const struct splitter *s, const struct range *r,
                    const struct split *split)
{
    const struct bvh_leaves *leaves = s->leaves;
    float area = box_area(&r->extent.bounds);
    float blocks = blocks_of(r->count, bits_for(s, r));

    return r->count <= leaves->most &&
           (split->axis < 0 ||
            leaves->block_cost * (blocks * area - split->cost) <= area);
}

static uint32_t stride_for(uint32_t count)
{
    uint32_t least = count < SAMPLED_HALF ? 1 : count < SAMPLED_QUARTER ? 2 : 4;

    return count / least > SAMPLE_MAX ? count / SAMPLE_MAX : least;
}

/* Finds the plane from a subset of the boxes, or from all if those of the
 * subset have one centre. */
static struct split find_split(const struct splitter *s, struct bins *bins,
                               const struct range *r)
{
    const struct box *boxes = s->buffers[r->buffer] + r->first;
    uint32_t stride = stride_for(r->count);
    struct split split;

    for (;; stride = 1) {
        bins_clear(bins, r->count, &r->extent.centers);
        bins_add(bins, boxes, r->count, stride);
        split = bins_split(bins, bits_for(s, r));
        if (split.axis >= 0 || stride == 1)
            break;
    }
    if (r->depth >= SAH_DEPTH)
        split.axis = -1;
    return split;
}

/* Sets the ranges of both sides. */
static void begin_sides(const struct range *r, uint32_t left,
                        struct range sides[2])
{
    for (uint32_t i = 0; i < 2; i++)
        sides[i] = (struct range){.first = r->first + i * left,
                                  .count = i == 0 ? left : r->count - left,
                                  .depth = r->depth + 1,
                                  .buffer = r->buffer ^ 1};
}

/* Copies boxes that no plane separates. The first half goes left. */
static uint32_t halve(const struct box *boxes, uint32_t count, struct box *to)
{
    memcpy(to, boxes, count * sizeof *to);
    return count / 2;
}

/* ---- copies ---- */

/* Copies lie in one place, to the bit, and rays hit the one of the lowest
 * number only: traverse_leaf.h. A surface that lets rays through shows them
 * all. */
static bool may_drop_copies(const struct world *w)
{
    if (w->settings.alpha_count > 0)
        return false;
    for (uint32_t i = 0; i < w->settings.material_count; i++) {
        const struct material *m = &w->materials[i];
        const uint32_t textures[2] = {m->color_texture, m->opacity_texture};

        if (m->opacity < 1.0f)
            return false;
        for (int k = 0; k < 2; k++)
            if (textures[k] != NO_INDEX && w->textures[textures[k]].has_alpha)
                return false;
    }
    return true;
}

static bool is_same_point(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static uint64_t hash_point(struct vec3 p)
{
    const float sums[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; /* no -0 */

    return hash_bytes(HASH_BEGIN, sums, sizeof sums);
}

/* The bytes of an instance that decide where it is. */
#define PLACE_BYTES offsetof(struct instance, inverse)

static bool are_copies(const struct world *w, uint32_t a, uint32_t b)
{
    if (a < w->settings.instance_count || b < w->settings.instance_count)
        return a < w->settings.instance_count &&
               b < w->settings.instance_count &&
               w->instances[a].mesh == w->instances[b].mesh &&
               memcmp(&w->instances[a], &w->instances[b], PLACE_BYTES) == 0;
    for (int k = 1; k < 3; k++) {
        const uint32_t *v = w->tris[a].v, *u = w->tris[b].v;
        const struct vec3 *p = w->positions;

        if (is_same_point(p[v[0]], p[u[0]]) &&
            is_same_point(p[v[1]], p[u[k]]) &&
            is_same_point(p[v[2]], p[u[3 - k]]))
            return true; /* k = 2: of the other winding */
    }
    return false;
}

static uint64_t hash_of(const struct world *w, uint32_t tri)
{
    const uint32_t *v = w->tris[tri].v;

    if (tri < w->settings.instance_count)
        return hash_bytes(HASH_BEGIN, &w->instances[tri], PLACE_BYTES);
    return hash_point(w->positions[v[0]]) +
           (hash_point(w->positions[v[1]]) ^ hash_point(w->positions[v[2]]));
}

/* Keeps the first of all copies in a range. Without memory it keeps all. */
static void drop_copies(const struct splitter *s, struct range *r)
{
    struct box *boxes = s->buffers[r->buffer] + r->first;
    size_t mask = 1, kept = 0;
    uint32_t *table; /* 1 + index of a box that is kept; 0: none */

    while (mask < 2 * (size_t)r->count)
        mask *= 2;
    table = alloc_array(mask--, sizeof *table);
    for (uint32_t i = 0; table != NULL && i < r->count; i++) {
        uint32_t tri = box_tri(&boxes[i]);
        size_t at = hash_of(s->world, tri) & mask;

        while (table[at] != 0 &&
               !are_copies(s->world, tri, box_tri(&boxes[table[at] - 1])))
            at = (at + 1) & mask;
        if (table[at] == 0) {
            boxes[kept] = boxes[i];
            table[at] = (uint32_t)++kept;
        } else if (tri < box_tri(&boxes[table[at] - 1])) {
            boxes[table[at] - 1] = boxes[i];
        }
    }
    if (table != NULL)
        r->count = (uint32_t)kept;
    free(table);
}

/* ---- splits ---- */

/* Splits by the caller's thread alone. */
static void part(const struct splitter *s, const struct range *r,
                 const struct split *split, struct range sides[2])
{
    const struct box *boxes = s->buffers[r->buffer] + r->first;
    struct box *to = s->buffers[r->buffer ^ 1] + r->first;

    begin_sides(r,
                split->axis < 0
                    ? halve(boxes, r->count, to)
                    : split_part(split, boxes, r->count, to, to + r->count),
                sides);
    for (int i = 0; i < 2; i++)
        sides[i].extent =
            extent_of(s->buffers[sides[i].buffer] + sides[i].first,
                      sides[i].count);
}

bool splitter_split(struct splitter *s, int worker, struct range *r,
                    struct range sides[2])
{
    struct split split;

    if (r->count <= 1u << bits_for(s, r))
        return false;
    split = find_split(s, &s->workers[worker].bins, r);
    if (is_leaf(s, r, &split))
        return false;
    if (split.axis < 0 && s->drops_copies) {
        drop_copies(s, r);
        if (r->count <= s->leaves->most)
            return false;
    }
    part(s, r, &split, sides);
    return true;
}

/* ---- by all threads ---- */

static void count_chunk(void *context, uint32_t chunk, int worker)
{
    const struct splitter *s = context;
    const struct range *r = s->range;
    uint32_t count = chunk_size(r->count, chunk);
    uint32_t right =
        split_count(&s->split, s->buffers[r->buffer] + r->first + chunk * CHUNK,
                    count);

    (void)worker;
    s->chunk_sides[chunk][0] = count - right;
    s->chunk_sides[chunk][1] = right;
}

/* Computes where the boxes of each chunk go: those of the left side from there
 * on, those of the right side before. */
static void place_chunks(struct splitter *s)
{
    const struct range *r = s->range;
    uint32_t left = r->first, right = r->first + r->count;

    for (uint32_t i = 0; i < chunks_of(r->count); i++) {
        uint32_t *sides = s->chunk_sides[i];
        uint32_t counts[2] = {sides[0], sides[1]};

        sides[0] = left;
        sides[1] = right;
        left += counts[0];
        right -= counts[1];
    }
    begin_sides(r, left - r->first, s->sides);
}

static void part_chunk(void *context, uint32_t chunk, int worker)
{
    const struct splitter *s = context;
    const struct range *r = s->range;
    struct extent *extents = s->workers[worker].extents;
    struct box *to = s->buffers[r->buffer ^ 1];
    struct box *left = to + s->chunk_sides[chunk][0];
    struct box *right = to + s->chunk_sides[chunk][1];
    uint32_t count = chunk_size(r->count, chunk);
    uint32_t left_count =
        split_part(&s->split, s->buffers[r->buffer] + r->first + chunk * CHUNK,
                   count, left, right);

    add_extent(&extents[0], left, left_count);
    add_extent(&extents[1], right - (count - left_count), count - left_count);
}

void splitter_split_together(struct splitter *s, const struct range *r,
                             struct range sides[2])
{
    uint32_t chunk_count = chunks_of(r->count);

    s->range = r;
    s->sides = sides;
    s->split = find_split(s, &s->workers[0].bins, r);
    if (s->split.axis < 0) {
        part(s, r, &s->split, sides);
        return;
    }
    pool_each(s->pool, chunk_count, count_chunk, s);
    place_chunks(s);
    clear_extents(s);
    pool_each(s->pool, chunk_count, part_chunk, s);
    for (int i = 0; i < 2; i++)
        sides[i].extent = join_extents(s, i);
}

/* ---- the whole ---- */

bool splitter_init(struct splitter *s, const struct world *w,
                   const struct bvh_leaves *leaves, struct pool *pool)
{
    uint32_t count = w->settings.tri_count;

    *s = (struct splitter){.leaves = leaves, .pool = pool, .world = w};
    s->drops_copies = may_drop_copies(w);
    s->worker_count = pool != NULL ? (uint32_t)pool_thread_count(pool) : 1;
    s->workers = alloc_aligned(s->worker_count, sizeof *s->workers);
    s->chunk_sides = alloc_aligned(chunks_of(count), sizeof *s->chunk_sides);
    for (int i = 0; i < 2; i++)
        s->buffers[i] = alloc_aligned(count, sizeof *s->buffers[i]);
    return s->workers != NULL && s->chunk_sides != NULL &&
           s->buffers[0] != NULL && s->buffers[1] != NULL;
}

void splitter_free(struct splitter *s)
{
    free(s->workers);
    free(s->chunk_sides);
    free(s->buffers[0]);
    free(s->buffers[1]);
}
