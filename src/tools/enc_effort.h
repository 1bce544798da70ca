/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How long a live segment is learnt. Without a delay that is to be held, as long as any run. With one, as many iterations as the
 * last segments' speed allows until the segment is due, and the clock as a guard; a few at least, even if they come too late.
 */
#ifndef ADCGS_TOOLS_ENC_EFFORT_H
#define ADCGS_TOOLS_ENC_EFFORT_H

#include "tools/enc_run.h"

typedef struct adcgs_enc_effort {
    double delay;     /**< seconds from when something is filmed to when it is written, at most; 0: no matter */
    uint32_t most;    /**< iterations of a segment */
    double rate;      /**< iterations per second lately; 0: not known */
    double overhead;  /**< seconds of a segment that are no iterations */
    uint32_t said;    /**< iterations that were told last; 0: none */
} adcgs_enc_effort;

/** Where there is a delay, matching takes less of it: settings of the job's configuration change. */
void adcgs_enc_effort_init(adcgs_enc_effort *effort, adcgs_enc_job *job);
/**
 * Set iterations and time limit, which counts from when training begins, of the job's configuration for segment `number`, which
 * takes so many seconds and came then.
 * Says so where effort is another than it was.
 */
void adcgs_enc_effort_choose(adcgs_enc_effort *effort, adcgs_enc_job *job, double came, double seconds, uint32_t number);
/** What a segment has shown: the reports after its first iteration and after its last, and how long it took in all. */
void adcgs_enc_effort_learn(adcgs_enc_effort *effort, const adcgs_train_report *first, const adcgs_train_report *last,
                            double seconds);

#endif
