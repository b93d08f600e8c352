// SPDX-License-Identifier: MIT
#include "read/child/import_child.h"

#include "read/child/assimp_api.h"

#if HAS_ASSIMP

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/name_table.h"
#include "base/text_stream.h"
#include "read/child/import_material.h"
#include "read/child/import_stream.h"

/* What is done once for each place of a mesh in the tree of nodes: it is
 * counted, or an array of it is written. */
struct sender;
typedef void take_mesh(struct sender *s, const struct aiNode *node,
                       const struct aiMesh *mesh, const struct affine *matrix);

struct sender {
    const struct aiScene *scene;
    const char *path;
    struct import_source source;
    double lo[3], hi[3]; /* of all vertices */
    FILE *to;
    struct import_head head;
    uint64_t vertex_count, tri_count, object_count, name_bytes; /* so far */
    take_mesh *take;
};

/* ---- visits ---- */

static bool is_drawn(const struct aiMesh *mesh)
{
    return (mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0 &&
           mesh->mVertices != NULL;
}

static void visit_nodes(struct sender *s, const struct aiNode *node,
                        const struct affine *parent)
{
    struct affine matrix = import_matrix(node);

    matrix = affine_join(parent, &matrix);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = s->scene->mMeshes[node->mMeshes[i]];

        if (is_drawn(mesh))
            s->take(s, node, mesh, &matrix);
    }
    for (unsigned i = 0; i < node->mNumChildren; i++)
        visit_nodes(s, node->mChildren[i], &matrix);
}

static const struct affine identity = {
    {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

static void visit_all(struct sender *s, take_mesh *take)
{
    s->vertex_count = s->tri_count = s->object_count = s->name_bytes = 0;
    s->take = take;
    visit_nodes(s, s->scene->mRootNode, &identity);
}

static uint32_t count_tris(const struct aiMesh *mesh)
{
    uint32_t count = 0;

    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        count += mesh->mFaces[i].mNumIndices == 3;
    return count;
}

/* Extends the box of the scene. */
static void measure(struct sender *s, const struct aiMesh *mesh,
                    const struct affine *matrix)
{
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *v = &mesh->mVertices[i];
        const double from[3] = {(double)v->x, (double)v->y, (double)v->z};
        double p[3];

        affine_point(matrix, from, p);
        for (int k = 0; k < 3; k++) {
            s->lo[k] = fmin(s->lo[k], p[k]);
            s->hi[k] = fmax(s->hi[k], p[k]);
        }
    }
}

static void count(struct sender *s, const struct aiNode *node,
                  const struct aiMesh *mesh, const struct affine *matrix)
{
    measure(s, mesh, matrix);
    s->vertex_count += mesh->mNumVertices;
    s->tri_count += count_tris(mesh);
    s->object_count++;
    s->name_bytes += strlen(node->mName.data) + 1;
    if (mesh->mNormals != NULL)
        s->head.flags |= IMPORT_HAS_NORMALS;
    if (mesh->mTextureCoords[0] != NULL)
        s->head.flags |= IMPORT_HAS_UVS;
    if (mesh->mColors[0] != NULL)
        s->head.flags |= IMPORT_HAS_COLORS;
}

static void send_positions(struct sender *s, const struct aiNode *node,
                           const struct aiMesh *mesh,
                           const struct affine *matrix)
{
    (void)node;
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *v = &mesh->mVertices[i];
        const double from[3] = {(double)v->x, (double)v->y, (double)v->z};
        double p[3];

        affine_point(matrix, from, p);
        fwrite(p, sizeof p, 1, s->to);
    }
}

static void send_normals(struct sender *s, const struct aiNode *node,
                         const struct aiMesh *mesh, const struct affine *matrix)
{
    double rows[3][3];

    (void)node;
    affine_normals(matrix, rows);
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        float n[3] = {0, 0, 0};

        if (mesh->mNormals != NULL) {
            const struct aiVector3D *v = &mesh->mNormals[i];
            const double from[3] = {(double)v->x, (double)v->y, (double)v->z};

            for (int k = 0; k < 3; k++)
                n[k] = (float)vec3d_dot(rows[k], from);
        }
        fwrite(n, sizeof n, 1, s->to);
    }
}

static void send_uvs(struct sender *s, const struct aiNode *node,
                     const struct aiMesh *mesh, const struct affine *matrix)
{
    (void)node;
    (void)matrix;
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *v = mesh->mTextureCoords[0];
        float uv[2] = {v != NULL ? v[i].x : 0, v != NULL ? v[i].y : 0};

        fwrite(uv, sizeof uv, 1, s->to);
    }
}

static void send_colors(struct sender *s, const struct aiNode *node,
                        const struct aiMesh *mesh, const struct affine *matrix)
{
    (void)node;
    (void)matrix;
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const struct aiColor4D *c = mesh->mColors[0];
        float rgb[3] = {c != NULL ? c[i].r : 1, c != NULL ? c[i].g : 1,
                        c != NULL ? c[i].b : 1};

        fwrite(rgb, sizeof rgb, 1, s->to);
    }
}

