// SPDX-License-Identifier: MIT
#include "session/edit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "terminal/xmalloc.h"

/* ---- history ---- */

/* Longest pause within a gesture: longer than the delay of keyboards before a
 * held key repeats. */
#define GESTURE_NS UINT64_C(700000000)

static void free_step(struct edit_step *step)
{
    if (step->kind == STEP_MATERIAL)
        free(step->value.source);
    if (step->kind == STEP_LIGHTING)
        free(step->value.lighting);
    if (step->kind == STEP_LAMPS)
        lamps_free(&step->value.lamps);
    if (step->kind == STEP_SMOKES)
        smokes_free(&step->value.smokes);
}

/* Drops all steps from number `count` on. */
static void truncate_steps(struct edit_history *h, size_t count)
{
    while (h->step_count > count)
        free_step(&h->steps[--h->step_count]);
    h->done_count = count;
}

void edit_history_free(struct edit_history *h)
{
    truncate_steps(h, 0);
    free(h->steps);
    *h = (struct edit_history){.steps = NULL};
}

void edit_history_end_step(struct edit_history *h)
{
    h->group++;
    h->gesture = 0;
}

bool edit_history_begin_gesture(struct edit_history *h, uint32_t gesture,
                                uint64_t now_ns)
{
    bool is_new = gesture != h->gesture || now_ns - h->gesture_ns > GESTURE_NS;

    if (is_new)
        h->group++;
    h->gesture = gesture;
    h->gesture_ns = now_ns;
    return is_new;
}

static void push(struct edit_history *h, const struct edit_step *step)
{
    void *steps = h->steps;

    xcheck(grow_array(&steps, &h->step_capacity, h->step_count + 1,
                      sizeof *h->steps));
    h->steps = steps;
    h->steps[h->step_count++] = *step;
}

const struct edit_step *edit_history_add(struct edit_history *h,
                                         struct edit_step step)
{
    struct edit_step *last = NULL;

    truncate_steps(h, h->done_count);
    if (h->step_count > 0 && h->steps[h->step_count - 1].group == h->group)
        last = &h->steps[h->step_count - 1];
    if (last != NULL && last->kind == step.kind && last->index == step.index) {
        free_step(&step);
        return last;
    }
    if (last != NULL && h->gesture != 0)
        h->group++;
    step.group = h->group;
    push(h, &step);
    h->done_count = h->step_count;
    return &h->steps[h->step_count - 1];
}

void edit_history_drop_last(struct edit_history *h)
{
    truncate_steps(h, h->done_count - 1);
}

struct edit_step *edit_history_back(struct edit_history *h,
                                    const struct edit_step *group)
{
    struct edit_step *step;

    if (h->done_count == 0)
        return NULL;
    step = &h->steps[h->done_count - 1];
    if (group != NULL && step->group != group->group)
        return NULL;
    h->done_count--;
    return step;
}

struct edit_step *edit_history_forward(struct edit_history *h,
                                       const struct edit_step *group)
{
    struct edit_step *step;

    if (h->done_count == h->step_count)
        return NULL;
    step = &h->steps[h->done_count];
    if (group != NULL && step->group != group->group)
        return NULL;
    h->done_count++;
    return step;
}

void edit_history_take_camera(struct edit_history *h,
                              const struct edit_history *from)
{
    for (size_t i = 0; i < from->step_count; i++) {
        const struct edit_step *step = &from->steps[i];

        if (step->kind != STEP_POSE && step->kind != STEP_SHOT)
            continue;
        push(h, step);
        h->done_count += i < from->done_count;
    }
    h->group = from->group + 1;
}

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
    edit_history_free(&e->history);
    *e = (struct edit){.names = NULL};
}

uint32_t edit_sky(struct edit *e, const char *path)
{
    uint32_t sky = name_table_add(&e->skies, path);

    return sky != NO_NAME ? sky : 0;
}

/* ---- changes ---- */

/* Returns a lighting whose path belongs to edit.skies, which only grows. */
static struct lighting with_own_path(struct edit *e,
                                     const struct lighting *lighting)
{
    struct lighting lent = *lighting;
    uint32_t sky = lent.sky_path != NULL ? edit_sky(e, lent.sky_path) : 0;

    lent.sky_path = sky != 0 ? e->skies.items[sky] : NULL;
    return lent;
}

static struct edit_shot shot_of(const struct view *view, uint32_t number)
{
    return (struct edit_shot){view->shots[number], view->has_shot[number]};
}

