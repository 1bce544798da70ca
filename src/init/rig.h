/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The input of matching: static cameras, or the images of a single moving camera, with reduced images at a few frames, in scene
 * units.
 */
#ifndef ADCGS_INIT_RIG_H
#define ADCGS_INIT_RIG_H

#include "base/thread_pool.h"
#include "init/stereo.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

enum { ADCGS_STEREO_CAMERAS = 24 }; /* maximum number of matched cameras; chosen by hand, not measured */
/** From this value of the fourth channel on, a pixel counts as known; below 1 for rounding; chosen by hand, not measured. */
#define ADCGS_STEREO_KNOWN 0.99f

/** A camera and its image. */
typedef struct adcgs_stereo_view {
    double rotation[9], centre[3]; /**< rows: the camera's axes; scene units */
    double fx, fy, cx, cy;
    int w, h;
    const float *pixels;  /**< [h][w][4] red, green, blue, and 1 where the pixel is known */
    const uint8_t *moves; /**< [h][w] 1: moving content; NULL: unknown */
    const uint8_t *still; /**< [h][w] 1: the 3x3 window shows only background; known if `moves` is */
} adcgs_stereo_view;

typedef struct adcgs_stereo_camera {
    adcgs_stereo_view view;                    /**< pixels: the background */
    uint32_t first;                            /**< index of its first training view */
    float *background;                         /**< [h][w][4] background, the median over frames; owned */
    uint8_t *unstable;                         /**< [h][w] 1: no stable background */
    uint8_t *frame[ADCGS_MATCHING_FRAMES_MAX]; /**< [h][w][4] image of each frame; NULL: none */
} adcgs_stereo_camera;

/** Zero-initialise before use. */
typedef struct adcgs_stereo_rig {
    int n_cameras, n_frames;
    int monocular; /**< 1: a single moving camera; camera m has an image of frame m only */
    adcgs_stereo_camera camera[ADCGS_STEREO_CAMERAS];
    float frame_time[ADCGS_MATCHING_FRAMES_MAX]; /**< t of each frame, ascending */
    double nearest, farthest;                    /**< range of depths to search, scene units */
} adcgs_stereo_rig;

adcgs_status adcgs_stereo_rig_init(adcgs_stereo_rig *rig, const adcgs_scene *scene, const adcgs_stereo_options *options,
                                   adcgs_error *error);
void adcgs_stereo_rig_clear(adcgs_stereo_rig *rig);

/**
 * Levels of 255: maximum difference from the background without motion; calibrated on zju, where 9 and 6 gain nothing
 * (doc/log/matching.md).
 */
enum { ADCGS_STEREO_MOVED = 18 };

/** True if a pixel differs from the background in a frame. The frame must have an image. */
static inline int adcgs_stereo_rig_differs(const adcgs_stereo_camera *c, int frame, int pixel)
{
    int most = 0;
    for (int k = 0; k < 3; k++)
        most = ADCGS_MAX(most, abs(c->frame[frame][4 * pixel + k] - (int)(c->background[4 * pixel + k] * 255 + 0.5f)));
    return most > ADCGS_STEREO_MOVED || c->unstable[pixel];
}

/** Converts the image of a frame to floats, [h][w][4]. */
void adcgs_stereo_rig_get_frame(const adcgs_stereo_camera *camera, int frame, float *pixels);

/** Smooths all images, so that details of one or two pixels do not disturb the registration of bodies. */
adcgs_status adcgs_stereo_rig_smooth(adcgs_stereo_rig *rig, adcgs_error *error);

/** Returns the first failure of n parallel jobs. Each job has its own error, initialised to zeros. */
static inline adcgs_status adcgs_stereo_first_failure(const adcgs_error *errors, int n, adcgs_error *error)
{
    int i = 0;
    while (i < n && errors[i].status == ADCGS_OK)
        i++;
    return i < n ? adcgs_fail(error, errors[i].status, "%s", errors[i].text) : ADCGS_OK;
}

/** Distance between two camera centres, in scene units. */
static inline double adcgs_stereo_baseline(const adcgs_stereo_view *a, const adcgs_stereo_view *b)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += (a->centre[i] - b->centre[i]) * (a->centre[i] - b->centre[i]);
    return sqrt(square);
}

/** Cosine between two viewing directions. */
static inline double adcgs_stereo_axes_dot(const adcgs_stereo_view *a, const adcgs_stereo_view *b)
{
    return a->rotation[6] * b->rotation[6] + a->rotation[7] * b->rotation[7] + a->rotation[8] * b->rotation[8];
}

/**
 * Projects a point into a view: pixel coordinates with centres at + 0.5, and depth. Returns 0 if the point is behind the camera
 * (at[] is not set) or outside the image (at[] is set).
 */
static inline int adcgs_stereo_rig_project(const adcgs_stereo_view *v, const double x[3], double at[2], double *depth)
{
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = v->rotation[3 * a] * (x[0] - v->centre[0]) + v->rotation[3 * a + 1] * (x[1] - v->centre[1]) +
               v->rotation[3 * a + 2] * (x[2] - v->centre[2]);
    *depth = p[2];
    if (!(p[2] > 1e-6))
        return 0;
    at[0] = v->fx * p[0] / p[2] + v->cx;
    at[1] = v->fy * p[1] / p[2] + v->cy;
    return at[0] >= 0 && at[1] >= 0 && at[0] < v->w && at[1] < v->h;
}

/** The point at a given depth on the ray through the centre of a pixel. */
static inline void adcgs_stereo_rig_lift(const adcgs_stereo_view *v, int px, int py, double depth, double x[3])
{
    const double p[3] = {(px + 0.5 - v->cx) / v->fx * depth, (py + 0.5 - v->cy) / v->fy * depth, depth};
    for (int a = 0; a < 3; a++)
        x[a] = v->centre[a] + v->rotation[a] * p[0] + v->rotation[3 + a] * p[1] + v->rotation[6 + a] * p[2];
}

#endif
