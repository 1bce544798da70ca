/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats to render at a time: the segment that serves the time, the segment that is crossfaded with it, their splats. */
#include "api/segment_at.h"

#include "api/decoder_priv.h"

#include "base/strict.h"

/** The first available segment: earlier ones were freed or missed. */
static uint32_t first_segment(const adcgs_decoder *d)
{
    return d->seek ? 0 : d->stream.first_segment;
}

/** One more than the number of the last available segment. */
static uint32_t end_segment(const adcgs_decoder *d)
{
    return d->seek ? adcgs_seek_segments(d->seek) : d->stream.first_segment + d->stream.n_segments + (d->unfinished.n > 0);
}

/** For a decoder that does not seek: a complete segment, or the one being received. */
static const adcgs_model *model_of(const adcgs_decoder *d, uint32_t segment)
{
    const uint32_t index = segment - d->stream.first_segment;
    return index < d->stream.n_segments ? &d->stream.segments[index] : &d->unfinished;
}

static double start_of(const adcgs_decoder *d, uint32_t segment)
{
    int64_t ticks[3];
    if (!d->seek)
        return model_of(d, segment)->time_start;
    adcgs_seek_times(d->seek, segment, ticks);
    return adcgs_ticks_to_seconds(&d->stream, ticks[0]);
}

/** End of the time range of a segment's model, with its crossfade. */
static double reach_of(const adcgs_decoder *d, uint32_t segment)
{
    int64_t ticks[3];
    if (!d->seek)
        return model_of(d, segment)->time_end + model_of(d, segment)->reach;
    adcgs_seek_times(d->seek, segment, ticks);
    return adcgs_ticks_to_seconds(&d->stream, ticks[1]) + adcgs_ticks_to_seconds(&d->stream, ticks[2]);
}

