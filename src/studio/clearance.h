// SPDX-License-Identifier: MIT
/*
 * clearance.h - distance from the camera to the surfaces around it; detects a
 * camera that has left a room or entered a solid
 *
 * Rays are traced from the eye in fixed directions all around. Leaving a room
 * and entering a solid are detected by the surface that the eye has crossed and
 * by the hits around it afterwards. The winding of faces is not used, because
 * it is not reliable in scenes from other programs.
 *
 * Units:     file units of the scene
 * Ownership: scene and world stay the caller's
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_CLEARANCE_H
#define GLIM_CLEARANCE_H

#include "scene/world.h"

/* Share of directions with a hit from which a place counts as enclosed.
 * Measured: at least 0.98 in rooms and an arcade, at most 0.5 outdoors. */
#define CLEARANCE_ENCLOSED 0.75

/* Location of the eye. */
enum clearance_state {
    CLEARANCE_IN_SCENE,     /* the normal case */
    CLEARANCE_OUTSIDE_ROOM, /* left a room through its wall */
    CLEARANCE_INSIDE_SOLID, /* entered a solid object */
    CLEARANCE_OUT_OF_VIEW   /* no part of the scene in the picture */
};

/* Result of the last update. A zeroed struct has none. */
struct clearance {
    bool is_known;
    double eye[3];
    /* distance within which a tenth of all directions hit a surface; INFINITY
     * if fewer hit any */
    double near;
    double box_distance; /* distance to the scene's bounding box; 0 inside */
    double hit_share;    /* share of directions that hit a surface */
    /* object whose surface the eye crossed last */
    uint32_t passed;
    double passed_share; /* share of directions that hit that object */
    enum clearance_state state;
};

/* Updates *c for the eye of `pose`, which has moved there in a straight line
 * from the eye of the last call. Traces 65 rays, in 15 us, or none if the eye
 * has not moved. A world without a tree has no surfaces. */
void clearance_update(struct clearance *c, const struct scene *scene,
                      const struct host_world *host, const struct pose *pose,
                      double aspect);

/* Resets *c after the eye has jumped, so that no surface counts as crossed. */
void clearance_reset(struct clearance *c);

#endif
