// SPDX-License-Identifier: MIT
#include "world/world_smoke.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "scene/material.h"

/* Largest extinction of a world, so that products with distances stay finite.
 */
#define EXTINCTION_MAX 1e30f

/* Most values of all grids: 8 GiB. */
#define VOXELS_MAX ((uint64_t)1 << 31)

/* A grid of a file in voxel_places and voxels. */
struct world_grid {
    char *path, *name;
    struct affine to_file;    /* from voxels, counted from the first brick's */
    double first[3], last[3]; /* active voxels: the box of the grid */
    double low[3], high[3];   /* those of them that bricks hold */
    uint32_t sides[3];        /* in bricks, and those of the file before */
    uint32_t before[3];
    uint32_t first_place;
    float most;    /* largest value, at least 0 */
    bool is_empty; /* it has no active voxel */
};

/* ---- grids ---- */

static const struct world_grid *find_grid(const struct host_world *host,
                                          const char *path, const char *name)
{
    for (uint32_t i = 0; i < host->grid_count; i++)
        if (strcmp(host->grids[i].path, path) == 0 &&
            strcmp(host->grids[i].name, name) == 0)
            return &host->grids[i];
    return NULL;
}

bool world_has_grid(const struct host_world *host, const char *path,
                    const char *name)
{
    return find_grid(host, path, name) != NULL;
}

/* Makes room for one more grid, and for its places and voxels. There is always
 * room for one of each, since realloc() of nothing would free. */
static bool make_room(struct host_world *host, uint64_t places, uint64_t voxels)
{
    struct world_grid *grids =
        realloc(host->grids, (host->grid_count + 1ull) * sizeof *grids);
    struct voxel_place *all =
        realloc(host->voxel_places,
                (host->voxel_place_count + places + 1) * sizeof *all);
    float *values = realloc(host->voxels,
                            (host->voxel_count + voxels + 1) * sizeof *values);

    if (grids != NULL)
        host->grids = grids;
    if (all != NULL)
        host->voxel_places = all;
    if (values != NULL)
        host->voxels = values;
    return grids != NULL && all != NULL && values != NULL;
}

/* Rounds a voxel down to the first one of its brick. */
static int64_t brick_floor(int64_t voxel)
{
    return voxel & ~(int64_t)(BRICK_SIDE - 1);
}

/* Makes a grid without bricks. Active voxels outside of the file's bricks are
 * background. They need bricks if that is a density; otherwise nothing is
 * there. */
static struct world_grid make_grid(const struct voxel_grid *g)
{
    struct affine local = {.m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    struct world_grid made = {.is_empty = false};

    for (int a = 0; a < 3; a++)
        made.is_empty = made.is_empty || g->first[a] > g->last[a];
    for (int a = 0; a < 3; a++) {
        int64_t begin = g->origin[a];
        int64_t end = begin + (int64_t)g->sides[a] * BRICK_SIDE;

        if (!made.is_empty && g->background > 0) {
            int64_t first = brick_floor(g->first[a]);
            int64_t last = brick_floor(g->last[a]) + BRICK_SIDE;

            if (begin == end)
                begin = end = first;
            begin = begin < first ? begin : first;
            end = end > last ? end : last;
        }
        local.m[a][3] = (double)begin;
        made.before[a] = (uint32_t)((g->origin[a] - begin) / BRICK_SIDE);
        made.sides[a] = (uint32_t)((end - begin) / BRICK_SIDE);
        made.first[a] = (double)(g->first[a] - begin);
        made.last[a] = (double)(g->last[a] - begin);
        made.low[a] = fmax(made.first[a], 0);
        made.high[a] = fmin(made.last[a], (double)(end - begin - 1));
    }
    made.to_file = affine_join(&g->to_world, &local);
    return made;
}

static uint64_t place_count(const struct world_grid *g)
{
    return (uint64_t)g->sides[0] * g->sides[1] * g->sides[2];
}

/* Returns a place of the made grid, which the file may lack. */
static struct voxel_place place_of(const struct voxel_grid *g,
                                   const struct world_grid *made, uint64_t i)
{
    const uint32_t *n = g->sides, *m = made->sides;
    uint64_t x = i / m[2] / m[1] - made->before[0];
    uint64_t y = i / m[2] % m[1] - made->before[1];
    uint64_t z = i % m[2] - made->before[2];
    uint64_t at = (x * n[1] + y) * n[2] + z;

    if (x >= n[0] || y >= n[1] || z >= n[2])
        return (struct voxel_place){BRICK_EMPTY, fmaxf(g->background, 0)};
    return (struct voxel_place){g->index[at], fmaxf(g->majorants[at], 0)};
}

/* Appends the bricks of a grid. The arrays have room. */
static void add_bricks(struct host_world *host, const struct voxel_grid *g,
                       struct world_grid *made)
{
    uint32_t first_brick = host->voxel_count / BRICK_VOXELS;

