/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stored cameras with their times, and a camera that follows a filmed path. */
#ifndef ADCGS_CAMERA_FOLLOW_H
#define ADCGS_CAMERA_FOLLOW_H

#include "camera/spline.h"

/** A stored camera. */
typedef struct adcgs_filmed_camera {
    adcgs_camera camera;
    double time; /**< seconds; NaN: none */
    int path;    /**< number of the filmed path that it is a key of; -1: none */
} adcgs_filmed_camera;

/** A path's camera at any time. */
typedef struct adcgs_follow {
    adcgs_camera_spline spline; /**< spline.n 0: there is no such path */
    double begin, end;          /**< of the path, seconds */
} adcgs_follow;

/** The stored cameras, [info->cameras]. The caller frees *cameras with free(), also after a failure. */
adcgs_status adcgs_filmed_cameras_get(adcgs_filmed_camera **cameras, const adcgs_decoder *decoder, const adcgs_info *info,
                                      adcgs_error *error);
/** The path with this number among n stored cameras. */
adcgs_status adcgs_follow_init(adcgs_follow *follow, const adcgs_filmed_camera *cameras, int n, int path, adcgs_error *error);
void adcgs_follow_clear(adcgs_follow *follow);
/** The camera at a time, which is clamped to the path's. Requires a path. */
void adcgs_follow_at(const adcgs_follow *follow, double time, adcgs_camera *camera);

#endif
