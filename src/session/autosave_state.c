// SPDX-License-Identifier: MIT
#include "session/autosave_state.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "engine/scene_load.h"
#include "read/mtl.h"
#include "read/mtl_save.h"
#include "read/view_file.h"
#include "session/session_save.h"
#include "terminal/xmalloc.h"

/* ---- one state ---- */

/* Size of a name in the MTL text. */
#define NAME_BYTES 16

/* ---- writing a state ---- */

static bool take_view(struct autosave_file *k, const struct session *s,
                      const char *path, struct error *err)
{
    struct view view;
    bool ok;

    session_view_to_save(s, &view);
    ok = view_format(&view, &(struct file_bytes){path, "", 0},
                     &k->parts[AUTOSAVE_VIEW], &k->sizes[AUTOSAVE_VIEW], err);
    view_free(&view);
    return ok;
}

/* Adds the three lines of a material to a text. */
static char *add_lines(char *text, const struct edit *e, uint32_t material)
{
    uint32_t from = e->copied_from[material];
    char *longer = xformat("%s%s\n%s%s\n%" PRIu32 "\n", text,
                           e->names[material], from != NO_INDEX ? "=" : "-",
                           from != NO_INDEX ? e->names[from] : "",
                           e->now.sources[material].maps_off);

    free(text);
    return longer;
}

/* Copies the maps of a material with their scales, and its dialect. */
static void copy_maps(struct material_values *to,
                      const struct material_values *from)
{
    memcpy(to->maps, from->maps, sizeof to->maps);
    memcpy(to->map_scales, from->map_scales, sizeof to->map_scales);
    to->dialect = from->dialect;
}

/* Returns a material, or the one that it was copied from, as its file has it.
 */
static const struct material_values *saved_of(const struct edit *e,
                                              uint32_t material)
{
    while (!e->saved.is_there[material])
        material = e->copied_from[material];
    return &e->saved.sources[material];
}

/* Returns the maps of a material without those that edits have added, and no
 * other statements. */
static struct material_values maps_of(const struct edit *e, uint32_t material)
{
    struct material_values maps = material_values_empty();
    const struct material_values *saved = saved_of(e, material);

    copy_maps(&maps, &e->now.sources[material]);
    maps.maps_off = e->now.sources[material].maps_off;
    for (int i = 0; i < MTL_MAPS; i++)
        if (maps.maps[i] != saved->maps[i])
            maps.maps[i] = NO_INDEX;
    return maps;
}

/* Writes all statements, but of the maps only those that edits have added, of
 * all materials that differ from their files. Statements that make no
 * difference are kept, too: another type may need them again. Those of all
 * dialects are read as they are in files of Blender. */
static bool take_materials(struct autosave_file *k, const struct session *s,
                           const char *path, struct error *err)
{
    const struct edit *e = &s->edit;
    const char *dialect = mtl_dialect_line(MTL_BLENDER_4);
    char *head = xformat("%s\n", dialect);
    struct mtl_change *changes = xcalloc(e->material_count, sizeof *changes);
    struct material_values *maps = xcalloc(e->material_count, sizeof *maps);
    char(*names)[NAME_BYTES] = xcalloc(e->material_count, sizeof *names);
    char *list = xstrdup("");
    size_t count = 0;
    bool ok;

    for (uint32_t i = 0; i < e->material_count; i++) {
        if (edit_has_saved_statements(e, i))
            continue;
        snprintf(names[count], NAME_BYTES, "m%zu", count);
        maps[count] = maps_of(e, i);
        changes[count] = (struct mtl_change){names[count], names[count],
                                             &maps[count], &e->now.sources[i]};
        list = add_lines(list, e, i);
        count++;
    }
    k->parts[AUTOSAVE_MATERIALS] = list;
    k->sizes[AUTOSAVE_MATERIALS] = strlen(list);
    ok = mtl_rewrite(&s->engine.scene,
                     &(struct file_bytes){path, head, strlen(head)},
                     (struct mtl_changes){changes, count},
                     &k->parts[AUTOSAVE_MTL], &k->sizes[AUTOSAVE_MTL], err);
    free(names);
    free(maps);
    free(changes);
    free(head);
    return ok;
}

