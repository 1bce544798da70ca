/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Totals of a live run. */
#ifndef ADCGS_SESSION_ENC_LIVE_SUM_H
#define ADCGS_SESSION_ENC_LIVE_SUM_H

#include "session/enc_run.h"

typedef struct adcgs_enc_live_sum {
    uint32_t n, keys, streams;
    uint32_t past;        /**< earlier segments of a continued stream */
    uint64_t bytes;       /**< earlier segments included */
    double begin, end;    /**< seconds of the scene */
    double delay, worst;  /**< seconds: sum over segments, and maximum */
    uint64_t iterations;  /**< sum */
    uint32_t least, most; /**< minimum and maximum of a segment */
} adcgs_enc_live_sum;

/** Adds a segment that was just written: its time range, and the arrival of its last image, by adcgs_seconds(). */
void adcgs_enc_live_sum_add(adcgs_enc_live_sum *sum, double begin, double end, double came, uint32_t iterations);
/** Prints text to stderr, or JSON to stdout with --json. */
adcgs_status adcgs_enc_live_sum_print(const adcgs_enc_live_sum *sum, const adcgs_enc_job *job, adcgs_error *error);

#endif
