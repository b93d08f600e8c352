// SPDX-License-Identifier: MIT
/*
 * world_hash.h - hashes of a world, by which films of the same picture are
 * known
 *
 * All that decides the bits of samples counts, and nothing else: files with
 * other comments, in other folders, or in other formats make equal worlds.
 * Trees and features, which only decide the speed, do not count.
 *
 * Threads:   any, while nobody changes the world
 */
#ifndef GLIM_WORLD_HASH_H
#define GLIM_WORLD_HASH_H

#include "picture/film_header.h"
#include "kernels/types.h"

/* Sets the hashes of a lent world, except that of the kernels. */
void world_hash(const struct world *world, uint64_t hashes[FILM_PARTS]);

#endif
