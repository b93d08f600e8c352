// SPDX-License-Identifier: MIT
/*
 * The whole program: a scene is loaded with all of its files, rendered,
 * filtered and saved as a picture and a film, by each build of the kernel. The
 * program ends with a finite picture, or one line.
 *
 * The first byte of an input chooses options. The rest are files between lines
 * "====": a scene of any format, materials, a view, an image and a grid.
 */
#include "base/memory.h"
#include "command/batch_progress.h"
#include "command/command.h"
#include "film/film_file.h"
#include "mutate_exr.h"
#include "mutate_gltf.h"
#include "mutate_vdb.h"
#include "read/child/draco_child.h"
#include "read/child/vdb_read.h"
#include "render/cpu_dispatch.h"
#include "session/command_line.h"
#include "tests/unit/whole_image.h"

/* Files of an input. */
#define PARTS 5

/* ---- files ---- */

static const struct {
    const char *begin, *name;
} formats[] = {
    {"glTF", "scene.glb"},      {"{", "scene.gltf"},
    {"ply", "scene.ply"},       {"solid", "scene.stl"},
    {"\x93NUMPY", "scene.npy"}, {"\x20\x42\x44\x56", "scene.vdb"},
    {"#!stl", "scene.stl"},     {"", "scene.obj"},
};

/* Returns the name of a scene by its first bytes. */
static const char *scene_name(const char *bytes, size_t size)
{
    int i = 0;

    while (strlen(formats[i].begin) > size ||
           memcmp(bytes, formats[i].begin, strlen(formats[i].begin)) != 0)
        i++;
    return formats[i].name;
}

/* Writes the files of an input, and removes those of the one before. Returns
 * the path of the scene for free(). */
static char *put_files(const uint8_t *data, size_t size)
{
    const char *names[PARTS] = {NULL, "scene.mtl", "scene.view",
                                "Maps/image.png", "grid.vdb"};
    const char *p = (const char *)data, *end = p + size;
    char path[512], *scene = NULL;

    snprintf(path, sizeof path, "%s/Maps", fuzz_folder());
    mkdir(path, 0700);
    for (int i = 0; i < PARTS; i++) {
        size_t part_size = 0;
        const char *part = fuzz_part(&p, end, &part_size);
        char *put;

        if (i == 0)
            names[0] = scene_name(part, part_size);
        put = fuzz_put(names[i], part, part_size);
        if (i == 0)
            scene = put;
        else
            free(put);
    }
    return scene;
}

/* ---- the program ---- */

/* What the program has printed. */
struct output {
    FILE *own; /* the standard error of the target */
    char *text;
    size_t size;
};

static void begin_output(struct output *o)
{
    o->own = stderr;
    stderr = open_memstream(&o->text, &o->size);
    require(stderr != NULL, "memory");
}

/* Each line is a valid message, and a failure prints none before its own. */
static void end_output(struct output *o, bool ok)
{
    char *next;

    fclose(stderr);
    stderr = o->own;
    next = o->text;
    require(ok || *next == '\0', next);
    for (char *line; (line = strsep(&next, "\n")) != NULL && next != NULL;)
        fuzz_check_message(line);
    free(o->text);
}

static bool run(const struct options *options, struct error *err)
{
    struct session s = {0};
    struct output output;
    int status = 0;
    bool ok;

    begin_output(&output);
    ok = batch_open(&s, options, 0, err) && batch_run(&s, &status, err);
    session_close(&s);
    end_output(&output, ok);
    require(status == 0, "the exit status");
    return ok;
}

/* ---- what it has written ---- */

static void check_picture(const char *path)
{
    struct image image;
    struct error err = {""};
    uint64_t clamped_count;

    if (strstr(path, ".png") != NULL)
        require(image_read_8bit(&image, path, &err), err.text);
    else
        require(image_read_linear(&image, path, &clamped_count, &err) &&
                    clamped_count == 0,
                err.text);
    image_free(&image);
}

static void check_film(const char *path)
{
    struct film_file f;
    struct error err = {""};

    require(film_file_read(&f, path, &err), err.text);
    require(f.header.non_finite == 0, "finite samples");
    film_file_free(&f);
}

/* ---- an input ---- */

static const char *const pictures[] = {"out.png", "out.exr", "out.pfm",
                                       "out.hdr"};
