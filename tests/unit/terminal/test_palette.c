// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "terminal/theme.h"

static void palette_follows_the_environment(void **state)
{
    static const struct {
        struct palette_facts facts;
        enum palette palette;
        bool is_final;
    } cases[] = {
        {{.term = "xterm-256color", .colors = 256}, PALETTE_256, false},
        {{.term = "xterm-256color", .colors = 256, .colorterm = "truecolor"},
         PALETTE_24BIT,
         false},
        {{.term = "xterm", .colors = 8, .colorterm = "24bit"},
         PALETTE_24BIT,
         false},
        {{.term = "xterm", .colors = 8, .colorterm = "yes"}, PALETTE_16, false},
        {{.term = "xterm-direct", .colors = 1 << 24}, PALETTE_24BIT, false},
        {{.term = "foot", .colors = 256, .has_rgb = true},
         PALETTE_24BIT,
         false},
        {{.term = "vt100", .colors = -1}, PALETTE_MONO, false},
        {{.term = "linux", .colors = 8, .colorterm = "truecolor"},
         PALETTE_16,
         true},
        /* The program screen cannot pass 24 bits, whatever COLORTERM says. */
        {{.term = "screen", .colors = 8, .colorterm = "truecolor"},
         PALETTE_256,
         true},
        {{.term = "xterm-256color",
          .colors = 256,
          .sty = "1.pts",
          .colorterm = "truecolor"},
         PALETTE_256,
         true},
        /* tmux also calls itself screen, but it passes 24 bits. */
        {{.term = "screen-256color", .colors = 256, .tmux = "/tmp/x"},
         PALETTE_24BIT,
         false},
        {{.term = "xterm-256color",
          .colors = 256,
          .colorterm = "truecolor",
          .no_color = "1"},
         PALETTE_MONO,
         true},
        {{.term = "xterm-256color", .colors = 256, .no_color = ""},
         PALETTE_256,
         false},
        {{.term = NULL, .colors = 256}, PALETTE_256, false},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        bool is_final;

        assert_int_equal(palette_guess(&cases[i].facts, &is_final),
                         cases[i].palette);
        assert_int_equal(is_final, cases[i].is_final);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(palette_follows_the_environment),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
