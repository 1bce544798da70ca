/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A body's place at a moment to a fraction of a pixel, from the pictures themselves: its points should show the colours that they
 * have, with the gains of its sides (Engel, Koltun and Cremers 2017, Direct sparse odometry, IEEE TPAMI 40; weights as Geman and
 * McClure 1987).
 */
#ifndef ADCGS_STEREO_DIRECT_H
#define ADCGS_STEREO_DIRECT_H

#include "stereo/register.h"

/** What a picture shows at a place, and how that changes per pixel. */
typedef struct adcgs_sample {
    double rgb[3], along[3], down[3];
} adcgs_sample;

/** 0: it is not known. */
int adcgs_sample_take(const adcgs_stereo_camera *camera, int moment, const double at[2], adcgs_sample *sample);

/** Refine place->at and place->gain over every stride'th point. */
void adcgs_direct_refine(const adcgs_body_model *model, const adcgs_moment_views *views, uint32_t stride, adcgs_placing *place);

/** Set place->gain and place->light, where it is. */
void adcgs_direct_judge(const adcgs_body_model *model, const adcgs_moment_views *views, uint32_t stride, adcgs_placing *place);

/**
 * How well pictures agree at a place if each side may also change its colours as it likes, by a gain and an offset for each
 * channel: what a body that only changes its looks has to be asked.
 */
double adcgs_direct_any_light(const adcgs_body_model *model, const adcgs_moment_views *views, uint32_t stride,
                              const adcgs_rigid *at);

/** How well the better half of the views that point i of a body faces agree with it, 0..1. */
double adcgs_direct_point(const adcgs_body_model *model, uint32_t i, const adcgs_moment_views *views, const adcgs_placing *place);

#endif
