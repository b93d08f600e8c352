// SPDX-License-Identifier: MIT
#include "session/edit_history.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "formats/scene_load.h"
#include "terminal/xmalloc.h"

/* Time within which a gesture continues its step: longer than the delay of
 * keyboards before the first repeat. */
#define GESTURE_NS UINT64_C(700000000)

enum step_kind {
    STEP_MATERIAL,
    STEP_ASSIGN,
    STEP_DUPLICATE,
    STEP_LIGHTING,
    STEP_POSE,
    STEP_SHOT
};

union value {
    struct mtl_source source;
    uint32_t material;
    bool is_there;
    struct lighting lighting; /* sky_path belongs to edit.skies */
    struct pose pose;
    struct {
        struct pose pose;
        bool is_there;
    } shot;
};

/* Change of one value. All changes of a group are undone together. */
struct edit_step {
    enum step_kind kind;
    /* number of the material, object or view */
    uint32_t index;
    uint32_t group;
    union value before, after;
};

/* ---- states ---- */

static void *copy_array(const void *from, size_t count, size_t size_bytes)
{
    void *to = xcalloc(count + 1, size_bytes);

    memcpy(to, from, count * size_bytes);
    return to;
}

static void copy_state(const struct edit *e, struct edit_state *to,
                       const struct edit_state *from)
{
    to->sources =
        copy_array(from->sources, e->material_count, sizeof *to->sources);
    to->is_there =
        copy_array(from->is_there, e->material_count, sizeof *to->is_there);
    to->assigned =
        copy_array(from->assigned, e->object_count, sizeof *to->assigned);
    xcheck(view_copy(&to->view, &from->view));
}

static void free_state(struct edit_state *s)
{
    free(s->sources);
    free(s->is_there);
    free(s->assigned);
    view_free(&s->view);
    *s = (struct edit_state){.sources = NULL};
}

static void grow_state(struct edit_state *s, uint32_t count)
{
    s->sources = xrealloc(s->sources, count * sizeof *s->sources);
    s->is_there = xrealloc(s->is_there, count * sizeof *s->is_there);
}

/* Adds a material; the caller sets its sources. */
static void add_material(struct edit *e, const char *name, uint32_t copied_from)
{
    uint32_t index = e->material_count++;

    grow_state(&e->now, e->material_count);
    grow_state(&e->saved, e->material_count);
    e->names = xrealloc(e->names, e->material_count * sizeof *e->names);
    e->copied_from =
        xrealloc(e->copied_from, e->material_count * sizeof *e->copied_from);
    e->names[index] = xstrdup(name);
    e->copied_from[index] = copied_from;
}

void edit_init(struct edit *e, const struct scene *scene,
               const struct view *view, struct warnings *report)
{
    *e = (struct edit){.object_count = scene->object_count};
    for (uint32_t i = 0; i < scene->material_count; i++) {
        add_material(e, scene->material_names[i], NO_INDEX);
        e->now.sources[i] = scene->material_origins[i].source;
        e->now.is_there[i] = true;
    }
    e->now.assigned = xcalloc(e->object_count + 1, sizeof *e->now.assigned);
    scene_find_assigned(scene, &view->assigns, e->now.assigned, report);
    edit_sky(e, "");
    if (view->lighting.sky_path != NULL)
        edit_sky(e, view->lighting.sky_path);
    xcheck(view_copy(&e->now.view, view));
    free_state(&e->saved);
    copy_state(e, &e->saved, &e->now);
}

void edit_free(struct edit *e)
{
    for (uint32_t i = 0; i < e->material_count; i++)
        free(e->names[i]);
    free(e->names);
    free(e->copied_from);
    free_state(&e->now);
    free_state(&e->saved);
    name_table_free(&e->skies);
    free(e->steps);
    *e = (struct edit){.names = NULL};
}

uint32_t edit_sky(struct edit *e, const char *path)
{
    uint32_t sky = name_table_add(&e->skies, path);

    return sky != NO_NAME ? sky : 0;
}

/* ---- steps ---- */

