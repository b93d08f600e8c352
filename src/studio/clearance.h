// SPDX-License-Identifier: MIT
/*
 * clearance.h - how far surfaces are from a camera, and where it is lost
 *
 * Rays go from the eye in fixed directions all around, through the world's
 * tree. A camera that leaves a room through its wall, or enters a solid, is
 * known by what it has passed and by what is around it then: how faces are
 * wound says nothing in files of strangers.
 *
 * Units:     file units of the scene
 * Ownership: scene and world stay the caller's
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_CLEARANCE_H
#define GLIM_CLEARANCE_H

#include "scene/world.h"

/* From this share of all directions on a place counts as closed. Measured: in
 * rooms and an arcade 0.98 and more, in the open 0.5 and less. */
#define CLEARANCE_ENCLOSED 0.75

/* Where the eye is. */
enum clearance_state {
    CLEARANCE_IN_SCENE,     /* what there is to see */
    CLEARANCE_OUTSIDE_ROOM, /* of a room, through its wall */
    CLEARANCE_INSIDE_SOLID, /* of a solid */
    CLEARANCE_OUT_OF_VIEW   /* nothing of the scene can be in the picture */
};

/* A zeroed struct knows nothing yet. */
struct clearance {
    bool is_known;
    double eye[3];
    double near; /* a tenth of all directions meets a surface within this
                    distance; INFINITY: fewer directions do at all */
    double box_distance; /* from the scene's box; 0 within it */
    double hit_share;    /* share of all directions that meet a surface */
    uint32_t passed; /* object of the last surface that the eye has passed */
    double passed_share; /* share of all directions that meet that object */
    enum clearance_state state;
};

/* Finds what is around the eye, which has come there on a straight way from
 * where the last call has found it. 65 rays, 15 us, and none where it has not
 * moved. A world without a tree has no surface. */
void clearance_update(struct clearance *c, const struct scene *scene,
                      const struct host_world *host, const struct pose *pose,
                      double aspect);

/* The eye has jumped: there was no way. */
void clearance_reset(struct clearance *c);

#endif
