/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images without a mask in a scene with a folder of masks. */
#ifndef ADCGS_SCENE_LAYOUTS_UNMASKED_H
#define ADCGS_SCENE_LAYOUTS_UNMASKED_H

#include "scene/scene.h"

/**
 * Adds a remark if the scene's directory has a folder masks or mask that is not empty, and some views have no mask. how names,
 * for the remark, the way in which the layout finds masks.
 */
adcgs_status adcgs_unmasked_remark(adcgs_scene *scene, const char *how, adcgs_error *error);

#endif
