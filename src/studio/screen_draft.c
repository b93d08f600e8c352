// SPDX-License-Identifier: MIT
#include "studio/screen_draft.h"

#include "filter/screen_filter.h"

/* A cell of half blocks shows two pixels, one above the other. */
void screen_draft_expect(struct session *s, const struct cells_rect *fit)
{
    s->draft_width = fit->cols;
    s->draft_height = 2 * fit->rows;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Returns true if the draft has the size that the next one will have. */
static bool is_current(const struct session *s, const struct film *draft)
{
    return draft->width == smaller(s->draft_width, s->engine.crop.width) &&
           draft->height == smaller(s->draft_height, s->engine.crop.height);
}

void screen_draft_fit(struct render_control *control,
                      const struct screen *screen)
{
    struct session *s = control->session;
    const struct film *young = render_draft(s->engine.render);

    screen_draft_expect(s, &screen->fit);
    if (s->is_filtered)
        screen_filter_draft_size(screen->frame_width, screen->frame_height,
                                 &s->draft_width, &s->draft_height);
    if (control->is_live && !control->is_halted && s->draft_has_surfaces &&
        young && !screen->is_too_small && !is_current(s, young))
        render_control_restart(control);
}
