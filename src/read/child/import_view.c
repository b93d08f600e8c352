// SPDX-License-Identifier: MIT
#include "read/child/import_view.h"

#if HAS_ASSIMP

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Width by height of a picture whose camera does not say. */
#define ASPECT_DEFAULT (16.0 / 9)

/* Angle across a picture below which libassimp has lost it, as it does for
 * Collada cameras without a name, and the one that is taken. */
#define ACROSS_LEAST   0.02
#define ACROSS_DEFAULT 1.0

/* Part of a Collada spot's cone that has its full light: libassimp's number for
 * the edge does not come from the file. It is Blender's default. */
#define SPOT_FULL 0.85

/* ---- the program that wrote the file ---- */

static const struct aiMetadataEntry *find(const struct aiScene *scene,
                                          const char *key)
{
    const struct aiMetadata *m = scene->mMetaData;

    for (unsigned i = 0; m != NULL && i < m->mNumProperties; i++)
        if (strcmp(m->mKeys[i].data, key) == 0)
            return &m->mValues[i];
    return NULL;
}

/* Returns true if the text of this key has the word. */
static bool says(const struct aiScene *scene, const char *key, const char *word)
{
    const struct aiMetadataEntry *e = find(scene, key);

    return e != NULL && e->mType == AI_AISTRING &&
           strstr(((const struct aiString *)e->mData)->data, word) != NULL;
}

/* Returns the units of a metre: FBX states centimetres for each unit, and
 * libassimp makes the units of Collada metres. */
static double units_of(const struct aiScene *scene, bool is_fbx)
{
    const struct aiMetadataEntry *e = find(scene, "UnitScaleFactor");
    double centimeters = 1;

    if (!is_fbx)
        return 1;
    if (e != NULL && e->mType == AI_DOUBLE)
        centimeters = *(const double *)e->mData;
    else if (e != NULL && e->mType == AI_FLOAT)
        centimeters = (double)*(const float *)e->mData;
    return 100 / centimeters;
}

struct import_source import_source_of(const struct aiScene *scene)
{
    struct import_source s = {
        .is_fbx = says(scene, "SourceAsset_Format", "FBX"),
        .is_collada = says(scene, "SourceAsset_Format", "Collada"),
    };

    s.is_blender = (s.is_fbx || s.is_collada) &&
                   says(scene, "SourceAsset_Generator", "Blender");
    s.units_per_meter = units_of(scene, s.is_fbx);
    return s;
}

/* ---- places ---- */

struct affine import_matrix(const struct aiNode *node)
{
    const struct aiMatrix4x4 *m = &node->mTransformation;

    return (struct affine){
        {{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
         {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
         {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static void place(const struct affine *matrix, struct aiVector3D p,
                  double to[3])
{
    affine_point(matrix, (double[3]){(double)p.x, (double)p.y, (double)p.z},
                 to);
}

/* Turns a direction, without moving it. */
static void turn(const struct affine *matrix, struct aiVector3D d, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = matrix->m[i][0] * (double)d.x + matrix->m[i][1] * (double)d.y +
                matrix->m[i][2] * (double)d.z;
    vec3d_normalize(to);
}

/* ---- records ---- */

void import_camera_fill(const struct aiCamera *camera,
                        const struct affine *matrix, struct import_camera *to)
{
    double aspect = (double)camera->mAspect;
    double across = (double)camera->mHorizontalFOV;

    memset(to, 0, sizeof *to);
    snprintf(to->name, sizeof to->name, "%.127s", camera->mName.data);
    place(matrix, camera->mPosition, to->eye);
    turn(matrix, camera->mLookAt, to->forward);
    turn(matrix, camera->mUp, to->up);
    if (!(aspect > 0))
        aspect = ASPECT_DEFAULT;
    if (!(across > ACROSS_LEAST))
        across = ACROSS_DEFAULT;
    to->yfov = 2 * atan(tan(across / 2) / aspect);
}

/* Returns the intensity of a light of colour 1. Blender writes the power in
 * watts of a light that shines to all sides. Other programs write the light of
 * a white surface that faces it, which fades with the distance as a polynomial
 * says: their lights are made to have it at the middle of the scene. The
 * polynomial of FBX files is about other things. */
static double intensity_of(const struct aiLight *l,
                           const struct import_source *s, const double from[3],
                           const double center[3])
{
    double square = 0, fade;

    if (s->is_blender)
        return s->units_per_meter * s->units_per_meter / (4 * M_PI);
    for (int i = 0; i < 3; i++)
        square += (center[i] - from[i]) * (center[i] - from[i]);
    fade = (double)l->mAttenuationConstant +
           (double)l->mAttenuationLinear * sqrt(square) +
           (double)l->mAttenuationQuadratic * square;
    if (s->is_fbx || !(fade > 0))
        fade = 1;
    return M_PI * square / fade;
}

/* Angles of libassimp go from edge to edge. */
static void set_cone(const struct aiLight *l, const struct import_source *s,
                     struct import_lamp *to)
{
    to->inner = (double)l->mAngleInnerCone / 2;
    to->outer = (double)l->mAngleOuterCone / 2;
    if (s->is_collada) {
        to->outer = to->inner;
        to->inner *= SPOT_FULL;
    }
}

bool import_lamp_fill(const struct aiLight *light, const struct affine *matrix,
                      const struct import_source *source,
                      const double center[3], struct import_lamp *to)
{
    const float rgb[3] = {light->mColorDiffuse.r, light->mColorDiffuse.g,
                          light->mColorDiffuse.b};
    double scale = source->is_blender ? 1 : M_PI;

    memset(to, 0, sizeof *to);
    place(matrix, light->mPosition, to->position);
    turn(matrix, light->mDirection, to->forward);
    switch ((int)light->mType) {
    case aiLightSource_DIRECTIONAL: to->kind = LAMP_DIRECTIONAL; break;
    case aiLightSource_POINT: to->kind = LAMP_POINT; break;
    case aiLightSource_SPOT:
        to->kind = LAMP_SPOT;
        set_cone(light, source, to);
        break;
    default: return false;
    }
    if (to->kind != LAMP_DIRECTIONAL)
        scale = intensity_of(light, source, to->position, center);
    for (int i = 0; i < 3; i++)
        to->rgb[i] = (double)rgb[i] * scale;
    return true;
}

#else

typedef int import_view_is_absent;

#endif