    made->first_place = host->voxel_place_count;
    for (uint64_t i = 0; i < place_count(made); i++) {
        struct voxel_place place = place_of(g, made, i);

        made->most = fmaxf(made->most, place.majorant);
        place.brick += first_brick;
        host->voxel_places[host->voxel_place_count++] = place;
    }
    memcpy(host->voxels + host->voxel_count, g->values,
           (size_t)g->brick_count * BRICK_VOXELS * sizeof *g->values);
    host->voxel_count += g->brick_count * BRICK_VOXELS;
}

bool world_add_grid(struct host_world *host, const char *path, const char *name,
                    const struct voxel_grid *grid, struct error *err)
{
    struct world_grid made = make_grid(grid);
    uint64_t places = place_count(&made);
    uint64_t voxels = (uint64_t)grid->brick_count * BRICK_VOXELS;

    if (places > BRICK_PLACES_MAX)
        return fail(err,
                    "%s: found a box of %" PRIu32 " x %" PRIu32 " x %" PRIu32
                    " active bricks, expected at most %" PRIu64 " in all",
                    path, made.sides[0], made.sides[1], made.sides[2],
                    BRICK_PLACES_MAX);
    if (host->voxel_count + voxels > VOXELS_MAX ||
        host->voxel_place_count + places > UINT32_MAX)
        return fail(err,
                    "%s: found more voxels than the %lu of all grids "
                    "together that are possible",
                    path, (unsigned long)VOXELS_MAX);
    made.path = strdup(path);
    made.name = strdup(name);
    if (made.path == NULL || made.name == NULL ||
        !make_room(host, places, voxels)) {
        free(made.path);
        free(made.name);
        return fail(err, "%s: out of memory for its voxels", path);
    }
    add_bricks(host, grid, &made);
    host->grids[host->grid_count++] = made;
    world_renew(host, WORLD_VOXELS);
    return true;
}

/* ---- where a grid is ---- */

/* Inverts a map. Returns false if it is flat, or beyond doubles. */
static bool invert(const struct affine *a, struct affine *to)
{
    double columns[3][3], volume;

    for (int i = 0; i < 3; i++)
        vec3d_cross(a->m[(i + 1) % 3], a->m[(i + 2) % 3], columns[i]);
    volume = vec3d_dot(a->m[0], columns[0]);
    if (!(fabs(volume) > 0 && fabs(volume) < INFINITY))
        return false;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            to->m[i][k] = columns[k][i] / volume;
        to->m[i][3] = 0;
    }
    for (int i = 0; i < 3; i++)
        to->m[i][3] = -(to->m[i][0] * a->m[0][3] + to->m[i][1] * a->m[1][3] +
                        to->m[i][2] * a->m[2][3]);
    return true;
}

/* Returns the map from the file of the grid to the scene. `density` is the grid
 * whose box counts. */
