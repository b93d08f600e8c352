// SPDX-License-Identifier: MIT
#include "studio/prompts.h"

#include <stddef.h>

static const struct {
    const char *text;
    char save; /* the key that saves what would be lost */
} questions[] = {
    [QUESTION_NONE] = {NULL, 0},
    [QUESTION_QUIT] = {"The render is not saved. Quit? y: yes, p: save it, "
                       "other: no",
                       'p'},
    [QUESTION_EDIT] = {"Changes of materials or light are not saved. Quit? "
                       "y: yes, s: save, other: no",
                       's'},
    [QUESTION_LIVE] = {"The render is not saved. Leave it? y: yes, p: save "
                       "it, other: no",
                       'p'},
    [QUESTION_RESTART] = {"The render is not saved. Start anew? y: yes, p: "
                          "save it, other: no",
                          'p'},
    [QUESTION_NUMBER] = {"Which number for this view? 1 to 9, other: none", 0},
};

const char *question_text(enum question question)
{
    return questions[question].text;
}

enum answer question_answer(enum question question, int key)
{
    int small = key >= 'A' && key <= 'Z' ? key - 'A' + 'a' : key;

    if (small == 'y')
        return ANSWER_YES;
    return small == questions[question].save ? ANSWER_SAVE : ANSWER_NO;
}
