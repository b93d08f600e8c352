// SPDX-License-Identifier: MIT
#include "studio/selection.h"

#include <stdlib.h>
#include <string.h>

#include "read/mtl.h"
#include "terminal/xmalloc.h"

static void find_first_tris(struct selection *s)
{
    const struct scene *scene = s->scene;

    free(s->first_tris);
    s->first_tris = xcalloc(scene->object_count + 1, sizeof *s->first_tris);
    for (uint32_t i = 0; i < scene->object_count; i++)
        s->first_tris[i] = NO_INDEX;
    for (uint32_t i = scene->placed_count; i-- > 0;)
        s->first_tris[scene->placed_objects[i]] = scene->placed[i].mesh_tri;
    for (uint32_t i = scene->placed_count > 0 ? scene->placed[0].first_tri
                                              : scene->tri_count;
         i-- > 0;)
        s->first_tris[scene->tri_objects[i]] = i;
}

void selection_init(struct selection *s, struct edit *edit,
                    const struct scene *scene, const struct host_world *world)
{
    *s = (struct selection){.edit = edit, .scene = scene, .world = world};
    find_first_tris(s);
    selection_settle(s);
}

void selection_free(struct selection *s)
{
    free(s->first_tris);
    free(s->listed);
}

/* ---- list ---- */

static bool is_listed(const struct selection *s, uint32_t i)
{
    if (s->page == PAGE_MATERIALS)
        return i > 0 && s->edit->now.is_there[i];
    return s->first_tris[i] != NO_INDEX;
}

void selection_settle(struct selection *s)
{
    const uint32_t counts[] = {
        [PAGE_MATERIALS] = s->edit->material_count,
        [PAGE_OBJECTS] = s->edit->object_count,
        [PAGE_LIGHT] = 0,
    };
    uint32_t count = counts[s->page];

    s->listed = xrealloc(s->listed, (count + 1) * sizeof *s->listed);
    s->listed_count = s->row = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_listed(s, i))
            continue;
        if (i <= s->index[s->page])
            s->row = s->listed_count;
        s->listed[s->listed_count++] = i;
    }
    selection_move(s, 0);
}

bool selection_has_one(const struct selection *s)
{
    return s->page == PAGE_LIGHT || s->listed_count > 0;
}

void selection_move(struct selection *s, int steps)
{
    int row = s->row + steps;

    if (s->listed_count == 0)
        return;
    row = row >= s->listed_count ? s->listed_count - 1 : row;
    s->row = row < 0 ? 0 : row;
    s->index[s->page] = s->listed[s->row];
}

/* ---- names ---- */

struct selection_names selection_names(const struct selection *s)
{
    const struct scene *scene = s->scene;
    const struct edit *e = s->edit;
    uint32_t material = s->index[PAGE_MATERIALS];
    uint32_t object = s->index[PAGE_OBJECTS];

    return (struct selection_names){
        xstrdup(material < e->material_count ? e->names[material] : ""),
        xstrdup(object < scene->object_count ? scene->object_names[object]
                                             : "")};
}

bool selection_renew(struct selection *s, const struct selection_names *names)
{
    const struct scene *scene = s->scene;
    uint32_t found[] = {
        [PAGE_MATERIALS] = mtl_find(scene, names->material),
        [PAGE_OBJECTS] = scene_find_object(scene, names->object),
        [PAGE_LIGHT] = 0,
    };

    for (int page = 0; page <= PAGE_LIGHT; page++)
        s->index[page] = found[page] != NO_INDEX ? found[page] : 0;
    find_first_tris(s);
    selection_settle(s);
    return found[s->page] != NO_INDEX;
}

const char *selection_name(const struct selection *s, enum selection_page page,
                           uint32_t i)
{
    const char *name =
        page == PAGE_OBJECTS ? s->scene->object_names[i] : s->edit->names[i];

    return *name != '\0' ? name : "(no name)";
}

uint32_t selection_material_of(const struct selection *s, uint32_t object)
{
    const struct scene *scene = s->scene;
    uint32_t assigned = edit_shown(s->edit)->assigned[object];
    uint32_t tri = s->first_tris[object];

    if (assigned != NO_INDEX)
        return assigned;
    return scene->tris[tri].material;
}

uint32_t selection_material(const struct selection *s)
{
    return s->page == PAGE_OBJECTS
               ? selection_material_of(s, s->index[PAGE_OBJECTS])
               : s->index[PAGE_MATERIALS];
}
