// SPDX-License-Identifier: MIT
/*
 * cluster.h - processes on one or more machines that render one picture: ranks
 *
 * Rank 0 is the program that the user sees. It has the scene, the film, the
 * terminal and the files. The others, its workers, have no files: they get the
 * arrays of the world from rank 0, so that all ranks have the same bits, and
 * render bands of rows for it. In a program that is built without MPI there is
 * rank 0 alone.
 *
 * Units:     bytes, pixels
 * Ownership: cluster_end() frees
 * Threads:   one at a time: the main thread, and the render thread while a
 *            picture renders
 * Errors:    no MPI, ranks that do not start or have another version of glim
 */
#ifndef GLIM_CLUSTER_H
#define GLIM_CLUSTER_H

#include "render/backend.h"

/* Returns true if mpirun or srun has started several ranks. */
bool cluster_is_launched(void);

/* Starts MPI. With ranks above 1 it starts the other ranks, as copies of this
 * program with these arguments, a list that ends with NULL; otherwise mpirun
 * has. `version` is the hash of the kernels, which is compared. */
bool cluster_begin(int ranks, const char *const *arguments, uint64_t version,
                   struct error *err);

/* Returns the number of ranks; 1 before cluster_begin(). */
int cluster_size(void);

/* Returns the rank of this process. */
int cluster_rank(void);

/* Returns a backend that renders with all ranks, on rank 0. It owns `local`,
 * the backend of this process. Returns NULL and frees nothing without memory.
 */
struct backend *cluster_backend_create(struct backend *local,
                                       struct error *err);

/* Renders for rank 0 until that ends. Returns false if MPI fails. */
bool cluster_work(struct backend *local, struct error *err);

/* Tells the other ranks to end, and ends MPI. A worker that has failed ends the
 * whole job. */
void cluster_end(bool has_failed);

#endif
