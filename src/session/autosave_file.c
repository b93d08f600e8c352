// SPDX-License-Identifier: MIT
#include "session/autosave_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/stop.h"
#include "base/xdg.h"
#include "engine/engine_film.h"
#include "film/film_file.h"

/* ---- files ---- */

/* Size limit of a head: the path of a scene and a few numbers. */
#define HEAD_BYTES_MAX 16384

static const char magic[] = "glim session 1\n";
static const char scene_key[] = "scene ";

/* Numbers of the head, in their order. */
enum field {
    FIELD_LIVE,
    FIELD_EDITS,
    FIELD_RENDER_NS,
    FIELD_PARTS, /* the sizes of the parts, in the order of enum autosave_part
                  */
    FIELD_TEXTS =
        FIELD_PARTS + AUTOSAVE_PARTS, /* hash of all parts but the film */
    FIELD_HEAD,                       /* hash of the lines before */
    FIELDS
};

static const char *const keys[FIELDS] = {
    "live", "edits",   "render_ns", "view",  "materials",
    "mtl",  "history", "film",      "texts", "head",
};

static uint64_t hash_of(const char *bytes, size_t size_bytes)
{
    return hash_bytes(HASH_BEGIN, bytes, size_bytes);
}

/* ---- write ---- */

/* Returns the bytes of all parts, after `room` bytes that are not set. */
static char *join(const struct autosave_file *k, size_t room,
                  size_t *size_bytes)
{
    char *bytes;

    *size_bytes = room;
    for (int i = 0; i < AUTOSAVE_PARTS; i++)
        *size_bytes += k->sizes[i];
    bytes = malloc(*size_bytes + 1);
    if (bytes == NULL)
        return NULL;
    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        if (k->sizes[i] > 0)
            memcpy(bytes + room, k->parts[i], k->sizes[i]);
        room += k->sizes[i];
    }
    return bytes;
}

/* Returns the lines of the head, for free(). */
static char *head_of(const struct autosave_file *k)
{
    uint64_t values[FIELDS] = {k->is_live, k->has_edits, k->render_ns};
    char *text = format_text("%s%s%s\n", magic, scene_key, k->scene);

    values[FIELD_TEXTS] = HASH_BEGIN;
    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        values[FIELD_PARTS + i] = k->sizes[i];
        if (i != AUTOSAVE_FILM && k->sizes[i] > 0)
            values[FIELD_TEXTS] =
                hash_bytes(values[FIELD_TEXTS], k->parts[i], k->sizes[i]);
    }
    for (int i = 0; i < FIELDS && text != NULL; i++) {
        char *before = text;

        if (i == FIELD_HEAD)
            values[i] = hash_of(text, strlen(text));
        text = format_text("%s%s %" PRIu64 "\n", before, keys[i], values[i]);
        free(before);
    }
    return text;
}

char *autosave_file_bytes(const struct autosave_file *k, size_t *size_bytes)
{
    char *head = head_of(k), *bytes;

    if (head == NULL)
        return NULL;
    bytes = join(k, strlen(head), size_bytes);
    if (bytes != NULL)
        memcpy(bytes, head, strlen(head));
    free(head);
    return bytes;
}

/* ---- read ---- */

struct reader {
    const char *path, *p;
    int line;
};

static bool fail_line(const struct reader *r, const char *expected,
                      struct error *err)
{
    return fail(err, "%s:%d: found another text, expected %s", r->path, r->line,
                expected);
}

static bool fail_memory(const struct reader *r, struct autosave_file *k,
                        struct error *err)
{
    k->is_damaged = false;
    return fail(err, "%s: out of memory", r->path);
}

/* Reads the line `KEY NUMBER`. A NUL is after the text. */
static bool read_number(struct reader *r, const char *key, uint64_t *value,
                        struct error *err)
{
    size_t length = strlen(key);
    const char *p;

    r->line++;
    if (strncmp(r->p, key, length) != 0 || r->p[length] != ' ' ||
        r->p[length + 1] < '0' || r->p[length + 1] > '9')
        return fail_line(r, key, err);
    p = r->p + length + 1;
    if (!digits_parse(&p, 10, UINT64_MAX, value) || *p != '\n')
        return fail_line(r, "a whole number", err);
    r->p = p + 1;
    return true;
}

