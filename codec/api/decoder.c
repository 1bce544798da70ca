/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder: opening it, pushing bytes to it, closing it. */
#include "api/decoder_priv.h"

#include "base/cpu_detect.h"
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

static void log_opened(const adcgs_decoder *d)
{
    adcgs_log_say(&d->log, ADCGS_LOG_INFO,
                  "stream: level %d, %u segments, %llu bytes; CPU level %s, %d threads, %llu bytes of memory", d->stream.level,
                  (unsigned)d->stream.n_segments, (unsigned long long)d->stream.bytes.total, adcgs_cpu_name(d->cpu),
                  adcgs_pool_threads(d->pool), (unsigned long long)d->memory.peak);
}

/** Source of a stream: sequential, or with random access. */
typedef struct origin {
    adcgs_read_fn read;
    adcgs_read_at_fn read_at; /**< NULL: sequential only */
    void *user;
    uint64_t size, at; /**< of read_at: total size, and bytes read in order so far */
} origin;

/** Read sequentially from a source with random access. */
static int64_t read_in_order(void *user, void *buffer, size_t bytes)
{
    origin *o = user;
    const size_t n = (size_t)ADCGS_MIN((uint64_t)bytes, o->size - o->at);
    const int64_t got = n ? o->read_at(o->user, o->at, buffer, n) : 0;
    o->at += got > 0 ? (uint64_t)got : 0;
    return got;
}

/**
 * Open for reading on demand, if the stream has several segments. A stream that ends early or is faulty is read as a whole
 * instead: only that shows its usable parts, or its fault.
 */
static adcgs_status open_seek(adcgs_decoder *d, const origin *from, const adcgs_read_options *options, adcgs_error *error)
{
    adcgs_error why; /* not yet a failure: reading the whole stream may still succeed */
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
    return options->tune_in ? adcgs_push_read(&d->stream, read, user, options, error)
                            : adcgs_stream_read(&d->stream, read, user, options, NULL, NULL, error);
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
    d->log = (adcgs_log){config->log, config->log_user};
    const adcgs_read_options options = {
        .cpu = d->cpu,
        .pool = d->pool,
        .memory = &d->memory,
        .log = d->log,
        .layers = config->layers,
        .strict_end = config->strict_end,
        .conceal = config->conceal != 0 && from && from->read_at,
        .tune_in = config->tune_in != 0,
    };
    if (!from) {
        adcgs_stream_init(&d->stream);
        return adcgs_push_create(&d->push, &d->stream, &options, error);
    }
    ADCGS_TRY(open_stream(d, from, &options, error));
    log_opened(d);
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
    return open_from(out, &(origin){.read = read, .user = user}, config, error);
}

adcgs_status adcgs_open_at(adcgs_decoder **out, adcgs_read_at_fn read, void *user, uint64_t bytes, const adcgs_config *config,
                           adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    ADCGS_REQUIRE(read, error);
    return open_from(out, &(origin){.read_at = read, .user = user, .size = bytes}, config, error);
}

void adcgs_close(adcgs_decoder **decoder)
{
    adcgs_decoder *d = decoder ? *decoder : NULL;
    if (!d)
        return;
    adcgs_decoder_forget_drawn(d);
    adcgs_raster_free(&d->raster);
    adcgs_free(&d->memory, d->planar);
    adcgs_seek_free(&d->seek);
    adcgs_push_free(&d->push);
    adcgs_model_clear(&d->unfinished, &d->memory);
    adcgs_stream_clear(&d->stream, &d->memory);
    if (d->file)
        fclose(d->file);
    adcgs_pool_free(&d->own_pool);
    adcgs_free(NULL, d);
    *decoder = NULL;
}

/* ---- Pushed bytes ---- */

adcgs_status adcgs_open_push(adcgs_decoder **out, const adcgs_config *config, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    return open_from(out, NULL, config, error);
}

static adcgs_status require_push(const adcgs_decoder *d, adcgs_error *error)
{
    return d->push ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_USAGE, "decoder: was not opened with adcgs_open_push()");
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

adcgs_status adcgs_push_discard_before(adcgs_decoder *decoder, double time, adcgs_error *error)
{
    uint32_t n = 0;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_TRY(require_push(decoder, error));
    const adcgs_model *const segments = decoder->stream.segments;
    while (n + 1 < decoder->stream.n_segments && segments[n + 1].time_start <= time)
        n++;
    if (n > 0 && time < segments[n - 1].time_end + segments[n - 1].reach)
        n--; /* the crossfade into the next one has not ended */
    if (n > 0)
        adcgs_decoder_forget_drawn(decoder); /* they refer to models that are freed or moved */
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
