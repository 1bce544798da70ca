/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder: opened, asked for splats at a time, closed. */
#include "api/decoder_priv.h"

#include "base/cpu.h"
#include "base/strict.h"
#include "net/net.h"

static adcgs_status check_config(const adcgs_config *config, adcgs_error *error)
{
    if (!config->pool && (config->threads < 0 || config->threads > ADCGS_THREADS_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: threads is %d, expected 0..%d", config->threads, ADCGS_THREADS_MAX);
    if (config->layers < 0 || config->layers > ADCGS_LAYERS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: layers is %d, expected 0..%d", config->layers, ADCGS_LAYERS);
    return ADCGS_OK;
}

static void say_opened(const adcgs_decoder *d)
{
    adcgs_log_say(&d->log, ADCGS_LOG_INFO,
                  "stream: level %d, %u segments, %llu bytes; CPU level %s, %d threads, %llu bytes of memory", d->stream.level,
                  (unsigned)d->stream.n_segments, (unsigned long long)d->stream.bytes.total, adcgs_cpu_name(d->cpu),
                  adcgs_pool_threads(d->pool), (unsigned long long)d->memory.peak);
}

/** Where a stream comes from: in order, or from any position. */
typedef struct origin {
    adcgs_read_fn read;
    adcgs_read_at_fn read_at; /**< NULL: in order only */
    void *user;
    uint64_t size, at;        /**< of read_at: bytes there are, and were read in order */
} origin;

/** In order from what is read at any position. */
static int64_t read_in_order(void *user, void *buffer, size_t bytes)
{
    origin *o = user;
    const size_t n = (size_t)ADCGS_MIN((uint64_t)bytes, o->size - o->at);
    const int64_t got = n ? o->read_at(o->user, o->at, buffer, n) : 0;
    o->at += got > 0 ? (uint64_t)got : 0;
    return got;
}

/**
 * Open for reading on demand, where there are segments to choose from. A stream that ends early or has a fault is one to be read
 * whole, which tells what can be used of it, or what is wrong.
 */
static adcgs_status open_seek(adcgs_decoder *d, const origin *from, const adcgs_read_options *options, adcgs_error *error)
{
    adcgs_error why; /* a failure that reading it whole may mend is none yet */
    adcgs_stream_init(&d->stream);
    const adcgs_status status = adcgs_seek_open(&d->seek, &d->stream, from->read_at, from->user, from->size, options, &why);
    if (status == ADCGS_OK && adcgs_seek_segments(d->seek) > 1)
        return ADCGS_OK;
    adcgs_seek_free(&d->seek);
    adcgs_stream_clear(&d->stream, &d->memory);
    if (status == ADCGS_OK || status == ADCGS_ERR_DATA || status == ADCGS_ERR_TRUNCATED)
        return ADCGS_OK;
    *error = why;
    return status;
}

static adcgs_status open_stream(adcgs_decoder *d, origin *from, const adcgs_read_options *options, adcgs_error *error)
{
    if (options->conceal)
        return adcgs_stream_salvage(&d->stream, from->read_at, from->user, from->size, options, &d->faults, error);
    if (from->read_at)
        ADCGS_TRY(open_seek(d, from, options, error));
    if (d->seek)
        return ADCGS_OK;
    const adcgs_read_fn read = from->read_at ? read_in_order : from->read;
    void *const user = from->read_at ? from : from->user;
    return options->join ? adcgs_push_read(&d->stream, read, user, options, error) :
                           adcgs_stream_read(&d->stream, read, user, options, NULL, NULL, error);
}

/** from: NULL: bytes will be pushed. */
static adcgs_status open_decoder(adcgs_decoder *d, origin *from, const adcgs_config *config, adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_check(error));
    ADCGS_TRY(adcgs_e24_check(error));
    ADCGS_TRY(adcgs_cpu_resolve(config->cpu, &d->cpu, error));
    if (!config->pool)
        ADCGS_TRY(adcgs_pool_create(&d->own_pool, config->threads, error));
    d->pool = config->pool ? config->pool : d->own_pool;
    d->memory.limit = config->memory_limit;
    d->log = (adcgs_log){ config->log, config->log_user };
    const adcgs_read_options options = {
        .cpu = d->cpu,
        .pool = d->pool,
        .memory = &d->memory,
        .log = d->log,
        .layers = config->layers,
        .strict_end = config->strict_end,
        .conceal = config->conceal != 0 && from && from->read_at,
        .join = config->join != 0,
    };
    if (!from) {
        adcgs_stream_init(&d->stream);
        return adcgs_push_create(&d->push, &d->stream, &options, error);
    }
    ADCGS_TRY(open_stream(d, from, &options, error));
    say_opened(d);
    return ADCGS_OK;
}

static adcgs_status open_from(adcgs_decoder **out, origin *from, const adcgs_config *config, adcgs_error *error)
{
    adcgs_config own;
    ADCGS_TRY(adcgs_config_read(&own, config, error));
    ADCGS_TRY(check_config(&own, error));
    adcgs_decoder *d = adcgs_alloc(NULL, 1, sizeof *d, error);
    if (!d)
        return adcgs_alloc_status(error);
    const adcgs_status status = open_decoder(d, from, &own, error);
    if (status == ADCGS_OK)
        *out = d;
    else
        adcgs_close(&d);
    return status;
}

adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                               adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    ADCGS_REQUIRE(read, error);
    return open_from(out, &(origin){ .read = read, .user = user }, config, error);
}

adcgs_status adcgs_open_at(adcgs_decoder **out, adcgs_read_at_fn read, void *user, uint64_t bytes, const adcgs_config *config,
                           adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    ADCGS_REQUIRE(read, error);
    return open_from(out, &(origin){ .read_at = read, .user = user, .size = bytes }, config, error);
}

void adcgs_close(adcgs_decoder **decoder)
{
    adcgs_decoder *d = decoder ? *decoder : NULL;
    if (!d)
        return;
    adcgs_splat_free(&d->splat);
    adcgs_raster_free(&d->raster);
    adcgs_free(&d->memory, d->planar);
    adcgs_seek_free(&d->seek);
    adcgs_push_free(&d->push);
    adcgs_model_clear(&d->unfinished, &d->memory);
    adcgs_model_clear(&d->coarser, &d->memory);
    adcgs_stream_clear(&d->stream, &d->memory);
    if (d->file)
        fclose(d->file);
    adcgs_pool_free(&d->own_pool);
    adcgs_free(NULL, d);
    *decoder = NULL;
}

/** The first segment that can be asked for: those before it were forgotten, or missed. */
static uint32_t first_segment(const adcgs_decoder *d)
{
    return d->seek ? 0 : d->stream.first_segment;
}

/** The number behind the last segment that can be asked for. */
static uint32_t end_segment(const adcgs_decoder *d)
{
    return d->seek ? adcgs_seek_segments(d->seek) : d->stream.first_segment + d->stream.n_segments + (d->unfinished.n > 0);
}

/** Of a decoder that does not seek: one that came, or the one that comes. */
static const adcgs_model *model_of(const adcgs_decoder *d, uint32_t segment)
{
    const uint32_t index = segment - d->stream.first_segment;
    return index < d->stream.n_segments ? &d->stream.segments[index] : &d->unfinished;
}

static double start_of(const adcgs_decoder *d, uint32_t segment)
{
    return d->seek ? adcgs_ticks_to_seconds(&d->stream, adcgs_seek_start(d->seek, segment)) : model_of(d, segment)->time_start;
}

/** The last segment that starts at or before the time; the first if none does. */
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

static float normalised_time(const adcgs_model *model, double time)
{
    const double span = model->time_end - model->time_start;
    const double t = span > 0 ? (time - model->time_start) / span : 0;
    return t > 0 ? t < 1 ? (float)t : 1.0f : 0.0f; /* NaN becomes 0 */
}

/** A segment's model, which may be moved by the next call. */
static adcgs_status decoder_segment(adcgs_decoder *d, uint32_t number, const adcgs_model **model, adcgs_error *error)
{
    if (!d->seek) {
        *model = model_of(d, number);
        return ADCGS_OK;
    }
    if (d->stream.n_segments == 1 && d->stream.first_segment == number) {
        *model = d->stream.segments;
        return ADCGS_OK;
    }
    adcgs_splat_free(&d->splat); /* of a model that goes */
    return adcgs_seek_to(d->seek, number, model, error);
}

/** Look at what has come since of the segment at hand. */
static adcgs_status catch_up(adcgs_decoder *d, adcgs_error *error)
{
    int drawable;
    if (!d->is_behind)
        return ADCGS_OK;
    adcgs_splat_free(&d->splat); /* of a model that goes, or that was moved */
    adcgs_model_clear(&d->unfinished, &d->memory);
    d->is_behind = 0;
    const adcgs_status status = adcgs_push_peek(d->push, &d->unfinished, &drawable, error);
    if (status != ADCGS_OK)
        adcgs_model_clear(&d->unfinished, &d->memory);
    return status;
}

/** Make splats of a segment's model, or of the tiers of it that are wanted. */
static adcgs_status make_splat(adcgs_decoder *d, const adcgs_model *model, adcgs_error *error)
{
    adcgs_model_clear(&d->coarser, &d->memory);
    if (d->tiers && d->tiers < model->finest + 1 - model->absent) {
        const adcgs_status status = adcgs_model_coarser(&d->coarser, model, d->tiers, &d->memory, error);
        if (status != ADCGS_OK) {
            adcgs_model_clear(&d->coarser, &d->memory);
            return status;
        }
        model = &d->coarser;
    }
    return adcgs_splat_create(&d->splat, model, d->cpu, d->pool, &d->memory, error);
}

adcgs_status adcgs_set_tiers(adcgs_decoder *decoder, int tiers, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    if (tiers < 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d tiers asked for", tiers);
    if (tiers != decoder->tiers)
        adcgs_splat_free(&decoder->splat);
    decoder->tiers = tiers;
    return ADCGS_OK;
}

adcgs_status adcgs_decoder_primitives(adcgs_decoder *d, double time, adcgs_primitives *out, adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_modes(error)); /* the caller may have changed them since */
    ADCGS_TRY(catch_up(d, error));
    if (end_segment(d) == first_segment(d))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "decoder: no segment that can be drawn has come yet");
    const uint32_t segment = segment_at(d, time);
    const adcgs_model *model;
    ADCGS_TRY(decoder_segment(d, segment, &model, error));
    if (d->splat && d->splat_segment != segment)
        adcgs_splat_free(&d->splat);
    if (!d->splat)
        ADCGS_TRY(make_splat(d, model, error));
    d->splat_segment = segment;
    return adcgs_splat_at(d->splat, normalised_time(model, time), out, error);
}

adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(out, error);
    return adcgs_decoder_primitives(decoder, time, out, error);
}

adcgs_status adcgs_get_splat_digest(adcgs_decoder *decoder, double time, uint8_t digest[16], adcgs_error *error)
{
    adcgs_primitives primitives;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(digest, error);
    ADCGS_TRY(adcgs_decoder_primitives(decoder, time, &primitives, error));
    const adcgs_model *model;
    ADCGS_TRY(decoder_segment(decoder, decoder->splat_segment, &model, error));
    adcgs_splat_digest(decoder->coarser.n ? &decoder->coarser : model, &primitives, digest);
    return ADCGS_OK;
}

adcgs_status adcgs_get_model_digest(adcgs_decoder *decoder, int segment, uint8_t digest[16], adcgs_error *error)
{
    const adcgs_model *model;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(digest, error);
    ADCGS_TRY(catch_up(decoder, error));
    const uint32_t first = first_segment(decoder), end = end_segment(decoder);
    if (segment < 0 || (uint32_t)segment >= end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "segment %d asked for; the stream has %u", segment, (unsigned)end);
    if ((uint32_t)segment < first)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "segment %d asked for; those before %u are not here", segment,
                          (unsigned)first);
    ADCGS_TRY(decoder_segment(decoder, (uint32_t)segment, &model, error));
    adcgs_model_digest(model, digest);
    return ADCGS_OK;
}

