// SPDX-License-Identifier: MIT
/*
 * test_live_render.c - live and normal mode with a renderer: starting,
 * halting and saving
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "read/view_file.h"
#include "session/save.h"
#include "kernels/rng.h"

static const char *const names[] = {"s.obj",   "s.view", "s.png",
                                    "s-2.png", "s.ans",  "s-2.ans"};

static int leave(void **state)
{
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return leave_empty_folder(state);
}

struct fixture {
    struct options options;
    struct session session;
    struct live_render control;
};

static int open_work(void **state)
{
    static struct fixture f;
    struct error err;
    FILE *to = fopen("s.obj", "w");

    unlink("s.view");
    unlink("s.png");
    unlink("s-2.png");
    if (!to || fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", to) < 0 ||
        fclose(to) != 0)
        return -1;
    f.options = (struct options){.scene_path = "s.obj",
                                 .width_px = 32,
                                 .height_px = 16,
                                 .spp = 3,
                                 .max_bounces = -1,
                                 .thread_count = 1};
    *state = &f;
    if (!session_open(&f.session, &f.options, clock_ns(), &err) ||
        !live_render_init(&f.control, &f.session, &err)) {
        print_error("%s\n", err.text);
        return -1;
    }
    return 0;
}

static int close_work(void **state)
{
    struct fixture *f = *state;

    live_render_free(&f->control);
    session_close(&f->session);
    return 0;
}

/* Polls until the render has ended, for at most ten seconds. */
static void run_to_end(struct live_render *w)
{
    assert_true(render_wait(w->session->engine.render, 10000));
    live_render_update(w);
}

static void render_whole(struct live_render *w)
{
    live_render_set_live(w, false);
    live_render_start_or_halt(w);
    run_to_end(w);
}

static void live_mode_has_nothing_to_lose(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    assert_true(w->is_live);
    assert_int_equal(w->progress.spp_limit, 0);
    while (live_render_awaits_picture(w))
        live_render_update(w);
    assert_false(live_render_has_unsaved(w));
    assert_true(live_render_need_live(w, "the camera moves"));
}

/* Moves the camera very little. */
static void move(struct live_render *w)
{
    struct edit *e = &w->session->edit;
    struct pose pose = e->now.view.pose;

    pose.eye[0] += 1e-6;
    edit_pose(e, &pose);
}

static void moving_restarts_the_render(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    uint64_t before_ns = w->restarted_ns;

    move(w);
    while (live_render_is_outdated(w)) /* after the first picture */
        live_render_update(w);
    assert_true(w->restarted_ns > before_ns);
    assert_int_equal(w->progress.state, RENDER_RUNNING);
}

/* A camera that never rests still shows pictures: after each there is time to
 * show it. */
static void moving_shows_pictures(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    for (int i = 0; i < 20; i++) {
        uint64_t before_ns = w->restarted_ns;

        move(w);
        /* It may have arrived by now. */
        while (live_render_awaits_picture(w)) {
            live_render_update(w);
            assert_int_equal(w->restarted_ns, before_ns);
            assert_true(live_render_is_outdated(w));
        }
        live_render_update(w);
        assert_int_not_equal(w->restarted_ns, before_ns);
    }
}

/* In live mode the draft comes first and is not counted. Normal mode has no
 * draft. */
static void drafts_are_live(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    struct render *render = w->session->engine.render;

    w->session->draft_width = 20;
    w->session->draft_height = 12;
    live_render_set_live(w, true);
    while (w->progress.samples == 0)
        live_render_update(w);
    assert_int_equal(w->progress.draft_samples, DRAFT_HALVES_SPP * 20 * 12);
    live_render_set_live(w, false);
    live_render_start_or_halt(w);
    assert_null(render_draft(render));
    run_to_end(w);
    assert_int_equal(w->progress.draft_samples, 0);
    assert_int_equal(w->progress.samples, 3 * 32 * 16);
}

