/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Compares one segment for a scene with several. */
#include "session/enc_whole.h"

#include "metric/evaluate.h"
#include "session/enc_parts.h"
#include "system/interrupt.h"
#include "train/resolve.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>
#include <unistd.h>

#define AS_GOOD 0.05 /* dB; smaller differences are invisible; chosen by hand, not measured */

/** Ends at an interrupt: the parts stay, and the same command with --resume joins them. */
static adcgs_status heed(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    const int *const interrupts = user;
    (void)score;
    return adcgs_interrupts() == *interrupts ? ADCGS_OK
                                             : adcgs_fail(error, ADCGS_ERR_IO,
                                                          "interrupted during the comparison; "
                                                          "continue it with --resume");
}

/** Measures a stream's PSNR on the training views. */
static adcgs_status measure(double *psnr, const adcgs_buffer *bytes, const adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_evaluation result = {.n = 0};
    int interrupts = adcgs_interrupts();
    adcgs_config_init(&config, sizeof config);
    config.cpu = job->cpu;
    config.pool = job->pool;
    ADCGS_TRY(adcgs_open_memory(&decoder, bytes->data, bytes->size, &config, error));
    const adcgs_status status = adcgs_evaluate(&result, decoder, job->scene, ADCGS_SPLIT_TRAIN, 0, heed, &interrupts, error);
    adcgs_close(&decoder);
    *psnr = result.psnr;
    return status;
}

static adcgs_status learn_whole(adcgs_buffer *bytes, adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_enc_job whole = *job;
    whole.config = job->whole;
    adcgs_resolve_whole(&whole.config, job->cuts.n);
    free(w->state);
    w->state = NULL;
    w->segments = w->segment = w->next_log = 0;
    w->team.team.size = 0; /* other ranks are done */
    ADCGS_TRY(adcgs_enc_part_name(&w->state, w->base, job->cuts.n, 0, error));
    adcgs_status status = adcgs_enc_train(w, &whole, job->scene, NULL, NULL,
                                          job->o->resume && !access(w->state, F_OK) ? w->state : NULL, adcgs_time_now(), error);
    adcgs_stream stream;
    adcgs_stream_init(&stream);
    if (status == ADCGS_OK)
        status = adcgs_enc_encode(&stream, bytes, w, job->pool, error);
    adcgs_stream_clear(&stream, NULL);
    adcgs_trainer_free(&w->t);
    return status;
}

adcgs_status adcgs_enc_try_whole(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_buffer *bytes, adcgs_time *spent,
                                 adcgs_error *error)
{
    adcgs_buffer whole;
    double with_parts = 0, with_one = 0;
    adcgs_buffer_init(&whole);
    adcgs_status status = learn_whole(&whole, w, job, error);
    *spent = adcgs_time_plus(*spent, w->last.spent);
    if (status == ADCGS_OK)
        status = measure(&with_parts, bytes, job, error);
    if (status == ADCGS_OK)
        status = measure(&with_one, &whole, job, error);
    const int takes = whole.size <= bytes->size && with_one > with_parts - AS_GOOD;
    if (status == ADCGS_OK)
        adcgs_cli_note(job->cli, "%u segments: %zu bytes, %.2f dB; one: %zu bytes, %.2f dB: %s", job->cuts.n, bytes->size,
                       with_parts, whole.size, with_one, takes ? "one is written" : "the segments are written");
    if (status == ADCGS_OK && takes) {
        const adcgs_buffer parts = *bytes;
        *bytes = whole;
        whole = parts;
    }
    adcgs_buffer_clear(&whole);
    return status;
}
