/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras calibrated for pictures of one size, used with pictures of another. */
#include "config.h"

#include "layouts/calibration.h"

#include <math.h>

#define SHAPE_TOLERANCE 0.01

adcgs_status adcgs_calibrate(adcgs_scene_view *view, const adcgs_lens *lens, int width, int height, const char *path,
                             adcgs_error *error)
{
    const double x = (double)width / lens->width, y = (double)height / lens->height;
    if (fabs(width - y * lens->width) > fmax(SHAPE_TOLERANCE * width, 1.0) &&
        fabs(height - x * lens->height) > fmax(SHAPE_TOLERANCE * height, 1.0))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, another shape than the %dx%d that its camera is given for",
                          path, width, height, lens->width, lens->height);
    view->lens = *lens;
    view->lens.width = width;
    view->lens.height = height;
    view->lens.fx *= x;
    view->lens.fy *= y;
    view->lens.cx *= x;
    view->lens.cy *= y;
    view->lens.skew *= x;
    return adcgs_lens_pinhole(&view->lens, &view->camera, path, error);
}