static bool read_scene(struct reader *r, struct autosave_file *k,
                       struct error *err)
{
    size_t key = sizeof scene_key - 1, length;

    r->line++;
    length = strcspn(r->p, "\n");
    if (strncmp(r->p, scene_key, key) != 0 || r->p[key] != '/' ||
        r->p[length] == '\0')
        return fail_line(r, "the path of a scene", err);
    k->scene = format_text("%.*s", (int)(length - key), r->p + key);
    r->p += length + 1;
    return k->scene != NULL || fail_memory(r, k, err);
}

/* Reads the head. The sizes of the parts must make up the rest of the file,
 * which has size_bytes. */
static bool read_head(struct reader *r, struct autosave_file *k,
                      size_t size_bytes, uint64_t *texts, struct error *err)
{
    const char *begin = r->p;
    uint64_t values[FIELDS], expected = 0, rest;

    if (strncmp(r->p, magic, sizeof magic - 1) != 0)
        return fail(err, "%s: found another kind of file, expected a session",
                    r->path);
    r->p += sizeof magic - 1;
    r->line = 1;
    if (!read_scene(r, k, err))
        return false;
    for (int i = 0; i < FIELDS; i++) {
        expected = hash_of(begin, (size_t)(r->p - begin));
        if (!read_number(r, keys[i], &values[i], err))
            return false;
    }
    if (values[FIELD_HEAD] != expected)
        return fail(err, "%s: found damaged lines, expected a session",
                    r->path);
    k->is_live = values[FIELD_LIVE] != 0;
    k->has_edits = values[FIELD_EDITS] != 0;
    k->render_ns = values[FIELD_RENDER_NS];
    *texts = values[FIELD_TEXTS];
    rest = size_bytes - (size_t)(r->p - begin);
    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        uint64_t size = values[FIELD_PARTS + i];

        if (size > rest)
            return fail(err, "%s: found the end of the file, expected more",
                        r->path);
        k->sizes[i] = (size_t)size;
        rest -= size;
    }
    return rest == 0 ||
           fail(err, "%s: found more bytes, expected the end", r->path);
}

/* Copies the parts, and checks them. */
static bool take_parts(struct autosave_file *k, const struct reader *r,
                       uint64_t texts, struct error *err)
{
    const char *p = r->p;
    uint64_t found = HASH_BEGIN;

    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        k->parts[i] = malloc(k->sizes[i] + 1);
        if (k->parts[i] == NULL)
            return fail_memory(r, k, err);
        memcpy(k->parts[i], p, k->sizes[i]);
        k->parts[i][k->sizes[i]] = '\0';
        if (i != AUTOSAVE_FILM)
            found = hash_bytes(found, p, k->sizes[i]);
        p += k->sizes[i];
    }
    return found == texts ||
           fail(err, "%s: found damaged bytes, expected a session", r->path);
}

static bool parse(struct autosave_file *k, const char *path, const char *bytes,
                  size_t size_bytes, bool has_parts, struct error *err)
{
    struct reader r = {.path = path, .p = bytes};
    uint64_t texts = 0;

    *k = (struct autosave_file){.is_damaged = true};
    if (!read_head(&r, k, size_bytes, &texts, err) ||
        (has_parts && !take_parts(k, &r, texts, err)))
        return false;
    k->is_damaged = false;
    return true;
}

bool autosave_file_parse(struct autosave_file *k, const char *path,
                         const char *bytes, size_t size_bytes,
                         struct error *err)
{
    return parse(k, path, bytes, size_bytes, true, err);
}

bool autosave_file_read(struct autosave_file *k, const char *path,
                        struct error *err)
{
    char *bytes;
    size_t size;
    bool ok;

    *k = (struct autosave_file){.scene = NULL};
    if (!file_read(path, &bytes, &size, err))
        return false;
    ok = autosave_file_parse(k, path, bytes, size, err);
    free(bytes);
    return ok;
}

bool autosave_file_read_head(struct autosave_file *k, const char *path,
                             struct error *err)
{
    char bytes[HEAD_BYTES_MAX + 1];
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat file;
    ssize_t count = -1;

