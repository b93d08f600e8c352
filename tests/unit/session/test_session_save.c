// SPDX-License-Identifier: MIT
/*
 * test_session_save.c - an edited world equals one that is loaded from the
 * saved files
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "engine/engine_film.h"
#include "read/mtl.h"
#include "read/view_file.h"
#include "session/autosave_state.h"
#include "session/session_save.h"
#include "terminal/xmalloc.h"
#include "tests/unit/files.h"
#include "tests/unit/kinds.h"

static char root[4096]; /* where the scenes are */

static const char obj[] =
    "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\n"
    "o plain\nf 1 2 3\no lamp\nusemtl lamp\nf 1 2 4\nf 1 3 4\n"
    "o my wall\nusemtl wall\nf 2 3 4\nusemtl lamp\nf 3 4 5\n"
    "o ball\nusemtl glass\nf 1 2 5\n";
static const char a_mtl[] = "# a\nnewmtl lamp\nKe 3 2 1 # warm\nPs 1\n"
                            "newmtl wall\n\tKd .5 .5 .5\n";
static const char b_mtl[] = "newmtl glass\r\nillum 7\r\nNi 1.5\r\n"
                            "newmtl spare\r\nKd 0 1 0\r\n";
static const char view[] = "# mine\neye 0 0 5\nat 0 0 0\nexposure 1\n";

static void put_scene(void)
{
    put("s.obj", obj);
    put("a.mtl", a_mtl);
    put("b.mtl", b_mtl);
    put("s.view", view);
}

/* Pictures have one pixel, since only the arrays behind them are compared. */
static struct options options = {.scene_path = "s.obj",
                                 .width_px = 1,
                                 .height_px = 1,
                                 .spp = 1,
                                 .max_bounces = -1,
                                 .thread_count = 1};

static void open_session(struct session *s)
{
    struct error err;

    check_or_say(session_open(s, &options, clock_ns(), &err), err.text);
}

static void restart(struct session *s)
{
    struct error err;

    check_or_say(session_restart(s, (struct render_limits){.spp = 1}, &err),
                 err.text);
    render_wait(s->engine.render, -1);
}

static char *saved(struct session *s)
{
    struct file_watch nothing = {.fd = -1};
    struct error err;
    char *what;

    check_or_say(session_save_edit(s, &nothing, &what, &err), err.text);
    return what;
}

static void save(struct session *s)
{
    free(saved(s));
}

/* Compares the arrays that samples read. */
static void check_same_world(const struct session *s, const struct session *t)
{
    const struct host_world *a = &s->engine.world, *b = &t->engine.world;
    const struct tri *a_tris = world_tris(a, &s->engine.scene);
    const struct tri *b_tris = world_tris(b, &t->engine.scene);

    assert_int_equal(s->engine.scene.tri_count, t->engine.scene.tri_count);
    for (uint32_t i = 0; i < s->engine.scene.tri_count; i++) {
        uint32_t m = a_tris[i].material, n = b_tris[i].material;

        assert_string_equal(s->edit.names[m], t->edit.names[n]);
        assert_memory_equal(&a->materials[m], &b->materials[n],
                            sizeof a->materials[m]);
    }
    assert_int_equal(a->lights.light_count, b->lights.light_count);
    assert_int_equal(a->lights.node_count, b->lights.node_count);
    assert_true(a->lights.unsampled_variance == b->lights.unsampled_variance);
    if (a->lights.light_count > 0) {
        assert_memory_equal(a->lights.lights, b->lights.lights,
                            a->lights.light_count * sizeof *a->lights.lights);
        assert_memory_equal(a->lights.tri_lights, b->lights.tri_lights,
                            s->engine.scene.tri_count *
                                sizeof *a->lights.tri_lights);
    }
    if (a->lights.node_count > 0)
        assert_memory_equal(a->lights.nodes, b->lights.nodes,
                            a->lights.node_count * sizeof *a->lights.nodes);
    assert_int_equal(a->guide.grid.table_count, b->guide.grid.table_count);
    if (a->guide.grid.table_count > 0)
        assert_memory_equal(a->guide.sums, b->guide.sums,
                            a->guide.grid.table_count * sizeof(float) *
                                GUIDE_BINS);
    assert_int_equal(world_features(a), world_features(b));
    assert_int_equal(world_has_emitters(a), world_has_emitters(b));
}

