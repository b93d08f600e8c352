// SPDX-License-Identifier: MIT
/*
 * frame_pacing.h - when the next frame may be written, and how many bytes it
 * may have
 *
 * Each frame ends with a request that the terminal answers (ESC[5n). The next
 * frame waits for the answer, and the time that it took says how fast the line
 * is. The length of the write queue would not: over ssh megabytes fit between
 * the program and the screen.
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
    FRAME_PACING_UNKNOWN, /* the first request is not answered yet */
    FRAME_PACING_ANSWERS,
    FRAME_PACING_MUTE /* answers take too long: frames do not wait */
};

struct frame_pacing {
    enum frame_pacing_state state;
    int outstanding;   /* requests without an answer */
    uint64_t asked_ns; /* when the last request was written */
    uint64_t first_asked_ns;
    uint64_t rtt_min_ns;  /* the shortest round trip so far, */
    size_t rtt_min_bytes; /* which a frame of this size had */
    size_t frame_bytes;   /* of the frame without an answer; 0: none */
    /* by how much slower frames exceed both, smoothed */
    double bytes, seconds;
    double rate;         /* bytes / seconds; 0: not known */
    double sure_rate;    /* the most bytes a second, round trip included */
    size_t budget_bytes; /* of the next frame */
    bool first_frame_sent;
};

/* Call it when the first request is written. */
void frame_pacing_init(struct frame_pacing *p, uint64_t now_ns);

/* True if a frame may be written now. */
bool frame_pacing_may_send(const struct frame_pacing *p);

/* True if the frame must end with FRAME_PACING_REQUEST. */
bool frame_pacing_wants_request(const struct frame_pacing *p);

/* Call it after a frame was written between these times; with_request: it ended
 * with FRAME_PACING_REQUEST. */
void frame_pacing_sent(struct frame_pacing *p, size_t size_bytes,
                       bool with_request, uint64_t begin_ns, uint64_t end_ns);

/* Takes an answer to FRAME_PACING_REQUEST. */
void frame_pacing_answer(struct frame_pacing *p, uint64_t now_ns);

/* Stops waiting for an answer that takes too long. Call it when
 * frame_pacing_deadline_ns() has passed, or more often. */
void frame_pacing_tick(struct frame_pacing *p, uint64_t now_ns);

/* Expects no answers to the requests so far: another program has read them. */
void frame_pacing_forget(struct frame_pacing *p);

/* When frame_pacing_tick() stops waiting; UINT64_MAX: never. */
uint64_t frame_pacing_deadline_ns(const struct frame_pacing *p);

/* True if the line is too slow for every small change of a picture. */
bool frame_pacing_is_slow(const struct frame_pacing *p);

#endif
