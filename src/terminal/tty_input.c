// SPDX-License-Identifier: MIT
#include "terminal/tty_input.h"

#include <string.h>

#define ESC 27

/* Longer than any expected answer; longer sequences are dropped. */
#define SEQUENCE_MAX 512

/* Enough for the device attributes of all terminals. */
#define PARAMS_MAX 32

/* Numbers of the sequences around pasted text. */
#define MARK_BEGIN 200
#define MARK_END   201

/* First sequence in the buffer. */
struct sequence {
    size_t length; /* 0 if incomplete */
    int mark;      /* of pasted text: MARK_BEGIN, MARK_END; 0: none */
    bool has_event;
    struct event event;
};

size_t tty_input_feed(struct tty_input *in, const void *bytes, size_t count)
{
    size_t room = sizeof in->bytes - in->length;

    if (count > room)
        count = room;
    memcpy(in->bytes + in->length, bytes, count);
    in->length += count;
    return count;
}

static void set_key(struct sequence *s, int key)
{
    s->has_event = true;
    s->event = (struct event){.kind = EVENT_KEY, .key = key};
}

static void set_answer(struct sequence *s, enum event_kind kind, int x, int y)
{
    s->has_event = true;
    s->event = (struct event){.kind = kind, .x = x, .y = y};
}

/* Parses "12;3" into params; the rest are 0. Returns their number. */
static int read_params(const unsigned char *p, size_t length,
                       int params[PARAMS_MAX])
{
    int count = 1;

    memset(params, 0, PARAMS_MAX * sizeof params[0]);
    for (size_t i = 0; i < length; i++) {
        if (p[i] >= '0' && p[i] <= '9') {
            int *v = &params[count - 1];

            if (*v < 100000)
                *v = *v * 10 + (p[i] - '0');
        } else if ((p[i] == ';' || p[i] == ':') && count < PARAMS_MAX) {
            count++;
        }
    }
    return count;
}

/* Parses b;x;yM or b;x;ym. Bits of b: 0-1 button, 2-4 Shift, Alt and Ctrl, 5
 * motion, 6 wheel. */
static void set_mouse(struct sequence *s, const int *params, bool released)
{
    int b = params[0];
    struct event *e = &s->event;

    s->has_event = true;
    *e = (struct event){.kind = EVENT_MOUSE,
                        .mouse = MOUSE_OTHER,
                        .button = b & 3,
                        .is_modified = (b & 24) != 0,
                        .x = params[1],
                        .y = params[2]};
    if (b & 128)
        return;
    if (b & 64) {
        if ((b & 3) < 2)
            e->mouse = b & 1 ? MOUSE_WHEEL_DOWN : MOUSE_WHEEL_UP;
    } else if (b & 32) {
        if (e->button != 3)
            e->mouse = MOUSE_DRAG;
    } else {
        e->mouse = released ? MOUSE_RELEASE : MOUSE_PRESS;
    }
}

static int key_of_letter(unsigned char letter)
{
    switch (letter) {
    case 'A': return TTY_KEY_UP;
    case 'B': return TTY_KEY_DOWN;
    case 'C': return TTY_KEY_RIGHT;
    case 'D': return TTY_KEY_LEFT;
    case 'F': return TTY_KEY_END;
    case 'H': return TTY_KEY_HOME;
    case 'P': return TTY_KEY_F1;
    case 'M': return '\r'; /* Enter of the keypad */
    default: return TTY_KEY_OTHER;
    }
}

static int key_of_number(int number)
{
    switch (number) {
    case 1:
    case 7: return TTY_KEY_HOME;
    case 2: return TTY_KEY_INSERT;
    case 3: return TTY_KEY_DELETE;
    case 4:
    case 8: return TTY_KEY_END;
    case 5: return TTY_KEY_PAGE_UP;
    case 6: return TTY_KEY_PAGE_DOWN;
    case 11: return TTY_KEY_F1;
    default: return TTY_KEY_OTHER;
    }
}

/* Returns true if attribute 4, sixel graphics, follows the terminal's class. */
static bool lists_sixels(const int *params, int count)
{
    for (int i = 1; i < count; i++) {
        if (params[i] == 4)
            return true;
    }
    return false;
}

