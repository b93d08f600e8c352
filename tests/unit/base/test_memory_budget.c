// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "base/machine.h"
#include "base/memory.h"

/* Items are taken until the size is used, and what does not fit takes
 * nothing. */
static void counts_what_is_taken(void **state)
{
    struct memory_budget b = {.size_bytes = 100};

    (void)state;
    assert_true(memory_budget_take(&b, 9, 10));
    assert_false(memory_budget_take(&b, 11, 1));
    assert_false(memory_budget_take(&b, UINT64_MAX / 2, 4)); /* overflows */
    assert_int_equal(memory_budget_left(&b), 10);
    assert_true(memory_budget_take(&b, 1, 10));
    assert_false(memory_budget_take(&b, 1, 1));
    assert_true(memory_budget_take(&b, 0, 1));
}

static void zeroed_budgets_have_no_limit(void **state)
{
    struct memory_budget b = {.size_bytes = 0};

    (void)state;
    assert_true(memory_budget_take(&b, UINT64_MAX, 1));
    assert_true(memory_budget_take(&b, UINT64_MAX, 1));
}

/* The budget grows with the files, at most to what the machine has. */
static void grows_up_to_the_machine(void **state)
{
    uint64_t quota = cgroup_quota_memory("").size_bytes, before;
    struct memory_budget b = {.size_bytes = 0};

    (void)state;
    memory_budget_add_file(&b, 0);
    assert_true(b.size_bytes > 0 && b.size_bytes <= quota);
    before = b.size_bytes;
    memory_budget_add_file(&b, 1000);
    assert_true(b.size_bytes >= before);
    memory_budget_add_file(&b, UINT64_MAX);
    memory_budget_add_file(&b, UINT64_MAX);
    assert_int_equal(b.size_bytes, quota);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_what_is_taken),
        cmocka_unit_test(zeroed_budgets_have_no_limit),
        cmocka_unit_test(grows_up_to_the_machine),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
