/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training effort of a live segment. Without a required delay, it is that of any run. With one, it is as many iterations as the
 * speed of the last segments allows until the segment is due, with a time limit as a guard. A minimum of iterations is kept, even
 * if they come too late.
 */
#ifndef ADCGS_SESSION_ENC_EFFORT_H
#define ADCGS_SESSION_ENC_EFFORT_H

#include "session/enc_run.h"

typedef struct adcgs_enc_effort {
    double delay;    /**< maximum seconds from filming to writing; 0: no limit */
    uint32_t most;   /**< maximum iterations of a segment */
    double rate;     /**< recent iterations per second; 0: unknown */
    double overhead; /**< seconds of a segment outside of iterations */
    uint32_t said;   /**< iterations reported last; 0: none */
} adcgs_enc_effort;

/** With a delay, changes settings of the job's configuration so that matching takes less time. */
void adcgs_enc_effort_init(adcgs_enc_effort *effort, adcgs_enc_job *job);
/**
 * Sets iterations and time limit in the job's configuration for segment `number`, of `seconds` seconds, which arrived at `came`.
 * The time limit counts from the beginning of training. Reports a change of effort.
 */
void adcgs_enc_effort_choose(adcgs_enc_effort *effort, adcgs_enc_job *job, double came, double seconds, uint32_t number);
/** Updates the speed from a segment: the reports after its first and its last iteration, and its total time. */
void adcgs_enc_effort_train(adcgs_enc_effort *effort, const adcgs_train_report *first, const adcgs_train_report *last,
                            double seconds);

#endif
