// SPDX-License-Identifier: MIT
#include "studio/studio.h"

#include <assert.h>
#include <signal.h>

#include "base/stop.h"
#include "session/save.h"
#include "studio/panel_draw.h"

/* ---- commands that concern several parts ---- */

void studio_end(struct studio *studio, int status)
{
    studio->is_ending = true;
    studio->status = status;
    stop_request(status, false); /* typed keys end it too */
}

void studio_suspend(struct studio *studio)
{
    screen_drain(&studio->workspace.screen, &studio->input);
    studio->input.length = 0; /* keys typed after ^Z are for the shell */
    tty_suspend();
    workspace_layout(&studio->workspace);
}

void studio_set_live(struct studio *studio, bool is_live)
{
    camera_control_stop(&studio->camera);
    inspector_leave(&studio->workspace.inspector);
    live_render_set_live(&studio->control, is_live);
    panel_draw(&studio->workspace.panel); /* only live mode edits */
}

/* Returns true if a render of normal mode has not been saved. Waits for a save
 * in progress. */
static bool would_lose_render(struct studio *studio)
{
    return save_finish(&studio->control) &&
           live_render_has_unsaved(&studio->control);
}

static void cancel(struct studio *studio)
{
    if (!workspace_take_back_glyphs(&studio->workspace))
        live_render_clear_message(&studio->control);
}

static void change_mode(struct studio *studio)
{
    if (would_lose_render(studio))
        question_ask(studio, QUESTION_LIVE);
    else
        studio_set_live(studio, !studio->control.is_live);
}

static void restart(struct studio *studio)
{
    if (would_lose_render(studio))
        question_ask(studio, QUESTION_RESTART);
    else
        live_render_restart(&studio->control);
}

void studio_quit(struct studio *studio)
{
    if (!save_finish(&studio->control))
        return;
    if (live_render_has_unsaved(&studio->control))
        question_ask(studio, QUESTION_QUIT);
    else if (live_render_has_unsaved_edit(&studio->control))
        question_ask(studio, QUESTION_EDIT);
    else
        studio_end(studio, 0);
}

static void keep_view(struct studio *studio)
{
    question_ask(studio, QUESTION_NUMBER);
}

static void switch_mouse(struct studio *studio)
{
    studio->has_mouse = !studio->has_mouse;
    camera_control_stop(&studio->camera);
    tty_set_mouse(studio->has_mouse);
    live_render_say(&studio->control, studio->has_mouse
                                          ? "mouse on: drag to look around"
                                          : "mouse off");
}

/* ---- table ---- */

/* Command of an action: a function of one part of the studio, or one of the
 * values below. Functions first end a move of the camera. Those of other parts
 * than camera and cursor then restart the render if the view has changed. */
struct command {
    void (*camera)(struct camera_control *camera);
    void (*camera_by)(struct camera_control *camera, int by);
    void (*cursor)(struct pick_cursor *cursor);
    void (*control)(struct live_render *control);
    void (*inspector)(struct inspector *inspector);
    void (*inspector_by)(struct inspector *inspector, int by);
    void (*comparison)(struct comparison *comparison);
    void (*workspace)(struct workspace *workspace);
    void (*studio)(struct studio *studio);

    int by;          /* for functions that take it */
    int end_signal;  /* the program ends as by this signal */
    int right, down; /* cells by which the cursor moves */

    /* the camera moves along the axis while the key is held: sign is 1 or -1,
     * or 0 for no move */
    enum held_keys_axis axis;
    int sign;
};

