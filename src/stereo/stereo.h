/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where things are, found by matching pictures before training: multi-view stereo. Cameras of one moment are matched over planes
 * of equal depth (Collins 1996, A space-sweep approach to true multi-image matching, CVPR), all neighbours at once, so that a
 * pattern that repeats finds the one depth at which all of them agree; what each camera finds is kept where others find the same.
 *
 * Cameras that stay where they are are matched once on what they show most of the time, which gives what is still, and moment by
 * moment where they show something else, which gives what moves, when, and how fast. The pictures of a film, of one camera that
 * goes, are matched as if all were taken at once, which gives what is still, and that tells where something else is shown. Only
 * views for training are looked at.
 * Deterministic for any number of threads.
 */
#ifndef ADCGS_STEREO_STEREO_H
#define ADCGS_STEREO_STEREO_H

#include "base/pool.h"
#include "data/scene.h"

enum { ADCGS_STEREO_MOMENTS = 48 /**< that are looked at, at most */ };

/** Whether something that moves lies where what is still lies anyhow. */
typedef enum adcgs_stereo_in_place {
    ADCGS_PLACE_OWN,    /**< it does not */
    ADCGS_PLACE_COMMON, /**< it does: a shadow, what is uncovered, or what turns on the spot */
    ADCGS_PLACE_STILL   /**< and most of the time what is still is seen there, so that it does not turn there all the time */
} adcgs_stereo_in_place;

typedef struct adcgs_stereo_point {
    double x[3];       /**< scene units */
    float rgb[3];
    float t;           /**< moment, 0..1; 0.5 for what is still */
    float velocity[3]; /**< scene units per unit of t; 0 where it is not known */
    float size;        /**< of a pixel at the point, scene units */
    float end[2];      /**< how long before and behind t it stays as it goes, of all time; 0: nothing tells of an end */
    float life, shift; /**< for who makes it an anchor: half of its life to begin with, and from t to the middle of that */
    float detail;      /**< contrast of the picture about it, 0..1 */
    uint8_t moves;
    uint8_t in_place;  /**< adcgs_stereo_in_place */
    uint8_t body;      /**< the body that it is part of, from 1; 0: none */
} adcgs_stereo_point;

/** Where a rigid body is at a moment: x at rest is at R(q) (x - pivot) + pivot + way. q: w, x, y, z, of length 1. */
typedef struct adcgs_stereo_pose {
    double q[4], way[3];
} adcgs_stereo_pose;

/** Parts of what moves that keep their form, followed over all moments. Signs of q are such that neighbours in time are near. */
typedef struct adcgs_stereo_body {
    double pivot[3];         /**< scene units */
    adcgs_stereo_pose *pose; /**< [n_moments] */
    uint32_t n;              /**< points that are part of it */
} adcgs_stereo_body;

typedef struct adcgs_stereo_options {
    double origin[3], scale; /**< of scene units, see adcgs_scene_frame() */
    uint32_t still;          /**< points that do not move, at most */
    uint32_t moving;         /**< points of each moment that do, at most */
    uint32_t moments;        /**< that are looked at, evenly spread, at most; 0: ADCGS_STEREO_MOMENTS */
    uint32_t bodies;         /**< rigid bodies among these, at most ADCGS_BODIES_MAX; 0: none are looked for */
    int judges;              /**< poses are judged */
} adcgs_stereo_options;

/**
 * How far poses are off. What one camera shows lies on a line in another's picture, wherever it is in space; where matches lie
 * beside it, poses or lenses are wrong.
 */
typedef struct adcgs_stereo_off {
    int pairs;     /**< of cameras that have enough in common; none: nothing is known */
    double median; /**< over these, of the distance of most of a pair's matches to one side, in pixels of what is matched */
    double pixels; /**< of the pictures as they are, to one of these */
} adcgs_stereo_off;

enum { ADCGS_STEREO_ODD = 4 };

/** A camera that shows what others show where its pose has it not, and the pose that would do. */
typedef struct adcgs_stereo_odd {
    uint32_t view; /**< the first of its views for training */
    double off;    /**< how far beside, in the median, in pixels of what is matched */
    double turned; /**< degrees from its pose to that one, and */
    double moved;  /**< the way, over the distance of what it sees */
} adcgs_stereo_odd;

/** Depths of what is still, which also say where nothing is. */
typedef struct adcgs_stereo_maps adcgs_stereo_maps;

/** Zero-initialise before use. */
typedef struct adcgs_stereo {
    uint32_t n_still, n_moving;
    adcgs_stereo_point *still;
    adcgs_stereo_point *moving; /**< ascending in t */
    int film;                   /**< one camera that goes: each moment is seen from one place */
    uint32_t n_moments;
    float *moment;              /**< [n_moments] those that were matched, ascending in t */
    uint32_t n_bodies;          /**< at most ADCGS_BODIES_MAX, the largest first */
    adcgs_stereo_body *body;
    adcgs_stereo_off poses;     /**< these, and cameras that are odd, if that was asked for */
    int n_odd;
    adcgs_stereo_odd odd[ADCGS_STEREO_ODD];
    adcgs_stereo_maps *maps;
} adcgs_stereo;

/**
 * Whether a scene allows it: at least three cameras that stay, in the mean two of them at a time, or a film, of one camera that
 * goes; pictures that are not tiny.
 */
adcgs_status adcgs_stereo_applies(const adcgs_scene *scene, int *applies, adcgs_error *error);

/** Both lists may be empty. */
adcgs_status adcgs_stereo_find(adcgs_stereo *out, const adcgs_scene *scene, const adcgs_stereo_options *options,
                               adcgs_pool *pool, adcgs_error *error);
void adcgs_stereo_clear(adcgs_stereo *stereo);

/** Time between neighbouring moments, of all time. */
static inline float adcgs_stereo_spacing(const adcgs_stereo *stereo)
{
    const uint32_t n = stereo->n_moments;
    return n > 1 ? (stereo->moment[n - 1] - stereo->moment[0]) / (float)(n - 1) : 1;
}

/** Whether most cameras that have a place, in scene units, in their pictures know a surface there, before it or behind it. */
int adcgs_stereo_is_known(const adcgs_stereo *stereo, const double x[3]);

/**
 * Whether what is still can be at a place, in scene units, only because hardly any camera would tell: no more than a third of
 * them have it in their pictures, and those that know something there see through it, to something behind; one does, or none has
 * it in its picture. A camera between the others would see it float before it.
 */
int adcgs_stereo_floats(const adcgs_stereo *stereo, const double x[3]);

#endif
