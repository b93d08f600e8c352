// SPDX-License-Identifier: MIT
#include "studio/studio.h"

#include <signal.h>

#include "studio/save_commands.h"

void studio_end(struct studio *studio, int status)
{
    studio->is_ending = true;
    studio->status = status;
}

void studio_interrupt(struct studio *studio)
{
    studio_end(studio, 128 + SIGINT);
}

void studio_abort(struct studio *studio)
{
    studio_end(studio, 128 + SIGQUIT);
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
    render_control_set_live(&studio->control, is_live);
}

/* Returns true if a render of normal mode has not been saved. Waits for a save
 * in progress. */
static bool would_lose_render(struct studio *studio)
{
    return save_finish(&studio->control) &&
           render_control_has_unsaved(&studio->control);
}

void studio_change_mode(struct studio *studio)
{
    if (would_lose_render(studio))
        question_ask(studio, QUESTION_LIVE);
    else
        studio_set_live(studio, !studio->control.is_live);
}

void studio_restart(struct studio *studio)
{
    if (would_lose_render(studio))
        question_ask(studio, QUESTION_RESTART);
    else
        render_control_restart(&studio->control);
}

void studio_quit(struct studio *studio)
{
    if (!save_finish(&studio->control))
        return;
    if (render_control_has_unsaved(&studio->control))
        question_ask(studio, QUESTION_QUIT);
    else if (render_control_has_unsaved_edit(&studio->control))
        question_ask(studio, QUESTION_EDIT);
    else
        studio_end(studio, 0);
}

void studio_keep_view(struct studio *studio)
{
    question_ask(studio, QUESTION_NUMBER);
}

void studio_switch_mouse(struct studio *studio)
{
    studio->has_mouse = !studio->has_mouse;
    camera_control_stop(&studio->camera);
    tty_set_mouse(studio->has_mouse);
    render_control_say(&studio->control, studio->has_mouse
                                             ? "mouse on: drag to look around"
                                             : "mouse off");
}
