/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a run says about a scene's footage before it learns: pictures that are doubled or missing, light, clocks, poses. */
#ifndef ADCGS_TOOLS_ENC_FOOTAGE_H
#define ADCGS_TOOLS_ENC_FOOTAGE_H

#include "cli/cli.h"
#include "data/faults.h"
#include "data/glance.h"
#include "data/scene.h"
#include "stereo/axes.h"

/**
 * Note, unless --quiet, faults of footage that are found (data/faults.h), one line for each kind. scene: what is learnt at a
 * time, which begins at `begins` seconds of the whole; found: by its matched pictures; doubled: those of its pictures that come
 * twice; glances are of its training views. *told: kinds told of before, for one part of a scene after the other; 0 to begin
 * with. Where there is no memory for it nothing is said.
 */
void adcgs_enc_doubt_footage(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_stereo *found,
                             const adcgs_fault *doubled, adcgs_pool *pool, const adcgs_glance *glances, double begins,
                             unsigned *told);

/** Print the scene's remarks, unless --quiet. */
void adcgs_enc_tell_remarks(const adcgs_cli *cli, const adcgs_scene *scene);
/** Note that such a step of light was evened out, or that there is none. */
void adcgs_enc_tell_evened(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *light);

#endif