static bool is_same_pose(const struct pose *a, const struct pose *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* Returns true if the step's value is the one of now. */
static bool is_now(const struct edit *e, const struct edit_step *s)
{
    const struct edit_state *now = &e->now;
    const struct view *view = &now->view;

    switch (s->kind) {
    case STEP_MATERIAL:
        return material_values_equal(s->value.source, &now->sources[s->index]);
    case STEP_ASSIGN: return s->value.material == now->assigned[s->index];
    case STEP_DUPLICATE: return s->value.is_there == now->is_there[s->index];
    case STEP_LIGHTING:
        return lighting_equal(s->value.lighting, &view->lighting);
    case STEP_LAMPS: return lamps_equal(&s->value.lamps, &view->lamps);
    case STEP_SMOKES: return smokes_equal(&s->value.smokes, &view->smokes);
    case STEP_POSE: return is_same_pose(&s->value.pose, &view->pose);
    case STEP_SHOT:
        return s->value.shot.is_there == view->has_shot[s->index] &&
               is_same_pose(&s->value.shot.pose, &view->shots[s->index]);
    }
    return false;
}

/* Exchanges the light of now with a step's. Returns true if the picture must be
 * rendered anew. */
static bool exchange_lighting(struct edit *e, struct lighting *value)
{
    struct lighting before = with_own_path(e, &e->now.view.lighting);

    xcheck(lighting_copy(&e->now.view.lighting, value));
    *value = before;
    return !lighting_is_same_light(&e->now.view.lighting, value);
}

#define EXCHANGE(type, a, b)    \
    do {                        \
        type exchanged_ = *(a); \
        *(a) = *(b);            \
        *(b) = exchanged_;      \
    } while (false)

/* Exchanges the value of now with the step's. */
static void exchange(struct edit *e, struct edit_step *s)
{
    struct edit_state *now = &e->now;
    struct view *view = &now->view;
    struct edit_shot shot;
    bool must_render = true;

    switch (s->kind) {
    case STEP_MATERIAL:
        EXCHANGE(struct material_values, &now->sources[s->index],
                 s->value.source);
        break;
    case STEP_ASSIGN:
        EXCHANGE(uint32_t, &now->assigned[s->index], &s->value.material);
        break;
    case STEP_DUPLICATE: /* no object has it yet */
        EXCHANGE(bool, &now->is_there[s->index], &s->value.is_there);
        must_render = false;
        break;
    case STEP_LIGHTING:
        must_render = exchange_lighting(e, s->value.lighting);
        break;
    case STEP_LAMPS:
        EXCHANGE(struct lamps, &view->lamps, &s->value.lamps);
        break;
    case STEP_SMOKES:
        EXCHANGE(struct smokes, &view->smokes, &s->value.smokes);
        break;
    case STEP_POSE: EXCHANGE(struct pose, &view->pose, &s->value.pose); break;
    case STEP_SHOT:
        shot = shot_of(view, s->index);
        view->shots[s->index] = s->value.shot.pose;
        view->has_shot[s->index] = s->value.shot.is_there;
        s->value.shot = shot;
        must_render = false;
        break;
    }
    e->version += must_render;
    e->changes += s->kind != STEP_POSE;
    if (s->kind != STEP_POSE && s->kind != STEP_SHOT)
        edit_compare(e, false); /* shows the change */
}

/* Carries out a change to the step's value. A group of changes that comes back
 * to the value before it leaves no step. */
static void change(struct edit *e, struct edit_step step)
{
    const struct edit_step *last;

    exchange(e, &step);
    last = edit_history_add(&e->history, step);
    if (is_now(e, last))
        edit_history_drop_last(&e->history);
}

void edit_end_step(struct edit *e)
{
    edit_history_end_step(&e->history);
}

bool edit_begin_gesture(struct edit *e, uint32_t gesture, uint64_t now_ns)
{
    return edit_history_begin_gesture(&e->history, gesture, now_ns);
}

void edit_material(struct edit *e, uint32_t material,
                   const struct material_values *source)
{
    struct edit_step step = {.kind = STEP_MATERIAL, .index = material};

    if (material_values_equal(source, &e->now.sources[material]))
        return;
    step.value.source = xmalloc(sizeof *source);
    *step.value.source = *source;
    change(e, step);
}

void edit_assign(struct edit *e, uint32_t object, uint32_t material)
{
    struct edit_step step = {.kind = STEP_ASSIGN,
                             .index = object,
                             .value.material = material};

    if (!is_now(e, &step))
        change(e, step);
}

void edit_lighting(struct edit *e, const struct lighting *lighting)
{
    struct edit_step step = {.kind = STEP_LIGHTING};

    if (lighting_equal(lighting, &e->now.view.lighting))
        return;
    step.value.lighting = xmalloc(sizeof *lighting);
    *step.value.lighting = with_own_path(e, lighting);
    change(e, step);
}

/* Begins a change of the lamps with a copy of them. */
static struct edit_step lamps_step(const struct edit *e, uint32_t number)
{
    struct edit_step step = {.kind = STEP_LAMPS, .index = number};

    xcheck(lamps_copy(&step.value.lamps, &e->now.view.lamps));
    return step;
}

void edit_lamp(struct edit *e, uint32_t number, const struct lamp *lamp)
{
    struct edit_step step;

    if (lamp_equal(lamp, &e->now.view.lamps.items[number]))
        return;
    step = lamps_step(e, number);
    profile_share(lamp->profile);
    profile_release(step.value.lamps.items[number].profile);
    step.value.lamps.items[number] = *lamp;
    change(e, step);
}

uint32_t edit_add_lamp(struct edit *e, const struct lamp *lamp)
{
    uint32_t number = e->now.view.lamps.count;
    struct edit_step step = lamps_step(e, number);

    xcheck(lamps_add(&step.value.lamps, lamp));
    change(e, step);
    return number;
}

void edit_remove_lamp(struct edit *e, uint32_t number)
{
    struct edit_step step = lamps_step(e, number);

    lamps_remove(&step.value.lamps, number);
    change(e, step);
}

/* Begins a change of the smokes with a copy of some. */
static struct edit_step smokes_step(const struct smokes *smokes,
                                    uint32_t number)
{
    struct edit_step step = {.kind = STEP_SMOKES, .index = number};

    xcheck(smokes_copy(&step.value.smokes, smokes));
    return step;
}

void edit_smoke(struct edit *e, uint32_t number,
                const struct smoke_numbers *numbers)
{
    const struct smokes *smokes = &e->now.view.smokes;
    struct edit_step step;

    if (memcmp(&smokes->items[number].numbers, numbers, sizeof *numbers) == 0)
        return;
    step = smokes_step(smokes, number);
    step.value.smokes.items[number].numbers = *numbers;
    change(e, step);
}

void edit_pose(struct edit *e, const struct pose *pose)
{
    struct edit_step step = {.kind = STEP_POSE, .value.pose = *pose};

    if (!is_now(e, &step))
        change(e, step);
}

void edit_shot(struct edit *e, uint32_t number)
{
    struct edit_step step = {.kind = STEP_SHOT,
                             .index = number,
                             .value.shot = {e->now.view.pose, true}};

    edit_end_step(e);
    if (!is_now(e, &step))
        change(e, step);
    edit_end_step(e);
}

uint32_t edit_find_material(const struct edit *e, const char *name)
{
    for (uint32_t i = 0; i < e->material_count; i++)
        if (strcmp(e->names[i], name) == 0)
            return i;
    return NO_INDEX;
}

/* Returns "wood.2" for "wood", and "wood.3" for "wood.2"; the caller frees. */
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
        if (edit_find_material(e, text) == NO_INDEX)
            return text;
        free(text);
    }
}