/* Without light paths and cells, which take a second, mostly. */
static const char *const extras[] = {
    "--gi=exact", "--gi=exact", "--gi=exact", "--gi=exact",
    "--gi=exact", "--gi=cells", "--adaptive", "--aov=albedo,normals,depth"};

static void render(char *scene, unsigned choice)
{
    static const char words[] = "glim SCENE -b -w 8 -h 8 -s 4 -t 1 "
                                "--backend cpu --denoise --isa ISA -o OUT "
                                "--film FILM EXTRA";
    char *picture = fuzz_put(pictures[choice / 4 % 4], NULL, 0);
    char *film = fuzz_put("out.film", NULL, 0), *argv[32];
    char text[sizeof words], isa[16], extra[32];
    struct options options;
    struct error err = {""};
    int argc = 0, isas = 0;

    while (cpu_kernel_at(isas) != NULL)
        isas++;
    snprintf(isa, sizeof isa, "%s",
             cpu_kernel_at((int)(choice % 4) % isas)->name);
    snprintf(extra, sizeof extra, "%s", extras[choice / 16 % 8]);
    memcpy(text, words, sizeof words);
    for (char *p = text, *word; (word = strsep(&p, " ")) != NULL;)
        argv[argc++] = strcmp(word, "SCENE") == 0   ? scene
                       : strcmp(word, "ISA") == 0   ? isa
                       : strcmp(word, "OUT") == 0   ? picture
                       : strcmp(word, "FILM") == 0  ? film
                       : strcmp(word, "EXTRA") == 0 ? extra
                                                    : word;
    argv[argc] = NULL;
    options_init(&options);
    require(options_parse(&options, argc, argv, &err), err.text);
    if (run(&options, &err)) {
        check_picture(picture);
        check_film(film);
    } else {
        fuzz_check_message(err.text);
    }
    free(picture);
    free(film);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *scene;

    if (size == 0)
        return 0;
    memory_init();
    scene = put_files(data + 1, size - 1);
    render(scene, data[0]);
    free(scene);
    return 0;
}

/* ---- copies that read with libraries ---- */

int LLVMFuzzerInitialize(int *argc, char ***argv);

/* A copy of the program is one of the target: it does what main.c does then. */
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    struct options o;
    struct error err;
    bool is_of_library =
        *argc > 1 && (strncmp((*argv)[1], "--unpack", 8) == 0 ||
                      strncmp((*argv)[1], "--voxels", 8) == 0);

    if (!is_of_library)
        return 0;
    memory_init();
    options_init(&o);
    if (!options_parse(&o, *argc, *argv, &err))
        _exit(1);
    _exit((o.is_unpack ? draco_child(o.library_limits, stdout)
                       : vdb_child(o.scene_path, o.library_limits, stdout))
              ? 0
              : 1);
}

/* ---- changes ---- */

/* Changes a file by its kind. */
static void mutate_file(struct mutation *m)
{
    const char *name = scene_name((const char *)m->data, m->size);

    if (strstr(name, ".gl") != NULL)
        mutation_gltf(m);
    else if (strstr(name, ".vdb") != NULL)
        mutation_vdb(m);
    else if (m->size > 8 && memcmp(m->data, exr_magic, 4) == 0)
        mutation_exr(m);
    else if (memchr(m->data, '\0', m->size) != NULL && mutation_pick(m, 3) != 0)
        mutation_fixed(m, m->data, m->size);
    else
        mutation_text(m, 0, m->size);
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed), file;
    const char *p = (const char *)data + 1, *part = p;
    size_t length = 0, count = 0;

    if (size < 2 || mutation_pick(&m, 16) == 0)
        return LLVMFuzzerMutate(data, size, max);
    if (mutation_pick(&m, 8) == 0)
        data[0] = (uint8_t)mutation_pick(&m, 128);
    /* each file is as likely as the others */
    while (p != NULL) {
        size_t part_length;
        const char *next =
            fuzz_part(&p, (const char *)data + size, &part_length);

        if (mutation_pick(&m, ++count) == 0) {
            part = next;
            length = part_length;
        }
    }
    file = mutation_begin(malloc(length + max - size + 1), length,
                          length + max - size, seed);
    require(file.data != NULL, "memory");
    memcpy(file.data, part, length);
    mutate_file(&file);
    mutation_replace(&m, (size_t)((const uint8_t *)part - data), length,
                     file.data, file.size);
    free(file.data);
    return m.size;
}
