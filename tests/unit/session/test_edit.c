// SPDX-License-Identifier: MIT
/*
 * test_edit.c - changes of camera, materials, objects and light are undone and
 * redone in one order, compared with the saved state, and counted if they need
 * a new render
 */
#include <stdlib.h>

#include "formats/scene_load.h"
#include "session/edit.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#define MS UINT64_C(1000000)

enum { LAMP = 1, WALL, BALL_OBJECT = 2 };

static struct scene scene;
static struct warnings report;

static int open_scene(void **state)
{
    struct error err;

    if (enter_folder(state) != 0)
        return -1;
    put("s.obj", "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                 "o lamp\nusemtl lamp\nf 1 2 3\no ball\nusemtl wall\nf 1 2 3\n"
                 "o floor\nusemtl wall\nf 1 2 3\n");
    put("s.mtl", "newmtl lamp\nKe 3 2 1\nnewmtl wall\nKd .5 .5 .5\n");
    return scene_load(&scene, "s.obj", false, &report, &err) ? 0 : -1;
}

static int close_scene(void **state)
{
    scene_free(&scene);
    warnings_free(&report);
    return remove_folder(state);
}

static void open_edit(struct edit *e)
{
    struct view view;

    view_init(&view);
    edit_init(e, &scene, &view, &report);
    view_free(&view);
}

/* ---- changes to given values ---- */

static void put_eye(struct edit *e, double x)
{
    struct pose pose = e->now.view.pose;

    pose.eye[0] = x;
    edit_pose(e, &pose);
}

static void put_kd(struct edit *e, uint32_t material, double red)
{
    struct mtl_source source = e->now.sources[material];

    source.kd.rgb[0] = red;
    source.kd.line = 1;
    edit_material(e, material, &source);
}

static void put_background(struct edit *e, double red)
{
    struct lighting light = e->now.view.lighting;

    light.background[0] = red;
    light.has_background = true;
    edit_lighting(e, &light);
}

static void put_exposure(struct edit *e, double exposure)
{
    struct lighting light = e->now.view.lighting;

    light.exposure = exposure;
    edit_lighting(e, &light);
}

static void put_tone(struct edit *e, uint32_t tone)
{
    struct lighting light = e->now.view.lighting;

    light.tone = tone;
    edit_lighting(e, &light);
}

static void put_sky(struct edit *e, const char *path)
{
    struct lighting light = e->now.view.lighting;
    char *copy = path != NULL ? xstrdup(path) : NULL;

    light.sky_path = copy;
    edit_lighting(e, &light);
    free(copy);
}

/* ---- undo and redo ---- */

static void steps_have_names_in_order_of_time(void **state)
{
    static const char *const names[] = {
        "camera", "material wall", "camera", "material of an object",
        "light",  "copy wall.2",   "view 3", "camera",
    };
    const int count = sizeof names / sizeof names[0];
    struct edit e;

    (void)state;
    open_edit(&e);
    assert_null(edit_undo(&e));
    assert_null(edit_redo(&e));
    for (int i = 0; i < count; i++) {
        edit_end_step(&e);
        switch (i) {
        case 1: put_kd(&e, WALL, .25); break;
        case 3: edit_assign(&e, BALL_OBJECT, LAMP); break;
        case 4: put_background(&e, .25); break;
        case 5: assert_int_equal(edit_duplicate(&e, WALL), 3); break;
        case 6: edit_shot(&e, 2); break;
        default: put_eye(&e, i + 1); break;
        }
    }
    for (int round = 0; round < 2; round++) {
        for (int i = count - 1; i >= 0; i--)
            assert_string_equal(edit_undo(&e), names[i]);
        assert_null(edit_undo(&e));
        assert_false(edit_has_unsaved_materials(&e));
        assert_false(edit_has_unsaved_view(&e));
        assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
        assert_false(e.now.view.has_shot[2]);
        for (int i = 0; i < count; i++)
            assert_string_equal(edit_redo(&e), names[i]);
        assert_null(edit_redo(&e));
        assert_true(e.now.view.pose.eye[0] == count);
        assert_true(e.now.view.shots[2].eye[0] == 3);
        assert_true(e.now.sources[WALL].kd.rgb[0] == .25);
        assert_true(e.now.sources[3].kd.rgb[0] == .25);
        assert_int_equal(e.now.assigned[BALL_OBJECT], LAMP);
        assert_true(e.now.view.lighting.background[0] == .25);
    }
    edit_free(&e);
}

