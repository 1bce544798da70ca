/* SPDX-License-Identifier: BSD-2-Clause */
/** \file For tests that train: the tiny scene in a separate folder, three threads, and runs that stop at a given iteration. */
#ifndef ADCGS_TESTS_TINY_SCENE_H
#define ADCGS_TESTS_TINY_SCENE_H

#include "outside_files.h"

#include "encode/encode.h"
#include "scene/layouts/open.h"
#include "synthetic/scenes.h"
#include "train/settings.h"
#include "train/state/state.h"
#include "train/trainer.h"

static adcgs_scene *scene;
static adcgs_pool *pool;

static int open_scene(void **state)
{
    const adcgs_scenes_options scene_options = {.name = "tiny", .width = 32, .height = 32, .format = "ppm"};
    const adcgs_scene_options options = {.points_path = NULL};
    if (make_folder(state) != 0 || adcgs_pool_create(&pool, 3, &error) != ADCGS_OK)
        return -1;
    return adcgs_scenes_write(folder, &scene_options, NULL, NULL, NULL, &error) != ADCGS_OK ||
           adcgs_scene_open(&scene, folder, &options, &error) != ADCGS_OK;
}

static int close_scene(void **state)
{
    adcgs_scene_free(&scene);
    adcgs_pool_free(&pool);
    return remove_folder(state);
}

enum { ITERATIONS = 200 };

/** A run of a second or two that goes through every stage. */
static inline adcgs_train_config small_config(void)
{
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "draft", &error), ADCGS_OK);
    c.iterations = ITERATIONS;
    c.start_anchors = 100;
    c.max_anchors = 150;
    c.detail_anchors = 0;
    c.densify_interval = 20;
    c.params.spans = 0; /* tests of lifetimes enable them */
    c.matching_frames = 0;
    c.densify_threshold = 1e-6f;
    c.static_threshold = 0; /* motion becomes visible later than these runs end */
    c.params.k = 4;
    c.params.n_fv = 12;
    c.params.n_fg = 8; /* so that there are layers */
    c.shape.theta_width = c.shape.omega_width = c.shape.varpi_width = c.shape.entropy_width = 16;
    return c;
}

/** An observer that stops at the iteration that user points to. */
static inline int stop_at(void *user, const adcgs_train_report *r)
{
    return r->iteration >= *(const uint32_t *)user;
}

/** A run over the scene, whose values are rounded as in streams. */
static inline adcgs_trainer *make_trainer(const adcgs_train_config *config, adcgs_pool *threads)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create(&t, scene, config, adcgs_cpu_best(), threads, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    return t;
}

/** Runs to the end, or until the observer stops it. \return whether it was stopped. */
static inline int run_trainer(adcgs_trainer *t, adcgs_train_observe observe, void *user)
{
    int stopped;
    if (adcgs_trainer_run(t, observe, user, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return stopped;
}

/** The state of a run without its time. */
static inline void store(adcgs_trainer *t, adcgs_buffer *out)
{
    t->run.elapsed = (adcgs_time){0, 0};
    adcgs_buffer_init(out);
    assert_int_equal(adcgs_trainer_store(t, out, &error), ADCGS_OK);
}

#endif
