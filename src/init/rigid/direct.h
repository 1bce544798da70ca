/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sub-pixel refinement of a body's pose in one frame, directly on the images: the points must show their own colours, times the
 * gains of the body's sides (Engel, Koltun and Cremers 2017, Direct sparse odometry, IEEE TPAMI 40; weights of Geman and McClure
 * 1987).
 */
#ifndef ADCGS_INIT_RIGID_DIRECT_H
#define ADCGS_INIT_RIGID_DIRECT_H

#include "init/register.h"

/** Colour of an image at a position, and its derivatives per pixel. */
typedef struct adcgs_sample {
    double rgb[3], along[3], down[3];
} adcgs_sample;

/** Returns 0 if the colour is unknown. */
int adcgs_sample_image(const adcgs_stereo_camera *camera, int frame, const double at[2], adcgs_sample *sample);

/** Refines place->at and place->gain over every stride'th point. */
void adcgs_direct_refine(const adcgs_body_model *model, const adcgs_frame_views *views, uint32_t stride, adcgs_placement *place);

/** Sets place->gain and place->light at the current pose. */
void adcgs_direct_judge(const adcgs_body_model *model, const adcgs_frame_views *views, uint32_t stride, adcgs_placement *place);

/**
 * Agreement of the images at a pose, if each side may also change its colours by a gain and an offset per channel. Serves to
 * detect bodies that change only their appearance.
 */
double adcgs_direct_any_light(const adcgs_body_model *model, const adcgs_frame_views *views, uint32_t stride,
                              const adcgs_rigid *at);

/** Agreement of point i with the better half of the views that it faces, 0..1. */
double adcgs_direct_point(const adcgs_body_model *model, uint32_t i, const adcgs_frame_views *views,
                          const adcgs_placement *place);

#endif