/* Takes an answer that begins with ESC[? */
static void set_private(struct sequence *s, const int *params, int count,
                        unsigned char last)
{
    if (last == 'c')
        set_answer(s, EVENT_ATTRIBUTES, lists_sixels(params, count), 0);
    else if (last == 'S' && params[0] == 1 && params[1] == 0)
        set_answer(s, EVENT_SIXEL_COLORS, params[2], 0);
    else if (last == 'y' && params[0] == 2026 && params[1] >= 1 &&
             params[1] <= 3)
        set_answer(s, EVENT_SYNC, 0, 0);
}

static void set_csi(struct sequence *s, const unsigned char *p, size_t length,
                    unsigned char last)
{
    int params[PARAMS_MAX];
    int count = read_params(p, length, params);

    if (length > 0 && p[0] == '<') {
        if (last == 'M' || last == 'm')
            set_mouse(s, params, last == 'm');
    } else if (length > 0 && p[0] == '?') {
        set_private(s, params, count, last);
    } else if (length > 0 && (p[0] == '>' || p[0] == '=')) {
        return; /* not an answer to a question of glim's */
    } else if (last == 'n') {
        if (params[0] == 0)
            set_answer(s, EVENT_READY, 0, 0);
    } else if (last == 't') {
        if (params[0] == 6 && count >= 3)
            set_answer(s, EVENT_CELL_SIZE, params[2], params[1]);
    } else if (last == 'R') {
        set_answer(s, EVENT_CURSOR, params[1], params[0]);
    } else if (last == '~' &&
               (params[0] == MARK_BEGIN || params[0] == MARK_END)) {
        s->mark = params[0];
    } else if (last == '~') {
        set_key(s, key_of_number(params[0]));
    } else {
        set_key(s, key_of_letter(last));
    }
}

/* Takes ESC [, parameters and intermediates (0x20-0x3f), a final byte
 * (0x40-0x7e). */
static void take_csi(struct sequence *s, const unsigned char *p, size_t length)
{
    size_t i = 2;

    if (length > 2 && p[2] == '[') { /* F1 on the Linux console is ESC[[A */
        if (length > 3) {
            s->length = 4;
            set_key(s, p[3] == 'A' ? TTY_KEY_F1 : TTY_KEY_OTHER);
        }
        return;
    }
    while (i < length && p[i] >= 0x20 && p[i] <= 0x3f)
        i++;
    if (i == length)
        return;
    if (p[i] < 0x40 || p[i] > 0x7e) {
        s->length = i; /* interrupted: this byte begins another sequence */
        return;
    }
    s->length = i + 1;
    set_csi(s, p + 2, i - 2, p[i]);
}

/* Checks the colour that DECRQSS reports: 0;48:2::1:2:3m, with colons or
 * semicolons. A terminal that rounds colours reports 48:5:16. */
static bool reports_true_color(const unsigned char *p, size_t length)
{
    for (size_t i = 0; i + 4 <= length; i++) {
        if (p[i] == '4' && p[i + 1] == '8' &&
            (p[i + 2] == ':' || p[i + 2] == ';') && p[i + 3] == '2' &&
            (i + 4 == length || p[i + 4] < '0' || p[i + 4] > '9'))
            return true;
    }
    return false;
}

/* Checks for _Gi=1;OK. Terminals without the protocol do not answer, or report
 * an error. */
static bool accepts_kitty(const unsigned char *p, size_t length)
{
    return length >= 4 && p[0] == 'G' && memcmp(p + length - 3, ";OK", 3) == 0;
}

void tty_name(char name[TTY_NAME_BYTES], const char *from, size_t length)
{
    length = length < TTY_NAME_BYTES ? length : TTY_NAME_BYTES - 1;
    for (size_t i = 0; i < length; i++)
        name[i] = from[i] > ' ' && from[i] <= '~' ? from[i] : '_';
    name[length] = '\0';
}

/* Takes >|NAME(VERSION), the answer to XTVERSION. */
static void set_name(struct sequence *s, const unsigned char *p, size_t length)
{
    if (length <= 2 || p[0] != '>' || p[1] != '|')
        return;
    set_answer(s, EVENT_NAME, 0, 0);
    tty_name(s->event.name, (const char *)p + 2, length - 2);
}

