// SPDX-License-Identifier: MIT
#include "read/crease_normals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/min_max.h"
#include "read/weld.h"
#include "kernels/vec.h"

/* Cosine of the crease angle, 40 degrees: above the noise of scans and the
 * steps of round shapes of nine sides or more, below the edges of bevels. */
#define CREASE_COS 0.766044443f

/* Least cosine between the normals of a triangle's corners and its own with
 * which it counts as flat. */
#define FLAT_COS 0.9999995f

/* Most corners at a place that are compared each with each. */
#define FEW 48

/* Most corners beyond an edge that one corner is joined with, where there are
 * more: copies of faces can be any number. */
#define COPIES_MAX 4

/* Triangles and places that are worked on as one. */
#define BLOCK_TRIS   8192u
#define BLOCK_PLACES 8192u

/* Places of a block, whose normals begin at the number of its first corner and
 * are moved together at the end. */
struct block {
    uint32_t begin; /* of its corners in `items` */
    uint32_t normal_count;
    uint32_t base; /* final number of its first normal */
    bool is_done;  /* memory was not out */
};

/* Mesh whose corners are numbered 3 * triangle + 0..2. The normals of faces are
 * in tri.ng, which scene_finish() sets anew; 0 for triangles without area. */
struct mesh {
    struct scene *scene;
    uint32_t *places; /* of vertices: their number, or that of the first copy */
    uint16_t *weights;    /* of corners: their angles, pi is 65535 */
    uint32_t *first;      /* of places: end of their corners in `items` */
    uint32_t *items;      /* corners, by place */
    struct vec3 *normals; /* with gaps between blocks */
    struct block *blocks;
    uint32_t block_count;
    struct weld weld;
    bool is_welded; /* `places` is filled; memory was not out */
};

/* Corner at the place that is worked on. */
struct spoke {
    uint32_t corner;
    uint32_t ahead, behind; /* places of the corners after and before it */
    uint32_t root; /* number of another spoke of its group, or its own */
};

struct fan {
    struct spoke *spokes;
    uint32_t *order; /* numbers of spokes by `behind` */
    size_t capacity, order_capacity;
    uint32_t count;
};

static uint32_t blocks_of(uint32_t count, uint32_t size)
{
    return count / size + (count % size != 0);
}

/* ---- the mesh ---- */

static void weld_vertices(struct mesh *m)
{
    const struct scene *s = m->scene;
    bool ok = true;

    for (uint32_t i = 0; ok && i < s->position_count; i++)
        ok = weld_add(&m->weld, s->file_positions, i, &m->places[i]);
    m->is_welded = ok;
}

/* Returns the angle of a cosine to 7e-5 (Abramowitz and Stegun 4.4.45). */
static float angle_of(float cosine)
{
    float x = f_min(fabsf(cosine), 1.0f);
    float a =
        sqrtf(1.0f - x) *
        (1.5707288f + x * (-0.2121144f + x * (0.0742610f + x * -0.0187293f)));

    return cosine < 0 ? (float)M_PI - a : a;
}

/* Sets normal and angles of a triangle; 0 if it has no area. The normal needs
 * double, since slivers lose most digits of its products. */
static void measure_tri(struct mesh *m, uint32_t tri)
{
    const struct scene *s = m->scene;
    const double *p[3];
    double e[3][3], squares[3], n[3], area, most = 0;
    float scales[3];
    uint16_t *w = m->weights + 3 * (size_t)tri;
    struct vec3 *ng = &s->tris[tri].ng;

    for (int k = 0; k < 3; k++)
        p[k] = s->file_positions + 3 * (size_t)s->tris[tri].v[k];
    for (int k = 0; k < 3; k++) {
        vec3d_sub(p[(k + 1) % 3], p[k], e[k]);
        squares[k] = vec3d_dot(e[k], e[k]);
        most = squares[k] > most ? squares[k] : most;
    }
    vec3d_cross(e[0], e[1], n);
    area = sqrt(vec3d_dot(n, n));
    *ng = v3(0.0f, 0.0f, 0.0f);
    w[0] = w[1] = w[2] = 0;
    if (!(area > 0 && area < INFINITY && most < INFINITY))
        return;
    area = 1 / area;
    most = 1 / most;
    *ng = v3((float)(n[0] * area), (float)(n[1] * area), (float)(n[2] * area));
    for (int k = 0; k < 3; k++)
        scales[k] = 1.0f / sqrtf((float)(squares[k] * most));
    for (int k = 0; k < 3; k++) {
        int in = (k + 2) % 3;
        float cosine = (float)(-vec3d_dot(e[k], e[in]) * most);

        w[k] = (uint16_t)(angle_of(cosine * scales[k] * scales[in]) *
                          (float)(UINT16_MAX / M_PI));
    }
}

/* Welds the vertices, item 0, or measures a block of triangles: one thread
 * welds while others measure. */
static void prepare(void *context, uint32_t item, int worker)
{
    struct mesh *m = context;
    uint32_t begin, end;

    (void)worker;
    if (item == 0) {
        weld_vertices(m);
        return;
    }
    begin = (item - 1) * BLOCK_TRIS;
    end = begin + u32_min(BLOCK_TRIS, m->scene->tri_count - begin);
    for (uint32_t i = begin; i < end; i++)
        measure_tri(m, i);
}