static void normal_mode_renders_to_its_end(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    live_render_set_live(w, false);
    run_to_end(w);
    assert_int_equal(w->progress.state, RENDER_IDLE);
    assert_false(live_render_need_live(w, "the camera moves"));
    assert_false(live_render_has_unsaved(w)); /* nothing has begun */
    live_render_start_or_halt(w);
    run_to_end(w);
    assert_int_equal(w->progress.state, RENDER_DONE);
    assert_int_equal(w->progress.spp_done, 3);
    assert_int_equal(w->progress.samples, 3 * 32 * 16);
    assert_true(live_render_has_unsaved(w));
    live_render_start_or_halt(w); /* Enter at the end loses nothing */
    live_render_update(w);
    assert_int_equal(w->progress.state, RENDER_DONE);
    live_render_set_live(w, true);
    assert_false(live_render_has_unsaved(w));
    assert_int_equal(w->progress.spp_limit, 0);
}

static void halted_renders_go_on(void **state)
{
    struct fixture *f = *state;
    struct live_render *w = &f->control;

    f->options.spp = 1000000;
    live_render_set_live(w, false);
    live_render_start_or_halt(w);
    while (live_render_awaits_picture(w))
        live_render_update(w);
    live_render_start_or_halt(w);
    assert_true(w->is_halted);
    assert_int_equal(w->progress.state, RENDER_IDLE);
    assert_true(live_render_has_unsaved(w));
    uint64_t samples = w->progress.samples;
    live_render_start_or_halt(w);
    assert_false(w->is_halted);
    while (w->progress.samples <= samples)
        live_render_update(w);
    assert_int_equal(w->progress.state, RENDER_RUNNING);
}

static void live_mode_pauses(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    uint64_t samples;

    while (live_render_awaits_picture(w))
        live_render_update(w);
    live_render_start_or_halt(w);
    assert_true(w->is_halted);
    assert_int_equal(w->progress.state, RENDER_IDLE);
    samples = w->progress.samples;
    live_render_start_or_halt(w);
    assert_false(w->is_halted);
    while (w->progress.samples <= samples)
        live_render_update(w);
    assert_int_equal(w->progress.spp_limit, 0);
    live_render_start_or_halt(w);
    move(w); /* a change resumes the render */
    live_render_update(w);
    assert_false(w->is_halted);
    assert_int_equal(w->progress.state, RENDER_RUNNING);
}

static void steps_are_one_sample_each(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    live_render_set_live(w, false);
    for (uint64_t spp = 1; spp <= 2; spp++) {
        live_render_step(w);
        run_to_end(w);
        assert_true(w->is_halted);
        assert_int_equal(w->progress.state, RENDER_IDLE);
        assert_int_equal(w->progress.spp_done, spp);
        assert_int_equal(w->progress.samples, spp * 32 * 16);
    }
    live_render_step(w); /* the last of -s 3 */
    run_to_end(w);
    assert_int_equal(w->progress.state, RENDER_DONE);
    assert_int_equal(w->progress.samples, 3 * 32 * 16);
    live_render_step(w); /* there is no more */
    run_to_end(w);
    assert_int_equal(w->progress.samples, 3 * 32 * 16);
    live_render_restart(w);
    run_to_end(w);
    assert_int_equal(w->progress.state, RENDER_DONE);
    assert_int_equal(w->progress.samples, 3 * 32 * 16);
}

/* A halted pass leaves pixels with unequal numbers of samples. Steps add to
 * those with the fewest, and all end with the same picture. */