static uint64_t seed = 7;

static uint32_t random_below(uint32_t count)
{
    return (uint32_t)(check_random(&seed) * count);
}

static void edit_anything(struct edit *e)
{
    uint32_t material = 1 + random_below(e->material_count - 1);
    struct material_values source = e->now.sources[material];
    struct lighting light = e->now.view.lighting;

    while (!e->now.is_there[material])
        material--;
    source = e->now.sources[material];
    if (random_below(3) != 0)
        edit_end_step(e);
    switch (random_below(8)) {
    case 0:
        source.base_color = (struct mtl_color){{check_random(&seed), .5, 0}, 1};
        edit_material(e, material, &source);
        break;
    case 1:
        source.emission = (struct mtl_color){{check_random(&seed), 1, 2}, 1};
        edit_material(e, material, &source);
        break;
    case 2:
        source.emission = (struct mtl_color){.line = 0};
        edit_material(e, material, &source);
        break;
    case 3:
        source.illum = (struct mtl_number){(double)random_below(10), 1};
        edit_material(e, material, &source);
        break;
    case 4:
        edit_assign(e, random_below(e->object_count),
                    random_below(2) ? NO_INDEX : material);
        break;
    case 5:
        edit_assign(e, random_below(e->object_count),
                    edit_duplicate(e, material));
        break;
    case 6:
        source.roughness = (struct mtl_number){check_random(&seed), 1};
        edit_material(e, material, &source);
        break;
    case 7:
        light.exposure = check_random(&seed);
        light.background[1] = check_random(&seed);
        light.has_background = true;
        edit_lighting(e, &light);
        break;
    }
}

/* Moves the camera, stores a view, adds a lamp and switches a map off. */
static void edit_the_rest(struct edit *e)
{
    struct pose pose = e->now.view.pose;
    struct material_values source = e->now.sources[1];
    struct lamp lamp;

    pose.eye[0] = 1 / 3.0;
    edit_pose(e, &pose);
    edit_shot(e, 4);
    pose.eye[1] = -2 / 7.0;
    edit_pose(e, &pose);
    lamp_init(&lamp, LAMP_POINT);
    lamp.position[2] = 3;
    edit_add_lamp(e, &lamp);
    source.maps_off ^= 1u << MTL_MAP_COLOR;
    edit_material(e, 1, &source);
}

static void check_same_picture(struct session *s, struct session *t)
{
    struct view view_s = edit_view(&s->edit), view_t = edit_view(&t->edit);
    struct film_identity a, b;
    struct error err;

    check_or_say(engine_film_identify(&s->engine, &view_s, &a, &err), err.text);
    check_or_say(engine_film_identify(&t->engine, &view_t, &b, &err), err.text);
    check_or_say(film_identity_check(&a, "a", &b, "b", &err), err.text);
}

/* A session that is restored has the picture and the unsaved values of the kept
 * one, from the files that it was opened with; one undo gives those. */
static void kept_edits_are_restored(void **state)
{
    struct session first;
    struct error err;

    (void)state;
    put_scene();
    open_session(&first);
    restart(&first);
    for (int round = 0; round < 25; round++) {
        struct session s, again;
        struct autosave_file kept = {.scene = NULL};
        uint32_t missing;

        if (!check_is_due(3))
            continue;
        open_session(&s);
        for (int i = 0; i < round; i++)
            edit_anything(&s.edit);
        if (round % 2 != 0)
            edit_the_rest(&s.edit);
        restart(&s);
        check_or_say(autosave_edit_take(&kept, &s, "/tmp/k", &err), err.text);
        assert_int_equal(kept.has_edits, edit_has_unsaved_materials(&s.edit) ||
                                             edit_has_unsaved_view(&s.edit));
        open_session(&again);
        check_or_say(autosave_edit_restore(&kept, &again, "/tmp/k", &missing,
                                           &err),
                     err.text);
        assert_int_equal(missing, 0);
        restart(&again);
        check_same_world(&again, &s);
        check_same_picture(&again, &s);
        for (uint32_t i = 0; i < s.edit.material_count; i++) {
            assert_true(material_values_equal(&s.edit.now.sources[i],
                                              &again.edit.now.sources[i]));
            assert_string_equal(s.edit.names[i], again.edit.names[i]);
        }
        for (int i = 0; i < VIEW_SHOTS; i++)
            assert_int_equal(s.edit.now.view.has_shot[i],
                             again.edit.now.view.has_shot[i]);
        edit_undo(&again.edit);
        assert_false(edit_has_unsaved_materials(&again.edit));
        assert_false(edit_has_unsaved_view(&again.edit));
        restart(&again);
        check_same_world(&again, &first);
        assert_null(edit_undo(&again.edit));
        autosave_file_free(&kept);
        session_close(&s);
        session_close(&again);
    }
    session_close(&first);
}

