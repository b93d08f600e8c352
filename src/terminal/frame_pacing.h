// SPDX-License-Identifier: MIT
/*
 * frame_pacing.h - when the next frame may be written, and how many bytes it
 * may have
 *
 * After each frame the terminal is asked for a sign (ESC[5n). The next frame
 * waits for it, and the time it took says how fast the line is. The write
 * queue would not tell: over ssh megabytes fit between here and the screen.
 *
 * Units:     nanoseconds of clock_ns(), bytes
 * Threads:   one thread at a time
 * Errors:    none; a terminal that never answers is written to all the same
 */
#ifndef GLIM_FRAME_PACING_H
#define GLIM_FRAME_PACING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Device status report: any terminal since the VT100 answers ESC[0n. */
#define FRAME_PACING_REQUEST "\033[5n"

enum frame_pacing_state {
    FRAME_PACING_UNKNOWN, /* asked for the first time, no answer yet */
    FRAME_PACING_ANSWERS,
    FRAME_PACING_MUTE /* no answer for long: go on without */
};

struct frame_pacing {
    enum frame_pacing_state state;
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
void frame_pacing_init(struct frame_pacing *p, uint64_t now_ns);

/* Whether a frame may be written now. */
bool frame_pacing_may_send(const struct frame_pacing *p);

/* Whether the frame must end with FRAME_PACING_REQUEST. */
bool frame_pacing_wants_request(const struct frame_pacing *p);

/* A frame of so many bytes was written between these times; with_request says
 * that FRAME_PACING_REQUEST was at its end. */
void frame_pacing_sent(struct frame_pacing *p, size_t size_bytes,
                       bool with_request, uint64_t begin_ns, uint64_t end_ns);

/* An answer to FRAME_PACING_REQUEST came. */
void frame_pacing_answer(struct frame_pacing *p, uint64_t now_ns);

/* Gives up waiting when it took too long. Call it when
 * frame_pacing_deadline_ns() has passed, or more often. */
void frame_pacing_tick(struct frame_pacing *p, uint64_t now_ns);

/* Answers that are on their way will not come: somebody else has read them. */
void frame_pacing_forget(struct frame_pacing *p);

/* When frame_pacing_tick() would give up; UINT64_MAX: never. */
uint64_t frame_pacing_deadline_ns(const struct frame_pacing *p);

/* True if a line this slow had better show rough pictures. */
bool frame_pacing_is_slow(const struct frame_pacing *p);

#endif
