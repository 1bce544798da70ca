/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Selection of a scene's frames by begin, end and step, as in slices. */
#ifndef ADCGS_SCENE_FRAMES_H
#define ADCGS_SCENE_FRAMES_H

#include "base/base.h"

/** Times of a layout, which are in [0,1], are equal if they are closer; chosen by hand, not measured. */
#define ADCGS_TIME_TOLERANCE 1e-6

struct adcgs_scene;

/** begin, begin + step, ... below end. All zero: every frame. */
typedef struct adcgs_frame_range {
    int64_t begin, end; /**< end is excluded; 0: up to and including the last frame */
    int64_t step;       /**< 0 means 1 */
} adcgs_frame_range;

/** Parses "A:B:STEP" or "A:B"; A defaults to 0, B to the end. ADCGS_ERR_USAGE, naming the option. */
adcgs_status adcgs_frames_parse(adcgs_frame_range *range, const char *text, adcgs_error *error);
int64_t adcgs_frames_step(const adcgs_frame_range *range);
/** Sets *count to the number of selected frames among n. ADCGS_ERR_DATA, naming path, if it is 0. */
adcgs_status adcgs_frames_count(const adcgs_frame_range *range, int64_t n, int64_t *count, const char *path, adcgs_error *error);
/**
 * Keeps the views of the selected frames of a scene whose times are in [0,1]. Frames are the distinct times of all its views,
 * in order. The remaining times are stretched to [0,1] again. ADCGS_ERR_DATA, naming path, if no training view is left.
 */
adcgs_status adcgs_frames_keep(struct adcgs_scene *scene, const adcgs_frame_range *range, const char *path, adcgs_error *error);

/**
 * Finds the number of intervals between frames in a scene whose times are in [0,1]. If the training views fill all of a grid,
 * they are the frames; other views may have been made at times in between. If they leave gaps, because frames were held out for
 * tests, the grid of all splits' views counts if these fill at least half of it. Otherwise the training views decide, by their
 * grid or by their number of distinct times (*n_times). ADCGS_ERR_MEMORY, naming path.
 */
adcgs_status adcgs_frames_intervals(const struct adcgs_scene *scene, uint32_t *n_times, double *intervals, const char *path,
                                    adcgs_error *error);

#endif
