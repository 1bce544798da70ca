/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that a scene's views are rendered from, each time that a view is loaded. */
#ifndef ADCGS_SCENE_SPLAT_VIEWS_H
#define ADCGS_SCENE_SPLAT_VIEWS_H

#include "media/dynamic/dynamic_splats.h"
#include "scene/scene.h"

#include <pthread.h>

#define ADCGS_SPLAT_STATES 4 /**< states of splats over time that are kept, at most; chosen by hand, not measured */

/** The splats at one time. */
typedef struct adcgs_splat_state {
    double time;         /**< seconds; negative: empty */
    uint64_t used;       /**< order of the last use */
    int users;           /**< renderings that read it */
    adcgs_splats splats; /**< in units of the radius, from the centre */
} adcgs_splat_state;

struct adcgs_splat_scene {
    adcgs_splats splats; /**< in units of the radius, from the centre; over time: those of the first frame */
    double centre[3], radius;
    adcgs_dynamic *dynamic; /**< NULL: the splats are static */
    int gives_points;       /**< the scene's points are the centres of these splats, which are static */
    pthread_mutex_t lock;   /**< protects the states, except the splats of those in use */
    pthread_cond_t unused;
    uint64_t uses;
    adcgs_splat_state state[ADCGS_SPLAT_STATES];
};

/** An empty scene of static splats, from malloc(); NULL: out of memory. */
adcgs_splat_scene *adcgs_splat_scene_create(void);
void adcgs_splat_scene_free(adcgs_splat_scene **splats);
/** Converts world units to those of the region, and limits values to a primitive's range. */
void adcgs_splat_scene_normalise(const adcgs_splat_scene *scene, adcgs_splats *splats);

/**
 * Renders the splats at a time, in seconds, for a camera over a background: three channels, values clipped to [0,1]. Colours
 * depend on the viewing direction, and are at least 0. For splats trained with antialiasing, opacity is scaled by sqrt(det S /
 * det(S + 0.3 I)), where S is the covariance in the image in pixels^2: the filter enlarges a splat, and must not make it
 * stronger. Any thread may call; path is for messages.
 */
adcgs_status adcgs_splat_scene_render(adcgs_splat_scene *scene, const float background[3], const adcgs_camera *camera,
                                      double time, adcgs_image *out, const char *path, adcgs_error *error);

#endif
