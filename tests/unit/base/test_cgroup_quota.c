// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/machine.h"

static void put_in_tree(const char *path, const char *text)
{
    char command[1024];

    snprintf(command, sizeof command,
             "mkdir -p \"$(dirname '%s/%s')\" && printf -- '%s' > '%s/%s'",
             folder, path, text, folder, path);
    assert_int_equal(system(command), 0);
}

/* The folders have the form in which the kernel shows them. */
static void quota_is_the_tightest_of_all_groups(void **state)
{
    (void)state;
    assert_int_equal(cgroup_quota_processors(folder), 0);

    put_in_tree("proc/self/cgroup", "0::/a/b\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_in_tree("sys/fs/cgroup/a/b/cpu.max", "max 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_in_tree("sys/fs/cgroup/a/b/cpu.max", "250000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 3);
    put_in_tree("sys/fs/cgroup/a/b/cpu.max", "5000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 1);
    put_in_tree("sys/fs/cgroup/a/b/cpu.max", "400000 100000\\n");
    put_in_tree("sys/fs/cgroup/a/cpu.max", "200000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 2);

    /* In a container the mount is the container's own group. */
    put_in_tree("proc/self/cgroup", "0::/elsewhere/x\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_in_tree("sys/fs/cgroup/cpu.max", "600000 200000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 3);
    put_in_tree("sys/fs/cgroup/cpu.max", "what\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);

    /* This is version 1 of control groups. */
    put_in_tree(
        "proc/self/cgroup",
        "12:cpuset:/z\\n4:cpu,cpuacct:/c\\n1:name=systemd:/y\\n0::/\\n");
    put_in_tree("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "-1\\n");
    put_in_tree("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_in_tree("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "150000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 2);
    put_in_tree("sys/fs/cgroup/cpu/c/cpu.cfs_quota_us", "100000\\n");
    put_in_tree("sys/fs/cgroup/cpu/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 1);
}

static void check_memory_limit(uint64_t size_bytes, const char *place)
{
    struct memory_quota quota = cgroup_quota_memory(folder);

    assert_string_equal(quota.place, place);
    assert_int_equal(quota.size_bytes, size_bytes);
}

/* Of several limits the tightest one is returned, with its place. */
static void tightest_memory_limit_is_named(void **state)
{
    uint64_t machine =
        (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    struct rlimit before, limit;

    (void)state;
    assert_int_equal(getrlimit(RLIMIT_DATA, &before), 0);
    if (IS_SANITIZED || before.rlim_cur != RLIM_INFINITY)
        skip();
    check_memory_limit(machine, "in this machine");

    put_in_tree("proc/self/cgroup", "0::/a/b\\n");
    put_in_tree("sys/fs/cgroup/a/b/memory.max", "max\\n");
    check_memory_limit(machine, "in this machine");
    put_in_tree("sys/fs/cgroup/a/memory.max", "300000000\\n");
    check_memory_limit(300000000, "in the control group");
    put_in_tree("sys/fs/cgroup/a/b/memory.max", "200000000\\n");
    check_memory_limit(200000000, "in the control group");

    /* In version 1 a number beyond all memory means that there is no limit. */
    put_in_tree("proc/self/cgroup", "4:memory:/c\\n2:cpu,cpuacct:/d\\n");
    check_memory_limit(machine, "in this machine");
    put_in_tree("sys/fs/cgroup/memory/c/memory.limit_in_bytes",
                "9223372036854771712\\n");
    check_memory_limit(machine, "in this machine");
    put_in_tree("sys/fs/cgroup/memory/c/memory.limit_in_bytes", "150000000\\n");
    check_memory_limit(150000000, "in the control group");

    limit = (struct rlimit){149999999, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_DATA, &limit), 0);
    check_memory_limit(149999999, "under ulimit -d");
    assert_int_equal(setrlimit(RLIMIT_DATA, &before), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(quota_is_the_tightest_of_all_groups,
                                        make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(tightest_memory_limit_is_named,
                                        make_folder, remove_folder),
    };

    return cmocka_run_group_tests_name("cgroup_quota", tests, NULL, NULL);
}
