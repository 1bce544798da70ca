/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether poses suffice for a scene. */
#ifndef ADCGS_APPS_IMPORT_POSE_JUDGE_H
#define ADCGS_APPS_IMPORT_POSE_JUDGE_H

#include "apps/import/scene_images.h"

/**
 * ADCGS_ERR_DATA, with the numbers and advice for filming, if the report shows too few poses or no parallax, unless the options
 * accept such poses.
 */
adcgs_status adcgs_import_judge(const adcgs_import_job *job);

#endif
