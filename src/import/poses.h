/* SPDX-License-Identifier: BSD-2-Clause */
/** \file COLMAP's programs, one after the other. */
#ifndef ADCGS_IMPORT_POSES_H
#define ADCGS_IMPORT_POSES_H

#include "import/pictures.h"

/** How it is to be called, which its versions differ in. */
typedef struct adcgs_colmap_program {
    int is_known;   /**< it said what it takes */
    int is_renamed; /**< since 3.12 some options have other names */
} adcgs_colmap_program;

/** Before anything long begins: is it there? ADCGS_ERR_UNSUPPORTED, saying what to do, if not. */
adcgs_status adcgs_import_ask(adcgs_colmap_program *out, const adcgs_import_options *options, adcgs_error *error);
/** Models in sparse/0, sparse/1, ... of the job's folder, from its pictures. What COLMAP says is appended to the job's log. */
adcgs_status adcgs_import_poses(adcgs_import_job *job, const adcgs_colmap_program *program);

#endif
