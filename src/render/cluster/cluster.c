// SPDX-License-Identifier: MIT
#include "render/cluster/cluster.h"

#include <stdlib.h>

#include "render/cluster/wire.h"

/* Returns a number that the environment has, 0 if there is none. */
static int number_of(const char *name)
{
    const char *text = getenv(name);

    return text != NULL ? (int)strtol(text, NULL, 10) : 0;
}

bool cluster_is_launched(void)
{
    return number_of("OMPI_COMM_WORLD_SIZE") > 1 || number_of("PMI_SIZE") > 1 ||
           (getenv("PMIX_RANK") != NULL && number_of("SLURM_NTASKS") > 1);
}

bool cluster_begin(int ranks, const char *const *arguments, uint64_t version,
                   struct error *err)
{
    int other;

    if (!wire_begin(ranks, arguments, err))
        return false;
    return wire_agree(version, &other) ||
           fail(err,
                "rank %d: found another version of glim, expected that of "
                "rank 0",
                other);
}

int cluster_size(void)
{
    return wire_size();
}

int cluster_rank(void)
{
    return wire_size() > 1 ? wire_rank() : number_of("OMPI_COMM_WORLD_RANK");
}

void cluster_end(bool has_failed)
{
    const struct rank_order end = {.kind = ORDER_END};

    if (wire_size() > 1 && wire_rank() == 0)
        for (int rank = 1; rank < wire_size(); rank++)
            wire_post(rank, WIRE_ORDER, &end, sizeof end);
    wire_end(has_failed && wire_rank() > 0);
}