/* Edits of materials that the files lost meanwhile are left out. */
static void kept_edits_of_lost_materials_are_counted(void **state)
{
    struct session s;
    struct autosave_file kept = {.scene = NULL};
    struct material_values source;
    struct error err;
    uint32_t missing;

    (void)state;
    put_scene();
    open_session(&s);
    for (uint32_t i = 1; i < 3; i++) {
        source = s.edit.now.sources[i];
        source.base_color = (struct mtl_color){{.25, .5, 1}, 1};
        edit_material(&s.edit, i, &source);
    }
    check_or_say(autosave_edit_take(&kept, &s, "/tmp/k", &err), err.text);
    session_close(&s);
    put("a.mtl", "newmtl wall\nKd .5 .5 .5\n");
    open_session(&s);
    check_or_say(autosave_edit_restore(&kept, &s, "/tmp/k", &missing, &err),
                 err.text);
    assert_int_equal(missing, 1);
    source = s.edit.now.sources[mtl_find(&s.engine.scene, "wall")];
    assert_true(source.base_color.rgb[0] == .25);
    session_close(&s);
    autosave_file_free(&kept);
}

/* A picture after an edit equals that of a fresh start after saving. Comparing
 * and undoing give what was loaded. */
static void saved_edits_are_loaded_again(void **state)
{
    struct session first;

    (void)state;
    put_scene();
    open_session(&first);
    for (int round = 0; round < 25; round++) {
        struct session s, again;

        if (!check_is_due(3))
            continue;
        put_scene();
        open_session(&s);
        restart(&s);
        for (int i = 0; i < 12; i++) {
            edit_anything(&s.edit);
            if (random_below(3) == 0)
                restart(&s);
        }
        restart(&s);
        s.edit.is_comparing = true;
        restart(&s);
        check_same_world(&s, &first);
        s.edit.is_comparing = false;
        restart(&s);
        save(&s);
        assert_false(edit_has_unsaved_materials(&s.edit));
        assert_false(edit_has_unsaved_view(&s.edit));
        open_session(&again);
        check_same_world(&s, &again);
        assert_true(again.edit.now.view.lighting.exposure ==
                    s.edit.now.view.lighting.exposure);
        assert_memory_equal(again.edit.now.view.lighting.background,
                            s.edit.now.view.lighting.background,
                            sizeof s.edit.now.view.lighting.background);
        assert_true(again.edit.now.view.pose.eye[2] == 5);
        session_close(&again);
        while (edit_undo(&s.edit))
            continue;
        restart(&s);
        check_same_world(&s, &first);
        session_close(&s);
    }
    session_close(&first);
}

/* A copy of a copy of a material that has a map and no colour, saved at once or
 * after the first copy, keeps the factor 1 of what was not changed. */
