/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Laying the points of a rigid body onto those of a moment: iterated closest points in place and colour, with weights that
 * forget what does not fit (Besl and McKay 1992, A method for registration of 3-D shapes, IEEE TPAMI 14; Johnson and Kang 1999,
 * Registration and integration of textured 3D data, Image and Vision Computing 17). Light does not turn with a body: each side
 * of it has a gain of its own at each moment.
 */
#ifndef ADCGS_STEREO_REGISTER_H
#define ADCGS_STEREO_REGISTER_H

#include "stereo/cloud.h"
#include "stereo/rigid.h"

enum { ADCGS_BODY_SIDES = 25 /**< quarters of a cube's faces, by the normal, and where none is known */ };

/** What a point of a body is, beside where. */
typedef struct adcgs_body_more {
    float normal[3];
    uint8_t side;
    uint16_t seen, agreed; /**< moments at which it faced a camera; at which it was where it should be */
} adcgs_body_more;

/** A body at rest. Zero-initialise before use. */
typedef struct adcgs_body_model {
    uint32_t n, capacity;
    adcgs_stereo_point *p;
    adcgs_body_more *more;
    double pixel; /**< scene units */
} adcgs_body_model;

/** The cameras that show a moment. */
typedef struct adcgs_moment_views {
    int n, moment;
    const adcgs_stereo_camera *camera[ADCGS_STEREO_CAMERAS];
} adcgs_moment_views;

/** Sums over products of colours, of sides and channels. Zero-initialise before use. */
typedef struct adcgs_gain_sums {
    double with[ADCGS_BODY_SIDES][3]; /**< of the body's and those that are seen */
    double own[ADCGS_BODY_SIDES][3];  /**< of the body's with themselves */
} adcgs_gain_sums;

/** Where a body is at a moment, and how much lighter its sides are than at rest. */
typedef struct adcgs_placing {
    adcgs_rigid at;
    float gain[ADCGS_BODY_SIDES][3];
    double share, light; /**< of its points that are where they should be; how well pictures agree, 0..1 */
} adcgs_placing;

/** How points are laid on others. */
typedef struct adcgs_lay {
    double reach, sharp; /**< pixels: no match beyond; what counts half */
    int rounds;
    uint32_t stride;     /**< of the body's points */
} adcgs_lay;

/** Of a normal at rest. */
int adcgs_body_side(const float normal[3]);

adcgs_status adcgs_body_add(adcgs_body_model *model, const adcgs_stereo_point *point, const float normal[3], adcgs_error *error);
void adcgs_body_clear(adcgs_body_model *model);

void adcgs_moment_views_init(adcgs_moment_views *views, const adcgs_stereo_rig *rig, int moment);

/** Whether a surface at x that faces along a normal shows it to a view. A normal of 0 faces everything. */
int adcgs_faces(const adcgs_stereo_view *view, const double x[3], const double normal[3]);

/** A point of a body and its normal at a moment. \return how many views it faces. */
int adcgs_body_point_at(const adcgs_body_model *model, uint32_t i, const adcgs_rigid *at, const adcgs_moment_views *views,
                        double x[3], double normal[3]);

/** Gains from sums; where little is known, as elsewhere. */
void adcgs_gains_set(float gain[ADCGS_BODY_SIDES][3], const adcgs_gain_sums *sums);

void adcgs_body_lay(const adcgs_body_model *model, const adcgs_cloud *cloud, const adcgs_moment_views *views,
                    const adcgs_lay *how, adcgs_placing *place);

/** The point of a moment that is where point i of the body should be, and of its colour. 0: none. */
int adcgs_body_match(const adcgs_body_model *model, uint32_t i, const double x[3], const adcgs_cloud *cloud,
                     const adcgs_placing *place, uint32_t *found);

/** Whether a place at rest, of a colour, is one of the body's points, which are in a cloud of their own. */
int adcgs_body_near(const adcgs_body_model *model, const adcgs_cloud *own, const double x[3], const float rgb[3],
                    uint32_t *found);

/** Set place->share. */
void adcgs_body_judge(const adcgs_body_model *model, const adcgs_cloud *cloud, const adcgs_moment_views *views, uint32_t stride,
                      adcgs_placing *place);

#endif
