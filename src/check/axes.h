/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Check of the axis convention of camera poses, before training. There are two common mistakes: OpenGL axes where OpenCV axes are
 * expected (or the reverse), and world-to-camera matrices in place of camera-to-world matrices.
 * The evidence is used in this order: the scene's points, which cameras must see; the images, in which neighbouring cameras must
 * show the same content; and, if neither decides, the placement of the cameras.
 */
#ifndef ADCGS_CHECK_AXES_H
#define ADCGS_CHECK_AXES_H

#include "init/stereo.h"

/** Possible meanings of the poses. The last one: world-to-camera matrices of OpenGL cameras in a file of OpenGL axes. */
typedef enum adcgs_axes_reading {
    ADCGS_READ_AS_GIVEN,
    ADCGS_READ_TURNED,
    ADCGS_READ_INVERSE,
    ADCGS_READ_INVERSE_OPENGL,
    ADCGS_READINGS
} adcgs_axes_reading;

typedef enum adcgs_axes_evidence { ADCGS_BY_POINTS, ADCGS_BY_IMAGES, ADCGS_BY_PLACES } adcgs_axes_evidence;

typedef struct adcgs_axes_check {
    adcgs_axes_reading meant; /**< ADCGS_READ_AS_GIVEN: no evidence against the poses; the other members are not set */
    adcgs_axes_evidence by;
    double here, there; /**< by points: mean share that a camera sees, under the poses as given and as meant */
} adcgs_axes_check;

enum { ADCGS_STEREO_PAIRS = 3 }; /* minimum number of camera pairs for a result; chosen by hand, not measured */

/** True if there are enough pairs and their matches lie on the epipolar lines. */
int adcgs_stereo_poses_fit(const adcgs_stereo_pose_error *off);

/** found: result of matching for this scene with its poses as given; zero if nothing was matched. */
adcgs_status adcgs_axes_check_run(adcgs_axes_check *out, const adcgs_scene *scene, const adcgs_stereo *found, adcgs_pool *pool,
                                  adcgs_error *error);

#endif
