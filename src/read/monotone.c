// SPDX-License-Identifier: MIT
#include "read/monotone.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

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

/* Index that means no link, and the end of a stack of links. */
#define NO_LINK 0

/* Monotone piece left of the sweep line that is not triangulated yet: a stack
 * of links. Two pieces of one region share their last site. */
struct piece {
    uint32_t top;
    bool is_upper; /* all links but the lowest lie on the upper boundary */
};

struct region {
    struct piece low, high; /* low.top is NO_LINK outside the polygon */
};

struct link {
    uint32_t site, below;
};

struct sweep {
    struct sweep_line line;
    struct region *regions; /* the region above each edge */
    struct link *links;
    uint32_t link_count;
    uint32_t (*triangles)[3];
    uint32_t triangle_count;
    uint64_t triangle_max;
};

/* ---- the sweep line ---- */

/*
 * The line moves from left to right over the sites. The edges that it meets
 * stand in a treap, from bottom to top, and are linked with their neighbours;
 * the others wait in the list of the site where they begin.
 */

/* Returns twice the signed area of the triangle of three sites: positive for a
 * left turn, 0 if it is within the noise. */
static double sweep_line_turn(const struct sweep_line *s, uint32_t a,
                              uint32_t b, uint32_t c)
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

/* Returns a positive number if the site lies above the edge, 0 if it lies on
 * it. */
static double sweep_line_side(const struct sweep_line *s, uint32_t e,
                              uint32_t site)
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

/* Returns the lowest edge of the line that passes through the site, or
 * SWEEP_LINE_NONE. *below is the edge under it, or under the site. */