static void copies_of_copies_keep_implied_factors(void **state)
{
    (void)state;
    for (int saves_first = 0; saves_first < 2; saves_first++) {
        struct session s, again;
        struct material_values source;
        uint32_t copy, second;

        put_scene();
        put("white.ppm", "P6\n1 1\n255\n\377\377\377");
        put("a.mtl", "newmtl lamp\nmap_Ke white.ppm\nnewmtl wall\n"
                     "map_Kd white.ppm\n");
        open_session(&s);
        copy = edit_duplicate(&s.edit, 2);
        edit_assign(&s.edit, 2, copy);
        if (saves_first)
            save(&s);
        second = edit_duplicate(&s.edit, copy);
        restart(&s); /* no object has the second copy */
        check_close((double)s.engine.world.materials[second].color.x, 1, 0);
        edit_assign(&s.edit, 3, second);
        source = s.edit.now.sources[second];
        step_kind(&source, 2);
        edit_material(&s.edit, second, &source);
        source = s.edit.now.sources[copy];
        source.diffuse_roughness = (struct mtl_number){.5, 1};
        edit_material(&s.edit, copy, &source);
        restart(&s);
        check_close((double)s.engine.world.materials[copy].color.x, 1, 0);
        check_close((double)s.engine.world.materials[second].color.x, 1, 0);
        save(&s);
        open_session(&again);
        check_same_world(&s, &again);
        session_close(&again);
        session_close(&s);
    }
    unlink("white.ppm");
}

/* The parts with another version than in `before`, which becomes the world's:
 * 1 << enum world_part, or-ed. */
static unsigned new_parts(const struct session *s, struct host_world *before)
{
    const struct host_world *now = &s->engine.world;
    unsigned parts = 0;

    for (int i = 0; i < WORLD_PARTS; i++)
        if (now->versions[i] != before->versions[i])
            parts |= 1u << i;
    assert_int_equal(now->generation != before->generation, parts != 0);
    memcpy(before->versions, now->versions, sizeof before->versions);
    before->generation = now->generation;
    return parts;
}

/* Changed arrays have new versions; the others keep theirs. */
static void changed_arrays_have_new_versions(void **state)
{
    const unsigned materials = 1u << WORLD_MATERIALS;
    const unsigned lights = 1u << WORLD_LIGHTS;
    const unsigned guide = 1u << WORLD_GUIDE;
    struct material_values source;
    struct host_world before = {.versions = {0}};
    struct session s;

    (void)state;
    put_scene();
    open_session(&s);
    restart(&s);
    assert_int_equal(new_parts(&s, &before), (1u << WORLD_PARTS) - 1);
    restart(&s);
    s.edit.now.view.pose.eye[0] += 1;
    restart(&s);
    assert_int_equal(new_parts(&s, &before), 0);
    source = s.edit.now.sources[2];
    source.base_color.rgb[0] = 1;
    edit_material(&s.edit, 2, &source);
    assert_true(session_is_outdated(&s));
    restart(&s);
    assert_false(session_is_outdated(&s));
    assert_int_equal(new_parts(&s, &before), materials);
    source = s.edit.now.sources[1];
    source.emission.rgb[0] = 1;
    edit_material(&s.edit, 1, &source);
    restart(&s);
    assert_int_equal(new_parts(&s, &before) & ~guide, materials | lights);
    edit_assign(&s.edit, 2, 2);
    restart(&s);
    assert_int_equal(new_parts(&s, &before) & ~guide,
                     materials | lights | 1u << WORLD_TRIS);
    session_close(&s);
}

/* Only changes are written, each into its file. */
static void only_changes_are_saved(void **state)
{
    struct material_values source;
    struct session s;
    struct error err;
    char *text;
    size_t size_bytes;
    uint32_t copy;

    (void)state;
    put_scene();
    open_session(&s);
    edit_end_step(&s.edit);
    copy = edit_duplicate(&s.edit, 1);
    edit_assign(&s.edit, 3, copy);
    source = s.edit.now.sources[copy];
    source.emission.rgb[0] = 9;
    edit_material(&s.edit, copy, &source);
    source = s.edit.now.sources[3];
    source.ior.value = 1.25;
    edit_material(&s.edit, 3, &source);
    save(&s);
    assert_true(file_read("a.mtl", &text, &size_bytes, &err));
    assert_string_equal(text, "# a\nnewmtl lamp\nKe 3 2 1 # warm\nPs 1\n"
                              "newmtl wall\n\tKd .5 .5 .5\n\n"
                              "newmtl lamp.2\nKe 9 2 1 # warm\nPs 1\n");
    free(text);
    assert_true(file_read("b.mtl", &text, &size_bytes, &err));
    assert_string_equal(text, "newmtl glass\r\nillum 7\r\nNi 1.25\r\n"
                              "newmtl spare\r\nKd 0 1 0\r\n");
    free(text);
    assert_true(file_read("s.view", &text, &size_bytes, &err));
    check_has(text, "\nassign \"my wall\" lamp.2\n");
    check_has(text, "\neye 0 0 5\n");
    check_has(text, "\nexposure 1\n");
    free(text);
    session_close(&s);
}

