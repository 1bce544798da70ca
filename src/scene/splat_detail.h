/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The share of an image that small splats cover. Trainers leave large splats where no camera looked, so an image with few small
 * splats is one that the splats were not made for.
 */
#ifndef ADCGS_SCENE_SPLAT_DETAIL_H
#define ADCGS_SCENE_SPLAT_DETAIL_H

#include "scene/splat_views.h"

/**
 * *share: of the opacity in the camera's image, the part of splats whose standard deviation is at most `most` pixels; 0 for an
 * image without splats. splats: in units of the scene's radius, from its centre.
 */
adcgs_status adcgs_splat_detail(double *share, const adcgs_splat_scene *scene, const adcgs_splats *splats,
                                const adcgs_camera *camera, double most, adcgs_error *error);

#endif
