// SPDX-License-Identifier: MIT
#include "studio/view_list.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Size of a picture, whose aspect is that of the render. */
#define PICTURE_WIDTH 88

static const struct view *view_of(const struct view_list *v)
{
    return &v->view_mode->session->edit.now.view;
}

static void describe(char text[64], const struct pose *pose)
{
    snprintf(text, 64, "from %.4g %.4g %.4g, %.3g degrees", pose->eye[0],
             pose->eye[1], pose->eye[2], pose->fovy_deg);
}

/* Finds the views whose number or text has the search, and their rows. */
static void find(struct view_list *v, struct list_row rows[VIEW_SHOTS])
{
    const struct view *view = view_of(v);

    v->count = 0;
    for (int i = 0; i < VIEW_SHOTS; i++) {
        char *text = v->texts[v->count], *key = v->keys[v->count];

        if (!view->has_shot[i])
            continue;
        describe(text, &view->shots[i]);
        snprintf(key, sizeof v->keys[0], "%d", i + 1);
        if (strstr(text, v->list.search) == NULL &&
            strcmp(key, v->list.search) != 0)
            continue;
        rows[v->count] = (struct list_row){key, text, ""};
        v->numbers[v->count++] = i;
    }
}

/* Renders the picture of the selected view, unless that is done. */
static bool has_picture(struct view_list *v)
{
    struct rect r = v->view_mode->session->engine.crop;
    int height = (int)lround((double)PICTURE_WIDTH * r.height / r.width);
    struct error ignored;
    int number;

    if (v->list.selected >= v->count)
        return false;
    number = v->numbers[v->list.selected];
    if (v->picture_of != number + 1) {
        frame_free(&v->picture);
        v->picture_of = number + 1;
        if (frame_init(&v->picture, PICTURE_WIDTH,
                       height < 1                   ? 1
                       : height > 2 * PICTURE_WIDTH ? 2 * PICTURE_WIDTH
                                                    : height,
                       &ignored) &&
            !view_mode_thumbnail(v->view_mode, &view_of(v)->shots[number],
                                 &v->picture, &ignored))
            frame_free(&v->picture);
    }
    return v->picture.rgb != NULL;
}

static void draw(struct view_list *v, struct screen *screen,
                 struct list_row rows[VIEW_SHOTS])
{
    int all = 0;

    for (int i = 0; i < VIEW_SHOTS; i++)
        all += view_of(v)->has_shot[i];
    find(v, rows);
    list_window_draw(&v->list, screen, rows, v->count, all);
    list_window_picture(&v->list, screen, has_picture(v) ? &v->picture : NULL);
}

bool view_list_open(struct view_list *v, struct screen *screen)
{
    struct list_row rows[VIEW_SHOTS];

    find(v, rows);
    if (v->count == 0 && v->list.search[0] == '\0')
        return false;
    v->list.does = "goes there";
    v->list.has_pane = true;
    list_window_open(&v->list, screen, " views ", rows, v->count);
    draw(v, screen, rows);
    return true;
}

enum action view_list_take(struct view_list *v, struct screen *screen,
                           const struct event *event)
{
    struct list_row rows[VIEW_SHOTS];
    enum list_result result;

    find(v, rows);
    result = list_window_take(&v->list, event, rows, v->count);
    if (result == LIST_STAYS)
        draw(v, screen, rows);
    return result == LIST_CHOSEN
               ? (enum action)(ACTION_VIEW_1 + v->numbers[v->list.selected])
               : ACTION_NONE;
}

void view_list_free(struct view_list *v)
{
    frame_free(&v->picture);
    *v = (struct view_list){.count = 0};
}