static void steps_after_a_halt_make_the_same_picture(void **state)
{
    struct fixture *f = *state;
    struct live_render *w = &f->control;
    float whole[32 * 16 * 3], stepped[32 * 16 * 3];

    f->options.spp = 40;
    render_whole(w);
    assert_int_equal(w->progress.spp_done, 40);
    film_linear(render_film(w->session->engine.render), whole);
    live_render_restart(w);
    for (int i = 0; i < 10000 && w->progress.state != RENDER_DONE; i++) {
        live_render_step(w);          /* halts the render */
        live_render_start_or_halt(w); /* halts the step */
        if (w->progress.state == RENDER_IDLE)
            live_render_start_or_halt(w);
        render_wait(w->session->engine.render, 1); /* part of a pass */
        live_render_update(w);
    }
    run_to_end(w);
    assert_int_equal(w->progress.samples, 40 * 32 * 16);
    film_linear(render_film(w->session->engine.render), stepped);
    assert_memory_equal(whole, stepped, sizeof whole);
}

static void saving_never_replaces_files(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    render_whole(w);
    for (int i = 0; i < 2; i++) {
        save_picture(w, "png");
        background_wait_copied(&w->saver.copying);
        assert_true(save_finish(w));
    }
    assert_int_equal(access("s.png", F_OK), 0);
    assert_int_equal(access("s-2.png", F_OK), 0);
    assert_int_equal(w->result_count, 2);
    assert_string_equal(w->results[0],
                        "saved s.png 32x16, 3 spp, with its noise");
    assert_string_equal(w->message.text,
                        "saved s-2.png 32x16, 3 spp, with its noise");
    assert_false(live_render_has_unsaved(w));
}

/* The saved picture is that at the time of the key, whatever follows. */
static void saving_takes_a_copy(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    char first[65536], second[65536];
    size_t sizes[2];

    render_whole(w);
    save_picture(w, "png");
    assert_true(save_finish(w));
    save_picture(w, "png");
    for (int i = 0; i < 3; i++)
        w->session->edit.now.view.pose.eye[i] += 5; /* another picture */
    live_render_set_live(w, true);
    assert_true(save_finish(w));
    FILE *a = fopen("s.png", "rb");
    FILE *b = fopen("s-2.png", "rb");
    assert_true(a && b);
    sizes[0] = fread(first, 1, sizeof first, a);
    sizes[1] = fread(second, 1, sizeof second, b);
    fclose(a);
    fclose(b);
    assert_true(sizes[0] > 60 && sizes[0] == sizes[1]);
    assert_memory_equal(first, second, sizes[0]);
}

/* The message has the size of the saved picture, even if the size changes
 * meanwhile. */
static void message_describes_the_saved_picture(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    render_whole(w);
    save_picture(w, "png");
    background_wait_copied(&w->saver.copying);
    w->session->engine.crop.width = 20;
    live_render_set_live(w, true);
    assert_true(save_finish(w));
    assert_string_equal(w->results[0],
                        "saved s.png 32x16, 3 spp, with its noise");
}

/* This holds even before the first poll. */
static void new_pictures_are_unsaved(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    live_render_set_live(w, false);
    live_render_start_or_halt(w);
    assert_true(render_wait(w->session->engine.render, 10000));
    assert_true(live_render_has_unsaved(w));
}

/* The loading thread may have read the old file, and the camera would return to
 * it. */
static void no_view_is_written_during_a_reload(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    live_render_reload(w);
    w->session->edit.now.view.pose.eye[0] = 7;
    save_view(w);
    assert_int_equal(access("s.view", F_OK), -1);
    assert_true(live_render_end_reload(w));
    assert_true(w->session->edit.now.view.pose.eye[0] == 7);
    save_view(w);
    assert_int_equal(access("s.view", F_OK), 0);
}

/* An error that appears while a person types stays after the next key. */
static void errors_stay_visible(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;

    live_render_say_error(w, "broken");
    assert_true(w->message.until_ns == UINT64_MAX);
    live_render_acknowledge_error(w);
    assert_string_equal(w->message.text, "broken");
    check_close((double)(w->message.until_ns - w->message.said_ns), 4e9, 1);
    live_render_acknowledge_error(w);
    check_close((double)(w->message.until_ns - w->message.said_ns), 4e9, 1);
}

/* A person reads 200 words of six characters per minute: 50 ms per
 * character. */
