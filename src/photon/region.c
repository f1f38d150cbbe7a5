/* Regions of gathering: the measure is an integral over triangles in polar coordinates.
 *
 * Of the kernel 1 - r^2 (radii are 1) the integral along a ray from the point to distance r is
 * G(r) = r^2 / 2 - r^4 / 4, so that of the kernel over a polygon is the sum over its directed edges
 * of the integral of G(min(r(angle), limit)) over the angle that the edge spans, with its sign; on
 * an edge at distance h from the point r = h / cos(u), and the integral has a closed form. Inside
 * the disk the mean over the middles of a triangle's edges is exact: the kernel is quadratic. */
#include "photon/region.h"

#include <string.h>

static const double pi = 3.14159265358979323846;
static const double sector_angle = 2.0 * 3.14159265358979323846 / PPMI_REGION_SECTORS;
/* What lies this close to a plane is in it, in radii; a place is on a triangle this close. */
static const double flatness = 2e-3;
/* A cylinder of the disk's radius and the reach below it is within this ball, in radii. */
static const float disk_reach = 1.05f;
/* Less than this share of the disk is taken for this much. */
static const float least_share = 0.01f;

/* ---- one edge -------------------------------------------------------------------------------- */

typedef struct region_edge {
    double first, span;      /* angle of the first end, signed way to the last one */
    double h, foot;          /* distance of its line, angle of the foot */
    double length0, length1; /* distances of the ends */
} region_edge;

/* Squared distance of the segment from the point. */
static double segment_distance2(double x0, double y0, double x1, double y1)
{
    const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
    const double along = -(x0 * dx + y0 * dy);
    const double share = along <= 0.0 ? 0.0 : along >= length2 ? 1.0 : along / length2;
    const double x = x0 + share * dx, y = y0 + share * dy;
    return x * x + y * y;
}

static region_edge edge_of(double x0, double y0, double x1, double y1)
{
    const double dx = x1 - x0, dy = y1 - y0, cross = x0 * y1 - y0 * x1;
    region_edge edge = {.first = atan2(y0, x0),
                        .span = atan2(cross, x0 * x1 + y0 * y1),
                        .length0 = sqrt(x0 * x0 + y0 * y0),
                        .length1 = sqrt(x1 * x1 + y1 * y1)};
    if (edge.length0 == 0.0 || edge.length1 == 0.0) edge.span = 0.0;
    const double length = sqrt(dx * dx + dy * dy);
    edge.h = length > 0.0 ? fabs(cross) / length : edge.length0;
    edge.foot = cross >= 0.0 ? atan2(-dx, dy) : atan2(dx, -dy);
    return edge;
}

/* An angle within half a turn of zero. */
static double wrap(double angle)
{
    return angle - 2.0 * pi * floor((angle + pi) / (2.0 * pi));
}

static double disk_integral(double r)
{
    return 0.5 * r * r - 0.25 * r * r * r * r;
}

/* Of G along the edge from its foot to the angle u. */
static double line_integral(double h, double u)
{
    const double tangent = tan(u), h2 = h * h;
    return 0.5 * h2 * tangent - 0.25 * h2 * h2 * (tangent + tangent * tangent * tangent / 3.0);
}

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Over the angles from u0 to u1 from the foot. */
static double span_integral(double h, double u0, double u1, double limit)
{
    if (h >= limit) return disk_integral(limit) * (u1 - u0);
    const double reach = acos(h / limit);
    const double inner0 = clamp(u0, -reach, reach), inner1 = clamp(u1, -reach, reach);
    return line_integral(h, inner1) - line_integral(h, inner0) +
           disk_integral(limit) * ((u1 - u0) - (inner1 - inner0));
}

static uint32_t sector_of(double angle)
{
    const double turns = angle / (2.0 * pi);
    const uint32_t sector = (uint32_t)((turns - floor(turns)) * PPMI_REGION_SECTORS);
    return sector < PPMI_REGION_SECTORS ? sector : 0;
}

/* A visitor of the parts of an edge by sector: u0, u1 are angles from the foot, in its direction.
 */
