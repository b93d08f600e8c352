// SPDX-License-Identifier: MIT
#include "embree_racer.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/instance.h"

/* Memory of all devices; only one builds at a time. */
static atomic_long bytes_held;

static bool note_bytes(void *user, ssize_t bytes, bool post)
{
    (void)user;
    (void)post;
    atomic_fetch_add(&bytes_held, bytes);
    return true;
}

static void note_error(void *user, enum RTCError code, const char *text)
{
    (void)user;
    fprintf(stderr, "rays: Embree's error %d: %s\n", (int)code, text);
    exit(1);
}

/* Makes a geometry of consecutive triangles of the world's array. */
static RTCGeometry geometry_of(RTCDevice device, const struct world *w,
                               uint32_t first, uint32_t count)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof *w->positions,
                                w->settings.position_count);
    uint32_t *corners =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof *corners, count);

    memcpy(positions, w->positions,
           w->settings.position_count * sizeof *w->positions);
    for (uint32_t i = 0; i < count; i++)
        memcpy(&corners[3 * (size_t)i], w->tris[first + i].v,
               sizeof w->tris[first + i].v);
    return g;
}

/* Makes an instance of a scene. */
static RTCGeometry instance_in(RTCDevice device, const struct instance *at,
                               RTCScene mesh)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    float rows[12];

    for (int i = 0; i < 3; i++) {
        memcpy(&rows[4 * i], &at->rows[i], sizeof at->rows[i]);
        rows[4 * i + 3] = (&at->origin.x)[i];
    }
    rtcSetGeometryInstancedScene(g, mesh);
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
    return g;
}

/* Flushes denormal numbers to zero, as Embree's manual recommends, because they
 * are slow; this changes none of its hits. Returns the mode to restore. */
static unsigned flush_denormals(void)
{
    unsigned before = _mm_getcsr();

    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    return before;
}

static struct RTCIntersectContext context_of(enum RTCIntersectContextFlags f)
{
    struct RTCIntersectContext c;

    rtcInitIntersectContext(&c);
    c.flags = f;
    return c;
}

static struct RTCRay ray_of(const struct ray *r)
{
    return (struct RTCRay){.org_x = r->o.x,
                           .org_y = r->o.y,
                           .org_z = r->o.z,
                           .dir_x = r->d.x,
                           .dir_y = r->d.y,
                           .dir_z = r->d.z,
                           .tfar = r->t_max,
                           .mask = 0xffffffffu};
}

typedef struct answer embree_query(const struct embree *e,
                                   struct RTCIntersectContext *c,
                                   const struct ray *r);

/* Returns glim's number of a triangle. Instances have their index as ID. */
static uint32_t number_of(const struct embree *e, unsigned instance,
                          unsigned tri)
{
    return tri == RTC_INVALID_GEOMETRY_ID || instance == RTC_INVALID_GEOMETRY_ID
               ? tri
               : e->world->instances[instance].first_tri + tri;
}

static struct answer ask_closest(const struct embree *e,
                                 struct RTCIntersectContext *c,
                                 const struct ray *r)
{
    struct RTCRayHit q = {.ray = ray_of(r)};

    q.hit.geomID = q.hit.primID = RTC_INVALID_GEOMETRY_ID;
    q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(e->scene, c, &q);
    return (struct answer){q.ray.tfar,
                           number_of(e, q.hit.instID[0], q.hit.primID)};
}

static struct answer ask_any(const struct embree *e,
                             struct RTCIntersectContext *c, const struct ray *r)
{
    struct RTCRay q = ray_of(r);

    rtcOccluded1(e->scene, c, &q);
    return (struct answer){0.0f, q.tfar < 0.0f ? 0 : NO_INDEX};
}

/* Traces rays one by one. It is inlined, so that only Embree's calls are
 * timed. */
static inline __attribute__((always_inline)) void
ask_each(const struct embree *e, embree_query *ask, const struct ray *rays,
         uint32_t count, struct answer *answers)
{
    struct RTCIntersectContext c =
        context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    unsigned before = flush_denormals();

    for (uint32_t i = 0; i < count; i++)
        answers[i] = ask(e, &c, &rays[i]);
    _mm_setcsr(before);
}

static void closest(const void *tree, const struct ray *rays, uint32_t count,
                    struct answer *answers)
{
    ask_each(tree, ask_closest, rays, count, answers);
}

static void any(const void *tree, const struct ray *rays, uint32_t count,
                struct answer *answers)
{
    ask_each(tree, ask_any, rays, count, answers);
}

