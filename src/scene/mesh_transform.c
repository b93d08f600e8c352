// SPDX-License-Identifier: MIT
#include "scene/mesh_transform.h"

/* Vertices that a thread takes at once. */
#define BLOCK_VERTICES 16384u

struct job {
    const struct affine *matrix;
    double rows[3][3]; /* of the matrix for normals */
    double *positions;
    struct vec3 *normals;
    struct tangent *tangents; /* NULL: none */
    bool is_mirror;
    uint32_t position_count, normal_count;
};

static struct vec3 moved_normal(const double rows[3][3], struct vec3 n)
{
    const double from[3] = {(double)n.x, (double)n.y, (double)n.z};
    double to[3];

    for (int i = 0; i < 3; i++)
        to[i] = vec3d_dot(rows[i], from);
    if (!vec3d_normalize(to))
        return (struct vec3){0, 0, 0};
    return (struct vec3){(float)to[0], (float)to[1], (float)to[2]};
}

/* Vectors along a surface move with it. */
static void move_tangent(const struct job *j, struct tangent *t)
{
    const double from[3] = {(double)t->d.x, (double)t->d.y, (double)t->d.z};
    double to[3];

    for (int i = 0; i < 3; i++)
        to[i] = vec3d_dot(j->matrix->m[i], from);
    t->d = vec3d_normalize(to)
               ? (struct vec3){(float)to[0], (float)to[1], (float)to[2]}
               : (struct vec3){0, 0, 0};
    t->sign = j->is_mirror ? -t->sign : t->sign;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static void move_block(void *context, uint32_t block, int worker)
{
    const struct job *j = context;
    uint32_t begin = block * BLOCK_VERTICES;

    (void)worker;
    for (size_t i = begin; i < least(begin + BLOCK_VERTICES, j->position_count);
         i++) {
        double *p = j->positions + 3 * i;
        const double from[3] = {p[0], p[1], p[2]};

        affine_point(j->matrix, from, p);
    }
    for (size_t i = begin; i < least(begin + BLOCK_VERTICES, j->normal_count);
         i++)
        j->normals[i] = moved_normal(j->rows, j->normals[i]);
    for (size_t i = begin; j->tangents != NULL &&
                           i < least(begin + BLOCK_VERTICES, j->normal_count);
         i++)
        move_tangent(j, &j->tangents[i]);
}

bool mesh_transform(struct scene *scene, const struct affine *matrix,
                    const struct scene_mesh *mesh, uint32_t first_position,
                    uint32_t first_normal, struct pool *pool)
{
    struct job job = {.matrix = matrix,
                      .position_count = mesh->position_count,
                      .normal_count = mesh->normal_count};
    uint32_t most = mesh->position_count > mesh->normal_count
                        ? mesh->position_count
                        : mesh->normal_count;

    job.is_mirror = affine_normals(matrix, job.rows);
    if (mesh->position_count > 0)
        job.positions = scene->file_positions + 3 * (size_t)first_position;
    if (mesh->normal_count > 0)
        job.normals = scene->normals + first_normal;
    if (mesh->normal_count > 0 && scene->tangents != NULL)
        job.tangents = scene->tangents + first_normal;
    pool_each(pool, most / BLOCK_VERTICES + (most % BLOCK_VERTICES > 0),
              move_block, &job);
    return job.is_mirror;
}

void tri_turn_over(struct tri *t)
{
    uint32_t *corners[] = {t->v, t->vn, t->vt};

    for (int i = 0; i < 3; i++) {
        uint32_t second = corners[i][1];

        corners[i][1] = corners[i][2];
        corners[i][2] = second;
    }
}