/** The last segment that starts at or before the time; the first segment if none does. */
static uint32_t segment_at(const adcgs_decoder *d, double time)
{
    uint32_t lo = first_segment(d), hi = end_segment(d);
    while (hi - lo > 1) {
        const uint32_t middle = lo + (hi - lo) / 2;
        if (start_of(d, middle) <= time)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

/** Whether the time is in the crossfade of the previous segment into this one. */
static int fades(const adcgs_decoder *d, uint32_t segment, double time)
{
    return segment > first_segment(d) && time < reach_of(d, segment - 1);
}

static void forget_drawn(adcgs_decoder *d, adcgs_drawn *drawn)
{
    adcgs_splat_free(&drawn->splat);
    adcgs_model_clear(&drawn->coarser, &d->memory);
}

void adcgs_decoder_forget_drawn(adcgs_decoder *d)
{
    forget_drawn(d, &d->drawn[0]);
    forget_drawn(d, &d->drawn[1]);
}

/** A segment's model if it is in memory; NULL if a seeking decoder must read it first. */
static const adcgs_model *model_at_hand(const adcgs_decoder *d, uint32_t segment)
{
    return d->seek ? adcgs_seek_at_hand(d->seek, segment) : model_of(d, segment);
}

/** Bring a segment's model into memory; if before is nonzero, also the model of the segment before it. */
static adcgs_status fetch(adcgs_decoder *d, uint32_t segment, int before, adcgs_error *error)
{
    if (model_at_hand(d, segment) && (!before || model_at_hand(d, segment - 1)))
        return ADCGS_OK;
    adcgs_decoder_forget_drawn(d);
    return adcgs_seek_to(d->seek, segment, before, error);
}

/** Update the model of the segment being received if more of it has come. */
static adcgs_status catch_up(adcgs_decoder *d, adcgs_error *error)
{
    int drawable;
    if (!d->is_behind)
        return ADCGS_OK;
    adcgs_decoder_forget_drawn(d); /* they refer to models that are freed or were moved */
    adcgs_model_clear(&d->unfinished, &d->memory);
    const adcgs_status status = adcgs_push_peek(d->push, &d->unfinished, &drawable, error);
    d->is_behind = status != ADCGS_OK; /* after a failure, the next call tries again */
    if (status != ADCGS_OK)
        adcgs_model_clear(&d->unfinished, &d->memory);
    return status;
}

/** Splats of a segment's model, or of its requested tiers. */
static adcgs_status make_splat(adcgs_decoder *d, adcgs_drawn *drawn, const adcgs_model *model, adcgs_error *error)
{
    if (d->tiers && d->tiers < model->finest + 1 - model->absent) {
        ADCGS_TRY(adcgs_model_coarser(&drawn->coarser, model, d->tiers, &d->memory, error));
        model = &drawn->coarser;
    }
    return adcgs_splat_create(&drawn->splat, model, d->cpu, d->pool, &d->memory, error);
}

/** Splats at a time, of a segment whose model is in memory. */
static adcgs_status primitives_of(adcgs_decoder *d, uint32_t segment, double time, adcgs_primitives *out, adcgs_error *error)
{
    const adcgs_model *const model = model_at_hand(d, segment);
    adcgs_drawn *const drawn = &d->drawn[segment % 2];
    adcgs_status status = ADCGS_OK;
    if (!drawn->splat || drawn->segment != segment) {
        forget_drawn(d, drawn);
        drawn->segment = segment;
        status = make_splat(d, drawn, model, error);
    }
    if (status == ADCGS_OK)
        status = adcgs_splat_at(drawn->splat, adcgs_splat_time(model, time), out, error);
    if (status != ADCGS_OK)
        forget_drawn(d, drawn);
    return status;
}

adcgs_status adcgs_set_tiers(adcgs_decoder *decoder, int tiers, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    if (tiers < 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d tiers requested, expected 0 or more", tiers);
    if (tiers != decoder->tiers)
        adcgs_decoder_forget_drawn(decoder);
    decoder->tiers = tiers;
    return ADCGS_OK;
}

/** Find the segment that serves a time, and whether the time is in its crossfade. Splats not needed at that time are freed. */
static adcgs_status find_segment(adcgs_decoder *d, double time, uint32_t *segment, int *is_fade, adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_modes(error)); /* the caller may have changed them since */
    ADCGS_TRY(catch_up(d, error));
    if (end_segment(d) == first_segment(d))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "decoder: no segment that can be rendered has arrived yet");
    *segment = segment_at(d, time);
    *is_fade = fades(d, *segment, time);
    if (!*is_fade)
        forget_drawn(d, &d->drawn[(*segment + 1) % 2]);
    return ADCGS_OK;
}

/** Bring the segment that serves a time into memory; if blends is nonzero, also the segment that is crossfaded with it. */
static adcgs_status bring(adcgs_decoder *d, double time, int blends, uint32_t *segment, int *is_fade, adcgs_error *error)
{
    ADCGS_TRY(find_segment(d, time, segment, is_fade, error));
    ADCGS_TRY(fetch(d, *segment, blends && *is_fade, error));
    if (segment_at(d, time) == *segment && fades(d, *segment, time) == *is_fade)
        return ADCGS_OK;
    /* The segment showed that the index is wrong, which happens only once: from now on, times come from the segments. */
    ADCGS_TRY(find_segment(d, time, segment, is_fade, error));
    return fetch(d, *segment, blends && *is_fade, error);
}

adcgs_status adcgs_decoder_state_at(adcgs_decoder *d, double time, adcgs_render_state *out, adcgs_error *error)
{
    uint32_t segment;
    ADCGS_TRY(bring(d, time, 1, &segment, &out->fades, error));
    ADCGS_TRY(primitives_of(d, segment, time, &out->now, error));
    if (!out->fades)
        return ADCGS_OK;
    const double start = start_of(d, segment);
    out->weight = (float)((time - start) / (reach_of(d, segment - 1) - start));
    return primitives_of(d, segment - 1, time, &out->before, error);
}

adcgs_status adcgs_decoder_primitives(adcgs_decoder *d, double time, uint32_t *segment, adcgs_primitives *out, adcgs_error *error)
{
    int is_fade;
    ADCGS_TRY(bring(d, time, 0, segment, &is_fade, error));
    return primitives_of(d, *segment, time, out, error);
}

adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out, adcgs_error *error)
{
    uint32_t segment;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(out, error);
    return adcgs_decoder_primitives(decoder, time, &segment, out, error);
}

adcgs_status adcgs_get_splat_digest(adcgs_decoder *decoder, double time, uint8_t digest[16], adcgs_error *error)
{
    adcgs_primitives primitives;
    uint32_t segment;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(digest, error);
    ADCGS_TRY(adcgs_decoder_primitives(decoder, time, &segment, &primitives, error));
    const adcgs_model *const coarser = &decoder->drawn[segment % 2].coarser;
    adcgs_splat_digest(coarser->n ? coarser : model_at_hand(decoder, segment), &primitives, digest);
    return ADCGS_OK;
}

adcgs_status adcgs_get_model_digest(adcgs_decoder *decoder, int segment, uint8_t digest[16], adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(digest, error);
    ADCGS_TRY(catch_up(decoder, error));
    const uint32_t first = first_segment(decoder), end = end_segment(decoder);
    if (segment < 0 || (uint32_t)segment >= end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "segment %d requested; the stream has %u", segment, (unsigned)end);
    if ((uint32_t)segment < first)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "segment %d requested; segments before %u are not available", segment,
                          (unsigned)first);
    ADCGS_TRY(fetch(decoder, (uint32_t)segment, 0, error));
    adcgs_model_digest(model_at_hand(decoder, (uint32_t)segment), digest);
    return ADCGS_OK;
}
