// SPDX-License-Identifier: MIT
/* libglim with the first, the second, ... allocation failing: an error each
 * time, nothing leaks, and what is made is right. The linker sends the calls
 * of the library's objects to the functions here (--wrap in tests.mk). */
#include "tests/unit/check.h"

#include <stdatomic.h>
#include <unistd.h>

#include "glim/glim.h"
#include "tests/unit/folder.h"

#define WIDTH  16
#define HEIGHT 12
#define BYTES  (3 * WIDTH * HEIGHT)

/* A limit above the number of allocations of a run. */
#define RUNS_MAX 100000

static atomic_long call_count; /* allocations since the run began */
static atomic_long live_count; /* blocks that are not freed */
static long failing;           /* number of the call that fails; 0: none */

static char picture_path[200], film_path[200];

static bool fails(void)
{
    return atomic_fetch_add(&call_count, 1) + 1 == failing;
}

static void *counted(void *p)
{
    if (p != NULL)
        atomic_fetch_add(&live_count, 1);
    return p;
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : counted(__real_malloc(size));
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : counted(__real_calloc(count, size));
}

void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : counted(__real_aligned_alloc(alignment, size));
}

void *__real_realloc(void *p, size_t size);
void *__wrap_realloc(void *p, size_t size);
void *__wrap_realloc(void *p, size_t size)
{
    void *grown = fails() ? NULL : __real_realloc(p, size);

    return p == NULL ? counted(grown) : grown;
}

char *__real_strdup(const char *text);
char *__wrap_strdup(const char *text);
char *__wrap_strdup(const char *text)
{
    return fails() ? NULL : counted(__real_strdup(text));
}

char *__real_strndup(const char *text, size_t size);
char *__wrap_strndup(const char *text, size_t size);
char *__wrap_strndup(const char *text, size_t size)
{
    return fails() ? NULL : counted(__real_strndup(text, size));
}

/* Fortified headers call __vasprintf_chk() for vasprintf(). */
int __wrap_vasprintf(char **text, const char *format, va_list values);
int __wrap_vasprintf(char **text, const char *format, va_list values)
{
    va_list again;
    int length;

    va_copy(again, values);
    length = vsnprintf(NULL, 0, format, values);
    *text = fails() ? NULL : counted(__real_malloc((size_t)length + 1));
    if (*text != NULL)
        vsnprintf(*text, (size_t)length + 1, format, again);
    va_end(again);
    return *text != NULL ? length : -1;
}

int __wrap___vasprintf_chk(char **text, int flag, const char *format,
                           va_list values);
int __wrap___vasprintf_chk(char **text, int flag, const char *format,
                           va_list values)
{
    (void)flag;
    return __wrap_vasprintf(text, format, values);
}

/* Headers of an optimised build call this for getline(). */
ssize_t __real___getdelim(char **line, size_t *size, int end, FILE *from);
ssize_t __wrap___getdelim(char **line, size_t *size, int end, FILE *from);
ssize_t __wrap___getdelim(char **line, size_t *size, int end, FILE *from)
{
    bool is_new = *line == NULL;
    ssize_t length =
        is_new && fails() ? -1 : __real___getdelim(line, size, end, from);

    if (is_new)
        counted(*line);
    return length;
}

ssize_t __wrap_getline(char **line, size_t *size, FILE *from);
ssize_t __wrap_getline(char **line, size_t *size, FILE *from)
{
    return __wrap___getdelim(line, size, '\n', from);
}

char *__real_realpath(const char *path, char *real);
char *__wrap_realpath(const char *path, char *real);
char *__wrap_realpath(const char *path, char *real)
{
    return fails() ? NULL : counted(__real_realpath(path, real));
}

void __real_free(void *p);
void __wrap_free(void *p);
void __wrap_free(void *p)
{
    if (p != NULL)
        atomic_fetch_sub(&live_count, 1);
    __real_free(p);
}

/* No disk loses power here. */
int __wrap_fsync(int fd);
int __wrap_fsync(int fd)
{
    (void)fd;
    return 0;
}

/* The result of a run. */
struct outcome {
    bool is_done;
    bool has_warning;
    struct glim_error err;
    uint8_t rgb[BYTES];
};

static bool render(struct glim *g, struct outcome *o, const char *picture)
{
    return glim_set_size(g, WIDTH, HEIGHT, &o->err) &&
           glim_set_threads(g, 2, &o->err) &&
           glim_set_denoise(g, true, &o->err) &&
           glim_render(g, 2, 0, NULL, NULL, &o->err) == GLIM_DONE &&
           glim_save(g, picture, &o->err) &&
           glim_save_film(g, film_path, &o->err) &&
           glim_load_films(g, &(const char *){film_path}, 1, &o->err) &&
           glim_read_bytes(g, o->rgb, BYTES, &o->err);
}

/* Opens, renders and saves; allocation n fails. */
static void run(struct outcome *o, const char *scene, long n)
{
    struct glim *g;

    memset(o, 0, sizeof *o);
    call_count = 0;
    live_count = 0;
    failing = n;
    g = glim_open(scene, NULL, &o->err);
    o->has_warning = g != NULL && glim_warning(g, 0) != NULL;
    o->is_done = g != NULL && render(g, o, picture_path);
    glim_close(g);
    failing = 0;
    if (live_count != 0)
        fail_msg("%s, allocation %ld: %ld blocks leak (%s)", scene, n,
                 (long)live_count, o->is_done ? "done" : o->err.text);
}

/* A run without failures gives the number of allocations and the picture. */
static void check_scene(const char *scene)
{
    struct outcome good, now;
    long count, tried = 0, errors = 0;

    run(&good, scene, 0);
    assert_true(good.is_done);
    count = call_count;
    assert_in_range(count, 10, RUNS_MAX);
    for (long n = 1; n <= count; n++) {
        if (!check_is_due(12))
            continue;
        tried++;
        run(&now, scene, n);
        errors += !now.is_done;
        if (!now.is_done && strstr(now.err.text, "emory") == NULL)
            fail_msg("%s, allocation %ld: %s", scene, n, now.err.text);
        if (now.is_done && !now.has_warning &&
            memcmp(now.rgb, good.rgb, BYTES) != 0)
            fail_msg("%s, allocation %ld: another picture", scene, n);
    }
    print_message("%s: %ld of %ld allocations, %ld errors\n", scene, tried,
                  count, errors);
    /* the rest are of what a picture can do without, as the texts in its
     * file, of which there were none when this was 8 of 10 */
    assert_true(errors >= tried * 7 / 10);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    snprintf(picture_path, sizeof picture_path, "%s/picture.png", folder);
    snprintf(film_path, sizeof film_path, "%s/film", folder);
    check_scene("scenes/cornell.obj");
    check_scene("scenes/skylit.obj");
    unlink(picture_path);
    unlink(film_path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_may_fail),
    };

    return cmocka_run_group_tests(tests, make_folder, leave_empty_folder);
}
