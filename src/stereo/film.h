/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What moves before a camera that moves, too. Depths of what is still, matched from picture to picture as if all were taken at
 * once, tell what each picture would show if nothing moved; what it shows besides moves. How far away that is no single camera
 * can tell. Things stand on something: along its lower edge it is taken to be as far away as what is seen below (Hoiem, Efros and
 * Hebert 2006, Putting objects in perspective, CVPR).
 */
#ifndef ADCGS_STEREO_FILM_H
#define ADCGS_STEREO_FILM_H

#include "stereo/fuse.h"

/** Set what each camera usually shows: what the others show at the depths that are still. */
adcgs_status adcgs_film_set_usual(adcgs_stereo_rig *rig, const adcgs_depths *depths, adcgs_pool *pool, adcgs_error *error);

/** Add the points of what moves in the picture of moment m. */
adcgs_status adcgs_film_find_moving(adcgs_stereo_list *list, const adcgs_stereo_rig *rig, const adcgs_depths *depths, int m,
                                    adcgs_error *error);

/**
 * Give each of the moving points, ascending in t, the middle of the velocities about it, at its moment and those beside: what one
 * point is laid onto is off by a pixel or so, which over a life is much.
 */
adcgs_status adcgs_film_even_velocities(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig, adcgs_error *error);

#endif
