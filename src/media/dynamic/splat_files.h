/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A folder of numbered files of static splats as splats over time. */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT_FILES_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT_FILES_H

#include "media/dynamic/dynamic_reader.h"

/** The reader; its path is a folder. */
extern const adcgs_dynamic_reader adcgs_dynamic_files;

/** True for a folder with two or more files of splats whose names end in a number. */
int adcgs_splat_files_are(const char *folder);
/** Path of the file of a frame; NULL behind the last. */
const char *adcgs_splat_files_path(const adcgs_dynamic *dynamic, uint32_t frame);
/** Parses the name of a frame: *prefix is the length of the text before the number. \return 0 for other names */
int adcgs_splat_files_name(const char *name, size_t *prefix, uint64_t *number);

#endif
