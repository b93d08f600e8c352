// SPDX-License-Identifier: MIT
/*
 * material.h - the material that the kernels render, made from the statements
 * of an MTL file, and the kernel features that it needs
 *
 * Units:     absorption is per unit of length of the file
 * Threads:   any
 * Errors:    impossible values are replaced, with a warning
 */
#ifndef GLIM_MATERIAL_H
#define GLIM_MATERIAL_H

#include <stdbool.h>

#include "base/warnings.h"
#include "scene/material_values.h"
#include "kernels/types.h"

/* ---- materials ---- */

/*
 * The kind of a material is the first of these that applies:
 *   glass        illum 6 or 7; colour Tf times map_Kd
 *   thin glass   illum 4 or 9, unless Tf is white or absent and d is below 1 or
 *                Ni is 1; colour Tf times map_Kd
 *   principled   Pm between 0 and 1, map_Pm, Pc, Ps, Pf or aniso above 0,
 *                map_Pc, map_Ps, or map_Tf or Tf that is not black beside Pr
 *   metal        Pm 1; colour Kd
 *   metal        illum 3 or 5 with map_Ks or with Ks that is not black;
 *                colour Ks
 *   plastic      map_Ks, or Ks that is not black: diffuse of colour Kd under a
 *                clear surface of reflectance MATERIAL_SPECULAR times Ks
 *   diffuse      all others; colour Kd, roughness Kd_roughness (default 0)
 * Diffuse surfaces, also those of plastic and mixtures, transmit light to all
 * directions with the weight Td_weight (default: 1 beside Td) and the colour
 * Td; they reflect the rest. The principled surface is a mixture of metal of
 * colour Kd (weight Pm times map_Pm), glass (mean of Tf) and plastic, under a
 * thin film (weight Pf, index Pf_ior, Pf_thickness nanometres), a coat (weight
 * Pc, roughness Pcr) and grey sheen (weight Ps, roughness Ps_roughness). aniso
 * stretches highlights along u, turned by anisor of a turn. With d_cutoff
 * coverage is 0 or 1.
 *
 * A map multiplies its statement, which material_values_with_factors()
 * completes. Roughness alpha is Pr squared; without Pr it is sqrt(2 / (Ns +
 * 2)), or 0 if Ns is absent, 0, or at least 1000. With Tf_distance, solid glass
 * has no tint of Tf: Tf is what it leaves of light after this distance. Glass
 * with Ni_abbe has the index Ni for yellow light, and more for blue. Thin
 * glass is rough with Pr or map_Pr only. In a mixture, Tf_thin above 0 makes
 * its glass a thin sheet; else, with Tf_distance, the weight of glass is the
 * largest channel of Tf, and absorption has the hue of Tf. Tf_attenuation, if
 * present, is what is left of light after Tf_distance, in place of Tf. Ks_full
 * is used in place of MATERIAL_SPECULAR. Ps_color, or map_Ps_color, colours
 * sheen. map_Ks_weight, map_Ps_roughness and map_Pf multiply Ks, Ps_roughness
 * and Pf; map_Pf_thickness goes from Pf_thinnest to Pf_thickness. map_grain
 * turns the grain and reduces aniso. map_Pc_norm bends the normal of the coat,
 * which norm and map_Bump do not. map_Td and map_Td_weight multiply Td and
 * Td_weight, and map_Sf multiplies Sf.
 *
 * In files of Blender (enum mtl_dialect), Ks never is a colour of metal; Pm is
 * Ka with illum 3 and 6 if there is no Pm; roughness is 1 - sqrt(Ns / 1000);
 * illum 9, and 6 with d below 1, are no glass; and from 4.0 on Ks scales twice
 * the Fresnel reflectance of Ni, and Pc is 4 times the weight of the coat.
 */

/* Reflectance of plastic whose Ks is 1. Exporters write Ks 0.5 for ordinary
 * surfaces, which then reflect 4 %, like glass and varnish. */
#define MATERIAL_SPECULAR 0.08f

/* Colour of a material whose file gives none. */
#define MATERIAL_GREY 0.8f

/* Roughness of sheen without Ps_roughness, as in Blender. */
#define MATERIAL_SHEEN_ROUGHNESS 0.5

/* A film without Pf_ior and Pf_thickness, as in KHR_materials_iridescence of
 * glTF, and the greatest numbers. */
#define MATERIAL_FILM_IOR           1.3
#define MATERIAL_FILM_THICKNESS     400
#define MATERIAL_FILM_IOR_MAX       10
#define MATERIAL_FILM_THICKNESS_MAX 2000

/* Maps of a material with textures of their own. */
#define MATERIAL_MAP_ONE(...) +1
#define MATERIAL_MAP_NONE(...)
enum { MATERIAL_MAPS = MATERIAL_MAP_LIST(MATERIAL_MAP_ONE, MATERIAL_MAP_NONE) };
#undef MATERIAL_MAP_ONE
#undef MATERIAL_MAP_NONE

struct material material_default(void);

/* Returns the place of the texture of a map, from 0 to MATERIAL_MAPS - 1. */
uint32_t *material_map(struct material *material, uint32_t number);

/* Lists the textures of all maps; NO_INDEX for those that are absent. */
void material_maps(const struct material *material,
                   uint32_t maps[MATERIAL_MAPS]);

/* Makes the material that the statements describe. `path` is the MTL file, for
 * warnings. */
struct material material_from_source(const struct material_values *source,
                                     const char *path, struct warnings *report);

/* Returns `wanted` with as many statements as possible replaced by those of
 * `file`, such that the material stays the same. Used to save only changes. */
struct material_values
material_values_needed(const struct material_values *file,
                       const struct material_values *wanted);

/* Returns the color of a half space of a medium, the inverse of
 * medium_albedo_of(). */
float seen_color(float albedo, float g);

/* Returns a mean cosine of scattering that the kernels can sample. */
float medium_anisotropy(double cosine);

/* Returns the medium in units of length that are 1 / factor as long. */
struct medium medium_scaled(struct medium medium, float factor);

/* ---- features ---- */

/* Returns a set of features.h. */
uint64_t material_features(const struct material *material,
                           const struct texture *textures);

/* Returns true if materials of these features use the tangents of vertices. */
bool features_use_tangents(uint64_t features);

#endif
