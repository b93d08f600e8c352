// SPDX-License-Identifier: MIT
#include "formats/monotone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "formats/sweep_line.h"

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
