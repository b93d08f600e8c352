// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_vertices.h"

#include <string.h>

#include "read/face_tris.h"
#include "kernels/vec.h"

/* Vertices that are read at once, and most components of one. */
#define CHUNK          128u
#define COMPONENTS_MAX 4

/* Vertices that a thread takes at once. */
#define BLOCK_VERTICES 16384u

struct job {
    const struct gltf_primitive *primitive;
    const struct gltf_shape *shape;
    struct scene *scene;
    uint32_t first_position, first_normal, first_uv;
    atomic_bool has_failed;
};

/* Positions, normals and tangents of some vertices. */
struct chunk {
    uint32_t first, count;
    double positions[3 * CHUNK], normals[3 * CHUNK], tangents[3 * CHUNK];
    float signs[CHUNK]; /* of the tangents */
};

static void read_doubles(const struct gltf_accessor *a, const struct chunk *c,
                         double factor, double *to)
{
    float numbers[3 * CHUNK];

    gltf_accessor_floats(a, c->first, c->count, numbers);
    for (uint32_t i = 0; i < 3 * c->count; i++)
        to[i] += factor * (double)numbers[i];
}

static void read_tangents(const struct gltf_primitive *p, struct chunk *c)
{
    float numbers[4 * CHUNK];

    gltf_accessor_floats(&p->tangents, c->first, c->count, numbers);
    for (uint32_t i = 0; i < c->count; i++) {
        for (uint32_t k = 0; k < 3; k++)
            c->tangents[3 * i + k] = (double)numbers[4 * i + k];
        c->signs[i] = numbers[4 * i + 3] < 0 ? -1 : 1;
    }
}

/* ---- joints ---- */

/* Adds the weighted matrices of a set of joints. Returns false if the skin does
 * not have a joint. */
static bool add_joints(const struct gltf_accessor *joints,
                       const struct gltf_accessor *weights,
                       const struct gltf_shape *shape, uint32_t vertex,
                       struct affine *sum, double *weight)
{
    uint32_t joint[COMPONENTS_MAX];
    float w[COMPONENTS_MAX];

    gltf_accessor_integers(joints, vertex, 1, joint);
    gltf_accessor_floats(weights, vertex, 1, w);
    for (int k = 0; k < 4; k++) {
        const struct affine *a;

        if (joint[k] >= shape->joint_count)
            return false;
        a = &shape->joints[joint[k]];
        *weight += (double)w[k];
        for (int i = 0; i < 3; i++)
            for (int m = 0; m < 4; m++)
                sum->m[i][m] += (double)w[k] * a->m[i][m];
    }
    return true;
}

/* Moves vertex i of a chunk by the mean of its joints. Vertices without weights
 * stay. */
static bool bend_vertex(const struct job *j, struct chunk *c, uint32_t i)
{
    const struct gltf_primitive *p = j->primitive;
    struct affine sum = {{{0}}};
    double *position = c->positions + 3 * i, *normal = c->normals + 3 * i;
    double *tangent = c->tangents + 3 * i;
    double rows[3][3], weight = 0, from[3], n[3], t[3];

    memcpy(from, position, sizeof from);
    memcpy(n, normal, sizeof n);
    memcpy(t, tangent, sizeof t);
    for (uint32_t k = 0; k < p->joint_set_count; k++)
        if (!add_joints(&p->joints[k], &p->weights[k], j->shape, c->first + i,
                        &sum, &weight))
            return false;
    if (!(weight > 0))
        return true;
    for (int k = 0; k < 12; k++)
        sum.m[k / 4][k % 4] /= weight;
    affine_point(&sum, from, position);
    affine_normals(&sum, rows);
    for (int k = 0; k < 3; k++) {
        normal[k] = vec3d_dot(rows[k], n);
        tangent[k] = vec3d_dot(sum.m[k], t);
    }
    return true;
}

/* ---- vertices ---- */

/* Reads a chunk and bends it. */
static bool read_chunk(const struct job *j, struct chunk *c)
{
    const struct gltf_primitive *p = j->primitive;
    bool ok = true;

    memset(c->positions, 0, sizeof c->positions);
    memset(c->normals, 0, sizeof c->normals);
    memset(c->tangents, 0, sizeof c->tangents);
    if (p->has_tangents)
        read_tangents(p, c);
    read_doubles(&p->positions, c, 1, c->positions);
    if (p->has_normals)
        read_doubles(&p->normals, c, 1, c->normals);
    for (uint32_t i = 0; i < p->target_count; i++) {
        const struct gltf_target *t = &p->targets[i];

        if (t->has_positions)
            read_doubles(&t->positions, c, t->weight, c->positions);
        if (t->has_normals && p->has_normals)
            read_doubles(&t->normals, c, t->weight, c->normals);
        if (t->has_tangents && p->has_tangents)
            read_doubles(&t->tangents, c, t->weight, c->tangents);
    }
    for (uint32_t i = 0; j->shape->joint_count > 0 && i < c->count; i++)
        ok = ok && bend_vertex(j, c, i);
    return ok;
}