    *k = (struct autosave_file){.scene = NULL};
    /* the size is that of this version: the name may get another one */
    if (fd >= 0 && fstat(fd, &file) == 0)
        count = read(fd, bytes, HEAD_BYTES_MAX);
    if (count < 0)
        fail(err, "%s: %s", path, strerror(errno));
    if (fd >= 0)
        close(fd);
    if (count < 0)
        return false;
    bytes[count] = '\0';
    if ((off_t)count > file.st_size)
        return fail(err, "%s: found a file that changes", path);
    return parse(k, path, bytes, (size_t)file.st_size, false, err);
}

void autosave_file_free(struct autosave_file *k)
{
    free(k->scene);
    for (int i = 0; i < AUTOSAVE_PARTS; i++)
        free(k->parts[i]);
    *k = (struct autosave_file){.scene = NULL};
}

/* ---- the folder ---- */

#define S_NS  UINT64_C(1000000000)
#define DAY_S 86400

static const char ending[] = ".session";
static const char picture_ending[] = ".png";

/* ---- paths ---- */

/* Returns the path of the folder with a slash, for free(), or NULL. */
static char *folder_path(void)
{
    char *path = xdg_state_path("sessions");
    char *folder = NULL;

    if (path != NULL && folder_make(path))
        folder = format_text("%s/", path);
    free(path);
    return folder;
}

char *autosave_scene(const char *scene_path)
{
    char *scene = realpath(scene_path, NULL);

    if (scene != NULL && strchr(scene, '\n') != NULL) {
        free(scene);
        scene = NULL;
    }
    return scene;
}

/* Returns the path of the file of a scene with this ending. */
static char *path_of(const char *scene, const char *end)
{
    char *folder = folder_path();
    char *path = NULL;

    if (folder != NULL)
        path = format_text("%s%016" PRIx64 "%s", folder,
                           hash_bytes(HASH_BEGIN, scene, strlen(scene)), end);
    free(folder);
    return path;
}

char *autosave_path(const char *scene)
{
    return path_of(scene, ending);
}

char *autosave_path_picture(const char *scene)
{
    return path_of(scene, picture_ending);
}

char *autosave_path_aside(const char *path)
{
    return format_text("%.*s-before%s", (int)(strlen(path) - strlen(ending)),
                       path, ending);
}

/* One file has the locks of all scenes: each locks the byte at the hash of its
 * path, far behind the end of the file, which is empty. */
int autosave_lock(const char *path)
{
    uint64_t hash = hash_bytes(HASH_BEGIN, path, strlen(path));
    struct flock lock = {.l_type = F_WRLCK,
                         .l_whence = SEEK_SET,
                         .l_start = (off_t)(hash >> 2),
                         .l_len = 1};
    char *name = path_beside(path, "lock");
    int fd = name != NULL ? open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;

    free(name);
    if (fd >= 0 && fcntl(fd, F_SETLK, &lock) == 0)
        return fd;
    if (fd >= 0)
        close(fd);
    return -1;
}

/* ---- list ---- */

struct entry {
    char *path;
    struct file_identity file;
};

struct list {
    struct entry *entries;
    size_t count;
};

static int compare_age(const void *a, const void *b)
{
    const struct timespec *s = &((const struct entry *)a)->file.modified;
    const struct timespec *t = &((const struct entry *)b)->file.modified;

    if (s->tv_sec != t->tv_sec)
        return s->tv_sec > t->tv_sec ? -1 : 1;
    return s->tv_nsec > t->tv_nsec ? -1 : s->tv_nsec < t->tv_nsec;
}

/* Returns true if a name is a hash with this ending. */
static bool has_hash(const char *name, const char *end)
{
    return strlen(name) == 16 + strlen(end) && strcmp(name + 16, end) == 0;
}

static void add(struct list *list, size_t *capacity, const char *path)
{
    void *entries = list->entries;

    if (path == NULL ||
        !grow_array(&entries, capacity, list->count + 1, sizeof(struct entry)))
        return;
    list->entries = entries;
    list->entries[list->count].path = strdup(path);
    list->entries[list->count].file = file_identify(path);
    if (list->entries[list->count].path != NULL)
        list->count++;
}

/* Lists the files with an ending in the folder of `beside`, the last one first.
 * A file for which memory is out is left out. */
static struct list read_list(const char *beside, const char *end)
{
    struct list list = {.count = 0};
    size_t capacity = 0;
    char *folder = path_beside(beside, ".");
    DIR *directory = folder != NULL ? opendir(folder) : NULL;
    const struct dirent *file;

