// SPDX-License-Identifier: MIT
#include "studio/commands.h"

#include <assert.h>

#include "studio/save_commands.h"

/* Command of an action: a function of one part of the studio, or one of the
 * values below. Functions and numbered views first end a move of the camera.
 * Functions of control, inspector, workspace and studio first restart the
 * render if the view has changed. */
struct command {
    void (*camera)(struct camera_control *camera);
    void (*cursor)(struct pick_cursor *cursor);
    void (*control)(struct render_control *control);
    void (*inspector)(struct inspector *inspector);
    void (*workspace)(struct workspace *workspace);
    void (*studio)(struct studio *studio);

    enum held_keys_axis axis; /* the camera moves along this axis */
    int sign;                 /* while the key is held: 1 or -1, or 0 for no
                                 move */
    int right, down;          /* cells by which the cursor moves */
    int number;               /* number of the view to go to, from 1 */
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
    [ACTION_FASTER] = {.camera = camera_control_faster},
    [ACTION_SLOWER] = {.camera = camera_control_slower},
    [ACTION_CURSOR] = {.cursor = pick_cursor_show},
    [ACTION_CANCEL] = {.control = render_control_clear_message},
    [ACTION_ORBIT] = {.camera = camera_control_switch_orbit},
    [ACTION_WALLS] = {.camera = camera_control_switch_walls},
    [ACTION_FRAME] = {.camera = camera_control_frame_object},
    [ACTION_FRAME_ALL] = {.camera = camera_control_frame_all},
    [ACTION_NARROWER] = {.axis = HELD_KEYS_WIDEN, .sign = -1},
    [ACTION_WIDER] = {.axis = HELD_KEYS_WIDEN, .sign = 1},
    [ACTION_FOCUS] = {.camera = camera_control_focus},
    [ACTION_CLOSE] = {.axis = HELD_KEYS_OPEN, .sign = -1},
    [ACTION_OPEN] = {.axis = HELD_KEYS_OPEN, .sign = 1},
    [ACTION_UNDO] = {.camera = camera_control_undo},
    [ACTION_REDO] = {.camera = camera_control_redo},
    [ACTION_RESET] = {.camera = camera_control_reset},
    [ACTION_KEEP] = {.studio = studio_keep_view},
    [ACTION_VIEW_1] = {.number = 1},
    [ACTION_VIEW_2] = {.number = 2},
    [ACTION_VIEW_3] = {.number = 3},
    [ACTION_VIEW_4] = {.number = 4},
    [ACTION_VIEW_5] = {.number = 5},
    [ACTION_VIEW_6] = {.number = 6},
    [ACTION_VIEW_7] = {.number = 7},
    [ACTION_VIEW_8] = {.number = 8},
    [ACTION_VIEW_9] = {.number = 9},
    [ACTION_SAVE_VIEW] = {.control = save_view},
    [ACTION_VIEW_NEXT] = {.inspector = inspector_next_view},
    [ACTION_VIEW_BACK] = {.inspector = inspector_previous_view},
    [ACTION_KEEP_RENDER] = {.workspace = workspace_keep_render},
    [ACTION_COMPARE] = {.workspace = workspace_compare},
    [ACTION_FILTER] = {.inspector = inspector_switch_filter},
    [ACTION_DRAWING] = {.workspace = workspace_next_drawing},
    [ACTION_LESS] = {.inspector = inspector_less},
    [ACTION_MORE] = {.inspector = inspector_more},
    [ACTION_PANEL] = {.workspace = workspace_open_panel},
    [ACTION_MODE] = {.studio = studio_change_mode},
    [ACTION_START] = {.control = render_control_start_or_halt},
    [ACTION_STEP] = {.control = render_control_step},
    [ACTION_RESTART] = {.studio = studio_restart},
    [ACTION_SAVE] = {.inspector = inspector_save},
    [ACTION_SAVE_TEXT] = {.inspector = inspector_save_text},
    [ACTION_SAVE_LINEAR] = {.inspector = inspector_save_hdr},
    [ACTION_BACKEND] = {.control = render_control_switch_backend},
    [ACTION_RELOAD] = {.control = render_control_reload},
    [ACTION_COLORS] = {.workspace = workspace_next_colors},
    [ACTION_GLYPHS] = {.workspace = workspace_next_glyphs},
    [ACTION_METER] = {.workspace = workspace_switch_progress},
    [ACTION_HIDE] = {.workspace = workspace_switch_status},
    [ACTION_MOUSE] = {.studio = studio_switch_mouse},
    [ACTION_REDRAW] = {.workspace = workspace_layout},
    [ACTION_HELP] = {.workspace = workspace_open_help},
    [ACTION_SUSPEND] = {.studio = studio_suspend},
    [ACTION_INTERRUPT] = {.studio = studio_interrupt},
    [ACTION_ABORT] = {.studio = studio_abort},
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
    render_control_restart_if_outdated(&studio->control);
    if (c->control)
        c->control(&studio->control);
    else if (c->inspector)
        c->inspector(&studio->workspace.inspector);
    else if (c->workspace)
        c->workspace(&studio->workspace);
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
    if (c->number != 0)
        camera_control_go_to_view(camera, c->number);
    else if (c->cursor)
        c->cursor(&camera->cursor);
    else if (c->camera)
        c->camera(camera);
    else
        run_settled(studio, c);
}

void command_run(struct studio *studio, enum action action)
{
    if (action != ACTION_NONE)
        run(studio, &commands[action]);
}

bool command_run_at_cursor(struct studio *studio, enum action action)
{
    const struct command *c = &cursor_commands[action];

    if (!studio->workspace.screen.has_cursor ||
        (c->right == 0 && c->down == 0 && !c->cursor && !c->camera))
        return false;
    run(studio, c);
    return true;
}
