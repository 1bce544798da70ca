/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A run of adcgs-enc: what it was asked for, what it shows, logs and notes, and learning itself. */
#ifndef ADCGS_TOOLS_ENC_RUN_H
#define ADCGS_TOOLS_ENC_RUN_H

#include "cli/cli.h"
#include "encode/encode.h"
#include "encode/plan.h"
#include "io/ranks.h"
#include "tools/enc_preview.h"
#include "tools/enc_team.h"

#define ADCGS_ENC_KEY_EVERY 10.0   /**< seconds from one key to the next, unless given */
#define ADCGS_ENC_FADE 0.2         /**< seconds in which a segment is faded into the one before, unless given */
#define ADCGS_ENC_LIVE_SEGMENT 2.0 /**< seconds of a segment of what is live, or planned, unless given */

/** As on the command line. */
typedef struct adcgs_enc_options {
    const char *scene, *output, *preset, *checkpoint, *resume, *finish, *log, *points, *set, *without, *beginning, *uncompressed;
    const char *preview, *frames, *fps, *plan;
    double lambda, psnr, time_limit, segment, key, fade, delay, cut;
    int iterations, scale, k, max_anchors, threads, cpu, dataset, bf16, json, quiet, no_progression, fixed, live, or_whole;
    int has_segment, has_key, has_lambda, has_size, has_psnr, has_iterations, has_scale, has_k, has_max_anchors, has_seed;
    int has_fade, has_delay, has_cut;
    adcgs_time started;
    double checkpoint_every;
    uint64_t seed, size, memory;
} adcgs_enc_options;

typedef struct adcgs_enc_watcher {
    const adcgs_enc_options *o;
    const char *target; /* what the run is for: the stream, a part of it, or the state before lambda matters */
    int keeps;    /* it saves its state now and then */
    adcgs_trainer *t;
    adcgs_enc_team team; /* ranks that learn with this one */
    uint32_t segment, segments; /* the one that is learnt, from 0; 0 segments: the scene is not cut, or nobody knows how many */
    int is_live; /* an interrupt ends what comes, not the run */
    char *base;   /* of what the run leaves while it lasts: the checkpoint, and where the scene is cut those of its segments */
    char *state;  /* the checkpoint at hand */
    adcgs_progress progress;
    FILE *log;
    adcgs_train_report first; /* after the first iteration */
    double saved;
    adcgs_enc_preview preview;
    int heard;   /* interrupts that were answered when training ended; more of them end the measurement */
    int unsaved; /* the last checkpoint could not be written */
    int cut_short; /* by interrupts: it was made a file of before its end */
    adcgs_train_report last;
    int (*hear)(void *user, const struct adcgs_enc_watcher *w); /* told how far it is, which is then not shown; nonzero: stop */
    void *hear_user;
    size_t uncompressed_bytes;
    char trials[ADCGS_TRIALS_TEXT]; /**< figures of the trials, for the stream to carry; "" without trials */
    adcgs_buffer changes; /**< settings that are not the preset's, for the stream to tell */
    uint32_t next_log; /**< iteration */
    adcgs_error log_error;
    double begins;    /* of what is learnt, in the scene */
    adcgs_glance *glances; /* until its footage has been looked at; NULL: nobody wants to know */
    unsigned doubted; /* kinds of doubts of footage that were told */
    int told_room;    /* 1: the room that images take was reported; 2: that it is not enough */
} adcgs_enc_watcher;

/** What the stream tells of how it was made. */
typedef struct adcgs_enc_notes {
    adcgs_encode_note list[10]; /* with room for two that a part of a plan has */
    uint32_t n;
    char seed[32], lambda[32], iterations[32], decisions[ADCGS_DECISIONS_TEXT], follows[33];
    char trials[ADCGS_TRIALS_TEXT];
} adcgs_enc_notes;

/** What a run is given. */
typedef struct adcgs_enc_job {
    const adcgs_cli *cli;
    const adcgs_enc_options *o;
    adcgs_scene *scene;
    adcgs_cuts cuts; /* n 0: the scene is not cut */
    uint8_t *follows; /* [cuts.n] 1: the part is learnt from the one before */
    const adcgs_ranks *ranks; /* that learn the segments together; NULL: this process alone */
    const adcgs_plan *plan; /* that the scene is learnt by; NULL: there is none */
    adcgs_train_config config;
    adcgs_train_config whole; /* of the scene as one segment, where it is cut */
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
} adcgs_enc_job;

/** "  1:05:00 left", or nothing where it is not known. */
const char *adcgs_enc_left(double seconds, char text[32]);
/** changes: settings that are not the preset's, "" for none. The notes point into this, changes and the configuration. */
void adcgs_enc_take_notes(adcgs_enc_notes *n, const adcgs_trainer *t, const char *changes);

/** The run's stream, initialised by the caller, and its bytes, read back once. */
adcgs_status adcgs_enc_encode(adcgs_stream *stream, adcgs_buffer *bytes, const adcgs_enc_watcher *w, adcgs_pool *pool,
                              adcgs_error *error);

/**
 * Learn a scene, or a part of it, which goes on with the model before unless that is NULL; w->t is the caller's then. state: a
 * checkpoint to go on from, or to be done with, or NULL. started: from which its time counts. otherwise: the model to go on with
 * where one that begins anew had other parameters than this one, or NULL.
 */
adcgs_status adcgs_enc_learn(adcgs_enc_watcher *w, const adcgs_enc_job *job, const adcgs_scene *scene, const adcgs_model *before,
                             const adcgs_model *otherwise, const char *state, adcgs_time started, adcgs_error *error);

/**
 * Of the job's scene, once it is open and before it is cut: its light is evened out where that was asked for, which is said.
 * Pictures of all of it are looked at. progress: cleared before anything is said.
 */
adcgs_status adcgs_enc_even_light(const adcgs_enc_job *job, adcgs_progress *progress, adcgs_error *error);

/**
 * Of the job's scene, once it is open, or what is live of it first: pictures are as large as they were asked to be; where nobody
 * asked, not larger than is of use, which is said. progress: cleared before that, or NULL.
 */
void adcgs_enc_reduce_large(adcgs_enc_job *job, adcgs_scene *scene, adcgs_progress *progress);

#endif
