// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <locale.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/cgroup_quota.h"
#include "base/util.h"

static void test_fail(void **state)
{
    struct error err;

    (void)state;
    assert_false(fail(&err, "%s:%d: found '%s'", "a.obj", 3, "x"));
    assert_string_equal(err.text, "a.obj:3: found 'x'");
    /* one line, and nothing that a terminal would obey */
    fail(&err, "a\nb\033[2Jc\177\t\xc2\x9b z\xc3\xa4");
    assert_string_equal(err.text, "a?b?[2Jc??? z\xc3\xa4");
    char *text = xformat("%02000d", 7);
    fail(&err, "%s", text);
    free(text);
    assert_int_equal(strlen(err.text), sizeof err.text - 1);
}

static void test_strings(void **state)
{
    char *a = xstrdup("abc"), *b = xformat("%s-%d", a, 12);

    (void)state;
    assert_string_equal(b, "abc-12");
    a = xrealloc(a, 10);
    assert_string_equal(a, "abc");
    free(a);
    free(b);
    free(xmalloc(0));
}

static void test_alloc_array(void **state)
{
    (void)state;
    unsigned char *p = alloc_array(1000, 7);
    assert_non_null(p);
    for (int i = 0; i < 7000; i++)
        assert_int_equal(p[i], 0);
    free(p);
    p = alloc_array(0, 8);
    assert_non_null(p);
    free(p);
    assert_null(alloc_array(SIZE_MAX / 2, 4));
    assert_null(alloc_array((size_t)1 << 33, (size_t)1 << 33));
    assert_null(alloc_array(SIZE_MAX, 1));
}

static void test_grow_array(void **state)
{
    uint32_t *items = NULL;
    void *array = NULL;
    size_t capacity = 0;
    int moves = 0;

    (void)state;
    for (uint32_t i = 0; i < 100000; i++) {
        size_t before = capacity;
        assert_true(grow_array(&array, &capacity, i + 1, sizeof *items));
        assert_true(capacity > i);
        moves += capacity != before;
        items = array;
        items[i] = i;
    }
    assert_true(moves <= 17);
    for (uint32_t i = 0; i < 100000; i++)
        assert_int_equal(items[i], i);
    size_t before = capacity;
    assert_false(grow_array(&array, &capacity, SIZE_MAX / 2, sizeof *items));
    assert_false(grow_array(&array, &capacity, SIZE_MAX, 1));
    assert_ptr_equal(array, items);
    assert_int_equal(capacity, before);
    free(array);
}

static void hook(void)
{
    static const char text[] = "restored\n";

    if (write(STDERR_FILENO, text, sizeof text - 1) < 0)
        _exit(9);
}

/* Out of memory: the hook, one line, exit status 1. */
static void test_out_of_memory(void **state)
{
    int ends[2], status;
    char text[200] = "";
    size_t length = 0;
    ssize_t n;

    (void)state;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        xmalloc_set_hook(hook);
        xcalloc(SIZE_MAX / 2, 4);
        _exit(0);
    }
    close(ends[1]);
    while ((n = read(ends[0], text + length, sizeof text - 1 - length)) > 0)
        length += (size_t)n;
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
    assert_string_equal(text, "restored\nglim: out of memory\n");
}

static void test_clock(void **state)
{
    uint64_t begin_ns = clock_ns();

    (void)state;
    usleep(20000);
    double seconds = seconds_between(begin_ns, clock_ns());
    assert_true(seconds >= 0.02 && seconds < 10);
    check_close(seconds_between(5, 1000000005), 1, 1e-12);
    check_close(seconds_between(10, 5), 0, 0); /* never negative */
}

static void test_threads(void **state)
{
    cpu_set_t mask, one;

    (void)state;
    assert_int_equal(sched_getaffinity(0, sizeof mask, &mask), 0);
    int all = usable_threads();
    assert_in_range(all, 1, CPU_COUNT(&mask));
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; i++) {
        if (CPU_ISSET(i, &mask))
            CPU_SET(i, &one);
    }
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    int single = usable_threads();
    sched_setaffinity(0, sizeof mask, &mask);
    assert_int_equal(single, 1);
}

static void put(const char *root, const char *path, const char *text)
{
    char command[512];

    snprintf(command, sizeof command,
             "mkdir -p \"$(dirname '%s/%s')\" && printf -- '%s' > '%s/%s'",
             root, path, text, root, path);
    assert_int_equal(system(command), 0);
}

