// SPDX-License-Identifier: MIT
#include "cluster/wire.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <mpi.h>

#include "base/memory.h"

/* Size of a message; MPI counts bytes with int. */
#define MESSAGE_BYTES ((size_t)1 << 30)

/* Time between looks for messages. */
#define REST_NS 200000

/* Time for rank 0 to end. */
#define END_NS 300000000

static MPI_Comm ranks_of_all;
static MPI_Comm spawned; /* between rank 0 and the ranks that it has started */
static bool has_begun;
/* Messages that are being sent. */
static struct message {
    MPI_Request request;
    void *bytes;
} * posted;
static size_t posted_count, posted_capacity;
static int size = 1, rank;

/* Starts copies of this program and joins them to one group. */
static bool spawn(int ranks, char *const *arguments, struct error *err)
{
    char program[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);

    if (length < 0)
        return fail(err, "--ranks: cannot find this program");
    program[length] = '\0';
    MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN);
    if (MPI_Comm_spawn(program, (char **)(uintptr_t)arguments, ranks - 1,
                       MPI_INFO_NULL, 0, MPI_COMM_SELF, &spawned,
                       MPI_ERRCODES_IGNORE) != MPI_SUCCESS)
        return fail(err, "--ranks: MPI cannot start %d more ranks", ranks - 1);
    MPI_Intercomm_merge(spawned, 0, &ranks_of_all);
    return true;
}

bool wire_begin(int ranks, char *const *arguments, struct error *err)
{
    int level;

    /* Open MPI starts no more ranks than there are cores, unless it is told;
     * these are as many as the user wants */
    setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 0);
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level) !=
        MPI_SUCCESS)
        return fail(err, "MPI cannot start");
    has_begun = true;
    MPI_Comm_get_parent(&spawned);
    ranks_of_all = MPI_COMM_WORLD;
    if (level < MPI_THREAD_SERIALIZED)
        return fail(err, "MPI: found support for one thread, expected one that "
                         "lets threads take turns");
    if (spawned != MPI_COMM_NULL)
        MPI_Intercomm_merge(spawned, 1, &ranks_of_all);
    else if (ranks > 1 && !spawn(ranks, arguments, err))
        return false;
    MPI_Comm_size(ranks_of_all, &size);
    MPI_Comm_rank(ranks_of_all, &rank);
    return true;
}

bool wire_agree(uint64_t number, int *other)
{
    uint64_t first = number;
    int mine, least;

    MPI_Bcast(&first, 1, MPI_UINT64_T, 0, ranks_of_all);
    mine = first == number ? INT_MAX : rank;
    MPI_Allreduce(&mine, &least, 1, MPI_INT, MPI_MIN, ranks_of_all);
    *other = least;
    return least == INT_MAX;
}

int wire_size(void)
{
    return size;
}

int wire_rank(void)
{
    return rank;
}

void wire_send(int to, enum wire_tag tag, const void *bytes, size_t count)
{
    const char *p = bytes;

    do {
        size_t part = count < MESSAGE_BYTES ? count : MESSAGE_BYTES;

        MPI_Send(p, (int)part, MPI_BYTE, to, (int)tag, ranks_of_all);
        p += part;
        count -= part;
    } while (count > 0);
}

void wire_post(int to, enum wire_tag tag, const void *bytes, size_t count)
{
    const char *p = bytes;

    do {
        size_t part = count < MESSAGE_BYTES ? count : MESSAGE_BYTES;
        void *array = posted;
        struct message m = {.bytes = alloc_array(part, 1)};

        if (m.bytes == NULL || !grow_array(&array, &posted_capacity,
                                           posted_count + 1, sizeof *posted))
            MPI_Abort(ranks_of_all, 1);
        posted = array;
        memcpy(m.bytes, p, part);
        MPI_Isend(m.bytes, (int)part, MPI_BYTE, to, (int)tag, ranks_of_all,
                  &m.request);
        posted[posted_count++] = m;
        p += part;
        count -= part;
    } while (count > 0);
}

bool wire_is_sent(void)
{
    size_t left = 0;

    for (size_t i = 0; i < posted_count; i++) {
        int is_sent;

        MPI_Test(&posted[i].request, &is_sent, MPI_STATUS_IGNORE);
        if (is_sent)
            free(posted[i].bytes);
        else
            posted[left++] = posted[i];
    }
    posted_count = left;
    return left == 0;
}

void wire_receive(int from, enum wire_tag tag, void *bytes, size_t count)
{
    char *p = bytes;

    do {
        size_t part = count < MESSAGE_BYTES ? count : MESSAGE_BYTES;

        MPI_Recv(p, (int)part, MPI_BYTE, from, (int)tag, ranks_of_all,
                 MPI_STATUS_IGNORE);
        p += part;
        count -= part;
    } while (count > 0);
}

bool wire_has(int *from, enum wire_tag tag)
{
    MPI_Status status;
    int is_there;

    MPI_Iprobe(*from < 0 ? MPI_ANY_SOURCE : *from, (int)tag, ranks_of_all,
               &is_there, &status);
    if (is_there)
        *from = status.MPI_SOURCE;
    return is_there != 0;
}

void wire_broadcast(void *bytes, size_t count)
{
    char *p = bytes;

    for (size_t part; count > 0; p += part, count -= part) {
        part = count < MESSAGE_BYTES ? count : MESSAGE_BYTES;
        MPI_Bcast(p, (int)part, MPI_BYTE, 0, ranks_of_all);
    }
}

void wire_rest(void)
{
    nanosleep(&(struct timespec){.tv_nsec = REST_NS}, NULL);
}

/* Waits for a while until all is sent. */
static bool is_sent_soon(void)
{
    for (int i = 0; i < END_NS / REST_NS; i++) {
        if (wire_is_sent())
            return true;
        wire_rest();
    }
    return false;
}

void wire_end(bool ends_job)
{
    if (!has_begun)
        return;
    /* a rank that is lost takes no messages, and MPI would wait for it */
    if (size > 1 && (ends_job || !is_sent_soon()))
        MPI_Abort(ranks_of_all, 1);
    /* ranks that rank 0 has started would be disconnected first, but in Open
     * MPI 4.1 MPI_Comm_disconnect() then never returns. They end after rank 0,
     * which otherwise reports a broken connection. */
    if (spawned != MPI_COMM_NULL && rank > 0)
        nanosleep(&(struct timespec){.tv_nsec = END_NS}, NULL);
    MPI_Finalize();
    free(posted);
    posted = NULL;
    has_begun = false;
    size = 1;
}
