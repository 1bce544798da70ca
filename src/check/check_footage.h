/* SPDX-License-Identifier: BSD-2-Clause */
/** \file All checks of a scene's footage: doubled or missing images, light, clocks, poses, axes. */
#ifndef ADCGS_CHECK_CHECK_FOOTAGE_H
#define ADCGS_CHECK_CHECK_FOOTAGE_H

#include "check/findings.h"
#include "scene/image_store.h"

/** The footage to judge. */
typedef struct adcgs_footage_facts {
    const adcgs_scene *scene;          /**< a scene, or a part of one (scene->whole) */
    double begins;                     /**< seconds at which the part begins in the whole */
    const adcgs_stereo *matched;       /**< matching with options.judges; zero if nothing was matched */
    const adcgs_thumbnail *thumbnails; /**< [training views] */
} adcgs_footage_facts;

/**
 * Appends findings. *known: kinds that earlier parts of the scene have shown, as bits 1 << adcgs_finding_kind, initially 0; each
 * kind is found once. A check that cannot allocate memory finds nothing.
 */
void adcgs_check_footage(adcgs_findings *findings, const adcgs_footage_facts *facts, adcgs_pool *pool, unsigned *known);

/** Computes the thumbnails of all training views from reduced images. config: progress callback and memory limit. */
adcgs_status adcgs_thumbnails_load(adcgs_thumbnail *thumbnails, const adcgs_scene *scene, const adcgs_image_store_config *config,
                                   adcgs_pool *pool, adcgs_error *error);

#endif
