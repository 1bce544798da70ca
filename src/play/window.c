/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module that holds SDL. */
#include "config.h"

#include "play/window.h"

#if !defined HAVE_SDL

adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error)
{
    *sdl = NULL;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: the player needs SDL2, which this build does not have", path);
}

#elif defined MODULES

static adcgs_module module = {
    .file = "adcgs_play.so",
    .symbol = "adcgs_play_table",
    .purpose = "the player needs SDL2",
    .lock = PTHREAD_MUTEX_INITIALIZER,
};

adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error)
{
    const void *table;
    const adcgs_status status = adcgs_module_get(&module, &table, path, error);
    *sdl = table;
    return status;
}

#else

adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error)
{
    *sdl = &adcgs_play_table;
    return ADCGS_OK;
}

#endif
