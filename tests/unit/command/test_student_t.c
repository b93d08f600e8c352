// SPDX-License-Identifier: MIT
/*
 * test_student_t.c - quantiles against closed forms and printed tables
 */
#include <math.h>

#include "tests/unit/check.h"

#include "command/replicates.h"

#define PI 3.14159265358979323846

/* One degree of freedom is Cauchy's distribution; two have a closed form. */
static void closed_forms_are_met(void **state)
{
    static const double probabilities[] = {0.9, 0.5, 0.05, 1e-3, 1e-6, 1e-9};

    (void)state;
    for (int i = 0; i < 6; i++) {
        double p = probabilities[i];
        double one = tan(PI / 2 * (1 - p)), two = sqrt(2 / (p * (2 - p)) - 2);

        check_close(student_t_bound(p, 1) / one, 1, 1e-6);
        check_close(student_t_bound(p, 2) / two, 1, 1e-6);
    }
}

/* Handbook tables, two-sided. */
static void tables_are_met(void **state)
{
    (void)state;
    check_close(student_t_bound(0.05, 3), 3.18245, 1e-5);
    check_close(student_t_bound(0.05, 7), 2.36462, 1e-5);
    check_close(student_t_bound(0.01, 10), 3.16927, 1e-5);
    check_close(student_t_bound(0.001, 30), 3.64596, 1e-5);
    check_close(student_t_bound(0.05, 120), 1.97993, 1e-5);
    /* the normal distribution */
    check_close(student_t_bound(0.05, 1e7), 1.959964, 1e-5);
    check_close(student_t_bound(1e-5, 1e7), 4.417173, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms_are_met),
        cmocka_unit_test(tables_are_met),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
