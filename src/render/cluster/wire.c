// SPDX-License-Identifier: MIT
#include "render/cluster/wire.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <mpi.h>

#include "base/memory.h"
#include "base/print.h"

/* Time between looks for messages; less while one is on its way, or while
 * nothing is rendered. */
#define REST_NS       1000000
#define REST_SHORT_NS 200000

/* Time for rank 0 to end. */
#define END_NS 300000000

/* A message on its way. */
struct message {
    MPI_Request request;
    int rank;
    enum wire_tag tag;
    bool is_whole;
    void *bytes;
    size_t size;
};

/* Messages in the order of their sending or of their arrival. */
struct message_list {
    struct message *messages;
    size_t count, capacity;
};

static MPI_Comm ranks_of_all;
static MPI_Comm spawned; /* between rank 0 and the ranks that it has started */
static bool has_begun;
static struct message_list sent, received;
static int size = 1, rank;

/* Starts copies of this program and joins them to one group. */
static bool spawn(int ranks, const char *const *arguments, struct error *err)
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
        return fail(err, "--ranks: MPI cannot start %d more rank%s", ranks - 1,
                    print_plural((uint64_t)(ranks - 1)));
    MPI_Intercomm_merge(spawned, 0, &ranks_of_all);
    return true;
}

bool wire_begin(int ranks, const char *const *arguments, struct error *err)
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

/* ---- messages ---- */

static struct message *append(struct message_list *l)
{
    void *array = l->messages;

    if (!grow_array(&array, &l->capacity, l->count + 1, sizeof *l->messages))
        MPI_Abort(ranks_of_all, 1);
    l->messages = array;
    return &l->messages[l->count++];
}

static void removed(struct message_list *l, size_t i)
{
    l->count--;
    memmove(&l->messages[i], &l->messages[i + 1],
            (l->count - i) * sizeof *l->messages);
}

static void *room_for(size_t count)
{
    void *bytes = alloc_aligned(count, 1);

    if (bytes == NULL)
        MPI_Abort(ranks_of_all, 1);
    return bytes;
}

void wire_give(int to, enum wire_tag tag, void *bytes, size_t count)
{
    struct message *m = append(&sent);

    *m =
        (struct message){.rank = to, .tag = tag, .bytes = bytes, .size = count};
    MPI_Isend(bytes, (int)count, MPI_BYTE, to, (int)tag, ranks_of_all,
              &m->request);
}

void wire_post(int to, enum wire_tag tag, const void *bytes, size_t count)
{
    wire_give(to, tag, memcpy(room_for(count), bytes, count), count);
}

/* Begins to receive the messages with this tag that have arrived. */
static void receive(enum wire_tag tag)
{
    for (;;) {
        MPI_Message handle;
        MPI_Status status;
        struct message *m;
        int is_there, count;

        MPI_Improbe(MPI_ANY_SOURCE, (int)tag, ranks_of_all, &is_there, &handle,
                    &status);
        if (!is_there)
            return;
        MPI_Get_count(&status, MPI_BYTE, &count);
        m = append(&received);
        *m = (struct message){.rank = status.MPI_SOURCE,
                              .tag = tag,
                              .bytes = room_for((size_t)count),
                              .size = (size_t)count};
        MPI_Imrecv(m->bytes, count, MPI_BYTE, &handle, &m->request);
    }
}

static bool is_whole(struct message *m)
{
    int is_done;

    if (m->is_whole)
        return true;
    MPI_Test(&m->request, &is_done, MPI_STATUS_IGNORE);
    m->is_whole = is_done != 0;
    return m->is_whole;
}

/* Returns true if an older message of the same rank and tag is on its way. */
static bool is_overtaking(const struct message_list *l, size_t index)
{
    const struct message *m = &l->messages[index];

    for (size_t i = 0; i < index; i++)
        if (l->messages[i].rank == m->rank && l->messages[i].tag == m->tag)
            return true;
    return false;
}

void *wire_take(int *from, enum wire_tag tag, size_t *count)
{
    receive(tag);
    for (size_t i = 0; i < received.count; i++) {
        struct message *m = &received.messages[i];
        void *bytes = m->bytes;

        if (m->tag != tag || !is_whole(m) || is_overtaking(&received, i))
            continue;
        *from = m->rank;
        *count = m->size;
        removed(&received, i);
        return bytes;
    }
    return NULL;
}

bool wire_is_moving(void)
{
    bool is_moving;

    for (size_t i = 0; i < sent.count;) {
        if (!is_whole(&sent.messages[i])) {
            i++;
            continue;
        }
        free(sent.messages[i].bytes);
        removed(&sent, i);
    }
    is_moving = sent.count > 0;
    for (size_t i = 0; i < received.count; i++)
        is_moving = !is_whole(&received.messages[i]) || is_moving;
    return is_moving;
}

void wire_broadcast(void *bytes, size_t count)
{
    char *p = bytes;

    for (size_t part; count > 0; p += part, count -= part) {
        part = count < WIRE_BYTES_MAX ? count : WIRE_BYTES_MAX;
        MPI_Bcast(p, (int)part, MPI_BYTE, 0, ranks_of_all);
    }
}

long wire_rest_ns(bool is_rendering)
{
    return is_rendering && !wire_is_moving() ? REST_NS : REST_SHORT_NS;
}

/* Waits for a while until all is sent. */
static bool is_sent_soon(void)
{
    for (int i = 0; i < END_NS / REST_SHORT_NS; i++) {
        wire_is_moving();
        if (sent.count == 0)
            return true;
        nanosleep(&(struct timespec){.tv_nsec = REST_SHORT_NS}, NULL);
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
    free(sent.messages);
    free(received.messages);
    sent = received = (struct message_list){0};
    has_begun = false;
    size = 1;
}
