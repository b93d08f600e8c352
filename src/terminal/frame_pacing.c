// SPDX-License-Identifier: MIT
#include "terminal/frame_pacing.h"

/* Seconds of output in a frame. A key waits for the frame on its way and its
 * answer, half of that on average, and for its own frame. With a round trip of
 * 200 ms a frame of 0.08 s makes that a median of 0.42 s, and uses more than a
 * quarter of the line. */
#define FRAME_SECONDS 0.08

/* Least bytes of a frame, enough for some cells on any line. */
#define BUDGET_MIN 600

/* Bytes of the first frame: half a second at 256 kbit/s. */
#define BUDGET_FIRST 16384

#define BUDGET_MAX ((size_t)1 << 30)

/* Most growth from one frame to the next: a rate that was measured too high is
 * corrected before a frame takes seconds. */
#define GROWTH_MAX 2

/* Smaller frames take too short to measure the line. */
#define MEASURE_BYTES 1000

/* Longest wait for an answer: the first, and later ones. */
#define FIRST_ANSWER_NS 400000000u
#define LOST_ANSWER_NS  5000000000u

/* Below a megabyte a second a frame of a common window takes visibly long. */
#define SLOW_RATE 1e6

void frame_pacing_init(struct frame_pacing *p, uint64_t now_ns)
{
    *p = (struct frame_pacing){.state = FRAME_PACING_UNKNOWN,
                               .outstanding = 1,
                               .asked_ns = now_ns,
                               .first_asked_ns = now_ns,
                               .budget_bytes = BUDGET_FIRST};
}

bool frame_pacing_may_send(const struct frame_pacing *p)
{
    if (p->state == FRAME_PACING_UNKNOWN)
        return !p->first_frame_sent;
    return p->state == FRAME_PACING_MUTE || p->outstanding == 0;
}

bool frame_pacing_wants_request(const struct frame_pacing *p)
{
    return p->state != FRAME_PACING_MUTE;
}

/* Bytes and times are smoothed separately: otherwise a small frame whose answer
 * was quick by chance would mean megabytes a second. */
static void learn_rate(struct frame_pacing *p, size_t bytes, double seconds)
{
    double weight = p->rate > 0 ? 0.3 : 1;
    double most = GROWTH_MAX * (double)p->budget_bytes;
    double budget;

    p->bytes += weight * ((double)bytes - p->bytes);
    p->seconds += weight * (seconds - p->seconds);
    p->rate = p->bytes / (p->seconds > 5e-4 ? p->seconds : 5e-4);
    budget = p->rate * FRAME_SECONDS;
    budget = budget < most ? budget : most;
    if (budget >= (double)BUDGET_MAX)
        p->budget_bytes = BUDGET_MAX;
    else
        p->budget_bytes = budget < BUDGET_MIN ? BUDGET_MIN : (size_t)budget;
}

/* Frames of equal size say nothing about the rate. So frames become smaller,
 * down to what sure_rate allows, and then larger, until sizes differ enough. */
static void look_for_rate(struct frame_pacing *p)
{
    double sure = p->sure_rate * FRAME_SECONDS;

    if ((double)p->budget_bytes > sure && p->budget_bytes > 2 * BUDGET_MIN)
        p->budget_bytes -= p->budget_bytes / 8;
    else if (p->frame_bytes > p->budget_bytes / 2 &&
             p->budget_bytes <= BUDGET_MAX / 2)
        p->budget_bytes *= 2;
}

/* The rate comes from the additional time of a larger frame over that of the
 * quickest: the difference has neither the round trip nor a slow start in it.
 */
static void learn_from_answer(struct frame_pacing *p, uint64_t rtt_ns)
{
    double least = (double)p->frame_bytes / ((double)(rtt_ns + 1) * 1e-9);

    p->sure_rate = least > p->sure_rate ? least : p->sure_rate;
    if (rtt_ns <= p->rtt_min_ns) {
        p->rtt_min_ns = rtt_ns;
        p->rtt_min_bytes = p->frame_bytes;
    } else if (p->frame_bytes > p->rtt_min_bytes + MEASURE_BYTES) {
        learn_rate(p, p->frame_bytes - p->rtt_min_bytes,
                   (double)(rtt_ns - p->rtt_min_ns) * 1e-9);
    } else if (p->frame_bytes > MEASURE_BYTES) {
        look_for_rate(p);
    }
}

/* Without answers the rate comes from the time that write() took. */
static void learn_from_write(struct frame_pacing *p, uint64_t took_ns)
{
    if (took_ns > 2000000u && p->frame_bytes > MEASURE_BYTES)
        learn_rate(p, p->frame_bytes, (double)took_ns * 1e-9);
    else if (p->budget_bytes <= BUDGET_MAX / 2)
        p->budget_bytes *= 2;
}

void frame_pacing_sent(struct frame_pacing *p, size_t size_bytes,
                       bool with_request, uint64_t begin_ns, uint64_t end_ns)
{
    p->frame_bytes = size_bytes;
    p->first_frame_sent = true;
    if (with_request) {
        p->outstanding++;
        p->asked_ns = begin_ns;
    }
    if (p->state == FRAME_PACING_MUTE)
        learn_from_write(p, end_ns - begin_ns);
}

/* The first request was written without a frame, so its answer measures the
 * round trip alone, even if a frame has followed. */
static void first_answer(struct frame_pacing *p, uint64_t now_ns)
{
    p->rtt_min_ns = now_ns - p->first_asked_ns;
    if (p->outstanding == 0)
        p->frame_bytes = 0;
}

void frame_pacing_answer(struct frame_pacing *p, uint64_t now_ns)
{
    enum frame_pacing_state before = p->state;

    p->state = FRAME_PACING_ANSWERS;
    if (before == FRAME_PACING_MUTE)
        p->outstanding = 0; /* earlier answers may be lost */
    else if (p->outstanding > 0)
        p->outstanding--;
    if (before != FRAME_PACING_ANSWERS) {
        first_answer(p, now_ns);
        return;
    }
    if (p->outstanding > 0 || p->frame_bytes == 0)
        return;
    learn_from_answer(p, now_ns - p->asked_ns);
    p->frame_bytes = 0;
}

uint64_t frame_pacing_deadline_ns(const struct frame_pacing *p)
{
    if (p->state == FRAME_PACING_MUTE || p->outstanding == 0)
        return UINT64_MAX;
    return p->asked_ns + (p->state == FRAME_PACING_UNKNOWN ? FIRST_ANSWER_NS
                                                           : LOST_ANSWER_NS);
}

void frame_pacing_tick(struct frame_pacing *p, uint64_t now_ns)
{
    if (now_ns >= frame_pacing_deadline_ns(p))
        p->state = FRAME_PACING_MUTE;
}

void frame_pacing_forget(struct frame_pacing *p)
{
    p->outstanding = 0;
    p->frame_bytes = 0;
}

bool frame_pacing_is_slow(const struct frame_pacing *p)
{
    return p->rate > 0 && p->rate < SLOW_RATE;
}
