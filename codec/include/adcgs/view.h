/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Cameras for programs that render splats themselves, for example on a GPU.
 */
#ifndef ADCGS_VIEW_H
#define ADCGS_VIEW_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Convert a camera to the units of a scene, with the values that adcgs_render() uses (clause "View"). The function needs no
 * decoder and allocates nothing. Any number of threads may call it at once.
 * \param view receives the result; unspecified on failure
 * \param camera any camera, not only the stream's
 * \param origin adcgs_info.scene_origin: x, y, z in world units
 * \param scale adcgs_info.scene_scale: world units in a scene unit, 2^-60..2^60
 * \param error says why it failed; may be NULL
 * \return ADCGS_OK, or ADCGS_ERR_USAGE in these cases: another pointer is NULL; the camera or the scale is not as described; the
 *         near plane is outside of 2^-30..2^30 scene units; the camera is farther than 2^30 scene units from the scene
 */
ADCGS_API adcgs_status adcgs_view_init(adcgs_view *view, const adcgs_camera *camera, const double origin[3], double scale,
                                       adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
