/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One of the ranks of adcgs-enc (enc_ranks.h): what it says, and how it learns what it is given. */
#ifndef ADCGS_TOOLS_ENC_RANK_H
#define ADCGS_TOOLS_ENC_RANK_H

#include "tools/enc_run.h"

#include <pthread.h>

/** A rank is READY once, is told to LEARN, tells then how far it is (TOLD), and is free again with each DONE. */
enum { ADCGS_RANK_READY, ADCGS_RANK_LEARN, ADCGS_RANK_TOLD, ADCGS_RANK_DONE, ADCGS_RANK_DISMISS };

/** What ranks say to each other. */
typedef struct adcgs_rank_note {
    int32_t kind, level; /**< level: of the kernels */
    uint32_t segment, iteration, iterations;
    double rate, loss, psnr;
    adcgs_time spent;    /**< DONE: in learning this segment */
    char host[ADCGS_RANKS_HOST];
} adcgs_rank_note;

/** A note of this rank, without a segment. */
adcgs_rank_note adcgs_rank_say(int kind, const adcgs_enc_job *job);
/** Sleep for a moment, between two looks for notes. */
void adcgs_rank_nap(void);

/** The same failure as that of this rank; of a run that is not cut. */
adcgs_status adcgs_rank_fail(const adcgs_enc_job *job, adcgs_error *error);
/** For the ranks of a team but the first, of which nobody wants to hear. */
int adcgs_rank_hear_nothing(void *user, const adcgs_enc_watcher *watcher);
/** Learn what rank 0 hands out, or the first of the team, until rank 0 has nothing more. */
adcgs_status adcgs_rank_follow(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_error *error);

/** Rank 0's own learning, in a thread beside the one that hands out. What is below the lock is both threads'. */
typedef struct adcgs_rank_learner {
    adcgs_enc_watcher *w;
    const adcgs_enc_job *job;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    int asked, answered, ends;
    adcgs_rank_note last;
    adcgs_status status;
    adcgs_error error;
} adcgs_rank_learner;

/** w and job are set, all else is zero. */
adcgs_status adcgs_rank_start(adcgs_rank_learner *learner, adcgs_error *error);
/** Have it learn what a note says; it has nothing else to do. */
void adcgs_rank_give(adcgs_rank_learner *learner, const adcgs_rank_note *note);
/** What it would say: how far it is, or once that it is done. */
adcgs_status adcgs_rank_ask(adcgs_rank_learner *learner, adcgs_rank_note *note, int *is_done, adcgs_error *error);
/** Stop what it learns, whose state it saves, and end the thread. */
void adcgs_rank_end(adcgs_rank_learner *learner);

#endif
