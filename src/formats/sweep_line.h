// SPDX-License-Identifier: MIT
/*
 * sweep_line.h - edges of an outline in the order in which a vertical line
 * meets them
 *
 * The line moves from left to right over the sites. The edges that it meets
 * stand in a treap, from bottom to top, and are linked with their neighbours;
 * the others wait in the list of the site where they begin.
 *
 * Units:     those of the points
 * Ownership: sweep_line_free() frees; a zeroed struct is empty
 * Threads:   one at a time
 */
#ifndef GLIM_SWEEP_LINE_H
#define GLIM_SWEEP_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "formats/monotone.h"

/* Index that means no edge. Edge 0 is a sentinel below all others: its prev and
 * next are the highest and the lowest edge of the sweep line, and its child[0]
 * is the root of the treap. */
#define SWEEP_LINE_NONE 0

/* Sweep event: all corners at one point. Sites are numbered from left to right,
 * and at equal x from bottom to top. */
struct site {
    struct point2 at;
    uint32_t corner;
    uint32_t edges; /* first of the list of edges that begin here and await
                       insertion */
};

/* Edge of the outline. Coincident edges are merged into one. */
struct edge {
    uint32_t left, right; /* numbers of sites */
    int32_t winding;     /* winding number above the edge minus the one below */
    uint32_t prev, next; /* neighbours below and above on the sweep line; next
                            also links the list of a site */
    uint32_t parent, child[2];
};

struct sweep_line {
    struct site *sites;
    struct edge *edges; /* numbered from 1 */
    uint32_t site_count;
    uint32_t splits_left; /* limit on splits, against quadratic time */
    struct point2 noise;
};

/* Makes the sites and the edges of an outline: edge i + 1 goes from corner i to
 * the next. No edge is on the line yet. Returns false when memory is out. */
bool sweep_line_init(struct sweep_line *s, const struct point2 *points,
                     uint32_t count, struct point2 noise);

/* Returns a positive number if the site lies above the edge, 0 if it lies on
 * it. */
double sweep_line_side(const struct sweep_line *s, uint32_t e, uint32_t site);

/* Returns twice the signed area of the triangle of three sites: positive for a
 * left turn, 0 if it is within the noise. */
double sweep_line_turn(const struct sweep_line *s, uint32_t a, uint32_t b,
                       uint32_t c);

/* Returns the lowest edge of the line that passes through the site, or
 * SWEEP_LINE_NONE. *below is the edge under it, or under the site. */
uint32_t sweep_line_find(const struct sweep_line *s, uint32_t site,
                         uint32_t *below);

/* Removes an edge at a site on it. An edge that goes on to the right of the
 * site is split there. Returns false if that exceeds the limit on splits. */
bool sweep_line_remove(struct sweep_line *s, uint32_t e, uint32_t site);

/* Inserts all edges that begin at the site. Edges that leave it in the same
 * direction are merged. Returns false if that exceeds the limit on splits. */
bool sweep_line_insert(struct sweep_line *s, uint32_t site);

/* Returns true if two neighbours on the line cross to the right of it. */
bool sweep_line_cross(const struct sweep_line *s, uint32_t low, uint32_t high);

void sweep_line_free(struct sweep_line *s);

#endif