bool autosave_edit_take(struct autosave_file *k, const struct session *s,
                        const char *path, struct error *err)
{
    k->has_edits =
        edit_has_unsaved_materials(&s->edit) || edit_has_unsaved_view(&s->edit);
    return take_view(k, s, path, err) && take_materials(k, s, path, err);
}

/* ---- restoring a state ---- */

/* Returns the next line of the text at *p, for free(), or NULL at its end. */
static char *next_line(const char **p)
{
    size_t length = strcspn(*p, "\n");
    char *line;

    if ((*p)[length] == '\0')
        return NULL;
    line = xformat("%.*s", (int)length, *p);
    *p += length + 1;
    return line;
}

/* Finds a material by its name. Makes a duplicate, if it is one, which no file
 * has. */
static uint32_t find_or_duplicate(struct edit *e, const char *name,
                                  const char *original)
{
    uint32_t found = edit_find_material(e, name);
    uint32_t from;

    if (found != NO_INDEX || *original != '=')
        return found;
    from = edit_find_material(e, original + 1);
    return from != NO_INDEX ? edit_duplicate_as(e, from, name) : NO_INDEX;
}

/* Takes the statements of material number i of `mtl`, and the maps that it has
 * besides those of the file. */
static void restore_material(struct session *s, uint32_t material,
                             const struct scene *mtl, uint32_t i,
                             uint32_t maps_off)
{
    struct edit *e = &s->edit;
    const struct material_values *statements = &mtl->material_origins[i].source;
    struct material_values source = *statements;

    copy_maps(&source, saved_of(e, material));
    for (int map = 0; map < MTL_MAPS; map++)
        if (statements->maps[map] != NO_INDEX)
            source.maps[map] =
                mtl_add_map(&s->engine.scene, (enum mtl_map)map,
                            mtl->texture_paths[statements->maps[map]]);
    source.maps_off = maps_off & ((1u << MTL_MAPS) - 1);
    edit_material(e, material, &source);
}

/* Restores the materials of the list, whose statements `mtl` has, and the saved
 * values of all others. */
static void restore_list(struct session *s, const char *list,
                         const struct scene *mtl, uint32_t *missing)
{
    struct edit *e = &s->edit;
    bool *is_listed =
        xcalloc(e->material_count + mtl->material_count, sizeof *is_listed);
    char *name, *original, *maps_off;

    for (uint32_t i = 1; i < mtl->material_count; i++) {
        uint32_t material = NO_INDEX;

        name = next_line(&list);
        original = name != NULL ? next_line(&list) : NULL;
        maps_off = original != NULL ? next_line(&list) : NULL;
        if (maps_off != NULL)
            material = find_or_duplicate(e, name, original);
        if (material != NO_INDEX) {
            restore_material(s, material, mtl, i,
                             (uint32_t)strtoul(maps_off, NULL, 10));
            is_listed[material] = true;
        }
        *missing += material == NO_INDEX;
        free(name);
        free(original);
        free(maps_off);
    }
    for (uint32_t i = 0; i < e->material_count; i++)
        if (!is_listed[i] && e->saved.is_there[i])
            edit_material(e, i, &e->saved.sources[i]);
    free(is_listed);
}

static bool restore_materials(const struct autosave_file *k, struct session *s,
                              const char *path, uint32_t *missing,
                              struct error *err)
{
    struct warnings ignored = {0};
    struct scene mtl = {.path = NULL};
    bool ok = mtl_parse(&mtl, k->parts[AUTOSAVE_MTL], k->sizes[AUTOSAVE_MTL],
                        path, &ignored, err);

    if (ok)
        restore_list(s, k->parts[AUTOSAVE_MATERIALS], &mtl, missing);
    scene_free(&mtl);
    warnings_free(&ignored);
    return ok;
}

