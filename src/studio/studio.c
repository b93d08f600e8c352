// SPDX-License-Identifier: MIT
#include "studio/studio.h"

#include <assert.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/background.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/min_max.h"
#include "base/print.h"
#include "base/stop.h"
#include "session/keymap.h"
#include "session/live_render.h"
#include "session/save.h"
#include "session/state_list.h"
#include "session/stats_json.h"
#include "studio/autosave.h"
#include "studio/camera/camera_control.h"
#include "studio/panel_draw.h"
#include "studio/workspace.h"
#include "terminal/tty_events.h"

#define S_NS UINT64_C(1000000000)

/* Factor of the speed of moves by capitals. */
#define MOVES_FAST 10

/* Most questions come before something is lost. */
enum question {
    QUESTION_NONE,
    QUESTION_QUIT, /* or open another scene: something is not saved */
    QUESTION_LIVE, /* leave normal mode */
    QUESTION_RESTART,
    QUESTION_NUMBER, /* number for a view */
    QUESTION_VIEW,   /* change a view file that was there before */
    QUESTION_RESTORE /* a kept session replaces changes */
};

struct studio {
    struct live_render control;
    struct camera_control camera;
    struct workspace workspace;
    struct autosave autosave;
    struct tty_events events;
    int pace; /* of moves by the present key: 1, or MOVES_FAST */
    bool has_mouse;
    enum question question; /* question that waits for an answer */
    char question_text[96]; /* of QUESTION_VIEW */
    bool may_write_view;    /* the person has agreed */
    bool quits_when_saved;  /* the person quits, and a picture is being saved */
    bool is_ending;
    bool is_gone; /* the terminal has gone */
    int status;   /* exit status */
};

static void question_ask(struct studio *studio, enum question question);
static void draw_panel(struct studio *studio);
static void go_on_kept(struct studio *studio);

/* ---- commands that concern several parts ---- */

/* Ends the loop; the program exits with this status. */
static void studio_end(struct studio *studio, int status)
{
    studio->is_ending = true;
    studio->status = status;
    if (status != 0 || studio->control.session->next_scene == NULL)
        stop_request(status, false); /* typed keys end it too */
}

/* Stops the program until the shell continues it. */
static void studio_suspend(struct studio *studio)
{
    screen_drain(&studio->workspace.screen, &studio->events.input);
    studio->events.input.length = 0; /* keys typed after ^Z are for the shell */
    tty_suspend();
    workspace_layout(&studio->workspace);
}

/* Switches to live or normal mode. The render of normal mode is lost. */
static void studio_set_live(struct studio *studio, bool is_live)
{
    camera_control_stop(&studio->camera);
    inspector_leave(&studio->workspace.inspector);
    live_render_set_live(&studio->control, is_live);
    panel_draw(&studio->workspace.panel); /* only live mode edits */
}

/* Returns true if a render of normal mode has not been saved. Waits for a save
 * in progress only if that may be the render: live mode answers meanwhile. */
static bool would_lose_render(struct studio *studio)
{
    if (!live_render_has_unsaved(&studio->control))
        return false;
    save_finish(&studio->control);
    return live_render_has_unsaved(&studio->control);
}

/* One level back, behind those of the parts: removes a message, or opens the
 * menu. */