typedef struct edge_walk {
    double u, end, step; /* step: the sectors' way round */
    double next;         /* u where the sector ends */
    uint32_t sector;
} edge_walk;

static edge_walk walk_edge(const region_edge *edge)
{
    edge_walk walk = {.u = wrap(edge->first - edge->foot), .step = edge->span < 0.0 ? -1.0 : 1.0};
    walk.end = walk.u + edge->span;
    walk.sector = sector_of(edge->first);
    const double turns = edge->first / (2.0 * pi);
    const double into = (turns - floor(turns)) * 2.0 * pi - walk.sector * sector_angle;
    walk.next = walk.u + (walk.step > 0.0 ? sector_angle - into : -into);
    return walk;
}

/* The next part: false at the end. */
static bool next_part(edge_walk *walk, uint32_t *sector, double *u0, double *u1)
{
    if ((walk->end - walk->u) * walk->step <= 0.0) return false;
    *sector = walk->sector;
    *u0 = walk->u;
    *u1 = (walk->end - walk->next) * walk->step > 0.0 ? walk->next : walk->end;
    walk->u = *u1;
    walk->next += walk->step * sector_angle;
    walk->sector =
        (walk->sector + (walk->step > 0.0 ? 1 : PPMI_REGION_SECTORS - 1)) % PPMI_REGION_SECTORS;
    return true;
}

static double edge_integral(const ppmi_gather_region *region, double x0, double y0, double x1,
                            double y1)
{
    if (!region->is_bounded && segment_distance2(x0, y0, x1, y1) >= 1.0) {
        return disk_integral(1.0) * atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1);
    }
    const region_edge edge = edge_of(x0, y0, x1, y1);
    if (!region->is_bounded) {
        const double u = wrap(edge.first - edge.foot);
        return span_integral(edge.h, u, u + edge.span, 1.0);
    }
    edge_walk walk = walk_edge(&edge);
    uint32_t sector;
    double u0, u1, sum = 0.0;
    while (next_part(&walk, &sector, &u0, &u1))
        sum += span_integral(edge.h, u0, u1, (double)region->limits[sector]);
    return sum;
}

/* ---- walls ----------------------------------------------------------------------------------- */

static void lower_limit(ppmi_gather_region *region, uint32_t sector, double distance)
{
    if (distance >= (double)region->limits[sector]) return;
    region->limits[sector] = (float)distance * (1.0f - 1e-6f);
    region->is_bounded = true;
}

/* Limits every sector that the segment touches to its nearest distance there. */
static void add_wall(ppmi_gather_region *region, const double from[2], const double to[2])
{
    if (segment_distance2(from[0], from[1], to[0], to[1]) >= 1.0) return;
    const region_edge edge = edge_of(from[0], from[1], to[0], to[1]);
    lower_limit(region, sector_of(edge.first), edge.length0);
    lower_limit(region, sector_of(edge.first + edge.span), edge.length1);
    edge_walk walk = walk_edge(&edge);
    uint32_t sector;
    double u0, u1;
    while (next_part(&walk, &sector, &u0, &u1)) {
        const double low = u0 < u1 ? u0 : u1, high = u0 < u1 ? u1 : u0;
        const double cosine = cos(clamp(0.0, low, high));
        lower_limit(region, sector, cosine > 1e-9 ? edge.h / cosine : edge.h);
    }
}

/* Where the triangle passes through the height of walls, if it does. */
static void add_wall_of(ppmi_gather_region *region, const ppmi_region_triangle *triangle)
{
    const double height = (double)PPMI_REGION_ABOVE;
    double ends[2][2];
    int count = 0;
    for (int i = 0; i < 3 && count < 2; i++) {
        const int k = (i + 1) % 3;
        const double a = triangle->z[i] - height, b = triangle->z[k] - height;
        if ((a > 0.0) == (b > 0.0)) continue;
        const double share = a / (a - b);
        ends[count][0] = triangle->x[i] + share * (triangle->x[k] - triangle->x[i]);
        ends[count++][1] = triangle->y[i] + share * (triangle->y[k] - triangle->y[i]);
    }
    if (count == 2) add_wall(region, ends[0], ends[1]);
}