static struct vec3 unit_vector(double v[3])
{
    return vec3d_normalize(v) ? v3((float)v[0], (float)v[1], (float)v[2])
                              : v3(0, 0, 0);
}

static void put_normals(const struct job *j, struct chunk *c)
{
    struct vec3 *to = j->scene->normals + j->first_normal + c->first;

    for (uint32_t i = 0; i < c->count; i++)
        to[i] = unit_vector(c->normals + 3 * i);
}

/* Puts tangents, 0 without them. */
static void put_tangents(const struct job *j, struct chunk *c)
{
    struct tangent *to = j->scene->tangents + j->first_normal + c->first;

    for (uint32_t i = 0; i < c->count; i++)
        to[i] = (struct tangent){unit_vector(c->tangents + 3 * i),
                                 j->primitive->has_tangents ? c->signs[i] : 1};
}

/* Puts a set of texture coordinates, 0 without one. glTF counts v from the
 * top. */
static void put_uvs(const struct job *j, int set, const struct chunk *c,
                    struct vec2 *to)
{
    const struct gltf_primitive *p = j->primitive;
    float numbers[2 * CHUNK] = {0};

    to += j->first_uv + c->first;
    if (p->has_uv_set[set])
        gltf_accessor_floats(&p->uvs[set], c->first, c->count, numbers);
    for (uint32_t i = 0; i < c->count; i++)
        to[i] = v2(texture_coordinate((double)numbers[2 * i]),
                   texture_coordinate(1 - (double)numbers[2 * i + 1]));
}

static float color_of(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

/* Colours of integers are normalised, also where the file does not say it. */
static void put_colors(const struct job *j, const struct chunk *c)
{
    size_t first = (size_t)j->first_position + c->first;
    struct vec3 *to = j->scene->colors + first;
    struct gltf_accessor a = j->primitive->colors;
    float numbers[COMPONENTS_MAX * CHUNK];

    a.is_normalized = true;
    gltf_accessor_floats(&a, c->first, c->count, numbers);
    for (uint32_t i = 0; i < c->count; i++) {
        const float *rgb = numbers + (size_t)a.component_count * i;

        to[i] = v3(color_of(rgb[0]), color_of(rgb[1]), color_of(rgb[2]));
        if (j->primitive->has_alphas)
            j->scene->alphas[first + i] = color_of(rgb[3]);
    }
}

static void put_chunk(const struct job *j, struct chunk *c)
{
    const struct gltf_primitive *p = j->primitive;
    struct scene *s = j->scene;

    memcpy(s->file_positions + 3 * ((size_t)j->first_position + c->first),
           c->positions, 3 * c->count * sizeof *c->positions);
    if (p->has_normals)
        put_normals(j, c);
    if (p->has_normals && s->tangents != NULL)
        put_tangents(j, c);
    if (p->has_uvs)
        put_uvs(j, 0, c, s->uvs);
    if (p->has_uvs && s->uvs2 != NULL)
        put_uvs(j, 1, c, s->uvs2);
    if (s->colors != NULL && p->has_colors)
        put_colors(j, c);
    for (uint32_t i = 0; s->colors != NULL && !p->has_colors && i < c->count;
         i++)
        s->colors[j->first_position + c->first + i] = v3(1, 1, 1);
    for (uint32_t i = 0; s->alphas != NULL && !p->has_alphas && i < c->count;
         i++)
        s->alphas[j->first_position + c->first + i] = 1;
}

static void read_block(void *context, uint32_t block, int worker)
{
    struct job *j = context;
    uint32_t first = block * BLOCK_VERTICES;
    uint32_t left = j->primitive->vertex_count - first;
    uint32_t end = first + (left < BLOCK_VERTICES ? left : BLOCK_VERTICES);
    struct chunk c;

    (void)worker;
    for (c.first = first; c.first < end; c.first += CHUNK) {
        c.count = end - c.first < CHUNK ? end - c.first : CHUNK;
        if (!read_chunk(j, &c))
            atomic_store(&j->has_failed, true);
        put_chunk(j, &c);
    }
}

bool gltf_vertices_add(const struct gltf_value *value,
                       const struct gltf_primitive *p,
                       const struct gltf_shape *shape, struct scene *scene,
                       struct pool *pool, struct error *err)
{
    uint32_t n = p->vertex_count;
    struct job job = {.primitive = p,
                      .shape = shape,
                      .scene = scene,
                      .first_position = scene->position_count,
                      .first_normal = scene->normal_count,
                      .first_uv = scene->uv_count};

    pool_each(pool, n / BLOCK_VERTICES + (n % BLOCK_VERTICES > 0), read_block,
              &job);
    scene->position_count += n;
    scene->normal_count += p->has_normals ? n : 0;
    scene->uv_count += p->has_uvs ? n : 0;
    scene->color_count = scene->colors != NULL ? scene->position_count : 0;
    return !atomic_load(&job.has_failed) ||
           gltf_fail(value, err, "found a joint beyond the %u of the skin",
                     (unsigned)shape->joint_count);
}