static void set(struct edit *e, const struct edit_step *s,
                const union value *value)
{
    struct view *view = &e->now.view;
    bool is_same_light = false;

    switch (s->kind) {
    case STEP_MATERIAL: e->now.sources[s->index] = value->source; break;
    case STEP_ASSIGN: e->now.assigned[s->index] = value->material; break;
    case STEP_DUPLICATE: e->now.is_there[s->index] = value->is_there; break;
    case STEP_LIGHTING:
        is_same_light =
            lighting_is_same_light(&view->lighting, &value->lighting);
        xcheck(lighting_copy(&view->lighting, &value->lighting));
        break;
    case STEP_POSE: view->pose = value->pose; break;
    case STEP_SHOT:
        view->shots[s->index] = value->shot.pose;
        view->has_shot[s->index] = value->shot.is_there;
        break;
    }
    if (s->kind != STEP_SHOT && !is_same_light)
        e->version++;
    if (s->kind < STEP_POSE) /* the changed state is shown */
        edit_compare(e, false);
}

static bool joins(const struct edit_step *last, const struct edit_step *step)
{
    return last->kind == step->kind && last->index == step->index;
}

/* Makes a change and removes undone changes from the history. A change of the
 * same value in the same group is merged into the previous one. */
static void change(struct edit *e, const struct edit_step *step)
{
    struct edit_step *last = NULL;
    void *steps = e->steps;

    e->step_count = e->done_count;
    if (e->done_count > 0 && e->steps[e->done_count - 1].group == e->group)
        last = &e->steps[e->done_count - 1];
    if (last != NULL && !joins(last, step) && e->gesture != 0)
        e->group++; /* another value was changed during the gesture */
    if (last != NULL && joins(last, step)) {
        last->after = step->after;
    } else {
        if (!grow_array(&steps, &e->step_capacity, e->step_count + 1,
                        sizeof *e->steps))
            return; /* out of memory: no change without undo */
        e->steps = steps;
        e->steps[e->step_count] = *step;
        e->steps[e->step_count++].group = e->group;
        e->done_count = e->step_count;
    }
    set(e, step, &step->after);
}

void edit_end_step(struct edit *e)
{
    e->group++;
    e->gesture = 0;
}

bool edit_begin_gesture(struct edit *e, uint32_t gesture, uint64_t now_ns)
{
    bool is_new = gesture != e->gesture || now_ns - e->gesture_ns > GESTURE_NS;

    if (is_new)
        e->group++;
    e->gesture = gesture;
    e->gesture_ns = now_ns;
    return is_new;
}

void edit_material(struct edit *e, uint32_t material,
                   const struct mtl_source *source)
{
    struct edit_step step = {
        .kind = STEP_MATERIAL,
        .index = material,
        .before = {.source = e->now.sources[material]},
        .after = {.source = *source},
    };

    if (!mtl_source_equal(&step.before.source, source))
        change(e, &step);
}

void edit_assign(struct edit *e, uint32_t object, uint32_t material)
{
    struct edit_step step = {
        .kind = STEP_ASSIGN,
        .index = object,
        .before = {.material = e->now.assigned[object]},
        .after = {.material = material},
    };

    if (step.before.material != material)
        change(e, &step);
}

/* Returns a lighting whose path belongs to edit.skies, which only grows. */
static struct lighting with_own_path(struct edit *e,
                                     const struct lighting *lighting)
{
    struct lighting lent = *lighting;
    uint32_t sky = lent.sky_path != NULL ? edit_sky(e, lent.sky_path) : 0;

    lent.sky_path = sky != 0 ? e->skies.items[sky] : NULL;
    return lent;
}

void edit_lighting(struct edit *e, const struct lighting *lighting)
{
    struct edit_step step = {
        .kind = STEP_LIGHTING,
        .before = {.lighting = with_own_path(e, &e->now.view.lighting)},
        .after = {.lighting = with_own_path(e, lighting)},
    };

    if (!lighting_equal(&step.before.lighting, lighting))
        change(e, &step);
}