/* Sends the triangles of a mesh. A mirror turns their winding. */
static void send_tris(struct sender *s, const struct aiNode *node,
                      const struct aiMesh *mesh, const struct affine *matrix)
{
    double unused[3][3];
    bool is_mirrored = affine_normals(matrix, unused);
    uint32_t first = (uint32_t)s->vertex_count;

    (void)node;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *f = &mesh->mFaces[i];
        struct import_tri t = {.material = mesh->mMaterialIndex,
                               .object = (uint32_t)s->object_count};

        if (f->mNumIndices != 3)
            continue;
        for (int k = 0; k < 3; k++)
            t.v[k] = first + f->mIndices[is_mirrored ? 2 - k : k];
        fwrite(&t, sizeof t, 1, s->to);
    }
    s->vertex_count += mesh->mNumVertices;
    s->object_count++;
}

static void send_names(struct sender *s, const struct aiNode *node,
                       const struct aiMesh *mesh, const struct affine *matrix)
{
    (void)mesh;
    (void)matrix;
    fwrite(node->mName.data, strlen(node->mName.data) + 1, 1, s->to);
}

/* ---- cameras and lights ---- */

/* Finds the node of this name, and its matrix to the scene. */
static bool find_node(const struct aiNode *node, const char *name,
                      struct affine *matrix)
{
    struct affine parent = *matrix, own = import_matrix(node);

    *matrix = affine_join(&parent, &own);
    if (strcmp(node->mName.data, name) == 0)
        return true;
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        struct affine found = *matrix;

        if (find_node(node->mChildren[i], name, &found)) {
            *matrix = found;
            return true;
        }
    }
    return false;
}

/* Returns the matrix of the camera or light of this name: that of its node. */
static struct affine place_of(const struct sender *s, const char *name)
{
    struct affine matrix = identity;

    return find_node(s->scene->mRootNode, name, &matrix) ? matrix : identity;
}

static void send_cameras(struct sender *s)
{
    for (unsigned i = 0; i < s->scene->mNumCameras; i++) {
        const struct aiCamera *camera = s->scene->mCameras[i];
        struct affine matrix = place_of(s, camera->mName.data);
        struct import_camera c;

        import_camera_fill(camera, &matrix, &c);
        fwrite(&c, sizeof c, 1, s->to);
    }
}

static bool fill_lamp(const struct sender *s, const struct aiLight *light,
                      struct import_lamp *lamp)
{
    struct affine matrix = place_of(s, light->mName.data);
    double center[3];

    for (int k = 0; k < 3; k++)
        center[k] = (s->lo[k] + s->hi[k]) / 2;
    return import_lamp_fill(light, &matrix, &s->source, center, lamp);
}

static void count_lamps(struct sender *s)
{
    for (unsigned i = 0; i < s->scene->mNumLights; i++) {
        struct import_lamp lamp;

        if (fill_lamp(s, s->scene->mLights[i], &lamp))
            s->head.lamp_count++;
        else
            s->head.skipped_count++;
    }
}

static void send_lamps(struct sender *s)
{
    for (unsigned i = 0; i < s->scene->mNumLights; i++) {
        struct import_lamp lamp;

        if (fill_lamp(s, s->scene->mLights[i], &lamp))
            fwrite(&lamp, sizeof lamp, 1, s->to);
    }
}

/* ---- images ---- */

/* Sends texels as a TGA file, which has them in the same order: blue, green,
 * red and alpha, from the top. */
static void send_texels(struct sender *s, const struct aiTexture *t)
{
    enum { TRUE_COLOR = 2, FROM_THE_TOP = 0x20, ALPHA_BITS = 8 };
    const uint8_t head[18] = {
        [2] = TRUE_COLOR,
        [12] = (uint8_t)t->mWidth,
        [13] = (uint8_t)(t->mWidth >> 8),
        [14] = (uint8_t)t->mHeight,
        [15] = (uint8_t)(t->mHeight >> 8),
        [16] = 32,
        [17] = FROM_THE_TOP | ALPHA_BITS,
    };
    uint64_t texels = (uint64_t)t->mWidth * t->mHeight;
    uint64_t size_bytes = sizeof head + sizeof *t->pcData * texels;

    fwrite(&size_bytes, sizeof size_bytes, 1, s->to);
    fwrite(head, sizeof head, 1, s->to);
    fwrite(t->pcData, sizeof *t->pcData, texels, s->to);
}

/* Sends the embedded images: files, and texels without a format. */
static void send_images(struct sender *s)
{
    for (unsigned i = 0; i < s->scene->mNumTextures; i++) {
        const struct aiTexture *t = s->scene->mTextures[i];
        uint64_t size_bytes = t->mWidth;

        if (t->mHeight > 0 && t->mWidth <= UINT16_MAX &&
            t->mHeight <= UINT16_MAX) {
            send_texels(s, t);
            continue;
        }
        if (t->mHeight > 0)
            size_bytes = 0;
        fwrite(&size_bytes, sizeof size_bytes, 1, s->to);
        fwrite(t->pcData, 1, size_bytes, s->to);
    }
}

