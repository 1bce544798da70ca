/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder: a stream, and the splats and the rasteriser of the segment that is being looked at. */
#include "base/cpu.h"
#include "base/pool.h"
#include "base/strict.h"
#include "net/net.h"
#include "render/render.h"
#include "splat/splat.h"
#include "stream/stream.h"

#define ROWS_PER_JOB 32

struct adcgs_decoder {
    adcgs_memory memory;
    adcgs_pool *pool;
    adcgs_cpu_level cpu;
    adcgs_stream stream;
    adcgs_splat *splat;     /**< of splat_segment; NULL until the first use */
    uint32_t splat_segment;
    adcgs_raster *raster;   /**< NULL until the first frame */
    float *planar;          /**< [3][height][width], grows */
    size_t planar_size;     /**< floats in it */
};

void adcgs_config_init(adcgs_config *config)
{
    *config = (adcgs_config){ .size = sizeof *config };
}

static adcgs_status check_config(const adcgs_config *config, adcgs_error *error)
{
    if (config->size != sizeof *config)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: size is %zu, expected %zu: call adcgs_config_init() first",
                          config->size, sizeof *config);
    if (config->threads < 0 || config->threads > 256)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: threads is %d, expected 0..256", config->threads);
    if (config->layers < 0 || config->layers > ADCGS_LAYERS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "config: layers is %d, expected 0..%d", config->layers, ADCGS_LAYERS);
    return ADCGS_OK;
}

static adcgs_status open_decoder(adcgs_decoder *d, adcgs_read_fn read, void *user, const adcgs_config *config, adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_check(error));
    ADCGS_TRY(adcgs_e24_check(error));
    ADCGS_TRY(adcgs_cpu_resolve(config->cpu, &d->cpu, error));
    ADCGS_TRY(adcgs_pool_create(&d->pool, config->threads, error));
    d->memory.limit = config->memory_limit;
    const adcgs_read_options options = {
        .cpu = d->cpu,
        .pool = d->pool,
        .memory = &d->memory,
        .layers = config->layers,
        .strict_end = config->strict_end,
    };
    return adcgs_stream_read(&d->stream, read, user, &options, NULL, NULL, error);
}

adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                               adcgs_error *error)
{
    adcgs_config defaults;
    *out = NULL;
    adcgs_config_init(&defaults);
    if (!config)
        config = &defaults;
    ADCGS_TRY(check_config(config, error));
    adcgs_decoder *d = adcgs_alloc(NULL, 1, sizeof *d, error);
    if (!d)
        return ADCGS_ERR_MEMORY;
    const adcgs_status status = open_decoder(d, read, user, config, error);
    if (status == ADCGS_OK)
        *out = d;
    else
        adcgs_close(&d);
    return status;
}

void adcgs_close(adcgs_decoder **decoder)
{
    adcgs_decoder *d = *decoder;
    if (!d)
        return;
    adcgs_splat_free(&d->splat);
    adcgs_raster_free(&d->raster);
    adcgs_free(&d->memory, d->planar);
    adcgs_stream_clear(&d->stream, &d->memory);
    adcgs_pool_free(&d->pool);
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

static adcgs_status primitives_at(adcgs_decoder *d, double time, adcgs_primitives *out, adcgs_error *error)
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

adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out)
{
    return primitives_at(decoder, time, out, NULL);
}

adcgs_status adcgs_get_splat_digest(adcgs_decoder *decoder, double time, uint8_t digest[16])
{
    adcgs_primitives primitives;
    ADCGS_TRY(primitives_at(decoder, time, &primitives, NULL));
    adcgs_splat_digest(&decoder->stream.segments[decoder->splat_segment], &primitives, digest);
    return ADCGS_OK;
}

/** Planar to interleaved, a band of rows. */
typedef struct interleave_job {
    const float *planar;
    const adcgs_frame *frame;
} interleave_job;

static void interleave(void *arg, int index, int thread)
{
    const interleave_job *job = arg;
    const size_t width = (size_t)job->frame->width, height = (size_t)job->frame->height, plane = width * height;
    const size_t begin = (size_t)index * ROWS_PER_JOB * width, end = ADCGS_MIN(begin + ROWS_PER_JOB * width, plane);
    float *out = job->frame->rgb + 3 * begin;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        for (size_t c = 0; c < 3; c++)
            *out++ = job->planar[c * plane + i];
}

static adcgs_status reserve_planar(adcgs_decoder *d, size_t floats, adcgs_error *error)
{
    if (floats <= d->planar_size)
        return ADCGS_OK;
    adcgs_free(&d->memory, d->planar);
    d->planar_size = 0;
    d->planar = adcgs_alloc(&d->memory, floats, sizeof *d->planar, error);
    if (!d->planar)
        return ADCGS_ERR_MEMORY;
    d->planar_size = floats;
    return ADCGS_OK;
}

