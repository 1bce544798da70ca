/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The files that transforms files name, wherever they were made. */
#ifndef ADCGS_LAYOUTS_TRANSFORMS_FILES_H
#define ADCGS_LAYOUTS_TRANSFORMS_FILES_H

#include "base/base.h"

/** folder + name, allocated; absolute names stand for themselves. NULL without memory. */
char *adcgs_transforms_join(const char *folder, const char *name);

/**
 * The image of a name, below a folder that ends with its slash: as named or with an extension. Where there is none, with slashes
 * for backslashes; of an absolute name its last parts, for files that have moved to another machine; and of a name in images/ (or
 * masks/) the same in images_2/, images_3/ and so on, where nerfstudio and COLMAP's users put reduced images. *out: NULL if there
 * is none of these. ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_transforms_find(char **out, const char *folder, const char *name, adcgs_error *error);

/** Whether it is a path with a drive or backslashes, as Windows has them. */
int adcgs_is_windows_path(const char *name);

#endif
