// SPDX-License-Identifier: MIT
#include "render/cluster/cluster.h"

bool cluster_is_launched(void)
{
    return false;
}

bool cluster_begin(int ranks, const char *const *arguments, uint64_t version,
                   struct error *err)
{
    (void)ranks;
    (void)arguments;
    (void)version;
    return fail(err, "--ranks: found a program without MPI, expected one that "
                     "is built with make MPI=1");
}

int cluster_size(void)
{
    return 1;
}

int cluster_rank(void)
{
    return 0;
}

struct backend *cluster_backend_create(struct backend *local, struct error *err)
{
    (void)err;
    return local;
}

bool cluster_work(struct backend *local, struct error *err)
{
    (void)local;
    return fail(err, "found a program without MPI, expected a rank of one");
}

void cluster_end(bool has_failed)
{
    (void)has_failed;
}
