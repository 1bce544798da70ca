/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One of the ranks of adcgs-enc (enc_ranks.h): its notes, and training of the segments that it receives. */
#ifndef ADCGS_SESSION_ENC_RANK_H
#define ADCGS_SESSION_ENC_RANK_H

#include "session/enc_run.h"

#include <pthread.h>

/** A rank sends READY once, receives LEARN, then sends its progress (TOLD), and is free again after each DONE. */
enum { ADCGS_RANK_READY, ADCGS_RANK_LEARN, ADCGS_RANK_TOLD, ADCGS_RANK_DONE, ADCGS_RANK_DISMISS };

/** A message between ranks. */
typedef struct adcgs_rank_note {
    int32_t kind, level; /**< level: of the kernels */
    uint32_t segment, iteration, iterations;
    double rate, loss, psnr;
    adcgs_time spent; /**< DONE: on training this segment */
    char host[ADCGS_RANKS_HOST];
} adcgs_rank_note;

/** Returns a note of this rank, without a segment. */
adcgs_rank_note adcgs_rank_say(int kind, const adcgs_enc_job *job);
/** Sleeps shortly between two checks for notes. */
void adcgs_rank_nap(void);

/** Returns the same failure with the rank's name, for a run that is not cut. */
adcgs_status adcgs_rank_fail(const adcgs_enc_job *job, adcgs_error *error);
/** For the ranks of a team except the first, which report nothing. */
int adcgs_rank_ignore_progress(void *user, const adcgs_enc_context *context);
/** Trains the segments from rank 0, or from the first rank of the team, until rank 0 has no more. */
adcgs_status adcgs_rank_follow(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_error *error);

/** Rank 0's own training, in a thread next to the one that hands out segments. Both threads use the members below the lock. */
typedef struct adcgs_rank_trainer {
    adcgs_enc_context *w;
    const adcgs_enc_job *job;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    int asked, answered, ends;
    adcgs_rank_note last;
    adcgs_status status;
    adcgs_error error;
} adcgs_rank_trainer;

/** w and job are set, all others zero. */
adcgs_status adcgs_rank_start(adcgs_rank_trainer *learner, adcgs_error *error);
/** Starts training of the note's segment; the learner has to be idle. */
void adcgs_rank_give(adcgs_rank_trainer *learner, const adcgs_rank_note *note);
/** Returns the learner's note: its progress, or once that it is done. */
adcgs_status adcgs_rank_ask(adcgs_rank_trainer *learner, adcgs_rank_note *note, int *is_done, adcgs_error *error);
/** Stops the training, which saves its state, and ends the thread. */
void adcgs_rank_end(adcgs_rank_trainer *learner);

#endif
