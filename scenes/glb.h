// SPDX-License-Identifier: MIT
/*
 * glb.h - writes models as binary glTF
 *
 * A model is built up from its parts, each of which has a number in its list.
 * Shapes are grids of points of a function of u and v from 0 to 1; their
 * normals are to the left of v seen along u, so that surfaces face outwards if
 * u goes around to the east and v up. Numbers are rounded, so that every
 * mathematical library gives the same file.
 *
 * Units:     metres, radians; y is up; candela and lux
 * Ownership: glb_free() frees; glb_write() does not
 * Threads:   one
 * Errors:    stop the program with a message
 */
#ifndef SCENES_GLB_H
#define SCENES_GLB_H

#include <stdint.h>

#include "mesh.h"

/* List of JSON values. */
struct glb_list {
    char *text;
    size_t size_bytes;
    uint32_t count;
};

struct glb {
    struct glb_list extensions, nodes, roots, meshes, materials, textures,
        images, samplers, accessors, views, cameras, lights, skins, animations;
    uint8_t *bytes; /* of the buffer */
    size_t size_bytes;
};

typedef struct point glb_function(const void *context, double u, double v);

/* Surface of a function. The optional members are what glTF calls them. */
struct glb_grid {
    int columns, rows; /* of quadrangles along u and v */
    glb_function *place;
    glb_function *target; /* place at the end of a morph, or NULL */
    const void *context;
    int joint_count;           /* joints along v, or 0 */
    double u_repeat, v_repeat; /* of texture coordinates */
};

/* Appends a value and returns its number. */
uint32_t glb_add(struct glb_list *list, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds the name of an extension, once. */
void glb_use(struct glb *g, const char *extension);

/* Appends numbers to the buffer as floats of `components` each, and returns
 * their accessor. */
uint32_t glb_floats(struct glb *g, const double *numbers, int count,
                    int components, const char *type);

/* Adds a PNG image of RGB bytes in sRGB, and returns its texture. Magnified
 * texels stay squares if is_pixels is 1. */
uint32_t glb_texture(struct glb *g, const uint8_t *rgb, int width, int height,
                     int is_pixels);

/* Writes the points and triangles of a grid, and returns the JSON members of a
 * part of a mesh, for free(). */
char *glb_shape(struct glb *g, const struct glb_grid *grid);

/* Writes points, three numbers each, with their normals, and the corners of
 * triangles, and returns the same. */
char *glb_triangles(struct glb *g, const double *places, const double *normals,
                    int count, const uint16_t *corners, int corner_count);

/* Adds a mesh of one shape, or of a grid. */
uint32_t glb_mesh_of(struct glb *g, const char *shape, uint32_t material);
uint32_t glb_mesh(struct glb *g, const struct glb_grid *grid,
                  uint32_t material);

/* Adds a root node of these JSON members. */
uint32_t glb_root(struct glb *g, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds an animation of channels and samplers, which stay the caller's. */
void glb_animation(struct glb *g, const char *name,
                   const struct glb_list *channels,
                   const struct glb_list *samplers);

/* Places a camera, and a light, which shines from `eye` to `at`. */
void glb_camera(struct glb *g, struct point eye, struct point at,
                double yfov_deg);
void glb_light(struct glb *g, struct point eye, struct point at,
               const char *light);

/* Writes FOLDER/NAME.glb. */
void glb_write(const struct glb *g, const char *folder, const char *name);
void glb_free(struct glb *g);

#endif
