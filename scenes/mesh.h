// SPDX-License-Identifier: MIT
/*
 * mesh.h - writes shapes as OBJ text
 *
 * Every closed shape is wound so that its normals point outwards, which glass
 * needs to tell inside from outside.
 *
 * Units:     scene units, degrees; y is up
 * Ownership: mesh_open() opens a file for mesh_close()
 * Threads:   one
 * Errors:    mesh_open(), mesh_close() and mesh_text() stop the program with a
 *            message
 */
#ifndef SCENES_MESH_H
#define SCENES_MESH_H

#include <stdio.h>

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

/* Subdivision of spheres: 1,280 triangles each. */
#define SEGMENTS 8

struct point {
    double x, y, z;
};

static inline struct point at(double x, double y, double z)
{
    return (struct point){x, y, z};
}

struct mesh {
    FILE *file;
    const char *name;
    unsigned v, vt, vn; /* written so far */
};

/* Begins FOLDER/NAME.obj with a comment and the name of its MTL file. */
struct mesh mesh_open(const char *folder, const char *name,
                      const char *comment);
void mesh_close(struct mesh *m);

/* Names what follows and the material it is of. */
void mesh_object(struct mesh *m, const char *object, const char *material);

/* Four corners, counter-clockwise seen from the front; the texture is repeated
 * u_repeat times along ab and v_repeat times along bc. */
void mesh_quad(struct mesh *m, struct point a, struct point b, struct point c,
               struct point d, double u_repeat, double v_repeat);

/* A box with the middle of its bottom at `foot`, turned about +y. */
void mesh_box(struct mesh *m, struct point foot, struct point size,
              double turn_deg);

/* 20 * segments^2 triangles with smooth normals. */
void mesh_sphere(struct mesh *m, struct point center, double radius,
                 int segments);

/* Turns a profile of (radius, height) pairs about the upright line through
 * `foot`. It runs with the solid at its left: from the bottom outwards and up.
 * Both ends are on the axis, or the same point for a ring. Corners above 50
 * degrees stay sharp. */
void mesh_lathe(struct mesh *m, struct point foot, const double (*profile)[2],
                int count, int segments);

/* Writes FOLDER/NAME.ENDING. */
void mesh_text(const char *folder, const char *name, const char *ending,
               const char *text);

#endif
