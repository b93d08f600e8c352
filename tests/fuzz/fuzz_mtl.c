// SPDX-License-Identifier: MIT
/*
 * MTL text with the files of its maps. Materials always have values that can be
 * rendered.
 */
#include <math.h>

#include "fuzz.h"
#include "mutate_text.h"
#include "read/mtl.h"

static int is_light(struct vec3 c)
{
    return c.x >= 0 && c.y >= 0 && c.z >= 0 && isfinite(c.x) && isfinite(c.y) &&
           isfinite(c.z);
}

static int is_reflectance(struct vec3 c)
{
    return is_light(c) && c.x <= 1 && c.y <= 1 && c.z <= 1;
}

static int is_medium(const struct medium *m)
{
    return is_light(m->scattering) && is_light(m->extinction) &&
           m->scattering.x <= m->extinction.x &&
           m->scattering.y <= m->extinction.y &&
           m->scattering.z <= m->extinction.z && fabsf(m->anisotropy) < 1;
}

static int is_texture(const struct scene *scene, uint32_t index)
{
    return index == NO_INDEX || index < scene->texture_count;
}

static void check_material(const struct scene *scene, const struct material *m)
{
    uint32_t maps[MATERIAL_MAPS];

    require(is_reflectance(m->color), "colour");
    require(is_reflectance(m->specular), "specular");
    require(is_light(m->emission), "emission");
    require(m->alpha >= 0 && m->alpha <= 1, "roughness");
    require(m->opacity >= 0 && m->opacity <= 1, "opacity");
    require(m->ior > 0 && isfinite(m->ior), "index of refraction");
    require(m->dispersion >= 0 && m->dispersion <= 1e6f, "dispersion");
    require(isfinite(m->bump_scale), "height of bumps");
    require(m->metalness >= 0 && m->metalness <= 1, "metalness");
    require(m->transmission >= 0 && m->transmission <= 1, "transmission");
    require(m->coat >= 0 && m->coat <= 1, "coat");
    require(m->coat_alpha >= 0 && m->coat_alpha <= 1, "roughness of the coat");
    require(m->sheen.x >= 0 && m->sheen.x <= 1, "sheen");
    require(m->sheen_alpha >= 0 && m->sheen_alpha <= 1, "width of sheen");
    require(m->film >= 0 && m->film <= 1, "film");
    require(m->film == 0 || (m->film_ior >= 1 && m->film_ior <= 10),
            "index of the film");
    require(m->film_thickness >= 0 && m->film_thickness <= 2000,
            "thickness of the film");
    require(m->cutoff >= 0 && m->cutoff <= 1, "cutoff");
    require(is_medium(&m->medium), "medium");
    require(isfinite(m->normal_strength), "slope of normals");
    require(isfinite(m->coat_normal_strength), "slope of the coat's normals");
    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        require(is_texture(scene, maps[i]), "textures");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *image = fuzz_put("a.png", "", 0);
    char *path = fuzz_put("a.mtl", NULL, 0);
    struct scene scene = {.path = NULL};
    struct warnings report = {0};
    struct error err = {""};

    if (!mtl_parse(&scene, (const char *)data, size, path, &report, &err))
        fuzz_check_message(err.text);
    for (uint32_t i = 0; i < scene.material_count; i++)
        check_material(&scene, &scene.materials[i]);
    fuzz_check_report(&report);
    warnings_free(&report);
    scene_free(&scene);
    free(path);
    free(image);
    return 0;
}
