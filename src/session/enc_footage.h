/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Messages on a scene's footage before training. */
#ifndef ADCGS_SESSION_ENC_FOOTAGE_H
#define ADCGS_SESSION_ENC_FOOTAGE_H

#include "check/check_footage.h"
#include "cli/cli.h"

/** Checks footage and prints the findings, unless --quiet. *known: as for adcgs_check_footage(). */
void adcgs_enc_diagnose_footage(const adcgs_cli *cli, const adcgs_footage_facts *facts, adcgs_pool *pool, unsigned *known);

/** Prints the scene's remarks, unless --quiet. */
void adcgs_enc_report_remarks(const adcgs_cli *cli, const adcgs_scene *scene);
/** Reports that this step of light was evened out, or that there is none. */
void adcgs_enc_report_light(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *light);

#endif
