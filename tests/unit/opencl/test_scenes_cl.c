// SPDX-License-Identifier: MIT
/*
 * test_scenes_cl.c - scenes with every feature on the OpenCL device and on the
 * CPU: the shipped scenes, edited ones, lamps, media, and random glTF files
 */
#include "tests/unit/files.h"
#include "tests/unit/folder.h"
#include "tests/unit/opencl/pair.h"
#include "tests/unit/opencl/random_gltf.h"
#include "tests/unit/smoke_world.h"
#include "world/world_lamps.h"
#include "world/world_materials.h"

static const char *const scenes[] = {
    "scenes/cornell.obj",    "scenes/materials.obj", "scenes/glass_mirror.obj",
    "scenes/interior.obj",   "scenes/skylit.obj",    "scenes/lights200.obj",
    "scenes/principled.obj", "scenes/bottles.glb",   "scenes/bubbles.glb",
    "scenes/chess.glb",      "scenes/forest.glb",    "scenes/jellyfish.glb",
    "scenes/knot.glb",       "scenes/prism.obj",     "scenes/lantern.obj",
    "scenes/fog.obj",        "scenes/busts.glb",     "scenes/milk.obj",
};

static void shipped_scenes_are_equal(void **state)
{
    (void)state;
    for (size_t i = 0; device && i < sizeof scenes / sizeof scenes[0]; i++) {
        if (!check_is_due(2))
            continue;
        struct pair p;

        open_pair(&p, scenes[i], 97, 55);
        render_both(&p, (struct rect){0, 0, 97, 55}, 5, (uint32_t)i);
        close_pair(&p);
    }
}

/* Materials, lights and triangles are swapped and freed between pictures, and
 * the device sees each change. */
static void edited_worlds_are_equal(void **state)
{
    struct material_values sources[32];
    uint32_t assigned[64];
    struct pair p;
    uint64_t seed = 9;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/cornell.obj", 48, 48);
    assert_in_range(p.scene.material_count, 2, 32);
    assert_in_range(p.scene.object_count, 2, 64);
    for (uint32_t i = 0; i < p.scene.material_count; i++)
        sources[i] = p.scene.material_origins[i].source;
    for (uint32_t i = 0; i < p.scene.object_count; i++)
        assigned[i] = NO_INDEX;
    render_both(&p, (struct rect){0, 0, 48, 48}, 2, 0);
    for (uint32_t round = 1; round < 20; round++) {
        uint32_t count = p.scene.material_count - 1;
        uint32_t m = 1 + (uint32_t)(check_random(&seed) * count);
        uint32_t o = (uint32_t)(check_random(&seed) * p.scene.object_count);
        struct error err;

        sources[m].base_color =
            (struct mtl_color){{check_random(&seed), 0.5, 0.5}, 1};
        if (round % 3 == 1)
            sources[m].emission =
                (struct mtl_color){{3 * check_random(&seed), 1, 1}, 1};
        if (round % 3 == 2)
            assigned[o] = m;
        check_or_say(world_set_materials(&p.world, &p.scene, count + 1, sources,
                                         assigned, &err),
                     err.text);
        render_both(&p, (struct rect){0, 0, 48, 48}, 2, round);
    }
    close_pair(&p);
}

/* A profile without symmetry. */
static struct profile *make_profile(void)
{
    struct profile *p = profile_create("a.ies", 8);

    assert_non_null(p);
    for (uint32_t i = 0; i < profile_value_count(p); i++)
        p->values[i] = (float)(1 + i % 13) / 13;
    return p;
}

/* Lamps of each kind come and go, with a size and with a profile. */
static void lamps_are_equal(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/materials.obj", 48, 48);
    for (uint32_t i = 0; i < 9; i++) {
        enum lamp_kind kind = (enum lamp_kind)(i % LAMP_KINDS);
        struct lamp lamp;
        struct error err;

        lamp_init(&lamp, kind);
        for (int k = 0; k < 3; k++)
            lamp.position[k] =
                p.view.pose.eye[k] + (k == 1 ? 0.5 * (double)i : 0);
        memcpy(lamp.at, p.view.pose.at, sizeof lamp.at);
        lamp.elevation_deg = 40;
        if (i >= 3) {
            lamp.radius = 0.1 * i;
            lamp.angle_deg = 5 * i;
        }
        if (i == 6)
            lamps_free(&p.view.lamps);
        lamp.profile = i == 1 || i == 6 ? make_profile() : NULL;
        assert_true(lamps_add(&p.view.lamps, &lamp));
        profile_release(lamp.profile);
        check_or_say(world_set_lamps(&p.world, &p.scene, &p.view, &err) &&
                         world_guide(&p.world, &p.scene, &p.view, &err),
                     err.text);
        render_both(&p, (struct rect){0, 0, 48, 48}, 2, i);
    }
    close_pair(&p);
}

