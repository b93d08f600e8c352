// SPDX-License-Identifier: MIT
/*
 * test_autosave.c - a session that is lost is offered to the next one,
 * which goes on with its edits and its film, or says why not
 */
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "base/clock.h"
#include "film/film_file.h"
#include "session/keymap.h"
#include "studio/autosave.h"

#include "tests/unit/files.h"

/* A session with all that a autosave needs. */
struct work {
    struct options options;
    struct session session;
    struct live_render control;
    struct screen screen;
    struct camera_control camera;
    struct autosave autosave;
};

static void begin(struct work *w)
{
    struct error err;

    memset(w, 0, sizeof *w);
    options_init(&w->options);
    keymap_settle(&w->options.keys, false);
    w->options.scene_path = "s.obj";
    w->options.width_px = 32;
    w->options.height_px = 16;
    w->options.spp = 3;
    w->options.thread_count = 1;
    check_or_say(session_open(&w->session, &w->options, clock_ns(), &err),
                 err.text);
    check_or_say(live_render_init(&w->control, &w->session, &err), err.text);
    camera_control_init(&w->camera, &w->control, &w->screen);
    autosave_init(&w->autosave, &w->control, &w->camera);
}

static void end(struct work *w, bool is_lost)
{
    render_halt(w->session.engine.render);
    autosave_end(&w->autosave, is_lost);
    autosave_free(&w->autosave);
    live_render_free(&w->control);
    session_close(&w->session);
}

static void set_exposure(struct work *w, double exposure)
{
    struct lighting light = w->session.edit.now.view.lighting;

    light.exposure = exposure;
    edit_lighting(&w->session.edit, &light);
}

static double exposure(const struct work *w)
{
    return w->session.edit.now.view.lighting.exposure;
}

/* The linker sends calls of clock_ns() here (--wrap in tests.mk). */
static _Atomic uint64_t clock_ahead_ns;

uint64_t __real_clock_ns(void);
uint64_t __wrap_clock_ns(void);
uint64_t __wrap_clock_ns(void)
{
    return __real_clock_ns() + clock_ahead_ns;
}

/* Renders until a film is worth keeping: some samples, and then the clock goes
 * on. */
static void render_a_while(struct work *w)
{
    do {
        render_wait(w->session.engine.render, 100);
        live_render_update(&w->control);
    } while (w->control.progress.spp_done == 0);
    clock_ahead_ns += UINT64_C(5100000000);
}

static int count_sessions(void)
{
    return count_files("state/glim/sessions") - 1; /* the lock */
}

static void quick_sessions_are_not_kept(void **state)
{
    struct work w;

    (void)state;
    begin(&w);
    assert_null(w.autosave.offer_path);
    end(&w, true);
    assert_int_equal(count_sessions(), 0);
}

static void edits_are_kept_until_they_are_dropped(void **state)
{
    struct work w;

    (void)state;
    begin(&w);
    set_exposure(&w, 1);
    edit_end_step(&w.session.edit);
    set_exposure(&w, 1.5);
    end(&w, true);
    assert_int_equal(count_sessions(), 1);
    begin(&w);
    assert_non_null(w.autosave.offer_path);
    assert_string_equal(w.control.message.text,
                        "kept: unsaved changes; ^R goes on with it");
    end(&w, false); /* neither taken nor dropped */
    begin(&w);
    assert_non_null(w.autosave.offer_path);
    autosave_go_on(&w.autosave);
    check_close(exposure(&w), 1.5, 0);
    assert_null(w.autosave.offer_path);
    /* with its history */
    assert_non_null(edit_undo(&w.session.edit));
    check_close(exposure(&w), 1, 0);
    assert_non_null(edit_redo(&w.session.edit));
    end(&w, true);
    begin(&w);
    assert_non_null(w.autosave.offer_path);
    autosave_drop(&w.autosave);
    assert_int_equal(count_sessions(), 0);
    check_close(exposure(&w), 0, 0);
    end(&w, false);
    assert_int_equal(count_sessions(), 0);
}

/* A session whose edits are lost while another one is offered: both are kept,
 * and the last one is offered first. */
static void offers_are_set_aside(void **state)
{
    struct work w;

    (void)state;
    for (int i = 1; i <= 2; i++) {
        begin(&w);
        set_exposure(&w, i);
        end(&w, true);
        assert_int_equal(count_sessions(), i);
    }
    begin(&w);
    autosave_go_on(&w.autosave);
    check_close(exposure(&w), 2, 0);
    assert_non_null(w.autosave.offer_path);
    end(&w, true);
    assert_int_equal(count_sessions(), 2);
    begin(&w);
    autosave_drop(&w.autosave);
    assert_int_equal(count_sessions(), 1);
    autosave_go_on(&w.autosave);
    check_close(exposure(&w), 1, 0);
    assert_null(w.autosave.offer_path);
    end(&w, true); /* under the first name now */
    assert_int_equal(count_sessions(), 1);
    begin(&w);
    check_close(exposure(&w), 0, 0);
    autosave_go_on(&w.autosave);
    check_close(exposure(&w), 1, 0);
    end(&w, false);
    assert_int_equal(count_sessions(), 0);
}

