// SPDX-License-Identifier: MIT
/*
 * gltf_light_unit.h - the unit of the lights of a glTF document
 *
 * KHR_lights_punctual has candela and lux, which few programs write. Blender's
 * exporter has three modes since version 3.4: Standard (683 lm for a watt),
 * Unitless and Raw (watts); earlier ones write watts. Files do not say which
 * mode they have: people's powers are round numbers, so that the unit is the
 * one in which the powers are round.
 *
 * Threads:   any
 */
#ifndef GLIM_GLTF_LIGHT_UNIT_H
#define GLIM_GLTF_LIGHT_UNIT_H

#include "gltf/gltf_document.h"
#include "scene/lamp.h"

/* Returns the unit; *is_guessed if neither version nor powers tell it. */
enum light_unit gltf_light_unit(const struct gltf_document *document,
                                bool *is_guessed);

#endif
