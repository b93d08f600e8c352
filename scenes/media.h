// SPDX-License-Identifier: MIT
/*
 * media.h - scenes in which light is scattered in fog, stone and milk
 *
 * Threads:   one
 * Errors:    stop the program with a message
 */
#ifndef SCENES_MEDIA_H
#define SCENES_MEDIA_H

/* Writes fog, busts and milk. */
void media_write(const char *folder);

#endif
