// SPDX-License-Identifier: MIT
/*
 * prompts.h - what is asked, most of it before something is lost
 *
 * Units:     keys are bytes or enum tty_key
 * Ownership: strings live as long as the program
 * Threads:   any
 */
#ifndef GLIM_PROMPTS_H
#define GLIM_PROMPTS_H

enum question {
    QUESTION_NONE,
    QUESTION_QUIT,
    QUESTION_EDIT, /* quit without what was edited */
    QUESTION_LIVE, /* leave normal mode */
    QUESTION_RESTART,
    QUESTION_NUMBER /* of a view: the answer is an action */
};

/* With the keys that answer it; NULL for none. */
const char *question_text(enum question question);

/* Any other key than those is a no. */
enum answer { ANSWER_NO, ANSWER_YES, ANSWER_SAVE };
enum answer question_answer(enum question question, int key);

#endif