static void long_messages_can_be_read(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    struct message *m = &w->message;
    char text[201] = "";

    live_render_say(w, "short");
    check_close((double)(m->until_ns - m->said_ns), 4e9, 1);
    memset(text, 'a', sizeof text - 1);
    live_render_say(w, "%s", text);
    assert_true(m->until_ns - m->said_ns >= 200 * UINT64_C(50000000));
    live_render_say_error(w, text);
    live_render_acknowledge_error(w);
    assert_true(m->until_ns - m->said_ns >= 200 * UINT64_C(50000000));
}

static void failures_are_messages(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    static char path[] = "no-such-folder-of-glim/s.view";

    free(w->session->engine.view_path);
    w->session->engine.view_path = strdup(path);
    save_view(w);
    assert_true(w->message.is_error);
    assert_non_null(strstr(w->message.text, "no-such-folder-of-glim"));
    assert_int_equal(w->result_count, 0);
}

static void views_are_written(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    struct warnings report = {0};
    struct view back;
    struct error err;

    w->session->edit.now.view.pose.eye[0] = 1.0 / 3;
    save_view(w);
    assert_string_equal(w->message.text, "wrote the view to s.view");
    view_init(&back);
    assert_true(view_read(&back, "s.view", &report, &err));
    assert_true(back.pose.eye[0] == 1.0 / 3);
    view_free(&back);
    warnings_free(&report);
}

/* Each text has a new name. A picture of normal mode remains unsaved. */
static void texts_are_written(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    struct ansi_text_style style = {8, 2, PALETTE_MONO, GLYPHS_HALF};
    struct frame frame;
    struct error err;

    assert_true(ansi_text_frame_init(&frame, &style, &err));
    render_whole(w);
    save_text(w, &frame, &style);
    assert_true(save_finish(w));
    assert_string_equal(w->message.text, "saved s.ans, text of 8x2 characters");
    save_text(w, &frame, &style);
    assert_true(save_finish(w));
    assert_string_equal(w->message.text,
                        "saved s-2.ans, text of 8x2 characters");
    frame_free(&frame);
    assert_int_equal(w->result_count, 2);
    assert_true(live_render_has_unsaved(w));
    for (size_t i = 5; i < sizeof names / sizeof names[0]; i++) {
        FILE *in = fopen(names[i], "r");
        char line[32];

        assert_non_null(in);
        for (int row = 0; row < 2; row++) {
            assert_non_null(fgets(line, sizeof line, in));
            assert_int_equal(strcspn(line, "\n"), 8);
        }
        assert_null(fgets(line, sizeof line, in));
        fclose(in);
    }
}

/* The message names the key that a person gave to the mode. */
static void messages_name_the_chosen_keys(void **state)
{
    struct fixture *f = *state;
    const int chosen[KEYMAP_MAX] = {'j'};

    keymap_choose(&f->options.keys, ACTION_MODE, chosen);
    keymap_settle(&f->options.keys, false);
    live_render_set_live(&f->control, false);
    assert_false(live_render_need_live(&f->control, "the camera moves"));
    assert_string_equal(f->control.message.text,
                        "the camera moves only in live mode: j switches to it");
    live_render_restart(&f->control);
    assert_string_equal(f->control.message.text,
                        "nothing is rendered yet: Enter starts");
}

/* A new draft keeps the samples, and those of a picture before a move of the
 * camera are gone. */
