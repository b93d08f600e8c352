// SPDX-License-Identifier: MIT
/*
 * wire.h - messages between ranks, over MPI
 *
 * Rank 0 sends orders, and a word that cancels bands; workers send an answer
 * for each band. The arrays of an order or an answer follow it as bytes. All
 * ranks have processors with the lowest byte first.
 *
 * Units:     bytes
 * Threads:   one at a time
 * Errors:    MPI ends the job when a rank or the connection to it is lost
 */
#ifndef GLIM_WIRE_H
#define GLIM_WIRE_H

#include "cluster/band.h"
#include "scene/world_list.h"

enum order_kind { ORDER_BEGIN, ORDER_BAND, ORDER_END };

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
    /* ORDER_BAND: rows of the film, whose numbers of samples and shares follow
     */
    uint32_t epoch; /* bands up to a cancelled epoch get empty answers */
    int y, rows;
    bool has_shares;
    struct pass pass;
};

struct rank_answer {
    uint32_t epoch; /* of the band */
    uint32_t has_failed;
    char error[256];
    int width, y, rows;
    bool has_surfaces;
    /* counters; the arrays of the film follow if there are samples */
    uint64_t samples, rays, non_finite, saturated, cut_paths;
};

enum wire_tag { WIRE_ORDER = 1, WIRE_CANCEL, WIRE_ANSWER, WIRE_DATA };

/* Starts MPI, and with ranks above 1 the other ranks: cluster.h. */
bool wire_begin(int ranks, char *const *arguments, struct error *err);

/* Finds whether all ranks have this number. *rank is one that has another
 * number if not. */
bool wire_agree(uint64_t number, int *rank);

int wire_size(void);
int wire_rank(void);

/* Sends bytes to a rank and returns when they may be reused. */
void wire_send(int rank, enum wire_tag tag, const void *bytes, size_t size);

/* Begins to send a copy of the bytes. Rank 0 sends in this way: a worker that
 * is lost takes no message, and one that sends a large one itself waits until
 * it is received. */
void wire_post(int rank, enum wire_tag tag, const void *bytes, size_t size);

/* Returns true if all that was posted is sent, and frees what is. */
bool wire_is_sent(void);

/* Receives bytes of this size. Blocks. */
void wire_receive(int rank, enum wire_tag tag, void *bytes, size_t size);

/* Returns true if a message with the tag is there, from *rank, or from any rank
 * if it is negative, which is then set. */
bool wire_has(int *rank, enum wire_tag tag);

/* Sends bytes from rank 0 to all others, which call it with room for them. */
void wire_broadcast(void *bytes, size_t size);

/* Sleeps for a moment in which a message may come, so that waiting ranks take
 * no processor time. */
void wire_rest(void);

/* Ends MPI, or at once the whole job. */
void wire_end(bool ends_job);

#endif
