// SPDX-License-Identifier: MIT
#include "session/session_save.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "base/thread_pool.h"
#include "engine/engine_film.h"
#include "film/image_write.h"
#include "read/mtl_save.h"
#include "read/view_file.h"
#include "render/filtered_picture.h"
#include "render/render_metadata.h"
#include "terminal/xmalloc.h"

/* ---- pictures ---- */

bool save_thread_init(struct save_thread *s, struct error *err)
{
    *s = (struct save_thread){.stem = NULL};
    return background_init(&s->copying, "saver", err);
}

/* Traces what the filter needs besides the film. */
static bool trace_draft(struct save_thread *s, struct film *draft)
{
    struct film *film = s->picture.film;
    struct error ignored;
    struct pool *pool = pool_create(usable_threads(), &ignored);
    bool ok = filtered_picture_draft(draft, &s->picture.world, film->width,
                                     film->height, pool, &s->cancel, &ignored);

    pool_destroy(pool);
    return ok;
}

static bool filter(struct save_thread *s, struct film *film, struct film *draft)
{
    struct frame *frame = &s->picture.frame;

    if (!frame_init(frame, film->width, film->height, &s->error))
        return false;
    s->was_filtered =
        filtered_picture_paint(film, draft, s->picture.how, frame, &s->error);
    if (s->was_filtered)
        s->name =
            image_write_frame_numbered(frame, &s->picture.filtered_metadata,
                                       s->stem, &s->error);
    return s->was_filtered;
}

/* Adds the hashes of the scene, the view and the kernels to the metadata. */
static void identify(struct picture_to_save *p)
{
    struct error ignored;

    if (p->identified.positions == NULL ||
        !engine_film_hash(&p->identified, p->kernels_path, &p->identity,
                          &ignored))
        return;
    render_metadata_identify(&p->metadata, &p->identity);
    render_metadata_identify(&p->filtered_metadata, &p->identity);
}

static void save_film(struct save_thread *s)
{
    struct film copy = {0}, draft = {0};
    bool ok = film_copy(&copy, s->picture.film, &s->error);
    bool filters = ok && s->picture.is_filtered && trace_draft(s, &draft);

    identify(&s->picture);
    background_has_copied(&s->copying);
    if (ok && !(filters && filter(s, &copy, &draft)))
        s->name =
            image_write_numbered(&copy, s->picture.how, &s->picture.metadata,
                                 s->stem, s->picture.ending, &s->error);
    film_free(&draft);
    film_free(&copy);
}

static void save(void *context)
{
    struct save_thread *s = context;

    stop_hold();
    s->was_filtered = false;
    if (s->picture.film != NULL) {
        save_film(s);
    } else if (s->picture.text != NULL) {
        background_has_copied(&s->copying);
        s->name =
            file_write_numbered(s->stem, s->picture.ending, s->picture.text,
                                s->picture.text_bytes, &s->error);
        free(s->picture.text);
    } else {
        background_has_copied(&s->copying);
        s->name =
            image_write_frame_numbered(&s->picture.frame, &s->picture.metadata,
                                       s->stem, &s->error);
    }
    frame_free(&s->picture.frame);
    stop_release();
}

void save_thread_wait_copied(struct save_thread *s)
{
    cancel_request(&s->cancel);
    background_wait_copied(&s->copying);
}

bool save_thread_begin(struct save_thread *s, const struct picture_to_save *p,
                       struct error *err)
{
    char *what;
    bool ok;

    if (s->copying.is_busy)
        return fail(err, "%s.%s: the previous picture is still being saved",
                    p->stem, p->ending);
    s->picture = *p;
    s->picture.stem = s->stem = xstrdup(p->stem);
    s->name = NULL;
    cancel_reset(&s->cancel);
    what = xformat("%s.%s", p->stem, p->ending);
    ok = background_begin(&s->copying, save, s, what, err);
    free(what);
    if (!ok)
        free(s->stem);
    return ok;
}

char *save_thread_finish(struct save_thread *s, struct error *err)
{
    background_finish(&s->copying);
    free(s->stem);
    s->stem = NULL;
    if (!s->name)
        *err = s->error;
    return s->name;
}

void save_thread_free(struct save_thread *s)
{
    struct error ignored;

    if (s->copying.is_busy)
        free(save_thread_finish(s, &ignored));
    background_free(&s->copying);
}

/* ---- edits ---- */

/* Returns the material whose saved block is the template for a new one: the
 * material itself or the nearest original that is in a file. */
static uint32_t pattern_of(const struct edit *e, uint32_t material)
{
    while (!e->saved.is_there[material])
        material = e->copied_from[material];
    return material;
}

/* Returns the index of the MTL file that has the material, or will have it. */
static uint32_t file_of(const struct session *s, uint32_t material)
{
    const struct edit *e = &s->edit;

    while (e->copied_from[material] != NO_INDEX)
        material = e->copied_from[material];
    return s->engine.scene.material_origins[material].file != NO_INDEX
               ? s->engine.scene.material_origins[material].file
               : 0;
}

/* Lists the unsaved changes of one MTL file. Returns their number. */
static size_t collect(struct session *s, uint32_t file,
                      struct mtl_change *changes, uint32_t *materials)
{
    struct edit *e = &s->edit;
    size_t count = 0;

