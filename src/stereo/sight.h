/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Points whose places other cameras know, looked for in a camera's picture: about where its pose has them, or anywhere.
 */
#ifndef ADCGS_STEREO_SIGHT_H
#define ADCGS_STEREO_SIGHT_H

#include "stereo/smooth.h"

enum { ADCGS_SIGHT_MARKS = 224, ADCGS_SIGHTS = 1024 };

/** A pixel whose depth is known, and whose surroundings are not like those of the pixels beside it. */
typedef struct adcgs_mark {
    int px, py;
    double depth;
} adcgs_mark;

/** A picture made ready to be looked at. Zero-initialise before use. */
typedef struct adcgs_outlook {
    const adcgs_stereo_view *view;
    float *grey; /**< [h][w] */
    float *over; /**< [h][w] 1 over the length of the window about a pixel; 0: it tells nothing */
    int n_marks;
    adcgs_mark mark[ADCGS_SIGHT_MARKS];
} adcgs_outlook;

/** Where a camera shows a point that another one, which is named by its number, knows. */
typedef struct adcgs_sight {
    double x[3], at[2];
    int from;
} adcgs_sight;

typedef struct adcgs_sights {
    int n;
    adcgs_sight sight[ADCGS_SIGHTS];
} adcgs_sights;

/** changes: [h][w] of the view, 1: its pixel is not looked at. depths: of the view. */
adcgs_status adcgs_outlook_init(adcgs_outlook *outlook, const adcgs_stereo_view *view, const uint8_t *changes,
                                const adcgs_depths *depths, adcgs_error *error);
void adcgs_outlook_clear(adcgs_outlook *outlook);

/**
 * Look for the marks of another camera, for one in `every` of them. pose: of `in`, where it may be; its pixels are not looked at.
 * They are looked for no farther than reach pixels from where this pose has them; a reach of 0: anywhere, as if that camera
 * looked the same way as the other one. alike: [h][w] for work.
 */
void adcgs_sights_add(adcgs_sights *sights, const adcgs_outlook *in, const adcgs_stereo_view *pose, const adcgs_outlook *other,
                      int from, int every, int reach, float *alike);

#endif
