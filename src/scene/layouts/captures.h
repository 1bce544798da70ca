/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Captures in formats that are recognised by their fields or files, but not read. */
#ifndef ADCGS_SCENE_LAYOUTS_CAPTURES_H
#define ADCGS_SCENE_LAYOUTS_CAPTURES_H

#include "base/base.h"

#include <jansson.h>

/** Returns ADCGS_ERR_UNSUPPORTED for the metadata of Record3D, naming the program and a converter; path is the file's. */
adcgs_status adcgs_capture_refuse(json_t *root, const char *path, adcgs_error *error);
/** The same for a folder that contains such a file, or files of another program. ADCGS_ERR_MEMORY. */
adcgs_status adcgs_capture_refuse_folder(const char *folder, adcgs_error *error);

#endif
