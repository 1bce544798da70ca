/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Interpolating key frames. */
#include "config.h"

#include "camera/path_files.h"
#include "camera/spline.h"

#include <math.h>
#include <stdio.h>

adcgs_status adcgs_path_fly(const adcgs_path_reader *r, const adcgs_camera_key *keys, size_t n, int linear,
                            adcgs_camera_path *out)
{
    const double begin = keys[0].at, frames = floor((keys[n - 1].at - begin) * out->frame_rate + 1e-6) + 1.0;
    const double rate = out->frame_rate;
    adcgs_camera_spline spline;
    ADCGS_TRY(adcgs_camera_path_alloc(out, frames, r->path, r->error));
    out->frame_rate = rate;
    ADCGS_TRY(adcgs_camera_spline_init(&spline, keys, (int)n, linear, 0, r->error));
    for (int i = 0; i < out->n; i++) {
        adcgs_camera *camera = &out->frame[i].camera;
        adcgs_camera_spline_at(&spline, begin + i / rate, &out->frame[i]);
        snprintf(camera->name, sizeof camera->name, "frame %d", i);
    }
    adcgs_camera_spline_clear(&spline);
    return ADCGS_OK;
}