/* A background that the program has added is in no view file. */
static void keep_soft_sky(struct view *view, const struct view *opened)
{
    if (!view->lighting.has_background && view_has_soft_sky(opened))
        memcpy(view->lighting.background, opened->lighting.background,
               sizeof view->lighting.background);
}

/* Finds the materials that the kept view gives to objects. */
static void find_assigned(const struct session *s, const struct view *view,
                          uint32_t *assigned)
{
    for (uint32_t i = 0; i < s->edit.object_count; i++)
        assigned[i] = NO_INDEX;
    for (size_t i = 0; i < view->assigns.count; i++) {
        const struct assign *a = &view->assigns.items[i];
        uint32_t object = scene_find_object(&s->engine.scene, a->object);
        uint32_t material = edit_find_material(&s->edit, a->material);

        if (object != NO_INDEX && material != NO_INDEX)
            assigned[object] = material;
    }
}

bool autosave_edit_restore(const struct autosave_file *k, struct session *s,
                           const char *path, uint32_t *missing,
                           struct error *err)
{
    struct edit *e = &s->edit;
    struct warnings ignored = {0};
    uint32_t *assigned = xcalloc((size_t)e->object_count + 1, sizeof *assigned);
    struct view view;
    bool ok;

    *missing = 0;
    view_init(&view);
    edit_end_step(e);
    ok = view_parse(&view, k->parts[AUTOSAVE_VIEW], k->sizes[AUTOSAVE_VIEW],
                    path, &ignored, err) &&
         pose_check(&view.pose, path, err) &&
         restore_materials(k, s, path, missing, err);
    if (ok) {
        keep_soft_sky(&view, &e->saved.view);
        find_assigned(s, &view, assigned);
        edit_take_view(e, &view, assigned);
        edit_end_step(e);
    }
    view_free(&view);
    warnings_free(&ignored);
    free(assigned);
    return ok;
}

/* ---- history ---- */

/* Texts of a state, which come first in enum autosave_part. */
#define STATE_PARTS AUTOSAVE_HISTORY

/* ---- writing the history ---- */

/* A text that grows. */
struct text {
    char *bytes;
    size_t size;
};

static void add(struct text *t, const char *bytes, size_t size)
{
    t->bytes = xrealloc(t->bytes, t->size + size + 1);
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
    t->bytes[t->size] = '\0';
}

static void add_numbers(struct text *t, const size_t *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        char *text = xformat("%zu%c", numbers[i], i + 1 < count ? ' ' : '\n');

        add(t, text, strlen(text));
        free(text);
    }
}

/* Adds the present state of the edit. */
static bool add_state(struct text *t, const struct session *s, const char *path,
                      struct error *err)
{
    struct autosave_file state = {.scene = NULL};
    bool ok = autosave_edit_take(&state, s, path, err);

    if (ok)
        add_numbers(t, state.sizes, STATE_PARTS);
    for (int i = 0; ok && i < STATE_PARTS; i++)
        add(t, state.parts[i], state.sizes[i]);
    autosave_file_free(&state);
    return ok;
}

/* Undoes or redoes steps, at most this number. Returns how many there were. */
static size_t walk(struct edit *e, const char *(*step)(struct edit *),
                   size_t most)
{
    size_t count = 0;

    while (count < most && step(e) != NULL)
        count++;
    return count;
}

/* Returns the most steps that are kept of a session whose present state is
 * this large. */
static size_t most_steps(const struct autosave_file *k)
{
    size_t size = 1, most;

    for (int i = 0; i < STATE_PARTS; i++)
        size += k->sizes[i];
    most = AUTOSAVE_STEPS_BYTES / size;
    return most < AUTOSAVE_STEPS_MAX ? most : AUTOSAVE_STEPS_MAX;
}

/* Adds the states before and after the present one: goes to the oldest and from
 * there to the newest. */
