/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of a decoded stream against a scene's images. */
#include "metric/evaluate.h"

#include "camera/path.h"
#include "metric/metric.h"
#include "metric/moving.h"
#include "scene/group_views.h"
#include "system/sort_values.h"

#include <adcgs/decoder.h>
#include <adcgs/frame.h>

#include <math.h>
#include <stdlib.h>

/** Render a view into planar 8-bit levels over 255. The caller provides the frame and planes, of the camera's size. */
static adcgs_status render_planar(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_frame *frame,
                                  uint8_t *levels, float *planar, double *seconds, adcgs_error *error)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    const double begin = adcgs_seconds();
    ADCGS_TRY(adcgs_camera_path_rendered(camera, adcgs_render(decoder, camera, time, frame, error), error));
    *seconds = adcgs_seconds() - begin;
    adcgs_frame_to_u8(frame, levels);
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            planar[c * pixels + i] = (float)levels[3 * i + c] / 255.0f;
    return ADCGS_OK;
}

/** State of an evaluation. */
typedef struct session {
    adcgs_decoder *decoder;
    const adcgs_scene *scene;
    const adcgs_scene_view *views;
    uint32_t n;
    uint32_t *of, *order; /**< [n] from adcgs_group_views() */
    int measure;
    adcgs_temporal *temporal; /**< of the current camera; NULL for a camera with one view, and without a measure over time */
    adcgs_temporal_total total;
    adcgs_score_fn each;
    void *user;
} session;

/** A view's true image, and its camera at that size. */
static adcgs_status load_truth(const session *s, const adcgs_scene_view *view, float **truth, adcgs_camera *camera,
                               adcgs_error *error)
{
    return adcgs_scene_image(s->scene, view, ADCGS_MAX(s->scene->measured, 1), truth, camera, error);
}

/** Load the true images of the camera whose views are order[first..end). */
static adcgs_status look_ahead(session *s, uint32_t first, uint32_t end, adcgs_error *error)
{
    for (uint32_t i = first; i < end; i++) {
        adcgs_camera camera;
        float *truth;
        ADCGS_TRY(load_truth(s, &s->views[s->order[i]], &truth, &camera, error));
        const adcgs_status status =
            i > first ? ADCGS_OK : adcgs_temporal_create(&s->temporal, camera.width, camera.height, error);
        if (status == ADCGS_OK)
            adcgs_temporal_look(s->temporal, truth);
        free(truth);
        ADCGS_TRY(status);
    }
    return adcgs_temporal_find_region(s->temporal, error);
}

static int is_same_camera(const session *s, uint32_t i, uint32_t j)
{
    return j < s->n && s->of[s->order[i]] == s->of[s->order[j]];
}

/** Prepare the camera of view order[i], if it is the first view of this camera. */
static adcgs_status begin_camera(session *s, uint32_t i, adcgs_error *error)
{
    uint32_t end = i + 1;
    if (!(s->measure & ADCGS_MEASURE_TIME) || (i && is_same_camera(s, i, i - 1)) || !is_same_camera(s, i, end))
        return ADCGS_OK;
    while (is_same_camera(s, i, end))
        end++;
    return look_ahead(s, i, end, error);
}

/** A known mask of moving pixels replaces the region estimated from the camera's views. */
static void measure_known(adcgs_view_score *score, const uint8_t *known)
{
    const size_t plane = (size_t)score->width * (size_t)score->height;
    const adcgs_moving moving = adcgs_moving_measure(known, score->decoded, score->truth, plane);
    score->temporal.dynamic_psnr = moving.psnr;
    score->known_share = moving.share;
}

/** Measure with the levels of the decoded image fitted to the truth. moving: NULL without a known or estimated region. */
static adcgs_status measure_fitted(adcgs_view_score *score, const uint8_t *moving, adcgs_error *error)
{
    const size_t plane = (size_t)score->width * (size_t)score->height;
    float *fitted = adcgs_alloc(NULL, 3 * plane, sizeof *fitted, error);
    if (!fitted)
        return adcgs_alloc_status(error);
    adcgs_fit_levels(fitted, score->decoded, score->truth, plane);
    score->fitted_psnr = adcgs_psnr(fitted, score->truth, 3 * plane);
    if (moving)
        score->fitted_dynamic_psnr = adcgs_moving_measure(moving, fitted, score->truth, plane).psnr;
    adcgs_free(NULL, fitted);
    return ADCGS_OK;
}

