/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of files: putting them together, seeing what is there. */
#ifndef ADCGS_DATA_PATHS_H
#define ADCGS_DATA_PATHS_H

#include "base/base.h"

/** As printf into memory from malloc(), which the caller frees; NULL if there is none. */
char *adcgs_path(const char *format, ...) ADCGS_PRINTF(1, 2);
/** Is it there, and of this kind? 0 for NULL. */
int adcgs_is_file(const char *path);
int adcgs_is_folder(const char *path);
/**
 * *out: the stem itself or with an extension of images, whichever is a file; NULL if none is. ADCGS_ERR_MEMORY, or ADCGS_ERR_IO
 * for a symbolic link that leads nowhere.
 */
adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error);

#endif