    for (uint32_t i = 0; i < e->material_count; i++) {
        uint32_t pattern = pattern_of(e, i);

        if (file_of(s, i) != file || !edit_simplify_material(e, i, pattern))
            continue;
        changes[count] = (struct mtl_change){
            .name = e->names[i],
            .copied_from = pattern != i ? e->names[pattern] : NULL,
            .before = &e->saved.sources[pattern],
            .after = &e->now.sources[i],
        };
        materials[count++] = i;
    }
    return count;
}

/* Count of the materials that were written, and the names of their files. */
struct written {
    size_t count;
    char *files; /* separated by commas, or NULL */
};

static void note_written(struct written *w, size_t count, const char *path)
{
    char *files =
        w->files == NULL ? xstrdup(path) : xformat("%s, %s", w->files, path);

    free(w->files);
    w->files = files;
    w->count += count;
}

static bool save_file(struct session *s, uint32_t file,
                      struct file_watch *watch, struct written *written,
                      struct error *err)
{
    const char *path = s->engine.scene.mtl_paths[file];
    struct mtl_change *changes =
        xcalloc(s->edit.material_count, sizeof *changes);
    uint32_t *materials = xcalloc(s->edit.material_count, sizeof *materials);
    size_t count = collect(s, file, changes, materials);
    struct file_change change;
    bool ok = count == 0 ||
              mtl_save(&s->engine.scene, path,
                       (struct mtl_changes){changes, count}, &change, err);

    if (ok && count > 0) {
        file_watch_replaced(watch, path, &change);
        note_written(written, count, path);
    }
    for (size_t i = 0; ok && i < count; i++)
        edit_saved_material(&s->edit, materials[i]);
    free(changes);
    free(materials);
    return ok;
}

/* Writes light and assignments into the view file. The file is read first,
 * since its camera and other values stay. */
static bool save_lighting(struct session *s, struct file_watch *watch,
                          struct error *err)
{
    struct file_change change;
    struct warnings report = {0};
    struct view view;
    bool ok;

    view_init(&view);
    ok = access(s->engine.view_path, F_OK) == 0
             ? view_read(&view, s->engine.view_path, &report, err)
             : (xcheck(view_copy(&view, &s->edit.saved.view)), true);
    edit_to_view(&s->edit, &s->engine.scene, &view);
    ok = ok && view_write(&view, s->engine.view_path, &change, err);
    if (ok) {
        edit_saved_lighting(&s->edit, &view);
        file_watch_replaced(watch, s->engine.view_path, &change);
    }
    view_free(&view);
    warnings_free(&report);
    return ok;
}

void session_view_to_save(const struct session *s, struct view *view)
{
    view_init(view);
    xcheck(view_copy(view, &s->edit.now.view) &&
           assigns_copy(&view->assigns, &s->edit.saved.view.assigns));
    view->has_camera = true; /* also a camera that the program placed */
    edit_to_view(&s->edit, &s->engine.scene, view);
}

bool session_save_view(struct session *s, struct file_change *change,
                       struct error *err)
{
    struct view view;
    bool ok;

    session_view_to_save(s, &view);
    view_copy_frame(&view, &s->edit.saved.view);
    ok = view_write(&view, s->engine.view_path, change, err);
    if (ok)
        edit_saved_view(&s->edit, &view);
    view_free(&view);
    return ok;
}

/* Returns the line about the written files. view_path is NULL if the view file
 * was not written. */
static char *say_written(const struct written *w, const char *view_path)
{
    if (w->count == 0 && view_path == NULL)
        return xstrdup("no changes since the last save");
    if (w->count == 0)
        return xformat("wrote %s", view_path);
    return xformat("wrote %zu material%s to %s%s%s", w->count,
                   print_plural(w->count), w->files,
                   view_path != NULL ? ", and " : "",
                   view_path != NULL ? view_path : "");
}

/* Appends a part of a list, which it takes. */
static void append(char **list, char *part)
{
    char *longer = *list != NULL ? xformat("%s, %s", *list, part) : NULL;

    if (longer != NULL)
        free(part);
    free(*list);
    *list = longer != NULL ? longer : part;
}

char *session_unsaved(struct session *s)
{
    struct mtl_change *changes =
        xcalloc(s->edit.material_count, sizeof *changes);
    uint32_t *materials = xcalloc(s->edit.material_count, sizeof *materials);
    char *list = NULL;

    for (uint32_t i = 0; i < s->engine.scene.mtl_path_count; i++) {
        size_t count = collect(s, i, changes, materials);

        if (count > 0)
            append(&list,
                   xformat("%zu material%s to %s", count, print_plural(count),
                           path_name(s->engine.scene.mtl_paths[i])));
    }
    if (edit_has_unsaved_view(&s->edit))
        append(&list, xstrdup(path_name(s->engine.view_path)));
    free(changes);
    free(materials);
    return list;
}

bool session_save_edit(struct session *s, struct file_watch *watch, char **what,
                       struct error *err)
{
    bool has_lighting = edit_has_unsaved_view(&s->edit);
    struct written written = {0};
    bool ok = true;

    if (edit_has_unsaved_materials(&s->edit) &&
        s->engine.scene.mtl_path_count == 0)
        return fail(err,
                    "%s: found no MTL file of this scene, expected one to "
                    "write the materials to",
                    s->engine.scene.path);
    for (uint32_t i = 0; ok && i < s->engine.scene.mtl_path_count; i++)
        ok = save_file(s, i, watch, &written, err);
    ok = ok && (!has_lighting || save_lighting(s, watch, err));
    if (ok)
        *what =
            say_written(&written, has_lighting ? s->engine.view_path : NULL);
    free(written.files);
    return ok;
}