static void a_copy_and_its_assignment_are_one_step(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    edit_end_step(&e);
    edit_assign(&e, BALL_OBJECT, edit_duplicate(&e, WALL));
    edit_end_step(&e);
    assert_string_equal(e.names[3], "wall.2");
    assert_string_equal(edit_undo(&e), "copy wall.2");
    assert_int_equal(e.now.assigned[BALL_OBJECT], NO_INDEX);
    assert_false(e.now.is_there[3]);
    assert_null(edit_undo(&e));
    assert_string_equal(edit_redo(&e), "copy wall.2");
    assert_int_equal(e.now.assigned[BALL_OBJECT], 3);
    assert_true(e.now.is_there[3]);
    assert_int_equal(edit_duplicate(&e, 3), 4);
    assert_string_equal(e.names[4], "wall.3");
    edit_free(&e);
}

/* Calls of a gesture are one step until it pauses, another one begins, or
 * another thing is changed. */
static void a_gesture_is_one_step(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    assert_true(edit_begin_gesture(&e, 1, 0));
    put_eye(&e, 1);
    assert_false(edit_begin_gesture(&e, 1, 700 * MS));
    put_eye(&e, 2);
    assert_false(edit_begin_gesture(&e, 1, 1400 * MS));
    put_eye(&e, 3);
    assert_true(edit_begin_gesture(&e, 1, 2101 * MS)); /* after a pause */
    put_eye(&e, 4);
    assert_true(edit_begin_gesture(&e, 2, 2102 * MS)); /* another key */
    put_eye(&e, 5);
    put_kd(&e, WALL, .25); /* another thing */
    put_kd(&e, WALL, .75);
    put_kd(&e, LAMP, .75);
    assert_string_equal(edit_undo(&e), "material lamp");
    assert_string_equal(edit_undo(&e), "material wall");
    assert_true(e.now.sources[WALL].kd.rgb[0] == .5);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 4);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 3);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
    assert_null(edit_undo(&e));
    assert_true(edit_begin_gesture(&e, 2, 2103 * MS)); /* undo ends a gesture */
    edit_free(&e);
}

static void a_change_drops_undone_steps(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    for (int i = 1; i <= 3; i++) {
        edit_end_step(&e);
        put_eye(&e, i);
        edit_end_step(&e);
        put_kd(&e, WALL, i / 4.);
    }
    for (int i = 0; i < 4; i++)
        edit_undo(&e);
    put_eye(&e, 1); /* as it is: no change */
    assert_non_null(edit_redo(&e));
    edit_undo(&e);
    put_background(&e, 1);
    assert_null(edit_redo(&e));
    assert_string_equal(edit_undo(&e), "light");
    assert_string_equal(edit_undo(&e), "material wall");
    assert_string_equal(edit_undo(&e), "camera");
    assert_null(edit_undo(&e));
    edit_free(&e);
}

static void a_gesture_without_effect_is_no_step(void **state)
{
    struct edit e;
    double x;

    (void)state;
    open_edit(&e);
    x = e.now.view.pose.eye[0];
    edit_begin_gesture(&e, 1, 0);
    put_eye(&e, x + 1);
    put_eye(&e, x);
    put_kd(&e, WALL, .75);
    put_kd(&e, WALL, .5);
    put_sky(&e, "a.hdr");
    put_sky(&e, NULL);
    edit_assign(&e, BALL_OBJECT, LAMP);
    edit_assign(&e, BALL_OBJECT, NO_INDEX);
    assert_null(edit_undo(&e));
    edit_shot(&e, 0);
    edit_shot(&e, 0);
    assert_string_equal(edit_undo(&e), "view 1");
    assert_null(edit_undo(&e));
    edit_free(&e);
}

/* ---- versions ---- */

