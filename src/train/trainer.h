/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training: one loop over posed pictures. The same seed gives the same model at
 * any thread count; a run can stop and go on exactly where it was.
 */
#ifndef ADCGS_TRAIN_TRAINER_H
#define ADCGS_TRAIN_TRAINER_H

#include "bits/bytes.h"
#include "data/pictures.h"
#include "fmodel/pass.h"
#include "fmodel/rdo.h"
#include "fmodel/rigidity.h"
#include "fmodel/scale_penalty.h"
#include "fmodel/weight_average.h"
#include "grad/loss.h"
#include "train/exposure.h"
#include "train/rate_control.h"
#include "train/schedule.h"
#include "train/time_curriculum.h"

/** What an observer is told. Bits are estimates until the stream is written. */
typedef struct adcgs_train_report {
    const char *stage;
    uint32_t iteration, iterations;
    uint32_t anchors;
    int divide;             /**< resolution in use, at the start the one to come: images are divided by this */
    double loss, psnr;      /**< running means over training views; none at iteration 0 */
    double bytes;           /**< estimated bytes of the features; 0 before rate is measured */
    double stream[ADCGS_GROUPS]; /**< the same of eta, f_v, Sigma_v, C_v (layer 0, but for its flags) and the chunks of f_g */
    double lambda;
    double seconds, rate;   /**< since the start; iterations per second lately */
    double left;            /**< seconds, estimated */
    int rollbacks;
} adcgs_train_report;

/** Called often; return nonzero to stop training (a checkpoint can then be saved). */
typedef int (*adcgs_train_observe)(void *user, const adcgs_train_report *report);

typedef struct adcgs_train_view {
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
    adcgs_rigid rigid;
    adcgs_window window;
    adcgs_exposure exposure;
    adcgs_viewpoints viewpoints;
    uint32_t n_views;
    adcgs_train_view *views;
    adcgs_pictures *pictures; /* of the training views */
    int divide;              /* of the views loaded; 0: none */
    uint64_t picture_memory; /* bytes of them at most; 0: half of the machine's */
    adcgs_pictures_progress loading; /* told of pictures loaded, or NULL */
    void *loading_user;
    float *image, *grad;
    float *taken;            /* the view's picture in use */
    adcgs_train_stats stats;
    adcgs_average average;
    adcgs_train_quantise quantise; /* provided by the room that builds streams; NULL: values stay as they are */
    adcgs_train_measure measure;   /* likewise; asked where there is a size to meet */
    void *measure_user;
    int until_lambda;        /* stop before the first iteration that lambda has a say in */
    /* State that a checkpoint carries beside the model. */
    uint32_t iteration, adam_steps;
    uint8_t lambda_used;     /* lambda has had a say: the run is bound to it */
    uint8_t weighed, slimmed, decided, rounding, frozen;
    float lr_scale;
    double lambda; /* of the rate; the configuration's unless a target steers it */
    adcgs_control control;
    uint32_t rollbacks;
    double mean_loss, mean_mse, elapsed;
    double mean_bits[ADCGS_GROUPS];
    adcgs_buffer snapshot;
} adcgs_trainer;

adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_trainer_free(adcgs_trainer **trainer);
/** Train to the end, or (*stopped = 1) until observe says stop or lambda would have a say. */
adcgs_status adcgs_trainer_run(adcgs_trainer *trainer, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error);

/**
 * Checkpoints: everything needed to go on with identical results; atomic file, versioned, checksummed. Loading one saved with
 * other options or another scene is ADCGS_ERR_DATA; only lambda may be another while it has had no say, so that runs at several
 * rates share their beginning, and without_lattice before weights are rounded, so that its price can be told.
 */
adcgs_status adcgs_trainer_save(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
adcgs_status adcgs_trainer_load(adcgs_trainer *trainer, const char *path, adcgs_error *error);
/** The same to and from memory (rollback). */
adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error);
adcgs_status adcgs_trainer_restore(adcgs_trainer *trainer, const uint8_t *data, size_t size, adcgs_error *error);

/**
 * A training view's picture as the mean camera would have taken it; valid until the next is asked for. drawn: the model's
 * picture of it, from which the camera's exposure is followed, or NULL.
 */
adcgs_status adcgs_trainer_target(adcgs_trainer *trainer, uint32_t view, const float *drawn, const float **target,
                                  adcgs_error *error);
/** (Re)load all training views with their size divided by an integer. */
adcgs_status adcgs_trainer_load_views(adcgs_trainer *trainer, int divide, adcgs_error *error);
/** Growth and pruning by temporal significance (paper section 3.5); progress in [0,1]. */
adcgs_status adcgs_trainer_refine(adcgs_trainer *trainer, double progress, adcgs_error *error);
/**
 * Whether motion is worth its bytes at all: if stopping time costs the pictures less than the deformation networks cost the
 * file, every anchor becomes static. Done when rate begins, so that the rest of the run makes up for what the networks had
 * taken over.
 */
adcgs_status adcgs_trainer_weigh(adcgs_trainer *trainer, adcgs_error *error);
/** Keep so many anchors (at least one): those that covered the most pixels since the anchors last changed. */
adcgs_status adcgs_trainer_prune(adcgs_trainer *trainer, uint32_t keep, adcgs_error *error);
/** Anchors that growth may have reached by then. */
double adcgs_trainer_budget(const adcgs_train_config *config, double progress);
/** Choose the lattices that weights are rounded to; from here on networks and values are seen rounded. */
adcgs_status adcgs_trainer_round(adcgs_trainer *trainer, adcgs_error *error);
/** Drop primitives that never matter and mark anchors that never move. */
adcgs_status adcgs_trainer_decide(adcgs_trainer *trainer, adcgs_error *error);
/**
 * Fix the anchors' values as the stream will hold them, by rate and distortion with the configured strength; from here on only
 * networks are trained. What the choice was made from stays in the trainer and its checkpoints, in place of the anchors' Adam
 * moments, which are spent: the values wanted in param[].m, the loss's curvature in param[].v.
 */
adcgs_status adcgs_trainer_freeze(adcgs_trainer *trainer, adcgs_error *error);
/** The prices of a frozen trainer at a strength: lambda_bit is the run's loss per bit times strength. ADCGS_ERR_USAGE before. */
adcgs_status adcgs_trainer_prices(const adcgs_trainer *trainer, double strength, adcgs_rdo *rdo, adcgs_error *error);
/**
 * Decide the values of a frozen trainer anew, from the same wishes, with another strength (0: the nearest levels). What
 * adcgs_encode_stream() writes after it has the bytes that adcgs_encode_bytes() gave for that strength, as long as no training
 * comes between.
 */
adcgs_status adcgs_trainer_choose(adcgs_trainer *trainer, double strength, adcgs_error *error);
/** Give each group of channels the density that codes its rounded values in the fewest bits, and take note of these. */
void adcgs_trainer_densities(adcgs_trainer *trainer);
/** Mean loss of up to `most` training views, spread evenly: each at its own time, or all at the middle of time. */
adcgs_status adcgs_trainer_sample_loss(adcgs_trainer *trainer, uint32_t most, int own_time, double *loss, adcgs_error *error);
/** After the anchors changed: workspace and statistics. */
adcgs_status adcgs_trainer_resize(adcgs_trainer *trainer, adcgs_error *error);

#endif
