// SPDX-License-Identifier: MIT
#include "formats/sweep_line.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

double sweep_line_turn(const struct sweep_line *s, uint32_t a, uint32_t b,
                       uint32_t c)
{
    struct point2 p = s->sites[a].at;
    struct point2 q = s->sites[b].at;
    struct point2 r = s->sites[c].at;
    double x1 = q.x - p.x;
    double y1 = q.y - p.y;
    double x2 = r.x - p.x;
    double y2 = r.y - p.y;
    double area = x1 * y2 - y1 * x2;
    double noise =
        s->noise.x * (fabs(y1) + fabs(y2)) + s->noise.y * (fabs(x1) + fabs(x2));

    return fabs(area) > noise ? area : 0;
}

double sweep_line_side(const struct sweep_line *s, uint32_t e, uint32_t site)
{
    const struct edge *edge = &s->edges[e];

    return edge->right == site
               ? 0
               : sweep_line_turn(s, edge->left, edge->right, site);
}

/* Returns a pseudorandom treap priority (the finalizer of MurmurHash3). */
static uint32_t priority(uint32_t e)
{
    e = (e ^ e >> 16) * 0x85ebca6bu;
    e = (e ^ e >> 13) * 0xc2b2ae35u;
    return e ^ e >> 16;
}

static void replace_child(struct sweep_line *s, uint32_t parent, uint32_t child,
                          uint32_t by)
{
    s->edges[parent].child[s->edges[parent].child[1] == child] = by;
    s->edges[by].parent = parent;
}

static void rotate_up(struct sweep_line *s, uint32_t e)
{
    uint32_t p = s->edges[e].parent;
    int side = s->edges[p].child[1] == e;
    uint32_t moved = s->edges[e].child[!side];

    replace_child(s, s->edges[p].parent, p, e);
    s->edges[p].child[side] = moved;
    s->edges[moved].parent = p;
    s->edges[e].child[!side] = p;
    s->edges[p].parent = e;
}

static void attach(struct sweep_line *s, uint32_t e, uint32_t parent, int side)
{
    struct edge *edge = &s->edges[e];

    edge->child[0] = edge->child[1] = SWEEP_LINE_NONE;
    edge->parent = parent;
    s->edges[parent].child[side] = e;
    edge->prev = side ? parent : s->edges[parent].prev;
    edge->next = side ? s->edges[parent].next : parent;
    s->edges[edge->prev].next = e;
    s->edges[edge->next].prev = e;
    while (edge->parent != SWEEP_LINE_NONE &&
           priority(e) > priority(edge->parent))
        rotate_up(s, e);
}

static void detach(struct sweep_line *s, uint32_t e)
{
    struct edge *edge = &s->edges[e];

    while (edge->child[0] != SWEEP_LINE_NONE &&
           edge->child[1] != SWEEP_LINE_NONE) {
        bool is_right = priority(edge->child[1]) > priority(edge->child[0]);

        rotate_up(s, edge->child[is_right]);
    }
    replace_child(s, edge->parent, e,
                  edge->child[edge->child[0] == SWEEP_LINE_NONE]);
    s->edges[edge->prev].next = edge->next;
    s->edges[edge->next].prev = edge->prev;
}

/* Adds an edge to the list of its left site, to be inserted when the sweep line
 * gets there. */
static void defer_edge(struct sweep_line *s, uint32_t e, uint32_t site)
{
    s->edges[e].left = site;
    s->edges[e].next = s->sites[site].edges;
    s->sites[site].edges = e;
}

/* Splits an edge at a site. Returns false when the limit on splits is reached:
 * outlines with many overlaps would take quadratic time. */
static bool split(struct sweep_line *s, uint32_t e, uint32_t site)
{
    if (s->splits_left == 0)
        return false;
    s->splits_left--;
    defer_edge(s, e, site);
    return true;
}

/* Merges two edges that leave a site in the same direction. They become one
 * edge up to the nearer end; the rest of the longer edge begins there. */
static bool merge_edges(struct sweep_line *s, uint32_t e, uint32_t with)
{
    struct edge *rest = &s->edges[e];
    struct edge *edge = &s->edges[with];
    uint32_t near = rest->right < edge->right ? rest->right : edge->right;
    uint32_t far = rest->right < edge->right ? edge->right : rest->right;
    int32_t winding = rest->right < edge->right ? edge->winding : rest->winding;

    edge->winding += rest->winding;
    edge->right = near;
    rest->winding = winding;
    rest->right = far;
    return near == far || split(s, e, near);
}

/* Inserts an edge that begins at the site. Returns false if a merge exceeds the
 * limit on splits. */
