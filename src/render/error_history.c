// SPDX-License-Identifier: MIT
#include "render/error_history.h"

#define GROWTH 1.1

void error_history_update(struct error_history *h,
                          const struct render_progress *p)
{
    double time_s = (double)p->render_ns * 1e-9;
    double error = p->film_error.error;

    if (h->count > 0 && time_s < h->points[h->count - 1].time_s)
        h->count = 0;
    if (!p->film_error.is_known || !(error > 0) ||
        h->count == ERROR_HISTORY_MAX)
        return;
    /* an error belongs to the end of its pass */
    if (h->count > 0 && (time_s < GROWTH * h->points[h->count - 1].time_s ||
                         !(error < h->points[h->count - 1].error ||
                           error > h->points[h->count - 1].error)))
        return;
    h->points[h->count++] = (struct error_then){time_s, error};
}
