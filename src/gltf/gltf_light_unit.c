// SPDX-License-Identifier: MIT
#include "gltf/gltf_light_unit.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "gltf/gltf_value.h"

/* First version of Blender's exporter that has modes. */
#define MODES_MAJOR 3
#define MODES_MINOR 4

/* Relative errors of powers: of the floats that Blender has, and of those files
 * that have six digits of an intensity at most. */
#define FLOAT_ERROR  1e-7
#define SHORT_ERROR  1e-5
#define SHORT_DIGITS 6

/* Digits of round powers. A number is round by chance with a probability of
 * about its error times 10 to the power of the digits, for each unit: one in a
 * hundred is certain enough, and more than one in ten tells nothing. */
#define DIGITS_MOST 6
#define CHANCE_SURE 0.011
#define CHANCE_MOST 0.11

/* Units in the order in which they are guessed: Blender's default first. */
static const enum light_unit units[] = {LIGHT_UNIT_LUMEN, LIGHT_UNIT_NONE,
                                        LIGHT_UNIT_WATT};
#define UNITS (sizeof units / sizeof units[0])

/* Reads the version behind the name, such as "Khronos glTF Blender I/O
 * v4.0.44". */
static bool read_version(const char *name, uint64_t *major, uint64_t *minor)
{
    const char *p = strstr(name, " v");

    if (p == NULL)
        return false;
    p += 2;
    if (!digits_parse(&p, 10, 1000, major) || *p != '.')
        return false;
    p++;
    return digits_parse(&p, 10, 1000, minor);
}

/* Returns true if the number has this many digits at most, but for an error. */
static bool is_round(double number, int digits, double error)
{
    double scaled = number * pow(10, digits - 1 - floor(log10(number) + error));

    return fabs(scaled - round(scaled)) <= error * scaled;
}

/* Returns the probability that the powers of all lights would be round in any
 * unit, 0 if no light shines, or 1 if they are not round in this one. Lights
 * may be copies of one, so the least probability counts. *has_lamp is set if
 * one is not directional. */
static double chance_of_powers(const json_t *lights, enum light_unit unit,
                               int digits, bool *has_lamp)
{
    double chance = 1;
    bool is_there = false;
    const json_t *light;
    size_t i;

    json_array_foreach (lights, i, light) {
        const json_t *v = json_object_get(light, "intensity");
        const char *type = json_string_value(json_object_get(light, "type"));
        double intensity = v != NULL ? json_number_value(v) : 1;
        bool is_sun = type != NULL && strcmp(type, "directional") == 0;
        double power = intensity * light_unit_factor(unit, is_sun);
        double error;

        if (!(power > 0 && power < 1e30))
            continue;
        error = is_round(intensity, SHORT_DIGITS, DBL_EPSILON) ? SHORT_ERROR
                                                               : FLOAT_ERROR;
        if (!is_round(is_sun ? power : power * 4 * M_PI, digits, error))
            return 1;
        chance = fmin(chance, error * pow(10, digits));
        is_there = true;
        *has_lamp |= !is_sun;
    }
    return is_there ? chance : 0;
}

/* Finds the unit in which the powers have the fewest digits. */
static enum light_unit unit_of_powers(const json_t *lights,
                                      enum light_unit otherwise,
                                      bool *is_guessed)
{
    *is_guessed = true;
    for (int digits = 1; digits <= DIGITS_MOST; digits++) {
        enum light_unit found = LIGHT_UNIT_OF_FILE;
        double chance = 1;
        int count = 0;

        for (size_t i = 0; i < UNITS; i++) {
            bool has_lamp = false;
            double c = chance_of_powers(lights, units[i], digits, &has_lamp);

            if (c > CHANCE_MOST)
                continue;
            /* watts and no unit are the same for directional lights */
            count += units[i] != LIGHT_UNIT_WATT || has_lamp;
            if (found == LIGHT_UNIT_OF_FILE)
                found = units[i];
            chance = c;
        }
        if (found == LIGHT_UNIT_OF_FILE)
            continue;
        *is_guessed = chance > 0 && (count > 1 || chance > CHANCE_SURE);
        return found;
    }
    return otherwise;
}

enum light_unit gltf_light_unit(const struct gltf_document *document,
                                bool *is_guessed)
{
    const char *name = strstr(gltf_generator(document), "Blender");
    uint64_t major, minor;
    bool has_version;

    *is_guessed = false;
    if (name == NULL)
        return LIGHT_UNIT_NONE;
    has_version = read_version(name, &major, &minor);
    if (has_version &&
        (major < MODES_MAJOR || (major == MODES_MAJOR && minor < MODES_MINOR)))
        return LIGHT_UNIT_WATT;
    return unit_of_powers(gltf_lights(document),
                          has_version ? LIGHT_UNIT_LUMEN : LIGHT_UNIT_WATT,
                          is_guessed);
}