uint32_t edit_duplicate_as(struct edit *e, uint32_t material, const char *name)
{
    struct edit_step step = {.kind = STEP_DUPLICATE,
                             .index = e->material_count,
                             .value.is_there = true};

    add_material(e, name, material);
    e->now.sources[step.index] = e->now.sources[material];
    e->now.is_there[step.index] = false;
    e->saved.sources[step.index] = material_values_empty();
    e->saved.is_there[step.index] = false;
    change(e, step);
    return step.index;
}

uint32_t edit_duplicate(struct edit *e, uint32_t material)
{
    char *name = new_name(e, e->names[material]);
    uint32_t index = edit_duplicate_as(e, material, name);

    free(name);
    return index;
}

/* Carries out a change unless it has the value of now. */
static void change_to(struct edit *e, struct edit_step step)
{
    if (!is_now(e, &step))
        change(e, step);
}

void edit_take_view(struct edit *e, const struct view *view,
                    const uint32_t *assigned)
{
    struct edit_step lamps = {.kind = STEP_LAMPS};

    edit_pose(e, &view->pose);
    edit_lighting(e, &view->lighting);
    if (!lamps_equal(&view->lamps, &e->now.view.lamps)) {
        xcheck(lamps_copy(&lamps.value.lamps, &view->lamps));
        change(e, lamps);
    }
    if (!smokes_equal(&view->smokes, &e->now.view.smokes))
        change(e, smokes_step(&view->smokes, 0));
    for (uint32_t i = 0; i < VIEW_SHOTS; i++)
        change_to(e, (struct edit_step){.kind = STEP_SHOT,
                                        .index = i,
                                        .value.shot = shot_of(view, i)});
    for (uint32_t i = 0; i < e->object_count; i++)
        edit_assign(e, i, assigned[i]);
}

/* Writes step_text, the words for a group of steps: those of its first one. */
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
    case STEP_SMOKES: snprintf(text, size, "smoke"); break;
    case STEP_LAMPS:
    case STEP_LIGHTING: snprintf(text, size, "light"); break;
    case STEP_POSE: snprintf(text, size, "camera"); break;
    case STEP_SHOT: snprintf(text, size, "view %d", (int)s->index + 1); break;
    }
    return text;
}

