// SPDX-License-Identifier: MIT
/*
 * wire.h - messages between ranks, over MPI
 *
 * Rank 0 sends orders, and a word that cancels bands; workers send an answer
 * for each band. The bytes of a film follow its order or answer in the same
 * message. All ranks have processors with the lowest byte first.
 *
 * Units:     bytes
 * Ownership: messages that are received are for free()
 * Threads:   one at a time
 * Errors:    MPI ends the job when a rank or the connection to it is lost, or
 *            without memory for a message
 */
#ifndef GLIM_WIRE_H
#define GLIM_WIRE_H

#include "render/cluster/band.h"
#include "world/world.h"

/* The largest message. */
#define WIRE_BYTES_MAX ((size_t)1 << 30)

enum order_kind { ORDER_BEGIN, ORDER_LIGHT, ORDER_BAND, ORDER_END };

struct rank_order {
    enum order_kind kind;
    /* ORDER_BEGIN: a picture. The arrays whose versions differ from those of
     * the last one are broadcast behind it. */
    uint64_t versions[WORLD_PARTS];
    uint64_t sizes[WORLD_LIST_COUNT]; /* of the arrays; 0 if it is NULL */
    struct settings settings;
    int width, x0, y0; /* the film: its width, its corner in the picture */
    bool has_surfaces;
    uint64_t first_sample;
    /* ORDER_LIGHT: what light paths bring to the bands that follow. Its pixels,
     * grids and cells are broadcast behind it. */
    struct pass_light light;
    /* ORDER_BAND: rows of the film. The pixels' numbers of samples follow
     * unless all have `before`, then the shares. */
    uint32_t epoch; /* bands up to a cancelled epoch get empty answers */
    struct band_range range;
    bool has_counts, has_shares;
    uint64_t before;
};

/* The arrays of pass_light that are broadcast. */
enum { LIGHT_PIXELS, LIGHT_GRIDS, LIGHT_CELLS, LIGHT_ARRAYS };

/* Returns the size of an array of the light, and the array. */
static inline size_t light_array(const struct pass_light *light, int index,
                                 const void **bytes)
{
    const void *const arrays[LIGHT_ARRAYS] = {light->pixels, light->grids,
                                              light->cells};
    const size_t sizes[LIGHT_ARRAYS] = {
        6 * light->pixel_count * sizeof *light->pixels,
        light->grids != NULL ? CELL_GRIDS * sizeof *light->grids : 0,
        light->cell_count * sizeof *light->cells};

    *bytes = arrays[index];
    return sizes[index];
}

enum wire_tag { WIRE_ORDER = 1, WIRE_CANCEL, WIRE_ANSWER };

/* Starts MPI, and with ranks above 1 the other ranks: cluster.h. */
bool wire_begin(int ranks, const char *const *arguments, struct error *err);

/* Finds whether all ranks have this number. *rank is one that has another
 * number if not. */
bool wire_agree(uint64_t number, int *rank);

int wire_size(void);
int wire_rank(void);

/* Begins to send a copy of the bytes. */
void wire_post(int rank, enum wire_tag tag, const void *bytes, size_t size);

/* Begins to send bytes for free(), which belong to the message from now on. */
void wire_give(int rank, enum wire_tag tag, void *bytes, size_t size);

/* Returns the next message with this tag if all of it is there, or NULL. *rank
 * is its sender. Messages of a rank come in the order of their sending. */
void *wire_take(int *rank, enum wire_tag tag, size_t *size);

/* Lets messages move on. Returns true while some are on their way from or to
 * this rank. */
bool wire_is_moving(void);

/* Sends bytes from rank 0 to all others, which call it with room for them. */
void wire_broadcast(void *bytes, size_t size);

/* Returns the time to rest between two looks for messages, in nanoseconds, if
 * this rank renders at the same time or not: each look takes a moment of the
 * cores, and messages move at looks alone. */
long wire_rest_ns(bool is_rendering);

/* Ends MPI, or at once the whole job. */
void wire_end(bool ends_job);

#endif
