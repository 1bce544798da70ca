/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Captures of programs whose format is known by its fields, but not read. */
#ifndef ADCGS_LAYOUTS_CAPTURES_H
#define ADCGS_LAYOUTS_CAPTURES_H

#include "base/base.h"

#include <jansson.h>

/** ADCGS_ERR_UNSUPPORTED, naming the program and a converter, for the metadata of Record3D; path: of the file. */
adcgs_status adcgs_capture_refuse(json_t *root, const char *path, adcgs_error *error);
/** The same for a folder with such a file. ADCGS_ERR_MEMORY. */
adcgs_status adcgs_capture_refuse_folder(const char *folder, adcgs_error *error);

#endif
