/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Counts the static anchors among those that show only static content. Arguments: FILE SCENE. For a camera that does not move and
 * has several images, a pixel changes if it is in the metric's dynamic region. An anchor shows only static content if at most a
 * hundredth of its rendered weight, over all images of all such cameras, lies in changing pixels.
 */
#include "config.h"

#include "grad/raster.h"
#include "metric/temporal.h"
#include "scene/group_views.h"
#include "scene/layouts/open.h"
#include "splat/splat.h"
#include "stream/input.h"
#include "stream/stream.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#define SHARE 0.01

typedef struct still {
    adcgs_stream stream;
    adcgs_scene *scene;
    adcgs_pool *pool;
    adcgs_cpu_level cpu;
    adcgs_splat *splat;
    adcgs_raster *raster;
    adcgs_raster_back *back;
    double *drawn, *changing; /* [anchors] weights in all pixels, in changing pixels */
    float *rows;              /* gradients of all slots */
} still;

/**
 * Adds the weights of an image. The weight of a primitive in changing pixels is the gradient of their red by the primitive's red.
 */
static adcgs_status add_picture(still *s, const adcgs_scene_view *v, const uint8_t *region, adcgs_error *error)
{
    const adcgs_model *const m = &s->stream.segments[0];
    const size_t pixels = (size_t)v->camera.width * (size_t)v->camera.height;
    float *const rgb = adcgs_alloc(NULL, 6 * pixels, sizeof *rgb, error), *const grad = rgb + 3 * pixels;
    adcgs_primitives p;
    adcgs_view view;
    if (!rgb)
        return adcgs_alloc_status(error);
    memset(grad, 0, 3 * pixels * sizeof *grad);
    for (size_t i = 0; i < pixels; i++)
        grad[i] = region[i];
    adcgs_status status = adcgs_view_init(&view, &v->camera, s->stream.scene_origin, s->stream.scene_scale, error);
    if (status == ADCGS_OK)
        status = adcgs_splat_at(s->splat, adcgs_splat_time(m, v->time), &p, error);
    const float black[3] = {0, 0, 0};
    if (status == ADCGS_OK)
        status = adcgs_raster_forward(s->raster, &p, &view, black, s->stream.screen_filter, rgb, 1, error);
    adcgs_raster_grads g = adcgs_raster_grads_of(s->rows, p.n);
    g.screen = NULL;
    if (status == ADCGS_OK)
        status = adcgs_raster_backward(s->back, s->raster, &p, &view, black, s->stream.screen_filter, rgb, grad, &g, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < p.n; i++) {
        const uint32_t anchor = i / (64 * (uint32_t)m->params.k) * 64 + i % 64;
        if (anchor >= m->n)
            continue;
        s->drawn[anchor] += (double)g.weight[i];
        s->changing[anchor] += (double)g.colour[0][i];
    }
    adcgs_free(NULL, rgb);
    return status;
}

/** Adds the n views of a camera. */
static adcgs_status add_camera(still *s, const uint32_t *view, uint32_t n, adcgs_error *error)
{
    const adcgs_scene_view *const v = s->scene->views[ADCGS_SPLIT_TRAIN];
    adcgs_temporal *temporal;
    ADCGS_TRY(adcgs_temporal_create(&temporal, v[view[0]].camera.width, v[view[0]].camera.height, error));
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++) {
        float *rgb = NULL;
        status = adcgs_scene_image(s->scene, &v[view[i]], 1, &rgb, NULL, error);
        if (status == ADCGS_OK)
            adcgs_temporal_look(temporal, rgb);
        free(rgb);
    }
    if (status == ADCGS_OK)
        status = adcgs_temporal_find_region(temporal, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        status = add_picture(s, &v[view[i]], adcgs_temporal_region(temporal), error);
    adcgs_temporal_free(&temporal);
    return status;
}

