/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The poster of a page: rendered from the scene, or a file. */
#ifndef ADCGS_TOOLS_SHARE_POSTER_H
#define ADCGS_TOOLS_SHARE_POSTER_H

#include "tools/share_page.h"

#include <adcgs/types.h>

/** The index of the stored camera with this name or number, as for adcgs-dec. */
adcgs_status adcgs_share_find_camera(int *index, const adcgs_decoder *decoder, const char *wanted, adcgs_error *error);
/** Renders the scene's first view as a small JPEG. */
adcgs_status adcgs_share_render_poster(adcgs_share_scene *scene, adcgs_decoder *decoder, adcgs_error *error);
/** Loads a JPEG or PNG, whose bytes become the poster. */
adcgs_status adcgs_share_load_poster(adcgs_share_scene *scene, const char *path, adcgs_error *error);

#endif
