// SPDX-License-Identifier: MIT
/*
 * extremes - random scenes of extreme numbers
 *
 * usage: extremes [COUNT [FIRST]]
 *
 * Every EACH_DEVICE-th scene is also rendered on the device.
 */
#include "extremes.h"
#include "rows.h"
#include "tests/unit/folder.h"

#define SCENES      10000
#define EACH_DEVICE 10

int main(int argc, char **argv)
{
    uint32_t count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : SCENES;
    uint32_t first = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    struct extremes x;
    uint32_t bad = 0;

    if (enter_folder(NULL) != 0)
        return 2;
    extremes_open(&x, true);
    for (uint32_t i = first; i < first + count; i++)
        bad += !extremes_check(&x, i, i % EACH_DEVICE == 0);
    row(bad == 0 && x.refused < count / 2, "M8",
        "%u random scenes of extreme numbers, %u on the device as well, %u "
        "refused, %llu of %llu samples saturated: %u with samples that are "
        "not finite or other bits, want 0",
        x.scenes, x.on_device, x.refused, (unsigned long long)x.saturated,
        (unsigned long long)x.samples, bad);
    extremes_close(&x);
    if (leave_empty_folder(NULL) != 0)
        return 2;
    return rows_status();
}