/* A change sets the timer to its file, once. */
static void changes_are_written_at_once(void **state)
{
    struct itimerspec left;
    struct work w;

    (void)state;
    begin(&w);
    autosave_note_changes(&w.autosave);
    assert_int_equal(timerfd_gettime(w.autosave.timer_fd, &left), 0);
    assert_in_range(left.it_value.tv_sec, 1, 10);
    set_exposure(&w, 1);
    autosave_note_changes(&w.autosave);
    assert_int_equal(timerfd_gettime(w.autosave.timer_fd, &left), 0);
    assert_int_equal(left.it_value.tv_sec, 0);
    /* writing it is no change */
    usleep(300000);
    autosave_write(&w.autosave);
    assert_false(w.autosave.is_hurried);
    autosave_note_changes(&w.autosave);
    assert_false(w.autosave.is_hurried);
    end(&w, false);
}

static void films_go_on(void **state)
{
    struct work w;
    uint64_t samples;

    (void)state;
    begin(&w);
    render_a_while(&w);
    set_exposure(&w, 2);
    render_halt(w.session.engine.render);
    samples = render_progress(w.session.engine.render).samples;
    end(&w, true);
    for (int i = 0; i < 2; i++) {
        begin(&w);
        assert_string_equal(w.control.message.text,
                            "kept: 5 s of render and unsaved changes; ^R goes "
                            "on with it");
        autosave_go_on(&w.autosave);
        assert_true(w.control.is_live);
        assert_true(w.control.has_gone_on);
        assert_true(render_progress(w.session.engine.render).samples >=
                    samples);
        check_close(exposure(&w), 2, 0);
        end(&w, true); /* the film is kept again at once */
    }
    /* another picture: the edits are restored, the film is not */
    put("s.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    begin(&w);
    autosave_go_on(&w.autosave);
    assert_false(w.control.has_gone_on);
    assert_non_null(strstr(w.control.message.text, "geometry"));
    check_close(exposure(&w), 2, 0);
    end(&w, false);
}

/* What is damaged is said in one line, and the session starts anew. */
static void damaged_files_are_removed(void **state)
{
    struct work w;
    char *path;
    FILE *file;

    (void)state;
    begin(&w);
    set_exposure(&w, 1);
    path = strdup(w.autosave.path);
    end(&w, true);
    file = fopen(path, "r+");
    assert_non_null(file);
    assert_int_equal(fseek(file, -1, SEEK_END), 0);
    assert_int_equal(fputc('?', file), '?');
    assert_int_equal(fclose(file), 0);
    begin(&w);
    assert_non_null(w.autosave.offer_path); /* its head is whole */
    autosave_go_on(&w.autosave);
    assert_non_null(strstr(w.control.message.text, "damaged"));
    check_close(exposure(&w), 0, 0);
    end(&w, false);
    put(path, "glim session 9\n");
    begin(&w);
    assert_null(w.autosave.offer_path);
    assert_non_null(strstr(w.control.message.text, "another kind of file"));
    end(&w, false);
    assert_int_equal(count_sessions(), 0);
    free(path);
}

/* A file that cannot be read now, for want of a descriptor, is offered again.
 */
static void unreadable_files_stay(void **state)
{
    struct rlimit before, none;
    struct work w;

    (void)state;
    begin(&w);
    set_exposure(&w, 1);
    end(&w, true);
    begin(&w);
    assert_non_null(w.autosave.offer_path);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
    none = before;
    none.rlim_cur = 0;
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    autosave_go_on(&w.autosave);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &before), 0);
    assert_non_null(strstr(w.control.message.text, "Too many open files"));
    assert_non_null(w.autosave.offer_path);
    check_close(exposure(&w), 0, 0);
    autosave_go_on(&w.autosave);
    assert_null(w.autosave.offer_path);
    check_close(exposure(&w), 1, 0);
    end(&w, false);
    assert_int_equal(count_sessions(), 0);
}

/* The folder of sessions is made again where it was removed. */
static void removed_folders_are_made_again(void **state)
{
    struct work w;

    (void)state;
    begin(&w);
    assert_int_equal(system("rm -r state"), 0);
    set_exposure(&w, 1);
    end(&w, true);
    begin(&w);
    assert_non_null(w.autosave.offer_path);
    autosave_drop(&w.autosave);
    end(&w, false);
    assert_int_equal(count_sessions(), 0);
}

static int enter(void **state)
{
    if (enter_folder_with_state(state) != 0)
        return -1;
    put("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quick_sessions_are_not_kept),
        cmocka_unit_test(edits_are_kept_until_they_are_dropped),
        cmocka_unit_test(offers_are_set_aside),
        cmocka_unit_test(changes_are_written_at_once),
        cmocka_unit_test(films_go_on),
        cmocka_unit_test(damaged_files_are_removed),
        cmocka_unit_test(unreadable_files_stay),
        cmocka_unit_test(removed_folders_are_made_again),
    };

    return cmocka_run_group_tests(tests, enter, remove_folder);
}
