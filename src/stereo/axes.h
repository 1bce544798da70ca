/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whether cameras look where their poses say, told before anything is learnt. Two mistakes are common: axes of OpenGL where those
 * of OpenCV are expected, or the other way round, and matrices that take the world to the camera where those back are. What
 * bears witness is, in this order, the scene's points, which cameras must see; its pictures, in which neighbours must show the
 * same; and, where these say nothing, where the cameras are.
 */
#ifndef ADCGS_STEREO_AXES_H
#define ADCGS_STEREO_AXES_H

#include "stereo/stereo.h"

/** How poses may be meant. The last: what takes the world to cameras whose axes are OpenGL's, in a file of such axes. */
typedef enum adcgs_reading {
    ADCGS_READ_AS_GIVEN,
    ADCGS_READ_TURNED,
    ADCGS_READ_INVERSE,
    ADCGS_READ_INVERSE_OPENGL,
    ADCGS_READINGS
} adcgs_reading;

typedef enum adcgs_witness { ADCGS_BY_POINTS, ADCGS_BY_PICTURES, ADCGS_BY_PLACES } adcgs_witness;

typedef struct adcgs_axes_doubt {
    adcgs_reading meant; /**< as given: nothing speaks against it, and the rest is not set */
    adcgs_witness by;
    double here, there;  /**< by points: the share that a camera sees, as given and as meant */
} adcgs_axes_doubt;

enum { ADCGS_STEREO_PAIRS = 3 }; /* of cameras, that say something */

/** Whether there are so many, and matches lie where the poses have them. */
int adcgs_stereo_poses_fit(const adcgs_stereo_off *off);

/** found: of this scene, as its poses are given. Where nothing was matched, it is zero. */
adcgs_status adcgs_axes_doubt_find(adcgs_axes_doubt *out, const adcgs_scene *scene, const adcgs_stereo *found, adcgs_pool *pool,
                                   adcgs_error *error);

#endif
