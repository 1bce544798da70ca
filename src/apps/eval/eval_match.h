/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks whether a stream was made of a scene: cameras, times, images. */
#ifndef ADCGS_APPS_EVAL_EVAL_MATCH_H
#define ADCGS_APPS_EVAL_EVAL_MATCH_H

#include "cli/cli.h"
#include "metric/evaluate.h"
#include "scene/scene.h"

typedef struct adcgs_match {
    const adcgs_cli *cli;
    const char *file, *scene_name; /**< for messages */
    const adcgs_decoder *decoder;
    const adcgs_scene *scene;
    adcgs_split split;
} adcgs_match;

/** Before the evaluation: ADCGS_ERR_DATA if no view of the split lies within the stream's time. */
adcgs_status adcgs_match_check(const adcgs_match *match, adcgs_error *error);
/** After the evaluation: prints remarks on mismatches. */
void adcgs_match_report(const adcgs_match *match, const adcgs_evaluation *evaluation);

#endif
