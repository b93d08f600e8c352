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
    uint32_t *index = &s->index[s->page];

    for (int i = abs(steps); i > 0; i--)
        *index = next_in_list(s, *index, steps > 0 ? 1 : -1);
}

bool selection_has_one(const struct selection *s)
{
    uint32_t index = s->index[s->page];

    return s->page == PARAMETER_LIGHT ||
           (index < selection_count(s) && selection_is_listed(s, index));
}

void selection_settle(struct selection *s)
{
    if (!selection_has_one(s))
        selection_move(s, -1);
    if (!selection_has_one(s))
        s->index[s->page] = next_in_list(s, 0, 1);
}

struct selection_names selection_names(const struct selection *s)
{
    const struct scene *scene = &s->session->scene;
    const struct edit *e = &s->session->edit;
    uint32_t material = s->index[PARAMETER_MATERIAL];
    uint32_t object = s->index[PARAMETER_OBJECT];

    return (struct selection_names){
        xstrdup(material < e->material_count ? e->names[material] : ""),
        xstrdup(object < scene->object_count ? scene->object_names[object]
                                             : "")};
}

bool selection_find(struct selection *s, const struct selection_names *names)
{
    const struct scene *scene = &s->session->scene;
    uint32_t found[] = {
        [PARAMETER_MATERIAL] = mtl_find(scene, names->material),
        [PARAMETER_OBJECT] = scene_find_object(scene, names->object),
        [PARAMETER_LIGHT] = 0,
    };

    for (int page = 0; page <= PARAMETER_LIGHT; page++)
        if (found[page] != NO_INDEX)
            s->index[page] = found[page];
    return found[s->page] != NO_INDEX;
}

struct parameter_target selection_target(const struct selection *s)
{
    return (struct parameter_target){
        .edit = &s->session->edit,
        .scene = &s->session->scene,
        .page = s->page,
        .index = s->index[s->page],
        .by_hsv = s->by_hsv,
    };
}

const char *selection_name(const struct selection *s, enum parameter_page page,
                           uint32_t i)
{
    const char *name = page == PARAMETER_OBJECT
                           ? s->session->scene.object_names[i]
                           : s->session->edit.names[i];

    return *name != '\0' ? name : "(no name)";
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
