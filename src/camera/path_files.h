/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Declarations that the readers and writers of camera path files share, one format each. */
#ifndef ADCGS_CAMERA_PATH_FILES_H
#define ADCGS_CAMERA_PATH_FILES_H

#include "camera/path.h"

/** Input of a path's reader. */
typedef struct adcgs_path_reader {
    const char *path; /**< of the file */
    const adcgs_info *info;
    const adcgs_camera_path_request *request; /**< with at most one time */
    const adcgs_camera *like;                 /**< values missing in the file: of a stored camera, or a default one */
    adcgs_error *error;
} adcgs_path_reader;

/** Interpolate frames between keys, at out->frame_rate. The last key is included if a frame falls on it. */
adcgs_status adcgs_path_fly(const adcgs_path_reader *r, const adcgs_camera_key *keys, size_t n, int linear,
                            adcgs_camera_path *out);

/** The caller frees *out of readers, after failure too; writers are atomic. */
adcgs_status adcgs_path_json_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_json_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const char *path,
                                   adcgs_error *error);
/**
 * Format of Nuke and Blender: lines with frame, position, angles in degrees, and optionally a vertical field of view; OpenGL
 * axes.
 */
adcgs_status adcgs_path_chan_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_chan_write(const adcgs_camera_key *keys, int n, double frame_rate, adcgs_rotation_order order,
                                   const char *path, adcgs_error *error);
/** USD as text: the first prim of type Camera, with its parents' transforms. */
adcgs_status adcgs_path_usd_read(adcgs_camera_path *out, const adcgs_path_reader *r);
adcgs_status adcgs_path_usd_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const adcgs_info *info,
                                  const char *path, adcgs_error *error);

#endif
