/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images that lie beside those of a scene, without a pose. */
#ifndef ADCGS_LAYOUTS_UNPOSED_H
#define ADCGS_LAYOUTS_UNPOSED_H

#include "data/scene.h"

/**
 * Remark how many images are in a folder, or in folders below it, that no view of the scene shows; nothing if there are none.
 * Names count without their extension. folder ends with its slash, and paths of views below it begin with it.
 * ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_unposed_remark(adcgs_scene *scene, const char *folder, adcgs_error *error);

#endif
