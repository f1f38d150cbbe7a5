/* Groups around a vertex (Mikkelsen 2008, appendix A): floods from corner to corner over the edges
 * that triangles share, as long as their coordinates turn the same way. */
#include "tangent/fan.h"

#include <stdlib.h>

enum { SMALL = 32 }; /* fans up to here are sorted by insertion */

#define NONE UINT32_MAX

static int compare_edges(const void *a, const void *b)
{
    const ppmi_tangent_edge *x = a, *y = b;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    return x->corner < y->corner ? -1 : x->corner > y->corner;
}

/* By vertex, then by corner. */
static void sort_edges(ppmi_tangent_edge *edges, uint32_t count)
{
    if (count > SMALL) {
        qsort(edges, count, sizeof *edges, compare_edges);
        return;
    }
    for (uint32_t i = 1; i < count; ++i) {
        const ppmi_tangent_edge edge = edges[i];
        uint32_t k = i;
        for (; k > 0 && edges[k - 1].vertex > edge.vertex; --k) {
            edges[k] = edges[k - 1];
        }
        edges[k] = edge;
    }
}

/* The first edge to a vertex, or the place where it would be. */
static uint32_t find_edge(const ppmi_tangent_edge *edges, uint32_t count, uint32_t vertex)
{
    uint32_t begin = 0, end = count;
    while (begin < end) {
        const uint32_t middle = begin + (end - begin) / 2;
        if (edges[middle].vertex < vertex) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

/* left and right of each corner: what is on the other side of its edges, or NONE. Two triangles are
 * neighbours when they run through their edge in opposite directions; each edge is used once. */
static void find_neighbours(ppmi_tangent_workspace *w, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        w->edges[i] = (ppmi_tangent_edge){w->corners[i].previous, i};
        w->left[i] = w->right[i] = NONE;
    }
    sort_edges(w->edges, count);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t vertex = w->corners[i].next;
        for (uint32_t k = find_edge(w->edges, count, vertex);
             k < count && w->edges[k].vertex == vertex; ++k) {
            const uint32_t other = w->edges[k].corner;
            if (other == i || w->left[other] != NONE) continue;
            w->right[i] = other;
            w->left[other] = i;
            break;
        }
    }
}

/* Takes a corner into the group, unless it is in one or turns the other way. One of no turn takes
 * that of the group. */
static void visit(ppmi_tangent_workspace *w, uint32_t corner, uint32_t group, uint8_t turn,
                  uint32_t *depth)
{
    if (corner == NONE || w->corners[corner].group != PPMI_TANGENT_NO_GROUP) return;
    if (w->corners[corner].turn != PPMI_TANGENT_ANY && w->corners[corner].turn != turn) return;
    w->corners[corner].group = group;
    w->stack[(*depth)++] = corner;
}

uint32_t ppmi_tangent_group_fan(ppmi_tangent_workspace *w, uint32_t count)
{
    uint32_t groups = 0;
    find_neighbours(w, count);
    for (uint32_t i = 0; i < count; ++i) {
        w->corners[i].group = PPMI_TANGENT_NO_GROUP;
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint8_t turn = w->corners[i].turn;
        uint32_t depth = 0;
        if (turn == PPMI_TANGENT_ANY || w->corners[i].group != PPMI_TANGENT_NO_GROUP) continue;
        visit(w, i, groups, turn, &depth);
        while (depth > 0) {
            const uint32_t corner = w->stack[--depth];
            visit(w, w->left[corner], groups, turn, &depth);
            visit(w, w->right[corner], groups, turn, &depth);
        }
        ++groups;
    }
    return groups;
}