/* ---- Bytes as they come ---- */

adcgs_status adcgs_open_push(adcgs_decoder **out, const adcgs_config *config, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    return open_from(out, NULL, config, error);
}

static adcgs_status require_push(const adcgs_decoder *d, adcgs_error *error)
{
    return d->push ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_USAGE, "decoder: was not opened for bytes that come");
}

adcgs_status adcgs_push(adcgs_decoder *decoder, const void *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                        adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(used, error);
    ADCGS_REQUIRE(arrived, error);
    if (bytes > 0)
        ADCGS_REQUIRE(data, error);
    ADCGS_TRY(require_push(decoder, error));
    const adcgs_status status = adcgs_push_take(decoder->push, data, bytes, used, arrived, error);
    decoder->is_behind |= status != ADCGS_OK || *arrived >= ADCGS_ARRIVED_SEGMENT;
    return status;
}

adcgs_status adcgs_push_forget(adcgs_decoder *decoder, double time, adcgs_error *error)
{
    uint32_t n = 0;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_TRY(require_push(decoder, error));
    while (n + 1 < decoder->stream.n_segments && decoder->stream.segments[n + 1].time_start <= time)
        n++;
    if (n > 0)
        adcgs_splat_free(&decoder->splat); /* of a model that goes, or is moved */
    adcgs_stream_forget(&decoder->stream, n, &decoder->memory);
    return ADCGS_OK;
}

adcgs_status adcgs_push_end(adcgs_decoder *decoder, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_TRY(require_push(decoder, error));
    decoder->is_behind = 1;
    return adcgs_push_finish(decoder->push, error);
}
