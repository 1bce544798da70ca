/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of what the player writes. */
#ifndef ADCGS_PLAY_FILES_H
#define ADCGS_PLAY_FILES_H

#include <limits.h>

/** A name in the working directory that no file has yet: the stream's, and a number. \return 0 if no number is left. */
int adcgs_play_free_name(char out[PATH_MAX], const char *stream, const char *extension);

#endif
