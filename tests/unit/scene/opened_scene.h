/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene that a test of layouts has open, if any, in its separate folder. */
#ifndef ADCGS_TESTS_OPENED_SCENE_H
#define ADCGS_TESTS_OPENED_SCENE_H

#include "outside_files.h"

#include "scene/layouts/open.h"

static adcgs_scene *scene;

static inline void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** A teardown: closes the scene and empties the folder. */
static inline int clean(void **state)
{
    adcgs_scene_free(&scene);
    return remove_folder(state) || mkdir(folder, 0777);
}

#endif
