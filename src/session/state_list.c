// SPDX-License-Identifier: MIT
#include "session/state_list.h"

#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/print.h"
#include "base/text_stream.h"
#include "base/thread_pool.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

/* ---- lists ---- */

static bool has(const struct state_list *list, const char *key)
{
    for (int i = 0; i < list->count; i++) {
        if (strcmp(list->keys[i], key) == 0)
            return true;
    }
    return false;
}

static void append(struct state_list *list, const struct state_list_file *file,
                   const char *line)
{
    const char *key = file->key(line);
    int i = list->count;

    if (i == file->lines_max || !key || has(list, key))
        return;
    list->lines[i] = xstrdup(line);
    list->keys[i] = list->lines[i] + (key - line);
    list->count++;
}

/* Appends the lines of the file. Returns false if it cannot be read. */
static bool append_file(struct state_list *list,
                        const struct state_list_file *file, const char *path)
{
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;

    if (access(path, F_OK) != 0 && errno == ENOENT)
        return true;
    if (!file_read(path, &text, &size_bytes, &ignored))
        return false;
    for (char *line = text, *next; *line != '\0'; line = next) {
        size_t length = strcspn(line, "\n");

        next = line + length + (line[length] == '\n');
        line[length] = '\0';
        append(list, file, line);
    }
    free(text);
    return true;
}

/* ---- lines that wait ---- */

/* Line that is not in its file yet. */
struct waiting {
    struct waiting *next; /* an older one */
    const struct state_list_file *file;
    char *path;
    char *line;
};

static struct {
    pthread_mutex_t lock;
    pthread_cond_t end;
    /* guarded by lock */
    struct waiting *lines; /* the last one first */
    bool has_thread;
    pthread_t thread;
} writer = {.lock = PTHREAD_MUTEX_INITIALIZER, .end = PTHREAD_COND_INITIALIZER};

/* Appends the lines that wait for a file. */
static void append_waiting(struct state_list *list,
                           const struct state_list_file *file, const char *path)
{
    pthread_mutex_lock(&writer.lock);
    for (struct waiting *w = writer.lines; w != NULL; w = w->next)
        if (strcmp(w->path, path) == 0)
            append(list, file, w->line);
    pthread_mutex_unlock(&writer.lock);
}

void state_list_read(struct state_list *list,
                     const struct state_list_file *file)
{
    char *path = xdg_state_path(file->name);

    *list = (struct state_list){.count = 0};
    if (path) {
        append_waiting(list, file, path);
        append_file(list, file, path);
    }
    free(path);
}

static void write_list(const struct state_list *list, const char *path)
{
    struct text_stream s;
    char *text;
    size_t size_bytes;
    struct error ignored;

    text_stream_open(&s);
    for (int i = 0; i < list->count && s.to != NULL; i++)
        fprintf(s.to, "%s\n", list->lines[i]);
    text = text_stream_close(&s, &size_bytes);
    if (text != NULL)
        file_write(path, text, size_bytes, false, NULL, &ignored);
    free(text);
}

/* Puts the line into its file. A file that another program changes, or that
 * cannot be read now, is left as it is: its lines are worth more. */
static void put(const struct waiting *w)
{
    struct state_list list = {.count = 0};
    struct error ignored;
    int lock = file_lock(w->path, &ignored);

    append(&list, w->file, w->line);
    if (lock >= 0 && append_file(&list, w->file, w->path))
        write_list(&list, w->path);
    if (lock >= 0)
        close(lock);
    state_list_free(&list);
}

/* Removes the oldest line, which is not in use. The caller holds the lock. */
static void remove_oldest(void)
{
    struct waiting **last = &writer.lines;
    struct waiting *oldest;

    while ((*last)->next != NULL)
        last = &(*last)->next;
    oldest = *last;
    *last = NULL;
    free(oldest->path);
    free(oldest->line);
    free(oldest);
}

static void *write_waiting(void *unused)
{
    pthread_mutex_lock(&writer.lock);
    while (writer.lines != NULL) {
        struct waiting *oldest = writer.lines;

        while (oldest->next != NULL)
            oldest = oldest->next;
        pthread_mutex_unlock(&writer.lock);
        put(oldest);
        pthread_mutex_lock(&writer.lock);
        remove_oldest();
    }
    writer.has_thread = false;
    pthread_cond_broadcast(&writer.end);
    pthread_mutex_unlock(&writer.lock);
    return unused;
}

void state_list_put(const struct state_list_file *file, const char *line)
{
    char *path = xdg_state_path(file->name);
    struct waiting *w;

    if (!path)
        return;
    w = xcalloc(1, sizeof *w);
    pthread_mutex_lock(&writer.lock);
    *w = (struct waiting){writer.lines, file, path, xstrdup(line)};
    writer.lines = w;
    if (!writer.has_thread &&
        thread_start(&writer.thread, write_waiting, NULL) == 0) {
        pthread_detach(writer.thread);
        writer.has_thread = true;
    }
    pthread_mutex_unlock(&writer.lock);
}

/* Lines for which no thread has started are written here. */
void state_list_finish(void)
{
    pthread_mutex_lock(&writer.lock);
    while (writer.has_thread)
        pthread_cond_wait(&writer.end, &writer.lock);
    pthread_mutex_unlock(&writer.lock);
    write_waiting(NULL);
}

void state_list_free(struct state_list *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->lines[i]);
    *list = (struct state_list){.count = 0};
}

/* ---- scenes ---- */

/* Returns the whole line if it is the absolute path of a file that exists. */
static const char *existing(const char *line)
{
    return *line == '/' && access(line, R_OK) == 0 ? line : NULL;
}

static const struct state_list_file scenes_file = {"recent", RECENT_MAX,
                                                   existing};

void recent_read(struct state_list *r)
{
    state_list_read(r, &scenes_file);
}

void recent_add(const char *path)
{
    char *whole = realpath(path, NULL);

    if (whole && !strchr(whole, '\n'))
        state_list_put(&scenes_file, whole);
    free(whole);
}

/* ---- glyphs ---- */

/* Returns the name of the terminal, which follows the kind of glyphs. */
static const char *terminal_of(const char *line)
{
    const char *blank = strchr(line, ' ');

    return blank ? blank + 1 : NULL;
}

static const struct state_list_file glyphs_file = {"glyphs", 50, terminal_of};

static enum glyph_mode mode_of(const char *line)
{
    size_t length = strcspn(line, " ");

    for (int i = 0; term_caps_glyph_names[i]; i++) {
        if (strlen(term_caps_glyph_names[i]) == length &&
            strncmp(line, term_caps_glyph_names[i], length) == 0)
            return (enum glyph_mode)i;
    }
    return GLYPH_AUTO;
}

enum glyph_mode glyph_memory_read(const char *terminal)
{
    struct state_list list;
    enum glyph_mode found = GLYPH_AUTO;

    state_list_read(&list, &glyphs_file);
    for (int i = 0; i < list.count; i++) {
        if (strcmp(list.keys[i], terminal) == 0)
            found = mode_of(list.lines[i]);
    }
    state_list_free(&list);
    return found;
}

void glyph_memory_write(const char *terminal, enum glyph_mode mode)
{
    char *line = xformat("%s %s", term_caps_glyph_names[mode], terminal);

    state_list_put(&glyphs_file, line);
    free(line);
}
