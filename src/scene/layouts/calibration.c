/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras calibrated for images of one size, used with images of another. */
#include "config.h"

#include "scene/layouts/calibration.h"

#include <math.h>

#define SHAPE_TOLERANCE 0.01 /* of width or height, relative; chosen by hand, not measured */

void adcgs_lens_resize(adcgs_lens *lens, int width, int height)
{
    const double x = (double)width / lens->width, y = (double)height / lens->height;
    lens->width = width;
    lens->height = height;
    lens->fx *= x;
    lens->fy *= y;
    lens->cx *= x;
    lens->cy *= y;
    lens->skew *= x;
}

adcgs_status adcgs_calibrate(adcgs_scene_view *view, const adcgs_lens *lens, int width, int height, const char *path,
                             adcgs_error *error)
{
    const double x = (double)width / lens->width, y = (double)height / lens->height;
    if (fabs(width - y * lens->width) > fmax(SHAPE_TOLERANCE * width, 1.0) &&
        fabs(height - x * lens->height) > fmax(SHAPE_TOLERANCE * height, 1.0))
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: %dx%d pixels, another aspect ratio than the %dx%d of its camera: check if "
                          "it is cropped or rotated",
                          path, width, height, lens->width, lens->height);
    view->lens = *lens;
    adcgs_lens_resize(&view->lens, width, height);
    return adcgs_lens_pinhole(&view->lens, &view->camera, path, error);
}
