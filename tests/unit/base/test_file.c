// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"

static void read_fails(const char *path, const char *expected)
{
    struct error err;
    char *text;
    size_t size;

    assert_false(file_read(path, &text, &size, &err));
    assert_string_equal(err.text, expected);
}

static void write_fails(const char *path, const char *expected)
{
    struct error err;

    assert_false(file_write(path, "x", 1, false, NULL, &err));
    assert_string_equal(err.text, expected);
    err.text[0] = '\0';
    assert_false(file_check(path, &err));
    assert_string_equal(err.text, expected);
}

static void contents_are_read_whole(void **state)
{
    struct error err;
    char *text = NULL;
    size_t size = 0;

    (void)state;
    put("a", "hello\n");
    assert_true(file_read("a", &text, &size, &err));
    assert_int_equal(size, 6);
    assert_string_equal(text, "hello\n");
    free(text);
    put("empty", "");
    assert_true(file_read("empty", &text, &size, &err));
    assert_int_equal(size, 0);
    assert_int_equal(text[0], 0);
    free(text);
}

static void unreadable_files_have_their_message(void **state)
{
    (void)state;
    put("plain", "");
    mkdir("sub", 0777);
    assert_int_equal(mkfifo("pipe", 0666), 0);
    int fd = open("huge", O_CREAT | O_WRONLY, 0666);
    assert_int_equal(ftruncate(fd, (off_t)1 << 43), 0);
    close(fd);

    read_fails("nothing", "nothing: no such file or folder");
    read_fails("sub", "sub: found a folder, expected a file");
    read_fails("plain/x",
               "plain/x: no such file: a part of the path is not a folder");
    alarm(5); /* opening a pipe without a writer must not block */
    read_fails("pipe", "pipe: found a pipe, expected a file");
    alarm(0);
    read_fails("/dev/zero", "/dev/zero: found a device, expected a file");

    struct error err;
    char *text;
    size_t size;
    assert_false(file_read("huge", &text, &size, &err));
    assert_non_null(strstr(err.text, "huge: found 8192.0 GiB, expected "));
    unlink("huge");
}

static void files_are_written_and_replaced(void **state)
{
    struct error err;
    struct stat st;

    (void)state;
    mkdir("w", 0777);
    mode_t mask = umask(027);
    assert_true(file_write("w/a", "one", 3, false, NULL, &err));
    umask(mask);
    has("w/a", "one");
    assert_int_equal(stat("w/a", &st), 0);
    assert_int_equal(st.st_mode & 07777, 0640);
    assert_int_equal(chmod("w/a", 0604), 0);
    assert_true(file_write("w/a", "two", 3, false, NULL, &err));
    has("w/a", "two");
    assert_int_equal(stat("w/a", &st), 0);
    assert_int_equal(st.st_mode & 07777, 0604);
    assert_true(file_write("w/a", "", 0, false, NULL, &err));
    has("w/a", "");
    assert_int_equal(count_files("w"), 1);
}

/* A file that someone else has written since it was read is left alone, whether
 * it was written in place, replaced by one of the same length, or is new. */
static void files_changed_by_others_are_not_replaced(void **state)
{
    struct file_change change = {.before = file_identify("r/a")};
    struct file_identity first;
    struct error err;

    (void)state;
    mkdir("r", 0700);
    assert_true(file_replace("r/a", "one", 3, &change, &err));
    has("r/a", "one");
    first = change.after;
    assert_false(file_replace("r/a", "new", 3, &change, &err));
    assert_string_equal(err.text,
                        "r/a: found changes by another program, not saved");
    change.before = first;
    assert_true(file_replace("r/a", "two", 3, &change, &err));
    change.before = change.after;
    put("r/a", "theirs");
    assert_false(file_replace("r/a", "three", 5, &change, &err));
    has("r/a", "theirs");
    change.before = file_identify("r/a");
    put("r/b", "others");
    assert_int_equal(rename("r/b", "r/a"), 0);
    assert_false(file_replace("r/a", "three", 5, &change, &err));
    has("r/a", "others");
    assert_int_equal(count_files("r"), 1);
}

