/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Intersection of rays with each shape. Each function returns the smallest t > 0 of the ray, and the normal there. */
#include "synthetic/shapes.h"

#include "geometry/vector.h"

#include <math.h>

#define HAIR_LINKS 8 /* straight links of a strand of hair; chosen by hand */

static double hit_ball(const double o[3], const double d[3], double radius, double normal[3])
{
    const double a = adcgs_v3_dot(d, d), b = adcgs_v3_dot(o, d), q = b * b - a * (adcgs_v3_dot(o, o) - radius * radius);
    if (q < 0.0)
        return ADCGS_SHAPES_FAR;
    const double root = sqrt(q), t = (-b - root > 0.0 ? -b - root : -b + root) / a;
    if (t <= 0.0)
        return ADCGS_SHAPES_FAR;
    for (int i = 0; i < 3; i++)
        normal[i] = (o[i] + t * d[i]) / radius;
    return t;
}

static double hit_box(const double o[3], const double d[3], const double half[3], double normal[3])
{
    double enter = -ADCGS_SHAPES_FAR, leave = ADCGS_SHAPES_FAR;
    int axis = 0;
    for (int i = 0; i < 3; i++) {
        const double slope = d[i] != 0.0 ? 1.0 / d[i] : ADCGS_SHAPES_FAR, middle = -o[i] * slope;
        const double reach = half[i] * (slope < 0.0 ? -slope : slope);
        if (middle - reach > enter) {
            enter = middle - reach;
            axis = i;
        }
        leave = ADCGS_MIN(leave, middle + reach);
    }
    if (enter >= leave || enter <= 0.0)
        return ADCGS_SHAPES_FAR;
    normal[0] = normal[1] = normal[2] = 0.0;
    normal[axis] = d[axis] > 0.0 ? -1.0 : 1.0;
    return enter;
}

static double hit_cylinder(const double o[3], const double d[3], const double size[3], double normal[3])
{
    const double radius = size[0], half = size[2];
    const double a = d[0] * d[0] + d[1] * d[1], b = o[0] * d[0] + o[1] * d[1];
    const double q = b * b - a * (o[0] * o[0] + o[1] * o[1] - radius * radius);
    if (q >= 0.0 && a > 1e-12) {
        const double t = (-b - sqrt(q)) / a, z = o[2] + t * d[2];
        if (t > 0.0 && z >= -half && z <= half) {
            normal[0] = (o[0] + t * d[0]) / radius;
            normal[1] = (o[1] + t * d[1]) / radius;
            normal[2] = 0.0;
            return t;
        }
    }
    if (d[2] == 0.0)
        return ADCGS_SHAPES_FAR;
    const double cap = d[2] < 0.0 ? half : -half, t = (cap - o[2]) / d[2];
    const double x = o[0] + t * d[0], y = o[1] + t * d[1];
    if (t <= 0.0 || x * x + y * y > radius * radius)
        return ADCGS_SHAPES_FAR;
    normal[0] = normal[1] = 0.0;
    normal[2] = d[2] < 0.0 ? 1.0 : -1.0;
    return t;
}

/* The walls of a box from inside. */
static double hit_room(const double o[3], const double d[3], const double half[3], double normal[3])
{
    double leave = ADCGS_SHAPES_FAR;
    int axis = 0;
    for (int i = 0; i < 3; i++) {
        const double t = d[i] != 0.0 ? ((d[i] > 0.0 ? half[i] : -half[i]) - o[i]) / d[i] : ADCGS_SHAPES_FAR;
        if (t < leave) {
            leave = t;
            axis = i;
        }
    }
    if (leave <= 0.0)
        return ADCGS_SHAPES_FAR;
    normal[0] = normal[1] = normal[2] = 0.0;
    normal[axis] = d[axis] > 0.0 ? -1.0 : 1.0;
    return leave;
}