static void fill_packet(struct RTCRayHit8 *q, int lane, const struct ray *r)
{
    q->ray.org_x[lane] = r->o.x;
    q->ray.org_y[lane] = r->o.y;
    q->ray.org_z[lane] = r->o.z;
    q->ray.tnear[lane] = 0.0f;
    q->ray.dir_x[lane] = r->d.x;
    q->ray.dir_y[lane] = r->d.y;
    q->ray.dir_z[lane] = r->d.z;
    q->ray.time[lane] = 0.0f;
    q->ray.tfar[lane] = r->t_max;
    q->ray.mask[lane] = 0xffffffffu;
    q->ray.id[lane] = q->ray.flags[lane] = 0;
    q->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    q->hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
    q->hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

static void coherent(const void *tree, const struct ray *rays, uint32_t count,
                     struct answer *answers)
{
    const struct embree *e = tree;
    struct RTCIntersectContext c =
        context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    unsigned before = flush_denormals();

    for (uint32_t i = 0; i < count; i += 8) {
        uint32_t lanes = count - i < 8 ? count - i : 8;
        _Alignas(32) int valid[8];
        struct RTCRayHit8 q;

        for (uint32_t k = 0; k < 8; k++) {
            valid[k] = k < lanes ? -1 : 0;
            fill_packet(&q, (int)k, &rays[k < lanes ? i + k : i]);
        }
        rtcIntersect8(valid, e->scene, &c, &q);
        for (uint32_t k = 0; k < lanes; k++)
            answers[i + k] =
                (struct answer){q.ray.tfar[k], number_of(e, q.hit.instID[0][k],
                                                         q.hit.primID[k])};
    }
    _mm_setcsr(before);
}

static RTCScene new_scene(const struct embree *e, enum embree_kind kind)
{
    RTCScene scene = rtcNewScene(e->device);

    if (kind == EMBREE_ROBUST)
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, kind == EMBREE_FAST
                                       ? RTC_BUILD_QUALITY_HIGH
                                       : RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

/* Attaches a geometry under this ID and releases it. */
static void attach(RTCScene scene, RTCGeometry g, enum embree_kind kind,
                   uint32_t id)
{
    rtcSetGeometryBuildQuality(g, kind == EMBREE_FAST
                                      ? RTC_BUILD_QUALITY_HIGH
                                      : RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene, g, id);
    rtcReleaseGeometry(g);
}

/* Attaches the instances, whose meshes have a scene each. Returns the time that
 * these took. */
static struct spent attach_instances(const struct embree *e,
                                     enum embree_kind kind)
{
    const struct world *w = e->world;
    uint32_t count = w->settings.instance_count;
    RTCScene *meshes = calloc(count, sizeof *meshes);
    struct spent all = {0.0, 0.0};

    if (meshes == NULL)
        note_error(NULL, RTC_ERROR_OUT_OF_MEMORY, "no memory");
    for (uint32_t i = 0; i < count; i++) {
        const struct instance *at = &w->instances[i];
        RTCScene *mesh = &meshes[at->mesh];

        if (*mesh == NULL) {
            struct spent begin;

            *mesh = new_scene(e, kind);
            attach(*mesh,
                   geometry_of(e->device, w, at->mesh_tri, at->tri_count), kind,
                   0);
            begin = spent_now();
            rtcCommitScene(*mesh);
            begin = spent_since(begin);
            all.s += begin.s;
            all.cpu_s += begin.cpu_s;
        }
        attach(e->scene, instance_in(e->device, at, *mesh), kind, i);
    }
    for (uint32_t i = 0; i < count; i++)
        if (meshes[i] != NULL)
            rtcReleaseScene(meshes[i]);
    free(meshes);
    return all;
}

void embree_build(struct embree *e, const struct world *world,
                  enum embree_kind kind, int thread_count)
{
    char settings[32];
    struct spent begin, meshes = {0.0, 0.0};
    long before;

    e->world = world;
    snprintf(settings, sizeof settings, "threads=%d", thread_count);
    e->device = rtcNewDevice(settings);
    if (e->device == NULL)
        note_error(NULL, rtcGetDeviceError(NULL), "no device");
    rtcSetDeviceErrorFunction(e->device, note_error, NULL);
    rtcSetDeviceMemoryMonitorFunction(e->device, note_bytes, NULL);
    e->scene = new_scene(e, kind);
    if (plain_tri_count(world) > 0)
        attach(e->scene,
               geometry_of(e->device, world, 0, plain_tri_count(world)), kind,
               world->settings.instance_count);
    before = atomic_load(&bytes_held);
    if (has_instances(world))
        meshes = attach_instances(e, kind);
    begin = spent_now();
    rtcCommitScene(e->scene);
    begin = spent_since(begin);
    begin.s += meshes.s;
    begin.cpu_s += meshes.cpu_s;
    e->racer =
        (struct racer){e,     closest,
                       any,   coherent,
                       begin, (double)(atomic_load(&bytes_held) - before)};
}

void embree_free(struct embree *e)
{
    if (e->scene != NULL)
        rtcReleaseScene(e->scene);
    if (e->device != NULL)
        rtcReleaseDevice(e->device);
    *e = (struct embree){.scene = NULL};
}
