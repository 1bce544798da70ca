/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The state of a run: all that the stages of training work on. Each stage has a header of its own; stages.c alone calls them.
 */
#ifndef ADCGS_TRAIN_STATE_H
#define ADCGS_TRAIN_STATE_H

#include "bits/bytes.h"
#include "data/faults.h"
#include "data/pictures.h"
#include "fmodel/pass.h"
#include "fmodel/rdo.h"
#include "fmodel/rigidity.h"
#include "fmodel/scale_penalty.h"
#include "fmodel/weight_average.h"
#include "grad/distortion.h"
#include "grad/loss.h"
#include "stereo/stereo.h"
#include "train/decisions.h"
#include "train/exposure.h"
#include "train/rate_state.h"
#include "train/schedule.h"
#include "train/team.h"
#include "train/time_curriculum.h"
#include "train/time_left.h"
#include "train/tree_sum.h"
#include "train/trial.h"

typedef struct adcgs_train_view {
    adcgs_view view;
    float t;
} adcgs_train_view;

/** Sums since the last densification, per slot. */
typedef struct adcgs_train_stats {
    float *weight;       /* Psi */
    float *significance; /* Psi times screen gradient */
    float *opacity;
    float *presence;     /* of each anchor, [groups][64] */
    float *in_view;      /* likewise, in views whose image contains one of its primitives */
    uint32_t n;          /* looks summed */
} adcgs_train_stats;

/** Where they lie, one behind the other, and how many numbers they are. */
size_t adcgs_train_stats_size(const adcgs_fmodel *f);
adcgs_train_stats adcgs_train_stats_at(float *numbers, const adcgs_fmodel *f);

/** What a look says beside gradients and statistics. */
typedef struct adcgs_seen {
    double loss, mse;
    double bits[ADCGS_GROUPS]; /* 0 where they have no price */
    adcgs_exposure_sums sums;  /* 0 where exposure is not followed */
} adcgs_seen;

/** Of the looks of an iteration; see batch.h. */
typedef struct adcgs_train_batch {
    adcgs_seen *seen;               /* [config.batch] */
    float *sum[ADCGS_TREE_PARTS];   /* [size] gradients and statistics, where there are several looks */
    size_t size;
    float *means;                   /* of the pass, as they were before */
    float *room;                    /* for what comes from a team */
} adcgs_train_batch;

/** Sums and means have another size now. */
void adcgs_train_batch_forget(adcgs_train_batch *batch);

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
    adcgs_rigidity rigid;
    adcgs_distortion distortion;
    adcgs_curriculum curriculum;
    adcgs_exposure exposure;
    adcgs_viewpoints viewpoints;
    adcgs_stereo stereo;
    uint32_t n_views;
    adcgs_train_view *views;
    adcgs_pictures *pictures; /* of the training views */
    int divide;              /* of the views loaded; 0: none */
    uint64_t picture_memory; /* bytes of them at most; 0: half of the machine's */
    adcgs_pictures_progress loading; /* told of pictures loaded, or NULL */
    void *loading_user;
    adcgs_glance *glances;   /* [n_views] taken of pictures that are loaded, whoever asks keeps them; NULL: nobody does */
    adcgs_fault doubled;     /* pictures that come twice, where they were looked for */
    float *image, *grad;
    float *taken;            /* the view's picture in use */
    adcgs_train_stats stats;
    adcgs_train_batch batch;
    adcgs_weight_average average;
    adcgs_train_quantise quantise; /* provided by the room that builds streams; NULL: values stay as they are */
    adcgs_train_measure measure;   /* likewise; asked where there is a size to meet */
    void *measure_user;
    const adcgs_team *team;        /* with whom the run is shared; NULL: with nobody */
    int until_lambda;        /* stop before the first iteration that lambda has a say in */
    /* State that a checkpoint carries beside the model. */
    uint32_t iteration;
    uint8_t lambda_used;     /* lambda has had a say: the run is bound to it */
    uint8_t rested, weighed, slimmed, decided, tiered, rounding, frozen;
    uint8_t released; /* times that it was asked which settled anchors should learn */
    uint8_t before[16]; /* digest of the model that this one goes on with; 0 without one */
    float lr_scale;
    double contrast; /* of the pictures that training began with; 0: not known yet */
    double lambda; /* of the rate; the configuration's unless a target steers it, or contrast */
    adcgs_rate_control rate_control;
    uint32_t rollbacks;
    int diverged;            /* the run ended after too many rollbacks */
    double mean_loss, mean_mse;
    double least_mse; /* the least that mean_mse has been; 0 before the first iteration */
    adcgs_time elapsed; /* of all programs that have had a part in the run */
    double mean_bits[ADCGS_GROUPS];
    adcgs_decisions decisions;
    char trials[ADCGS_TRIALS_TEXT]; /* figures of the trials before the run, for its stream to carry; "" without trials */
    /* No checkpoint has these. */
    adcgs_time started;      /* from which this program's time counts; clock 0: when the run begins, or goes on */
    adcgs_time_left left;
    uint8_t content[16];     /* of the training pictures' files; see adcgs_scene_content() */
    int has_content;         /* it is known: they are read when a file needs it, once */
    adcgs_buffer snapshot;
    uint32_t snapshot_at;    /* its iteration */
    int torn;                /* the state is being changed in several steps: only the snapshot is whole */
    adcgs_buffer begin;      /* a checkpoint has it: the run where rate began, while it may go back there; see rate_search.h */
} adcgs_trainer;

/** ADCGS_ERR_USAGE for a configuration that does not pass adcgs_train_check(). */
adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
/**
 * The same for a part of a scene whose model goes on with that of the part before, as a predicted segment will. before has the
 * times of its part, in seconds of the scene; it has not to outlive the call. NULL: there is none.
 */
adcgs_status adcgs_trainer_create_after(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                        const adcgs_model *before, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
/** The same with the matching result of another run over the scene. It is taken over, and may be taken back: trainer->stereo. */
adcgs_status adcgs_trainer_create_matched(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                          adcgs_stereo *matched, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_trainer_free(adcgs_trainer **trainer);
/** Forget the pictures that are loaded, and the room to draw them. */
void adcgs_views_unload(adcgs_trainer *trainer);
/** After the anchors changed: workspace and statistics. */
adcgs_status adcgs_trainer_resize(adcgs_trainer *trainer, adcgs_error *error);
/** Derive from the networks' parameters what passes use, rounded to the weights' steps once weights are. */
void adcgs_trainer_prepare_networks(adcgs_trainer *trainer);
/** A time of the scene in the model's, [0,1]. */
float adcgs_trainer_time(const adcgs_trainer *trainer, double seconds);
/** How far the run is, in [0,1]. */
double adcgs_trainer_progress(const adcgs_trainer *trainer);

/** What a bit costs in terms of the loss: lambda is the price of a mebibyte. */
static inline double adcgs_price_of_bit(const adcgs_trainer *t)
{
    return t->lambda * 0x1p-23;
}

#endif
