// SPDX-License-Identifier: MIT
/*
 * MTL files are read, edited as in the panel, saved, and read again. Then each
 * material is the one that the panel showed. The first byte is the number of
 * edits, three bytes are an edit, and the rest is the file.
 */
#include "base/lexer.h"
#include "fuzz.h"
#include "mutate_text.h"
#include "read/mtl.h"
#include "scene/material.h"
#include "session/session_save.h"
#include "studio/parameter.h"

#define EDITS_MAX 16

static void load(struct session *s, const struct options *options)
{
    struct error err = {""};

    require(session_load(s, options, 0, &err), err.text);
}

/* Values that only a map uses count only beside the map. */
static struct material material_of(const struct session *s, uint32_t i)
{
    struct warnings report = {0};
    struct material m =
        material_from_source(&s->edit.now.sources[i], "", &report);

    warnings_free(&report);
    if (m.bump_texture == NO_INDEX)
        m.bump_scale = 0;
    if (m.metal_texture == NO_INDEX)
        m.metalness = 0;
    return m;
}

static void check_maps(const struct session *a, const struct material *m,
                       const struct session *b, const struct material *n)
{
    uint32_t of_a[MATERIAL_MAPS], of_b[MATERIAL_MAPS];

    material_maps(m, of_a);
    material_maps(n, of_b);
    for (int i = 0; i < MATERIAL_MAPS; i++) {
        uint32_t p = of_a[i], q = of_b[i];

        require((p == NO_INDEX) == (q == NO_INDEX), "a map");
        if (p == NO_INDEX)
            continue;
        require(strcmp(a->engine.scene.texture_paths[p],
                       b->engine.scene.texture_paths[q]) == 0,
                a->engine.scene.texture_paths[p]);
        require(memcmp(&a->engine.scene.textures[p].scale,
                       &b->engine.scene.textures[q].scale,
                       sizeof(struct texture) -
                           offsetof(struct texture, scale)) == 0,
                a->engine.scene.texture_paths[p]);
    }
}

/* Compares colours, numbers, images and look-ups. */
static void check_material(const struct session *a, const struct material *m,
                           const struct session *b, const struct material *n,
                           const char *name)
{
    struct material x = *m, y = *n;

    check_maps(a, m, b, n);
    for (uint32_t i = 0; i < MATERIAL_MAPS; i++)
        *material_map(&x, i) = *material_map(&y, i) = 0;
    require(memcmp(&x, &y, sizeof x) == 0, name);
}

static void edit(struct session *s, const uint8_t *bytes)
{
    struct edit *e = &s->edit;
    uint32_t material = bytes[0] % e->material_count;
    struct selection target = {.edit = e,
                               .scene = &s->engine.scene,
                               .page = PAGE_MATERIALS,
                               .index = {material}};
    struct parameter list[PARAMETERS_MAX];
    int count;

    edit_end_step(e);
    if (bytes[1] == 255)
        edit_undo(e);
    else if (bytes[1] == 254)
        edit_duplicate(e, material);
    if (bytes[1] >= 254 || material == 0 || !e->now.is_there[material])
        return;
    count = parameters_list(&target, list);
    parameter_step(&target, list[bytes[1] % count].id, bytes[2] - 128);
}

static void save(struct session *s)
{
    struct error err = {""};
    struct file_watch watch;
    char *what;

    file_watch_init(&watch);
    require(session_save_edit(s, &watch, &what, &err), err.text);
    free(what);
    file_watch_free(&watch);
}

/* Reads the file again, which has exactly the same materials. */
static void check_saved(const struct session *s, const struct options *options)
{
    struct session back;
    uint32_t there = 0;

    load(&back, options);
    for (uint32_t i = 0; i < s->edit.material_count; i++) {
        const char *name = s->edit.names[i];
        uint32_t other = mtl_find(&back.engine.scene, name);
        struct material m, n;

        if (!s->edit.now.is_there[i])
            continue;
        there++;
        require(other != NO_INDEX, name);
        m = material_of(s, i);
        n = material_of(&back, other);
        check_material(s, &m, &back, &n, name);
    }
    require(there == back.engine.scene.material_count, "as many materials");
    session_close(&back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char obj[] = "mtllib a.mtl\n";
    size_t edits = size > 0 ? data[0] % (EDITS_MAX + 1) : 0;
    size_t begin = 1 + 3 * edits;
    struct options options;
    struct session s;
    struct error err = {""};
    char *path, *mtl, *image;

    /* text in UTF-16 is refused, so that there is no file to save to */
    if (size < begin ||
        lexer_is_utf16((const char *)data + begin, size - begin))
        return 0;
    path = fuzz_put("a.obj", obj, strlen(obj));
    mtl = fuzz_put("a.mtl", data + begin, size - begin);
    image = fuzz_put("a.png", "", 0);
    options_init(&options);
    options.scene_path = path;
    options.thread_count = 1;
    if (session_load(&s, &options, 0, &err)) {
        for (size_t i = 0; i < edits; i++)
            edit(&s, data + 1 + 3 * i);
        save(&s);
        check_saved(&s, &options);
    }
    session_close(&s);
    free(path);
    free(mtl);
    free(image);
    return 0;
}