static bool insert(struct sweep_line *s, uint32_t e, uint32_t site)
{
    uint32_t parent = SWEEP_LINE_NONE;
    int side = 0;

    for (uint32_t at = s->edges[SWEEP_LINE_NONE].child[0];
         at != SWEEP_LINE_NONE; at = s->edges[at].child[side]) {
        bool is_sibling = s->edges[at].left == site;
        double where = is_sibling ? sweep_line_turn(s, site, s->edges[at].right,
                                                    s->edges[e].right)
                                  : sweep_line_side(s, at, site);

        if (where == 0)
            return is_sibling && merge_edges(s, e, at);
        parent = at;
        side = where > 0;
    }
    attach(s, e, parent, side);
    return true;
}

uint32_t sweep_line_find(const struct sweep_line *s, uint32_t site,
                         uint32_t *below)
{
    uint32_t at = s->edges[SWEEP_LINE_NONE].child[0];
    double side = 1;

    *below = SWEEP_LINE_NONE;
    while (at != SWEEP_LINE_NONE &&
           (side = sweep_line_side(s, at, site)) != 0) {
        *below = side > 0 ? at : *below;
        at = s->edges[at].child[side > 0];
    }
    if (at == SWEEP_LINE_NONE)
        return SWEEP_LINE_NONE;
    while (s->edges[at].prev != SWEEP_LINE_NONE &&
           sweep_line_side(s, s->edges[at].prev, site) == 0)
        at = s->edges[at].prev;
    *below = s->edges[at].prev;
    return at;
}

bool sweep_line_cross(const struct sweep_line *s, uint32_t low, uint32_t high)
{
    const struct edge *a = &s->edges[low];
    const struct edge *b = &s->edges[high];

    if (low == SWEEP_LINE_NONE || high == SWEEP_LINE_NONE ||
        a->right == b->right)
        return false;
    return a->right < b->right ? sweep_line_side(s, high, a->right) > 0
                               : sweep_line_side(s, low, b->right) < 0;
}

bool sweep_line_remove(struct sweep_line *s, uint32_t e, uint32_t site)
{
    detach(s, e);
    return s->edges[e].right == site || split(s, e, site);
}

bool sweep_line_insert(struct sweep_line *s, uint32_t site)
{
    uint32_t e, next;

    for (e = s->sites[site].edges; e != SWEEP_LINE_NONE; e = next) {
        next = s->edges[e].next;
        if (!insert(s, e, site))
            return false;
    }
    return true;
}

static int compare_sites(const void *a, const void *b)
{
    const struct site *p = a;
    const struct site *q = b;

    if (p->at.x != q->at.x)
        return p->at.x < q->at.x ? -1 : 1;
    if (p->at.y != q->at.y)
        return p->at.y < q->at.y ? -1 : 1;
    return (p->corner > q->corner) - (p->corner < q->corner);
}

/* Sorts the corners. Corners of one vertical line, within the noise, get the
 * same x, so that rounding does not change their order. */
static void sort_sites(struct sweep_line *s, uint32_t n)
{
    double x = -INFINITY;

    qsort(s->sites, n, sizeof *s->sites, compare_sites);
    for (uint32_t i = 0; i < n; i++) {
        x = s->sites[i].at.x - x > 4 * s->noise.x ? s->sites[i].at.x : x;
        s->sites[i].at.x = x;
    }
    qsort(s->sites, n, sizeof *s->sites, compare_sites);
}

/* Merges the sorted corners into sites, and finds the two sites of each edge.
 */
static void make_sites(struct sweep_line *s, const struct point2 *points,
                       uint32_t n)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < n; i++)
        s->sites[i] = (struct site){points[i], i, SWEEP_LINE_NONE};
    sort_sites(s, n);
    for (uint32_t i = 0; i < n; i++) {
        struct site site = s->sites[i];
        uint32_t from = site.corner + 1;
        uint32_t to = site.corner == 0 ? n : site.corner;

        if (count == 0 || s->sites[count - 1].at.x != site.at.x ||
            s->sites[count - 1].at.y != site.at.y)
            s->sites[count++] = site;
        s->edges[from].left = count - 1;
        s->edges[to].right = count - 1;
    }
    s->site_count = count;
}

static void make_edges(struct sweep_line *s, uint32_t n)
{
    for (uint32_t e = 1; e <= n; e++) {
        struct edge *edge = &s->edges[e];
        uint32_t from = edge->left;
        uint32_t to = edge->right;

        if (from == to)
            continue;
        edge->winding = from < to ? 1 : -1;
        edge->right = from < to ? to : from;
        defer_edge(s, e, from < to ? from : to);
    }
}

bool sweep_line_init(struct sweep_line *s, const struct point2 *points,
                     uint32_t count, struct point2 noise)
{
    *s = (struct sweep_line){
        .sites = alloc_array(count, sizeof *s->sites),
        .edges = alloc_array((size_t)count + 1, sizeof *s->edges),
        .splits_left = count,
        .noise = noise,
    };
    if (s->sites == NULL || s->edges == NULL)
        return false;
    make_sites(s, points, count);
    make_edges(s, count);
    return true;
}

void sweep_line_free(struct sweep_line *s)
{
    free(s->sites);
    free(s->edges);
    *s = (struct sweep_line){.sites = NULL};
}
