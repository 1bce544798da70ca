/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The ray tracer of the scenes: textured shapes with simple motions, a key light with a soft edge, ambient and fill light.
 */
#ifndef ADCGS_SYNTHETIC_TRACE_H
#define ADCGS_SYNTHETIC_TRACE_H

#include "base/thread_pool.h"

typedef enum adcgs_trace_shape {
    ADCGS_SHAPE_BALL,     /**< size[0] is the radius */
    ADCGS_SHAPE_BOX,      /**< size is half the edges */
    ADCGS_SHAPE_CYLINDER, /**< size[0] is the radius, size[2] half the height, axis z */
    ADCGS_SHAPE_CAPSULE,  /**< the same with a half ball at each end, outside the height */
    ADCGS_SHAPE_FLOOR,    /**< the disc z = position z of radius size[0] */
    ADCGS_SHAPE_HAIR,     /**< a chain of capsules of radius size[0] from z = -size[2] to size[2] along a parabola; its
                               middle lies at x = size[1], its ends at x = 0; casts no shadow */
    ADCGS_SHAPE_DOME,     /**< a ball seen from inside: emits light, casts no shadow */
    ADCGS_SHAPE_ROOM,     /**< a box seen from inside, size is half the edges; outside light passes through its walls */
    ADCGS_SHAPE_LAMP      /**< invisible; lights its surroundings, half as bright at the distance size[0], through everything */
} adcgs_trace_shape;

typedef enum adcgs_trace_texture {
    ADCGS_TEXTURE_PLAIN,
    ADCGS_TEXTURE_CHECKER,
    ADCGS_TEXTURE_STRIPES, /**< soft stripes across the local x + z/2 */
    ADCGS_TEXTURE_NOISE,   /**< three octaves of smooth noise */
    ADCGS_TEXTURE_RINGS,   /**< soft rings around the local z axis */
    ADCGS_TEXTURE_PATCHES, /**< a grid of cells, each with its own random mix */
    ADCGS_TEXTURE_DOTS
} adcgs_trace_texture;

/** One object in a scene. Motions add up; a member left at zero has no effect. Time runs from 0 to 1. */
typedef struct adcgs_trace_object {
    adcgs_trace_shape shape;
    double size[3];
    double position[3];
    double tilt; /**< turns about the local x axis, before everything else */
    double turn; /**< turns about the z axis, after the tilt */
    adcgs_trace_texture texture;
    double frequency;    /**< texture cells per unit of length */
    double colour[2][3]; /**< the two ends of the texture's mix */
    double detail;       /**< strength of the fine noise on top, 0..1 */
    uint32_t seed;
    double velocity[3]; /**< units per unit of time */
    double bounces, bounce_height;
    double spin_axis[3], spin;    /**< unit axis, turns per unit of time */
    double orbit[2], orbit_turns; /**< circle about the point orbit (x, y) in turns per unit of time */
    double stretch[3], beats; /**< soft body: size along local axes times 1 + stretch sin(beats time), including its texture */
    double zigzag[3], zigs;   /**< back and forth in straight lines, zigs times per unit of time, with sharp turns */
    double slide[3];          /**< motion of its texture over the static surface, units per unit of time */
    double clear;             /**< glass: share of the light that passes through each of its sides, without refraction */
    double mirror;            /**< share of reflected light */
    int glows;                /**< fire: emits light, casts no shadow; has gaps where its texture's mix is small */
    double fade[3];           /**< added smoothly to both colours until time 1 */
    double from;              /**< absent before this time */
    double until;             /**< absent from this time on; 0: it stays */
} adcgs_trace_object;

/** A camera of the tracer: OpenGL axes (x right, y up, looking along -z), as in the written layout. */
typedef struct adcgs_trace_camera {
    double to_world[12]; /**< row-major 3x4 */
    double focal;        /**< in pixels */
} adcgs_trace_camera;

/** The camera at eye that looks at target with z up. */
void adcgs_trace_look(adcgs_trace_camera *camera, const double eye[3], const double target[3]);

/**
 * Renders n objects at a time: interleaved rgb [height][width][3], 0..1, with samples x samples rays per pixel. The bytes are
 * the same for any number of threads.
 */
adcgs_status adcgs_trace_render(const adcgs_trace_object *objects, int n, const adcgs_trace_camera *camera, double time,
                                int width, int height, int samples, adcgs_pool *pool, float *rgb, adcgs_error *error);

/**
 * Coverage of the image by objects: the share of a pixel's samples that meet one, 0..1, [height][width]. Samples are those of
 * adcgs_trace_render(), whose colours are premultiplied by the coverage.
 */
adcgs_status adcgs_trace_alpha(const adcgs_trace_object *objects, int n, const adcgs_trace_camera *camera, double time, int width,
                               int height, int samples, adcgs_pool *pool, float *alpha, adcgs_error *error);

/**
 * Mask of some objects, [height][width]: 1 if, for at least half of a pixel's samples, the nearest surface belongs to an object
 * whose bit (bit i: object i) is set in `which`, else 0. Samples are those of adcgs_trace_render().
 */
adcgs_status adcgs_trace_cover(const adcgs_trace_object *objects, int n, uint32_t which, const adcgs_trace_camera *camera,
                               double time, int width, int height, int samples, adcgs_pool *pool, float *cover,
                               adcgs_error *error);

#endif
