/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes of transforms: one file, or one file for each split, which have to agree. */
#include "config.h"

#include "scene/layouts/transforms_splits.h"

#include "scene/layouts/transforms.h"
#include "scene/layouts/transforms_check.h"
#include "system/paths.h"

#include <stdlib.h>

/** Takes a file's values other than its views. */
static void take_facts(adcgs_scene *scene, adcgs_transforms *facts, char **points_path)
{
    if (!scene->rate.den)
        scene->rate = facts->rate;
    if (!*points_path)
        *points_path = facts->points_path;
    else
        free(facts->points_path);
}

/** The rate of any file applies to all of them. */
static adcgs_status agree_rate(adcgs_fps *rate, adcgs_fps own, const char *path, adcgs_error *error)
{
    if (rate->den && own.den && (rate->num != own.num || rate->den != own.den))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: fps: %g, but %g in the file of another split", path, adcgs_fps_value(own),
                          adcgs_fps_value(*rate));
    *rate = own.den ? own : *rate;
    return ADCGS_OK;
}

/** Reads one file per split; only the training split must exist. */
static adcgs_status read_splits(adcgs_scene *scene, char **points_path, adcgs_error *error)
{
    adcgs_transforms train = {.has_times = 0};
    adcgs_fps rate = {0, 0};
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        char *path = adcgs_path("%s/transforms_%s.json", scene->directory, adcgs_split_name((adcgs_split)s));
        adcgs_transforms facts = {0};
        adcgs_status status = path ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
        if (adcgs_is_there(path)) {
            status = adcgs_transforms_read(scene, &facts, path, (adcgs_split)s, error);
            if (status == ADCGS_OK && s == ADCGS_SPLIT_TRAIN) {
                take_facts(scene, &facts, points_path);
                train = facts;
            } else
                free(facts.points_path); /* only the training split decides */
            if (status == ADCGS_OK && train.has_times != facts.has_times)
                status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: frames[0].time: %s, unlike in the training split", path,
                                    train.has_times ? "missing" : "given");
            if (status == ADCGS_OK)
                status = agree_rate(&rate, facts.rate, path, error);
        }
        free(path);
        ADCGS_TRY(status);
    }
    if (!scene->rate.den)
        scene->rate = rate;
    return adcgs_transforms_check(scene, &train, 0, scene->directory, error);
}

adcgs_status adcgs_transforms_read_single(adcgs_scene *scene, const char *path, char **points_path, adcgs_error *error)
{
    adcgs_transforms facts;
    ADCGS_TRY(adcgs_transforms_read(scene, &facts, path, ADCGS_SPLITS, error));
    take_facts(scene, &facts, points_path);
    if (!scene->n_views[ADCGS_SPLIT_TRAIN])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: frames: no frame is left for training", path);
    return adcgs_transforms_check(scene, &facts, 1, path, error);
}

adcgs_status adcgs_transforms_read_folder(adcgs_scene *scene, char **points_path, adcgs_error *error)
{
    char *train = adcgs_path("%s/transforms_train.json", scene->directory);
    char *single = adcgs_path("%s/transforms.json", scene->directory);
    adcgs_status status = ADCGS_ERR_MEMORY;
    if (!train || !single)
        adcgs_fail(error, status, "%s: out of memory", scene->directory);
    else
        status = adcgs_is_there(train) ? read_splits(scene, points_path, error)
                                       : adcgs_transforms_read_single(scene, single, points_path, error);
    free(train);
    free(single);
    return status;
}

int adcgs_is_transforms(const char *folder)
{
    return adcgs_is_there_at("%s/transforms_train.json", folder) || adcgs_is_there_at("%s/transforms.json", folder);
}
