/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One splat over time as pieces at equal distances: the steps of adcgs_pieces_add(). */
#ifndef ADCGS_MEDIA_DYNAMIC_PIECE_FIT_H
#define ADCGS_MEDIA_DYNAMIC_PIECE_FIT_H

#include "media/dynamic/splat_paths.h"

/** A path to replace. Frames are counted from its first sample. */
typedef struct adcgs_piece_path {
    const adcgs_path_sample *sample; /**< [frames]; quaternions of successive visible samples have no sign change */
    int frames;
    int low, high;  /**< first and last visible frame */
    int is_open[2]; /**< the clip begins at low, and ends at high */
    int first, end; /**< frames of the clip in which the path is compared, a few beyond low and high */
    double size;    /**< position error that is tolerated */
    adcgs_piece_form form;
} adcgs_piece_path;

/** A candidate. */
typedef struct adcgs_piece_trial {
    adcgs_piece *piece; /**< for all pieces, in the order of time */
    double *depth;      /**< for all compared frames */
    int n;
    double error; /**< root mean square over frames, in units of the tolerance */
} adcgs_piece_trial;

/** Weight of a piece at a frame, 0..1. */
double adcgs_piece_weight(const adcgs_piece *piece, double frame);
/** Fit position, rotation, scale and colour of a piece with centre and sigma, by least squares. */
void adcgs_piece_fit_motion(adcgs_piece *piece, const adcgs_piece_path *path);
/** Set the error of a trial. */
void adcgs_piece_judge(adcgs_piece_trial *trial, const adcgs_piece_path *path);

#endif
