/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The poster of a page: rendered from the scene, or a file. */
#ifndef ADCGS_APPS_SHARE_SHARE_POSTER_H
#define ADCGS_APPS_SHARE_SHARE_POSTER_H

#include "apps/share/share_page.h"

#include <adcgs/types.h>

/** Renders the scene's first view as a small JPEG. */
adcgs_status adcgs_share_render_poster(adcgs_share_scene *scene, adcgs_decoder *decoder, adcgs_error *error);
/** Loads a JPEG or PNG, whose bytes become the poster. */
adcgs_status adcgs_share_load_poster(adcgs_share_scene *scene, const char *path, adcgs_error *error);

#endif
