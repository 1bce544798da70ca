/* SPDX-License-Identifier: BSD-2-Clause */
/** \file COLMAP's vocabulary tree, by which it recognises a place that a film has shown before. */
#ifndef ADCGS_APPS_IMPORT_VOCABULARY_H
#define ADCGS_APPS_IMPORT_VOCABULARY_H

#include "base/base.h"

/**
 * Finds a tree in the folders where COLMAP and packages keep it. is_faiss: of the format that COLMAP reads since 3.12, else of
 * the one before; the name shows it. *out is NULL if there is none; else the caller free()s it.
 */
adcgs_status adcgs_import_find_vocabulary(char **out, int is_faiss, adcgs_error *error);

#endif