/* ---- collecting ------------------------------------------------------------------------------ */

typedef struct region_search {
    ppmi_gather_region *region;
    double scale; /* radii in a metre */
    bool is_full;
} region_search;

static double z_min(const ppmi_region_triangle *t)
{
    return fmin(t->z[0], fmin(t->z[1], t->z[2]));
}

static double z_max(const ppmi_region_triangle *t)
{
    return fmax(t->z[0], fmax(t->z[1], t->z[2]));
}

static void bring_home(const region_search *search, const ppmi_near_triangle *triangle,
                       ppmi_region_triangle *out)
{
    const ppmi_gather_region *region = search->region;
    for (int i = 0; i < 3; i++) {
        const double x = (double)triangle->corners[i].x - (double)region->center.x;
        const double y = (double)triangle->corners[i].y - (double)region->center.y;
        const double z = (double)triangle->corners[i].z - (double)region->center.z;
        const ppmi_vec3 s = region->s, t = region->t, n = region->n;
        out->x[i] = search->scale * (x * (double)s.x + y * (double)s.y + z * (double)s.z);
        out->y[i] = search->scale * (x * (double)t.x + y * (double)t.y + z * (double)t.z);
        out->z[i] = search->scale * (x * (double)n.x + y * (double)n.y + z * (double)n.z);
    }
}

static double cross_of(const ppmi_region_triangle *t, int i, int k)
{
    return t->x[i] * t->y[k] - t->y[i] * t->x[k];
}

static double distance2_of(const ppmi_region_triangle *t, int i, int k)
{
    return segment_distance2(t->x[i], t->y[i], t->x[k], t->y[k]);
}

/* Whether the disk lies beside the triangle. */
static bool is_beside(const ppmi_region_triangle *t)
{
    const double a = cross_of(t, 0, 1), b = cross_of(t, 1, 2), c = cross_of(t, 2, 0);
    if ((a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0)) return false;
    return distance2_of(t, 0, 1) >= 1.0 && distance2_of(t, 1, 2) >= 1.0 &&
           distance2_of(t, 2, 0) >= 1.0;
}

/* A quick test, by single precision: of many that a query shows nothing else is asked. */
static bool is_far_off_plane(const ppmi_gather_region *region, const ppmi_near_triangle *triangle)
{
    const float slack = 0.01f * region->radius;
    const float above = PPMI_REGION_ABOVE * region->radius + slack;
    const float below = -PPMI_REGION_BELOW * region->radius - slack;
    float z[3];
    for (int i = 0; i < 3; i++)
        z[i] = vec3_dot(vec3_sub(triangle->corners[i], region->center), region->n);
    return (z[0] > above && z[1] > above && z[2] > above) ||
           (z[0] < below && z[1] < below && z[2] < below);
}

static bool on_triangle(void *user, const ppmi_near_triangle *triangle)
{
    region_search *search = user;
    ppmi_gather_region *region = search->region;
    if (is_far_off_plane(region, triangle)) return true;
    ppmi_region_triangle one_more;
    const bool is_full = region->count == PPMI_REGION_TRIANGLES;
    ppmi_region_triangle *found = is_full ? &one_more : &region->triangles[region->count];
    bring_home(search, triangle, found);
    const double low = z_min(found), high = z_max(found);
    if (low > (double)PPMI_REGION_ABOVE || high < -(double)PPMI_REGION_BELOW || is_beside(found)) {
        return true;
    }
    if (is_full) {
        search->is_full = true;
        return false;
    }
    found->key = (uint64_t)triangle->instance << 40 ^ (uint64_t)triangle->primitive << 32 ^
                 triangle->element;
    region->count++;
    return true;
}

/* Embree's order is its tree's: sums have one of their own. */
static void sort(ppmi_gather_region *region)
{
    for (uint32_t i = 1; i < region->count; i++) {
        const ppmi_region_triangle moved = region->triangles[i];
        uint32_t k = i;
        for (; k > 0 && region->triangles[k - 1].key > moved.key; k--)
            region->triangles[k] = region->triangles[k - 1];
        region->triangles[k] = moved;
    }
}

