/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of files: putting them together, seeing what is there. */
#ifndef ADCGS_DATA_PATHS_H
#define ADCGS_DATA_PATHS_H

#include "base/base.h"

/** As printf into memory from malloc(), which the caller frees; NULL if there is none. */
char *adcgs_path(const char *format, ...) ADCGS_PRINTF(1, 2);
/** Is there something of this name, be it a link that leads nowhere? Who opens it hears what is wrong with it. 0 for NULL. */
int adcgs_is_there(const char *path);
/** The same of a path that is written out only to ask: it takes no memory, so that none cannot make a file seem missing. */
int adcgs_is_there_at(const char *format, ...) ADCGS_PRINTF(1, 2);
/** 0 for NULL. */
int adcgs_is_folder(const char *path);
/** *out: the stem itself or with an extension of images, whichever is there and no folder; NULL if none is. ADCGS_ERR_MEMORY. */
adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error);

#endif
