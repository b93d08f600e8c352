// SPDX-License-Identifier: MIT
#include "gltf/gltf_light_unit.h"

#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "gltf/gltf_value.h"

/* First version of Blender's exporter that has modes. */
#define MODES_MAJOR 3
#define MODES_MINOR 4

/* Relative error of a power: some files have five digits of an intensity. */
#define POWER_ERROR 1e-5

/* Digits of round powers. Three make the unit certain: one intensity in some
 * hundred has a second unit by chance. */
#define DIGITS_SURE 3
#define DIGITS_MOST 4

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

/* Returns true if the number has this many digits at most. */
static bool is_round(double number, int digits)
{
    double scaled =
        number * pow(10, digits - 1 - floor(log10(number) + POWER_ERROR));

    return fabs(scaled - round(scaled)) <= POWER_ERROR * scaled;
}

/* Returns true if the powers of all lights are round in this unit. *is_there
 * is set if a light is, and *has_lamp if one is not directional. */
static bool all_are_round(const json_t *lights, enum light_unit unit,
                          int digits, bool *is_there, bool *has_lamp)
{
    const json_t *light;
    size_t i;

    json_array_foreach (lights, i, light) {
        const json_t *v = json_object_get(light, "intensity");
        const char *type = json_string_value(json_object_get(light, "type"));
        double intensity = v != NULL ? json_number_value(v) : 1;
        bool is_sun = type != NULL && strcmp(type, "directional") == 0;
        double power = intensity * light_unit_factor(unit, is_sun);

        if (!(power > 0 && power < 1e30))
            continue;
        *is_there = true;
        *has_lamp |= !is_sun;
        if (!is_round(is_sun ? power : power * 4 * M_PI, digits))
            return false;
    }
    return true;
}

/* Finds the unit in which the powers have the fewest digits. */
static enum light_unit unit_of_powers(const json_t *lights,
                                      enum light_unit otherwise,
                                      bool *is_guessed)
{
    bool is_there = false, has_lamp = false;

    *is_guessed = true;
    for (int digits = 1; digits <= DIGITS_MOST; digits++) {
        enum light_unit found = LIGHT_UNIT_OF_FILE;
        int count = 0;

        for (size_t i = 0; i < UNITS; i++) {
            if (!all_are_round(lights, units[i], digits, &is_there, &has_lamp))
                continue;
            /* watts and no unit are the same for directional lights */
            count += units[i] != LIGHT_UNIT_WATT || has_lamp;
            if (found == LIGHT_UNIT_OF_FILE)
                found = units[i];
        }
        if (found == LIGHT_UNIT_OF_FILE)
            continue;
        *is_guessed = is_there && (count > 1 || digits > DIGITS_SURE);
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
