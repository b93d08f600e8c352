// SPDX-License-Identifier: MIT
/*
 * lamp.h - lights that are no surfaces: points, spots and directions, and their
 * emission profiles
 *
 * Definitions are those of glTF's KHR_lights_punctual, in glim's units. A
 * surface of area A and radiance L has seen from afar the intensity L A.
 * Profiles do not change after they were made, so that copies of a view share
 * them.
 *
 * Units:     file units, degrees; intensity is radiance times area, irradiance
 *            is of a surface that faces the light; a profile has factors of the
 *            intensity, in the rows and columns of PROFILE_ROWS in
 *            kernels/types.h
 * Ownership: lamps_free() frees; a zeroed list is empty; profile_create() and
 *            profile_share() return a reference for profile_release()
 * Threads:   one thread at a time; any for profiles
 * Errors:    false, or NULL for a profile, when memory is out
 */
#ifndef GLIM_LAMP_H
#define GLIM_LAMP_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "kernels/types.h"

/* ---- profiles ---- */

struct profile {
    atomic_uint references;
    uint32_t columns;
    float *values;
    char *path; /* of its file */
};

/* Makes a profile with room for its values. */
struct profile *profile_create(const char *path, uint32_t columns);

/* Makes one that emits the same in all directions. */
struct profile *profile_create_even(const char *path);

/* Both accept NULL. */
struct profile *profile_share(struct profile *profile);
void profile_release(struct profile *profile);

/* Returns true if paths and values are the same; NULL equals NULL. */
bool profiles_equal(const struct profile *a, const struct profile *b);

static inline uint32_t profile_value_count(const struct profile *profile)
{
    return PROFILE_ROWS * profile->columns;
}

/* ---- lamps ---- */

enum lamp_kind { LAMP_POINT, LAMP_SPOT, LAMP_DIRECTIONAL };

#define LAMP_KINDS 3

struct lamp {
    uint32_t kind;      /* enum lamp_kind */
    double position[3]; /* of points and spots */
    double at[3];       /* point to which a spot is turned */
    double rgb[3];      /* intensity; of a direction: irradiance */
    double radius;      /* above 0: a sphere of this radius */
    double inner_deg;   /* angles from a spot's axis, between which its light */
    double outer_deg;   /* falls to 0 */
    double azimuth_deg; /* direction to the light, as that of struct sun */
    double elevation_deg;
    double angle_deg; /* above 0: a disc of this diameter */
    /* of points and spots: a factor of the intensity in each direction, or
     * NULL. Angle 0 is straight down, or the axis of a spot. */
    struct profile *profile;
};

/* Units of the intensities that a file has. */
enum light_unit {
    LIGHT_UNIT_OF_FILE, /* as its reader decides */
    LIGHT_UNIT_LUMEN,   /* candela and lux, with 683 lm for a watt */
    LIGHT_UNIT_WATT,    /* the power of a lamp, the irradiance of a direction */
    LIGHT_UNIT_NONE     /* those of glim */
};
#define LIGHT_UNITS 4

/* Their names in view files. */
extern const char *const light_units[LIGHT_UNITS];

/* Returns the factor that makes intensities those of glim. */
double light_unit_factor(enum light_unit unit, bool is_directional);

struct lamps {
    struct lamp *items;
    uint32_t count;
};

/* Sets the defaults of a kind, without a profile: intensity or irradiance 1,
 * and a spot's angles of 0 and 45 degrees. */
void lamp_init(struct lamp *lamp, enum lamp_kind kind);

/* Computes the direction to a directional light, and sets it from one of any
 * length. */
void lamp_direction(const struct lamp *lamp, double to[3]);
void lamp_set_direction(struct lamp *lamp, const double to[3]);

/* Appends a lamp and shares its profile. */
bool lamps_add(struct lamps *lamps, const struct lamp *lamp);

/* Changes intensities that were read in one unit to those of another. */
void lamps_change_unit(struct lamps *lamps, enum light_unit from,
                       enum light_unit to);

/* Removes lamp i. */
void lamps_remove(struct lamps *lamps, uint32_t i);

bool lamp_equal(const struct lamp *a, const struct lamp *b);
bool lamps_equal(const struct lamps *a, const struct lamps *b);

/* Replaces the contents of `to`; leaves them unchanged when memory is out. */
bool lamps_copy(struct lamps *to, const struct lamps *from);
void lamps_free(struct lamps *lamps);

#endif
