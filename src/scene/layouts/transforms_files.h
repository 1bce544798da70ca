/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Locates the files named by transforms files, which may come from another machine. */
#ifndef ADCGS_SCENE_LAYOUTS_TRANSFORMS_FILES_H
#define ADCGS_SCENE_LAYOUTS_TRANSFORMS_FILES_H

#include "base/base.h"

/** folder + name, allocated; an absolute name is used alone. NULL on allocation failure. */
char *adcgs_transforms_join(const char *folder, const char *name);

/**
 * Finds the image of a name below a folder, which ends with its slash: by the name, or with an extension. If it does not exist,
 * tries slashes for backslashes. For an absolute name it tries the last parts, for files that have moved to another machine.
 * For a name in images/ (or masks/) it tries images_2/, images_3/ and so on, where nerfstudio and COLMAP's users put reduced
 * images. For a relative name it tries another letter case and another extension of images last. *out: NULL if none exists.
 * ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_transforms_find(char **out, const char *folder, const char *name, adcgs_error *error);

/** True for a Windows path, with a drive or backslashes. */
int adcgs_is_windows_path(const char *name);

#endif
