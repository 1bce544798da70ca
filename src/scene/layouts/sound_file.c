/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a scene. */
#include "config.h"

#include "scene/layouts/sound_file.h"

#include "scene/layouts/open.h"
#include "system/extension.h"
#include "system/paths.h"

#include <stdlib.h>
#include <strings.h>

adcgs_status adcgs_sound_file_find(char **file, double *begin, const char *path, adcgs_error *error)
{
    adcgs_scene *scene;
    *begin = 0;
    if (!adcgs_is_folder(path) && strcasecmp(adcgs_extension(path), "json")) {
        *file = strdup(path);
        return *file ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    }
    *file = NULL;
    ADCGS_TRY(adcgs_scene_open(&scene, path, &(adcgs_scene_options){.is_outline = 1}, error));
    *begin = scene->sound_begin;
    *file = scene->sound;
    scene->sound = NULL;
    adcgs_scene_free(&scene);
    return ADCGS_OK;
}
