// SPDX-License-Identifier: MIT
#include "session/edit_history.h"

#include <stdlib.h>

#include "base/memory.h"
#include "terminal/xmalloc.h"

/* Longest pause within a gesture: longer than the delay of keyboards before a
 * held key repeats. */
#define GESTURE_NS UINT64_C(700000000)

static void free_step(struct edit_step *step)
{
    if (step->kind == STEP_MATERIAL)
        free(step->value.source);
    if (step->kind == STEP_LAMPS)
        lamps_free(&step->value.lamps);
}

/* Drops all steps from number `count` on. */
static void truncate_steps(struct edit_history *h, size_t count)
{
    while (h->step_count > count)
        free_step(&h->steps[--h->step_count]);
    h->done_count = count;
}

void edit_history_free(struct edit_history *h)
{
    truncate_steps(h, 0);
    free(h->steps);
    *h = (struct edit_history){.steps = NULL};
}

void edit_history_end_step(struct edit_history *h)
{
    h->group++;
    h->gesture = 0;
}

bool edit_history_begin_gesture(struct edit_history *h, uint32_t gesture,
                                uint64_t now_ns)
{
    bool is_new = gesture != h->gesture || now_ns - h->gesture_ns > GESTURE_NS;

    if (is_new)
        h->group++;
    h->gesture = gesture;
    h->gesture_ns = now_ns;
    return is_new;
}

static void push(struct edit_history *h, const struct edit_step *step)
{
    void *steps = h->steps;

    xcheck(grow_array(&steps, &h->step_capacity, h->step_count + 1,
                      sizeof *h->steps));
    h->steps = steps;
    h->steps[h->step_count++] = *step;
}

const struct edit_step *edit_history_add(struct edit_history *h,
                                         struct edit_step step)
{
    struct edit_step *last = NULL;

    truncate_steps(h, h->done_count);
    if (h->step_count > 0 && h->steps[h->step_count - 1].group == h->group)
        last = &h->steps[h->step_count - 1];
    if (last != NULL && last->kind == step.kind && last->index == step.index) {
        free_step(&step);
        return last;
    }
    if (last != NULL && h->gesture != 0)
        h->group++;
    step.group = h->group;
    push(h, &step);
    h->done_count = h->step_count;
    return &h->steps[h->step_count - 1];
}

void edit_history_drop_last(struct edit_history *h)
{
    truncate_steps(h, h->done_count - 1);
}

struct edit_step *edit_history_back(struct edit_history *h,
                                    const struct edit_step *group)
{
    struct edit_step *step;

    if (h->done_count == 0)
        return NULL;
    step = &h->steps[h->done_count - 1];
    if (group != NULL && step->group != group->group)
        return NULL;
    h->done_count--;
    return step;
}

struct edit_step *edit_history_forward(struct edit_history *h,
                                       const struct edit_step *group)
{
    struct edit_step *step;

    if (h->done_count == h->step_count)
        return NULL;
    step = &h->steps[h->done_count];
    if (group != NULL && step->group != group->group)
        return NULL;
    h->done_count++;
    return step;
}

void edit_history_take_camera(struct edit_history *h,
                              const struct edit_history *from)
{
    for (size_t i = 0; i < from->step_count; i++) {
        const struct edit_step *step = &from->steps[i];

        if (step->kind != STEP_POSE && step->kind != STEP_SHOT)
            continue;
        push(h, step);
        h->done_count += i < from->done_count;
    }
    h->group = from->group + 1;
}
