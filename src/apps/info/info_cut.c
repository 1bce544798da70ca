/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reduces a stream. */
#include "apps/info/info_cut.h"

#include "system/atomic.h"

/** Returns the segment with the most tiers to drop, the last of several; NULL if there is none. */
static adcgs_model *next_to_cut(adcgs_stream *s)
{
    adcgs_model *found = NULL;
    for (uint32_t i = 0; i < s->n_segments; i++) {
        adcgs_model *m = &s->segments[i];
        const int tiers = m->finest - m->absent, needed = i + 1 < s->n_segments && m[1].predicted;
        if (tiers > 0 && !m->predicted && !needed && (!found || tiers >= found->finest - found->absent))
            found = m;
    }
    return found;
}

static adcgs_status drop_tier(adcgs_model *m, adcgs_error *error)
{
    adcgs_model coarser;
    const adcgs_status status = adcgs_model_coarser(&coarser, m, m->finest - m->absent, NULL, error);
    if (status != ADCGS_OK) {
        adcgs_model_clear(&coarser, NULL);
        return status;
    }
    adcgs_model_clear(m, NULL);
    *m = coarser;
    return ADCGS_OK;
}

static adcgs_status fit(adcgs_stream *s, uint64_t bytes, adcgs_buffer *out, adcgs_error *error)
{
    for (;;) {
        out->size = 0;
        s->level = 0; /* the lowest level that fits */
        ADCGS_TRY(adcgs_stream_write(s, out, error));
        adcgs_model *m = out->size > bytes ? next_to_cut(s) : NULL;
        if (out->size <= bytes)
            return ADCGS_OK;
        if (!m)
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "--bytes %llu: the stream has %zu bytes without its finer tiers: give a "
                              "larger --bytes",
                              (unsigned long long)bytes, out->size);
        ADCGS_TRY(drop_tier(m, error));
    }
}

adcgs_status adcgs_info_cut(adcgs_stream *stream, uint64_t bytes, const char *path, adcgs_error *error)
{
    adcgs_buffer out;
    adcgs_buffer_init(&out);
    adcgs_status status = fit(stream, bytes, &out, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(path, out.data, out.size, error);
    adcgs_buffer_clear(&out);
    return status;
}