static void new_files_do_not_replace_others(void **state)
{
    struct error err;
    bool exists = false;

    (void)state;
    mkdir("n", 0777);
    assert_true(file_write("n/a", "one", 3, true, &exists, &err));
    assert_false(exists);
    assert_false(file_write("n/a", "two", 3, true, &exists, &err));
    assert_true(exists);
    assert_string_equal(err.text, "n/a: File exists");
    has("n/a", "one");
    assert_int_equal(symlink("nowhere", "n/link"), 0);
    exists = false;
    assert_false(file_write("n/link", "two", 3, true, &exists, &err));
    assert_true(exists);
    assert_false(file_write("n/none/a", "two", 3, true, &exists, &err));
    assert_false(exists);
    assert_int_equal(count_files("n"), 2);
}

/* The first free name is taken, and the other files do not change. */
static void numbered_files_take_the_first_free_name(void **state)
{
    static const char *const names[] = {"m/a.txt", "m/a-2.txt", "m/a-4.txt"};
    struct error err;

    (void)state;
    mkdir("m", 0777);
    put("m/a-3.txt", "mine");
    for (int i = 0; i < 3; i++) {
        char *name = file_write_numbered("m/a", "txt", names[i], 7, &err);

        assert_string_equal(name, names[i]);
        free(name);
    }
    for (int i = 0; i < 3; i++) {
        char begin[8];

        snprintf(begin, sizeof begin, "%.7s", names[i]);
        has(names[i], begin);
    }
    has("m/a-3.txt", "mine");
    assert_int_equal(count_files("m"), 4);
    assert_null(file_write_numbered("m/none/a", "txt", "x", 1, &err));
    assert_string_equal(err.text, "m/none/a.txt: no such file or folder");
}

static void links_are_followed_when_writing(void **state)
{
    struct error err;
    struct stat st;

    (void)state;
    mkdir("l", 0777);
    mkdir("l/deep", 0777);
    put("l/deep/real", "old");
    assert_int_equal(symlink("deep/real", "l/one"), 0);
    assert_int_equal(symlink("one", "l/two"), 0);
    assert_int_equal(symlink("deep/later", "l/dangling"), 0);
    assert_int_equal(symlink("loop", "l/loop"), 0);
    assert_true(file_write("l/two", "new", 3, false, NULL, &err));
    has("l/deep/real", "new");
    assert_int_equal(lstat("l/two", &st), 0);
    assert_true(S_ISLNK(st.st_mode));
    assert_true(file_write("l/dangling", "new", 3, false, NULL, &err));
    has("l/deep/later", "new");
    write_fails("l/loop", "l/loop: Too many levels of symbolic links");
}

static void unwritable_places_have_their_message(void **state)
{
    (void)state;
    mkdir("sub", 0777);
    put("plain", "");
    write_fails("sub", "sub: found a folder, expected a file");
    write_fails("no/a", "no: no such file or folder");
    write_fails("", ": no such file or folder");
    write_fails("plain/a",
                "plain/a: no such file: a part of the path is not a folder");
    write_fails("/dev/null", "/dev/null: found a device, expected a file");
    char name[300];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    struct error err;
    assert_false(file_write(name, "x", 1, false, NULL, &err));
    assert_non_null(strstr(err.text, ": File name too long"));
}

/* Runs the function as a user without rights. Returns true if it returned
 * true. */