static void cancel(struct studio *studio)
{
    if (workspace_take_back_glyphs(&studio->workspace))
        return;
    if (studio->control.message.until_ns != 0)
        live_render_clear_message(&studio->control);
    else
        workspace_open_menu(&studio->workspace);
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

/* Ends the loop, after a picture that is being saved unless the key is pressed
 * again. Asks first, once, if something would be lost. */
static void studio_quit(struct studio *studio)
{
    if (studio->control.saver.copying.is_busy && !studio->quits_when_saved) {
        studio->quits_when_saved = true;
        live_render_say_long(&studio->control, "%s when the picture is saved",
                             studio->control.session->next_scene != NULL
                                 ? "leaves"
                                 : "quits");
        return;
    }
    studio->quits_when_saved = false;
    if (studio->question != QUESTION_QUIT &&
        (live_render_has_unsaved(&studio->control) ||
         live_render_has_unsaved_edit(&studio->control)))
        question_ask(studio, QUESTION_QUIT);
    else
        studio_end(studio, 0);
}

/* Writes the view file. Asks before it changes one that was there before. */
static void write_view(struct studio *studio)
{
    const char *path = studio->control.session->engine.view_path;

    if (access(path, F_OK) != 0)
        studio->may_write_view = true;
    if (studio->may_write_view)
        save_view(&studio->control);
    else
        question_ask(studio, QUESTION_VIEW);
}

static void restore_kept(struct studio *studio)
{
    if (studio->autosave.offer_path == NULL)
        live_render_say(&studio->control, "no session of this scene is kept");
    else if (live_render_has_unsaved_edit(&studio->control))
        question_ask(studio, QUESTION_RESTORE);
    else
        go_on_kept(studio);
}

static void drop_kept(struct studio *studio)
{
    autosave_drop(&studio->autosave);
}

static void save_changes(struct studio *studio)
{
    save_edit(&studio->control);
    draw_panel(studio);
}

static void add_lamp(struct studio *studio)
{
    workspace_open_light(&studio->workspace);
    editor_panel_add_lamp(&studio->workspace.panel);
    draw_panel(studio);
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
    [ACTION_SAVE_VIEW] = {.studio = write_view},
    [ACTION_VIEW_NEXT] = {.inspector_by = inspector_turn_view, .by = 1},
    [ACTION_VIEW_BACK] = {.inspector_by = inspector_turn_view, .by = -1},
    [ACTION_KEEP_RENDER] = {.workspace = workspace_keep_render},
    [ACTION_COMPARE] = {.comparison = comparison_next},
    [ACTION_FILTER] = {.inspector = inspector_switch_filter},
    [ACTION_DRAWING] = {.workspace = workspace_next_drawing},
    [ACTION_LESS] = {.inspector_by = inspector_change, .by = -1},
    [ACTION_MORE] = {.inspector_by = inspector_change, .by = 1},
    [ACTION_PANEL] = {.workspace = workspace_open_panel},
    [ACTION_LIGHT] = {.workspace = workspace_open_light},
    [ACTION_ADD_LAMP] = {.studio = add_lamp},
    [ACTION_SAVE_EDIT] = {.studio = save_changes},
    [ACTION_MODE] = {.studio = change_mode},
    [ACTION_START] = {.control = live_render_start_or_halt},
    [ACTION_STEP] = {.control = live_render_step},
    [ACTION_RESTART] = {.studio = restart},
    [ACTION_SAVE] = {.inspector = inspector_save},
    [ACTION_SAVE_RAW] = {.inspector = inspector_save_raw},
    [ACTION_SAVE_EXR] = {.inspector = inspector_save_exr},
    [ACTION_SAVE_TEXT] = {.inspector = inspector_save_text},
    [ACTION_SAVE_LINEAR] = {.inspector = inspector_save_hdr},
    [ACTION_BACKEND] = {.control = live_render_switch_backend},
    [ACTION_RESTORE] = {.studio = restore_kept},
    [ACTION_DROP] = {.studio = drop_kept},
    [ACTION_VIEWS] = {.workspace = workspace_open_views},
    [ACTION_SCENE] = {.workspace = workspace_open_scenes},
    [ACTION_RELOAD] = {.control = live_render_reload},
    [ACTION_COLORS] = {.workspace = workspace_next_colors},
    [ACTION_THEME] = {.workspace = workspace_next_theme},
    [ACTION_GLYPHS] = {.workspace = workspace_next_glyphs},
    [ACTION_ABOUT] = {.workspace = workspace_switch_about},
    [ACTION_HIDE] = {.workspace = workspace_switch_status},
    [ACTION_MOUSE] = {.studio = switch_mouse},
    [ACTION_REDRAW] = {.workspace = workspace_redraw},
    [ACTION_HELP] = {.workspace = workspace_open_commands},
    [ACTION_SUSPEND] = {.studio = studio_suspend},
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
        camera_control_move(camera, c->axis,
                            c->sign * (c->axis <= HELD_KEYS_FORWARD
                                           ? studio->pace
                                           : 1));
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

/* Runs the command of an action. ACTION_NONE does nothing. */
static void studio_run(struct studio *studio, enum action action)
{
    if (action != ACTION_NONE)
        run(studio, &commands[action]);
}

/* Runs the command that an action has while the cursor is shown. Returns false
 * if the cursor is not shown, or if the action has no other command then. */
static bool studio_run_at_cursor(struct studio *studio, enum action action)
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

/* Saves the changes and the picture, and quits. */
static void save_and_quit(struct studio *studio)
{
    bool is_saved = !live_render_has_unsaved_edit(&studio->control) ||
                    save_edit(&studio->control);

    if (is_saved && live_render_has_unsaved(&studio->control))
        save_picture(&studio->control, "png");
    if (is_saved)
        studio_quit(studio);
}

static void go_on_kept(struct studio *studio)
{
    autosave_go_on(&studio->autosave);
    workspace_refresh(&studio->workspace);
}

static void save_and_restore(struct studio *studio)
{
    if (save_edit(&studio->control))
        go_on_kept(studio);
}

static void write_view_over(struct studio *studio)
{
    studio->may_write_view = true;
    save_view(&studio->control);
}

/* Table of the questions. The key y runs `yes`, the save key runs `save`, and
 * any other key means no. The narrowest window shows 39 columns of a text, so
 * that both keys are among them. Texts of NULL depend on the state. */
static const struct {
    const char *text;
    void (*yes)(struct studio *studio);
    char save_key;
    void (*save)(struct studio *studio);
} questions[] = {
    [QUESTION_NONE] = {0},
    [QUESTION_QUIT] = {NULL, end, 's', save_and_quit},
    [QUESTION_LIVE] = {"Unsaved render. Leave it? y: yes, p: save, other: no",
                       go_live, 'p', save_render},
    [QUESTION_RESTART] = {"Unsaved render. Restart it? y: yes, p: save, "
                          "other: no",
                          restart_unasked, 'p', save_render},
    [QUESTION_NUMBER] = {.text = "Number for this view? 1 to 9; others cancel"},
    [QUESTION_VIEW] = {NULL, write_view_over, 0, NULL},
    [QUESTION_RESTORE] = {"Unsaved changes. Replace them? y: yes, s: save",
                          go_on_kept, 's', save_and_restore},
};

static const char *question_text(struct studio *studio, enum question question)
{
    const struct live_render *control = &studio->control;

    if (question == QUESTION_VIEW) {
        snprintf(studio->question_text, sizeof studio->question_text,
                 "Change %.60s? y: yes, other: no",
                 path_name(control->session->engine.view_path));
        return studio->question_text;
    }
    if (question != QUESTION_QUIT)
        return questions[question].text;
    snprintf(studio->question_text, sizeof studio->question_text,
             "%s. %s? y: yes, s: save, other: no",
             !live_render_has_unsaved(control)       ? "Unsaved changes"
             : live_render_has_unsaved_edit(control) ? "Edits, render unsaved"
                                                     : "Unsaved render",
             control->session->next_scene != NULL ? "Leave" : "Quit");
    return studio->question_text;
}

/* Shows a question instead of the status line. QUESTION_NONE removes it. */
static void question_ask(struct studio *studio, enum question question)
{
    studio->question = question;
    if (question != QUESTION_NONE)
        workspace_close_list(&studio->workspace);
    workspace_ask(&studio->workspace, question_text(studio, question));
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

/* Forgets the scene that was to be opened. */
static void stay(struct studio *studio)
{
    free(studio->control.session->next_scene);
    studio->control.session->next_scene = NULL;
}

/* Ends the save in progress, and goes on with quitting after it. */
static void end_save(struct studio *studio)
{
    bool quits = studio->quits_when_saved;
    bool is_saved = save_finish(&studio->control);

    studio->quits_when_saved = false;
    if (quits && is_saved)
        studio_quit(studio);
    else if (quits)
        stay(studio);
}

/* Takes any key as the answer and removes the question. */
static void question_answer(struct studio *studio, int key)
{
    enum question question = studio->question;
    int small = key >= 'A' && key <= 'Z' ? key - 'A' + 'a' : key;

    question_ask(studio, QUESTION_NONE);
    if (question == QUESTION_NUMBER)
        answer_number(studio, key);
    else if (small == 'y')
        questions[question].yes(studio);
    else if (questions[question].save != NULL &&
             small == questions[question].save_key)
        questions[question].save(studio);
    else if (question == QUESTION_QUIT)
        stay(studio);
}

/* ---- input ---- */

/* Draws the panel after a key, and the picture, which outlines the selection.
 */
static void draw_panel(struct studio *studio)
{
    panel_draw(&studio->workspace.panel);
    workspace_refresh(&studio->workspace);
}

/* Time for which a pick is outlined, as its message is shown. */
#define PICKED_NS (4 * S_NS)

/* Selects a new pick in the panel, and outlines it. */
static void follow_pick(struct studio *studio)
{
    struct editor_panel *panel = &studio->workspace.panel;

    if (studio->camera.cursor.is_pick_new) {
        editor_panel_select(panel, &studio->camera.cursor.pick);
        studio->workspace.picked_until_ns = clock_ns() + PICKED_NS;
        draw_panel(studio);
    }
    studio->camera.cursor.is_pick_new = false;
}

/* ---- parts ---- */

/* What a person may be in. */
struct part {
    bool (*is_open)(const struct studio *studio);
    /* Takes a key, which means an action elsewhere. Returns false for a key of
     * the parts behind. NULL: it has no keys. */
    bool (*takes)(struct studio *studio, int key, enum action action);
    enum keys_state hints; /* of its keys; KEYS_NONE: those of a part behind */
    void (*leave)(struct studio *studio); /* its only key, ACTION_CANCEL */
};

static bool asks(const struct studio *studio)
{
    return studio->question != QUESTION_NONE;
}

static bool answers(struct studio *studio, int key, enum action action)
{
    (void)action;
    question_answer(studio, key);
    return true;
}

static bool is_too_small(const struct studio *studio)
{
    return studio->workspace.screen.is_too_small;
}

static bool takes_nothing(struct studio *studio, int key, enum action action)
{
    (void)studio;
    (void)key;
    (void)action;
    return true;
}

static bool has_list(const struct studio *studio)
{
    return workspace_has_list(&studio->workspace);
}

/* Leaves for a scene that was chosen, as the program ends. */
static void open_chosen(struct studio *studio)
{
    char **next = &studio->control.session->next_scene;

    if (studio->workspace.chosen_scene == NULL)
        return;
    free(*next);
    *next = studio->workspace.chosen_scene;
    studio->workspace.chosen_scene = NULL;
    studio_quit(studio);
}

static void take_list(struct studio *studio, const struct event *event)
{
    studio_run(studio, workspace_take_list(&studio->workspace, event));
    open_chosen(studio);
}

static bool list_takes(struct studio *studio, int key, enum action action)
{
    (void)action;
    take_list(studio, &(struct event){.kind = EVENT_KEY, .key = key});
    return true;
}

/* The cursor on the picture; text that is typed in the panel has its keys. */
static bool has_cursor(const struct studio *studio)
{
    return studio->workspace.screen.has_cursor &&
           !studio->workspace.panel.is_typing &&
           !studio->workspace.panel.is_finding;
}

static bool cursor_takes(struct studio *studio, int key, enum action action)
{
    (void)key;
    return studio_run_at_cursor(studio, action);
}

static bool has_panel(const struct studio *studio)
{
    return studio->workspace.panel.is_open;
}

static bool has_live_panel(const struct studio *studio)
{
    return has_panel(studio) && studio->control.is_live;
}

/* The arrows are the cursor's while that is shown. */
static bool panel_takes(struct studio *studio, int key, enum action action)
{
    struct editor_panel *panel = &studio->workspace.panel;

    (void)action;
    if (has_cursor(studio) || !editor_panel_key(panel, key))
        return false;
    if (!panel->is_open)
        workspace_layout(&studio->workspace);
    else
        draw_panel(studio);
    return true;
}

static bool compares(const struct studio *studio)
{
    return studio->workspace.comparison.mode != COMPARISON_OFF;
}

static bool wipe_takes_key(struct studio *studio, int key, enum action action)
{
    (void)key;
    return comparison_takes(&studio->workspace.comparison, action);
}

static bool has_drawing(const struct studio *studio)
{
    return studio->workspace.inspector.drawing != INSPECTOR_NOTHING;
}

static void leave_drawing(struct studio *studio)
{
    inspector_stop_drawing(&studio->workspace.inspector);
    workspace_refresh(&studio->workspace);
}

static bool has_view(const struct studio *studio)
{
    return studio->workspace.inspector.view_mode.kind != SHOW_LIGHT;
}

static void leave_view(struct studio *studio)
{
    inspector_show_light(&studio->workspace.inspector);
}

static bool orbits(const struct studio *studio)
{
    return studio->camera.input.is_orbiting;
}

static void leave_orbit(struct studio *studio)
{
    camera_control_switch_orbit(&studio->camera);
}

static bool is_paused(const struct studio *studio)
{
    return studio->control.is_halted;
}

static bool is_live(const struct studio *studio)
{
    return studio->control.is_live;
}

static bool is_normal(const struct studio *studio)
{
    return !studio->control.is_live;
}

/* All parts, the innermost first. A key goes to the first one that is open and
 * takes it, and the bar shows the keys of the first one that has some. */
static const struct part parts[] = {
    {asks, answers, KEYS_NONE, NULL},
    {is_too_small, takes_nothing, KEYS_NONE, NULL},
    {has_list, list_takes, KEYS_NONE, NULL},
    {has_cursor, cursor_takes, KEYS_CURSOR, NULL},
    {has_live_panel, panel_takes, KEYS_PANEL, NULL},
    {has_panel, panel_takes, KEYS_PANEL_NORMAL, NULL},
    {compares, wipe_takes_key, KEYS_COMPARE, NULL},
    {has_drawing, NULL, KEYS_DRAWING, leave_drawing},
    {has_view, NULL, KEYS_VIEW, leave_view},
    {orbits, NULL, KEYS_ORBIT, leave_orbit},
    {is_paused, NULL, KEYS_PAUSED, NULL},
    {is_live, NULL, KEYS_LIVE, NULL},
    {is_normal, NULL, KEYS_NORMAL, NULL},
};

#define PARTS (sizeof parts / sizeof parts[0])

static enum keys_state keys_of_now(const struct studio *studio)
{
    for (size_t i = 0; i < PARTS; i++)
        if (parts[i].hints != KEYS_NONE && parts[i].is_open(studio))
            return parts[i].hints;
    return KEYS_NONE;
}

static bool is_urgent(enum action action)
{
    return action == ACTION_QUIT || action == ACTION_ABORT ||
           action == ACTION_SUSPEND || action == ACTION_REDRAW;
}

/* Gives a key to a part. Returns false if it is not open, or for a key of the
 * parts behind. */
static bool part_takes(const struct part *part, struct studio *studio, int key,
                       enum action action)
{
    if (!part->is_open(studio))
        return false;
    if (part->takes != NULL)
        return part->takes(studio, key, action);
    if (part->leave == NULL || action != ACTION_CANCEL)
        return false;
    part->leave(studio);
    return true;
}

/* Takes a key, or a press on its hint. Urgent keys, and those that no part
 * takes, run their commands. */
static void take_action(struct studio *studio, int key, enum action action)
{
    bool is_taken = false;

    live_render_acknowledge_error(&studio->control);
    if (studio->quits_when_saved && action != ACTION_QUIT) {
        studio->quits_when_saved = false;
        stay(studio);
    }
    studio->pace = key >= 'A' && key <= 'Z' ? MOVES_FAST : 1;
    for (size_t i = 0; i < PARTS && !is_taken && !is_urgent(action); i++)
        is_taken = part_takes(&parts[i], studio, key, action);
    if (!is_taken)
        studio_run(studio, action);
    if (action == ACTION_UNDO || action == ACTION_REDO)
        panel_draw(&studio->workspace.panel);
    follow_pick(studio);
}

static void take_key(struct studio *studio, int key)
{
    take_action(studio, key,
                keymap_action(&studio->control.session->options->keys, key));
}

/* ---- events ---- */

/* Gives a character of a pasted text to the field that takes text, if there is
 * one: no key of it is a command. */
static void take_pasted(struct studio *studio, int key)
{
    struct editor_panel *panel = &studio->workspace.panel;
    bool is_text = key >= ' ' && key < 127;

    if (has_list(studio)) {
        if (is_text)
            list_takes(studio, key, ACTION_NONE);
    } else if (panel->is_open && is_text &&
               (panel->is_typing || panel->is_finding ||
                (panel->is_in_parameters &&
                 keymap_panel_action(key) == PANEL_TYPE))) {
        editor_panel_key(panel, key);
        draw_panel(studio);
    } else if (!panel->is_typing) {
        live_render_say(&studio->control,
                        "pasted text is dropped: no field takes it");
    }
}

/* Moves the wipe to the mouse while a comparison is shown. */
static bool wipe_takes(struct studio *studio, const struct event *event)
{
    struct workspace *workspace = &studio->workspace;
    const struct cells_rect *fit = &workspace->screen.fit;

    if (workspace->comparison.mode == COMPARISON_OFF ||
        (event->mouse != MOUSE_PRESS && event->mouse != MOUSE_DRAG))
        return false;
    comparison_wipe_to(&workspace->comparison,
                       (event->x - 0.5 - fit->col) / fit->cols);
    return true;
}

static void take_mouse(struct studio *studio, const struct event *event)
{
    enum action hint =
        event->mouse == MOUSE_PRESS && !has_list(studio) && !asks(studio)
            ? workspace_hint_at(&studio->workspace, event->x - 1, event->y - 1)
            : ACTION_NONE;

    if (hint != ACTION_NONE) {
        take_action(studio, TTY_KEY_OTHER, hint);
        return;
    }
    if (has_list(studio))
        take_list(studio, event);
    else if (editor_panel_mouse(&studio->workspace.panel, event))
        draw_panel(studio);
    else if (!wipe_takes(studio, event))
        camera_control_mouse(&studio->camera, event);
    follow_pick(studio);
}

static bool take_event(void *context, const struct event *event)
{
    struct studio *studio = context;
    struct workspace *workspace = &studio->workspace;
    enum palette palette = workspace->screen.display.palette;
    enum theme theme = workspace->screen.display.theme;

    if (event->kind == EVENT_KEY) {
        take_key(studio, event->key);
    } else if (event->kind == EVENT_PASTED) {
        take_pasted(studio, event->key);
    } else if (event->kind == EVENT_MOUSE) {
        if (studio->has_mouse && !workspace->screen.is_too_small)
            take_mouse(studio, event);
    } else {
        bool is_other = screen_answer(&workspace->screen, event);

        if ((event->kind == EVENT_ATTRIBUTES || event->kind == EVENT_KITTY) &&
            glyph_choice_recall(&workspace->glyph_choice))
            is_other = true;
        if (is_other)
            workspace_layout(workspace);
        if (workspace->screen.display.palette != palette ||
            workspace->screen.display.theme != theme)
            draw_panel(studio);
    }
    return !studio->is_ending;
}

/* Takes all keys that wait before the next frame is drawn. */
static void take_input(struct studio *studio)
{
    if (tty_events_read(&studio->events, take_event, studio))
        return;
    studio->is_gone = true;
    studio_end(studio, 128 + SIGHUP);
}

static void take_signals(struct studio *studio)
{
    int number;

    while ((number = tty_signal()) != 0) {
        switch (number) {
        case SIGTERM:
        case SIGHUP:
        case SIGINT:
        case SIGQUIT: studio_end(studio, 128 + number); return;
        case SIGTSTP: studio_suspend(studio); break;
        case SIGCONT:
            tty_resume();
            workspace_layout(&studio->workspace);
            break;
        case SIGWINCH: workspace_redraw(&studio->workspace); break;
        default: break;
        }
    }
}

/* ---- loop ---- */

/* Descriptors that wake the loop. */
enum {
    FD_KEYS,
    FD_SIGNALS,
    FD_RENDER,
    FD_SAVER,
    FD_AUTOSAVE, /* an autosaved session is written */
    FD_KEEPER_TIMER,
    FD_DEVICE, /* an OpenCL device has started, or cannot */
    FD_FILES,  /* files of the scene have changed */
    FD_RELOAD, /* the scene was loaded anew */
    FDS
};

/* When the loop has to go on if no descriptor wakes it. */
static uint64_t wake_ns(const struct studio *studio, uint64_t now_ns)
{
    return u64_min(workspace_next_ns(&studio->workspace, now_ns),
                   u64_min(camera_control_next_ns(&studio->camera),
                           tty_events_deadline_ns(&studio->events)));
}

static void take_reload(struct studio *studio)
{
    struct selection_names names =
        selection_names(&studio->workspace.panel.selection);

    if (live_render_end_reload(&studio->control)) {
        camera_control_set_scene(&studio->camera);
        workspace_renew(&studio->workspace, &names);
    }
    free(names.material);
    free(names.object);
}

/* Keys come last, so that they find finished saves and loaded files. */
static void take_events(struct studio *studio, struct pollfd fds[FDS])
{
    if (fds[FD_SIGNALS].revents)
        take_signals(studio);
    if (studio->is_ending)
        return;
    if (fds[FD_RENDER].revents)
        event_fd_clear(fds[FD_RENDER].fd); /* live_render_update() follows */
    if (fds[FD_SAVER].revents)
        end_save(studio);
    if (fds[FD_AUTOSAVE].revents)
        autosave_finish(&studio->autosave);
    if (fds[FD_KEEPER_TIMER].revents)
        autosave_write(&studio->autosave);
    if (fds[FD_DEVICE].revents)
        live_render_end_device(&studio->control);
    if (fds[FD_FILES].revents)
        live_render_check_files(&studio->control);
    if (fds[FD_RELOAD].revents)
        take_reload(studio);
    if (fds[FD_KEYS].revents)
        take_input(studio);
    if (!studio->is_ending)
        tty_events_expire(&studio->events, take_event, studio);
    frame_pacing_tick(&studio->workspace.screen.pace, clock_ns());
}

static void wait_for_events(struct studio *studio)
{
    const struct cl_start *start =
        studio->control.session->engine.backends.start;
    struct pollfd fds[FDS] = {
        [FD_KEYS].fd = STDIN_FILENO,
        [FD_SIGNALS].fd = tty_signal_fd(),
        [FD_RENDER].fd =
            render_event_fd(studio->control.session->engine.render),
        [FD_SAVER].fd = studio->control.saver.copying.event_fd,
        [FD_AUTOSAVE].fd = studio->control.keeping.copying.event_fd,
        [FD_KEEPER_TIMER].fd = studio->autosave.timer_fd,
        [FD_DEVICE].fd = start ? cl_start_event_fd(start) : -1,
        [FD_FILES].fd = studio->control.watch.fd,
        [FD_RELOAD].fd = studio->control.is_live
                             ? studio->control.reload.loading.event_fd
                             : -1,
    };
    uint64_t now_ns = clock_ns();
    uint64_t until_ns = wake_ns(studio, now_ns);
    uint64_t pause_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec pause = {(time_t)(pause_ns / S_NS),
                             (long)(pause_ns % S_NS)};

    for (int i = 0; i < FDS; i++)
        fds[i].events = POLLIN;
    if (ppoll(fds, FDS, until_ns == UINT64_MAX ? NULL : &pause, NULL) < 0)
        memset(fds, 0, sizeof fds); /* interrupted: FD_SIGNALS wakes it next */
    take_events(studio, fds);
}

/* A write to the terminal has failed: a signal has come, or the terminal is
 * gone. */
static void lose_terminal(struct studio *studio)
{
    take_signals(studio);
    if (studio->is_ending)
        return;
    studio->is_gone = true;
    studio_end(studio, 128 + SIGHUP);
}

static void loop(struct studio *studio)
{
    while (!studio->is_ending) {
        uint64_t now_ns = clock_ns();

        camera_control_step(&studio->camera, now_ns);
        autosave_note_changes(&studio->autosave);
        studio->workspace.has_kept = studio->autosave.offer_path != NULL;
        workspace_look(&studio->workspace);
        if (!workspace_draw(&studio->workspace, keys_of_now(studio), now_ns))
            lose_terminal(studio);
        if (!studio->is_ending)
            wait_for_events(studio);
    }
}

/* Says on the terminal that is left what the program waits for. */
static void say_writing(void)
{
    static const char text[] = "glim: files are being written; ^C ends without "
                               "them\n";

    if (!tty_is_open() && write(STDOUT_FILENO, text, sizeof text - 1) < 0)
        return; /* the terminal is gone */
}

/* Leaves the screen before the files, since a disk may be slow, or not answer
 * at all: then ^C ends the program. */
static void close_screen(struct studio *studio)
{
    bool is_lost = studio->status > 128; /* by a signal, or its key */

    if (is_lost)
        tty_ignore_termination(); /* shells send SIGHUP again */
    if (!studio->is_gone)
        screen_drain(&studio->workspace.screen, &studio->events.input);
    /* before what may take longer than stop.h allows: a driver, or a tree */
    stop_hold();
    stop_when_waiting(say_writing);
    tty_leave(studio->is_gone);
    save_finish(&studio->control);
    workspace_keep_picture(&studio->workspace);
    autosave_end(&studio->autosave, is_lost);
    state_list_finish();
    stop_release();
    /* before tty_close(): its end puts back the signal handlers of its start */
    backends_abandon_device(&studio->control.session->engine.backends);
    tty_close(studio->is_gone);
    for (int i = 0; i < studio->control.result_count && !studio->is_gone; i++)
        print_line(stdout, "%s", studio->control.results[i]);
    fflush(stdout);
    render_halt(studio->control.session->engine.render);
}

/* The render starts first: it works while the terminal is opened. */
bool studio_loop(struct session *s, int *status, struct error *err)
{
    const char *stats_path = s->options->stats_path;
    struct studio studio = {.has_mouse = true};
    bool ok;

    workspace_expect(s);
    if (stats_path && (!session_check_output(s, "--stats", stats_path, err) ||
                       !stats_json_check(stats_path, err)))
        return false;
    if (!live_render_init(&studio.control, s, err))
        return false;
    camera_control_init(&studio.camera, &studio.control,
                        &studio.workspace.screen);
    workspace_init(&studio.workspace, &studio.control, &studio.camera);
    ok = tty_open(err);
    if (ok) {
        workspace_open(&studio.workspace);
        if (s->notice[0] != '\0')
            live_render_say_long(&studio.control, "%s", s->notice);
        s->notice[0] = '\0';
        autosave_init(&studio.autosave, &studio.control, &studio.camera);
        /* after tty_open(): it puts back the signal handlers that it finds */
        if (s->options->backend != BACKEND_CPU)
            live_render_begin_device(&studio.control);
        loop(&studio);
        close_screen(&studio);
        autosave_free(&studio.autosave);
        *status = studio.status;
        session_progress(s);
        ok = !stats_path || stats_json_write(s, false, stats_path, err);
    }
    workspace_free(&studio.workspace);
    live_render_free(&studio.control);
    return ok;
}
