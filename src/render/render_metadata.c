// SPDX-License-Identifier: MIT
#include "render/render_metadata.h"

#include <inttypes.h>

#include "base/file.h"
#include "glim/version.h"

struct image_metadata render_metadata(const struct render_progress *p,
                                      const char *scene_path, uint32_t seed)
{
    struct image_metadata m = {.count = 0};

    image_metadata_add(&m, IMAGE_KEY_SOFTWARE, "glim %s", GLIM_VERSION);
    image_metadata_add(&m, "glim:scene", "%s", path_name(scene_path));
    image_metadata_add(&m, "glim:seed", "%" PRIu32, seed);
    image_metadata_add(&m, "glim:spp", "%" PRIu64, p->spp_done);
    return m;
}