static bool add_states(struct text *t, struct session *s, size_t most,
                       const char *path, struct error *err)
{
    struct edit *e = &s->edit;
    size_t undone = walk(e, edit_redo, most);
    size_t done;
    bool ok = true;

    walk(e, edit_undo, undone);
    done = walk(e, edit_undo, most);
    add_numbers(t, (size_t[]){done, undone}, 2);
    for (size_t i = 0; i < done; i++) {
        ok = ok && add_state(t, s, path, err);
        edit_redo(e);
    }
    for (size_t i = 0; i < undone; i++) {
        edit_redo(e);
        ok = ok && add_state(t, s, path, err);
    }
    walk(e, edit_undo, undone);
    return ok;
}

bool autosave_history_take(struct autosave_file *k, struct session *s,
                           const char *path, struct error *err)
{
    struct edit *e = &s->edit;
    const struct edit before = *e;
    struct text t = {.bytes = NULL};
    bool ok = autosave_edit_take(k, s, path, err) &&
              add_states(&t, s, most_steps(k), path, err);

    k->parts[AUTOSAVE_HISTORY] = t.bytes;
    k->sizes[AUTOSAVE_HISTORY] = t.size;
    /* the values are the same, and a gesture goes on */
    e->version = before.version;
    e->changes = before.changes;
    e->is_comparing = before.is_comparing;
    e->history.group = before.history.group;
    e->history.gesture = before.history.gesture;
    memcpy(e->step_text, before.step_text, sizeof e->step_text);
    return ok;
}

/* ---- restoring the history ---- */

struct reader {
    const char *p, *end, *path;
};

/* Reads the numbers of a line. A NUL is after the text. */
static bool read_numbers(struct reader *r, size_t *numbers, int count,
                         struct error *err)
{
    for (int i = 0; i < count; i++) {
        uint64_t number;

        if (!digits_parse(&r->p, 10, SIZE_MAX, &number) ||
            *r->p++ != (i + 1 < count ? ' ' : '\n'))
            return fail(err,
                        "%s: found another text in the history, expected "
                        "numbers",
                        r->path);
        numbers[i] = (size_t)number;
    }
    return true;
}

/* Reads the texts of a state. The caller frees after a failure, too. */
static bool read_state(struct reader *r, struct autosave_file *state,
                       struct error *err)
{
    size_t sizes[STATE_PARTS];

    *state = (struct autosave_file){.scene = NULL};
    if (!read_numbers(r, sizes, STATE_PARTS, err))
        return false;
    for (int i = 0; i < STATE_PARTS; i++) {
        if (sizes[i] > (size_t)(r->end - r->p))
            return fail(err, "%s: found the end of the history, expected more",
                        r->path);
        state->parts[i] = xmalloc(sizes[i] + 1);
        memcpy(state->parts[i], r->p, sizes[i]);
        state->parts[i][sizes[i]] = '\0';
        state->sizes[i] = sizes[i];
        r->p += sizes[i];
    }
    return true;
}

static bool restore_next(struct reader *r, struct session *s, struct error *err)
{
    struct autosave_file state;
    uint32_t missing;
    bool ok = read_state(r, &state, err) &&
              autosave_edit_restore(&state, s, r->path, &missing, err);

    autosave_file_free(&state);
    return ok;
}

bool autosave_history_restore(const struct autosave_file *k, struct session *s,
                              const char *path, uint32_t *missing,
                              struct error *err)
{
    const char *text = k->parts[AUTOSAVE_HISTORY];
    struct reader r = {text, text + k->sizes[AUTOSAVE_HISTORY], path};
    size_t numbers[2] = {0}; /* of done and of undone steps */
    size_t done;

    if (!read_numbers(&r, numbers, 2, err))
        return false;
    for (size_t i = 0; i < numbers[0]; i++) {
        if (!restore_next(&r, s, err))
            return false;
        if (i == 0)
            edit_forget_steps(&s->edit);
    }
    if (!autosave_edit_restore(k, s, path, missing, err))
        return false;
    done = s->edit.history.done_count;
    for (size_t i = 0; i < numbers[1]; i++)
        if (!restore_next(&r, s, err))
            return false;
    while (s->edit.history.done_count > done)
        edit_undo(&s->edit);
    return true;
}