/* ---- media ---- */

static const char media_mtl[] =
    "newmtl floor\nKd .7 .6 .5\n"
    "newmtl lamp\nKd 0\nKe 9 8 7\n"
    "newmtl smoke\nillum 7\nNi 1\nTf_scatter 1 2 4\nTf_absorb .5 .2 0\n"
    "Tf_anisotropy .6\n"
    "newmtl core\nillum 7\nNi 1\nTf_scatter 9 3 1\nTf_anisotropy -.4\n"
    "newmtl milk\nillum 7\nNi 1.34\nTf .8\nTf_distance .3\n"
    "Tf_attenuation .2 .3 .4\nTf_multiscatter .9 .8 .7\n"
    "newmtl frosted\nillum 7\nNi 1.5\nPr .5\nTf_scatter 2\nTf_absorb 0 .1 1\n"
    "newmtl wax\nKd .9 .8 .6\nKs .5\nPr .3\nPm .2\nTf .2\nPc .5\nPs .3\nPf .4\n"
    "Sf .8\nSr .1 .07 .05\nSg .3\n"
    "newmtl chalk\nKd .9 .8 .8\nKd_roughness .6\nSf .4\nSr .02 .02 .03\n";

/* Writes a box whose faces point outwards. */
static void put_box(FILE *f, const char *material, const double low[3],
                    const double high[3])
{
    static const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                    {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};

    fprintf(f, "usemtl %s\n", material);
    for (int i = 0; i < 8; i++)
        fprintf(f, "v %g %g %g\n", i & 1 ? high[0] : low[0],
                i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    for (int i = 0; i < 6; i++)
        fprintf(f, "f %d %d %d %d\n", faces[i][0] - 9, faces[i][1] - 9,
                faces[i][2] - 9, faces[i][3] - 9);
}

/* Writes bodies on a floor: smoke around a core, milk in smooth and in rough
 * glass, which touches the floor, two bodies with light below their surface,
 * and a lamp over them if it is wanted. */
static void put_media(const char *view, bool has_lamp)
{
    char path[sizeof folder + 32];
    FILE *f;

    snprintf(path, sizeof path, "%s/media.mtl", folder);
    put_bytes(path, media_mtl, strlen(media_mtl));
    snprintf(path, sizeof path, "%s/media.view", folder);
    put_bytes(path, view, strlen(view));
    snprintf(path, sizeof path, "%s/media.obj", folder);
    f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "mtllib media.mtl\nusemtl floor\nv -4 0 4\nv 4 0 4\nv 4 0 -4\n"
               "v -4 0 -4\nf -4 -3 -2 -1\n");
    put_box(f, "smoke", (const double[3]){-1, .2, -1},
            (const double[3]){.2, 1.4, .2});
    put_box(f, "core", (const double[3]){-.7, .5, -.7},
            (const double[3]){-.1, 1, -.1});
    put_box(f, "milk", (const double[3]){.4, .1, -.6},
            (const double[3]){1, 1, 0});
    put_box(f, "frosted", (const double[3]){.2, 0, .3},
            (const double[3]){.8, .5, .9});
    put_box(f, "wax", (const double[3]){-.6, 0, .7},
            (const double[3]){-.3, .4, 1});
    put_box(f, "chalk", (const double[3]){-.2, 0, .8},
            (const double[3]){0, .3, 1});
    if (has_lamp)
        fprintf(f, "usemtl lamp\nv -.5 2 .5\nv -.5 2 -.5\nv .5 2 -.5\n"
                   "v .5 2 .5\nf -4 -3 -2 -1\n");
    assert_int_equal(fclose(f), 0);
}

#define OUTSIDE "eye 0 1.2 4\nat 0 .6 0\n"

