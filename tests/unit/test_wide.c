// SPDX-License-Identifier: MIT
/* Built for other sets of instructions as well; ISA is the name of the set. */
#include "glim/isa.h"
#include "glim/wide_hit.h"

#include "trees.h"

#ifndef ISA
#define ISA "plain"
#endif

static void instructions_are_missing(void **state)
{
    (void)state;
    skip();
}

int main(void)
{
    const struct CMUnitTest none[] = {
        cmocka_unit_test(instructions_are_missing),
    };
    struct error err;

    return isa_named(ISA, &err) != NULL
               ? run_trees()
               : cmocka_run_group_tests(none, NULL, NULL);
}