/* The message names exactly the files that were written. */
static void message_names_the_saved_files(void **state)
{
    static const char *const names[] = {"glass", "lamp"};
    static const char *const lines[] = {"wrote 1 material to b.mtl",
                                        "wrote 2 materials to a.mtl, b.mtl",
                                        "no changes since the last save"};
    struct session s;

    (void)state;
    put_scene();
    open_session(&s);
    for (size_t i = 0; i < 3; i++) {
        char *what;

        for (size_t k = 0; i < 2 && k <= i; k++) {
            uint32_t material = mtl_find(&s.engine.scene, names[k]);
            struct material_values source = s.edit.now.sources[material];

            /* One of them is the colour of a lamp, the other that of glass. */
            source.base_color =
                (struct mtl_color){{.25 * (double)(1 + i), 0, 0}, 1};
            source.transmission = source.base_color;
            edit_material(&s.edit, material, &source);
        }
        what = saved(&s);
        assert_string_equal(what, lines[i]);
        free(what);
    }
    session_close(&s);
}

/* Remains of other kinds are not written. A statement that a kind needs is
 * written later, even if it existed once before. */
static void kinds_leave_nothing_in_files(void **state)
{
    static const struct {
        int steps; /* from the state saved before */
        const char *wall;
    } cases[] = {
        {3, "newmtl wall\n\tKd .5 .5 .5\n\tTf 0.5 0.5 0.5\n\tillum 7\n"},
        {4, "newmtl wall\n\tKd .5 .5 .5\n\tTf 0.5 0.5 0.5\n\tillum 3\n"
            "\tPm 1\n"},
        {-2, "newmtl wall\n\tKd .5 .5 .5\n\tTf 0.5 0.5 0.5\n\tillum 3\n"
             "\tPm 0\n"},
    };
    struct session s;
    struct error err;

    (void)state;
    put_scene();
    open_session(&s);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t wall = mtl_find(&s.engine.scene, "wall");
        struct material_values source = s.edit.now.sources[wall];
        size_t size_bytes;
        char *text;

        step_kind(&source, cases[i].steps);
        edit_material(&s.edit, wall, &source);
        save(&s);
        assert_false(edit_has_unsaved_materials(&s.edit));
        assert_true(file_read("a.mtl", &text, &size_bytes, &err));
        check_has(text, cases[i].wall);
        free(text);
    }
    session_close(&s);
}

/* Assign lines about absent names do nothing and are kept. */
static void assignments_without_names_are_kept(void **state)
{
    const struct tri *tris;
    struct session s;
    struct lighting light;
    struct error err;
    char *text;
    size_t size_bytes;

    (void)state;
    put_scene();
    put("s.view", "eye 0 0 5\nat 0 0 0\nassign nobody lamp\n"
                  "assign plain \"no such\"\nassign lamp wall # dim\n");
    open_session(&s);
    assert_int_equal(s.engine.report.entry_count, 2);
    check_has(s.engine.report.entries[0].text,
              "found no object 'nobody' to assign");
    check_has(s.engine.report.entries[1].text, "found no material 'no such'");
    tris = world_tris(&s.engine.world, &s.engine.scene);
    assert_int_equal(tris[1].material, tris[2].material);
    assert_string_equal(s.engine.scene.material_names[tris[1].material],
                        "wall");
    restart(&s);
    light = s.edit.now.view.lighting;
    light.exposure = 2;
    edit_lighting(&s.edit, &light);
    assert_false(session_is_outdated(&s)); /* no new picture */
    assert_true(session_develop(&s).exposure == 2);
    save(&s);
    assert_true(file_read("s.view", &text, &size_bytes, &err));
    check_has(text, "assign nobody lamp\nassign plain \"no such\"\n"
                    "assign lamp wall # dim\n");
    free(text);
    session_close(&s);
}

