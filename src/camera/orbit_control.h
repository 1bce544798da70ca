/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A camera that is moved by hand: round a point, sideways, towards it, or
 * freely. Axes are those of adcgs_camera; angles are in radians. A camera that
 * nobody moved stays as it was given, to the last bit.
 */
#ifndef ADCGS_CAMERA_ORBIT_CONTROL_H
#define ADCGS_CAMERA_ORBIT_CONTROL_H

#include <adcgs/decoder.h>

typedef struct adcgs_play_rig {
    adcgs_camera camera; /**< at the size that its intrinsics are for */
    double centre[3];    /**< of the scene, world units */
    double target[3];    /**< what it orbits about: the centre until it is panned or flown elsewhere */
    double up[3];        /**< unit vector */
    double unit;         /**< world units in a scene unit */
} adcgs_play_rig;

/** Centre, unit and up are the stream's; where it names no up, the camera's own. */
void adcgs_play_rig_init(adcgs_play_rig *rig, const adcgs_info *info, const adcgs_camera *camera);
/** Take another camera's place and lens, and orbit about the scene's centre again. */
void adcgs_play_rig_jump(adcgs_play_rig *rig, const adcgs_camera *camera);

/**
 * Turn the whole camera about the target: yaw about up, then pitch about the
 * horizontal. The distance stays, and so does the target's place in the
 * picture. Pitch ends shortly before the camera looks straight up or down.
 */
void adcgs_play_rig_orbit(adcgs_play_rig *rig, double yaw, double pitch);
/** The same turns about the camera's own position. */
void adcgs_play_rig_look(adcgs_play_rig *rig, double yaw, double pitch);
/** Move camera and target so that the target moves by right and down in the picture, in focal lengths. */
void adcgs_play_rig_pan(adcgs_play_rig *rig, double right, double down);
/** Move along the view: the target's depth shrinks by a tenth for each step, and grows with negative ones. */
void adcgs_play_rig_zoom(adcgs_play_rig *rig, double steps);
/** Move by scene units along the camera's own axes, the target staying behind. */
void adcgs_play_rig_fly(adcgs_play_rig *rig, double right, double down, double forward);
/** After a flight: the target becomes the point of the view axis that is nearest to it. */
void adcgs_play_rig_land(adcgs_play_rig *rig);

/** Distance from camera to target, world units. */
double adcgs_play_rig_distance(const adcgs_play_rig *rig);
/**
 * The camera for a picture of another size, with square pixels where the camera has them: all that it sees is in it,
 * and more at two sides where the shapes differ.
 */
void adcgs_play_rig_view(const adcgs_play_rig *rig, int width, int height, adcgs_camera *out);

#endif
