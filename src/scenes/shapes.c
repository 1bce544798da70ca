/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rays against each shape. Each function is the smallest t > 0 of the ray, with the normal there. */
#include "scenes/shapes.h"

#include "camera/vector.h"

#include <math.h>

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
    case ADCGS_SHAPE_FLOOR:
        return hit_floor(o, d, object->size[0], normal);
    default:
        return hit_ball(o, d, object->size[0], normal);
    }
}