    while (directory != NULL && (file = readdir(directory)) != NULL) {
        char *path = has_hash(file->d_name, end)
                         ? path_beside(beside, file->d_name)
                         : NULL;

        add(&list, &capacity, path);
        free(path);
    }
    if (directory != NULL)
        closedir(directory);
    free(folder);
    if (list.count > 0)
        qsort(list.entries, list.count, sizeof *list.entries, compare_age);
    return list;
}

static void free_list(struct list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->entries[i].path);
    free(list->entries);
}

static int prune(const char *path, const char *end, int days_max,
                 uint64_t bytes_max)
{
    struct list list = read_list(path, end);
    time_t oldest = time(NULL) - (time_t)days_max * DAY_S;
    uint64_t bytes = 0;
    int count = 0;

    for (size_t i = 0; i < list.count; i++) {
        const struct file_identity *file = &list.entries[i].file;

        bytes += (uint64_t)file->size_bytes;
        if (bytes > bytes_max || file->modified.tv_sec < oldest)
            count += unlink(list.entries[i].path) == 0;
    }
    free_list(&list);
    return count;
}

int autosave_prune(const char *path, int days_max, uint64_t bytes_max)
{
    prune(path, picture_ending, days_max, bytes_max);
    return prune(path, ending, days_max, bytes_max);
}

/* ---- texts ---- */

/* Writes a time with its two largest units. */
static void print_time(char text[AUTOSAVE_TEXT_BYTES], uint64_t s)
{
    if (s < 60)
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%" PRIu64 " s", s);
    else if (s < 3600)
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%" PRIu64 " min %" PRIu64 " s",
                 s / 60, s % 60);
    else if (s < DAY_S)
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%" PRIu64 " h %" PRIu64 " min",
                 s / 3600, s / 60 % 60);
    else
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%" PRIu64 " d %" PRIu64 " h",
                 s / DAY_S, s / 3600 % 24);
}

void autosave_describe(char text[AUTOSAVE_TEXT_BYTES],
                       const struct autosave_file *k)
{
    char duration[AUTOSAVE_TEXT_BYTES];

    print_time(duration, k->render_ns / S_NS);
    if (k->sizes[AUTOSAVE_FILM] == 0)
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%s",
                 k->has_edits ? "unsaved changes" : "a view");
    else
        snprintf(text, AUTOSAVE_TEXT_BYTES, "%.40s of render%s", duration,
                 k->has_edits ? " and unsaved changes" : "");
}

static void print_entry(FILE *to, const struct entry *entry)
{
    char age[AUTOSAVE_TEXT_BYTES], what[AUTOSAVE_TEXT_BYTES];
    time_t now = time(NULL), then = entry->file.modified.tv_sec;
    struct autosave_file k;
    struct error err;

    print_time(age, now > then ? (uint64_t)(now - then) : 0);
    if (autosave_file_read_head(&k, entry->path, &err)) {
        autosave_describe(what, &k);
        print_line(to, "%s: %s, %s ago, %.1f MB", k.scene, what, age,
                   (double)entry->file.size_bytes / 1e6);
    } else {
        print_line(to, "%s", err.text);
    }
    autosave_file_free(&k);
}

bool autosave_print_list(FILE *to, struct error *err)
{
    char *folder = folder_path();
    int removed;
    struct list list;

    if (folder == NULL)
        return fail(err, "found no folder for kept sessions, expected one in "
                         "XDG_STATE_HOME or HOME");
    removed = autosave_prune(folder, AUTOSAVE_DAYS_MAX, AUTOSAVE_BYTES_MAX);
    list = read_list(folder, ending);
    for (size_t i = 0; i < list.count; i++)
        print_entry(to, &list.entries[i]);
    if (list.count == 0)
        print_line(to, "no kept sessions");
    if (removed > 0)
        print_line(to, "removed %d old session%s", removed,
                   print_plural((uint64_t)removed));
    free_list(&list);
    free(folder);
    return true;
}

/* ---- the writer ---- */

bool autosave_writer_init(struct autosave_writer *w, struct error *err)
{
    *w = (struct autosave_writer){.path = NULL};
    return background_init(&w->copying, "sessions", err);
}

