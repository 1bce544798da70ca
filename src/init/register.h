/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Registration of a rigid body's points to those of a frame: iterative closest point in space and colour with robust weights
 * (Besl and McKay 1992, A method for registration of 3-D shapes, IEEE TPAMI 14; Johnson and Kang 1999, Registration and
 * integration of textured 3D data, Image and Vision Computing 17). The lighting does not rotate with the body, so each side has
 * its own gain in each frame.
 */
#ifndef ADCGS_INIT_REGISTER_H
#define ADCGS_INIT_REGISTER_H

#include "init/cloud.h"
#include "init/rigid/rigid.h"

enum { ADCGS_BODY_SIDES = 25 /**< four quarters of each cube face, by the normal, and one side for unknown normals; geometry */ };

/** Properties of a body's point in addition to its position. */
typedef struct adcgs_body_more {
    float normal[3];
    uint8_t side;
    uint16_t seen, agreed; /**< frames in which it faces a camera; frames in which it matches */
} adcgs_body_more;

/** A body in its rest pose. Zero-initialise before use. */
typedef struct adcgs_body_model {
    uint32_t n, capacity;
    adcgs_stereo_point *p;
    adcgs_body_more *more;
    double pixel; /**< scene units */
} adcgs_body_model;

/** The cameras with an image of a frame. */
typedef struct adcgs_frame_views {
    int n, frame;
    const adcgs_stereo_camera *camera[ADCGS_STEREO_CAMERAS];
} adcgs_frame_views;

/** Sums of colour products per side and channel. Zero-initialise before use. */
typedef struct adcgs_gain_sums {
    double with[ADCGS_BODY_SIDES][3]; /**< body colour times observed colour */
    double own[ADCGS_BODY_SIDES][3];  /**< body colour squared */
} adcgs_gain_sums;

/** Pose of a body in a frame, and the brightness of its sides relative to the rest pose. */
typedef struct adcgs_placement {
    adcgs_rigid at;
    float gain[ADCGS_BODY_SIDES][3];
    double share, light; /**< share of the points that match; agreement of the images, 0..1 */
} adcgs_placement;

/** Parameters of a registration. */
typedef struct adcgs_registration_stage {
    double reach, sharp; /**< pixels: maximum match distance; distance at which the fit is one half */
    int rounds;
    uint32_t stride; /**< of the body's points */
} adcgs_registration_stage;

/** Side of a normal in the rest pose. */
int adcgs_body_side(const float normal[3]);

adcgs_status adcgs_body_add(adcgs_body_model *model, const adcgs_stereo_point *point, const float normal[3], adcgs_error *error);
void adcgs_body_clear(adcgs_body_model *model);

void adcgs_frame_views_init(adcgs_frame_views *views, const adcgs_stereo_rig *rig, int frame);

/** True if a view sees the front of a surface at x with this normal. A normal of 0 faces every view. */
int adcgs_faces(const adcgs_stereo_view *view, const double x[3], const double normal[3]);

/** Position and normal of a body's point in a frame. \return the number of views that it faces. */
int adcgs_body_point_at(const adcgs_body_model *model, uint32_t i, const adcgs_rigid *at, const adcgs_frame_views *views,
                        double x[3], double normal[3]);

/** Gains from sums. Sides with little data get the gain of the others. */
void adcgs_gains_set(float gain[ADCGS_BODY_SIDES][3], const adcgs_gain_sums *sums);

void adcgs_body_register(const adcgs_body_model *model, const adcgs_cloud *cloud, const adcgs_frame_views *views,
                         const adcgs_registration_stage *how, adcgs_placement *place);

/** Finds the frame's point at the position of the body's point i and with a similar colour. Returns 0 if there is none. */
int adcgs_body_match(const adcgs_body_model *model, uint32_t i, const double x[3], const adcgs_cloud *cloud,
                     const adcgs_placement *place, uint32_t *found);

/** True if a position in the rest pose, with this colour, matches one of the body's points, which are in the cloud `own`. */
int adcgs_body_near(const adcgs_body_model *model, const adcgs_cloud *own, const double x[3], const float rgb[3],
                    uint32_t *found);

/** Sets place->share. */
void adcgs_body_judge(const adcgs_body_model *model, const adcgs_cloud *cloud, const adcgs_frame_views *views, uint32_t stride,
                      adcgs_placement *place);

#endif
