// SPDX-License-Identifier: MIT
#include "world/bvh/instance_trees.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "kernels/instance.h"

struct bounds {
    struct vec3 lo, hi;
};

struct bounds_job {
    const struct instance_trees *trees;
    struct bounds *bounds;
};

static struct bounds bounds_of(const struct world *w, uint32_t first,
                               uint32_t count)
{
    struct bounds b = {{FLT_MAX, FLT_MAX, FLT_MAX},
                       {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 p = w->positions[w->tris[i].v[k]];

            b.lo = v3_min(b.lo, p);
            b.hi = v3_max(b.hi, p);
        }
    return b;
}

static void find_bounds(void *context, uint32_t mesh, int worker)
{
    const struct bounds_job *job = context;
    const struct world *w = &job->trees->meshes[mesh];

    (void)worker;
    job->bounds[mesh] = bounds_of(w, 0, w->settings.tri_count);
}

void instance_box_corners(const struct world *w, uint32_t instance,
                          struct mesh_box *box, struct vec3 corners[8])
{
    const struct instance *at = &w->instances[instance];

    if (box->mesh != at->mesh) {
        struct bounds b = bounds_of(w, at->mesh_tri, at->tri_count);

        *box = (struct mesh_box){at->mesh, b.lo, b.hi};
    }
    for (int i = 0; i < 8; i++)
        corners[i] = instance_point(*at, v3(i & 1 ? box->hi.x : box->lo.x,
                                            i & 2 ? box->hi.y : box->lo.y,
                                            i & 4 ? box->hi.z : box->lo.z));
}

/* Sets the coordinates of a stand-in's box along an axis. Half an ulp of the
 * moved corners is within BOX_PAD. */
static void set_slab(float *lo, float *hi, const struct instance *at, int axis,
                     const struct bounds *b)
{
    const struct vec3 *row = &at->rows[axis];
    const double m[3] = {(double)row->x, (double)row->y, (double)row->z};
    const float low[3] = {b->lo.x, b->lo.y, b->lo.z};
    const float high[3] = {b->hi.x, b->hi.y, b->hi.z};
    const float origin[3] = {at->origin.x, at->origin.y, at->origin.z};
    double from = (double)origin[axis], to = from;

    for (int k = 0; k < 3; k++) {
        from += fmin(m[k] * (double)low[k], m[k] * (double)high[k]);
        to += fmax(m[k] * (double)low[k], m[k] * (double)high[k]);
    }
    *lo = (float)from;
    *hi = (float)to;
}

static void add_stand_in(struct instance_trees *t, struct bounds box)
{
    uint32_t i = t->stand_ins.settings.tri_count++;

    t->corners[2 * i] = box.lo;
    t->corners[2 * i + 1] = box.hi;
    t->tris[i].v[0] = t->tris[i].v[2] = 2 * i;
    t->tris[i].v[1] = 2 * i + 1;
}

static void add_stand_ins(struct instance_trees *t, const struct world *w,
                          const struct bounds *bounds)
{
    for (uint32_t i = 0; i < w->settings.instance_count; i++) {
        const struct instance *at = &w->instances[i];
        struct bounds box;

        for (int axis = 0; axis < 3; axis++)
            set_slab(&box.lo.x + axis, &box.hi.x + axis, at, axis,
                     &bounds[at->mesh]);
        add_stand_in(t, box);
    }
    if (plain_tri_count(w) > 0)
        add_stand_in(t, bounds[t->mesh_count - 1]);
}

static bool set_meshes(struct instance_trees *t, const struct world *w)
{
    for (uint32_t i = 0; i < w->settings.instance_count; i++)
        if (w->instances[i].mesh >= t->mesh_count)
            t->mesh_count = w->instances[i].mesh + 1;
    t->mesh_count++;
    t->meshes = alloc_array(t->mesh_count, sizeof *t->meshes);
    if (t->meshes == NULL)
        return false;
    for (uint32_t i = 0; i < w->settings.instance_count; i++) {
        const struct instance *at = &w->instances[i];
        struct world *mesh = &t->meshes[at->mesh];

        *mesh = *w;
        mesh->tris += at->mesh_tri;
        mesh->settings.tri_count = at->tri_count;
        mesh->settings.instance_count = 0;
    }
    t->meshes[t->mesh_count - 1] = *w;
    t->meshes[t->mesh_count - 1].settings.tri_count = plain_tri_count(w);
    t->meshes[t->mesh_count - 1].settings.instance_count = 0;
    return true;
}

bool instance_trees_init(struct instance_trees *t, const struct world *w,
                         struct pool *pool)
{
    size_t count = (size_t)w->settings.instance_count + 1;
    struct bounds *bounds;

    *t = (struct instance_trees){.mesh_count = 0};
    if (!set_meshes(t, w))
        return false;
    t->tris = alloc_array(count, sizeof *t->tris);
    t->corners = alloc_array(2 * count, sizeof *t->corners);
    t->stand_ins = *w; /* copies of instances are found by these */
    t->stand_ins.tris = t->tris;
    t->stand_ins.positions = t->corners;
    t->stand_ins.settings.tri_count = 0;
    bounds = alloc_array(t->mesh_count, sizeof *bounds);
    if (t->tris != NULL && t->corners != NULL && bounds != NULL) {
        pool_each(pool, t->mesh_count, find_bounds,
                  &(struct bounds_job){t, bounds});
        add_stand_ins(t, w, bounds);
        free(bounds);
        return true;
    }
    free(bounds);
    instance_trees_free(t);
    return false;
}

void instance_trees_free(struct instance_trees *t)
{
    free(t->meshes);
    free(t->tris);
    free(t->corners);
    *t = (struct instance_trees){.meshes = NULL};
}
