/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A run of adcgs-enc: its options, progress, log and notes, and training itself. */
#ifndef ADCGS_SESSION_ENC_RUN_H
#define ADCGS_SESSION_ENC_RUN_H

#include "cli/cli.h"
#include "encode/encode.h"
#include "net/ranks.h"
#include "session/enc_preview.h"
#include "session/enc_team.h"
#include "session/plan.h"

#define ADCGS_ENC_KEY_EVERY 10.0   /**< seconds from one key to the next, by default; chosen by hand, not measured */
#define ADCGS_ENC_FADE 0.2         /**< crossfade between segments, seconds, by default; measured on clip (doc/log/segments.md) */
#define ADCGS_ENC_LIVE_SEGMENT 2.0 /**< seconds of a live or planned segment, by default; chosen by hand, not measured */

/** As on the command line. */
typedef struct adcgs_enc_options {
    const char *scene, *output, *preset, *checkpoint, *resume, *finish, *log, *points, *set, *without, *beginning, *uncompressed;
    const char *preview, *frames, *fps, *plan;
    int splat_frames, has_splat_frames, is_partial; /**< see adcgs_scene_options */
    double lambda, psnr, time_limit, segment, key, fade, delay, cut;
    int iterations, scale, k, max_anchors, threads, cpu, dataset, bf16, json, quiet, no_progression, fixed, live, or_whole,
        schedule;
    int has_segment, has_key, has_lambda, has_size, has_psnr, has_iterations, has_scale, has_k, has_max_anchors, has_seed;
    int has_fade, has_delay, has_cut;
    adcgs_time started;
    double checkpoint_every;
    uint64_t seed, size, memory;
} adcgs_enc_options;

typedef struct adcgs_enc_context {
    const adcgs_enc_options *o;
    const char *target; /* the run's product: the stream, a part of it, or the state before lambda matters */
    int keeps;          /* it saves its state at intervals */
    adcgs_trainer *t;
    adcgs_enc_team team;        /* ranks that train with this one */
    uint32_t segment, segments; /* the segment in training, from 0; 0 segments: not cut, or number unknown */
    int is_live;                /* an interrupt ends the input, not the run */
    char *base;                 /* prefix of the run's temporary files: the checkpoint, and those of segments */
    char *state;                /* the current checkpoint */
    adcgs_progress progress;
    FILE *log;
    adcgs_train_report first; /* after the first iteration */
    double saved;
    adcgs_enc_preview preview;
    int interrupts; /* interrupts handled when training ended; further ones end the measurement */
    int unsaved;    /* the last checkpoint could not be written */
    int cut_short;  /* by interrupts: the file was made before the run's end */
    adcgs_train_report last;
    /* Receives the progress instead of the display; nonzero: stop. */
    int (*on_progress)(void *user, const struct adcgs_enc_context *w);
    void *progress_user;
    size_t uncompressed_bytes;
    char trials[ADCGS_TRIALS_TEXT]; /**< figures of the trials, for the stream; "" without trials */
    adcgs_buffer changes;           /**< settings that differ from the preset's, for the stream */
    uint32_t next_log;              /**< iteration */
    adcgs_error log_error;
    double begins;               /* time in the scene at which the trained part begins */
    adcgs_thumbnail *thumbnails; /* until the footage has been checked; NULL: no check */
    unsigned diagnosed;          /* kinds of faults of footage that were reported */
    int told_settings;           /* 1: the log has the line of settings of the run */
    int told_room;               /* 1: the space for images was reported; 2: also that it is not enough */
} adcgs_enc_context;

/** Notes in the stream on its making. */
typedef struct adcgs_enc_notes {
    adcgs_encode_note list[10]; /* with room for two of a plan's part */
    uint32_t n;
    char seed[32], lambda[32], iterations[32], decisions[ADCGS_DECISIONS_TEXT], follows[33];
    char trials[ADCGS_TRIALS_TEXT];
} adcgs_enc_notes;

/** The input of a run. */
typedef struct adcgs_enc_job {
    const adcgs_cli *cli;
    const adcgs_enc_options *o;
    adcgs_scene *scene;
    adcgs_cuts cuts;                     /* n 0: the scene is not cut */
    uint8_t *follows;                    /* [cuts.n] 1: the part is trained from the previous one */
    const adcgs_ranks *ranks;            /* that train the segments together; NULL: this process alone */
    const adcgs_plan *plan;              /* plan of the training; NULL: none */
    const adcgs_train_config *requested; /* by the command line or the plan */
    adcgs_train_config config;           /* resolved, as far as the facts are known (train/resolve.h) */
    adcgs_train_config whole;            /* of the scene as one segment, if it is cut */
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
} adcgs_enc_job;

/**
 * changes: settings that differ from the preset's, "" for none. The notes point into this struct, changes and the configuration.
 */
void adcgs_enc_make_notes(adcgs_enc_notes *n, const adcgs_trainer *t, const char *changes);

/** Makes the run's stream, initialised by the caller, and its bytes, which are read back once. */
adcgs_status adcgs_enc_encode(adcgs_stream *stream, adcgs_buffer *bytes, const adcgs_enc_context *w, adcgs_pool *pool,
                              adcgs_error *error);

/**
 * Trains a scene or a part of it, which continues the model `before` unless that is NULL. The caller then owns w->t. state: a
 * checkpoint to continue from, or to finish, or NULL. started: the time from which the run counts. otherwise: the model to
 * continue if one that begins anew had other parameters than this one, or NULL.
 */
adcgs_status adcgs_enc_train(adcgs_enc_context *w, const adcgs_enc_job *job, const adcgs_scene *scene, const adcgs_model *before,
                             const adcgs_model *otherwise, const char *state, adcgs_time started, adcgs_error *error);

/**
 * Evens out the light of the job's scene, if requested, and reports it. Call it when the scene is open and before it is cut,
 * since it reads images of the whole scene. progress: cleared before a message.
 */
adcgs_status adcgs_enc_compensate_light(const adcgs_enc_job *job, adcgs_progress *progress, adcgs_error *error);

/**
 * Sets the size of the images of the job's scene, once it is open, or of the first live segment: the requested size, or, by
 * default, at most the useful size. Reports a reduction. progress: cleared before that, or NULL.
 */
void adcgs_enc_reduce_large(adcgs_enc_job *job, adcgs_scene *scene, adcgs_progress *progress);

#endif
