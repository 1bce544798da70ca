/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of the player's output files. */
#ifndef ADCGS_PLAY_FILES_H
#define ADCGS_PLAY_FILES_H

#include <limits.h>

/** Finds an unused name in the working directory: the stream's name and a number. \return 0 if no number is left */
int adcgs_play_free_name(char out[PATH_MAX], const char *stream, const char *extension);

#endif
