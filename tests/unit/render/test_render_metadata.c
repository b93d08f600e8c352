// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <string.h>

#include "render/render_metadata.h"

/* Returns the value of a key, or NULL. */
static const char *value(const struct image_metadata *m, const char *key)
{
    for (int i = 0; i < m->count; i++)
        if (strcmp(m->texts[i].key, key) == 0)
            return m->texts[i].value;
    return NULL;
}

static void check_value(const struct image_metadata *m, const char *key,
                        const char *expected)
{
    const char *found = value(m, key);

    if (expected == NULL)
        assert_null(found);
    else
        check_or_say(found != NULL && strcmp(found, expected) == 0, key);
}

static void values_are_those_of_the_render(void **state)
{
    struct render_progress p = {
        .spp_done = 96,
        .film_error = {true, false, 0.02, 0.015625, 0.0312},
        .stopped_by = RENDER_LIMIT_TIME,
        .render_ns = UINT64_C(2500000000),
    };
    struct image_metadata m = render_metadata(&p, "a/b.obj", 7, true);

    (void)state;
    check_value(&m, "glim:scene", "b.obj");
    check_value(&m, "glim:seed", "7");
    check_value(&m, "glim:spp", "96");
    check_value(&m, "glim:error", "0.02");
    check_value(&m, "glim:error_low", "0.015625");
    check_value(&m, "glim:error_high", "0.0312");
    check_value(&m, "glim:resolved", "false");
    check_value(&m, "glim:stopped_by", "time");
    check_value(&m, "glim:time_s", "2.500");
    check_value(&m, "glim:denoised", "true");
}

static void unknown_values_are_left_out(void **state)
{
    struct render_progress p = {.spp_done = 1,
                                .stopped_by = RENDER_LIMIT_SPP,
                                .render_ns = 1};
    struct image_metadata m = render_metadata(&p, "b.obj", 0, false);

    (void)state;
    check_value(&m, "glim:spp", "1");
    check_value(&m, "glim:error", NULL);
    check_value(&m, "glim:error_high", NULL);
    check_value(&m, "glim:resolved", NULL);
    check_value(&m, "glim:stopped_by", "samples");
    check_value(&m, "glim:time_s", NULL);
    check_value(&m, "glim:denoised", NULL);
    p.stopped_by = RENDER_LIMIT_ERROR;
    m = render_metadata(&p, "b.obj", 0, false);
    check_value(&m, "glim:stopped_by", "error");
    p.stopped_by = RENDER_LIMIT_NONE;
    m = render_metadata(&p, "b.obj", 0, false);
    check_value(&m, "glim:stopped_by", NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_render),
        cmocka_unit_test(unknown_values_are_left_out),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