#define COUNTS(change, count)                     \
    do {                                          \
        uint32_t before_ = e.version;             \
        edit_end_step(&e);                        \
        change;                                   \
        if ((count) == 0)                         \
            assert_int_equal(e.version, before_); \
        else                                      \
            assert_true(e.version != before_);    \
    } while (0)

static void version_counts_new_renders(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    COUNTS(put_eye(&e, 1), 1);
    COUNTS(put_eye(&e, 1), 0);
    COUNTS(put_kd(&e, WALL, .25), 1);
    COUNTS(put_kd(&e, WALL, .25), 0);
    COUNTS(edit_assign(&e, BALL_OBJECT, LAMP), 1);
    COUNTS(edit_assign(&e, BALL_OBJECT, LAMP), 0);
    COUNTS(put_background(&e, 1), 1);
    COUNTS(put_sky(&e, "a.hdr"), 1);
    COUNTS(put_sky(&e, "a.hdr"), 0);
    COUNTS(put_exposure(&e, 1), 0);
    COUNTS(put_tone(&e, TONE_ACES), 0);
    COUNTS(edit_shot(&e, 0), 0);
    COUNTS(edit_duplicate(&e, WALL), 0);
    for (int i = 0; i < 4; i++)
        COUNTS(edit_undo(&e), 0); /* copy, view, tone, exposure */
    for (int i = 0; i < 5; i++)
        COUNTS(edit_undo(&e), 1);
    COUNTS(edit_undo(&e), 0); /* nothing to undo */
    edit_free(&e);
}

/* ---- comparing with the saved state ---- */

static void comparing_shows_saved_values_and_the_present_camera(void **state)
{
    struct edit e;
    struct view view;

    (void)state;
    open_edit(&e);
    put_eye(&e, 1);
    put_exposure(&e, 1);
    COUNTS(edit_compare(&e, true), 0); /* the picture differs by exposure */
    COUNTS(edit_compare(&e, false), 0);
    put_kd(&e, WALL, .25);
    edit_assign(&e, BALL_OBJECT, LAMP);
    put_background(&e, 1);
    COUNTS(edit_compare(&e, true), 1);
    COUNTS(edit_compare(&e, true), 0);
    assert_true(edit_shown(&e)->sources[WALL].kd.rgb[0] == .5);
    assert_int_equal(edit_shown(&e)->assigned[BALL_OBJECT], NO_INDEX);
    view = edit_view(&e);
    assert_true(view.lighting.background[0] == 0);
    assert_true(view.lighting.exposure == 0);
    assert_true(view.pose.eye[0] == 1);
    COUNTS(put_eye(&e, 2), 1); /* the camera goes on moving */
    assert_true(edit_view(&e).pose.eye[0] == 2);
    COUNTS(edit_shot(&e, 0), 0);
    edit_undo(&e);
    edit_undo(&e);
    assert_true(e.is_comparing);
    assert_true(edit_view(&e).pose.eye[0] == 1);
    COUNTS(edit_compare(&e, false), 1);
    assert_true(edit_shown(&e)->sources[WALL].kd.rgb[0] == .25);
    assert_true(edit_view(&e).lighting.background[0] == 1);
    edit_free(&e);
}

/* A change of materials or light, its undo and its saving end the comparison,
 * with a new render if the picture was another one. */
static void changes_end_comparing(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    for (int i = 0; i < 6; i++) {
        struct view view = {.width_px = 0};

        edit_end_step(&e);
        put_kd(&e, WALL, .25 + i);
        edit_end_step(&e);
        put_exposure(&e, 1 + i);
        edit_compare(&e, true);
        switch (i) {
        case 0: COUNTS(put_kd(&e, LAMP, .25), 1); break;
        case 1: COUNTS(edit_undo(&e), 1); break; /* of the exposure */
        case 2:
            edit_undo(&e);
            COUNTS(edit_redo(&e), 0);
            break;
        case 3: COUNTS(put_exposure(&e, 9), 1); break;
        case 4:
            xcheck(view_copy(&view, &e.now.view));
            COUNTS(edit_saved_view(&e, &view), 1);
            view_free(&view);
            break;
        case 5: COUNTS(edit_saved_material(&e, WALL), 1); break;
        }
        assert_false(e.is_comparing);
        assert_true(edit_shown(&e) == &e.now);
    }
    edit_free(&e);
}