/* ---- the measure ----------------------------------------------------------------------------- */

typedef struct region_normal {
    double x, y, z; /* z >= 0 is up; not of unit length */
    double length;
} region_normal;

static region_normal normal_of(const ppmi_region_triangle *t)
{
    const double ax = t->x[1] - t->x[0], ay = t->y[1] - t->y[0], az = t->z[1] - t->z[0];
    const double bx = t->x[2] - t->x[0], by = t->y[2] - t->y[0], bz = t->z[2] - t->z[0];
    region_normal n = {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 0.0};
    n.length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return n;
}

enum { MAX_CORNERS = 5 };

typedef struct region_polygon {
    double x[MAX_CORNERS], y[MAX_CORNERS], z[MAX_CORNERS];
    int count;
} region_polygon;

/* The part of a polygon with sign * z <= bound. */
static region_polygon clip(const region_polygon *polygon, double sign, double bound)
{
    region_polygon out = {.count = 0};
    for (int i = 0; i < polygon->count; i++) {
        const int k = (i + 1) % polygon->count;
        const double a = sign * polygon->z[i] - bound, b = sign * polygon->z[k] - bound;
        if (a <= 0.0 && out.count < MAX_CORNERS) {
            out.x[out.count] = polygon->x[i];
            out.y[out.count] = polygon->y[i];
            out.z[out.count++] = polygon->z[i];
        }
        if ((a <= 0.0) != (b <= 0.0) && out.count < MAX_CORNERS) {
            const double share = a / (a - b);
            out.x[out.count] = polygon->x[i] + share * (polygon->x[k] - polygon->x[i]);
            out.y[out.count] = polygon->y[i] + share * (polygon->y[k] - polygon->y[i]);
            out.z[out.count++] = polygon->z[i] + share * (polygon->z[k] - polygon->z[i]);
        }
    }
    return out;
}

/* The part that is near the tangent plane. */
static region_polygon near_plane(const ppmi_region_triangle *t)
{
    region_polygon polygon = {.count = 3};
    memcpy(polygon.x, t->x, sizeof t->x);
    memcpy(polygon.y, t->y, sizeof t->y);
    memcpy(polygon.z, t->z, sizeof t->z);
    if (z_max(t) > (double)PPMI_REGION_ABOVE) {
        polygon = clip(&polygon, 1.0, (double)PPMI_REGION_ABOVE);
    }
    if (z_min(t) < -(double)PPMI_REGION_BELOW) {
        polygon = clip(&polygon, -1.0, (double)PPMI_REGION_BELOW);
    }
    return polygon;
}

static bool is_inside(const ppmi_region_triangle *t, double radius)
{
    for (int i = 0; i < 3; i++) {
        if (t->x[i] * t->x[i] + t->y[i] * t->y[i] > radius * radius) return false;
    }
    return true;
}

static double kernel_between(const ppmi_region_triangle *t, int i, int k)
{
    const double x = 0.5 * (t->x[i] + t->x[k]), y = 0.5 * (t->y[i] + t->y[k]);
    return 1.0 - x * x - y * y;
}

/* Of the kernel over the triangle's projection. */
static double projected(const ppmi_gather_region *region, const ppmi_region_triangle *t,
                        const region_normal *normal, double least_limit)
{
    if (is_inside(t, least_limit) && z_max(t) <= (double)PPMI_REGION_ABOVE &&
        z_min(t) >= -(double)PPMI_REGION_BELOW) {
        return 0.5 * fabs(normal->z) *
               (kernel_between(t, 0, 1) + kernel_between(t, 1, 2) + kernel_between(t, 2, 0)) / 3.0;
    }
    const region_polygon polygon = near_plane(t);
    double sum = 0.0;
    for (int i = 0; i < polygon.count; i++) {
        const int k = (i + 1) % polygon.count;
        sum += edge_integral(region, polygon.x[i], polygon.y[i], polygon.x[k], polygon.y[k]);
    }
    return fabs(sum);
}

