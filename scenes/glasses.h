// SPDX-License-Identifier: MIT
/*
 * glasses.h - scenes in which light comes through glass or paper
 *
 * Threads:   one
 * Errors:    stop the program with a message
 */
#ifndef SCENES_GLASSES_H
#define SCENES_GLASSES_H

/* Writes globe, bulb, lantern, water and prism. */
void glasses_write(const char *folder);

#endif