/* Trees as the kernel shows them. */
static void test_quota(void **state)
{
    char root[] = "/tmp/glim-test-XXXXXX", command[64];

    (void)state;
    assert_non_null(mkdtemp(root));
    assert_int_equal(cgroup_quota_processors(root), 0);

    put(root, "proc/self/cgroup", "0::/a/b\\n");
    assert_int_equal(cgroup_quota_processors(root), 0);
    put(root, "sys/fs/cgroup/a/b/cpu.max", "max 100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 0);
    put(root, "sys/fs/cgroup/a/b/cpu.max", "250000 100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 3);
    put(root, "sys/fs/cgroup/a/b/cpu.max", "5000 100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 1);
    put(root, "sys/fs/cgroup/a/b/cpu.max", "400000 100000\\n");
    put(root, "sys/fs/cgroup/a/cpu.max", "200000 100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 2);

    /* a container's own group is the mount itself */
    put(root, "proc/self/cgroup", "0::/elsewhere/x\\n");
    assert_int_equal(cgroup_quota_processors(root), 0);
    put(root, "sys/fs/cgroup/cpu.max", "600000 200000\\n");
    assert_int_equal(cgroup_quota_processors(root), 3);
    put(root, "sys/fs/cgroup/cpu.max", "what\\n");
    assert_int_equal(cgroup_quota_processors(root), 0);

    /* version 1 */
    put(root, "proc/self/cgroup",
        "12:cpuset:/z\\n4:cpu,cpuacct:/c\\n1:name=systemd:/y\\n0::/\\n");
    put(root, "sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "-1\\n");
    put(root, "sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 0);
    put(root, "sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "150000\\n");
    assert_int_equal(cgroup_quota_processors(root), 2);
    put(root, "sys/fs/cgroup/cpu/c/cpu.cfs_quota_us", "100000\\n");
    put(root, "sys/fs/cgroup/cpu/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(root), 1);

    snprintf(command, sizeof command, "rm -rf %s", root);
    assert_int_equal(system(command), 0);
}

static void memory_is(const char *root, uint64_t size_bytes, const char *place)
{
    struct memory_quota quota = cgroup_quota_memory(root);

    assert_string_equal(quota.place, place);
    assert_int_equal(quota.size_bytes, size_bytes);
}

/* The tightest of all that limit memory is named. */
static void test_memory_quota(void **state)
{
    char root[] = "/tmp/glim-test-XXXXXX", command[64];
    uint64_t machine =
        (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    struct rlimit before, limit;

    (void)state;
    assert_int_equal(getrlimit(RLIMIT_DATA, &before), 0);
    if (before.rlim_cur != RLIM_INFINITY)
        skip();
    assert_non_null(mkdtemp(root));
    memory_is(root, machine, "in this machine");

    put(root, "proc/self/cgroup", "0::/a/b\\n");
    put(root, "sys/fs/cgroup/a/b/memory.max", "max\\n");
    memory_is(root, machine, "in this machine");
    put(root, "sys/fs/cgroup/a/memory.max", "300000000\\n");
    memory_is(root, 300000000, "in the control group");
    put(root, "sys/fs/cgroup/a/b/memory.max", "200000000\\n");
    memory_is(root, 200000000, "in the control group");

    /* version 1, where no limit is a number beyond all memory */
    put(root, "proc/self/cgroup", "4:memory:/c\\n2:cpu,cpuacct:/d\\n");
    memory_is(root, machine, "in this machine");
    put(root, "sys/fs/cgroup/memory/c/memory.limit_in_bytes",
        "9223372036854771712\\n");
    memory_is(root, machine, "in this machine");
    put(root, "sys/fs/cgroup/memory/c/memory.limit_in_bytes", "150000000\\n");
    memory_is(root, 150000000, "in the control group");

    limit = (struct rlimit){149999999, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_DATA, &limit), 0);
    memory_is(root, 149999999, "under ulimit -d");
    assert_int_equal(setrlimit(RLIMIT_DATA, &before), 0);

    snprintf(command, sizeof command, "rm -rf %s", root);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fail),          cmocka_unit_test(test_strings),
        cmocka_unit_test(test_alloc_array),   cmocka_unit_test(test_grow_array),
        cmocka_unit_test(test_out_of_memory), cmocka_unit_test(test_clock),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_quota),
        cmocka_unit_test(test_memory_quota),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests_name("util", tests, NULL, NULL);
}
