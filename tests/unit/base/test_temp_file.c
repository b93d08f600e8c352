// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"

/* Makes a system call fail in this process if all these bits are set in the
 * argument, as some file systems and sandboxes do. */
static bool forbid(int call, int argument, unsigned bits, int reason)
{
    unsigned at =
        (unsigned)(offsetof(struct seccomp_data, args) + 8 * (size_t)argument);
    struct sock_filter filter[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)call, 0, 4),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at),
        BPF_STMT(BPF_ALU | BPF_AND | BPF_K, bits),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, bits, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | (unsigned)reason),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog program = {sizeof filter / sizeof filter[0], filter};

    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

enum way { UNNAMED, NO_UNNAMED_FILES, NO_LINKS_TO_THEM, WAYS };

static bool take_way(enum way way)
{
    switch (way) {
    case NO_UNNAMED_FILES: return forbid(SYS_openat, 2, O_TMPFILE, EOPNOTSUPP);
    case NO_LINKS_TO_THEM:
        return forbid(SYS_linkat, 4, AT_SYMLINK_FOLLOW, EACCES);
    default: return true;
    }
}

/* Runs the function in a child process in which files are written in this way.
 * Returns its wait status. */
static int run_in_way(enum way way, bool (*check)(void))
{
    int status;
    pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0) {
        if (!take_way(way))
            _exit(77);
        _exit(check() ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static bool files_are_written(void)
{
    struct file_change change = {.before = {.exists = false}};
    struct error err;
    bool exists = false;
    bool ok = file_write("ways/a", "one", 3, false, NULL, &err) &&
              file_write("ways/a", "two", 3, false, NULL, &err) &&
              file_write("ways/b", "new", 3, true, NULL, &err) &&
              !file_write("ways/b", "not", 3, true, &exists, &err) && exists;
    char *name = file_write_numbered("ways/b", "", "x", 1, &err);

    ok = ok && name && file_replace("ways/c", "one", 3, &change, &err);
    free(name);
    change.before = change.after;
    return ok && file_replace("ways/c", "two", 3, &change, &err) &&
           !file_replace("ways/c", "six", 3, &change, &err);
}

/* Every way of writing gives the same files and leaves no others. */
static void every_way_of_writing_gives_the_same_files(void **state)
{
    (void)state;
    for (enum way way = UNNAMED; way < WAYS; way++) {
        mkdir("ways", 0777);
        int status = run_in_way(way, files_are_written);
        if (WIFEXITED(status) && WEXITSTATUS(status) == 77)
            skip();
        assert_int_equal(status, 0);
        has("ways/a", "two");
        has("ways/b", "new");
        has("ways/b.", "x");
        has("ways/c", "two");
        assert_int_equal(count_files("ways"), 4);
        assert_int_equal(system("rm -r ways"), 0);
    }
}

/* Dies in the middle of a write: the signal of the file size limit is not
 * caught. */
static bool die_while_writing(void)
{
    static char data[65536];
    struct rlimit limit = {4096, 4096};
    struct error err;

    signal(SIGXFSZ, SIG_DFL);
    return setrlimit(RLIMIT_FSIZE, &limit) == 0 &&
           file_write("dead/a", data, sizeof data, false, NULL, &err);
}

/* A process that dies leaves no file if unnamed files exist. Elsewhere the next
 * save removes what it left. */
static void files_of_killed_processes_are_removed(void **state)
{
    struct error err;

    (void)state;
    mkdir("dead", 0777);
    put("dead/a", "old");
    int fd = open("dead", O_TMPFILE | O_WRONLY, 0666);
    if (fd >= 0) {
        close(fd);
        assert_true(WIFSIGNALED(run_in_way(UNNAMED, die_while_writing)));
        has("dead/a", "old");
        assert_int_equal(count_files("dead"), 1);
    }
    int status = run_in_way(NO_UNNAMED_FILES, die_while_writing);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77)
        skip();
    assert_true(WIFSIGNALED(status));
    has("dead/a", "old");
    assert_int_equal(count_files("dead"), 2);
    assert_true(file_write("dead/b", "new", 3, false, NULL, &err));
    assert_int_equal(count_files("dead"), 2);
    has("dead/a", "old");
    has("dead/b", "new");
}

/* Files that other processes may still be writing, and files with similar
 * names, stay. */
static void files_of_other_processes_stay(void **state)
{
    static const char *const kept[] = {
        ".glim-12345678-1-00000000", /* another host: its process may be running
                                      */
        ".glim-12345678-01-00000000", ".glim-12345678-1-0000000",
        ".glim-12345678-1-00000000x", ".glim-12345678--1-00000000",
        ".glim-1234567g-1-00000000",  "glim-12345678-1-00000000"};
    static const char old[] = "left/.glim-12345678-2-0000abcd";
    static const char folder_name[] = "left/.glim-12345678-3-0000abcd";
    struct timeval days_ago[2] = {{.tv_sec = time(NULL) - 49 * 3600},
                                  {.tv_sec = time(NULL) - 49 * 3600}};
    int count = (int)(sizeof kept / sizeof kept[0]);
    struct error err;

    (void)state;
    mkdir("left", 0777);
    for (int i = 0; i < count; i++) {
        char path[100];

        snprintf(path, sizeof path, "left/%s", kept[i]);
        put(path, "x");
        if (i > 0)
            assert_int_equal(utimes(path, days_ago), 0);
    }
    put(old, "x");
    mkdir(folder_name, 0777);
    assert_int_equal(utimes(old, days_ago), 0);
    assert_int_equal(utimes(folder_name, days_ago), 0);
    assert_true(file_write("left/a", "new", 3, false, NULL, &err));
    assert_int_equal(access(old, F_OK), -1);
    assert_int_equal(access(folder_name, F_OK), 0);
    assert_int_equal(count_files("left"), count + 2);
    if (geteuid() != 0)
        return;
    put(old, "x");
    assert_int_equal(utimes(old, days_ago), 0);
    assert_int_equal(chown(old, 65534, 65534), 0);
    assert_true(file_write("left/a", "new", 3, false, NULL, &err));
    assert_int_equal(access(old, F_OK), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_way_of_writing_gives_the_same_files),
        cmocka_unit_test(files_of_killed_processes_are_removed),
        cmocka_unit_test(files_of_other_processes_stay),
    };

    return cmocka_run_group_tests_name("temp_file", tests, enter_folder,
                                       remove_folder);
}