static const struct command commands[ACTIONS] = {
    [ACTION_FORWARD] = {.axis = HELD_KEYS_FORWARD, .sign = 1},
    [ACTION_BACK] = {.axis = HELD_KEYS_FORWARD, .sign = -1},
    [ACTION_LEFT] = {.axis = HELD_KEYS_RIGHT, .sign = -1},
    [ACTION_RIGHT] = {.axis = HELD_KEYS_RIGHT, .sign = 1},
    [ACTION_DOWN] = {.axis = HELD_KEYS_UP, .sign = -1},
    [ACTION_UP] = {.axis = HELD_KEYS_UP, .sign = 1},
    [ACTION_LOOK_UP] = {.axis = HELD_KEYS_LOOK_UP, .sign = 1},
    [ACTION_LOOK_DOWN] = {.axis = HELD_KEYS_LOOK_UP, .sign = -1},
    [ACTION_LOOK_LEFT] = {.axis = HELD_KEYS_LOOK_RIGHT, .sign = -1},
    [ACTION_LOOK_RIGHT] = {.axis = HELD_KEYS_LOOK_RIGHT, .sign = 1},
    [ACTION_FASTER] = {.camera_by = camera_control_change_speed, .by = 1},
    [ACTION_SLOWER] = {.camera_by = camera_control_change_speed, .by = -1},
    [ACTION_CURSOR] = {.cursor = pick_cursor_show},
    [ACTION_CANCEL] = {.studio = cancel},
    [ACTION_ORBIT] = {.camera = camera_control_switch_orbit},
    [ACTION_WALLS] = {.camera = camera_control_switch_walls},
    [ACTION_FRAME] = {.camera = camera_control_frame_object},
    [ACTION_FRAME_ALL] = {.camera = camera_control_frame_all},
    [ACTION_NARROWER] = {.axis = HELD_KEYS_WIDEN, .sign = -1},
    [ACTION_WIDER] = {.axis = HELD_KEYS_WIDEN, .sign = 1},
    [ACTION_FOCUS] = {.camera = camera_control_focus},
    [ACTION_CLOSE] = {.axis = HELD_KEYS_OPEN, .sign = -1},
    [ACTION_OPEN] = {.axis = HELD_KEYS_OPEN, .sign = 1},
    [ACTION_UNDO] = {.camera_by = camera_control_step_history, .by = -1},
    [ACTION_REDO] = {.camera_by = camera_control_step_history, .by = 1},
    [ACTION_RESET] = {.camera = camera_control_reset},
    [ACTION_KEEP] = {.studio = keep_view},
    [ACTION_VIEW_1] = {.camera_by = camera_control_go_to_view, .by = 1},
    [ACTION_VIEW_2] = {.camera_by = camera_control_go_to_view, .by = 2},
    [ACTION_VIEW_3] = {.camera_by = camera_control_go_to_view, .by = 3},
    [ACTION_VIEW_4] = {.camera_by = camera_control_go_to_view, .by = 4},
    [ACTION_VIEW_5] = {.camera_by = camera_control_go_to_view, .by = 5},
    [ACTION_VIEW_6] = {.camera_by = camera_control_go_to_view, .by = 6},
    [ACTION_VIEW_7] = {.camera_by = camera_control_go_to_view, .by = 7},
    [ACTION_VIEW_8] = {.camera_by = camera_control_go_to_view, .by = 8},
    [ACTION_VIEW_9] = {.camera_by = camera_control_go_to_view, .by = 9},
    [ACTION_SAVE_VIEW] = {.control = save_view},
    [ACTION_VIEW_NEXT] = {.inspector_by = inspector_turn_view, .by = 1},
    [ACTION_VIEW_BACK] = {.inspector_by = inspector_turn_view, .by = -1},
    [ACTION_KEEP_RENDER] = {.comparison = comparison_keep},
    [ACTION_COMPARE] = {.comparison = comparison_next},
    [ACTION_FILTER] = {.inspector = inspector_switch_filter},
    [ACTION_DRAWING] = {.workspace = workspace_next_drawing},
    [ACTION_LESS] = {.inspector_by = inspector_change, .by = -1},
    [ACTION_MORE] = {.inspector_by = inspector_change, .by = 1},
    [ACTION_PANEL] = {.workspace = workspace_open_panel},
    [ACTION_MODE] = {.studio = change_mode},
    [ACTION_START] = {.control = live_render_start_or_halt},
    [ACTION_STEP] = {.control = live_render_step},
    [ACTION_RESTART] = {.studio = restart},
    [ACTION_SAVE] = {.inspector = inspector_save},
    [ACTION_SAVE_TEXT] = {.inspector = inspector_save_text},
    [ACTION_SAVE_LINEAR] = {.inspector = inspector_save_hdr},
    [ACTION_BACKEND] = {.control = live_render_switch_backend},
    [ACTION_RELOAD] = {.control = live_render_reload},
    [ACTION_COLORS] = {.workspace = workspace_next_colors},
    [ACTION_GLYPHS] = {.workspace = workspace_next_glyphs},
    [ACTION_METER] = {.workspace = workspace_switch_progress},
    [ACTION_HIDE] = {.workspace = workspace_switch_status},
    [ACTION_MOUSE] = {.studio = switch_mouse},
    [ACTION_REDRAW] = {.workspace = workspace_layout},
    [ACTION_HELP] = {.workspace = workspace_open_help},
    [ACTION_SUSPEND] = {.studio = studio_suspend},
    [ACTION_INTERRUPT] = {.end_signal = SIGINT},
    [ACTION_ABORT] = {.end_signal = SIGQUIT},
    [ACTION_QUIT] = {.studio = studio_quit},
};

/* Commands of actions that mean something else while the cursor is shown. */
static const struct command cursor_commands[ACTIONS] = {
    [ACTION_LOOK_UP] = {.down = -1},
    [ACTION_LOOK_DOWN] = {.down = 1},
    [ACTION_LOOK_LEFT] = {.right = -1},
    [ACTION_LOOK_RIGHT] = {.right = 1},
    [ACTION_CURSOR] = {.cursor = pick_cursor_hide},
    [ACTION_CANCEL] = {.cursor = pick_cursor_hide},
    [ACTION_START] = {.camera = camera_control_pick},
};

