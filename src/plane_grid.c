// SPDX-License-Identifier: MIT
#include "glim/plane_grid.h"

#include <math.h>

/* Whoever sorts into the cells has an array of them: of 64 MiB then. */
#define SIDE_MAX 4096

/* More than rounding can move a point, in cells. */
#define MARGIN 1e-3

/* Products with it are finite. */
#define SCALE_MAX 1e200

/* fmin() and fmax() are calls, and rows are asked for often. */
static double lesser(double a, double b)
{
    return a < b ? a : b;
}

static double greater(double a, double b)
{
    return a > b ? a : b;
}

struct plane_grid plane_grid_over(const struct point2 *points, uint32_t count)
{
    struct point2 lo = points[0];
    struct point2 hi = lo;
    uint32_t side = (uint32_t)sqrt(count);
    struct plane_grid g = {.side = side < SIDE_MAX ? side : SIDE_MAX};

    for (uint32_t i = 1; i < count; i++) {
        lo.x = lesser(lo.x, points[i].x);
        lo.y = lesser(lo.y, points[i].y);
        hi.x = greater(hi.x, points[i].x);
        hi.y = greater(hi.y, points[i].y);
    }
    g.origin = lo;
    g.scale.x = lesser(g.side / (hi.x - lo.x), SCALE_MAX);
    g.scale.y = lesser(g.side / (hi.y - lo.y), SCALE_MAX);
    return g;
}

/* The place in cells: their numbers are the whole parts. */
static struct point2 in_cells(const struct plane_grid *g, struct point2 p)
{
    return (struct point2){(p.x - g->origin.x) * g->scale.x,
                           (p.y - g->origin.y) * g->scale.y};
}

static uint32_t cell_along(const struct plane_grid *g, double place)
{
    if (!(place > 0))
        return 0;
    return place < g->side ? (uint32_t)place : g->side - 1;
}

uint32_t plane_grid_cell(const struct plane_grid *g, struct point2 p)
{
    struct point2 place = in_cells(g, p);

    return cell_along(g, place.y) * g->side + cell_along(g, place.x);
}

static struct plane_edge edge_between(struct point2 a, struct point2 b)
{
    struct plane_edge e = {a.y < b.y ? a : b, a.y < b.y ? b : a, 0};

    e.slope = (e.high.x - e.low.x) / (e.high.y - e.low.y);
    return e;
}

struct plane_triangle plane_grid_triangle(const struct plane_grid *g,
                                          struct point2 a, struct point2 b,
                                          struct point2 c)
{
    a = in_cells(g, a);
    b = in_cells(g, b);
    c = in_cells(g, c);
    return (struct plane_triangle){
        .edges = {edge_between(a, b), edge_between(b, c), edge_between(c, a)},
        .first_row = cell_along(g, lesser(lesser(a.y, b.y), c.y)),
        .last_row = cell_along(g, greater(greater(a.y, b.y), c.y)),
    };
}

/* Widens the part of a row from *from to *to by what the edge has of the row.
 */
static void widen(const struct plane_edge *e, uint32_t row, double *from,
                  double *to)
{
    double begin = row - MARGIN;
    double end = row + 1 + MARGIN;
    double first = e->low.x;
    double last = e->high.x;

    if (e->high.y < begin || e->low.y > end)
        return;
    if (e->low.y < begin)
        first += (begin - e->low.y) * e->slope;
    if (e->high.y > end)
        last -= (e->high.y - end) * e->slope;
    *from = lesser(*from, lesser(first, last));
    *to = greater(*to, greater(first, last));
}

void plane_grid_row(const struct plane_grid *g, const struct plane_triangle *t,
                    uint32_t row, uint32_t *first, uint32_t *last)
{
    double from = INFINITY;
    double to = -INFINITY;

    for (int k = 0; k < 3; k++)
        widen(&t->edges[k], row, &from, &to);
    *first = row * g->side + cell_along(g, from - MARGIN);
    *last = row * g->side + cell_along(g, to + MARGIN);
}