/* ---- the scene ---- */

/* Returns the materials as MTL text, for free(). */
static char *material_text(const struct assimp_api *api, struct sender *s,
                           size_t *size_bytes)
{
    struct name_table names = {0};
    struct text_stream stream;
    bool ok = text_stream_open(&stream);
    const struct import_materials m = {api,       s->scene,
                                       s->path,   &s->source,
                                       stream.to, &s->head.clamped_count};
    char *text;

    for (unsigned i = 0; ok && i < s->scene->mNumMaterials; i++)
        ok = import_material_write(&m, s->scene->mMaterials[i], &names);
    name_table_free(&names);
    text = text_stream_close(&stream, size_bytes);
    if (ok)
        return text;
    free(text);
    return NULL;
}

static bool fill_head(struct sender *s, size_t material_bytes,
                      struct error *err)
{
    for (int k = 0; k < 3; k++) {
        s->lo[k] = HUGE_VAL;
        s->hi[k] = -HUGE_VAL;
    }
    visit_all(s, count);
    count_lamps(s);
    if (s->vertex_count >= NO_INDEX || s->tri_count >= NO_INDEX ||
        s->object_count >= NO_INDEX)
        return fail(err, "found %llu triangles, expected fewer than 2^32",
                    (unsigned long long)s->tri_count);
    memcpy(s->head.magic, IMPORT_MAGIC, sizeof s->head.magic);
    s->head.vertex_count = (uint32_t)s->vertex_count;
    s->head.tri_count = (uint32_t)s->tri_count;
    s->head.object_count = (uint32_t)s->object_count;
    s->head.name_bytes = s->name_bytes;
    s->head.material_count = s->scene->mNumMaterials;
    s->head.material_bytes = material_bytes;
    s->head.image_count = s->scene->mNumTextures;
    s->head.camera_count = s->scene->mNumCameras;
    return true;
}

static bool send(const struct assimp_api *api, struct sender *s,
                 struct error *err)
{
    size_t size_bytes = 0;
    char *text = material_text(api, s, &size_bytes);
    bool ok = text != NULL ? fill_head(s, size_bytes, err)
                           : fail(err, "out of memory for the materials");

    if (ok) {
        fwrite(&s->head, sizeof s->head, 1, s->to);
        visit_all(s, send_positions);
        if ((s->head.flags & IMPORT_HAS_NORMALS) != 0)
            visit_all(s, send_normals);
        if ((s->head.flags & IMPORT_HAS_UVS) != 0)
            visit_all(s, send_uvs);
        if ((s->head.flags & IMPORT_HAS_COLORS) != 0)
            visit_all(s, send_colors);
        visit_all(s, send_tris);
        visit_all(s, send_names);
        send_cameras(s);
        send_lamps(s);
        send_images(s);
        fwrite(text, size_bytes, 1, s->to);
        ok = fflush(s->to) == 0 && !ferror(s->to);
        if (!ok)
            fail(err, "the scene could not be sent: %s", strerror(errno));
    }
    free(text);
    return ok;
}

/* Reads the file. Lines and points are left out. */
static const struct aiScene *read_file(const struct assimp_api *api,
                                       const char *path)
{
    struct aiPropertyStore *options = api->CreatePropertyStore();

    api->SetImportPropertyInteger(options, AI_CONFIG_PP_SBP_REMOVE,
                                  aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    return api->ImportFileExWithProperties(path,
                                           aiProcess_Triangulate |
                                               aiProcess_SortByPType |
                                               aiProcess_JoinIdenticalVertices |
                                               aiProcess_GenUVCoords |
                                               aiProcess_TransformUVCoords |
                                               aiProcess_ValidateDataStructure,
                                           NULL, options);
}

static bool read_and_send(const char *path, FILE *to, struct error *err)
{
    const struct assimp_api *api = assimp_api_open(err);
    struct sender s = {.path = path, .to = to};

    if (api == NULL)
        return false;
    s.scene = read_file(api, path);
    if (s.scene == NULL)
        return fail(err, "libassimp: %s", api->GetErrorString());
    if (s.scene->mRootNode == NULL || s.scene->mNumMeshes == 0)
        return fail(err, "found no faces");
    s.source = import_source_of(s.scene);
    return send(api, &s, err);
}

#else

static bool read_and_send(const char *path, FILE *to, struct error *err)
{
    (void)path;
    (void)to;
    return assimp_api_open(err) != NULL;
}

#endif

bool import_child(const char *path, struct library_limits limits, FILE *to)
{
    struct error err;

    library_child_limit(limits);
    return read_and_send(path, to, &err) || library_child_fail(to, &err);
}
