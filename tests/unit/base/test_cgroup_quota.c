// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/cgroup_quota.h"

static void put_within(const char *path, const char *text)
{
    char command[1024];

    snprintf(command, sizeof command,
             "mkdir -p \"$(dirname '%s/%s')\" && printf -- '%s' > '%s/%s'",
             folder, path, text, folder, path);
    assert_int_equal(system(command), 0);
}

/* Trees as the kernel shows them. */
static void test_quota(void **state)
{
    (void)state;
    assert_int_equal(cgroup_quota_processors(folder), 0);

    put_within("proc/self/cgroup", "0::/a/b\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_within("sys/fs/cgroup/a/b/cpu.max", "max 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_within("sys/fs/cgroup/a/b/cpu.max", "250000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 3);
    put_within("sys/fs/cgroup/a/b/cpu.max", "5000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 1);
    put_within("sys/fs/cgroup/a/b/cpu.max", "400000 100000\\n");
    put_within("sys/fs/cgroup/a/cpu.max", "200000 100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 2);

    /* a container's own group is the mount itself */
    put_within("proc/self/cgroup", "0::/elsewhere/x\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_within("sys/fs/cgroup/cpu.max", "600000 200000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 3);
    put_within("sys/fs/cgroup/cpu.max", "what\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);

    /* version 1 */
    put_within("proc/self/cgroup",
               "12:cpuset:/z\\n4:cpu,cpuacct:/c\\n1:name=systemd:/y\\n0::/\\n");
    put_within("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "-1\\n");
    put_within("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 0);
    put_within("sys/fs/cgroup/cpu,cpuacct/c/cpu.cfs_quota_us", "150000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 2);
    put_within("sys/fs/cgroup/cpu/c/cpu.cfs_quota_us", "100000\\n");
    put_within("sys/fs/cgroup/cpu/c/cpu.cfs_period_us", "100000\\n");
    assert_int_equal(cgroup_quota_processors(folder), 1);
}

static void memory_is(uint64_t size_bytes, const char *place)
{
    struct memory_quota quota = cgroup_quota_memory(folder);

    assert_string_equal(quota.place, place);
    assert_int_equal(quota.size_bytes, size_bytes);
}

/* The tightest of all that limit memory is named. */
static void test_memory_quota(void **state)
{
    uint64_t machine =
        (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    struct rlimit before, limit;

    (void)state;
    assert_int_equal(getrlimit(RLIMIT_DATA, &before), 0);
    if (before.rlim_cur != RLIM_INFINITY)
        skip();
    memory_is(machine, "in this machine");

    put_within("proc/self/cgroup", "0::/a/b\\n");
    put_within("sys/fs/cgroup/a/b/memory.max", "max\\n");
    memory_is(machine, "in this machine");
    put_within("sys/fs/cgroup/a/memory.max", "300000000\\n");
    memory_is(300000000, "in the control group");
    put_within("sys/fs/cgroup/a/b/memory.max", "200000000\\n");
    memory_is(200000000, "in the control group");

    /* version 1, where no limit is a number beyond all memory */
    put_within("proc/self/cgroup", "4:memory:/c\\n2:cpu,cpuacct:/d\\n");
    memory_is(machine, "in this machine");
    put_within("sys/fs/cgroup/memory/c/memory.limit_in_bytes",
               "9223372036854771712\\n");
    memory_is(machine, "in this machine");
    put_within("sys/fs/cgroup/memory/c/memory.limit_in_bytes", "150000000\\n");
    memory_is(150000000, "in the control group");

    limit = (struct rlimit){149999999, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_DATA, &limit), 0);
    memory_is(149999999, "under ulimit -d");
    assert_int_equal(setrlimit(RLIMIT_DATA, &before), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_quota, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_memory_quota, make_folder,
                                        remove_folder),
    };

    return cmocka_run_group_tests_name("cgroup_quota", tests, NULL, NULL);
}
