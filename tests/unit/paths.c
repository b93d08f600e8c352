// SPDX-License-Identifier: MIT
#include "tests/unit/paths.h"

#include "render/path_stream.h"

struct path_sample trace_path(const struct world *w, struct ray r,
                              struct sampler sampler,
                              struct first_surface *surface)
{
    return path_trace(w, (struct camera_sample){r, sampler, 0}, surface);
}

void trace_samples(const struct world *w, const struct sample_id *places,
                   uint32_t count, struct path_sample *out,
                   struct first_surface *surfaces)
{
    path_samples(w, places, count, out, surfaces, NULL);
}
