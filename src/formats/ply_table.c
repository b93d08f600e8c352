// SPDX-License-Identifier: MIT
#include "formats/ply_table.h"

#include <inttypes.h>
#include <string.h>

#include "formats/vertex_colors.h"

static const struct {
    const char *name;
    enum ply_role role;
} role_names[] = {
    {"x", PLY_X},
    {"y", PLY_Y},
    {"z", PLY_Z},
    {"nx", PLY_NX},
    {"ny", PLY_NY},
    {"nz", PLY_NZ},
    {"normal_x", PLY_NX},
    {"normal_y", PLY_NY},
    {"normal_z", PLY_NZ},
    {"red", PLY_RED},
    {"green", PLY_GREEN},
    {"blue", PLY_BLUE},
    {"r", PLY_RED},
    {"g", PLY_GREEN},
    {"b", PLY_BLUE},
    {"diffuse_red", PLY_RED},
    {"diffuse_green", PLY_GREEN},
    {"diffuse_blue", PLY_BLUE},
    {"s", PLY_U},
    {"t", PLY_V},
    {"u", PLY_U},
    {"v", PLY_V},
    {"texture_u", PLY_U},
    {"texture_v", PLY_V},
    {"texture_s", PLY_U},
    {"texture_t", PLY_V},
    {"s0", PLY_U},
    {"t0", PLY_V},
    {"texnumber", PLY_TEXTURE},
};

static void find_list(struct ply_table *t, uint32_t number)
{
    struct word name = t->items[number].name;

    if ((word_is(name, "vertex_indices") || word_is(name, "vertex_index")) &&
        t->lists[PLY_LIST_VERTICES] == NO_INDEX)
        t->lists[PLY_LIST_VERTICES] = number;
    else if (word_is(name, "texcoord") && t->lists[PLY_LIST_UVS] == NO_INDEX)
        t->lists[PLY_LIST_UVS] = number;
}

static void find_number(struct ply_table *t, uint32_t number)
{
    struct word name = t->items[number].name;

    for (size_t i = 0; i < sizeof role_names / sizeof role_names[0]; i++)
        if (t->numbers[role_names[i].role] == NO_INDEX &&
            word_is(name, role_names[i].name))
            t->numbers[role_names[i].role] = number;
}

bool ply_table_init(struct ply_table *t, const struct ply_header *header,
                    const struct ply_element *element, const char *path,
                    struct error *err)
{
    *t = (struct ply_table){.element = element,
                            .count = (uint32_t)element->count};
    if (element->property_count > 0)
        t->items = header->properties + element->first_property;
    if (element->count >= NO_INDEX)
        return fail(err,
                    "%s:%" PRIu64 ": found %" PRIu64 " %s, expected fewer "
                    "than 4294967295",
                    path, element->line, element->count,
                    word_cut(element->name).text);
    memset(t->numbers, 0xff, sizeof t->numbers);
    memset(t->lists, 0xff, sizeof t->lists);
    for (uint32_t i = 0; i < element->property_count; i++) {
        if (t->items[i].count_type != PLY_NONE)
            find_list(t, i);
        else
            find_number(t, i);
    }
    return true;
}

bool ply_table_has(const struct ply_table *t, enum ply_role first, int count)
{
    for (int i = 0; i < count; i++)
        if (t->numbers[(int)first + i] == NO_INDEX)
            return false;
    return true;
}

/* Returns the largest number of a colour's property: 1 for fractions. */
static float white_of(const struct ply_table *t)
{
    switch (t->items[t->numbers[PLY_RED]].type) {
    case PLY_INT8: return INT8_MAX;
    case PLY_UINT8: return UINT8_MAX;
    case PLY_INT16: return INT16_MAX;
    case PLY_UINT16: return UINT16_MAX;
    case PLY_INT32: return (float)INT32_MAX;
    case PLY_UINT32: return (float)UINT32_MAX;
    default: return 1.0f;
    }
}

void ply_table_decode(const struct ply_table *t, struct vec3 *colors)
{
    float white = white_of(t);

    vertex_colors_decode(colors, t->count,
                         white > 1.0f ? white
                                      : vertex_colors_white(colors, t->count));
}
