// SPDX-License-Identifier: MIT
/*
 * frame_pacing.h - when the next frame may be written, and how many bytes it may have
 *
 * After each frame the terminal is asked for a sign (ESC[5n). The next frame
 * waits for it, and the time it took says how fast the line is. The write
 * queue would not tell: over ssh megabytes fit between here and the screen.
 *
 * Units:     nanoseconds of clock_ns(), bytes
 * Ownership: none
 * Threads:   one thread at a time
 * Errors:    none; a terminal that never answers is written to all the same
 */
#ifndef GLIM_FRAME_PACING_H
#define GLIM_FRAME_PACING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Device status report: any terminal since the VT100 answers ESC[0n. */
#define PACE_REQUEST "\033[5n"

enum pace_state {
    PACE_UNKNOWN, /* asked for the first time, no answer yet */
    PACE_ANSWERS,
    PACE_MUTE /* no answer for long: go on without */
};

struct pace {
    enum pace_state state;
    int outstanding;   /* requests without an answer */
    uint64_t asked_ns; /* when the last request went out */
    uint64_t first_asked_ns;
    uint64_t rtt_min_ns;  /* the quickest answer so far, */
    size_t rtt_min_bytes; /* to so many */
    size_t frame_bytes;
    double bytes, seconds; /* of late frames beyond that: smoothed */
    double rate;           /* of them, bytes a second; 0: not known */
    double sure_rate;      /* the way included, of the best frame so far */
    size_t budget_bytes;
    bool first_frame_sent;
};

/* The first request is written now. */
void pace_init(struct pace *p, uint64_t now_ns);

/* Whether a frame may be written now. */
bool pace_may_send(const struct pace *p);

/* Whether the frame must end with PACE_REQUEST. */
bool pace_wants_request(const struct pace *p);

/* A frame of so many bytes was written between these times; with_request says
 * that PACE_REQUEST was at its end. */
void pace_sent(struct pace *p, size_t size_bytes, bool with_request,
               uint64_t begin_ns, uint64_t end_ns);

/* An answer to PACE_REQUEST came. */
void pace_answer(struct pace *p, uint64_t now_ns);

/* Gives up waiting when it took too long. Call it when pace_deadline_ns() has
 * passed, or more often. */
void pace_tick(struct pace *p, uint64_t now_ns);

/* Answers that are on their way will not come: somebody else has read them. */
void pace_forget(struct pace *p);

/* When pace_tick() would give up; UINT64_MAX: never. */
uint64_t pace_deadline_ns(const struct pace *p);

/* True if a line this slow had better show rough pictures. */
bool pace_is_slow(const struct pace *p);

#endif
