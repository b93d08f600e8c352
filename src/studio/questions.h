// SPDX-License-Identifier: MIT
/*
 * questions.h - questions in the last line, most of them before something is
 * lost, and the effects of the answers
 *
 * Units:     keys are bytes or enum tty_key
 * Threads:   main only
 * Errors:    errors become messages
 */
#ifndef GLIM_QUESTIONS_H
#define GLIM_QUESTIONS_H

#include <stdbool.h>

struct studio;

enum question {
    QUESTION_NONE,
    QUESTION_QUIT,
    QUESTION_EDIT, /* quit without saving edits */
    QUESTION_LIVE, /* leave normal mode */
    QUESTION_RESTART,
    QUESTION_NUMBER, /* number for a view */
    QUESTION_KEPT    /* go on with a kept session */
};

/* Shows a question instead of the status line. QUESTION_NONE removes it. */
void question_ask(struct studio *studio, enum question question);

/* Takes any key as the answer and removes the question. Returns false if the
 * key is to have its effect, too. */
bool question_answer(struct studio *studio, int key);

#endif
