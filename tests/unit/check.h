// SPDX-License-Identifier: MIT
/*
 * check.h - checks that print both values and the bound that was missed
 *
 * Units:     those of the values
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_CHECK_H
#define TESTS_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#undef fail /* error.h has a function of this name */

/* Says whether a sanitizer watches memory, which takes much of its own. */
#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || \
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define IS_SANITIZED true
#else
#define IS_SANITIZED false
#endif

/* Says whether tests take their whole time: THOROUGH is set, as by `make test
 * BUILDS=all`. Otherwise the slowest take a part of their trials. */
static inline bool check_is_thorough(void)
{
    return getenv("THOROUGH") != NULL;
}

/* Says whether the next case of a long list is due: every case in a thorough
 * test, otherwise one of n. */
static inline bool check_is_due(unsigned n)
{
    static unsigned next;

    return next++ % n == 0 || check_is_thorough();
}

static inline void check_close_at(double got, double want, double bound,
                                  const char *what, const char *file, int line)
{
    double miss = got > want ? got - want : want - got;

    if (miss <= bound)
        return;
    print_error("%s: got %.9g, want %.9g, off by %.3g, allowed %.3g\n", what,
                got, want, miss, bound);
    _fail(file, line);
}

/* Checks that |got - want| <= bound; NaN fails. */
#define check_close(got, want, bound) \
    check_close_at(got, want, bound, #got, __FILE__, __LINE__)

static inline void check_at_most_at(double got, double bound, const char *what,
                                    const char *file, int line)
{
    if (got <= bound)
        return;
    print_error("%s: got %.9g, allowed at most %.9g\n", what, got, bound);
    _fail(file, line);
}

#define check_at_most(got, bound) \
    check_at_most_at(got, bound, #got, __FILE__, __LINE__)

/* Prints the text, which gives the reason, if the check fails. */
#define check_or_say(ok, text)         \
    do {                               \
        if (!(ok)) {                   \
            print_error("%s\n", text); \
            _fail(__FILE__, __LINE__); \
        }                              \
    } while (0)

static inline void check_has_at(const char *text, const char *part,
                                const char *file, int line)
{
    if (strstr(text, part))
        return;
    print_error("found no '%s' in '%s'\n", part, text);
    _fail(file, line);
}

#define check_has(text, part) check_has_at(text, part, __FILE__, __LINE__)

/* Random numbers in [0, 1) for tests, by splitmix64, which glim does not
 * use. */
static inline double check_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

#endif