static bool as_nobody(bool (*check)(void))
{
    int status;
    pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0) {
        if (geteuid() == 0 && setuid(65534) != 0)
            _exit(2);
        _exit(check() ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static bool both_fail(const char *path, const char *expected)
{
    struct error a, b;
    bool failed = !file_write(path, "x", 1, false, NULL, &a) &&
                  !file_check(path, &b) && strcmp(a.text, expected) == 0 &&
                  strcmp(b.text, expected) == 0;

    if (!failed)
        print_error("%s: found '%s' and '%s'\n", path, a.text, b.text);
    return failed;
}

static bool permissions_are_respected(void)
{
    struct error err;
    char *text;
    size_t size;

    return both_fail("closed/a", "closed: Permission denied") &&
           both_fail("open/read-only", "open/read-only: Permission denied") &&
           !file_read("open/secret", &text, &size, &err) &&
           strcmp(err.text, "open/secret: Permission denied") == 0;
}

static void permissions_are_respected_without_root(void **state)
{
    (void)state;
    chmod(folder, 0755);
    mkdir("closed", 0777);
    mkdir("open", 0777);
    chmod("open", 0777);
    put("open/read-only", "x");
    put("open/secret", "x");
    chmod("closed", 0555);
    chmod("open/read-only", 0444);
    chmod("open/secret", 0);
    assert_true(as_nobody(permissions_are_respected));
    has("open/read-only", "x");
}

static bool full_disk_leaves_old(void)
{
    static char data[65536];
    struct rlimit limit = {4096, 4096};
    struct error err;

    signal(SIGXFSZ, SIG_IGN);
    return setrlimit(RLIMIT_FSIZE, &limit) == 0 &&
           !file_write("full/a", data, sizeof data, false, NULL, &err) &&
           strcmp(err.text, "full/a: File too large") == 0;
}

static void full_disk_keeps_the_old_file(void **state)
{
    (void)state;
    mkdir("full", 0777);
    chmod("full", 0777);
    put("full/a", "old");
    chmod("full/a", 0666);
    assert_true(as_nobody(full_disk_leaves_old));
    has("full/a", "old");
    assert_int_equal(count_files("full"), 1);
}

static void path_is(char *path, const char *expected)
{
    assert_string_equal(path, expected);
    free(path);
}

static void same_file_is_known_by_any_path(void **state)
{
    (void)state;
    mkdir("same", 0777);
    mkdir("same/sub", 0777);
    put("same/there", "");
    assert_int_equal(symlink("there", "same/link"), 0);
    assert_int_equal(symlink("later", "same/dangling"), 0);
    assert_int_equal(symlink("sub", "same/way"), 0);
    assert_true(path_is_same("same/a", "same/a"));
    assert_true(path_is_same("same/a", "./same//sub/../a"));
    assert_true(path_is_same("same/there", "same/link"));
    assert_true(path_is_same("same/dangling", "same/sub/../later"));
    assert_true(path_is_same("same/way/a", "same/sub/a"));
    assert_false(path_is_same("same/a", "same/b"));
    assert_false(path_is_same("same/a", "same/sub/a"));
    assert_false(path_is_same("same/link", "same/dangling"));
    assert_false(path_is_same("none/a", "none/b"));
    assert_true(path_is_same("none/a", "none/a"));
}

static void paths_are_joined_and_cut(void **state)
{
    (void)state;
    path_is(path_beside("a/b.obj", "c.mtl"), "a/c.mtl");
    path_is(path_beside("b.obj", "c.mtl"), "c.mtl");
    path_is(path_beside("/b.obj", "c d/e"), "/c d/e");
    path_is(path_beside("a/b.obj", "/c.mtl"), "/c.mtl");
    path_is(path_beside("a/b.obj", "../c"), "a/../c");
    path_is(path_stem("a/b.obj"), "a/b");
    path_is(path_stem("a.d/b"), "a.d/b");
    path_is(path_stem("b.tar.gz"), "b.tar");
    path_is(path_stem("a/.hidden"), "a/.hidden");
    path_is(path_stem(""), "");
    path_is(path_stem_of_input("a/b.obj"), "a/b");
    path_is(path_stem_of_input("a/b.obj.gz"), "a/b");
    path_is(path_stem_of_input(".gz"), ".gz");
    path_is(path_stem_of_input("-"), "scene");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contents_are_read_whole),
        cmocka_unit_test(unreadable_files_have_their_message),
        cmocka_unit_test(files_are_written_and_replaced),
        cmocka_unit_test(files_changed_by_others_are_not_replaced),
        cmocka_unit_test(new_files_do_not_replace_others),
        cmocka_unit_test(numbered_files_take_the_first_free_name),
        cmocka_unit_test(links_are_followed_when_writing),
        cmocka_unit_test(unwritable_places_have_their_message),
        cmocka_unit_test(permissions_are_respected_without_root),
        cmocka_unit_test(full_disk_keeps_the_old_file),
        cmocka_unit_test(same_file_is_known_by_any_path),
        cmocka_unit_test(paths_are_joined_and_cut),
    };

    return cmocka_run_group_tests_name("file", tests, enter_folder,
                                       remove_folder);
}
