// SPDX-License-Identifier: MIT
/*
 * obj_runs.h - runs of plain lines in OBJ text, read by all threads
 *
 * A plain line is a v, vt, vn or f statement without anything that the parser
 * has to report or to look up: numbers that are finite, indices from 1 on, and
 * no colour, comment or join. Their meaning does not depend on other lines but
 * for the count of vertices, so that threads read blocks of the text in
 * advance. All other lines, and runs that do not fit, are left to the parser.
 *
 * Units:     file units
 * Ownership: obj_runs_read() owns the blocks; texts stay the caller's
 * Threads:   one thread, which uses a pool
 * Errors:    memory; a line that is not plain is left to the parser
 */
#ifndef GLIM_OBJ_RUNS_H
#define GLIM_OBJ_RUNS_H

#include "base/thread_pool.h"
#include "read/face_tris.h"

/* The lists of vertices, in the order of a corner's indices. */
enum obj_list { OBJ_V, OBJ_VT, OBJ_VN, OBJ_LISTS };

/* Consecutive plain lines. What they hold begins at these indices in the arrays
 * of the block, and ends where the next run begins. */
struct obj_run {
    const char *begin, *end;
    uint32_t line_count;
    uint32_t first[OBJ_LISTS], first_face, first_corner;
    /* the least counts of vertices before the run for which its indices are in
     * range, negative ones included */
    int64_t needed[OBJ_LISTS];
    bool has_polygons; /* a face has more than three corners */
};

/* Where the corners of a face end in those of the block, and its line from the
 * beginning of the run. */
struct obj_face {
    uint32_t corner_end, line;
};

struct obj_block {
    const char *begin, *end;
    struct obj_run *runs; /* one more than run_count, which is empty */
    uint32_t run_count;
    double *positions;
    struct vec2 *uvs;
    struct vec3 *normals;
    struct obj_face *faces;
    struct corner *corners;
    uint32_t counts[OBJ_LISTS], face_count, corner_count;
    size_t run_capacity, position_capacity, uv_capacity, normal_capacity,
        face_capacity, corner_capacity;
};

/* Consecutive blocks of a text, up to `end`. */
struct obj_blocks {
    struct obj_block *items;
    uint32_t count;
    const char *end;
};

/* Takes the runs of blocks. Returns false to end the reading. */
typedef bool obj_take_blocks(void *context, const struct obj_blocks *blocks);

/* Reads a text, of which `from` begins a line, and calls `take` for all of its
 * blocks in order, by any thread of the pool: one takes blocks while the others
 * read the next ones. Without a pool the calling thread does both, and without
 * memory `take` gets the text without blocks. Returns what its last call did.
 */
bool obj_runs_read(const char *from, const char *end, struct pool *pool,
                   obj_take_blocks *take, void *context);

/* Returns true if the scene can take the run: its indices are in range, and all
 * counts. */
bool obj_run_fits(const struct obj_run *run, const struct face_tris *faces);

/* What the triangles of a run belong to. */
struct obj_run_place {
    uint32_t object, material;
    uint64_t line; /* of the run */
};

/* Appends the vertices and triangles of a run that fits to the scene of
 * `faces`, whose vertices are finite. Returns false when memory is out. */
bool obj_run_take(const struct obj_block *b, const struct obj_run *run,
                  struct face_tris *faces, size_t capacities[OBJ_LISTS],
                  struct obj_run_place at);

#endif