static int digit_of(unsigned char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Reads a background: 11;rgb:RRRR/GGGG/BBBB with one to four digits a channel.
 * *is_light tells if it is nearer to white than to black. */
static bool reads_background(const unsigned char *p, size_t length,
                             bool *is_light)
{
    static const int weights[3] = {2, 5, 1};
    int sum = 0, channel = 0, digits = 0;

    if (length < 12 || memcmp(p, "11;rgb:", 7) != 0)
        return false;
    for (size_t i = 7; i < length && channel < 3; i++) {
        if (p[i] == '/' && digits > 0) {
            channel++;
            digits = 0;
        } else if (digit_of(p[i]) >= 0) {
            if (digits++ == 0) /* the first digit says enough */
                sum += weights[channel] * digit_of(p[i]);
        } else {
            return false;
        }
    }
    *is_light = sum > 8 * 15 / 2;
    return channel == 2 && digits > 0;
}

/* Takes ESC P, ], ^, _ or X and the text up to ESC \ or BEL. */
static void take_string(struct sequence *s, const unsigned char *p,
                        size_t length)
{
    bool is_light;

    for (size_t i = 2; i < length; i++) {
        bool ends = p[i] == 7;

        if (p[i] == ESC) {
            if (i + 1 == length)
                return;
            if (p[i + 1] != '\\') {
                s->length = i;
                return;
            }
            ends = true;
        }
        if (!ends)
            continue;
        s->length = p[i] == 7 ? i + 1 : i + 2;
        if (p[1] == 'P' && reports_true_color(p + 2, i - 2))
            set_answer(s, EVENT_TRUE_COLOR, 0, 0);
        else if (p[1] == 'P')
            set_name(s, p + 2, i - 2);
        else if (p[1] == '_' && accepts_kitty(p + 2, i - 2))
            set_answer(s, EVENT_KITTY, 0, 0);
        else if (p[1] == ']' && reads_background(p + 2, i - 2, &is_light))
            set_answer(s, EVENT_BACKGROUND, is_light, 0);
        return;
    }
}

static void take_escape(struct sequence *s, const unsigned char *p,
                        size_t length)
{
    if (length < 2)
        return;
    switch (p[1]) {
    case '[': take_csi(s, p, length); break;
    case 'O':
        if (length > 2) {
            s->length = 3;
            set_key(s, key_of_letter(p[2]));
        }
        break;
    case 'P':
    case ']':
    case '^':
    case '_':
    case 'X': take_string(s, p, length); break;
    default: /* ESC and a key soon after: the same bytes as Alt and the key */
        s->length = 1;
        set_key(s, ESC);
        break;
    }
    if (s->length == 0 && length >= SEQUENCE_MAX)
        s->length = length;
}

/* Returns the length of the UTF-8 character that starts with this byte; 1 for
 * an invalid byte. */
static size_t character_bytes(unsigned char first)
{
    if (first < 0xc2 || first > 0xf4)
        return 1;
    return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/* Takes one UTF-8 character as one key. */
static void take_character(struct sequence *s, const unsigned char *p,
                           size_t length)
{
    size_t count = character_bytes(p[0]);
    size_t i = 1;

    while (i < length && i < count && (p[i] & 0xc0) == 0x80)
        i++;
    if (i == length && i < count)
        return;
    s->length = i;
    if (p[0] < 0x80)
        set_key(s, p[0] == '\n' ? '\r' : p[0]);
    else
        set_key(s, TTY_KEY_OTHER);
}

bool tty_input_next(struct tty_input *in, bool nothing_follows,
                    struct event *event)
{
    while (in->length > 0) {
        struct sequence s = {0};

        if (in->bytes[0] == ESC)
            take_escape(&s, in->bytes, in->length);
        else
            take_character(&s, in->bytes, in->length);
        if (s.length == 0) {
            if (!nothing_follows)
                return false;
            if (in->bytes[0] != ESC)
                set_key(&s, TTY_KEY_OTHER);
            else if (in->length == 1)
                set_key(&s, ESC);
            s.length = in->length;
        }
        in->length -= s.length;
        memmove(in->bytes, in->bytes + s.length, in->length);
        if (s.mark != 0)
            in->is_pasting = s.mark == MARK_BEGIN;
        if (s.has_event) {
            *event = s.event;
            if (in->is_pasting &&
                (s.event.kind == EVENT_KEY || s.event.kind == EVENT_MOUSE))
                event->kind = EVENT_PASTED;
            return true;
        }
    }
    return false;
}
