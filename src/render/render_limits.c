// SPDX-License-Identifier: MIT
#include "render/render_limits.h"

enum render_limit render_limits_at(const struct render_limits *limits,
                                   uint64_t spp_done,
                                   const struct film_error *error)
{
    if (limits->error > 0 && spp_done >= RENDER_ERROR_SPP_MIN &&
        error->is_known && error->high <= limits->error)
        return RENDER_LIMIT_ERROR;
    return limits->spp != 0 && spp_done >= limits->spp ? RENDER_LIMIT_SPP
                                                       : RENDER_LIMIT_NONE;
}
