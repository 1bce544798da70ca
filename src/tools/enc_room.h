/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The room that a run's images take, reported before training. */
#ifndef ADCGS_TOOLS_ENC_ROOM_H
#define ADCGS_TOOLS_ENC_ROOM_H

#include "tools/enc_run.h"

/** Of the run's images at full size, where they do not all fit into memory; once. Decodes an image or two then. */
adcgs_status adcgs_enc_tell_room(adcgs_enc_watcher *w, adcgs_error *error);
/** Images are loaded: some have found no room, although it was not foreseen. Once. */
void adcgs_enc_tell_no_room(adcgs_enc_watcher *w);

#endif
