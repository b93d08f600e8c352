// SPDX-License-Identifier: MIT
/*
 * test_autosave_file.c - files of kept sessions: what is written is read,
 * damage at any byte is found, and old files are removed
 */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "session/autosave_file.h"

#include "tests/unit/files.h"

static char view[] = "eye 0 0 5\n";
static char list[] = "m\n-\n0\n";
static char mtl[] = "newmtl m0\nKd 1 0 0\n";
static char history[] = "0 0\n";
static char film[] = "any bytes\0 of a film";
static char scene[] = "/a b/s.obj";

static struct autosave_file some_session(void)
{
    return (struct autosave_file){
        .scene = scene,
        .is_live = true,
        .has_edits = true,
        .render_ns = UINT64_C(200000000000),
        .parts = {view, list, mtl, history, film},
        .sizes = {sizeof view - 1, sizeof list - 1, sizeof mtl - 1,
                  sizeof history - 1, sizeof film},
    };
}

static void check_same(const struct autosave_file *a,
                       const struct autosave_file *b)
{
    assert_string_equal(a->scene, b->scene);
    assert_int_equal(a->is_live, b->is_live);
    assert_int_equal(a->has_edits, b->has_edits);
    assert_int_equal(a->render_ns, b->render_ns);
    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        assert_int_equal(a->sizes[i], b->sizes[i]);
        if (b->parts[i] != NULL)
            assert_memory_equal(a->parts[i], b->parts[i], a->sizes[i]);
    }
}

static void sessions_are_read_as_written(void **state)
{
    struct autosave_file from = some_session(), k;
    struct error err;
    size_t size;
    char *bytes = autosave_file_bytes(&from, &size);
    char text[AUTOSAVE_TEXT_BYTES];

    (void)state;
    assert_non_null(bytes);
    put_bytes("s", bytes, size);
    check_or_say(autosave_file_read(&k, "s", &err), err.text);
    check_same(&from, &k);
    autosave_file_free(&k);
    check_or_say(autosave_file_read_head(&k, "s", &err), err.text);
    check_same(&from, &k);
    assert_null(k.parts[AUTOSAVE_FILM]);
    autosave_describe(text, &k);
    assert_string_equal(text, "3 min 20 s of render and unsaved changes");
    k.has_edits = false;
    autosave_describe(text, &k);
    assert_string_equal(text, "3 min 20 s of render");
    autosave_file_free(&k);
    free(bytes);
}

/* Parses bytes, which must fail, with a line that begins with the path. */
static void check_damaged(const char *bytes, size_t size)
{
    struct autosave_file k;
    struct error err;
    char *copy = malloc(size + 1);

    assert_non_null(copy);
    memcpy(copy, bytes, size);
    copy[size] = '\0';
    assert_false(autosave_file_parse(&k, "s", copy, size, &err));
    assert_int_equal(strncmp(err.text, "s:", 2), 0);
    assert_null(strchr(err.text, '\n'));
    autosave_file_free(&k);
    free(copy);
}

/* The film has checksums of its own. */
static void damage_is_found_at_each_byte(void **state)
{
    struct autosave_file from = some_session();
    size_t size, protected;
    char *bytes = autosave_file_bytes(&from, &size);

    (void)state;
    assert_non_null(bytes);
    protected = size - from.sizes[AUTOSAVE_FILM];
    for (size_t i = 0; i < protected; i++)
        for (int bit = 0; bit < 8; bit++) {
            bytes[i] = (char)(bytes[i] ^ 1 << bit);
            check_damaged(bytes, size);
            bytes[i] = (char)(bytes[i] ^ 1 << bit);
        }
    for (size_t i = 0; i < size; i++)
        check_damaged(bytes, i);
    free(bytes);
    check_damaged("something else\n", 15);
}

/* ---- the folder ---- */

static char folder_of_state[512];

/* Writes a file of this size, which is a number of days old, in place of the
 * session of a scene. */
static char *put_old(const char *name, size_t size, int days)
{
    char *path = autosave_path(name);
    char *bytes = calloc(size, 1);
    struct timespec times[2] = {{.tv_sec = time(NULL) - days * 86400L}};

    assert_non_null(path);
    assert_non_null(bytes);
    times[1] = times[0];
    put_bytes(path, bytes, size);
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
    free(bytes);
    return path;
}

static void old_sessions_are_removed(void **state)
{
    char *paths[4];

    (void)state;
    paths[0] = put_old("/new", 100, 0);
    paths[1] = put_old("/week", 100, 7);
    paths[2] = put_old("/month", 100, 29);
    paths[3] = put_old("/old", 100, 31);
    assert_int_equal(autosave_prune(paths[0], 30, 1000), 1);
    assert_int_equal(access(paths[3], F_OK), -1);
    assert_int_equal(autosave_prune(paths[0], 30, 300), 0);
    assert_int_equal(autosave_prune(paths[0], 30, 299), 1);
    assert_int_equal(access(paths[2], F_OK), -1);
    assert_int_equal(access(paths[1], F_OK), 0);
    for (int i = 0; i < 4; i++) {
        unlink(paths[i]);
        free(paths[i]);
    }
}

/* Locks are of processes, so another one asks. */
static void one_process_has_a_session(void **state)
{
    char *path = autosave_path("/a"), *other = autosave_path("/b");
    int fd, status;

    (void)state;
    assert_non_null(path);
    fd = autosave_lock(path);
    assert_true(fd >= 0);
    pid_t child = fork();
    if (child == 0)
        _exit(autosave_lock(path) >= 0 ? 1 : autosave_lock(other) < 0 ? 2 : 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    close(fd);
    free(path);
    free(other);
}

static void sessions_are_listed(void **state)
{
    struct autosave_file from = some_session();
    size_t size, length;
    char *bytes = autosave_file_bytes(&from, &size),
         *path = autosave_path(scene), *text;
    char *damaged = autosave_path("/damaged");
    struct error err;
    FILE *to = open_memstream(&text, &length);

    (void)state;
    assert_non_null(bytes);
    assert_non_null(to);
    put_bytes(path, bytes, size);
    put(damaged, "no session");
    check_or_say(autosave_print_list(to, &err), err.text);
    assert_int_equal(fclose(to), 0);
    assert_non_null(strstr(text, "/a b/s.obj: 3 min 20 s of render and unsaved "
                                 "changes, "));
    assert_non_null(strstr(text, ": found another kind of file"));
    unlink(path);
    unlink(damaged);
    free(text);
    to = open_memstream(&text, &length);
    assert_non_null(to);
    check_or_say(autosave_print_list(to, &err), err.text);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(text, "no kept sessions\n");
    free(text);
    free(bytes);
    free(path);
    free(damaged);
}

static int enter(void **state)
{
    if (enter_folder(state) != 0)
        return -1;
    snprintf(folder_of_state, sizeof folder_of_state, "%s/state", folder);
    return setenv("XDG_STATE_HOME", folder_of_state, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sessions_are_read_as_written),
        cmocka_unit_test(damage_is_found_at_each_byte),
        cmocka_unit_test(old_sessions_are_removed),
        cmocka_unit_test(one_process_has_a_session),
        cmocka_unit_test(sessions_are_listed),
    };

    return cmocka_run_group_tests(tests, enter, remove_folder);
}
