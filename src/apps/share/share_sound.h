/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a page: a file that browsers decode. */
#ifndef ADCGS_APPS_SHARE_SHARE_SOUND_H
#define ADCGS_APPS_SHARE_SHARE_SOUND_H

#include "apps/share/share_page.h"

/**
 * Loads the sound of a file or of a scene, whose bytes become the page's sound. A scene is a folder or a scene file; it also
 * determines when its sound begins. A scene without a sound gives none.
 */
adcgs_status adcgs_share_load_sound(adcgs_share_sound *sound, const char *path, adcgs_error *error);

#endif
