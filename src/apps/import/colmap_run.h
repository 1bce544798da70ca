/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs COLMAP's programs one after another. */
#ifndef ADCGS_APPS_IMPORT_COLMAP_RUN_H
#define ADCGS_APPS_IMPORT_COLMAP_RUN_H

#include "apps/import/scene_images.h"

/** The program's interface, which differs between versions. */
typedef struct adcgs_colmap_program {
    int is_known;   /**< its help text was understood */
    int is_renamed; /**< since 3.12 some options have other names */
    int has_glomap; /**< glomap is installed, and the options allow it */
} adcgs_colmap_program;

/** Checks, before any long step, that the program exists. ADCGS_ERR_UNSUPPORTED, with advice, if it does not. */
adcgs_status adcgs_import_ask(adcgs_colmap_program *out, const adcgs_import_options *options, adcgs_error *error);
/** Makes models in sparse/0, sparse/1, ... of the job's folder from its images. Appends COLMAP's output to the job's log. */
adcgs_status adcgs_import_poses(adcgs_import_job *job, const adcgs_colmap_program *program);

#endif