/** Adds all cameras with several images; *cameras is incremented for each. */
static adcgs_status add_cameras(still *s, uint32_t *cameras, adcgs_error *error)
{
    const uint32_t n_views = s->scene->n_views[ADCGS_SPLIT_TRAIN];
    uint32_t *const of = adcgs_alloc(NULL, 2 * (size_t)n_views, sizeof *of, error), *const order = of + n_views, all, n;
    if (!of)
        return adcgs_alloc_status(error);
    adcgs_status status = adcgs_group_views(s->scene->views[ADCGS_SPLIT_TRAIN], n_views, of, order, &all, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < n_views; i += n) {
        n = 1;
        while (i + n < n_views && of[order[i + n]] == of[order[i]])
            n++;
        if (n < 2)
            continue;
        status = add_camera(s, order + i, n, error);
        ++*cameras;
    }
    adcgs_free(NULL, of);
    return status;
}

static adcgs_status measure(still *s, adcgs_error *error)
{
    const adcgs_model *const m = &s->stream.segments[0];
    const size_t slots = ((size_t)m->n + 63) / 64 * 64 * (size_t)m->params.k;
    uint32_t cameras = 0, seen = 0, all = 0, shows = 0, is_static = 0;
    s->drawn = calloc(2 * (size_t)m->n, sizeof *s->drawn);
    s->rows = adcgs_alloc(NULL, ADCGS_GRAD_ROWS * slots, sizeof *s->rows, error);
    if (!s->drawn || !s->rows)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    s->changing = s->drawn + m->n;
    ADCGS_TRY(adcgs_splat_create(&s->splat, m, s->cpu, s->pool, NULL, error));
    ADCGS_TRY(adcgs_raster_create(&s->raster, s->cpu, s->pool, NULL, error));
    ADCGS_TRY(adcgs_raster_back_create(&s->back, s->cpu, s->pool, error));
    ADCGS_TRY(add_cameras(s, &cameras, error));
    for (uint32_t i = 0; i < m->n; i++) {
        const int still_here = !m->params.time_rows || m->is_static[i];
        if (!(s->drawn[i] > 0))
            continue;
        seen++;
        all += still_here != 0;
        if (s->changing[i] > SHARE * s->drawn[i])
            continue;
        shows++;
        is_static += still_here != 0;
    }
    printf("%u cameras; %u of %u anchors are visible, %u of them static; %u show static content, %u of these static (%.1f %%)\n",
           cameras, seen, m->n, all, shows, is_static, shows ? 100.0 * is_static / shows : 0);
    return ADCGS_OK;
}

static adcgs_status run(still *s, const char *path, const char *scene, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = s->cpu, .pool = s->pool};
    const adcgs_scene_options any = {0};
    FILE *const file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", path, strerror(errno));
    const adcgs_status status = adcgs_stream_read(&s->stream, adcgs_file_read, file, &options, NULL, NULL, error);
    fclose(file);
    ADCGS_TRY(status);
    ADCGS_TRY(adcgs_scene_open(&s->scene, scene, &any, error));
    return measure(s, error);
}

int main(int argc, char **argv)
{
    still s = {.scene = NULL};
    adcgs_error error;
    if (argc != 3) {
        fprintf(stderr, "expected FILE SCENE\n");
        return 2;
    }
    adcgs_stream_init(&s.stream);
    adcgs_status status = adcgs_cpu_resolve(ADCGS_CPU_AUTO, &s.cpu, &error);
    if (status == ADCGS_OK)
        status = run(&s, argv[1], argv[2], &error);
    if (status != ADCGS_OK)
        fprintf(stderr, "%s\n", error.text);
    adcgs_splat_free(&s.splat);
    adcgs_raster_free(&s.raster);
    adcgs_raster_back_free(&s.back);
    adcgs_free(NULL, s.rows);
    free(s.drawn);
    adcgs_scene_free(&s.scene);
    adcgs_stream_clear(&s.stream, NULL);
    return status == ADCGS_OK ? 0 : 1;
}
