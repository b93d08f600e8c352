// SPDX-License-Identifier: MIT
/*
 * View files: what was read is written to a new file and over the old one, and
 * read again from both. All three views are equal.
 */
#include "fuzz.h"
#include "mutate_text.h"
#include "read/view_file.h"

static int is_same_text(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

static int is_same3(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int is_same_pose(const struct pose *a, const struct pose *b)
{
    return is_same3(a->eye, b->eye) && is_same3(a->at, b->at) &&
           is_same3(a->up, b->up) && a->fovy_deg == b->fovy_deg &&
           a->aperture == b->aperture && a->focus == b->focus;
}

static void check_shots(const struct view *a, const struct view *b)
{
    for (int i = 0; i < VIEW_SHOTS; i++) {
        require(a->has_shot[i] == b->has_shot[i], "a numbered view");
        require(!a->has_shot[i] || is_same_pose(&a->shots[i], &b->shots[i]),
                "a numbered view");
    }
}

static void check_assigns(const struct assigns *a, const struct assigns *b)
{
    require(a->count == b->count, "assignments");
    for (size_t i = 0; i < a->count; i++) {
        require(is_same_text(a->items[i].object, b->items[i].object),
                a->items[i].object);
        require(is_same_text(a->items[i].material, b->items[i].material),
                a->items[i].material);
    }
}

/* Compares names of files, which may have different paths. */
static void check_sky(const char *a, const char *b)
{
    char *names[2];

    require((a == NULL) == (b == NULL), "a sky");
    if (a == NULL)
        return;
    names[0] = path_seen_from(fuzz_folder(), a);
    names[1] = path_seen_from(fuzz_folder(), b);
    require(is_same_text(names[0], names[1]), names[0]);
    free(names[0]);
    free(names[1]);
}

static void check_smokes(const struct smokes *a, const struct smokes *b)
{
    require(a->count == b->count, "media");
    for (uint32_t i = 0; i < a->count; i++) {
        const struct smoke *x = &a->items[i], *y = &b->items[i];

        check_sky(x->path, y->path);
        require(is_same_text(x->grid, y->grid), x->grid);
        require(is_same_text(x->temperature, y->temperature), x->temperature);
        require(memcmp(&x->numbers, &y->numbers, sizeof x->numbers) == 0 &&
                    x->up_is_z == y->up_is_z,
                "numbers of a medium");
    }
}

static void check_same(const struct view *a, const struct view *b)
{
    require(a->has_camera == b->has_camera, "a camera");
    require(is_same_pose(&a->pose, &b->pose), "the camera");
    require(a->has_size == b->has_size && a->width_px == b->width_px &&
                a->height_px == b->height_px,
            "size");
    require(a->lighting.has_background == b->lighting.has_background &&
                is_same3(a->lighting.background, b->lighting.background),
            "background");
    require(a->max_bounces == b->max_bounces, "bounces");
    check_sky(a->lighting.sky_path, b->lighting.sky_path);
    require(a->lighting.sky_strength == b->lighting.sky_strength &&
                a->lighting.sky_rotation_deg == b->lighting.sky_rotation_deg &&
                sun_has_same_sky(&a->lighting.sun, &b->lighting.sun) &&
                a->lighting.sun.azimuth_deg == b->lighting.sun.azimuth_deg,
            "sky");
    require(memcmp(&a->lighting.fog, &b->lighting.fog,
                   sizeof a->lighting.fog) == 0,
            "fog");
    require(a->lighting.exposure == b->lighting.exposure &&
                a->lighting.tone == b->lighting.tone,
            "exposure");
    check_shots(a, b);
    check_assigns(&a->assigns, &b->assigns);
    require(lamps_equal(&a->lamps, &b->lamps), "lamps");
    check_smokes(&a->smokes, &b->smokes);
}

/* Returns whether the file could be read. Its warnings must be valid
 * messages. */
static int read_view(struct view *view, const char *path, struct error *err)
{
    struct warnings report = {0};
    int ok;

    view_init(view);
    ok = view_read(view, path, &report, err);
    fuzz_check_report(&report);
    warnings_free(&report);
    if (!ok)
        fuzz_check_message(err->text);
    return ok;
}

static void check_written(const struct view *view, const char *path)
{
    struct file_change change;
    struct error err = {""};
    struct view back;

    require(view_write(view, path, &change, &err), err.text);
    require(read_view(&back, path, &err), err.text);
    check_same(view, &back);
    view_free(&back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *path = fuzz_put("a.view", data, size);
    char *other = fuzz_put("b.view", NULL, 0);
    struct error err;
    struct view view;

    if (read_view(&view, path, &err)) {
        check_written(&view, other);
        check_written(&view, path);
    }
    view_free(&view);
    free(path);
    free(other);
    return 0;
}
