/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Warnings on a scene's footage before training: doubled or missing images, light, clocks, poses. */
#ifndef ADCGS_SESSION_ENC_FOOTAGE_H
#define ADCGS_SESSION_ENC_FOOTAGE_H

#include "check/axes.h"
#include "check/faults.h"
#include "cli/cli.h"
#include "scene/scene.h"
#include "scene/thumbnail_stats.h"

/**
 * Prints faults of footage (check/faults.h) unless --quiet, one line for each kind. scene: the part that is trained, which begins
 * at `begins` seconds of the whole; found: its matched images; doubled: its repeated images; thumbnails: those of its training
 * views. *told: kinds already reported for earlier parts of the scene, initially 0. Prints nothing on allocation failure.
 */
void adcgs_enc_diagnose_footage(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_stereo *found,
                                const adcgs_fault *doubled, adcgs_pool *pool, const adcgs_thumbnail *thumbnails, double begins,
                                unsigned *told);

/** Prints the scene's remarks, unless --quiet. */
void adcgs_enc_report_remarks(const adcgs_cli *cli, const adcgs_scene *scene);
/** Reports that this step of light was evened out, or that there is none. */
void adcgs_enc_report_light(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *light);

#endif
