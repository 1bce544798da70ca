/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Storing and restoring the state of the rate. */
#include "config.h"

#include "train/rate/rate_state.h"

void adcgs_rate_state_walk(adcgs_checkpoint_walk *w, adcgs_rate_state *s)
{
    adcgs_checkpoint_visit(w, &s->contrast, sizeof s->contrast);
    adcgs_checkpoint_visit(w, &s->lambda, sizeof s->lambda);
    adcgs_checkpoint_visit(w, &s->control, sizeof s->control);
    adcgs_checkpoint_visit(w, s->mean_bits, sizeof s->mean_bits);
}

void adcgs_rate_state_walk_begin(adcgs_checkpoint_walk *w, adcgs_rate_state *s)
{
    uint64_t n = s->begin.size;
    adcgs_checkpoint_visit(w, &n, sizeof n);
    if (!w->in) {
        adcgs_checkpoint_visit(w, s->begin.data, n);
        return;
    }
    const uint8_t *from = w->failed || n > adcgs_reader_left(w->in) ? NULL : adcgs_read_bytes(w->in, n);
    w->failed |= !from;
    s->begin.size = 0;
    if (from)
        adcgs_write_bytes(&s->begin, from, n);
    w->failed |= s->begin.failed;
}

void adcgs_rate_state_clear(adcgs_rate_state *s)
{
    adcgs_buffer_clear(&s->begin);
}
