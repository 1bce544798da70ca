/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whether a PNG or JPEG file is whole. Their libraries make do with what there is of one that ends early, grey for the rest,
 * or say on standard error what is wrong with it; so we look first. Readers of other formats tell us.
 */
#ifndef ADCGS_IO_WHOLE_H
#define ADCGS_IO_WHOLE_H

#include "base/base.h"

#include <stdio.h>

/**
 * A file at its beginning, which is where it is left when it is good, as all of other formats are. all 0: only what precedes the
 * pixels. ADCGS_ERR_DATA for one that ends early, for a checksum that is wrong, and for a size beyond ADCGS_IMAGE_MAX.
 */
adcgs_status adcgs_whole_check(FILE *file, int all, const char *path, adcgs_error *error);

#endif
