/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Multi-view stereo before training: 3D points from matched images. The cameras of one frame are matched over planes of equal
 * depth (Collins 1996, A space-sweep approach to true multi-image matching, CVPR). All neighbours are compared at once, so that a
 * repetitive pattern matches only at the depth on which they all agree. A depth is kept if other cameras confirm it.
 *
 * Static cameras are matched once on their background, which gives the static points. In each frame they are matched again where
 * the image differs from the background, which gives moving points with time and velocity. The images of a single moving camera
 * are matched as if all were taken at once. This gives the static points, and with them the pixels that show other content. Only
 * training views are used.
 * The result does not depend on the number of threads.
 */
#ifndef ADCGS_INIT_STEREO_H
#define ADCGS_INIT_STEREO_H

#include "base/thread_pool.h"
#include "scene/scene.h"

/** Maximum number of matched frames; calibrated on demo, where 24 find no body (doc/log/bodies.md). */
enum { ADCGS_MATCHING_FRAMES_MAX = 48 };

/** Relation of a moving point to the static surfaces. */
typedef enum adcgs_stereo_in_place {
    ADCGS_PLACE_OWN,    /**< not on a static surface */
    ADCGS_PLACE_COMMON, /**< on a surface: a shadow, uncovered background, or an object that rotates in place */
    ADCGS_PLACE_STILL   /**< on a surface that is visible most of the time, so no object rotates there all the time */
} adcgs_stereo_in_place;

typedef struct adcgs_stereo_point {
    double x[3]; /**< scene units */
    float rgb[3];
    float t;           /**< time, 0..1; 0.5 for static points */
    float velocity[3]; /**< scene units per unit of t; 0 if unknown */
    float size;        /**< of a pixel at the point, scene units */
    float end[2];      /**< time from t to the end of the lifetime, before and after, 1: whole duration; 0: unknown */
    float life, shift; /**< for the anchor: initial half lifetime, and offset of its middle from t */
    float detail;      /**< contrast of the image around it, 0..1 */
    float spread[3];   /**< standard deviations along the axes of the content that it stands for, scene units; 0: unknown */
    float extent[3];   /**< standard deviations along the axes of a splat of this content, scene units; 0: unknown */
    uint8_t moves;
    uint8_t in_place; /**< adcgs_stereo_in_place */
    uint8_t body;     /**< index of its rigid body, from 1; 0: none */
} adcgs_stereo_point;

/** Pose of a rigid body in a frame: a rest position x moves to R(q) (x - pivot) + pivot + way. q: w, x, y, z, of length 1. */
typedef struct adcgs_stereo_pose {
    double q[4], way[3];
} adcgs_stereo_pose;

/** A rigid body, tracked over all frames. The signs of q are such that consecutive poses are close. */
typedef struct adcgs_stereo_body {
    double pivot[3];         /**< scene units */
    adcgs_stereo_pose *pose; /**< [n_frames] */
    uint32_t n;              /**< number of its points */
} adcgs_stereo_body;

typedef struct adcgs_stereo_options {
    double origin[3], scale; /**< of scene units, see adcgs_scene_frame() */
    uint32_t still;          /**< maximum number of static points */
    uint32_t moving;         /**< maximum number of moving points per frame */
    uint32_t frames;         /**< maximum number of matched frames, evenly spaced; 0: ADCGS_MATCHING_FRAMES_MAX */
    uint32_t bodies;         /**< maximum number of rigid bodies, up to ADCGS_BODIES_MAX; 0: no search */
    int judges;              /**< 1: measure pose errors and report outliers */
} adcgs_stereo_options;

/**
 * Pose errors. A pixel of one camera lies on its epipolar line in another image, at any depth. If matches lie off these lines,
 * the poses or the lens parameters are wrong.
 */
typedef struct adcgs_stereo_pose_error {
    int pairs;     /**< camera pairs with enough matches; 0: no result */
    double median; /**< median over pairs of |median offset of a pair's matches from the line|, pixels of reduced images */
    double pixels; /**< pixels of the original image per pixel of a reduced image */
} adcgs_stereo_pose_error;

enum { ADCGS_POSE_OUTLIERS_MAX = 4 }; /* maximum number of reported cameras; chosen by hand, not measured */

/** A camera whose image contradicts its pose, and the correction by the fitted pose. */
typedef struct adcgs_pose_outlier {
    uint32_t view; /**< index of its first training view */
    double off;    /**< median error, pixels of reduced images */
    double turned; /**< degrees: rotation to the fitted pose */
    double moved;  /**< translation to it, relative to the distance of the points */
} adcgs_pose_outlier;

/** Static depth maps, which also bound free space. */
typedef struct adcgs_stereo_maps adcgs_stereo_maps;

/** Zero-initialise before use. */
typedef struct adcgs_stereo {
    uint32_t n_still, n_moving;
    adcgs_stereo_point *still;
    adcgs_stereo_point *moving; /**< ascending in t */
    int monocular;              /**< 1: a single moving camera, so each frame has one view */
    uint32_t n_frames;
    float *frame_time; /**< [n_frames] t of the matched frames, ascending */
    uint32_t n_bodies; /**< at most ADCGS_BODIES_MAX, the largest first */
    adcgs_stereo_body *body;
    adcgs_stereo_pose_error poses; /**< pose errors and outliers, if options.judges */
    int n_outliers;
    adcgs_pose_outlier outlier[ADCGS_POSE_OUTLIERS_MAX];
    adcgs_stereo_maps *maps;
} adcgs_stereo;

/**
 * Sets *applies if matching suits the scene. It needs images that are not tiny, and one of two: at least three static cameras,
 * with two images per frame on average, or a single moving camera.
 */
adcgs_status adcgs_stereo_applies(const adcgs_scene *scene, int *applies, adcgs_error *error);

/** Matches the scene. Both lists may be empty. */
adcgs_status adcgs_stereo_find(adcgs_stereo *out, const adcgs_scene *scene, const adcgs_stereo_options *options, adcgs_pool *pool,
                               adcgs_error *error);
void adcgs_stereo_clear(adcgs_stereo *stereo);

/** Time between adjacent frames, 1: whole duration. */
static inline float adcgs_stereo_spacing(const adcgs_stereo *stereo)
{
    const uint32_t n = stereo->n_frames;
    return n > 1 ? (stereo->frame_time[n - 1] - stereo->frame_time[0]) / (float)(n - 1) : 1;
}

/** True if most cameras whose image contains the position, in scene units, have a depth there, in front of it or behind it. */
int adcgs_stereo_is_known(const adcgs_stereo *stereo, const double x[3]);

/**
 * True if static content at this position, in scene units, would be a floater. At most a third of the cameras have it in their
 * image, and no depth confirms it. At least one of them sees through it to a surface behind, or no camera has it in its image. A
 * camera between the others would see it float in front of the scene.
 */
int adcgs_stereo_floats(const adcgs_stereo *stereo, const double x[3]);

#endif
