/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of a decoded stream against a scene's pictures. */
#include "metric/evaluate.h"

#include "data/sort.h"
#include "metric/metric.h"

#include <stdlib.h>

/** Render a view into planar 8-bit levels over 255. The frame and planes are the caller's, of the view's size. */
static adcgs_status render_planar(adcgs_decoder *decoder, const adcgs_scene_view *view, adcgs_frame *frame, uint8_t *levels,
                                  float *planar, double *seconds, adcgs_error *error)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    const double begin = adcgs_seconds();
    ADCGS_TRY(adcgs_render(decoder, &view->camera, view->time, frame, error));
    *seconds = adcgs_seconds() - begin;
    adcgs_frame_to_u8(frame, levels);
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            planar[c * pixels + i] = (float)levels[3 * i + c] / 255.0f;
    return ADCGS_OK;
}

static adcgs_status score_view(adcgs_decoder *decoder, const adcgs_scene *scene, const adcgs_scene_view *view,
                               adcgs_score_fn each, void *user, adcgs_view_score *score, adcgs_error *error)
{
    const size_t pixels = (size_t)view->camera.width * (size_t)view->camera.height;
    float *truth;
    ADCGS_TRY(adcgs_scene_load(scene, view, 1, &truth, NULL, error));
    float *rgb = malloc(pixels * 3 * sizeof *rgb), *planar = malloc(pixels * 3 * sizeof *planar);
    uint8_t *levels = malloc(pixels * 3);
    adcgs_frame frame = { view->camera.width, view->camera.height, rgb };
    adcgs_status status = ADCGS_ERR_MEMORY;
    if (rgb && planar && levels)
        status = render_planar(decoder, view, &frame, levels, planar, &score->seconds, error);
    else
        adcgs_fail(error, status, "out of memory for a picture of %d x %d", frame.width, frame.height);
    score->view = view;
    score->width = frame.width;
    score->height = frame.height;
    score->decoded = planar;
    score->truth = truth;
    if (status == ADCGS_OK) {
        score->psnr = adcgs_psnr(planar, truth, pixels * 3);
        status = adcgs_ssim(planar, truth, frame.width, frame.height, &score->ssim, error);
    }
    if (status == ADCGS_OK && each)
        status = each(user, score, error);
    free(truth);
    free(rgb);
    free(planar);
    free(levels);
    return status;
}

adcgs_status adcgs_evaluate(adcgs_evaluation *out, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_split split,
                            adcgs_score_fn each, void *user, adcgs_error *error)
{
    const uint32_t n = scene->n_views[split];
    memset(out, 0, sizeof *out);
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the %s split has no views", scene->directory, adcgs_split_name(split));
    double *seconds = malloc(n * sizeof *seconds);
    if (!seconds)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u results", n);
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++) {
        adcgs_view_score score;
        status = score_view(decoder, scene, &scene->views[split][i], each, user, &score, error);
        if (status == ADCGS_OK) {
            out->psnr += score.psnr / n;
            out->ssim += score.ssim / n;
            seconds[out->n++] = score.seconds;
        }
    }
    if (status == ADCGS_OK) {
        adcgs_sort(seconds, n);
        out->frames_per_second = seconds[n / 2] > 0 ? 1 / seconds[n / 2] : 0;
    }
    free(seconds);
    return status;
}