/* ---- reloading ---- */

/* Loads the files anew. `file_eye` is the eye's x in the changed view file; 0:
 * the file is unchanged. */
static void reload(struct edit *e, struct edit *before, double file_eye)
{
    struct view view;

    view_init(&view);
    view.has_camera = true;
    if (file_eye > 0)
        view.pose.eye[0] = file_eye;
    edit_init(e, &scene, &view, &report);
    edit_keep_camera(e, before);
    edit_free(before);
    view_free(&view);
}

static void move_and_edit(struct edit *e)
{
    struct view view;

    view_init(&view);
    view.has_camera = true;
    edit_init(e, &scene, &view, &report);
    view_free(&view);
    put_eye(e, 1);
    edit_end_step(e);
    put_kd(e, WALL, .25);
    edit_end_step(e);
    put_eye(e, 2);
    edit_shot(e, 0);
    put_background(e, 1);
}

static void a_reload_keeps_camera_steps(void **state)
{
    struct edit before, e;
    uint32_t version;

    (void)state;
    move_and_edit(&before);
    version = before.version;
    reload(&e, &before, 0);
    assert_true(e.version != version);
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_true(e.now.view.shots[0].eye[0] == 2);
    assert_true(e.now.sources[WALL].kd.rgb[0] == .5);
    assert_true(e.now.view.lighting.background[0] == 0);
    put_eye(&e, 3); /* a step of its own */
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_undo(&e), "view 1");
    assert_false(e.now.view.has_shot[0]);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 1);
    /* undone steps are there after a reload, too */
    before = e;
    reload(&e, &before, 0);
    assert_true(e.now.view.pose.eye[0] == 1);
    assert_string_equal(edit_redo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_undo(&e), "camera");
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
    assert_null(edit_undo(&e));
    edit_free(&e);
}

static void the_camera_of_a_changed_file_is_a_step(void **state)
{
    struct edit before, e;

    (void)state;
    move_and_edit(&before);
    reload(&e, &before, 7);
    assert_true(e.now.view.pose.eye[0] == 7);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_redo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 7);
    edit_free(&e);
}

/* ---- random changes ---- */

#define OPERATIONS    2000
#define MATERIALS_MAX 40

/* A copy of the whole present state, and the name of the step that made it. */
struct snapshot {
    uint32_t material_count;
    struct mtl_source sources[MATERIALS_MAX];
    bool is_there[MATERIALS_MAX];
    uint32_t assigned[8];
    struct lighting light;
    const char *sky; /* one of `skies` */
    struct pose pose, shots[VIEW_SHOTS];
    bool has_shot[VIEW_SHOTS];
    char name[128];
};

static const char *const skies[] = {NULL, "a.hdr", "b.hdr"};

static const char *sky_of(const struct lighting *light)
{
    for (int i = 1; i < 3; i++)
        if (light->sky_path && strcmp(light->sky_path, skies[i]) == 0)
            return skies[i];
    assert_null(light->sky_path);
    return NULL;
}

static void take(struct snapshot *s, const struct edit *e,
                 const struct edit_state *shown)
{
    memset(s, 0, sizeof *s);
    s->material_count = e->material_count;
    for (uint32_t i = 0; i < e->material_count; i++) {
        s->sources[i] = shown->sources[i];
        s->is_there[i] = shown->is_there[i];
    }
    memcpy(s->assigned, shown->assigned, e->object_count * sizeof *s->assigned);
    s->light = shown->view.lighting;
    s->sky = sky_of(&s->light);
    s->light.sky_path = NULL;
    s->pose = e->now.view.pose;
    memcpy(s->shots, e->now.view.shots, sizeof s->shots);
    memcpy(s->has_shot, e->now.view.has_shot, sizeof s->has_shot);
}

static bool has_same_sources(const struct snapshot *a, const struct snapshot *b)
{
    for (uint32_t i = 0; i < MATERIALS_MAX; i++) {
        bool a_has = i < a->material_count && a->is_there[i];
        bool b_has = i < b->material_count && b->is_there[i];

        if (a_has != b_has ||
            (a_has && !mtl_source_equal(&a->sources[i], &b->sources[i])))
            return false;
    }
    return true;
}