/** Measure everything but the speed. */
static adcgs_status compare(const session *s, adcgs_view_score *score, adcgs_error *error)
{
    const float *const a = score->decoded, *const b = score->truth;
    uint8_t *known = NULL;
    adcgs_status status = ADCGS_OK;
    score->psnr = adcgs_psnr(a, b, (size_t)score->width * (size_t)score->height * 3);
    ADCGS_TRY(adcgs_ssim(a, b, score->width, score->height, &score->ssim, error));
    score->ms_ssim = score->fitted_psnr = score->fitted_dynamic_psnr = score->known_share = (double)NAN;
    if (s->measure & ADCGS_MEASURE_MS_SSIM)
        ADCGS_TRY(adcgs_ms_ssim(a, b, score->width, score->height, &score->ms_ssim, &score->ms_ssim_scales, error));
    score->temporal = (adcgs_temporal_view){.dynamic_psnr = (double)NAN, .flicker = (double)NAN};
    if (s->temporal)
        score->temporal = adcgs_temporal_add(s->temporal, a, b);
    if ((s->measure & ADCGS_MEASURE_MOVING) && score->view->moving) {
        ADCGS_TRY(adcgs_scene_load_moving(score->view, ADCGS_MAX(s->scene->measured, 1), &known, error));
        measure_known(score, known);
    }
    if (s->measure & (ADCGS_MEASURE_FITTED | ADCGS_MEASURE_FITTED_DYNAMIC))
        status = measure_fitted(score, known ? known : s->temporal ? adcgs_temporal_region(s->temporal) : NULL, error);
    free(known);
    return status;
}

/** Render and compare view order[i]. */
static adcgs_status score_view(session *s, uint32_t i, adcgs_view_score *score, adcgs_error *error)
{
    const adcgs_scene_view *view = &s->views[s->order[i]];
    adcgs_camera camera;
    float *truth;
    ADCGS_TRY(load_truth(s, view, &truth, &camera, error));
    const size_t pixels = (size_t)camera.width * (size_t)camera.height;
    float *rgb = malloc(pixels * 3 * sizeof *rgb), *planar = malloc(pixels * 3 * sizeof *planar);
    uint8_t *levels = malloc(pixels * 3);
    adcgs_frame frame = {camera.width, camera.height, rgb};
    *score = (adcgs_view_score){.view = view,
                                .camera = s->of[s->order[i]],
                                .width = frame.width,
                                .height = frame.height,
                                .seen = &camera,
                                .decoded = planar,
                                .truth = truth};
    adcgs_status status = ADCGS_ERR_MEMORY;
    if (rgb && planar && levels)
        status = render_planar(s->decoder, &camera, view->time, &frame, levels, planar, &score->seconds, error);
    else
        adcgs_fail(error, status, "out of memory for an image of %d x %d", frame.width, frame.height);
    if (status == ADCGS_OK)
        status = compare(s, score, error);
    if (status == ADCGS_OK && s->temporal && !is_same_camera(s, i, i + 1)) {
        s->total = adcgs_temporal_end(s->temporal);
        score->of_camera = &s->total;
        adcgs_temporal_free(&s->temporal);
    }
    if (status == ADCGS_OK && s->each)
        status = s->each(s->user, score, error);
    free(truth);
    free(rgb);
    free(planar);
    free(levels);
    return status;
}

/** seconds: [n] one per frame. */
static adcgs_status score_all(session *s, adcgs_evaluation *out, double *seconds, adcgs_error *error)
{
    uint32_t n_cameras;
    ADCGS_TRY(adcgs_group_views(s->views, s->n, s->of, s->order, &n_cameras, error));
    for (uint32_t i = 0; i < s->n; i++) {
        adcgs_view_score score;
        ADCGS_TRY(begin_camera(s, i, error));
        ADCGS_TRY(score_view(s, i, &score, error));
        out->psnr += score.psnr / s->n;
        out->ssim += score.ssim / s->n;
        seconds[out->n++] = score.seconds;
    }
    adcgs_sort(seconds, s->n);
    const double median = seconds[s->n / 2];
    out->frames_per_second = median > 0 ? 1 / median : 0;
    return ADCGS_OK;
}

adcgs_status adcgs_evaluate(adcgs_evaluation *out, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_split split,
                            int measure, adcgs_score_fn each, void *user, adcgs_error *error)
{
    const uint32_t n = scene->n_views[split];
    session s = {.decoder = decoder,
                 .scene = scene,
                 .views = scene->views[split],
                 .n = n,
                 .measure = measure,
                 .each = each,
                 .user = user};
    memset(out, 0, sizeof *out);
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the %s split has no views", scene->directory, adcgs_split_name(split));
    double *seconds = adcgs_alloc(NULL, n, sizeof *seconds, error);
    s.of = adcgs_alloc(NULL, n, sizeof *s.of, error);
    s.order = adcgs_alloc(NULL, n, sizeof *s.order, error);
    const adcgs_status status = seconds && s.of && s.order ? score_all(&s, out, seconds, error) : adcgs_alloc_status(error);
    adcgs_temporal_free(&s.temporal);
    adcgs_free(NULL, seconds);
    adcgs_free(NULL, s.of);
    adcgs_free(NULL, s.order);
    return status;
}