/* Bodies and fog under each kind of light, seen from outside and inside. */
static void media_are_equal(void **state)
{
    static const struct {
        const char *view;
        bool has_lamp;
    } cases[] = {
        {OUTSIDE "background .5 .6 .7\n", true},
        {OUTSIDE "light point 1 2 1 intensity 3 3 3\n"
                 "fog scatter .1 .2 .3 absorb .1 0 0 anisotropy .7\n",
         false},
        {OUTSIDE "sun 120 30\nfog scatter .3 .2 .1 height .5 falloff .4\n",
         false},
        {"eye -.9 1 -.3\nat .6 .5 -.3\nlight spot 0 2 2 at 0 0 0 radius .2\n"
         "light directional 20 50 angle 2\n",
         true},
        {"eye -.4 .8 -.4\nat 1 .4 .3\nbackground 1 1 1\n"
         "fog absorb .3 .2 .1 falloff 2\n",
         false},
        {"eye .7 .5 -.3\nat -.4 .8 -.4\naperture .1\nbackground 1 .9 .8\n",
         true},
        {OUTSIDE "max_bounces 2\nlight point 1 .3 1 radius .1\n"
                 "fog scatter 1 0 9 anisotropy -1\n",
         true},
    };

    (void)state;
    for (uint32_t i = 0; device && i < sizeof cases / sizeof cases[0]; i++) {
        char path[sizeof folder + 32];
        struct pair p;

        put_media(cases[i].view, cases[i].has_lamp);
        snprintf(path, sizeof path, "%s/media.obj", folder);
        open_pair(&p, path, 48, 36);
        assert_true((world_features(&p.world) & FEATURE_MEDIA) != 0);
        assert_true((world_features(&p.world) & FEATURE_SUBSURFACE) != 0);
        render_both(&p, (struct rect){0, 0, 48, 36}, 5, i);
        p.has_surfaces = true;
        render_both(&p, (struct rect){0, 0, 48, 36}, 2, i);
        p.has_surfaces = false;
        if (check_is_thorough())
            render_special(&p, (struct rect){0, 0, 48, 36}, 3, i);
        close_pair(&p);
    }
}

/* ---- smokes ---- */

/* Returns one of two grids of random numbers with empty bricks. */
static struct voxel_grid random_grid(int which, float most)
{
    static const uint32_t size[3] = {13, 19, 10};
    static float numbers[13 * 19 * 10];
    uint64_t seed = 3;

    for (uint32_t k = 0; k < 13 * 19 * 10; k++)
        numbers[k] = k / 247 / 8 == (uint32_t)which || k / 13 % 19 / 8 == 1
                         ? 0
                         : most * (float)check_random(&seed);
    return grid_of(size, numbers);
}

/* Writes both grids, as NumPy files. */
static void put_grids(void)
{
    static const uint32_t size[3] = {13, 19, 10};
    static float numbers[13 * 19 * 10];

    for (int i = 0; i < 2; i++) {
        struct voxel_grid grid = random_grid(i, 1);
        char path[sizeof folder + 32];
        size_t size_bytes;
        char *bytes;

        for (uint32_t k = 0; k < 13 * 19 * 10; k++)
            numbers[k] =
                voxel_grid_value(&grid, k % 13, k / 13 % 19, k / 13 / 19);
        bytes = npy_file_of(size, numbers, &size_bytes);
        snprintf(path, sizeof path, "%s/%d.npy", folder, i);
        put_bytes(path, bytes, size_bytes);
        free(bytes);
        voxel_grid_free(&grid);
    }
}

/* Gives smokes temperatures, which no NumPy file has. */
static void set_fire(struct pair *p)
{
    struct error err;

    for (uint32_t i = 0; i < p->view.smokes.count; i++) {
        struct smoke *s = &p->view.smokes.items[i];
        struct voxel_grid heat = random_grid((int)i, 2500);

        free(s->temperature);
        s->temperature = strdup("heat");
        s->numbers.glow = 3;
        check_or_say(world_add_grid(&p->world, s->path, "heat", &heat, &err),
                     err.text);
        voxel_grid_free(&heat);
    }
    check_or_say(world_set_smokes(&p->world, &p->scene, &p->view.smokes, &err),
                 err.text);
    assert_true(p->world.glow_count > 0);
}

#define SMOKE                                                          \
    "medium 0.npy scatter 3 2 1 absorb 0 .5 1 anisotropy .6 up z box " \
    "-1.5 0 -1.5 1.5 1.8 1\n"
#define OTHER                                                                \
    "medium 1.npy scatter .5 0 4 absorb .2 .1 0 anisotropy -.4 scale .1 at " \
    "-.3 .2 0\n"

