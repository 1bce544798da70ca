/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Executes a script. */
#ifndef ADCGS_PLAY_SCRIPT_RUN_H
#define ADCGS_PLAY_SCRIPT_RUN_H

#include "play/player.h"

/** Executes lines of the script until one has to wait. Its events arrive with the others. */
adcgs_status adcgs_script_go(adcgs_player *player, adcgs_error *error);

#endif
