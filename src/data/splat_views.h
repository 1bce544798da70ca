/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that a scene's views are renderings of, drawn anew whenever one is loaded. */
#ifndef ADCGS_DATA_SPLAT_VIEWS_H
#define ADCGS_DATA_SPLAT_VIEWS_H

#include "data/scene.h"
#include "io/splats.h"

struct adcgs_splat_scene {
    adcgs_splats splats; /**< in units of the radius, from the centre */
    double centre[3], radius;
};

void adcgs_splat_scene_free(adcgs_splat_scene **splats);

/**
 * What a camera sees over a background, values clipped to [0,1], three channels. Colours are those for the direction of view,
 * and not below 0. Splats that were trained with antialiasing have their opacity scaled by sqrt(det S / det(S + 0.3 I)), S being
 * their covariance in the image in pixels^2: the filter makes a splat larger, and must not make it stronger. Any thread may call;
 * path is for messages.
 */
adcgs_status adcgs_splat_scene_render(const adcgs_splat_scene *splats, const float background[3], const adcgs_camera *camera,
                                      adcgs_image *out, const char *path, adcgs_error *error);

#endif
