/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of camera paths, one format each: what their readers share. */
#ifndef ADCGS_CAMERA_PATH_FILES_H
#define ADCGS_CAMERA_PATH_FILES_H

#include "camera/path.h"

/** What a path is read for. */
typedef struct adcgs_path_reader {
    const char *path;                         /**< of the file */
    const adcgs_info *info;
    const adcgs_camera_path_request *request; /**< one time at most */
    const adcgs_camera *like;                 /**< what the file does not say: a stored camera's, or one of our own */
    adcgs_error *error;
} adcgs_path_reader;

/** Make frames between keys, at out->frame_rate: one for each of its steps, the last key included where a step meets it. */
adcgs_status adcgs_path_fly(const adcgs_path_reader *r, const adcgs_camera_key *keys, size_t n, int linear,
                            adcgs_camera_path *out);

/** Readers leave to the caller to free *out, whatever they return; writers are atomic. */
adcgs_status adcgs_path_json_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_json_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const char *path,
                                   adcgs_error *error);
/** Nuke's and Blender's: lines of frame, place, angles in degrees, vertical field of view or none; OpenGL axes. */
adcgs_status adcgs_path_chan_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_chan_write(const adcgs_camera_key *keys, int n, double frame_rate, adcgs_rotation_order order,
                                   const char *path, adcgs_error *error);
/** USD as text: the first prim of type Camera, with its parents' transforms. */
adcgs_status adcgs_path_usd_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_usd_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const adcgs_info *info,
                                  const char *path, adcgs_error *error);

#endif
