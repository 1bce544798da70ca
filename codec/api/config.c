/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Structs that grow from version to version, exchanged by a caller and a library of different versions. A member that one side
 * does not know is zero, and zero is the default of every setting.
 */
#include "api/decoder_priv.h"

#include <math.h>

/* The struct of the first version ended before pool. No version has one as large as SIZE_MOST: such a size was never set. */
#define CONFIG_SIZE_LEAST offsetof(adcgs_config, pool)
#define SIZE_MOST 4096

void adcgs_config_init(adcgs_config *config, size_t size)
{
    memset(config, 0, size);
    memcpy(config, &size, ADCGS_MIN(size, sizeof size));
}

adcgs_status adcgs_config_read(adcgs_config *own, const adcgs_config *theirs, adcgs_error *error)
{
    size_t size;
    memset(own, 0, sizeof *own);
    own->size = sizeof *own;
    if (!theirs)
        return ADCGS_OK;
    memcpy(&size, theirs, sizeof size); /* the caller's struct may be smaller than adcgs_config */
    if (size < CONFIG_SIZE_LEAST || size > SIZE_MOST)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: size is %zu, expected %zu: call adcgs_config_init() first", size,
                          sizeof *own);
    const unsigned char *bytes = (const unsigned char *)theirs;
    for (size_t i = sizeof *own; i < size; i++)
        if (bytes[i])
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                              "config: byte %zu is set, but this version of the library does not know it", i);
    memcpy(own, theirs, ADCGS_MIN(size, sizeof *own));
    own->size = sizeof *own;
    return ADCGS_OK;
}

/** Properties that are known before any segment is read. */
static void describe_on_demand(const adcgs_decoder *d, adcgs_info *info)
{
    const uint32_t n = adcgs_seek_segments(d->seek);
    const adcgs_stream *s = &d->stream;
    int64_t first[3], last[3];
    adcgs_seek_times(d->seek, 0, first);
    adcgs_seek_times(d->seek, n - 1, last);
    const int64_t end = s->duration_ticks >= 0 ? s->start_ticks + s->duration_ticks : last[1];
    info->segments = (int)n;
    info->first_segment = 0;
    info->time_start = adcgs_ticks_to_seconds(s, first[0]);
    info->time_end = adcgs_ticks_to_seconds(s, end);
    info->bytes.total = adcgs_seek_bytes(d->seek);
}

/** Seconds of a tick. The lowest and the highest tick mean minus and plus infinity. */
static double seconds_of(const adcgs_stream *s, int64_t tick)
{
    return tick == INT64_MIN ? -INFINITY : tick == INT64_MAX ? INFINITY : adcgs_ticks_to_seconds(s, tick);
}

/** Properties of a pushed stream, and its progress. */
static void describe_push(const adcgs_decoder *d, adcgs_info *info)
{
    adcgs_push_progress p;
    adcgs_push_get_progress(d->push, &p);
    info->segments = (int)p.segments;
    info->segments_total = (int)p.total;
    info->time_start = seconds_of(&d->stream, p.start);
    info->time_committed = seconds_of(&d->stream, p.committed);
    info->tiers_received = p.tiers_received;
    info->tiers = ADCGS_MAX(info->tiers, p.tiers);
    if (p.is_over && p.segments > 0)
        return;
    info->time_available = seconds_of(&d->stream, p.available);
    info->time_end = seconds_of(&d->stream, p.end);
    info->bytes.total = p.bytes;
}

adcgs_status adcgs_get_info(const adcgs_decoder *decoder, adcgs_info *info, size_t size, adcgs_error *error)
{
    adcgs_info own;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(info, error);
    if (size < sizeof info->size || size > SIZE_MOST)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "info: size is %zu, expected %zu", size, sizeof own);
    if (decoder->push && !adcgs_push_has_head(decoder->push))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "decoder: the header has not arrived yet");
    memset(&own, 0, sizeof own); /* padding, too */
    adcgs_stream_info(&decoder->stream, &own);
    own.faults = (int)ADCGS_MIN(decoder->faults, (uint32_t)INT32_MAX);
    own.time_committed = INFINITY;
    if (decoder->seek)
        describe_on_demand(decoder, &own);
    own.time_available = own.time_end;
    if (decoder->push)
        describe_push(decoder, &own);
    own.size = ADCGS_MIN(size, sizeof own);
    memset(info, 0, size);
    memcpy(info, &own, own.size);
    return ADCGS_OK;
}

adcgs_status adcgs_get_camera(const adcgs_decoder *decoder, int index, adcgs_camera *camera, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(camera, error);
    if (index < 0 || (uint32_t)index >= decoder->stream.n_cameras)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "camera %d requested; the stream has %u", index,
                          (unsigned)decoder->stream.n_cameras);
    *camera = decoder->stream.cameras[index].camera;
    return ADCGS_OK;
}

adcgs_status adcgs_get_camera_time(const adcgs_decoder *decoder, int index, double *time, int *path, adcgs_error *error)
{
    adcgs_camera camera;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(time, error);
    ADCGS_REQUIRE(path, error);
    ADCGS_TRY(adcgs_get_camera(decoder, index, &camera, error));
    *time = decoder->stream.cameras[index].time;
    *path = decoder->stream.cameras[index].path;
    return ADCGS_OK;
}

const char *adcgs_get_metadata(const adcgs_decoder *decoder, const char *key)
{
    for (uint32_t i = 0; decoder && key && i < decoder->stream.n_meta; i++)
        if (strcmp(decoder->stream.meta[i].key, key) == 0)
            return decoder->stream.meta[i].value;
    return NULL;
}

const char *adcgs_get_metadata_key(const adcgs_decoder *decoder, int index)
{
    if (!decoder || index < 0 || (uint32_t)index >= decoder->stream.n_meta)
        return NULL;
    return decoder->stream.meta[index].key;
}
