// SPDX-License-Identifier: MIT
/*
 * live_render.h - controls the render of the interactive program: live and
 * normal mode, starting and halting, the backend, changed files, messages
 *
 * Live mode renders without a limit and restarts at every change. Normal mode
 * renders one view up to the samples of -s; it can be halted, and its picture
 * is not discarded without a question.
 *
 * Units:     nanoseconds of clock_ns(), samples of all pixels together
 * Ownership: the session is the caller's; live_render_free() frees the rest
 * Threads:   main only
 * Errors:    become messages, except in live_render_init()
 */
#ifndef GLIM_LIVE_RENDER_H
#define GLIM_LIVE_RENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "session/autosave_file.h"
#include "session/reload.h"
#include "session/session.h"
#include "session/session_save.h"

/* The line for the person in the place of the status line. */
struct message {
    char text[sizeof(struct error)];
    bool is_error; /* shown until a key is pressed */
    uint64_t said_ns;
    uint64_t until_ns; /* end of the display; 0: no message */
};

struct live_render {
    struct session *session;
    struct save_thread saver;
    struct autosave_writer keeping;
    struct reload reload;
    struct file_watch watch;
    struct render_progress progress; /* of the last live_render_update() */
    struct message message;

    bool is_live;
    bool is_started;  /* normal mode: the render was started */
    bool is_halted;   /* halted by the person */
    bool has_gone_on; /* the film began with that of an autosaved session */
    /* the screen must be drawn; cleared by the screen */
    bool has_changed;
    bool has_changed_files; /* since the last load */
    /* time to check or reload the files; UINT64_MAX: when the watch reports */
    uint64_t files_ns;
    uint32_t watched_version; /* session.files_version of the watch */
    uint64_t restarted_ns;
    uint64_t changed_ns; /* of the last start of another picture */

    uint64_t saved_samples;  /* samples of this picture when last saved */
    uint64_t saving_samples; /* samples that are being saved */
    char saving_what[64];    /* description: size and samples */

    bool has_said_faults; /* of samples */
    bool awaits_device;   /* asked for by an option or a key, in test */

    char **results; /* lines to print at the end */
    int result_count;
};

/* Starts to render in live mode. */
bool live_render_init(struct live_render *control, struct session *session,
                      struct error *err);

/* Show a message in the status line for at least 4 s, or 10 s (long), and at
 * least as long as it takes to read. An error stays until a key is pressed. */
void live_render_say(struct live_render *control, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void live_render_say_long(struct live_render *control, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void live_render_say_error(struct live_render *control, const char *text);

/* Removes the message. */
void live_render_clear_message(struct live_render *control);

/* Handles a key press during an error: the error disappears, but not before it
 * can be read, since the person may have been typing when it appeared. */
void live_render_acknowledge_error(struct live_render *control);

/* Returns the name of the key of an action, for messages. */
struct keymap_name live_render_key(const struct live_render *control,
                                   enum action action);

/* Adds a line that is printed when the screen is closed. */
void live_render_add_result(struct live_render *control, const char *text);

/* Returns true if live mode shows the picture of an older version of the edit,
 * which will be restarted. */
bool live_render_is_outdated(const struct live_render *control);

/* Updates the progress. Restarts the render if it is outdated and already had a
 * picture at the last update. */
void live_render_update(struct live_render *control);

/* Restarts an outdated render at once, before a command that uses the film. */
void live_render_restart_if_outdated(struct live_render *control);

/* Returns true after a restart until there is a picture to show: at least a
 * coarse one, and the whole draft if that takes less than 8 ms. */
bool live_render_awaits_picture(const struct live_render *control);

/* Returns true if normal mode has an unsaved picture. */
bool live_render_has_unsaved(const struct live_render *control);

/* Returns true if changes of materials, assignments or light are unsaved. */
bool live_render_has_unsaved_edit(const struct live_render *control);

/* Returns true in live mode. Otherwise a message says that something, such as
 * "the camera moves", is only possible there. */
bool live_render_need_live(struct live_render *control, const char *what);

/* Returns true if the edit may change now: in live mode, and not during a
 * reload, whose files would undo the change. Otherwise shows a message. */
bool live_render_may_edit(struct live_render *control, const char *what);

/* Changes the mode. Discards the picture of normal mode. */
void live_render_set_live(struct live_render *control, bool is_live);

/* Halts or continues the render; starts it at the first call in normal mode. */
void live_render_start_or_halt(struct live_render *control);

/* Renders one more sample of every pixel, then halts. */
void live_render_step(struct live_render *control);

/* Restarts the render. Discards the picture of normal mode. */
void live_render_restart(struct live_render *control);

/* Returns true if the picture has been the same for so long that it does not
 * move. */
bool live_render_rests(const struct live_render *control);

/* Returns true if a fine draft of this picture is worth its time: it rests, and
 * the film has as many samples as such a draft. */
bool live_render_wants_fine_draft(const struct live_render *control);

/* Renders the draft of live mode anew, for another size of the screen or
 * another kind of samples; a fine one if that is wanted. The film's samples
 * stay, and the draft before is shown until this one is whole. */
void live_render_renew_draft(struct live_render *control);

/* Restarts in a mode. With the film of an autosaved session, of the same
 * picture, it goes on from there; NULL: none. */
void live_render_go_on(struct live_render *control, bool is_live,
                       struct film_file *from);

/* Switches between CPU and OpenCL device, which is started first if necessary.
 * A new picture begins, since one backend makes a whole film. */
void live_render_switch_backend(struct live_render *control);

/* Starts the device in the background, while the CPU renders. */
void live_render_begin_device(struct live_render *control);

/* Handles the readable event_fd of the start: switches to the device, or shows
 * the error. */
void live_render_end_device(struct live_render *control);

/* Handles the readable fd of the watch: lets live_render_update() look at
 * the files when writes have come to rest. */
void live_render_check_files(struct live_render *control);

/* Starts to reload the files of the scene, in live mode. The old scene is
 * rendered until the reload's event_fd is readable; then
 * live_render_end_reload() exchanges it. After an error this returns false
 * and the old scene stays. A reload is refused while an edit is unsaved. */
void live_render_reload(struct live_render *control);
bool live_render_end_reload(struct live_render *control);

void live_render_free(struct live_render *control);

#endif