static bool has_same_assigned(const struct snapshot *a,
                              const struct snapshot *b)
{
    return memcmp(a->assigned, b->assigned, sizeof a->assigned) == 0;
}

static bool is_same(const struct snapshot *a, const struct snapshot *b)
{
    return has_same_sources(a, b) && has_same_assigned(a, b) &&
           a->sky == b->sky && lighting_equal(&a->light, &b->light) &&
           memcmp(&a->pose, &b->pose, sizeof a->pose) == 0 &&
           memcmp(a->shots, b->shots, sizeof a->shots) == 0 &&
           memcmp(a->has_shot, b->has_shot, sizeof a->has_shot) == 0;
}

/* Returns true if both have the same picture; copies that no object has make no
 * difference. */
static bool is_same_picture(const struct edit *e, const struct snapshot *a,
                            const struct snapshot *b)
{
    for (uint32_t i = 0; i < e->object_count; i++) {
        uint32_t m = a->assigned[i];

        if (m != b->assigned[i] ||
            (m != NO_INDEX &&
             !mtl_source_equal(&a->sources[m], &b->sources[m])))
            return false;
    }
    for (uint32_t i = 0; i < scene.material_count; i++)
        if (!mtl_source_equal(&a->sources[i], &b->sources[i]))
            return false;
    return a->sky == b->sky && lighting_is_same_light(&a->light, &b->light) &&
           memcmp(&a->pose, &b->pose, sizeof a->pose) == 0;
}

static uint64_t seed = 11;

static uint32_t random_below(uint32_t count)
{
    return (uint32_t)(check_random(&seed) * count);
}

/* Returns one of few values, so that changes often restore earlier ones. */
static double value(void)
{
    return random_below(3) / 4.;
}

/* The expected steps: a copy of the state after each, and the gesture of the
 * last one. */
struct oracle {
    struct snapshot *copies; /* 0: as opened */
    size_t count, at;
    size_t open;      /* the copy that goes on; 0: none */
    char thing[128];  /* name of the value that was changed last */
    uint32_t gesture; /* 0: none */
    uint64_t ns, last_ns;
};

static uint32_t any_material(const struct edit *e)
{
    uint32_t i = random_below(e->material_count);

    while (!e->now.is_there[i])
        i--;
    return i;
}

/* Changes a random value. Writes the name of the step to `name`, and a name of
 * its own for each value to `thing`. */
static void change_anything(struct edit *e, char *name, char *thing)
{
    uint32_t m = any_material(e), object = random_below(e->object_count);
    struct lighting light = e->now.view.lighting;
    uint32_t number = random_below(3);

    strcpy(name, "light");
    strcpy(thing, "light");
    switch (random_below(9)) {
    case 0:
    case 1:
        sprintf(name, "material %s", e->names[m]);
        strcpy(thing, name);
        put_kd(e, m, value());
        break;
    case 2:
        strcpy(name, "material of an object");
        sprintf(thing, "object %u", object);
        edit_assign(e, object, random_below(2) ? NO_INDEX : m);
        break;
    case 3: put_exposure(e, value()); break;
    case 4:
        light.background[0] = value();
        light.has_background = true;
        edit_lighting(e, &light);
        break;
    case 5: put_sky(e, skies[random_below(3)]); break;
    case 6:
        if (random_below(4) == 0 && e->material_count < MATERIALS_MAX) {
            m = edit_duplicate(e, m);
            sprintf(name, "copy %s", e->names[m]);
            strcpy(thing, name);
            break;
        } /* fall through */
    case 7:
        strcpy(name, "camera");
        strcpy(thing, name);
        put_eye(e, value());
        break;
    case 8:
        sprintf(name, "view %u", number + 1);
        strcpy(thing, name);
        edit_shot(e, number);
        break;
    }
}

