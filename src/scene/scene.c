/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes: names of splits, remarks, freeing. */
#include "config.h"

#include "scene/scene.h"

#include "scene/clips.h"
#include "scene/image_cache.h"
#include "scene/splat_views.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const split_names[ADCGS_SPLITS] = {"train", "val", "test"};

const char *adcgs_split_name(adcgs_split split)
{
    return split_names[split];
}

int adcgs_split_parse(const char *name, adcgs_split *split)
{
    for (int i = 0; i < ADCGS_SPLITS; i++)
        if (!strcmp(name, split_names[i])) {
            *split = (adcgs_split)i;
            return 0;
        }
    return -1;
}

void adcgs_scene_remark(adcgs_scene *scene, const char *format, ...)
{
    if (scene->n_remarks == ADCGS_REMARKS_MAX)
        return;
    char *text = scene->remarks[scene->n_remarks++];
    va_list arguments;
    va_start(arguments, format);
    const int n = snprintf(text, ADCGS_REMARK_BYTES, "%.200s: ", scene->directory);
    vsnprintf(text + n, ADCGS_REMARK_BYTES - (size_t)n, format, arguments);
    va_end(arguments);
}

void adcgs_scene_view_clear(adcgs_scene_view *view)
{
    free(view->path);
    free(view->mask);
    free(view->moving);
    view->path = view->mask = view->moving = NULL;
}

void adcgs_scene_free(adcgs_scene **scene)
{
    if (!*scene)
        return;
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        for (uint32_t i = 0; i < (*scene)->n_views[s]; i++)
            adcgs_scene_view_clear(&(*scene)->views[s][i]);
        free((*scene)->views[s]);
    }
    adcgs_points_free(&(*scene)->points);
    adcgs_splat_scene_free(&(*scene)->splats);
    adcgs_clips_free(&(*scene)->clips);
    adcgs_image_cache_free(&(*scene)->images);
    free((*scene)->directory);
    free((*scene)->sound);
    free(*scene);
    *scene = NULL;
}