static struct affine placing(const struct smoke *s,
                             const struct world_grid *density)
{
    static const struct affine turned = {
        .m = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}}};
    static const struct affine same = {
        .m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const struct smoke_numbers *n = &s->numbers;
    struct affine up = s->up_is_z ? turned : same;
    struct affine place = {.m = {{n->scale, 0, 0, n->at[0]},
                                 {0, n->scale, 0, n->at[1]},
                                 {0, 0, n->scale, n->at[2]}}};

    if (smoke_has_box(n)) {
        struct affine to = affine_join(&up, &density->to_file);
        double low[3], high[3];

        voxel_box_bounds(density->first, density->last, &to, low, high);
        for (int a = 0; a < 3; a++) {
            double factor = (n->box[a + 3] - n->box[a]) / (high[a] - low[a]);

            place.m[a][a] = factor;
            place.m[a][3] = n->box[a] - low[a] * factor;
        }
    }
    return affine_join(&place, &up);
}

static struct vec3 as_floats(const double v[3])
{
    return v3((float)v[0], (float)v[1], (float)v[2]);
}

static struct vec3 scaled(const double v[3], double factor)
{
    const double to[3] = {v[0] * factor, v[1] * factor, v[2] * factor};

    return as_floats(to);
}

/* Makes the field of a grid that has this map from its file to the scene. */
static bool make_field(const struct scene *scene, const struct world_grid *g,
                       const struct affine *place, struct voxel_field *to)
{
    double s = scene->scale;
    const double *c = scene->center;
    struct affine normalised = {.m = {{s, 0, 0, -c[0] * s},
                                      {0, s, 0, -c[1] * s},
                                      {0, 0, s, -c[2] * s}}};
    struct affine map = affine_join(place, &g->to_file), back;

    map = affine_join(&normalised, &map);
    if (!invert(&map, &back))
        return false;
    for (int i = 0; i < 3; i++) {
        to->rows[i] = as_floats(back.m[i]);
        to->sides[i] = g->sides[i];
        if (!(v3_length(to->rows[i]) < INFINITY && fabs(back.m[i][3]) < 1e30))
            return false;
    }
    to->origin =
        v3((float)back.m[0][3], (float)back.m[1][3], (float)back.m[2][3]);
    to->first = as_floats(g->low);
    to->last = as_floats(g->high);
    to->first_place = g->first_place;
    return true;
}

/* ---- what a smoke does ---- */

/* Fills a table of the radiance of black bodies up to a temperature, by equal
 * steps. The last one has this luminance. */
static void fill_glow(double kelvin, double luminance,
                      struct vec3 table[GLOW_ENTRIES])
{
    double last = blackbody_log_luminance(kelvin);

    for (int i = 0; i < GLOW_ENTRIES; i++) {
        double t = kelvin * i / (GLOW_ENTRIES - 1), rgb[3] = {0, 0, 0};

        if (t >= BLACKBODY_MIN) {
            double part = exp(blackbody_log_luminance(t) - last) * luminance;

            blackbody_rgb(t, rgb);
            for (int k = 0; k < 3; k++)
                rgb[k] *= part;
        }
        table[i] = as_floats(rgb);
    }
}

/* What is built for a world. */
struct made {
    struct smoke_medium smokes[SMOKES_MAX];
    struct vec3 glows[SMOKES_MAX * GLOW_ENTRIES];
    uint32_t count, glow_count;
};

static bool make_glow(const struct host_world *host, const struct scene *scene,
                      const struct smoke *s, const struct affine *place,
                      struct smoke_medium *m, struct made *made)
{
    const struct world_grid *g;
    double kelvin;

    m->first_glow = NO_INDEX;
    if (s->temperature[0] == '\0' || !(s->numbers.glow > 0))
        return true;
    g = find_grid(host, s->path, s->temperature);
    kelvin = g->is_empty
                 ? 0
                 : fmin((double)g->most * s->numbers.kelvin, BLACKBODY_MAX);
    if (kelvin < BLACKBODY_MIN)
        return true;
    m->first_glow = made->glow_count;
    m->glow_scale = (float)((GLOW_ENTRIES - 1) * s->numbers.kelvin / kelvin);
    fill_glow(kelvin, fmin(s->numbers.glow, (double)EXTINCTION_MAX),
              made->glows + made->glow_count);
    made->glow_count += GLOW_ENTRIES;
    return make_field(scene, g, place, &m->temperature);
}

