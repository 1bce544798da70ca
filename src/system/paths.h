/* SPDX-License-Identifier: BSD-2-Clause */
/** \file File names: composing them, checking for existence. */
#ifndef ADCGS_SYSTEM_PATHS_H
#define ADCGS_SYSTEM_PATHS_H

#include "base/base.h"

/** Like printf into memory from malloc(), which the caller frees; NULL on allocation failure. */
char *adcgs_path(const char *format, ...) ADCGS_PRINTF(1, 2);
/** True if the name exists, even as a dangling link: opening it then reports the problem. 0 for NULL. */
int adcgs_is_there(const char *path);
/** The same for a path composed for this check. It allocates nothing, so no allocation failure can make a file seem missing. */
int adcgs_is_there_at(const char *format, ...) ADCGS_PRINTF(1, 2);
/** Returns 0 for NULL. */
int adcgs_is_folder(const char *path);
/** *out: the stem itself or with an image extension, the first that exists and is no folder; else NULL. ADCGS_ERR_MEMORY. */
adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error);
/**
 * Finds an image below a folder, which ends with its slash or is empty, by a name that may differ in letter case or in the
 * extension of images. *out: from malloc(); NULL if no file matches, or several do. ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_find_image_like(char **out, const char *folder, const char *name, adcgs_error *error);

#endif
