// SPDX-License-Identifier: MIT
#include "studio/selection.h"

#include <stdlib.h>
#include <string.h>

#include "formats/mtl.h"
#include "terminal/xmalloc.h"

void selection_init(struct selection *s, struct session *session)
{
    const struct scene *scene = &session->scene;

    *s = (struct selection){.session = session};
    s->first_tris = xcalloc(scene->object_count + 1, sizeof *s->first_tris);
    for (uint32_t i = 0; i < scene->object_count; i++)
        s->first_tris[i] = NO_INDEX;
    for (uint32_t i = scene->tri_count; i-- > 0;)
        s->first_tris[scene->tri_objects[i]] = i;
}

void selection_free(struct selection *s)
{
    free(s->first_tris);
}

uint32_t selection_count(const struct selection *s)
{
    switch (s->page) {
    case PARAMETER_MATERIAL: return s->session->edit.material_count;
    case PARAMETER_OBJECT: return s->session->edit.object_count;
    case PARAMETER_LIGHT: break;
    }
    return 0;
}

bool selection_is_listed(const struct selection *s, uint32_t i)
{
    if (s->page == PARAMETER_MATERIAL)
        return i > 0 && s->session->edit.now.is_there[i];
    return s->first_tris[i] != NO_INDEX;
}

uint32_t selection_index(const struct selection *s)
{
    return s->page == PARAMETER_OBJECT ? s->object : s->material;
}

void selection_set(struct selection *s, uint32_t i)
{
    if (s->page == PARAMETER_OBJECT)
        s->object = i;
    else
        s->material = i;
}

/* The next one in the list, or the same at its end. */
static uint32_t next_in_list(const struct selection *s, uint32_t from, int step)
{
    uint32_t count = selection_count(s);

    for (int64_t i = (int64_t)from + step; i >= 0 && i < count; i += step)
        if (selection_is_listed(s, (uint32_t)i))
            return (uint32_t)i;
    return from;
}

void selection_move(struct selection *s, int steps)
{
    for (int i = abs(steps); i > 0; i--)
        selection_set(s,
                      next_in_list(s, selection_index(s), steps > 0 ? 1 : -1));
}

static bool is_in_list(const struct selection *s)
{
    return selection_index(s) < selection_count(s) &&
           selection_is_listed(s, selection_index(s));
}

bool selection_has_one(const struct selection *s)
{
    return s->page == PARAMETER_LIGHT || is_in_list(s);
}

void selection_settle(struct selection *s)
{
    if (selection_count(s) == 0 || is_in_list(s))
        return;
    selection_move(s, -1);
    if (!is_in_list(s))
        selection_set(s, next_in_list(s, 0, 1));
}

struct selection_names selection_names(const struct selection *s)
{
    const struct scene *scene = &s->session->scene;

    return (struct selection_names){
        xstrdup(s->material < s->session->edit.material_count
                    ? s->session->edit.names[s->material]
                    : ""),
        xstrdup(s->object < scene->object_count ? scene->object_names[s->object]
                                                : "")};
}

bool selection_find(struct selection *s, const struct selection_names *names)
{
    const struct scene *scene = &s->session->scene;
    uint32_t material = mtl_find(scene, names->material);
    uint32_t object = 0;

    while (object < scene->object_count &&
           strcmp(scene->object_names[object], names->object) != 0)
        object++;
    if (material != NO_INDEX)
        s->material = material;
    if (object < scene->object_count)
        s->object = object;
    return s->page == PARAMETER_MATERIAL ? material != NO_INDEX
           : s->page == PARAMETER_OBJECT ? object < scene->object_count
                                         : true;
}

struct parameter_target selection_target(const struct selection *s)
{
    return (struct parameter_target){s->page, selection_index(s), s->by_hsv};
}

int selection_knobs(const struct selection *s,
                    struct parameter knobs[PARAMETERS_MAX])
{
    struct parameter_target target = selection_target(s);

    if (!selection_has_one(s))
        return 0;
    return parameters_list(&s->session->edit, &s->session->scene, &target,
                           knobs);
}

uint32_t selection_material_of(const struct selection *s, uint32_t object)
{
    const struct scene *scene = &s->session->scene;
    uint32_t assigned = edit_shown(&s->session->edit)->assigned[object];
    uint32_t tri = s->first_tris[object];

    if (assigned != NO_INDEX)
        return assigned;
    return scene->file_materials != NULL ? scene->file_materials[tri]
                                         : scene->tris[tri].material;
}