/* Lists the corners at each place. */
static void sort_corners(struct mesh *m)
{
    const struct scene *s = m->scene;
    uint32_t sum = 0;

    for (uint32_t i = 0; i < s->tri_count; i++)
        for (int k = 0; k < 3; k++)
            m->first[m->places[s->tris[i].v[k]]]++;
    for (uint32_t i = 0; i <= s->position_count; i++) {
        uint32_t count = m->first[i];

        m->first[i] = sum;
        sum += count;
    }
    /* the beginning of each place's corners moves to their end */
    for (uint32_t i = 0; i < s->tri_count; i++)
        for (uint32_t k = 0; k < 3; k++)
            m->items[m->first[m->places[s->tris[i].v[k]]]++] = 3 * i + k;
}

static bool mesh_init(struct mesh *m, struct scene *scene, struct pool *pool)
{
    size_t corner_count = 3 * (size_t)scene->tri_count;
    uint32_t block_count = blocks_of(scene->position_count, BLOCK_PLACES);

    *m = (struct mesh){
        .scene = scene,
        .places = alloc_array(scene->position_count, sizeof *m->places),
        .weights = alloc_array(corner_count, sizeof *m->weights),
        .first =
            alloc_array((size_t)scene->position_count + 1, sizeof *m->first),
        .items = alloc_array(corner_count, sizeof *m->items),
        .normals = alloc_array(corner_count, sizeof *m->normals),
        .blocks = alloc_array(block_count, sizeof *m->blocks),
        .block_count = block_count,
    };
    if (m->places == NULL || m->weights == NULL || m->first == NULL ||
        m->items == NULL || m->normals == NULL || m->blocks == NULL ||
        !weld_init(&m->weld, scene->position_count))
        return false;
    pool_each(pool, 1 + blocks_of(scene->tri_count, BLOCK_TRIS), prepare, m);
    weld_free(&m->weld);
    if (m->is_welded)
        sort_corners(m);
    return m->is_welded;
}

/* Frees what only the search for groups of corners needs. */
static void free_corners(struct mesh *m)
{
    free(m->weights);
    free(m->first);
    free(m->items);
    m->weights = NULL;
    m->first = m->items = NULL;
}

static void mesh_free(struct mesh *m)
{
    free_corners(m);
    free(m->places);
    free(m->normals);
    free(m->blocks);
}

/* ---- the corners at one place ---- */

static uint32_t find_root(struct spoke *spokes, uint32_t i)
{
    while (spokes[i].root != i) {
        spokes[i].root = spokes[spokes[i].root].root;
        i = spokes[i].root;
    }
    return i;
}

/* Joins two spokes that share an edge, unless it is a crease. The lower number
 * is the root. */
static void join(const struct mesh *m, struct fan *fan, uint32_t i, uint32_t j)
{
    struct vec3 a = m->scene->tris[fan->spokes[i].corner / 3].ng;
    struct vec3 b = m->scene->tris[fan->spokes[j].corner / 3].ng;

    if (v3_dot(a, b) < CREASE_COS)
        return;
    i = find_root(fan->spokes, i);
    j = find_root(fan->spokes, j);
    fan->spokes[i < j ? j : i].root = i < j ? i : j;
}

static int compare_behind(const void *a, const void *b, void *spokes)
{
    const struct spoke *s = spokes;
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

    if (s[x].behind != s[y].behind)
        return s[x].behind < s[y].behind ? -1 : 1;
    return x < y ? -1 : x > y;
}

/* Joins many spokes, which are sorted for this. */
static void join_many(const struct mesh *m, struct fan *fan)
{
    for (uint32_t i = 0; i < fan->count; i++)
        fan->order[i] = i;
    qsort_r(fan->order, fan->count, sizeof *fan->order, compare_behind,
            fan->spokes);
    for (uint32_t i = 0; i < fan->count; i++) {
        uint32_t low = 0, high = fan->count;

        while (low < high) {
            uint32_t middle = low + (high - low) / 2;

            if (fan->spokes[fan->order[middle]].behind < fan->spokes[i].ahead)
                low = middle + 1;
            else
                high = middle;
        }
        for (uint32_t k = low;
             k < fan->count && k < low + COPIES_MAX &&
             fan->spokes[fan->order[k]].behind == fan->spokes[i].ahead;
             k++)
            join(m, fan, i, fan->order[k]);
    }
}

static void join_few(const struct mesh *m, struct fan *fan)
{
    for (uint32_t i = 0; i < fan->count; i++)
        for (uint32_t j = 0; j < fan->count; j++)
            if (fan->spokes[j].behind == fan->spokes[i].ahead)
                join(m, fan, i, j);
}

