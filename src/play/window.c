/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module with SDL. */
#include "config.h"

#include "play/window.h"

#ifndef HAVE_SDL

adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error)
{
    *sdl = NULL;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: the player needs SDL2, which this build does not have", path);
}

#else

ADCGS_MODULE_GET(adcgs_sdl_get, adcgs_sdl, adcgs_play_table, "adcgs_play.so", "the player needs SDL2")

#endif