/* Smokes of several colours and fire, beside bodies and in fog, under each kind
 * of light. */
static void smokes_are_equal(void **state)
{
    static const struct {
        const char *view;
        bool has_lamp, is_hot;
    } cases[] = {
        {OUTSIDE "background .5 .6 .7\n" SMOKE, true, false},
        {OUTSIDE "light point 1 2 1 intensity 3 3 3\n" SMOKE OTHER
                 "fog scatter .1 .2 .3 absorb .1 0 0 anisotropy .7\n",
         false, true},
        {"eye -.3 1.2 .8\nat .6 .5 -.3\nlight spot 0 2 2 at 0 0 0 radius .2\n"
         "light directional 20 50 angle 2\n" SMOKE OTHER,
         true, true},
        {OUTSIDE "sun 120 30\nfog absorb .3 .2 .1 height .5 falloff .4\n" OTHER,
         false, false},
    };

    (void)state;
    put_grids();
    for (uint32_t i = 0; device && i < sizeof cases / sizeof cases[0]; i++) {
        char path[sizeof folder + 32];
        struct pair p;

        put_media(cases[i].view, cases[i].has_lamp);
        snprintf(path, sizeof path, "%s/media.obj", folder);
        open_pair(&p, path, 48, 36);
        if (cases[i].is_hot)
            set_fire(&p);
        assert_true((world_features(&p.world) & FEATURE_GRIDS) != 0);
        render_both(&p, (struct rect){0, 0, 48, 36}, 5, i);
        p.has_surfaces = true;
        render_both(&p, (struct rect){0, 0, 48, 36}, 2, i);
        p.has_surfaces = false;
        if (check_is_thorough())
            render_special(&p, (struct rect){0, 0, 48, 36}, 3, i);
        close_pair(&p);
    }
}

/* What the random files are for. */
#define RANDOM_FEATURES                                                        \
    ((uint64_t)(FEATURE_COVERAGE | FEATURE_TEXTURES | FEATURE_ROUGH |          \
                FEATURE_EMITTERS | FEATURE_BUMPS | FEATURE_PRINCIPLED |        \
                FEATURE_ANISOTROPY | FEATURE_SHEEN | FEATURE_POINT_LIGHTS |    \
                FEATURE_DIRECTIONAL_LIGHTS | FEATURE_ATTENUATION |             \
                FEATURE_VERTEX_COLORS | FEATURE_ROUGH_SHEETS |                 \
                FEATURE_THIN_FILM | FEATURE_INSTANCES |                        \
                FEATURE_TEXTURE_OPTIONS | FEATURE_VERTEX_ALPHAS |              \
                FEATURE_TANGENTS | FEATURE_COAT_NORMALS | FEATURE_DISPERSION | \
                FEATURE_MEDIA | FEATURE_TRANSLUCENT | FEATURE_SUBSURFACE))

/* Random files have each feature of glTF, some of them without instances. */
static void random_files_are_equal(void **state)
{
    uint64_t features = 0;
    uint64_t seed = 5;

    (void)state;
    if (!device)
        return;
    for (uint32_t i = 0; i < 6; i++) {
        struct pair p;
        char path[sizeof folder + 32];

        random_gltf_write(folder, i % 2 == 0, &seed);
        snprintf(path, sizeof path, "%s/random.gltf", folder);
        open_pair(&p, path, 64, 48);
        assert_true(i % 2 == 0 ||
                    (world_features(&p.world) & FEATURE_INSTANCES) == 0);
        features |= world_features(&p.world);
        render_both(&p, (struct rect){0, 0, 64, 48}, 6, i);
        render_special(&p, (struct rect){0, 0, 64, 48}, 3, i);
        close_pair(&p);
    }
    assert_int_equal(features & RANDOM_FEATURES, RANDOM_FEATURES);
}

static int set_up(void **state)
{
    return make_folder(state) == 0 ? open_device(state) : -1;
}

static int tear_down(void **state)
{
    return close_device(state) == 0 ? remove_folder(state) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shipped_scenes_are_equal),
        cmocka_unit_test(edited_worlds_are_equal),
        cmocka_unit_test(lamps_are_equal),
        cmocka_unit_test(media_are_equal),
        cmocka_unit_test(smokes_are_equal),
        cmocka_unit_test(random_files_are_equal),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
