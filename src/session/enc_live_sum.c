/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Totals of a live run. */
#include "config.h"

#include "session/enc_live_sum.h"

#include "system/json.h"
#include "system/text.h"

#include <math.h>

void adcgs_enc_live_sum_add(adcgs_enc_live_sum *s, double begin, double end, double came, uint32_t iterations)
{
    const double delay = end - begin + adcgs_seconds() - came;
    s->begin = s->n ? s->begin : begin;
    s->end = end;
    s->delay += delay;
    s->worst = fmax(s->worst, delay);
    s->iterations += iterations;
    s->least = s->n ? ADCGS_MIN(s->least, iterations) : iterations;
    s->most = ADCGS_MAX(s->most, iterations);
    s->n++;
}

static adcgs_status print_json(const adcgs_enc_live_sum *s, const adcgs_enc_options *o, adcgs_error *error)
{
    const double n = ADCGS_MAX(s->n, 1U);
    adcgs_json j;
    adcgs_json_init(&j);
    adcgs_json_open(&j, NULL, '{');
    adcgs_json_string(&j, "file", o->output);
    adcgs_json_int(&j, "bytes", (int64_t)s->bytes);
    adcgs_json_int(&j, "streams", s->streams);
    adcgs_json_int(&j, "segments", s->n);
    if (o->resume)
        adcgs_json_int(&j, "segments_before", s->past);
    adcgs_json_int(&j, "keys", s->keys);
    adcgs_json_real(&j, "seconds", s->end - s->begin);
    adcgs_json_real(&j, "mean_delay", s->delay / n);
    adcgs_json_real(&j, "worst_delay", s->worst);
    if (o->has_delay)
        adcgs_json_real(&j, "delay", o->delay);
    adcgs_json_real(&j, "mean_iterations", (double)s->iterations / n);
    adcgs_json_int(&j, "least_iterations", s->least);
    adcgs_json_int(&j, "most_iterations", s->most);
    adcgs_json_close(&j);
    return adcgs_json_write(&j, stdout, "standard output", error);
}

adcgs_status adcgs_enc_live_sum_print(const adcgs_enc_live_sum *s, const adcgs_enc_job *job, adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    if (o->json)
        return print_json(s, o, error);
    if (o->quiet)
        return ADCGS_OK;
    const double n = ADCGS_MAX(s->n, 1U);
    adcgs_text_show(stderr, strcmp(o->output, "-") ? o->output : "standard output");
    fprintf(stderr, ": %llu bytes; ", (unsigned long long)s->bytes);
    if (s->past)
        fprintf(stderr, "%u earlier segment%s unchanged, ", s->past, adcgs_s(s->past));
    fprintf(stderr, "%u segment%s of %g s together, %u of them keys\n", s->n, adcgs_s(s->n), s->end - s->begin, s->keys);
    fprintf(stderr, "delay %.2f s on average, %.2f s at most", s->delay / n, s->worst);
    if (o->has_delay)
        fprintf(stderr, ", %g s requested", o->delay);
    fprintf(stderr, "; %.0f iterations per segment, %u to %u\n", (double)s->iterations / n, s->least, s->most);
    return ADCGS_OK;
}
