/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Conversion of a camera in world units to a view in scene units (spec clause "View"). */
#include "render/render.h"

#include <math.h>

/* Bound of a view's translation, scene units: far beyond any use, small enough that nothing overflows later. */
#define FIELD_MAX 0x1p30

static int usable(double v, double lo, double hi)
{
    return v >= lo && v <= hi;
}

static adcgs_status check_camera(const adcgs_camera *camera, adcgs_error *error)
{
    if (camera->width < 1 || camera->width > 16384 || camera->height < 1 || camera->height > 16384)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: image of %d x %d pixels, expected 1..16384 each", (int)camera->width,
                          (int)camera->height);
    if (!usable(camera->fx, 0x1p-10, 0x1p24) || !usable(camera->fy, 0x1p-10, 0x1p24))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: focal lengths %g, %g pixels, expected 2^-10..2^24", camera->fx,
                          camera->fy);
    if (!usable(camera->cx, -0x1p20, 0x1p20) || !usable(camera->cy, -0x1p20, 0x1p20))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: principal point %g, %g is farther than 2^20 pixels", camera->cx,
                          camera->cy);
    const double *m = camera->cam_to_world;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double dot = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
            if (!usable(dot - (i == j ? 1.0 : 0.0), -1e-3, 1e-3))
                return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: the rotation in cam_to_world is not orthonormal");
        }
    return ADCGS_OK;
}

static void fill_limits(adcgs_view *view, const adcgs_camera *camera)
{
    const double margin_x = 0.15 * camera->width, margin_y = 0.15 * camera->height;
    view->limit[0] = (float)((-camera->cx - margin_x) / camera->fx);
    view->limit[1] = (float)((camera->width - camera->cx + margin_x) / camera->fx);
    view->limit[2] = (float)((-camera->cy - margin_y) / camera->fy);
    view->limit[3] = (float)((camera->height - camera->cy + margin_y) / camera->fy);
}

adcgs_status adcgs_view_init(adcgs_view *view, const adcgs_camera *camera, const double origin[3], double scale,
                             adcgs_error *error)
{
    if (!view || !camera || !origin)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %s is NULL", __func__, !view ? "view" : !camera ? "camera" : "origin");
    ADCGS_TRY(check_camera(camera, error));
    if (!usable(scale, 0x1p-60, 0x1p60))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scene scale %g, expected 2^-60..2^60", scale);
    const double near_plane = camera->near_plane / scale;
    if (!usable(near_plane, 0x1p-30, 0x1p30))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: near plane at %g scene units, expected 2^-30..2^30", near_plane);
    const double *m = camera->cam_to_world;
    for (int i = 0; i < 3; i++) {
        double t = 0.0;
        for (int j = 0; j < 3; j++) {
            view->rotation[3 * i + j] = (float)m[4 * j + i];
            t += m[4 * j + i] * ((origin[j] - m[4 * j + 3]) / scale);
        }
        if (!usable(t, -FIELD_MAX, FIELD_MAX))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "camera: farther than 2^30 scene units from the scene");
        view->translation[i] = (float)t;
    }
    view->width = camera->width;
    view->height = camera->height;
    view->fx = (float)camera->fx;
    view->fy = (float)camera->fy;
    view->cx = (float)camera->cx;
    view->cy = (float)camera->cy;
    view->near_plane = (float)near_plane;
    fill_limits(view, camera);
    return ADCGS_OK;
}