/* Of the kernel over all that is open, were there a surface everywhere. */
static double open_measure(const ppmi_gather_region *region)
{
    double sum = 0.0;
    for (int i = 0; i < PPMI_REGION_SECTORS; i++)
        sum += disk_integral((double)region->limits[i]) * sector_angle;
    return sum;
}

/* How far the point may be off its triangle: corners and the point are rounded. */
static double center_slack(const ppmi_gather_region *region)
{
    const double rounding = 4e-7 * (double)vec3_max_abs(region->center) / (double)region->radius;
    return fmax(flatness, rounding);
}

/* Whether the triangle holds the point: its height is 0 there. Queries show large triangles that
 * pass through the tangent plane far away, too. */
static bool holds_center(const ppmi_region_triangle *t, const region_normal *n, double most_height)
{
    const double height = n->x * t->x[0] + n->y * t->y[0] + n->z * t->z[0];
    if (fabs(height) > most_height * n->length) return false;
    int sides = 0;
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        const double cross = cross_of(t, i, k);
        const double dx = t->x[k] - t->x[i], dy = t->y[k] - t->y[i];
        const double slack = flatness * sqrt(dx * dx + dy * dy);
        sides |= (cross > -slack ? 1 : 0) << i | (cross < slack ? 1 : 0) << (i + 3);
    }
    return (sides & 7) == 7 || (sides & 56) == 56;
}

/* Walls, and what faces the same way as the point. */
static bool classify(ppmi_gather_region *region)
{
    const double most_height = center_slack(region);
    bool is_flat = true, is_on_front = false, is_on_back = false;
    for (uint32_t i = 0; i < region->count; i++) {
        ppmi_region_triangle *t = &region->triangles[i];
        const region_normal n = normal_of(t);
        const double low = z_min(t), high = z_max(t);
        const bool is_in_plane = low > -flatness && high < flatness;
        is_flat = is_flat && is_in_plane;
        t->is_front = n.z > 0.0;
        t->counts = fabs(n.z) >= (double)PPMI_REGION_COSINE * n.length && n.length > 0.0;
        if (high > (double)PPMI_REGION_ABOVE) add_wall_of(region, t);
        if (t->counts && holds_center(t, &n, most_height)) {
            is_on_front = is_on_front || t->is_front;
            is_on_back = is_on_back || !t->is_front;
        }
    }
    region->is_known = is_on_front || is_on_back;
    if (is_flat || !region->is_known) return is_flat;
    /* the point's own side: of a closed thing the other one is within it */
    if (is_on_front && is_on_back) return false;
    const bool side = is_on_front;
    for (uint32_t i = 0; i < region->count; i++) {
        ppmi_region_triangle *t = &region->triangles[i];
        if (t->counts && t->is_front != side) {
            t->counts = false;
            region->is_layered = true;
        }
    }
    return false;
}

static double smallest(const float *limits)
{
    float least = 1.0f;
    for (int i = 0; i < PPMI_REGION_SECTORS; i++)
        least = ppmi_min(least, limits[i]);
    return (double)least;
}

/* All that is open counts: of a crowd, and of a surface that was not found (a ball, rough glass).
 */
static void take_all(ppmi_gather_region *region)
{
    region->share = ppmi_max((float)(open_measure(region) / (0.5 * pi)), least_share);
    region->is_whole = !region->is_bounded;
}

static void measure(ppmi_gather_region *region, bool is_flat)
{
    const double least_limit = smallest(region->limits), whole = 0.5 * pi;
    double area = 0.0, shadow = 0.0;
    for (uint32_t i = 0; i < region->count; i++) {
        const ppmi_region_triangle *t = &region->triangles[i];
        if (!t->counts) continue;
        const region_normal n = normal_of(t);
        const double part = projected(region, t, &n, least_limit);
        shadow += part;
        area += part * n.length / fabs(n.z);
    }
    const double open = open_measure(region);
    if (shadow > 1.001 * open) {
        area *= open / shadow;
        region->is_layered = !is_flat;
    }
    region->share = ppmi_max((float)(area / whole), least_share);
    region->is_whole = is_flat && !region->is_bounded;
}