void edit_pose(struct edit *e, const struct pose *pose)
{
    struct edit_step step = {
        .kind = STEP_POSE,
        .before = {.pose = e->now.view.pose},
        .after = {.pose = *pose},
    };

    if (memcmp(&step.before.pose, pose, sizeof *pose) != 0)
        change(e, &step);
}

void edit_shot(struct edit *e, int number)
{
    const struct view *view = &e->now.view;
    struct edit_step step = {
        .kind = STEP_SHOT,
        .index = (uint32_t)number,
        .before = {.shot = {view->shots[number], view->has_shot[number]}},
        .after = {.shot = {view->pose, true}},
    };

    edit_end_step(e);
    change(e, &step);
    edit_end_step(e);
}

static bool has_name(const struct edit *e, const char *name)
{
    for (uint32_t i = 0; i < e->material_count; i++)
        if (strcmp(e->names[i], name) == 0)
            return true;
    return false;
}

/* Returns a free name, for free(): wood.2 for wood, wood.3 for wood.2. */
static char *new_name(const struct edit *e, const char *name)
{
    const char *dot = strrchr(name, '.');
    int length = (int)strlen(name);
    char *text;

    if (dot != NULL && dot != name &&
        strspn(dot + 1, "0123456789") == strlen(dot + 1))
        length = (int)(dot - name);
    if (*name == '\0') {
        name = "material";
        length = (int)strlen(name);
    }
    for (int i = 2;; i++) {
        text = xformat("%.*s.%d", length, name, i);
        if (!has_name(e, text))
            return text;
        free(text);
    }
}

uint32_t edit_duplicate(struct edit *e, uint32_t material)
{
    char *name = new_name(e, e->names[material]);
    struct edit_step step = {
        .kind = STEP_DUPLICATE,
        .index = e->material_count,
        .before = {.is_there = false},
        .after = {.is_there = true},
    };

    add_material(e, name, material);
    e->now.sources[step.index] = e->now.sources[material];
    e->now.is_there[step.index] = false;
    e->saved.sources[step.index] = mtl_source_empty();
    e->saved.is_there[step.index] = false;
    change(e, &step);
    free(name);
    return step.index;
}

/* Returns the name of a step, which depends on its first change. */
static const char *name_step(struct edit *e, const struct edit_step *s)
{
    char *text = e->step_text;
    size_t size = sizeof e->step_text;

    switch (s->kind) {
    case STEP_MATERIAL:
        snprintf(text, size, "material %.60s", e->names[s->index]);
        break;
    case STEP_ASSIGN: snprintf(text, size, "material of an object"); break;
    case STEP_DUPLICATE:
        snprintf(text, size, "copy %.60s", e->names[s->index]);
        break;
    case STEP_LIGHTING: snprintf(text, size, "light"); break;
    case STEP_POSE: snprintf(text, size, "camera"); break;
    case STEP_SHOT: snprintf(text, size, "view %d", (int)s->index + 1); break;
    }
    return text;
}

const char *edit_undo(struct edit *e)
{
    const struct edit_step *s = NULL;
    uint32_t group;

    if (e->done_count == 0)
        return NULL;
    group = e->steps[e->done_count - 1].group;
    while (e->done_count > 0 && e->steps[e->done_count - 1].group == group) {
        s = &e->steps[--e->done_count];
        set(e, s, &s->before);
    }
    edit_end_step(e);
    return name_step(e, s);
}

const char *edit_redo(struct edit *e)
{
    const struct edit_step *first;

    if (e->done_count == e->step_count)
        return NULL;
    first = &e->steps[e->done_count];
    while (e->done_count < e->step_count &&
           e->steps[e->done_count].group == first->group) {
        const struct edit_step *s = &e->steps[e->done_count++];

        set(e, s, &s->after);
    }
    edit_end_step(e);
    return name_step(e, first);
}

/* ---- shown and saved state ---- */

static bool has_unsaved_assigned(const struct edit *e)
{
    return memcmp(e->now.assigned, e->saved.assigned,
                  e->object_count * sizeof *e->now.assigned) != 0;
}

