/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The cameras that a stream stores with the scene. */
#ifndef ADCGS_ENCODE_STORED_CAMERAS_H
#define ADCGS_ENCODE_STORED_CAMERAS_H

#include "scene/scene.h"
#include "stream/stream.h"

#define ADCGS_STORED_CAMERAS_MAX 8 /**< cameras without a path; chosen by hand, not measured */
#define ADCGS_STORED_PATHS_MAX 8   /**< filmed paths; chosen by hand, not measured */

/**
 * Stores the filmed path of each moving camera; without a path a few training cameras, spread evenly over all of them. Images
 * belong to one camera if their files have one name except for a number at the end, or if they are frames of one video. Fixed
 * cameras that recur at every time are stored once. A camera that filmed at one time only has that time. stream->scene_scale
 * is given.
 */
adcgs_status adcgs_stored_cameras_choose(adcgs_stream *stream, const adcgs_scene *scene, adcgs_error *error);

#endif
