// SPDX-License-Identifier: MIT
/*
 * test_edit_random.c - after random changes, undo and redo give the same states
 * as copies of them
 */
#include "tests/unit/edits.h"

#define MS UINT64_C(1000000)

#define OPERATIONS    2000
#define MATERIALS_MAX 40

/* A copy of the whole present state, and the name of the step that made it. */
struct snapshot {
    uint32_t material_count;
    struct material_values sources[MATERIALS_MAX];
    bool is_there[MATERIALS_MAX];
    uint32_t assigned[8];
    struct lighting light;
    struct lamp lamp;
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
    s->lamp = shown->view.lamps.items[0];
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
            (a_has && !material_values_equal(&a->sources[i], &b->sources[i])))
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
           memcmp(&a->lamp, &b->lamp, sizeof a->lamp) == 0 &&
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
             !material_values_equal(&a->sources[m], &b->sources[m])))
            return false;
    }
    for (uint32_t i = 0; i < scene.material_count; i++)
        if (!material_values_equal(&a->sources[i], &b->sources[i]))
            return false;
    return a->sky == b->sky && lighting_is_same_light(&a->light, &b->light) &&
           memcmp(&a->lamp, &b->lamp, sizeof a->lamp) == 0 &&
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
    struct lamp lamp = e->now.view.lamps.items[0];
    uint32_t number = random_below(3);

    strcpy(name, "light");
    strcpy(thing, "light");
    switch (random_below(10)) {
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
    case 9:
        strcpy(thing, "lamp");
        lamp.rgb[1] = value();
        edit_lamp(e, 0, &lamp);
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
        cmocka_unit_test(random_changes_match_copies_of_the_state),
    };

    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
