/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The point of the scene under a place of the image. */
#include "config.h"

#include "camera/pivot.h"

#include "base/base.h"
#include "geometry/rotation.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define SIDE 64        /* pixels of the reduced image's longer side */
#define AROUND 0.125   /* share of the longer side: half the width of the square around the place that counts */
#define OPAQUE 0.5f    /* minimum alpha of a pixel that shows the scene */
#define PIXELS_LEAST 3 /* opaque pixels of the square, which has about 250: fewer are noise */

static int compare_depths(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/** Median depth of the opaque pixels around a place, in pixels; 0 if there are too few. */
static float median_depth(float *depth, const float *alpha, const adcgs_camera *c, double x, double y)
{
    const double around = AROUND * SIDE;
    size_t n = 0;
    for (int j = 0; j < c->height; j++)
        for (int i = 0; i < c->width; i++) {
            const size_t at = (size_t)j * (size_t)c->width + (size_t)i;
            if (fabs(i + 0.5 - x) <= around && fabs(j + 0.5 - y) <= around && alpha[at] >= OPAQUE)
                depth[n++] = depth[at]; /* n never passes at */
        }
    if (n < PIXELS_LEAST)
        return 0;
    qsort(depth, n, sizeof *depth, compare_depths);
    return depth[n / 2];
}

adcgs_status adcgs_pivot_find(double point[3], adcgs_decoder *decoder, const adcgs_camera *camera, double time, double x,
                              double y, adcgs_error *error)
{
    adcgs_camera c = *camera;
    const double scale = (double)SIDE / ADCGS_MAX(c.width, c.height);
    adcgs_camera_stretch(&c, ADCGS_MAX(1, (int)(c.width * scale + 0.5)), ADCGS_MAX(1, (int)(c.height * scale + 0.5)));
    const size_t n = (size_t)c.width * (size_t)c.height;
    float *const depth = malloc(2 * n * sizeof *depth), *const alpha = depth + n;
    if (!depth)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for an image of depths");
    adcgs_status status = adcgs_render_depth(decoder, &c, time, depth, alpha, error);
    const double px = x * c.width, py = y * c.height;
    const float z = status == ADCGS_OK ? median_depth(depth, alpha, &c, px, py) : 0;
    if (status == ADCGS_OK && !(z > 0))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "the place shows background only");
    const double ray[3] = {(px - c.cx) / c.fx, (py - c.cy) / c.fy, 1};
    for (int i = 0; i < 3 && status == ADCGS_OK; i++)
        point[i] = c.cam_to_world[4 * i + 3] + (double)z * (c.cam_to_world[4 * i] * ray[0] + c.cam_to_world[4 * i + 1] * ray[1] +
                                                            c.cam_to_world[4 * i + 2] * ray[2]);
    free(depth);
    return status;
}