static void wrong_lines_have_their_message(void **state)
{
    static const char *const wrong[] = {"assign a", "assign", "assign a b c",
                                        "assign \"a b", "assign \"a\" \"b"};
    struct view v;
    struct warnings report = {0};
    struct error err;

    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        view_init(&v);
        put("w.view", wrong[i]);
        assert_false(view_read(&v, "w.view", &report, &err));
        check_has(err.text, "w.view:1: found a malformed line, expected "
                            "assign OBJECT MATERIAL");
        view_free(&v);
    }
    view_init(&v);
    put("w.view", "assign \"a \"\"b#\" c\nassign \"\" \"d\\\"\n"
                  "assign x y\nassign x z\n");
    check_or_say(view_read(&v, "w.view", &report, &err), err.text);
    assert_int_equal(v.assigns.count, 3);
    assert_string_equal(v.assigns.items[0].object, "a \"b#");
    assert_string_equal(v.assigns.items[1].object, "");
    assert_string_equal(v.assigns.items[1].material, "d\\");
    assert_string_equal(v.assigns.items[2].material, "z");
    view_free(&v);
    warnings_free(&report);
}

/* An image that no material used is read when a material uses it. */
static void textures_are_read_when_used(void **state)
{
    struct session s, again;
    struct material_values source;
    const struct texture *textures;
    struct material before;
    char *text = xformat("newmtl lamp\nKe 1 1 1\nnewmtl wall\nillum 7\nKd .5\n"
                         "map_Ks %s/scenes/tiles.png\n",
                         root);

    (void)state;
    put_scene();
    put("a.mtl", text);
    open_session(&s);
    restart(&s);
    before = s.engine.world.materials[2];
    textures = s.engine.world.textures;
    assert_int_equal(s.engine.scene.texture_count, 1);
    assert_int_equal(textures[0].width, 0);
    source = s.edit.now.sources[2];
    source.illum.value = 2;
    edit_material(&s.edit, 2, &source);
    restart(&s);
    assert_ptr_not_equal(s.engine.world.textures, textures);
    assert_true(s.engine.world.textures[0].width > 0);
    assert_int_equal(s.engine.world.materials[2].kind, MATERIAL_PLASTIC);
    assert_int_equal(s.engine.world.materials[2].specular_texture, 0);
    save(&s);
    open_session(&again);
    check_same_world(&s, &again);
    session_close(&again);
    /* Without the texture the colour is used; the next step copies no
     * textures. */
    textures = s.engine.world.textures;
    source.maps_off = 1u << MTL_MAP_SPECULAR;
    edit_end_step(&s.edit);
    edit_material(&s.edit, 2, &source);
    restart(&s);
    assert_ptr_equal(s.engine.world.textures, textures);
    assert_int_equal(s.engine.world.materials[2].kind, MATERIAL_DIFFUSE);
    save(&s);
    open_session(&again);
    check_same_world(&s, &again);
    session_close(&again);
    while (edit_undo(&s.edit))
        continue;
    restart(&s);
    assert_memory_equal(&s.engine.world.materials[2], &before, sizeof before);
    session_close(&s);
    free(text);
}

static int enter(void **state)
{
    return getcwd(root, sizeof root) != NULL ? enter_folder(state) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saved_edits_are_loaded_again),
        cmocka_unit_test(copies_of_copies_keep_implied_factors),
        cmocka_unit_test(kept_edits_are_restored),
        cmocka_unit_test(kept_edits_of_lost_materials_are_counted),
        cmocka_unit_test(changed_arrays_have_new_versions),
        cmocka_unit_test(textures_are_read_when_used),
        cmocka_unit_test(only_changes_are_saved),
        cmocka_unit_test(message_names_the_saved_files),
        cmocka_unit_test(kinds_leave_nothing_in_files),
        cmocka_unit_test(assignments_without_names_are_kept),
        cmocka_unit_test(wrong_lines_have_their_message),
    };

    return cmocka_run_group_tests(tests, enter, remove_folder);
}