static bool fill_fan(const struct mesh *m, struct fan *fan,
                     const uint32_t *items, uint32_t count)
{
    void *spokes = fan->spokes, *order = fan->order;

    if (!grow_array(&spokes, &fan->capacity, count, sizeof *fan->spokes))
        return false;
    fan->spokes = spokes;
    if (!grow_array(&order, &fan->order_capacity, count, sizeof *fan->order))
        return false;
    fan->order = order;
    fan->count = count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t corner = items[i], k = corner % 3;
        const uint32_t *v = m->scene->tris[corner / 3].v;

        fan->spokes[i] =
            (struct spoke){.corner = corner,
                           .ahead = m->places[v[k == 2 ? 0 : k + 1]],
                           .behind = m->places[v[k == 0 ? 2 : k - 1]],
                           .root = i};
    }
    return true;
}

/* Adds a normal for each group of spokes and gives it to their corners. */
static void add_normals(struct mesh *m, struct block *b, struct fan *fan)
{
    struct scene *s = m->scene;
    uint32_t base = b->begin + b->normal_count;

    for (uint32_t i = 0; i < fan->count; i++) {
        uint32_t corner = fan->spokes[i].corner;
        uint32_t root = find_root(fan->spokes, i); /* first of its group */
        uint32_t *vn = &s->tris[corner / 3].vn[corner % 3];
        struct vec3 n =
            v3_scale(s->tris[corner / 3].ng, (float)m->weights[corner]);

        if (root == i) {
            *vn = b->begin + b->normal_count++;
            m->normals[*vn] = n;
        } else {
            uint32_t first = fan->spokes[root].corner;

            *vn = s->tris[first / 3].vn[first % 3];
            m->normals[*vn] = v3_add(m->normals[*vn], n);
        }
    }
    for (uint32_t i = base; i < b->begin + b->normal_count; i++) {
        float length = v3_length(m->normals[i]);

        m->normals[i] = length > 0 ? v3_scale(m->normals[i], 1.0f / length)
                                   : v3(0.0f, 0.0f, 0.0f);
    }
}

static void smooth_block(void *context, uint32_t number, int worker)
{
    struct mesh *m = context;
    struct block *b = &m->blocks[number];
    struct fan fan = {.spokes = NULL};
    uint32_t place = number * BLOCK_PLACES;
    uint32_t end =
        place + u32_min(BLOCK_PLACES, m->scene->position_count - place);
    uint32_t begin = place > 0 ? m->first[place - 1] : 0;

    (void)worker;
    *b = (struct block){.begin = begin, .is_done = true};
    for (; place < end && b->is_done; place++) {
        uint32_t count = m->first[place] - begin;

        b->is_done = fill_fan(m, &fan, m->items + begin, count);
        if (b->is_done) {
            (count <= FEW ? join_few : join_many)(m, &fan);
            add_normals(m, b, &fan);
        }
        begin += count;
    }
    free(fan.spokes);
    free(fan.order);
}

/* Moves the normals together, into the scene. */
static bool take_normals(struct mesh *m)
{
    struct scene *s = m->scene;
    uint32_t count = 0;

    for (uint32_t i = 0; i < m->block_count; i++) {
        if (!m->blocks[i].is_done)
            return false;
        m->blocks[i].base = count;
        count += m->blocks[i].normal_count;
    }
    free(s->normals); /* those of the file that were all unusable */
    s->normals = alloc_array(count, sizeof *s->normals);
    if (s->normals == NULL)
        return false;
    for (uint32_t i = 0; i < m->block_count; i++)
        memcpy(s->normals + m->blocks[i].base, m->normals + m->blocks[i].begin,
               m->blocks[i].normal_count * sizeof *s->normals);
    s->normal_count = count;
    return true;
}

/* Gives the corners the final numbers of their normals. Triangles that are flat
 * or have none at a corner get none. */
static void number_block(void *context, uint32_t block, int worker)
{
    const struct mesh *m = context;
    const struct scene *s = m->scene;
    uint32_t begin = block * BLOCK_TRIS;
    uint32_t end = begin + u32_min(BLOCK_TRIS, s->tri_count - begin);

    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        struct tri *t = &s->tris[i];
        bool is_flat = true, has_all = true;

        for (int k = 0; k < 3; k++) {
            uint32_t place = m->places[t->v[k]];
            const struct block *b = &m->blocks[place / BLOCK_PLACES];
            struct vec3 n = m->normals[t->vn[k]];

            t->vn[k] += b->base - b->begin;
            has_all &= n.x != 0 || n.y != 0 || n.z != 0;
            is_flat &= v3_dot(n, t->ng) > FLAT_COS;
        }
        if (is_flat || !has_all)
            t->vn[0] = t->vn[1] = t->vn[2] = NO_INDEX;
    }
}

bool crease_normals(struct scene *scene, struct pool *pool)
{
    struct mesh m;
    bool ok;

    /* more corners than indices, in more memory than any machine has */
    if (scene->tri_count > (NO_INDEX - 1) / 3)
        return true;
    ok = mesh_init(&m, scene, pool);
    if (ok) {
        pool_each(pool, m.block_count, smooth_block, &m);
        free_corners(&m);
        ok = take_normals(&m);
    }
    if (ok)
        pool_each(pool, blocks_of(scene->tri_count, BLOCK_TRIS), number_block,
                  &m);
    mesh_free(&m);
    return ok;
}
