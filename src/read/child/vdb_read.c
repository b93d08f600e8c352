// SPDX-License-Identifier: MIT
#include "read/child/vdb_read.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "read/vdb.h"

/* zlib unpacks 100 MB/s at least. A byte of packed values can stand for more
 * than a thousand, as memory_budget_add_file() allows. */
#define BYTES_A_SECOND   1000000
#define MEMORY_OF_A_BYTE 1600

/* ---- the stream ---- */

static bool fail_stream(const char *what, struct error *err)
{
    return fail(err, "found %s in what its reader sent", what);
}

/* Takes an array out of the stream. */
static bool take_array(const char **p, void *array, uint64_t count,
                       size_t item_bytes, struct error *err)
{
    void *items = alloc_array(count, item_bytes);

    if (items == NULL)
        return fail(err, "out of memory for its voxels");
    memcpy(array, &items, sizeof items);
    memcpy(items, *p, count * item_bytes);
    *p += count * item_bytes;
    return true;
}

/* Returns true if `left_bytes` are those of the arrays. */
static bool has_size(const struct voxel_grid *g, uint64_t left_bytes)
{
    uint64_t places = g->sides[0];

    for (int a = 1; a < 3; a++) {
        if (places > BRICK_PLACES_MAX)
            return false;
        places *= g->sides[a];
    }
    return places <= BRICK_PLACES_MAX && g->brick_count > 0 &&
           left_bytes ==
               places * (sizeof *g->index + sizeof *g->majorants) +
                   (uint64_t)g->brick_count * BRICK_VOXELS * sizeof *g->values;
}

static bool are_numbers(const float *numbers, uint64_t count, float most)
{
    for (uint64_t i = 0; i < count; i++)
        if (!(fabsf(numbers[i]) <= most))
            return false;
    return true;
}

static bool check_numbers(const struct voxel_grid *g, struct error *err)
{
    uint64_t places = voxel_grid_place_count(g);

    for (uint64_t i = 0; i < places; i++)
        if (g->index[i] >= g->brick_count)
            return fail_stream("a place without its brick", err);
    for (int i = 0; i < 12; i++)
        if (!isfinite(g->to_world.m[i / 4][i % 4]))
            return fail_stream("a transform without numbers", err);
    return (are_numbers(&g->background, 1, VOXEL_VALUE_MAX) &&
            are_numbers(g->values, (uint64_t)g->brick_count * BRICK_VOXELS,
                        VOXEL_VALUE_MAX) &&
            are_numbers(g->majorants, places, 2 * VOXEL_VALUE_MAX)) ||
           fail_stream("voxels without numbers", err);
}

bool vdb_stream_read(struct voxel_grid *grid, const char *bytes,
                     size_t size_bytes, struct error *err)
{
    const char *p = bytes + sizeof *grid;
    uint64_t places;

    memset(grid, 0, sizeof *grid);
    if (size_bytes < sizeof *grid)
        return fail_stream("no end", err);
    memcpy(grid, bytes, sizeof *grid);
    grid->index = NULL;
    grid->majorants = NULL;
    grid->values = NULL;
    if (!has_size(grid, size_bytes - sizeof *grid))
        return fail_stream("another end", err);
    places = voxel_grid_place_count(grid);
    return take_array(&p, &grid->index, places, sizeof *grid->index, err) &&
           take_array(&p, &grid->majorants, places, sizeof *grid->majorants,
                      err) &&
           take_array(&p, &grid->values,
                      (uint64_t)grid->brick_count * BRICK_VOXELS,
                      sizeof *grid->values, err) &&
           check_numbers(grid, err);
}

static bool send(const struct voxel_grid *g, FILE *to, struct error *err)
{
    uint64_t places = voxel_grid_place_count(g);
    struct voxel_grid head = *g;

    head.index = NULL;
    head.majorants = NULL;
    head.values = NULL;
    fwrite(&head, sizeof head, 1, to);
    fwrite(g->index, sizeof *g->index, places, to);
    fwrite(g->majorants, sizeof *g->majorants, places, to);
    fwrite(g->values, sizeof *g->values * BRICK_VOXELS, g->brick_count, to);
    return (fflush(to) == 0 && !ferror(to)) ||
           fail(err, "its voxels could not be sent: %s", strerror(errno));
}

/* ---- both sides ---- */

static bool read_and_send(const char *path, FILE *to, struct error *err)
{
    struct voxel_grid grid = {.index = NULL};
    char *name = NULL, *bytes = NULL;
    size_t name_bytes, size_bytes;
    bool ok = file_read_stdin(&name, &name_bytes, err) &&
              file_read(path, &bytes, &size_bytes, err) &&
              vdb_parse(&grid, bytes, size_bytes, name, err) &&
              send(&grid, to, err);

    voxel_grid_free(&grid);
    free(bytes);
    free(name);
    return ok;
}

bool vdb_child(const char *path, struct library_limits limits, FILE *to)
{
    struct error err;

    library_child_limit(limits);
    return read_and_send(path, to, &err) || library_child_fail(to, &err);
}

bool vdb_read(struct voxel_grid *grid, const char *path, const char *name,
              const char *program, struct error *err)
{
    struct library_task task = {
        .library = "its reader",
        .program = program,
        .option = "--voxels",
        .path = path,
        .words = name != NULL ? name : "",
        .bytes_a_second = BYTES_A_SECOND,
        .memory_of_a_byte = MEMORY_OF_A_BYTE,
    };
    struct child_result result = {.output = NULL};
    struct error own;
    bool ok;

    memset(grid, 0, sizeof *grid);
    if (!file_measure(path, &task.size_bytes, err))
        return false;
    if (program == NULL)
        return fail(err, "%s: found a file that only the program glim reads",
                    path);
    ok = (library_child_run(&task, &result, &own) &&
          vdb_stream_read(grid, result.output, result.size_bytes, &own)) ||
         fail(err, "%s: %s", path, own.text);
    free(result.output);
    return ok;
}