static void new_drafts_keep_the_samples(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    uint64_t samples;

    w->session->draft_width = 20;
    w->session->draft_height = 12;
    live_render_set_live(w, true);
    while (w->progress.spp_done < FILM_YOUNG_SPP)
        live_render_update(w);
    w->has_gone_on = true;
    for (int i = 0; i < 6; i++) {
        samples = w->progress.samples;
        w->session->sample = i % 2 == 0 ? SAMPLE_NORMAL : SAMPLE_LIGHT;
        w->session->draft_width = 10 + i;
        live_render_renew_draft(w);
        assert_true(w->progress.samples >= samples);
        assert_true(w->has_gone_on);
        if (i % 2 == 0) /* numbers are shown, however old the film is */
            assert_non_null(render_draft(w->session->engine.render));
        while (live_render_awaits_picture(w))
            live_render_update(w);
        assert_true(w->progress.samples >= samples);
    }
    samples = w->progress.samples;
    while (w->progress.samples == samples)
        live_render_update(w);
    render_halt(w->session->engine.render);
    samples = render_progress(w->session->engine.render).samples;
    move(w);
    w->session->sample = SAMPLE_NORMAL; /* whose film stays empty */
    live_render_renew_draft(w);
    assert_true(samples > 0);
    assert_int_equal(w->progress.samples, 0);
    w->session->sample = SAMPLE_LIGHT;
}

/* A picture that rests gets a fine draft when its film has as many samples as
 * that. Until it is whole, also if it begins several times, the draft before is
 * shown, and a move shows neither. */
static void fine_drafts_follow_small_ones(void **state)
{
    struct live_render *w = &((struct fixture *)*state)->control;
    struct session *s = w->session;
    struct render *render = s->engine.render;

    s->is_filtered = true;
    s->draft_width = 8;
    s->draft_height = 4;
    s->fine_width = 24;
    s->fine_height = 12;
    live_render_set_live(w, true);
    assert_false(live_render_wants_fine_draft(w));
    while (!live_render_wants_fine_draft(w))
        live_render_update(w);
    assert_true(live_render_rests(w));
    assert_true(w->progress.samples >= 5 * 24 * 12);
    s->fine_width = 1 << 26; /* more samples than the film has */
    assert_false(live_render_wants_fine_draft(w));
    s->fine_width = 24;
    assert_int_equal(render_surfaces(render)->width, 8);
    for (int i = 0; i < 3; i++) {
        live_render_renew_draft(w);
        assert_true(s->draft_is_fine);
        assert_true(live_render_rests(w));
        assert_non_null(render_surfaces(render));
    }
    while (render_surfaces(render)->width == 8)
        assert_true(film_count(render_surfaces(render), 0, 0) > 0);
    assert_int_equal(render_surfaces(render)->width, 24);
    assert_int_equal(render_surfaces(render)->height, 12);
    assert_true(film_count(render_surfaces(render), 23, 11) > 0);
    move(w);
    live_render_restart_if_outdated(w);
    assert_false(live_render_rests(w));
    assert_false(s->draft_is_fine);
    assert_true(render_surfaces(render) == NULL ||
                render_surfaces(render)->width == 8);
}

int main(void)
{
#define WORK_TEST(f) cmocka_unit_test_setup_teardown(f, open_work, close_work)
    const struct CMUnitTest tests[] = {
        WORK_TEST(live_mode_has_nothing_to_lose),
        WORK_TEST(moving_restarts_the_render),
        WORK_TEST(moving_shows_pictures),
        WORK_TEST(drafts_are_live),
        WORK_TEST(new_drafts_keep_the_samples),
        WORK_TEST(fine_drafts_follow_small_ones),
        WORK_TEST(normal_mode_renders_to_its_end),
        WORK_TEST(halted_renders_go_on),
        WORK_TEST(live_mode_pauses),
        WORK_TEST(steps_are_one_sample_each),
        WORK_TEST(steps_after_a_halt_make_the_same_picture),
        WORK_TEST(saving_never_replaces_files),
        WORK_TEST(saving_takes_a_copy),
        WORK_TEST(message_describes_the_saved_picture),
        WORK_TEST(new_pictures_are_unsaved),
        WORK_TEST(no_view_is_written_during_a_reload),
        WORK_TEST(errors_stay_visible),
        WORK_TEST(long_messages_can_be_read),
        WORK_TEST(failures_are_messages),
        WORK_TEST(views_are_written),
        WORK_TEST(texts_are_written),
        WORK_TEST(messages_name_the_chosen_keys),
    };

    return cmocka_run_group_tests(tests, enter_folder, leave);
}