static void start(ppmi_gather_region *region, const ppmi_visible_point *point, float radius)
{
    const ppmi_frame frame = ppmi_frame_from_normal(point->bsdf.ng);
    region->radius = radius;
    region->share = 1.0f;
    region->is_whole = true;
    region->is_bounded = region->is_layered = region->is_known = false;
    region->center = point->position;
    region->s = frame.s;
    region->t = frame.t;
    region->n = frame.n;
    region->count = 0;
    for (int i = 0; i < PPMI_REGION_SECTORS; i++)
        region->limits[i] = 1.0f;
}

/* Whether another triangle has the edge too. */
static bool is_shared(const ppmi_gather_region *region, uint32_t owner, int i, int k)
{
    const ppmi_region_triangle *t = &region->triangles[owner];
    for (uint32_t other = 0; other < region->count; other++) {
        const ppmi_region_triangle *o = &region->triangles[other];
        if (other == owner) continue;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3;
            if (o->x[a] == t->x[k] && o->y[a] == t->y[k] && o->x[b] == t->x[i] &&
                o->y[b] == t->y[i]) {
                return true;
            }
        }
    }
    return false;
}

/* Whether all that was found is one plane under the whole disk: no border passes through it. Told
 * for few triangles, without a measure. */
static bool is_plain(const ppmi_gather_region *region, double most_height)
{
    enum { FEW = 12 };
    if (region->count > FEW) return false;
    for (uint32_t i = 0; i < region->count; i++) {
        const ppmi_region_triangle *t = &region->triangles[i];
        if (z_min(t) < -most_height || z_max(t) > most_height) return false;
    }
    for (uint32_t i = 0; i < region->count; i++) {
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3;
            if (distance2_of(&region->triangles[i], a, b) < 1.0 && !is_shared(region, i, a, b)) {
                return false;
            }
        }
    }
    return true;
}

/* ---- plain disks ----------------------------------------------------------------------------- */

/* A disk in a plain one may be that much smaller: heights are held against flatness of the small
 * one, whose search would have found it plain too. */
static const float least_of_plain = 0.125f;

static bool lies_in(const ppmi_plain_disk *known, const ppmi_visible_point *point, float radius)
{
    const ppmi_vec3 n = known->normal, ng = point->bsdf.ng;
    if (n.x != ng.x || n.y != ng.y || n.z != ng.z) return false;
    const ppmi_vec3 way = vec3_sub(point->position, known->center);
    return vec3_length(way) + disk_reach * radius <= known->radius &&
           radius >= least_of_plain * known->radius &&
           fabsf(vec3_dot(way, n)) <= 0.5f * (float)flatness * radius;
}

/* Looks for a plain disk with room for the points of later passes, whose disks are smaller. Uses
 * region for its search. */
static void learn_plain(const ppmi_accel *accel, const ppmi_visible_point *point, float radius,
                        float time, ppmi_plain_disk *known, ppmi_gather_region *region)
{
    const float wider = 1.5f * radius, try_again = 0.7f;
    if (known->failed > 0.0f && wider > try_again * known->failed) return;
    start(region, point, wider);
    region_search search = {.region = region, .scale = 1.0 / (double)wider};
    ppmi_accel_nearby(accel, point->position, disk_reach * wider, time, on_triangle, &search);
    if (search.is_full || region->count == 0 ||
        !is_plain(region, 0.25 * (double)least_of_plain * flatness)) {
        known->failed = wider;
        return;
    }
    *known =
        (ppmi_plain_disk){.center = point->position, .normal = point->bsdf.ng, .radius = wider};
}

/* Walls alone, where there are too many triangles for a measure. */
static bool on_wall(void *user, const ppmi_near_triangle *triangle)
{
    const region_search *search = user;
    ppmi_region_triangle found;
    bring_home(search, triangle, &found);
    if (z_min(&found) <= (double)PPMI_REGION_ABOVE && z_max(&found) > (double)PPMI_REGION_ABOVE) {
        add_wall_of(search->region, &found);
    }
    return true;
}

