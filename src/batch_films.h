// SPDX-License-Identifier: MIT
/*
 * batch_films.h - glim info, glim merge and glim develop: films as text,
 * joined, and as pictures
 *
 * Threads:   main only
 * Errors:    damaged films, films of different pictures, unwritable outputs
 */
#ifndef GLIM_BATCH_FILMS_H
#define GLIM_BATCH_FILMS_H

#include "session/command_line.h"

/* Prints what each film is of. */
bool batch_films_info(const struct options *o, struct error *err);

/* Joins the films and writes a film or a picture. start_ns is that of the
 * program. */
bool batch_films_merge(const struct options *o, uint64_t start_ns,
                       struct error *err);

#endif