/* The points at a distance of radius from the line from a to b. Only entry points count, seen from outside. */
static double hit_link(const double o[3], const double d[3], const double a[3], const double b[3], double radius,
                       double normal[3])
{
    double axis[3], from[3], best = ADCGS_SHAPES_FAR;
    for (int i = 0; i < 3; i++) {
        axis[i] = b[i] - a[i];
        from[i] = o[i] - a[i];
    }
    const double length2 = adcgs_v3_dot(axis, axis), along = adcgs_v3_dot(axis, d), start = adcgs_v3_dot(axis, from);
    const double p = length2 * adcgs_v3_dot(d, d) - along * along, q = length2 * adcgs_v3_dot(from, d) - start * along;
    const double r = length2 * (adcgs_v3_dot(from, from) - radius * radius) - start * start, root2 = q * q - p * r;
    if (p > 0.0 && root2 >= 0.0) {
        const double t = (-q - sqrt(root2)) / p, at = start + t * along;
        if (t > 0.0 && at >= 0.0 && at <= length2) {
            for (int i = 0; i < 3; i++)
                normal[i] = (from[i] + t * d[i] - axis[i] * at / length2) / radius;
            return t;
        }
    }
    for (int end = 0; end < 2; end++) {
        double relative[3], own[3];
        for (int i = 0; i < 3; i++)
            relative[i] = o[i] - (end ? b[i] : a[i]);
        const double t = hit_ball(relative, d, radius, own);
        if (t < best) {
            best = t;
            memcpy(normal, own, sizeof own);
        }
    }
    return best;
}

static double hit_capsule(const double o[3], const double d[3], const double size[3], double normal[3])
{
    const double a[3] = {0.0, 0.0, -size[2]}, b[3] = {0.0, 0.0, size[2]};
    return hit_link(o, d, a, b, size[0], normal);
}

static double hit_hair(const double o[3], const double d[3], const double size[3], double normal[3])
{
    double best = ADCGS_SHAPES_FAR, a[3] = {0.0, 0.0, -size[2]};
    for (int link = 1; link <= HAIR_LINKS; link++) {
        const double f = 2.0 * link / HAIR_LINKS - 1.0, b[3] = {size[1] * (1.0 - f * f), 0.0, size[2] * f};
        double own[3];
        const double t = hit_link(o, d, a, b, size[0], own);
        if (t < best) {
            best = t;
            memcpy(normal, own, sizeof own);
        }
        memcpy(a, b, sizeof a);
    }
    return best;
}

static double hit_floor(const double o[3], const double d[3], double radius, double normal[3])
{
    if (d[2] == 0.0)
        return ADCGS_SHAPES_FAR;
    const double t = -o[2] / d[2], x = o[0] + t * d[0], y = o[1] + t * d[1];
    if (t <= 0.0 || x * x + y * y > radius * radius)
        return ADCGS_SHAPES_FAR;
    normal[0] = normal[1] = 0.0;
    normal[2] = 1.0;
    return t;
}

double adcgs_shapes_hit(const adcgs_trace_object *object, const double o[3], const double d[3], double normal[3])
{
    switch (object->shape) {
    case ADCGS_SHAPE_BOX:
        return hit_box(o, d, object->size, normal);
    case ADCGS_SHAPE_CYLINDER:
        return hit_cylinder(o, d, object->size, normal);
    case ADCGS_SHAPE_CAPSULE:
        return hit_capsule(o, d, object->size, normal);
    case ADCGS_SHAPE_HAIR:
        return hit_hair(o, d, object->size, normal);
    case ADCGS_SHAPE_ROOM:
        return hit_room(o, d, object->size, normal);
    case ADCGS_SHAPE_FLOOR:
        return hit_floor(o, d, object->size[0], normal);
    default:
        return hit_ball(o, d, object->size[0], normal);
    }
}

double adcgs_shapes_bound2(const adcgs_trace_object *object)
{
    const double *const size = object->size, ends = size[0] + size[2];
    const double bow = size[1] < 0.0 ? size[0] - size[1] : size[0] + size[1];
    switch (object->shape) {
    case ADCGS_SHAPE_BOX:
    case ADCGS_SHAPE_ROOM:
        return adcgs_v3_dot(size, size);
    case ADCGS_SHAPE_CAPSULE:
        return ends * ends;
    case ADCGS_SHAPE_HAIR:
        return ends * ends + bow * bow;
    default:
        return size[0] * size[0] + size[2] * size[2];
    }
}
