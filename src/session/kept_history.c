// SPDX-License-Identifier: MIT
#include "session/kept_history.h"

#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "terminal/xmalloc.h"

/* Texts of a state, which come first in enum kept_part. */
#define STATE_PARTS KEPT_HISTORY

/* ---- write ---- */

/* A text that grows. */
struct text {
    char *bytes;
    size_t size;
};

static void add(struct text *t, const char *bytes, size_t size)
{
    t->bytes = xrealloc(t->bytes, t->size + size + 1);
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
    t->bytes[t->size] = '\0';
}

static void add_numbers(struct text *t, const size_t *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        char *text = xformat("%zu%c", numbers[i], i + 1 < count ? ' ' : '\n');

        add(t, text, strlen(text));
        free(text);
    }
}

/* Adds the present state of the edit. */
static bool add_state(struct text *t, const struct session *s, const char *path,
                      struct error *err)
{
    struct kept state = {.scene = NULL};
    bool ok = kept_edit_take(&state, s, path, err);

    if (ok)
        add_numbers(t, state.sizes, STATE_PARTS);
    for (int i = 0; ok && i < STATE_PARTS; i++)
        add(t, state.parts[i], state.sizes[i]);
    kept_free(&state);
    return ok;
}

/* Undoes or redoes steps, at most this number. Returns how many there were. */
static size_t walk(struct edit *e, const char *(*step)(struct edit *),
                   size_t most)
{
    size_t count = 0;

    while (count < most && step(e) != NULL)
        count++;
    return count;
}

/* Returns the most steps that are kept of a session whose present state is
 * this large. */
static size_t most_steps(const struct kept *k)
{
    size_t size = 1, most;

    for (int i = 0; i < STATE_PARTS; i++)
        size += k->sizes[i];
    most = KEPT_STEPS_BYTES / size;
    return most < KEPT_STEPS_MAX ? most : KEPT_STEPS_MAX;
}

/* Adds the states before and after the present one: goes to the oldest and from
 * there to the newest. */
static bool add_states(struct text *t, struct session *s, size_t most,
                       const char *path, struct error *err)
{
    struct edit *e = &s->edit;
    size_t undone = walk(e, edit_redo, most);
    size_t done;
    bool ok = true;

    walk(e, edit_undo, undone);
    done = walk(e, edit_undo, most);
    add_numbers(t, (size_t[]){done, undone}, 2);
    for (size_t i = 0; i < done; i++) {
        ok = ok && add_state(t, s, path, err);
        edit_redo(e);
    }
    for (size_t i = 0; i < undone; i++) {
        edit_redo(e);
        ok = ok && add_state(t, s, path, err);
    }
    walk(e, edit_undo, undone);
    return ok;
}

bool kept_history_take(struct kept *k, struct session *s, const char *path,
                       struct error *err)
{
    struct edit *e = &s->edit;
    const struct edit before = *e;
    struct text t = {.bytes = NULL};
    bool ok = kept_edit_take(k, s, path, err) &&
              add_states(&t, s, most_steps(k), path, err);

    k->parts[KEPT_HISTORY] = t.bytes;
    k->sizes[KEPT_HISTORY] = t.size;
    /* the values are the same, and a gesture goes on */
    e->version = before.version;
    e->is_comparing = before.is_comparing;
    e->history.group = before.history.group;
    e->history.gesture = before.history.gesture;
    memcpy(e->step_text, before.step_text, sizeof e->step_text);
    return ok;
}

/* ---- restore ---- */

struct reader {
    const char *p, *end, *path;
};

/* Reads the numbers of a line. A NUL is after the text. */
static bool read_numbers(struct reader *r, size_t *numbers, int count,
                         struct error *err)
{
    for (int i = 0; i < count; i++) {
        uint64_t number;

        if (!digits_parse(&r->p, 10, SIZE_MAX, &number) ||
            *r->p++ != (i + 1 < count ? ' ' : '\n'))
            return fail(err,
                        "%s: found another text in the history, expected "
                        "numbers",
                        r->path);
        numbers[i] = (size_t)number;
    }
    return true;
}

/* Reads the texts of a state. The caller frees after a failure, too. */
static bool read_state(struct reader *r, struct kept *state, struct error *err)
{
    size_t sizes[STATE_PARTS];

    *state = (struct kept){.scene = NULL};
    if (!read_numbers(r, sizes, STATE_PARTS, err))
        return false;
    for (int i = 0; i < STATE_PARTS; i++) {
        if (sizes[i] > (size_t)(r->end - r->p))
            return fail(err, "%s: found the end of the history, expected more",
                        r->path);
        state->parts[i] = xmalloc(sizes[i] + 1);
        memcpy(state->parts[i], r->p, sizes[i]);
        state->parts[i][sizes[i]] = '\0';
        state->sizes[i] = sizes[i];
        r->p += sizes[i];
    }
    return true;
}

static bool restore_next(struct reader *r, struct session *s, struct error *err)
{
    struct kept state;
    uint32_t missing;
    bool ok = read_state(r, &state, err) &&
              kept_edit_restore(&state, s, r->path, &missing, err);

    kept_free(&state);
    return ok;
}

bool kept_history_restore(const struct kept *k, struct session *s,
                          const char *path, uint32_t *missing,
                          struct error *err)
{
    const char *text = k->parts[KEPT_HISTORY];
    struct reader r = {text, text + k->sizes[KEPT_HISTORY], path};
    size_t numbers[2] = {0}; /* of done and of undone steps */
    size_t done;

    if (!read_numbers(&r, numbers, 2, err))
        return false;
    for (size_t i = 0; i < numbers[0]; i++) {
        if (!restore_next(&r, s, err))
            return false;
        if (i == 0)
            edit_forget_steps(&s->edit);
    }
    if (!kept_edit_restore(k, s, path, missing, err))
        return false;
    done = s->edit.history.done_count;
    for (size_t i = 0; i < numbers[1]; i++)
        if (!restore_next(&r, s, err))
            return false;
    while (s->edit.history.done_count > done)
        edit_undo(&s->edit);
    return true;
}