static void find_walls(const ppmi_accel *accel, const ppmi_visible_point *point, float radius,
                       float time, ppmi_gather_region *region)
{
    start(region, point, radius);
    region_search search = {.region = region, .scale = 1.0 / (double)radius};
    ppmi_accel_nearby(accel, point->position, disk_reach * radius, time, on_wall, &search);
    take_all(region);
}

void ppmi_region_find(const ppmi_accel *accel, const ppmi_visible_point *point, float radius,
                      float time, ppmi_plain_disk *known, ppmi_gather_region *region)
{
    enum { HALVINGS = 2 };
    if (known && lies_in(known, point, radius)) {
        start(region, point, radius);
        return;
    }
    for (int i = 0; i <= HALVINGS; i++, radius *= 0.5f) {
        start(region, point, radius);
        region_search search = {.region = region, .scale = 1.0 / (double)radius};
        ppmi_accel_nearby(accel, point->position, disk_reach * radius, time, on_triangle, &search);
        if (search.is_full) continue;
        if (region->count == 0) return;
        if (is_plain(region, flatness)) {
            if (known && i == 0) learn_plain(accel, point, radius, time, known, region);
            start(region, point, radius);
            return;
        }
        sort(region);
        const bool is_flat = classify(region);
        if (region->is_known) {
            measure(region, is_flat);
        } else {
            take_all(region);
        }
        return;
    }
    find_walls(accel, point, 2.0f * radius, time, region);
}

/* ---- photons --------------------------------------------------------------------------------- */

/* The triangle's height above a place in the tangent plane; false where it is not. */
static bool height_at(const ppmi_region_triangle *t, double x, double y, double *height)
{
    const double ax = t->x[1] - t->x[0], ay = t->y[1] - t->y[0];
    const double bx = t->x[2] - t->x[0], by = t->y[2] - t->y[0];
    const double whole = ax * by - ay * bx;
    if (whole == 0.0) return false;
    const double dx = x - t->x[0], dy = y - t->y[0];
    const double u = (dx * by - dy * bx) / whole, v = (ax * dy - ay * dx) / whole;
    const double slack = 1e-5;
    if (u < -slack || v < -slack || u + v > 1.0 + slack) return false;
    *height = t->z[0] + u * (t->z[1] - t->z[0]) + v * (t->z[2] - t->z[0]);
    return true;
}

/* Whether the place is on a triangle that counts, and nothing is above it. */
static bool is_on_top(const ppmi_gather_region *region, double x, double y, double z)
{
    bool is_on_it = false;
    for (uint32_t i = 0; i < region->count; i++) {
        const ppmi_region_triangle *t = &region->triangles[i];
        double height;
        if (!height_at(t, x, y, &height)) continue;
        if (height > z + flatness && height <= (double)PPMI_REGION_ABOVE) return false;
        is_on_it = is_on_it || (t->counts && fabs(height - z) <= flatness);
    }
    return is_on_it;
}

/* sector_of the place's angle, without the angle. */
static uint32_t sector_at(float x, float y)
{
    const float tan_sector = 0.41421356f, ax = fabsf(x), ay = fabsf(y);
    const uint32_t in_quadrant =
        ay < ax ? (ay < tan_sector * ax ? 0 : 1) : (ax > tan_sector * ay ? 2 : 3);
    if (x >= 0.0f) return y >= 0.0f ? in_quadrant : 15 - in_quadrant;
    return y >= 0.0f ? 7 - in_quadrant : 8 + in_quadrant;
}

bool ppmi_region_holds(const ppmi_gather_region *region, ppmi_vec3 place)
{
    if (region->is_whole) return true;
    const ppmi_vec3 way = vec3_sub(place, region->center);
    const float scale = 1.0f / region->radius, z = scale * vec3_dot(way, region->n);
    if (z > PPMI_REGION_ABOVE) return false;
    if (!region->is_bounded && !region->is_layered) return true;
    const float x = scale * vec3_dot(way, region->s), y = scale * vec3_dot(way, region->t);
    if (region->is_bounded) {
        const float limit = region->limits[sector_at(x, y)];
        if (x * x + y * y >= limit * limit) return false;
    }
    return !region->is_layered || is_on_top(region, (double)x, (double)y, (double)z);
}
