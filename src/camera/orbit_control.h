/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A camera moved by hand: around a point, sideways, towards it, or freely. Axes
 * are those of adcgs_camera; angles are in radians. Without any movement the
 * camera stays bit-exact. Known as orbit or turntable control: yaw about up and
 * pitch about the horizontal, so that the image never rolls, as it may with an
 * arcball (Shoemake, 1992).
 */
#ifndef ADCGS_CAMERA_ORBIT_CONTROL_H
#define ADCGS_CAMERA_ORBIT_CONTROL_H

#include <adcgs/types.h>

typedef struct adcgs_orbit_control {
    adcgs_camera camera; /**< at the size of its intrinsics */
    double centre[3];    /**< of the scene [world units] */
    double target[3];    /**< centre of the orbit: the scene's centre, until it is panned or flown elsewhere */
    double up[3];        /**< unit vector */
    double unit;         /**< world units per scene unit */
} adcgs_orbit_control;

/** Centre, unit and up are the stream's; without an up axis in the stream, up is the camera's own. */
void adcgs_orbit_control_init(adcgs_orbit_control *control, const adcgs_info *info, const adcgs_camera *camera);
/** Take the pose and lens of another camera, and orbit about the scene's centre again. */
void adcgs_orbit_control_jump(adcgs_orbit_control *control, const adcgs_camera *camera);

/** Orbit about this point from now on. The camera does not change. */
void adcgs_orbit_control_pivot(adcgs_orbit_control *control, const double point[3]);

/**
 * Turn the whole camera about the target: yaw about up, then pitch about the horizontal. The distance and the target's position
 * in the image are unchanged. Pitch is limited so that the camera never looks straight up or down.
 */
void adcgs_orbit_control_orbit(adcgs_orbit_control *control, double yaw, double pitch);
/** The same turns about the camera's own position. */
void adcgs_orbit_control_look(adcgs_orbit_control *control, double yaw, double pitch);
/** Move camera and target so that the target moves right and down in the image, in focal lengths. */
void adcgs_orbit_control_pan(adcgs_orbit_control *control, double right, double down);
/** Move along the view: each step reduces the target's depth by a tenth; negative steps increase it. */
void adcgs_orbit_control_zoom(adcgs_orbit_control *control, double steps);
/** Move by scene units along the camera's own axes; the target stays. */
void adcgs_orbit_control_fly(adcgs_orbit_control *control, double right, double down, double forward);
/** After a flight: set the target to its nearest point on the view axis. */
void adcgs_orbit_control_land(adcgs_orbit_control *control);

/** Distance from camera to target, world units. */
double adcgs_orbit_control_distance(const adcgs_orbit_control *control);
/**
 * The camera for an image of another size, with square pixels if the camera has them. If the aspect ratios differ, the image
 * shows a part of the camera's view, which fills it: at least half of it, and more next to it if that does not fill the image.
 */
void adcgs_orbit_control_view(const adcgs_orbit_control *control, int width, int height, adcgs_camera *out);
/** The share of that image's width (axis 0) or height (axis 1) at each of two sides that is next to the camera's view. */
double adcgs_orbit_control_inset(const adcgs_orbit_control *control, int width, int height, int axis);

#endif
