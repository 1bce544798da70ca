/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Doing what a script says. */
#ifndef ADCGS_PLAY_SCRIPT_RUN_H
#define ADCGS_PLAY_SCRIPT_RUN_H

#include "play/player.h"

/** Do lines of the script until one has to wait. Events that it makes arrive with the others. */
adcgs_status adcgs_script_go(adcgs_player *player, adcgs_error *error);

#endif
