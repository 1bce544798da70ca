/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training: one loop over posed pictures. The same seed gives the same model at
 * any thread count; a run can stop and go on exactly where it was.
 */
#ifndef ADCGS_TRAIN_TRAINER_H
#define ADCGS_TRAIN_TRAINER_H

#include "bits/bytes.h"
#include "data/scene.h"
#include "train/loss.h"
#include "train/pass.h"
#include "train/schedule.h"

/** What an observer is told. Bits are estimates until the stream is written. */
typedef struct adcgs_train_report {
    const char *stage;
    uint32_t iteration, iterations;
    uint32_t anchors;
    int divide;             /**< resolution in use: images are divided by this */
    double loss, psnr;      /**< running means over training views */
    double bytes;           /**< estimated bytes of the features; 0 before rate is measured */
    double seconds, rate;   /**< since the start; iterations per second lately */
    double left;            /**< seconds, estimated */
    int rollbacks;
} adcgs_train_report;

/** Called often; return nonzero to stop training (a checkpoint can then be saved). */
typedef int (*adcgs_train_observe)(void *user, const adcgs_train_report *report);

/**
 * Exact quantisation, provided by the room that builds streams. Writes the predicted means (1/64 step) into mu and, if value
 * is not NULL, the decoded values into value; both laid out like the parameters.
 */
typedef adcgs_status (*adcgs_train_quantise)(void *user, const adcgs_fmodel *f, float *const mu[ADCGS_P_ANCHOR],
                                             float *const value[ADCGS_P_ANCHOR], adcgs_error *error);

typedef struct adcgs_train_view {
    float *rgb;          /* planar target, NULL until loaded */
    adcgs_view view;
    float t;
} adcgs_train_view;

/** Sums since the last refinement, per slot. */
typedef struct adcgs_train_stats {
    float *weight;       /* Psi */
    float *significance; /* Psi times screen gradient */
    float *opacity;
    uint32_t n;          /* iterations summed */
} adcgs_train_stats;

typedef struct adcgs_trainer {
    adcgs_train_config config;
    const adcgs_scene *scene;
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    double origin[3], scale;
    adcgs_fmodel *f;
    adcgs_pass *pass;
    adcgs_raster *raster;
    adcgs_raster_back *back;
    adcgs_loss *loss;
    uint32_t n_views;
    adcgs_train_view *views;
    int divide;              /* of the views loaded; 0: none */
    float *image, *grad;
    adcgs_train_stats stats;
    adcgs_train_quantise quantise;
    void *quantise_user;
    /* State that a checkpoint carries beside the model. */
    uint32_t iteration, adam_steps;
    uint8_t weighed, decided, rounding, frozen;
    float lr_scale;
    uint32_t rollbacks;
    double mean_loss, mean_mse, mean_bits, elapsed;
    adcgs_buffer snapshot;
} adcgs_trainer;

adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_trainer_free(adcgs_trainer **trainer);
/** Train to the end, or until observe says stop (*stopped = 1). */
adcgs_status adcgs_trainer_run(adcgs_trainer *trainer, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error);

/** Checkpoints: everything needed to go on with identical results; atomic file, versioned, checksummed. */
adcgs_status adcgs_trainer_save(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
adcgs_status adcgs_trainer_load(adcgs_trainer *trainer, const char *path, adcgs_error *error);
/** The same to and from memory (rollback). */
adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error);
adcgs_status adcgs_trainer_restore(adcgs_trainer *trainer, const uint8_t *data, size_t size, adcgs_error *error);

/** Growth and pruning by temporal significance (paper section 3.5); progress in [0,1]. */
adcgs_status adcgs_trainer_refine(adcgs_trainer *trainer, double progress, adcgs_error *error);
/**
 * Whether motion is worth its bytes at all: if stopping time costs the pictures less than the deformation networks cost the
 * file, every anchor becomes static. Early, so that the rest of the run makes up for what the networks had taken over.
 */
adcgs_status adcgs_trainer_weigh(adcgs_trainer *trainer, adcgs_error *error);
/** Drop primitives that never matter and mark anchors that never move. */
adcgs_status adcgs_trainer_decide(adcgs_trainer *trainer, adcgs_error *error);
/** After the anchors changed: workspace and statistics. */
adcgs_status adcgs_trainer_resize(adcgs_trainer *trainer, adcgs_error *error);

#endif