/** What both kinds of picture need: the view, the splats, a raster, and planes of the picture's size. */
static adcgs_status prepare(adcgs_decoder *d, const adcgs_camera *camera, double time, adcgs_primitives *primitives,
                            adcgs_view *view, adcgs_error *error)
{
    ADCGS_TRY(adcgs_view_init(view, camera, d->stream.scene_origin, d->stream.scene_scale, error));
    ADCGS_TRY(primitives_at(d, time, primitives, error));
    if (!d->raster)
        ADCGS_TRY(adcgs_raster_create(&d->raster, d->cpu, d->pool, &d->memory, error));
    return reserve_planar(d, 3 * (size_t)view->width * (size_t)view->height, error);
}

adcgs_status adcgs_render(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_frame *frame, adcgs_error *error)
{
    adcgs_decoder *d = decoder;
    const adcgs_stream *stream = &d->stream;
    adcgs_primitives primitives;
    adcgs_view view;
    if (!frame->rgb || frame->width != camera->width || frame->height != camera->height)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "frame: size is %dx%d, expected the camera's, %dx%d", (int)frame->width,
                          (int)frame->height, (int)camera->width, (int)camera->height);
    ADCGS_TRY(prepare(d, camera, time, &primitives, &view, error));
    ADCGS_TRY(adcgs_raster_forward(d->raster, &primitives, &view, stream->background, stream->screen_filter, d->planar, 0,
                                   error));
    interleave_job job = { d->planar, frame };
    adcgs_pool_run(d->pool, interleave, &job, (frame->height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    return ADCGS_OK;
}

/** Sums over the splats to depth and coverage, a band of rows. */
typedef struct divide_job {
    const float *sums;
    size_t width, height;
    double scale;
    float *depth, *alpha;
} divide_job;

static void divide(void *arg, int index, int thread)
{
    const divide_job *job = arg;
    const size_t plane = job->width * job->height, begin = (size_t)index * ROWS_PER_JOB * job->width;
    const size_t end = ADCGS_MIN(begin + ROWS_PER_JOB * job->width, plane);
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const float weight = job->sums[plane + i];
        if (job->depth) {
            const double depth = (double)job->sums[i] / (double)weight * job->scale;
            job->depth[i] = weight > 0 && depth < (double)ADCGS_DEPTH_FAR ? (float)depth : ADCGS_DEPTH_FAR; /* NaN is far, too */
        }
        if (job->alpha)
            job->alpha[i] = weight < 1 ? weight : 1.0f; /* rounding may add up to more */
    }
}

adcgs_status adcgs_render_depth(adcgs_decoder *decoder, const adcgs_camera *camera, double time, float *depth, float *alpha,
                                adcgs_error *error)
{
    adcgs_decoder *d = decoder;
    adcgs_primitives primitives;
    adcgs_view view;
    ADCGS_TRY(prepare(d, camera, time, &primitives, &view, error));
    ADCGS_TRY(adcgs_raster_depth(d->raster, &primitives, &view, d->stream.screen_filter, d->planar, error));
    divide_job job = { d->planar, (size_t)view.width, (size_t)view.height, d->stream.scene_scale, depth, alpha };
    adcgs_pool_run(d->pool, divide, &job, (view.height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    return ADCGS_OK;
}

adcgs_status adcgs_get_camera(const adcgs_decoder *decoder, int index, adcgs_camera *camera)
{
    if (index < 0 || (uint32_t)index >= decoder->stream.n_cameras)
        return ADCGS_ERR_USAGE;
    *camera = decoder->stream.cameras[index];
    return ADCGS_OK;
}

const char *adcgs_get_metadata(const adcgs_decoder *decoder, const char *key)
{
    for (uint32_t i = 0; i < decoder->stream.n_meta; i++)
        if (strcmp(decoder->stream.meta[i].key, key) == 0)
            return decoder->stream.meta[i].value;
    return NULL;
}

adcgs_status adcgs_get_model_digest(const adcgs_decoder *decoder, int segment, uint8_t digest[16])
{
    if (segment < 0 || (uint32_t)segment >= decoder->stream.n_segments)
        return ADCGS_ERR_USAGE;
    adcgs_model_digest(&decoder->stream.segments[segment], digest);
    return ADCGS_OK;
}

adcgs_status adcgs_get_info(const adcgs_decoder *decoder, adcgs_info *info)
{
    adcgs_stream_info(&decoder->stream, info);
    return ADCGS_OK;
}
