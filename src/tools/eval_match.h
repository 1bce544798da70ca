/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether a stream may have been made of a scene: cameras, times, pictures. */
#ifndef ADCGS_TOOLS_EVAL_MATCH_H
#define ADCGS_TOOLS_EVAL_MATCH_H

#include "cli/cli.h"
#include "data/scene.h"
#include "metric/evaluate.h"

/** Before the evaluation. Notes say what does not match; ADCGS_ERR_DATA if no view of the split is within the stream's time. */
adcgs_status adcgs_eval_match(const adcgs_cli *cli, const char *file, const adcgs_decoder *decoder, const char *scene_name,
                              const adcgs_scene *scene, adcgs_split split, adcgs_error *error);
/** After it: a note if the pictures are nothing like the decoded views. */
void adcgs_eval_match_pictures(const adcgs_cli *cli, const char *file, const char *scene_name,
                               const adcgs_evaluation *evaluation);

#endif
