// SPDX-License-Identifier: MIT
#include "studio/scene_list.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "terminal/xmalloc.h"

/* ---- rows ---- */

/* Returns what is in the column of keys: the ending of a name. */
static const char *kind_of(const struct scene_file *f)
{
    const char *dot = strrchr(path_name(f->path), '.');

    if (f->is_folder)
        return "folder";
    return dot != NULL && strlen(dot) < 8 ? dot + 1 : "";
}

/* Finds the files that match the search. */
static void find(struct scene_list *s)
{
    s->count = 0;
    for (int i = 0; i < s->files.count; i++) {
        const struct scene_file *f = &s->files.files[i];

        if (strcasestr(f->text, s->list.search) == NULL)
            continue;
        s->found[s->count] = i;
        s->rows[s->count++] = (struct list_row){kind_of(f), f->text, f->group};
    }
}

static void use_folder(struct scene_list *s, const char *folder)
{
    scene_files_free(&s->files);
    scene_files_list(&s->files, folder);
    s->rows = xrealloc(s->rows, (size_t)s->files.count * sizeof *s->rows);
    s->found = xrealloc(s->found, (size_t)s->files.count * sizeof *s->found);
    s->list.search[0] = '\0';
    s->list.selected = s->list.top = 0;
    s->picture_of = -1;
}

/* ---- the picture ---- */

/* Reads the picture of the selected file, unless that is done. */
static bool has_picture(struct scene_list *s)
{
    int i = s->list.selected < s->count ? s->found[s->list.selected] : -1;

    if (i < 0)
        return false;
    if (i != s->picture_of) {
        frame_free(&s->picture);
        scene_picture_read(s->files.files[i].path, &s->picture);
        s->picture_of = i;
    }
    return s->picture.rgb != NULL;
}

/* ---- window ---- */

static void draw(struct scene_list *s, struct screen *screen)
{
    find(s);
    list_window_draw(&s->list, screen, s->rows, s->count, s->files.count);
    list_window_picture(&s->list, screen, has_picture(s) ? &s->picture : NULL);
}

void scene_list_open(struct scene_list *s, struct screen *screen)
{
    if (s->files.files == NULL)
        use_folder(s, NULL);
    s->list.does = "opens";
    s->list.has_pane = true;
    find(s);
    list_window_open(&s->list, screen, " open a scene ", s->rows, s->count);
    draw(s, screen);
}

char *scene_list_take(struct scene_list *s, struct screen *screen,
                      const struct event *event)
{
    enum list_result result =
        list_window_take(&s->list, event, s->rows, s->count);
    const struct scene_file *f;
    char *path;

    if (result == LIST_STAYS)
        draw(s, screen);
    if (result != LIST_CHOSEN)
        return NULL;
    f = &s->files.files[s->found[s->list.selected]];
    path = xstrdup(f->path);
    if (!f->is_folder)
        return path;
    screen_close_window(screen);
    use_folder(s, path);
    free(path);
    scene_list_open(s, screen);
    return NULL;
}

void scene_list_free(struct scene_list *s)
{
    scene_files_free(&s->files);
    frame_free(&s->picture);
    free(s->rows);
    free(s->found);
    *s = (struct scene_list){.count = 0};
}