static void run_settled(struct studio *studio, const struct command *c)
{
    struct workspace *workspace = &studio->workspace;

    live_render_restart_if_outdated(&studio->control);
    if (c->control)
        c->control(&studio->control);
    else if (c->inspector)
        c->inspector(&workspace->inspector);
    else if (c->inspector_by)
        c->inspector_by(&workspace->inspector, c->by);
    else if (c->comparison)
        c->comparison(&workspace->comparison);
    else if (c->workspace)
        c->workspace(workspace);
    else if (c->studio)
        c->studio(studio);
    else
        assert(!"an action without a command");
}

static void run(struct studio *studio, const struct command *c)
{
    struct camera_control *camera = &studio->camera;

    if (c->sign != 0) {
        camera_control_move(camera, c->axis, c->sign);
        return;
    }
    if (c->right != 0 || c->down != 0) {
        pick_cursor_move(&camera->cursor, c->right, c->down);
        return;
    }
    camera_control_end_move(camera);
    if (c->end_signal != 0)
        studio_end(studio, 128 + c->end_signal);
    else if (c->cursor)
        c->cursor(&camera->cursor);
    else if (c->camera)
        c->camera(camera);
    else if (c->camera_by)
        c->camera_by(camera, c->by);
    else
        run_settled(studio, c);
}

void studio_run(struct studio *studio, enum action action)
{
    if (action != ACTION_NONE)
        run(studio, &commands[action]);
}

bool studio_run_at_cursor(struct studio *studio, enum action action)
{
    const struct command *c = &cursor_commands[action];

    if (!studio->workspace.screen.has_cursor ||
        (c->right == 0 && c->down == 0 && !c->cursor && !c->camera))
        return false;
    run(studio, c);
    return true;
}

/* ---- questions ---- */

static void end(struct studio *studio)
{
    studio_end(studio, 0);
}

static void go_live(struct studio *studio)
{
    studio_set_live(studio, true);
}

static void restart_unasked(struct studio *studio)
{
    live_render_restart(&studio->control);
}

static void save_render(struct studio *studio)
{
    save_picture(&studio->control, "png");
}

static void save_and_quit(struct studio *studio)
{
    if (save_edit(&studio->control))
        studio_quit(studio);
}

/* Table of the questions. The key y runs `yes`, the save key runs `save`, and
 * any other key means no. The narrowest window shows 39 columns of a text, so
 * that both keys are among them. */
static const struct {
    const char *text;
    void (*yes)(struct studio *studio);
    char save_key;
    void (*save)(struct studio *studio);
} questions[] = {
    [QUESTION_NONE] = {0},
    [QUESTION_QUIT] = {"Unsaved render. Quit? y: yes, p: save, other: no", end,
                       'p', save_render},
    [QUESTION_EDIT] = {"Unsaved changes. Quit? y: yes, s: save, other: no", end,
                       's', save_and_quit},
    [QUESTION_LIVE] = {"Unsaved render. Leave it? y: yes, p: save, other: no",
                       go_live, 'p', save_render},
    [QUESTION_RESTART] = {"Unsaved render. Restart it? y: yes, p: save, "
                          "other: no",
                          restart_unasked, 'p', save_render},
    [QUESTION_NUMBER] = {.text = "Number for this view? 1 to 9, other: none"},
    [QUESTION_KEPT] = {0}, /* its text is that of autosave */
};

void question_ask(struct studio *studio, enum question question)
{
    studio->question = question;
    workspace_ask(&studio->workspace, question == QUESTION_KEPT
                                          ? studio->autosave.question
                                          : questions[question].text);
}

/* Answers QUESTION_NUMBER: the key that goes to a view gives the number of that
 * view. */
static void answer_number(struct studio *studio, int key)
{
    enum action action =
        keymap_action(&studio->control.session->options->keys, key);

    if (action >= ACTION_VIEW_1 && action <= ACTION_VIEW_9)
        camera_control_keep_view(&studio->camera,
                                 (int)action - ACTION_VIEW_1 + 1);
}

/* Answers QUESTION_KEPT: Enter goes on, and any other key but r has its effect
 * in a session that starts anew. The question stays for the next session if the
 * person quits. */
static bool answer_kept(struct studio *studio, int key)
{
    enum action action =
        keymap_action(&studio->control.session->options->keys, key);

    if (action == ACTION_QUIT)
        return false;
    if (key == '\r') {
        autosave_go_on(&studio->autosave);
        workspace_refresh(&studio->workspace);
    } else {
        autosave_start_anew(&studio->autosave);
    }
    return key == '\r' || key == 'r';
}

bool question_answer(struct studio *studio, int key)
{
    enum question question = studio->question;
    int small = key >= 'A' && key <= 'Z' ? key - 'A' + 'a' : key;

    question_ask(studio, QUESTION_NONE);
    if (question == QUESTION_KEPT)
        return answer_kept(studio, key);
    if (question == QUESTION_NUMBER)
        answer_number(studio, key);
    else if (small == 'y')
        questions[question].yes(studio);
    else if (small == questions[question].save_key)
        questions[question].save(studio);
    return true;
}