/* A film that nobody adds to any more. */
struct copy {
    struct film film;
    uint16_t *shares; /* of adaptive sampling; NULL: not decided */
};

static bool copy_film(struct autosave_writer *w, struct copy *c)
{
    const uint16_t *shares;
    size_t size;

    if (!film_copy(&c->film, render_film(w->render), &w->error) ||
        !engine_film_hash(&w->world, w->kernels_path, &w->header.identity,
                          &w->error))
        return false;
    /* after the copy, whose samples may depend on them */
    shares = render_shares(w->render);
    if (shares == NULL)
        return true;
    size = (size_t)c->film.width * (size_t)c->film.height * sizeof *shares;
    c->shares = malloc(size);
    if (c->shares == NULL)
        return fail(&w->error, "%s: out of memory", w->path);
    memcpy(c->shares, shares, size);
    return true;
}

static const uint16_t *shares_of(void *context)
{
    return ((const struct copy *)context)->shares;
}

/* Packs the film, unless it is too large. */
static bool pack_film(struct autosave_writer *w, struct copy *c)
{
    size_t size;
    char *bytes =
        film_file_bytes(&w->header, &c->film, shares_of, c, &size, &w->error);

    if (bytes == NULL)
        return false;
    w->is_film_left_out = size > AUTOSAVE_FILM_BYTES_MAX;
    if (w->is_film_left_out) {
        free(bytes);
        return true;
    }
    w->kept.parts[AUTOSAVE_FILM] = bytes;
    w->kept.sizes[AUTOSAVE_FILM] = size;
    w->kept.render_ns = w->header.render_ns;
    return true;
}

/* Writes the file, and makes its folder again if that was removed. */
static bool write_file(struct autosave_writer *w)
{
    size_t size;
    char *bytes = autosave_file_bytes(&w->kept, &size);
    bool ok;

    free(folder_path());
    ok = bytes != NULL
             ? file_write(w->path, bytes, size, false, NULL, &w->error)
             : fail(&w->error, "%s: out of memory", w->path);

    free(bytes);
    return ok;
}

/* Without the film, for which memory may be out, the rest is written. */
static void work(void *context)
{
    struct autosave_writer *w = context;
    struct copy copy = {.shares = NULL};
    bool ok;

    stop_hold();
    ok = !w->has_film || copy_film(w, &copy);
    background_has_copied(&w->copying);
    if (ok && w->has_film)
        ok = pack_film(w, &copy);
    film_free(&copy.film);
    free(copy.shares);
    w->is_written = write_file(w) && ok;
    autosave_prune(w->path, AUTOSAVE_DAYS_MAX, AUTOSAVE_BYTES_MAX);
    stop_release();
}

bool autosave_writer_begin(struct autosave_writer *w, struct session *s,
                           struct autosave_file *k, const char *path,
                           bool has_film, struct error *err)
{
    struct engine *e = &s->engine;
    struct view view = edit_view(&s->edit);
    const struct film *film = render_film(e->render);
    uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;

    w->kept = *k;
    *k = (struct autosave_file){.scene = NULL}; /* the writer owns it now */
    w->path = path;
    w->render = e->render;
    w->kernels_path = s->options->kernels_path;
    w->is_film_left_out =
        has_film && pixels * FILM_PIXEL_BYTES > AUTOSAVE_COPY_BYTES_MAX;
    w->has_film = has_film && !w->is_film_left_out;
    w->header =
        engine_film_header(e, &view, 0, render_progress(e->render).spp_limit,
                           &w->range);
    if ((!w->has_film ||
         engine_film_describe(e, &view, &w->header.identity, &w->world, err)) &&
        background_begin(&w->copying, work, w, path, err))
        return true;
    autosave_file_free(&w->kept);
    return false;
}

bool autosave_writer_finish(struct autosave_writer *w, bool *is_film_left_out,
                            struct error *err)
{
    background_finish(&w->copying);
    autosave_file_free(&w->kept);
    *is_film_left_out = w->is_film_left_out;
    if (!w->is_written)
        *err = w->error;
    return w->is_written;
}

void autosave_writer_free(struct autosave_writer *w)
{
    struct error ignored;
    bool is_film_left_out;

    if (w->copying.is_busy)
        autosave_writer_finish(w, &is_film_left_out, &ignored);
    background_free(&w->copying);
}
