/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies among tracks of splats: samples of near tracks that move alike, by random sample consensus (Fischler and Bolles
 * 1981, CACM 24), each with the least-squares motion of its members from the rest frame to every frame.
 */
#ifndef ADCGS_INIT_SPLATS_SPLAT_BODIES_H
#define ADCGS_INIT_SPLATS_SPLAT_BODIES_H

#include "init/splats/splat_tracks.h"

/**
 * Finds at most `most` bodies among the tracks with kind[i] == moving that are visible in all frames. Sets body[i], from 1, of
 * their members, and out->body and n_bodies. out->n_frames and frame_time are those of the tracks. rest: the frame in which all
 * poses are the identity.
 */
adcgs_status adcgs_splat_bodies_find(adcgs_stereo *out, uint8_t *body, const adcgs_splat_tracks *tracks, const uint8_t *kind,
                                     uint8_t moving, uint32_t rest, uint32_t most, adcgs_error *error);

#endif
