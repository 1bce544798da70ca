/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which frames to render: a camera and a time for each. */
#ifndef ADCGS_TOOLS_SHOTS_H
#define ADCGS_TOOLS_SHOTS_H

#include "base/base.h"

#include <adcgs/decoder.h>

typedef struct adcgs_shot {
    adcgs_camera camera;
    double time; /**< seconds */
} adcgs_shot;

typedef struct adcgs_shots {
    int n;
    adcgs_shot *shot;
} adcgs_shots;

typedef struct adcgs_shots_request {
    const char *camera; /**< stored camera's name or index, "orbit", or a path's .json file; NULL: 0, or orbit without one */
    int has_times;
    double begin, end;  /**< seconds; the stream's whole span without them */
    int size[2];        /**< 0, 0: the camera's own; else its field of view is fitted to it */
} adcgs_shots_request;

adcgs_status adcgs_shots_make(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_shots_request *request,
                              adcgs_error *error);
void adcgs_shots_free(adcgs_shots *shots);

/* What follows is for the files of this part alone. */
#define ADCGS_SHOTS_MAX 1000000
#define ADCGS_ORBIT_WIDTH 800
#define ADCGS_ORBIT_HEIGHT 600

adcgs_status adcgs_shots_alloc(adcgs_shots *shots, double n, adcgs_error *error);
/**
 * A path from {"frames": [{"time": seconds, "transform_matrix": camera-to-world in OpenGL axes}], "fl_x": ..., "w": ...,
 * "h": ...}. Frames without a time follow each other at the stream's frame rate.
 */
adcgs_status adcgs_shots_read_path(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                                   double near_plane, adcgs_error *error);

#endif