/* Returns true if saved and current state render the same picture, apart from
 * exposure and tone. */
static bool is_shown_as_saved(const struct edit *e)
{
    return !edit_has_unsaved_materials(e) && !has_unsaved_assigned(e) &&
           lighting_is_same_light(&e->now.view.lighting,
                                  &e->saved.view.lighting);
}

void edit_compare(struct edit *e, bool is_comparing)
{
    if (is_comparing != e->is_comparing && !is_shown_as_saved(e))
        e->version++;
    e->is_comparing = is_comparing;
}

const struct edit_state *edit_shown(const struct edit *e)
{
    return e->is_comparing ? &e->saved : &e->now;
}

struct view edit_view(const struct edit *e)
{
    struct view view = e->now.view;

    view.lighting = edit_shown(e)->view.lighting;
    return view;
}

bool edit_is_saved(const struct edit *e, uint32_t i)
{
    /* an undone duplicate that was saved stays in its file */
    return !e->now.is_there[i] ||
           (e->saved.is_there[i] &&
            mtl_source_equal(&e->now.sources[i], &e->saved.sources[i]));
}

bool edit_has_unsaved_materials(const struct edit *e)
{
    for (uint32_t i = 0; i < e->material_count; i++)
        if (!edit_is_saved(e, i))
            return true;
    return false;
}

bool edit_has_unsaved_view(const struct edit *e)
{
    return !lighting_equal(&e->now.view.lighting, &e->saved.view.lighting) ||
           has_unsaved_assigned(e);
}

bool edit_simplify_material(struct edit *e, uint32_t material, uint32_t pattern)
{
    if (edit_is_saved(e, material))
        return false;
    e->now.sources[material] = mtl_source_needed(&e->saved.sources[pattern],
                                                 &e->now.sources[material]);
    return !edit_is_saved(e, material);
}

void edit_saved_material(struct edit *e, uint32_t material)
{
    e->saved.sources[material] = e->now.sources[material];
    e->saved.is_there[material] = e->now.is_there[material];
}

/* Updates the lines of objects of the scene. Lines of unknown objects stay. */
static void write_assigns(const struct edit *e, const struct scene *scene,
                          struct assigns *assigns)
{
    for (uint32_t i = 0; i < e->object_count; i++) {
        uint32_t material = e->now.assigned[i];

        if (material != NO_INDEX)
            xcheck(assigns_set(assigns, scene->object_names[i],
                               e->names[material]));
        else if (e->saved.assigned[i] != NO_INDEX)
            xcheck(assigns_set(assigns, scene->object_names[i], NULL));
    }
}

void edit_to_view(const struct edit *e, const struct scene *scene,
                  struct view *view)
{
    xcheck(lighting_copy(&view->lighting, &e->now.view.lighting));
    write_assigns(e, scene, &view->assigns);
}

void edit_saved_lighting(struct edit *e, const struct view *written)
{
    xcheck(lighting_copy(&e->saved.view.lighting, &written->lighting) &&
           assigns_copy(&e->saved.view.assigns, &written->assigns));
    memcpy(e->saved.assigned, e->now.assigned,
           e->object_count * sizeof *e->now.assigned);
}

void edit_saved_view(struct edit *e, const struct view *written)
{
    xcheck(view_copy(&e->saved.view, written));
    edit_saved_lighting(e, written);
}

/* ---- reload ---- */

void edit_keep_camera(struct edit *e, const struct edit *before)
{
    view_keep_camera(&e->now.view, &before->now.view, &before->saved.view,
                     &e->saved.view);
    free(e->steps);
    e->steps = xcalloc(before->step_count + 1, sizeof *e->steps);
    e->step_count = e->done_count = 0;
    e->step_capacity = before->step_count + 1;
    for (size_t i = 0; i < before->step_count; i++) {
        if (before->steps[i].kind != STEP_POSE)
            continue;
        e->steps[e->step_count++] = before->steps[i];
        e->done_count += i < before->done_count;
    }
    e->group = before->group + 1;
    e->version = before->version + 1;
}
