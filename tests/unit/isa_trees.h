// SPDX-License-Identifier: MIT
/*
 * isa_trees.h - the tests of trees.h for queries that are built for a set of
 * instructions, if the processor has it
 *
 * Include wide_hit.h first.
 *
 * Units:     none
 * Ownership: none
 * Threads:   one
 * Errors:    as trees.h
 */
#ifndef TESTS_ISA_TREES_H
#define TESTS_ISA_TREES_H

#include "glim/isa.h"
#include "trees.h"

static void instructions_are_missing(void **state)
{
    (void)state;
    skip();
}

static int run_isa_trees(const char *isa)
{
    const struct CMUnitTest none[] = {
        cmocka_unit_test(instructions_are_missing),
    };
    struct error err;

    return isa_named(isa, &err) != NULL
               ? run_trees()
               : cmocka_run_group_tests(none, NULL, NULL);
}

#endif
