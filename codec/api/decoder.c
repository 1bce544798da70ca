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

static adcgs_status open_decoder(adcgs_decoder *d, adcgs_read_fn read, void *user, const adcgs_config *config, adcgs_error *error)
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
    };
    ADCGS_TRY(adcgs_stream_read(&d->stream, read, user, &options, NULL, NULL, error));
    say_opened(d);
    return ADCGS_OK;
}

adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                               adcgs_error *error)
{
    adcgs_config own;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    ADCGS_REQUIRE(read, error);
    ADCGS_TRY(adcgs_config_read(&own, config, error));
    ADCGS_TRY(check_config(&own, error));
    adcgs_decoder *d = adcgs_alloc(NULL, 1, sizeof *d, error);
    if (!d)
        return adcgs_alloc_status(error);
    const adcgs_status status = open_decoder(d, read, user, &own, error);
    if (status == ADCGS_OK)
        *out = d;
    else
        adcgs_close(&d);
    return status;
}

void adcgs_close(adcgs_decoder **decoder)
{
    adcgs_decoder *d = decoder ? *decoder : NULL;
    if (!d)
        return;
    adcgs_splat_free(&d->splat);
    adcgs_raster_free(&d->raster);
    adcgs_free(&d->memory, d->planar);
    adcgs_stream_clear(&d->stream, &d->memory);
    adcgs_pool_free(&d->own_pool);
    adcgs_free(NULL, d);
    *decoder = NULL;
}

/** The last segment that starts at or before the time; the first if none does. */
static uint32_t segment_at(const adcgs_stream *stream, double time)
{
    uint32_t lo = 0, hi = stream->n_segments;
    while (hi - lo > 1) {
        const uint32_t middle = lo + (hi - lo) / 2;
        if (stream->segments[middle].time_start <= time)
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

adcgs_status adcgs_decoder_primitives(adcgs_decoder *d, double time, adcgs_primitives *out, adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_modes(error)); /* the caller may have changed them since */
    const uint32_t segment = segment_at(&d->stream, time);
    const adcgs_model *model = &d->stream.segments[segment];
    if (d->splat && d->splat_segment != segment)
        adcgs_splat_free(&d->splat);
    if (!d->splat)
        ADCGS_TRY(adcgs_splat_create(&d->splat, model, d->cpu, d->pool, &d->memory, error));
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
    adcgs_splat_digest(&decoder->stream.segments[decoder->splat_segment], &primitives, digest);
    return ADCGS_OK;
}