/* Adds a copy of the state after a change, or replaces the last one. */
static void note_change(struct oracle *o, const struct edit *e,
                        const char *name, const char *thing)
{
    bool goes_on = o->open != 0 && strcmp(thing, o->thing) == 0;
    struct snapshot now;

    take(&now, e, &e->now);
    strcpy(now.name, name);
    if (is_same(&now, &o->copies[o->at]))
        return;
    strcpy(o->thing, thing);
    o->at += !goes_on;
    o->copies[o->at] = now;
    o->open = o->at;
    if (is_same(&now, &o->copies[o->at - 1])) { /* the step has no effect */
        o->at--;
        o->open = 0;
    }
    o->count = o->at + 1;
}

/* One change, alone or by a gesture. */
static void make_change(struct oracle *o, struct edit *e)
{
    uint32_t gesture = random_below(3);
    char name[128], thing[128];
    bool is_new, is_shot;

    o->ns += random_below(1000) * MS;
    is_new =
        gesture == 0 || gesture != o->gesture || o->ns - o->last_ns > 700 * MS;
    if (gesture == 0)
        edit_end_step(e);
    else
        assert_int_equal(edit_begin_gesture(e, gesture, o->ns), is_new);
    o->gesture = gesture;
    o->last_ns = o->ns;
    change_anything(e, name, thing);
    is_shot = strncmp(name, "view ", 5) == 0; /* a step of its own */
    if (is_new || is_shot)
        o->open = 0;
    note_change(o, e, name, thing);
    if (is_shot)
        o->open = o->gesture = 0;
}

static void travel(struct oracle *o, struct edit *e, bool is_back)
{
    bool may = is_back ? o->at > 0 : o->at + 1 < o->count;
    const char *name = is_back ? edit_undo(e) : edit_redo(e);
    struct snapshot now;

    o->gesture = 0;
    o->open = 0;
    if (!may) {
        assert_null(name);
        return;
    }
    assert_non_null(name);
    assert_string_equal(name, o->copies[is_back ? o->at : o->at + 1].name);
    o->at = is_back ? o->at - 1 : o->at + 1;
    take(&now, e, &e->now);
    assert_true(is_same(&now, &o->copies[o->at]));
}

static void random_changes_match_copies_of_the_state(void **state)
{
    struct oracle o = {.count = 1};
    struct snapshot before, after;
    size_t longest = 0;
    struct edit e;

    (void)state;
    open_edit(&e);
    o.copies = xcalloc(OPERATIONS + 1, sizeof *o.copies);
    take(&o.copies[0], &e, &e.now);
    for (int i = 0; i < OPERATIONS; i++) {
        uint32_t version = e.version;
        bool saves = false;

        take(&before, &e, edit_shown(&e));
        switch (random_below(10)) {
        case 0:
            for (uint32_t k = random_below(5); k > 0; k--)
                travel(&o, &e, true);
            break;
        case 1:
        case 2: travel(&o, &e, false); break;
        case 3: edit_compare(&e, random_below(2)); break;
        case 4:
            saves = true;
            edit_saved_material(&e, any_material(&e));
            break;
        default: make_change(&o, &e); break;
        }
        take(&after, &e, edit_shown(&e));
        if (!is_same_picture(&e, &before, &after))
            assert_true(e.version != version);
        if (saves)
            assert_false(e.is_comparing);
        longest = o.count > longest ? o.count : longest;
    }
    assert_true(longest > 100);
    while (o.at > 0)
        travel(&o, &e, true);
    travel(&o, &e, true);
    while (o.at + 1 < o.count)
        travel(&o, &e, false);
    travel(&o, &e, false);
    free(o.copies);
    edit_free(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_have_names_in_order_of_time),
        cmocka_unit_test(a_copy_and_its_assignment_are_one_step),
        cmocka_unit_test(a_gesture_is_one_step),
        cmocka_unit_test(a_change_drops_undone_steps),
        cmocka_unit_test(a_gesture_without_effect_is_no_step),
        cmocka_unit_test(version_counts_new_renders),
        cmocka_unit_test(comparing_shows_saved_values_and_the_present_camera),
        cmocka_unit_test(changes_end_comparing),
        cmocka_unit_test(a_reload_keeps_camera_steps),
        cmocka_unit_test(the_camera_of_a_changed_file_is_a_step),
        cmocka_unit_test(random_changes_match_copies_of_the_state),
    };

    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
