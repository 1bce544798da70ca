/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes the scene file and its points. */
#ifndef ADCGS_APPS_IMPORT_SCENE_WRITE_H
#define ADCGS_APPS_IMPORT_SCENE_WRITE_H

#include "apps/import/colmap_result.h"

/** Writes scene.json and points.ply in the job's folder. */
adcgs_status adcgs_import_write(const adcgs_poses *poses, const adcgs_import_job *job);

#endif
