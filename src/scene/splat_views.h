/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that a scene's views are rendered from, each time that a view is loaded. */
#ifndef ADCGS_SCENE_SPLAT_VIEWS_H
#define ADCGS_SCENE_SPLAT_VIEWS_H

#include "media/splats/splats.h"
#include "scene/scene.h"

struct adcgs_splat_scene {
    adcgs_splats splats; /**< in units of the radius, from the centre */
    double centre[3], radius;
};

void adcgs_splat_scene_free(adcgs_splat_scene **splats);

/**
 * Renders the splats for a camera over a background: three channels, values clipped to [0,1]. Colours depend on the viewing
 * direction, and are at least 0. For splats trained with antialiasing, opacity is scaled by sqrt(det S / det(S + 0.3 I)), where
 * S is the covariance in the image in pixels^2: the filter enlarges a splat, and must not make it stronger. Any thread may
 * call; path is for messages.
 */
adcgs_status adcgs_splat_scene_render(const adcgs_splat_scene *splats, const float background[3], const adcgs_camera *camera,
                                      adcgs_image *out, const char *path, adcgs_error *error);

#endif
