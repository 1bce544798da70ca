/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images: frames, frames of 8 bits, depth. The rasteriser fills planes; the rows are then converted in bands. */
#include "api/decoder_priv.h"
#include "api/frame_samples.h"

#define ROWS_PER_JOB 32

/** Convert a band of rows from planar to interleaved. */
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

static void interleave_all(adcgs_decoder *d, const adcgs_frame *frame)
{
    interleave_job job = {d->planar, frame};
    adcgs_pool_run(d->pool, interleave, &job, (frame->height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
}

static adcgs_status reserve_planar(adcgs_decoder *d, size_t floats, adcgs_error *error)
{
    if (floats <= d->planar_size)
        return ADCGS_OK;
    adcgs_free(&d->memory, d->planar);
    d->planar_size = 0;
    d->planar = adcgs_alloc(&d->memory, floats, sizeof *d->planar, error);
    if (!d->planar)
        return adcgs_alloc_status(error);
    d->planar_size = floats;
    return ADCGS_OK;
}

/** State for rendering any kind of image. */
typedef struct picture {
    adcgs_render_state state;
    adcgs_view view;
    size_t plane;  /**< floats in one plane */
    float *before; /**< three planes, for the previous segment during a crossfade */
} picture;

/** Find the splats to render; allocate the rasteriser and planes of the image's size. */
static adcgs_status prepare(adcgs_decoder *d, const adcgs_camera *camera, double time, size_t planes, picture *p,
                            adcgs_error *error)
{
    ADCGS_TRY(adcgs_view_init(&p->view, camera, d->stream.scene_origin, d->stream.scene_scale, error));
    ADCGS_TRY(adcgs_decoder_state_at(d, time, &p->state, error));
    if (!d->raster)
        ADCGS_TRY(adcgs_raster_create(&d->raster, d->cpu, d->pool, &d->memory, error));
    p->plane = (size_t)p->view.width * (size_t)p->view.height;
    ADCGS_TRY(reserve_planar(d, (planes + (p->state.fades ? 3 : 0)) * p->plane, error));
    p->before = d->planar + planes * p->plane;
    return ADCGS_OK;
}

/** Blend three planes of the previous segment's image into those of the current one, a band of rows. */
typedef struct fade_job {
    const float *before;
    float *now;
    size_t n, step; /**< total number of floats, and of a band */
    float weight;
} fade_job;

static void fade(void *arg, int index, int thread)
{
    const fade_job *job = arg;
    const size_t begin = (size_t)index * job->step, end = ADCGS_MIN(begin + job->step, job->n);
    (void)thread;
    for (size_t i = begin; i < end; i++)
        job->now[i] = job->before[i] + job->weight * (job->now[i] - job->before[i]);
}

static adcgs_status draw_one(adcgs_decoder *d, const picture *p, const adcgs_primitives *primitives, int depth, float *planes,
                             adcgs_error *error)
{
    return depth ? adcgs_raster_depth(d->raster, primitives, &p->view, d->stream.screen_filter, planes, error)
                 : adcgs_raster_forward(d->raster, primitives, &p->view, d->stream.background, d->stream.screen_filter, planes, 0,
                                        error);
}

/** Fill the first three planes with colours or, if depth is nonzero, with the sums that give depth and coverage. */
static adcgs_status draw(adcgs_decoder *d, const picture *p, int depth, adcgs_error *error)
{
    ADCGS_TRY(draw_one(d, p, &p->state.now, depth, d->planar, error));
    if (!p->state.fades)
        return ADCGS_OK;
    ADCGS_TRY(draw_one(d, p, &p->state.before, depth, p->before, error));
    fade_job job = {p->before, d->planar, 3 * p->plane, 3 * ROWS_PER_JOB * (size_t)p->view.width, p->state.weight};
    adcgs_pool_run(d->pool, fade, &job, (p->view.height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    return ADCGS_OK;
}

adcgs_status adcgs_render(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_frame *frame, adcgs_error *error)
{
    picture p;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(camera, error);
    ADCGS_REQUIRE(frame, error);
    if (!frame->rgb || frame->width != camera->width || frame->height != camera->height)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "frame: size is %dx%d, expected the camera's, %dx%d", (int)frame->width,
                          (int)frame->height, (int)camera->width, (int)camera->height);
    ADCGS_TRY(prepare(decoder, camera, time, 3, &p, error));
    ADCGS_TRY(draw(decoder, &p, 0, error));
    interleave_all(decoder, frame);
    return ADCGS_OK;
}

/** Convert planes R, G, B and coverage to pixels of 4 bytes, a band of rows. */
typedef struct rgba8_job {
    const float *planar;
    size_t width, height;
    const float *background;
    adcgs_alpha alpha;
    uint8_t *pixels;
    ptrdiff_t stride;
} rgba8_job;

static void store_rgba8(const rgba8_job *job, size_t i, uint8_t *out)
{
    const size_t plane = job->width * job->height;
    const float sum = job->planar[3 * plane + i], coverage = sum < 1 ? sum : 1.0f; /* rounding can make the sum exceed 1 */
    const float divisor = job->alpha == ADCGS_ALPHA_STRAIGHT && coverage > 0 ? coverage : 1.0f;
    for (size_t c = 0; c < 3; c++)
        out[c] = adcgs_sample_u8((job->planar[c * plane + i] - (1.0f - coverage) * job->background[c]) / divisor);
    out[3] = adcgs_sample_u8(coverage);
}

static void store_rgbx8(const rgba8_job *job, size_t i, uint8_t *out)
{
    for (size_t c = 0; c < 3; c++)
        out[c] = adcgs_sample_u8(job->planar[c * job->width * job->height + i]);
    out[3] = 255;
}

static void pack_rgba8(void *arg, int index, int thread)
{
    const rgba8_job *job = arg;
    const size_t begin = (size_t)index * ROWS_PER_JOB, end = ADCGS_MIN(begin + ROWS_PER_JOB, job->height);
    (void)thread;
    for (size_t y = begin; y < end; y++) {
        uint8_t *out = job->pixels + (ptrdiff_t)y * job->stride;
        for (size_t x = 0; x < job->width; x++, out += 4)
            if (job->alpha == ADCGS_ALPHA_OPAQUE)
                store_rgbx8(job, y * job->width + x, out);
            else
                store_rgba8(job, y * job->width + x, out);
    }
}

adcgs_status adcgs_render_rgba8(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_alpha alpha,
                                uint8_t *pixels, ptrdiff_t stride, adcgs_error *error)
{
    adcgs_decoder *d = decoder;
    picture p;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(camera, error);
    ADCGS_REQUIRE(pixels, error);
    if ((unsigned)alpha > ADCGS_ALPHA_PREMULTIPLIED)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "alpha is %d, expected 0..%d", (int)alpha, ADCGS_ALPHA_PREMULTIPLIED);
    ADCGS_TRY(prepare(d, camera, time, 4, &p, error));
    const int width = p.view.width, height = p.view.height;
    if (stride < 4 * (ptrdiff_t)width && stride > -4 * (ptrdiff_t)width)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stride is %td bytes, expected at least %d in magnitude", stride, 4 * width);
    if (alpha != ADCGS_ALPHA_OPAQUE) {
        ADCGS_TRY(draw(d, &p, 1, error));
        memcpy(d->planar + 3 * p.plane, d->planar + p.plane, p.plane * sizeof *d->planar);
    }
    ADCGS_TRY(draw(d, &p, 0, error));
    rgba8_job job = {d->planar, (size_t)width, (size_t)height, d->stream.background, alpha, pixels, stride};
    adcgs_pool_run(d->pool, pack_rgba8, &job, (height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    return ADCGS_OK;
}

/** Convert sums over the splats to depth and coverage, a band of rows. */
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
            job->alpha[i] = weight < 1 ? weight : 1.0f; /* rounding can make the sum exceed 1 */
    }
}

adcgs_status adcgs_render_depth(adcgs_decoder *decoder, const adcgs_camera *camera, double time, float *depth, float *alpha,
                                adcgs_error *error)
{
    adcgs_decoder *d = decoder;
    picture p;
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(decoder, error);
    ADCGS_REQUIRE(camera, error);
    ADCGS_TRY(prepare(d, camera, time, 3, &p, error));
    ADCGS_TRY(draw(d, &p, 1, error));
    divide_job job = {d->planar, (size_t)p.view.width, (size_t)p.view.height, d->stream.scene_scale, depth, alpha};
    adcgs_pool_run(d->pool, divide, &job, (p.view.height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    return ADCGS_OK;
}
