// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/cgroup_quota.h"

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
        cmocka_unit_test(test_quota),
        cmocka_unit_test(test_memory_quota),
    };

    return cmocka_run_group_tests_name("cgroup_quota", tests, NULL, NULL);
}
