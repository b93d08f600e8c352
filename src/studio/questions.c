// SPDX-License-Identifier: MIT
#include "studio/studio.h"

#include "studio/save_commands.h"

static void end(struct studio *studio)
{
    studio_end(studio, 0);
}

static void go_live(struct studio *studio)
{
    studio_set_live(studio, true);
}

static void restart(struct studio *studio)
{
    render_control_restart(&studio->control);
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
 * any other key means no. */
static const struct {
    const char *text;
    void (*yes)(struct studio *studio);
    char save_key;
    void (*save)(struct studio *studio);
} questions[] = {
    [QUESTION_NONE] = {0},
    [QUESTION_QUIT] = {"The render is not saved. Quit? y: yes, p: save it, "
                       "other: no",
                       end, 'p', save_render},
    [QUESTION_EDIT] = {"Materials or light are not saved. Quit? "
                       "y: yes, s: save, other: no",
                       end, 's', save_and_quit},
    [QUESTION_LIVE] = {"The render is not saved. Leave it? y: yes, p: save "
                       "it, other: no",
                       go_live, 'p', save_render},
    [QUESTION_RESTART] = {"The render is not saved. Restart it? y: yes, p: "
                          "save it, other: no",
                          restart, 'p', save_render},
    [QUESTION_NUMBER] = {.text = "Which number for this view? 1 to 9, other: "
                                 "none"},
    [QUESTION_KEPT] = {0}, /* its text is that of the session keeper */
};

void question_ask(struct studio *studio, enum question question)
{
    studio->question = question;
    workspace_ask(&studio->workspace, question == QUESTION_KEPT
                                          ? studio->keeper.question
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
        session_keeper_go_on(&studio->keeper);
        workspace_refresh(&studio->workspace);
    } else {
        session_keeper_start_anew(&studio->keeper);
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
