/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A frame to measure: its splats, its image, the data of the renderer's stages, and the baseline's. */
#ifndef ADCGS_BENCH_BENCH_FRAME_H
#define ADCGS_BENCH_BENCH_FRAME_H

#include "fast.h"
#include "measure.h"
#include "plain.h"

#include "grad/loss.h"
#include "unit/pixels_scene.h"

/** Kernels of a level: the renderer's and the baseline's. */
typedef struct bench_frame_kernels {
    const adcgs_raster_dsp *raster;
    const adcgs_back_dsp *back;
    const plain_dsp *plain;
} bench_frame_kernels;

typedef struct bench_frame {
    bench_frame_kernels k;
    adcgs_primitives primitives;
    scene_splats scene;
    adcgs_view view;
    adcgs_pool *pool;
    adcgs_raster *raster;
    adcgs_raster_back *back;
    adcgs_loss *loss;
    float *grads, *rgb, *target, *grad;
    adcgs_raster_grads to;
    adcgs_kept kept; /**< of the raster's last forward pass with keep set */
    int tiles;
    /* Data of the stages, which also run separately. */
    adcgs_project_job project;
    adcgs_bin_job bin;
    adcgs_blend_job blend;
    adcgs_back_job gradients;
    uint32_t n, *where, *first, *counts;
    uint64_t *keys, *emitted;
    plain_job plain;
    adcgs_back_job plain_gradients;
} bench_frame;

/** The kernels of a level. fast: those compiled without the rules that make them exact. */
bench_frame_kernels bench_frame_kernels_of(adcgs_cpu_level level, int fast);
/** Makes a frame of a room of splats, and checks the baseline against it. The caller clears it. */
void bench_frame_make(bench_frame *f, adcgs_cpu_level level, int threads, int width, int height, uint32_t splats);
void bench_frame_clear(bench_frame *f);

/* Items to measure; arg is the frame. First the whole frame, by the renderer. */
void bench_frame_draw(void *arg);
void bench_frame_draw_and_back(void *arg);
void bench_frame_loss(void *arg);

/* Its stages. */
void bench_frame_project(void *arg);
void bench_frame_sort(void *arg);
void bench_frame_list_tiles(void *arg);
void bench_frame_blend(void *arg);
void bench_frame_blend_back(void *arg);
void bench_frame_project_back(void *arg);

/* The whole frame, by the baseline. */
void bench_frame_plain_draw(void *arg);
void bench_frame_plain_draw_and_back(void *arg);

#endif
