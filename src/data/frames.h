/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which frames of a scene are taken: begin, end, step, as in slices. */
#ifndef ADCGS_DATA_FRAMES_H
#define ADCGS_DATA_FRAMES_H

#include "base/base.h"

#define ADCGS_TIME_TOLERANCE 1e-6 /**< closer times of a layout, which are in [0,1], are one */

struct adcgs_scene;

/** begin, begin + step, ... below end. All zero: every frame. */
typedef struct adcgs_frame_range {
    int64_t begin, end; /**< end 0: the last one is in */
    int64_t step;       /**< 0: 1 */
} adcgs_frame_range;

/** "A:B:STEP", "A:B"; A may be left out for 0, B for the end. ADCGS_ERR_USAGE, naming the option. */
adcgs_status adcgs_frames_parse(adcgs_frame_range *range, const char *text, adcgs_error *error);
int64_t adcgs_frames_step(const adcgs_frame_range *range);
/** How many of n frames are taken. ADCGS_ERR_DATA, naming path, if none is. */
adcgs_status adcgs_frames_count(const adcgs_frame_range *range, int64_t n, int64_t *count, const char *path, adcgs_error *error);
/**
 * Leave the views of these moments of a scene whose times are in [0,1]. Moments are the distinct times of all its views, in
 * order; those that are kept are stretched to [0,1] again. ADCGS_ERR_DATA, naming path, if no view is left for training.
 */
adcgs_status adcgs_frames_keep(struct adcgs_scene *scene, const adcgs_frame_range *range, const char *path, adcgs_error *error);

/**
 * How many intervals between frames the times of a scene, which are in [0,1], make of it. Views for training that fill all of
 * a grid are the frames: others may have been made at moments in between. Where they leave gaps, because frames were put aside
 * for tests, the frames are the grid on which the views of all splits lie, if these fill at least half of it; else the views
 * for training decide, by their grid or by how many moments they have (*n_times). ADCGS_ERR_MEMORY, naming path.
 */
adcgs_status adcgs_frames_intervals(const struct adcgs_scene *scene, uint32_t *n_times, double *intervals, const char *path,
                                    adcgs_error *error);

#endif
