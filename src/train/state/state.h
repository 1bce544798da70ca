/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The state of a run, on which all stages of training work. Each stage has its own header; only stages.c calls them.
 */
#ifndef ADCGS_TRAIN_STATE_STATE_H
#define ADCGS_TRAIN_STATE_STATE_H

#include "bits/bytes.h"
#include "fmodel/pass.h"
#include "fmodel/rdo_input.h"
#include "fmodel/rigidity.h"
#include "fmodel/scale_penalty.h"
#include "fmodel/weight_average.h"
#include "grad/loss.h"
#include "init/stereo.h"
#include "train/exposure/exposure.h"
#include "train/rate/rate_state.h"
#include "train/state/decisions.h"
#include "train/state/run_state.h"
#include "train/state/stage_state.h"
#include "train/state/view_state.h"
#include "train/team/team.h"
#include "train/team/tree_sum.h"
#include "train/time_curriculum.h"
#include "train/trial/trial.h"

/** Sums since the last densification, per slot. */
typedef struct adcgs_train_stats {
    float *weight;       /* Psi */
    float *significance; /* Psi times screen gradient */
    float *opacity;
    float *presence; /* of each anchor, [groups][64] */
    float *in_view;  /* likewise, in views whose image contains one of its primitives */
    uint32_t n;      /* number of view passes */
} adcgs_train_stats;

/** Total size of the arrays, which are consecutive. */
size_t adcgs_train_stats_size(const adcgs_fmodel *f);
adcgs_train_stats adcgs_train_stats_at(float *numbers, const adcgs_fmodel *f);

/** Results of a view pass in addition to gradients and statistics. */
typedef struct adcgs_view_result {
    double loss, mse;
    double bits[ADCGS_GROUPS]; /* 0 if rate is not in the loss */
    adcgs_exposure_sums sums;  /* 0 if exposure is not updated */
} adcgs_view_result;

/** View passes of an iteration; see batch.h. */
typedef struct adcgs_train_batch {
    adcgs_view_result *results;   /* [config.batch] */
    float *sum[ADCGS_TREE_PARTS]; /* [size] gradients and statistics, if there are several passes */
    size_t size;
    float *means; /* means of the pass before the iteration */
    float *room;  /* receive buffer for a team */
} adcgs_train_batch;

/** Frees the sums and means after a change of their size. */
void adcgs_train_batch_forget(adcgs_train_batch *batch);

typedef struct adcgs_trainer {
    adcgs_train_config config;
    const adcgs_scene *scene;
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    const adcgs_team *team; /* runs that share the work; NULL: none */
    double origin[3], scale;
    adcgs_fmodel *f;
    /* Work of a view pass. */
    adcgs_pass *pass;
    adcgs_raster *raster;
    adcgs_raster_back *back;
    adcgs_loss *loss;
    float *image, *grad;
    float *taken; /* recorded image of the current view */
    adcgs_train_stats stats;
    adcgs_train_batch batch;
    /* Parts, each owned by its stage. */
    adcgs_run_state run;
    adcgs_stage_state stage;
    adcgs_rate_state rate;
    adcgs_view_state views;
    adcgs_rigidity rigid;
    adcgs_curriculum curriculum;
    adcgs_exposure exposure;
    adcgs_viewpoints viewpoints;
    adcgs_stereo stereo;
    adcgs_weight_average average;
    adcgs_decisions decisions;
    adcgs_train_quantise quantise;  /* provided by the code that builds streams; NULL: values stay unquantised */
    uint8_t before[16];             /* digest of the previous segment's model; 0 without one */
    char trials[ADCGS_TRIALS_TEXT]; /* results of trials before the run, for the stream; "" without trials */
} adcgs_trainer;

/** ADCGS_ERR_USAGE for a configuration that does not pass adcgs_train_check(). */
adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
/** The input of a run besides its scene and its configuration. Unknown members are 0. */
typedef struct adcgs_trainer_input {
    /** Model that the run continues, for a predicted segment; with the times of its part in seconds of the scene. */
    const adcgs_model *before;
    adcgs_stereo *matched;   /**< result of matching of another run over the scene; moved to trainer->stereo */
    const uint32_t *details; /**< details per image (adcgs_plan_details()); NULL: counted if needed */
    int judges_poses;        /**< 1: report pose errors */
} adcgs_trainer_input;

/** The same with more input, which the trainer does not use after the call. */
adcgs_status adcgs_trainer_create_from(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                       const adcgs_trainer_input *input, adcgs_cpu_level cpu, adcgs_pool *pool,
                                       adcgs_error *error);
void adcgs_trainer_free(adcgs_trainer **trainer);
/** Frees the loaded images and the image buffers. */
void adcgs_views_unload(adcgs_trainer *trainer);
/** After a change of the anchors: reallocates workspace and statistics. */
adcgs_status adcgs_trainer_resize(adcgs_trainer *trainer, adcgs_error *error);
/** Derives the form of the networks' parameters that passes use, rounded to the weight steps once weights are rounded. */
void adcgs_trainer_prepare_networks(adcgs_trainer *trainer);
/** Converts a time of the scene to the model's time, [0,1]. */
float adcgs_trainer_time(const adcgs_trainer *trainer, double seconds);
/** Progress of the run, in [0,1]. */
double adcgs_trainer_progress(const adcgs_trainer *trainer);

/** Loss per bit: lambda is the loss per mebibyte. */
static inline double adcgs_cost_of_bit(const adcgs_trainer *t)
{
    return t->rate.lambda * 0x1p-23;
}

#endif