static uint32_t sweep_line_find(const struct sweep_line *s, uint32_t site,
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

/* Returns true if two neighbours on the line cross to the right of it. */
static bool sweep_line_cross(const struct sweep_line *s, uint32_t low,
                             uint32_t high)
{
    const struct edge *a = &s->edges[low];
    const struct edge *b = &s->edges[high];

    if (low == SWEEP_LINE_NONE || high == SWEEP_LINE_NONE ||
        a->right == b->right)
        return false;
    return a->right < b->right ? sweep_line_side(s, high, a->right) > 0
                               : sweep_line_side(s, low, b->right) < 0;
}

/* Removes an edge at a site on it. An edge that goes on to the right of the
 * site is split there. Returns false if that exceeds the limit on splits. */
static bool sweep_line_remove(struct sweep_line *s, uint32_t e, uint32_t site)
{
    detach(s, e);
    return s->edges[e].right == site || split(s, e, site);
}

/* Inserts all edges that begin at the site. Edges that leave it in the same
 * direction are merged. Returns false if that exceeds the limit on splits. */
static bool sweep_line_insert(struct sweep_line *s, uint32_t site)
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

/* Makes the sites and the edges of an outline: edge i + 1 goes from corner i to
 * the next. No edge is on the line yet. Returns false when memory is out. */
static bool sweep_line_init(struct sweep_line *s, const struct point2 *points,
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

static void sweep_line_free(struct sweep_line *s)
{
    free(s->sites);
    free(s->edges);
    *s = (struct sweep_line){.sites = NULL};
}

/* ---- monotone pieces ---- */

static struct piece piece_from(struct sweep *s, uint32_t site)
{
    s->links[++s->link_count] = (struct link){site, NO_LINK};
    return (struct piece){s->link_count, false};
}

static void emit(struct sweep *s, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t n = s->triangle_count++;

    if (n >= s->triangle_max)
        return;
    s->triangles[n][0] = s->line.sites[a].corner;
    s->triangles[n][1] = s->line.sites[b].corner;
    s->triangles[n][2] = s->line.sites[c].corner;
}

/* Extends the piece by a site on its upper or lower boundary and emits all
 * triangles that the site can see. A site opposite to the stack sees every
 * link; a site on the same side sees those up to the first reflex corner. */
static void extend(struct sweep *s, struct piece *piece, uint32_t site,
                   bool is_upper)
{
    bool is_opposite = is_upper != piece->is_upper;
    uint32_t last = piece->top;
    uint32_t top = last;

    while (s->links[top].below != NO_LINK) {
        uint32_t b = s->links[top].site;
        uint32_t a = s->links[s->links[top].below].site;
        double left = piece->is_upper ? sweep_line_turn(&s->line, a, site, b)
                                      : sweep_line_turn(&s->line, a, b, site);

        if (!is_opposite && !(left > 0))
            break;
        if (piece->is_upper)
            emit(s, a, site, b);
        else
            emit(s, a, b, site);
        top = s->links[top].below;
    }
    if (is_opposite) {
        top = last;
        s->links[top].below = NO_LINK;
    }
    s->links[++s->link_count] = (struct link){site, top};
    *piece = (struct piece){s->link_count, is_upper};
}

static void finish(struct sweep *s, struct piece *piece, uint32_t site)
{
    if (piece->top != NO_LINK)
        extend(s, piece, site, !piece->is_upper);
    piece->top = NO_LINK;
}

/* Extends the region by the site where its lower edge ends. */
static void extend_below(struct sweep *s, struct region *r, uint32_t site)
{
    if (r->low.top == NO_LINK)
        return;
    if (r->high.top != NO_LINK) {
        finish(s, &r->low, site);
        r->low = r->high;
        r->high.top = NO_LINK;
    }
    extend(s, &r->low, site, false);
}

/* Extends the region by the site where its upper edge ends. */
static void extend_above(struct sweep *s, struct region *r, uint32_t site)
{
    if (r->low.top == NO_LINK)
        return;
    finish(s, &r->high, site);
    extend(s, &r->low, site, true);
}

/* Splits a region at a site inside it where edges begin, with a diagonal from
 * the last site of the region. Returns the part above the diagonal. */
static struct region split_region(struct sweep *s, struct region *r,
                                  uint32_t site)
{
    struct region above = {.low = r->high};

    if (r->low.top == NO_LINK)
        return above;
    if (above.low.top == NO_LINK) {
        struct piece fresh = piece_from(s, s->links[r->low.top].site);

        above.low = r->low.is_upper ? fresh : r->low;
        r->low = r->low.is_upper ? r->low : fresh;
    }
    r->high.top = NO_LINK;
    extend(s, &r->low, site, true);
    extend(s, &above.low, site, false);
    return above;
}

/* ---- the sweep ---- */

/* Removes all edges through the site from the sweep line. *above is the region
 * above them; the region below them stays with the edge below. Returns false if
 * a split exceeds the limit. */
static bool end_edges(struct sweep *s, uint32_t site, uint32_t first,
                      uint32_t below, struct region *above)
{
    uint32_t e = first;
    uint32_t next;

    extend_above(s, &s->regions[below], site);
    for (bool is_last = false; !is_last; e = next) {
        next = s->line.edges[e].next;
        is_last = next == SWEEP_LINE_NONE ||
                  sweep_line_side(&s->line, next, site) != 0;
        *above = s->regions[e];
        if (!is_last) {
            finish(s, &above->low, site);
            finish(s, &above->high, site);
        }
        if (!sweep_line_remove(&s->line, e, site))
            return false;
    }
    extend_below(s, above, site);
    return true;
}

/* Assigns regions to the edges that begin at the site, from bottom to top.
 * Returns false if a winding number is neither 0 nor 1. */
static bool begin_regions(struct sweep *s, uint32_t site, uint32_t below,
                          uint32_t end, struct region above)
{
    int32_t winding = s->regions[below].low.top != NO_LINK;
    bool is_inside = above.low.top != NO_LINK;
    uint32_t e = s->line.edges[below].next;

    if (e == end) {
        s->regions[below].high = above.low;
        return winding == is_inside;
    }
    for (; e != end; e = s->line.edges[e].next) {
        struct region *r = &s->regions[e];

        winding += s->line.edges[e].winding;
        if (winding != 0 && winding != 1)
            return false;
        memset(r, 0, sizeof *r);
        if (s->line.edges[e].next == end)
            *r = above;
        else if (winding == 1)
            r->low = piece_from(s, site);
    }
    return winding == is_inside;
}

static bool sweep_site(struct sweep *s, uint32_t site)
{
    uint32_t below, end;
    uint32_t first = sweep_line_find(&s->line, site, &below);
    struct region above;

    if (first == SWEEP_LINE_NONE)
        above = split_region(s, &s->regions[below], site);
    else if (!end_edges(s, site, first, below, &above))
        return false;
    end = s->line.edges[below].next;
    return sweep_line_insert(&s->line, site) &&
           begin_regions(s, site, below, end, above) &&
           !sweep_line_cross(&s->line, below, s->line.edges[below].next) &&
           !sweep_line_cross(&s->line, s->line.edges[end].prev, end);
}

/* Checks that the triangles' areas add up to the area of the outline. This
 * detects results where noise misled the sweep. */
static bool area_is_right(const struct sweep *s, const struct point2 *points,
                          uint32_t n)
{
    double area = 0;
    double noise = 0;

    for (uint32_t i = 0; i < n; i++) {
        struct point2 p = points[i];
        struct point2 q = points[i + 1 == n ? 0 : i + 1];

        area += (p.x + q.x) * (q.y - p.y);
        noise += s->line.noise.x * fabs(q.y - p.y) +
                 s->line.noise.y * fabs(q.x - p.x);
    }
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        struct point2 p = points[s->triangles[i][0]];
        struct point2 q = points[s->triangles[i][1]];
        struct point2 r = points[s->triangles[i][2]];

        area -= fabs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
    }
    return fabs(area) <= n * noise; /* each sum has n terms */
}

static bool sweep_over(struct sweep *s, const struct point2 *points, uint32_t n)
{
    for (uint32_t site = 0; site < s->line.site_count; site++) {
        if (!sweep_site(s, site))
            return false;
    }
    return s->line.edges[SWEEP_LINE_NONE].child[0] == SWEEP_LINE_NONE &&
           s->triangle_count > 0 && s->triangle_count <= s->triangle_max &&
           area_is_right(s, points, n);
}

enum monotone_result monotone_cut(const struct point2 *points, uint32_t count,
                                  struct point2 noise, uint32_t (*triangles)[3],
                                  uint32_t *triangle_count)
{
    size_t n = count;
    struct sweep s = {.regions = alloc_array(n + 1, sizeof *s.regions),
                      .links = alloc_array(4 * n + 1, sizeof *s.links),
                      .triangles = triangles,
                      .triangle_max = 2 * (uint64_t)count};
    enum monotone_result result = MONOTONE_NO_MEMORY;

    if (sweep_line_init(&s.line, points, count, noise) && s.regions && s.links)
        result =
            sweep_over(&s, points, count) ? MONOTONE_DONE : MONOTONE_CROSSING;
    sweep_line_free(&s.line);
    free(s.regions);
    free(s.links);
    *triangle_count = s.triangle_count;
    return result;
}
