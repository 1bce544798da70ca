/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a live run has come to. */
#ifndef ADCGS_TOOLS_ENC_LIVE_SUM_H
#define ADCGS_TOOLS_ENC_LIVE_SUM_H

#include "tools/enc_run.h"

typedef struct adcgs_enc_live_sum {
    uint32_t n, keys, streams;
    uint32_t past;               /**< segments before those, of a stream that went on */
    uint64_t bytes;              /**< theirs, too */
    double begin, end;           /**< seconds of the scene */
    double delay, worst;         /**< seconds: the sum over segments, and the most */
    uint64_t iterations;         /**< likewise the sum */
    uint32_t least, most;        /**< iterations of a segment */
} adcgs_enc_live_sum;

/** A segment that was written now: what it spans, and when its last picture came, by adcgs_seconds(). */
void adcgs_enc_live_sum_add(adcgs_enc_live_sum *sum, double begin, double end, double came, uint32_t iterations);
/** As text on stderr, or with --json on stdout. */
adcgs_status adcgs_enc_live_sum_print(const adcgs_enc_live_sum *sum, const adcgs_enc_job *job, adcgs_error *error);

#endif