const char *edit_undo(struct edit *e)
{
    const struct edit_step *first = NULL;
    struct edit_step *s;

    while ((s = edit_history_back(&e->history, first)) != NULL) {
        exchange(e, s);
        first = s;
    }
    edit_end_step(e);
    return first != NULL ? name_step(e, first) : NULL;
}

const char *edit_redo(struct edit *e)
{
    const struct edit_step *first = NULL;
    struct edit_step *s;

    while ((s = edit_history_forward(&e->history, first)) != NULL) {
        exchange(e, s);
        first = first != NULL ? first : s;
    }
    edit_end_step(e);
    return first != NULL ? name_step(e, first) : NULL;
}

void edit_forget_steps(struct edit *e)
{
    edit_history_free(&e->history);
}

/* ---- shown and saved state ---- */

static bool has_unsaved_assigned(const struct edit *e)
{
    return memcmp(e->now.assigned, e->saved.assigned,
                  e->object_count * sizeof *e->now.assigned) != 0;
}

/* Returns true if saved and present state have the same picture but for
 * exposure and tone. */
static bool is_shown_as_saved(const struct edit *e)
{
    return !edit_has_unsaved_materials(e) && !has_unsaved_assigned(e) &&
           lighting_is_same_light(&e->now.view.lighting,
                                  &e->saved.view.lighting) &&
           lamps_equal(&e->now.view.lamps, &e->saved.view.lamps) &&
           smokes_equal(&e->now.view.smokes, &e->saved.view.smokes);
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
    view.lamps = edit_shown(e)->view.lamps;
    view.smokes = edit_shown(e)->view.smokes;
    return view;
}

bool edit_has_saved_statements(const struct edit *e, uint32_t i)
{
    /* an undone duplicate that was saved stays in its file */
    return !e->now.is_there[i] ||
           (e->saved.is_there[i] &&
            material_values_equal(&e->now.sources[i], &e->saved.sources[i]));
}

bool edit_is_saved(const struct edit *e, uint32_t i)
{
    struct material_values needed;

    if (edit_has_saved_statements(e, i))
        return true;
    if (!e->saved.is_there[i])
        return false;
    needed = material_values_needed(&e->saved.sources[i], &e->now.sources[i]);
    return material_values_equal(&needed, &e->saved.sources[i]);
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
           !lamps_equal(&e->now.view.lamps, &e->saved.view.lamps) ||
           !smokes_equal(&e->now.view.smokes, &e->saved.view.smokes) ||
           has_unsaved_assigned(e);
}

bool edit_simplify_material(struct edit *e, uint32_t material, uint32_t pattern)
{
    if (edit_is_saved(e, material))
        return false;
    e->now.sources[material] =
        material_values_needed(&e->saved.sources[pattern],
                               &e->now.sources[material]);
    return !edit_is_saved(e, material);
}

void edit_saved_material(struct edit *e, uint32_t material)
{
    edit_compare(e, false);
    e->saved.sources[material] = e->now.sources[material];
    e->saved.is_there[material] = e->now.is_there[material];
    e->changes++;
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
    xcheck(lighting_copy(&view->lighting, &e->now.view.lighting) &&
           lamps_copy(&view->lamps, &e->now.view.lamps) &&
           smokes_copy(&view->smokes, &e->now.view.smokes));
    write_assigns(e, scene, &view->assigns);
}

void edit_saved_lighting(struct edit *e, const struct view *written)
{
    edit_compare(e, false);
    xcheck(lighting_copy(&e->saved.view.lighting, &written->lighting) &&
           assigns_copy(&e->saved.view.assigns, &written->assigns) &&
           lamps_copy(&e->saved.view.lamps, &written->lamps) &&
           smokes_copy(&e->saved.view.smokes, &written->smokes));
    memcpy(e->saved.assigned, e->now.assigned,
           e->object_count * sizeof *e->now.assigned);
    e->changes++;
}

void edit_saved_view(struct edit *e, const struct view *written)
{
    edit_saved_lighting(e, written);
    xcheck(view_copy(&e->saved.view, written));
    e->changes++;
}

/* ---- reload ---- */

void edit_keep_camera(struct edit *e, const struct edit *before)
{
    struct edit_step step = {.kind = STEP_POSE,
                             .value.pose = before->now.view.pose};

    view_keep_camera(&e->now.view, &before->now.view, &before->saved.view,
                     &e->saved.view);
    edit_history_take_camera(&e->history, &before->history);
    if (!is_now(e, &step)) /* the camera of the new view file is a change */
        edit_history_add(&e->history, step);
    edit_end_step(e);
    e->version = before->version + 1;
    e->changes = before->changes + 1;
}
