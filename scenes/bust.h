// SPDX-License-Identifier: MIT
/*
 * bust.h - the bust of a woman, as triangles
 *
 * Units:     metres; y is up, the foot at 0, and the face to +z
 * Ownership: bust_make() allocates for bust_free()
 * Threads:   one
 * Errors:    stops the program with a message
 */
#ifndef SCENES_BUST_H
#define SCENES_BUST_H

#include <stdint.h>

struct bust {
    double *places, *normals; /* three numbers for each point */
    uint16_t *corners;        /* of triangles, counter-clockwise */
    int point_count, corner_count;
};

struct bust bust_make(void);
void bust_free(struct bust *b);

#endif
