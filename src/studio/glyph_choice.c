// SPDX-License-Identifier: MIT
#include "studio/glyph_choice.h"

#include "base/clock.h"
#include "session/state_list.h"

/* A terminal that has not answered within this time shows no pixels. */
#define LACK_NS UINT64_C(1000000000)

void glyph_choice_init(struct glyph_choice *g, struct live_render *control,
                       struct screen *screen)
{
    *g = (struct glyph_choice){.control = control,
                               .screen = screen,
                               .lack_ns = clock_ns() + LACK_NS};
}

/* Returns true while the message is shown that the last change of the glyphs
 * can be taken back. */
static bool may_take_back(const struct glyph_choice *g)
{
    uint64_t until_ns = g->control->message.until_ns;

    return until_ns != 0 && until_ns == g->until_ns;
}

static void remember(const struct term_caps *display)
{
    glyph_memory_write(display->name, display->glyph_mode);
}

void glyph_choice_next(struct glyph_choice *g)
{
    struct term_caps *display = &g->screen->display;

    if (!may_take_back(g))
        g->before = display->glyph_mode;
    term_caps_next_glyphs(display);
    remember(display);
}

bool glyph_choice_take_back(struct glyph_choice *g)
{
    struct term_caps *display = &g->screen->display;

    if (!may_take_back(g))
        return false;
    term_caps_use_glyphs(display, g->before);
    remember(display);
    return true;
}

void glyph_choice_say(struct glyph_choice *g)
{
    const char *name = screen_glyphs_name(g->screen);

    if (g->screen->display.glyph_mode == g->before) {
        live_render_say(g->control, "%s again", name);
        return;
    }
    live_render_say(g->control, "%s from now on; %s goes back", name,
                    live_render_key(g->control, ACTION_CANCEL).text);
    g->until_ns = g->control->message.until_ns;
}

bool glyph_choice_recall(struct glyph_choice *g)
{
    struct term_caps *display = &g->screen->display;
    enum glyph_mode mode = glyph_memory_read(display->name);

    return !g->control->session->options->display.has_glyph &&
           mode != display->glyph_mode && term_caps_use_glyphs(display, mode);
}

void glyph_choice_say_lack(struct glyph_choice *g, uint64_t now_ns)
{
    const char *lack = term_caps_lack(&g->screen->display);
    bool is_known = (g->screen->has_all_answers && !tty_is_in_tmux()) ||
                    now_ns >= g->lack_ns;

    if (g->lack_ns == 0 || !is_known || g->control->message.until_ns != 0)
        return;
    g->lack_ns = 0;
    if (tty_is_in_tmux() && !g->has_asked_again) {
        g->has_asked_again = true;
        g->lack_ns = now_ns + LACK_NS;
        tty_ask_through_tmux();
        return;
    }
    if (lack && g->screen->graphics.shape.kind == PIXEL_GRAPHICS_NONE)
        live_render_say(g->control, "%s: %s", screen_glyphs_name(g->screen),
                        lack);
}