/* Makes a smoke, or leaves it out if it has no effect. */
static bool make_smoke(const struct host_world *host, const struct scene *scene,
                       const struct smoke *s, struct made *made,
                       struct error *err)
{
    const struct world_grid *g = find_grid(host, s->path, s->grid);
    struct smoke_medium *m = &made->smokes[made->count];
    double per_unit = 1 / scene->scale;
    struct affine place;
    double most = 0, limit;

    for (int k = 0; k < 3; k++)
        most = fmax(most,
                    (s->numbers.scatter[k] + s->numbers.absorb[k]) * per_unit);
    if (g->is_empty || !(g->most > 0) || !(most > 0))
        return true;
    /* all coefficients by one factor, so that the albedo stays */
    limit = (double)EXTINCTION_MAX / fmax((double)g->most, 1);
    per_unit *= fmin(1, limit / most);
    *m = (struct smoke_medium){.anisotropy =
                                   medium_anisotropy(s->numbers.anisotropy)};
    m->scattering = scaled(s->numbers.scatter, per_unit);
    m->extinction = v3_add(m->scattering, scaled(s->numbers.absorb, per_unit));
    m->most = v3_max_component(m->extinction);
    if (!(m->most >= FLT_MIN)) /* its inverse is beyond floats */
        return true;
    place = placing(s, g);
    if (!make_field(scene, g, &place, &m->density) ||
        !make_glow(host, scene, s, &place, m, made))
        return fail(err, "%s: found a grid that is flat or too far away",
                    s->path);
    made->count++;
    return true;
}

/* Returns true if the arrays of the world are these. */
static bool is_current(const struct host_world *host, const struct made *m)
{
    return m->count == host->smoke_count && m->glow_count == host->glow_count &&
           (m->count == 0 || memcmp(m->smokes, host->smokes,
                                    m->count * sizeof *m->smokes) == 0) &&
           (m->glow_count == 0 ||
            memcmp(m->glows, host->glows, m->glow_count * sizeof *m->glows) ==
                0);
}

bool world_set_smokes(struct host_world *host, const struct scene *scene,
                      const struct smokes *smokes, struct error *err)
{
    struct made *m = calloc(1, sizeof *m);
    bool ok = m != NULL || fail(err, "out of memory for smoke");

    for (uint32_t i = 0; ok && i < smokes->count; i++)
        ok = make_smoke(host, scene, &smokes->items[i], m, err);
    if (ok && !is_current(host, m)) {
        struct smoke_medium *own = alloc_array(m->count, sizeof *own);
        struct vec3 *glows = alloc_array(m->glow_count, sizeof *glows);

        ok = (own != NULL && glows != NULL) ||
             fail(err, "out of memory for smoke");
        if (ok) {
            memcpy(own, m->smokes, m->count * sizeof *own);
            memcpy(glows, m->glows, m->glow_count * sizeof *glows);
            free(host->smokes);
            free(host->glows);
            host->smokes = own;
            host->glows = glows;
            host->smoke_count = m->count;
            host->glow_count = m->glow_count;
            own = NULL;
            glows = NULL;
            world_renew(host, WORLD_SMOKES);
        }
        free(own);
        free(glows);
    }
    free(m);
    return ok;
}

void world_free_smokes(struct host_world *host)
{
    for (uint32_t i = 0; i < host->grid_count; i++) {
        free(host->grids[i].path);
        free(host->grids[i].name);
    }
    free(host->grids);
    free(host->voxel_places);
    free(host->voxels);
    free(host->smokes);
    free(host->glows);
}
