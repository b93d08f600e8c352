// SPDX-License-Identifier: MIT
#include "session/edit_history.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "formats/scene_load.h"
#include "terminal/xmalloc.h"

enum step_kind { STEP_MATERIAL, STEP_ASSIGN, STEP_DUPLICATE, STEP_MOOD };

union value {
    struct mtl_source source;
    uint32_t material;
    bool is_there;
    struct mood mood;
};

/* One thing that changed; all of a group are a step for people. */
struct edit_step {
    enum step_kind kind;
    uint32_t index; /* of the material or object */
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
    to->mood = from->mood;
}

static void free_state(struct edit_state *s)
{
    free(s->sources);
    free(s->is_there);
    free(s->assigned);
    *s = (struct edit_state){.sources = NULL};
}

static void grow_state(struct edit_state *s, uint32_t count)
{
    s->sources = xrealloc(s->sources, count * sizeof *s->sources);
    s->is_there = xrealloc(s->is_there, count * sizeof *s->is_there);
}

/* Room for one more material. */
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
    e->now.mood = (struct mood){
        .has_background = view->lighting.has_background,
        .sky = edit_sky(e, view->lighting.sky_path != NULL
                               ? view->lighting.sky_path
                               : ""),
        .sky_strength = view->lighting.sky_strength,
        .sky_rotation_deg = view->lighting.sky_rotation_deg,
        .exposure = view->lighting.exposure,
        .tone = view->lighting.tone,
    };
    memcpy(e->now.mood.background, view->lighting.background,
           sizeof view->lighting.background);
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
    switch (s->kind) {
    case STEP_MATERIAL: e->now.sources[s->index] = value->source; break;
    case STEP_ASSIGN: e->now.assigned[s->index] = value->material; break;
    case STEP_DUPLICATE: e->now.is_there[s->index] = value->is_there; break;
    case STEP_MOOD: e->now.mood = value->mood; break;
    }
}

/* Does it, and takes what was undone out of the history. A later change of the
 * same thing in the same group takes the place of the earlier one. */
static void change(struct edit *e, const struct edit_step *step)
{
    struct edit_step *last = NULL;
    void *steps = e->steps;

    e->step_count = e->done_count;
    if (e->done_count > 0)
        last = &e->steps[e->done_count - 1];
    if (last != NULL && last->group == e->group && last->kind == step->kind &&
        last->index == step->index) {
        last->after = step->after;
    } else {
        if (!grow_array(&steps, &e->step_capacity, e->step_count + 1,
                        sizeof *e->steps))
            return; /* it would not be undone, so it is not done */
        e->steps = steps;
        e->steps[e->step_count] = *step;
        e->steps[e->step_count++].group = e->group;
        e->done_count = e->step_count;
    }
    set(e, step, &step->after);
}

void edit_break(struct edit *e)
{
    e->group++;
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

static bool moods_equal(const struct mood *a, const struct mood *b)
{
    return memcmp(a->background, b->background, sizeof a->background) == 0 &&
           a->has_background == b->has_background && a->sky == b->sky &&
           a->sky_strength == b->sky_strength &&
           a->sky_rotation_deg == b->sky_rotation_deg &&
           a->exposure == b->exposure && a->tone == b->tone;
}

void edit_mood(struct edit *e, const struct mood *mood)
{
    struct edit_step step = {
        .kind = STEP_MOOD,
        .before = {.mood = e->now.mood},
        .after = {.mood = *mood},
    };

    if (!moods_equal(&step.before.mood, mood))
        change(e, &step);
}

static bool has_name(const struct edit *e, const char *name)
{
    for (uint32_t i = 0; i < e->material_count; i++)
        if (strcmp(e->names[i], name) == 0)
            return true;
    return false;
}

/* "wood" becomes wood.2, and that wood.3. */
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

bool edit_undo(struct edit *e)
{
    uint32_t group;

    if (e->done_count == 0)
        return false;
    group = e->steps[e->done_count - 1].group;
    while (e->done_count > 0 && e->steps[e->done_count - 1].group == group) {
        const struct edit_step *s = &e->steps[--e->done_count];

        set(e, s, &s->before);
    }
    edit_break(e);
    return true;
}

bool edit_redo(struct edit *e)
{
    uint32_t group;

    if (e->done_count == e->step_count)
        return false;
    group = e->steps[e->done_count].group;
    while (e->done_count < e->step_count &&
           e->steps[e->done_count].group == group) {
        const struct edit_step *s = &e->steps[e->done_count++];

        set(e, s, &s->after);
    }
    edit_break(e);
    return true;
}

/* ---- what is shown and saved ---- */

const struct edit_state *edit_shown(const struct edit *e)
{
    return e->is_comparing ? &e->saved : &e->now;
}

bool edit_is_saved(const struct edit *e, uint32_t i)
{
    /* a duplicate that was saved and then undone stays in its file */
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
    return !moods_equal(&e->now.mood, &e->saved.mood) ||
           memcmp(e->now.assigned, e->saved.assigned,
                  e->object_count * sizeof *e->now.assigned) != 0;
}

bool edit_tidy_material(struct edit *e, uint32_t material, uint32_t pattern)
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

void edit_saved_view(struct edit *e)
{
    memcpy(e->saved.assigned, e->now.assigned,
           e->object_count * sizeof *e->now.assigned);
    e->saved.mood = e->now.mood;
}

/* An object that never had an effect keeps its line. */
static void write_assigns(const struct edit *e, const struct edit_state *s,
                          const struct scene *scene, struct assigns *assigns)
{
    for (uint32_t i = 0; i < e->object_count; i++) {
        uint32_t material = s->assigned[i];

        if (material != NO_INDEX)
            xcheck(assigns_set(assigns, scene->object_names[i],
                               e->names[material]));
        else if (e->saved.assigned[i] != NO_INDEX ||
                 e->now.assigned[i] != NO_INDEX)
            xcheck(assigns_set(assigns, scene->object_names[i], NULL));
    }
}

void edit_to_view(const struct edit *e, const struct edit_state *s,
                  const struct scene *scene, struct view *view)
{
    const struct mood *m = &s->mood;

    memcpy(view->lighting.background, m->background,
           sizeof view->lighting.background);
    view->lighting.has_background = m->has_background;
    view->lighting.sky_strength = m->sky_strength;
    view->lighting.sky_rotation_deg = m->sky_rotation_deg;
    view->lighting.exposure = m->exposure;
    view->lighting.tone = m->tone;
    free(view->lighting.sky_path);
    view->lighting.sky_path =
        m->sky != 0 ? xstrdup(e->skies.items[m->sky]) : NULL;
    write_assigns(e, s, scene, &view->assigns);
}
