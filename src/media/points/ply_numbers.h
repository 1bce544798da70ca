/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The numbers of PLY's elements, for media/points/ply.c, which reads the header. */
#ifndef ADCGS_MEDIA_POINTS_PLY_NUMBERS_H
#define ADCGS_MEDIA_POINTS_PLY_NUMBERS_H

#include "media/points/ply.h"

/** The type of a name or alias: "float", "float32"; -1 for an unknown one. */
int adcgs_ply_type_of(const char *name);
/** Check an element's count against the bytes left. */
adcgs_status adcgs_ply_check_count(adcgs_ply *ply, const adcgs_ply_element *element);
/** Read the items of an element from the current position: pass their numbers to take(), or skip them if it is NULL. */
adcgs_status adcgs_ply_read(adcgs_ply *ply, const adcgs_ply_element *element, adcgs_ply_take_fn take, void *user);

#endif
