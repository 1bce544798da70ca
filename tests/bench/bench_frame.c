/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A frame to measure: its items, its baseline and its memory. */
#include "config.h"

#include "bench_frame.h"

#include "render/sort.h"

#define OVERLAP 36.0 /* splats that cover a pixel, about */
#define FILTER 0.3f

static const float background[3] = {0.1f, 0.2f, 0.3f};

bench_frame_kernels bench_frame_kernels_of(adcgs_cpu_level level, int fast)
{
    switch (level) {
#ifdef HAVE_AVX512
    case ADCGS_CPU_AVX512:
        return fast ? (bench_frame_kernels){&bench_fast_raster_avx512, &bench_fast_back_avx512, &plain_avx512}
                    : (bench_frame_kernels){&adcgs_raster_avx512, &adcgs_back_avx512, &plain_avx512};
#endif
#ifdef HAVE_AVX2
    case ADCGS_CPU_AVX2:
        return fast ? (bench_frame_kernels){&bench_fast_raster_avx2, &bench_fast_back_avx2, &plain_avx2}
                    : (bench_frame_kernels){&adcgs_raster_avx2, &adcgs_back_avx2, &plain_avx2};
#endif
    default:
        return (bench_frame_kernels){&adcgs_raster_scalar, &adcgs_back_scalar, &plain_scalar};
    }
}

/* ---- Whole frames ---- */

void bench_frame_draw(void *arg)
{
    bench_frame *f = arg;
    bench_check(adcgs_raster_forward(f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, 0, NULL), NULL);
}

void bench_frame_draw_and_back(void *arg)
{
    bench_frame *f = arg;
    bench_check(adcgs_raster_forward(f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, 1, NULL), NULL);
    bench_check(adcgs_raster_backward(f->back, f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, f->grad, &f->to,
                                      NULL),
                NULL);
}

void bench_frame_loss(void *arg)
{
    bench_frame *f = arg;
    adcgs_loss_value value;
    bench_check(adcgs_loss_image(f->loss, f->rgb, f->target, f->view.width, f->view.height, &(adcgs_loss_shares){0.2f, 0.9f},
                                 f->grads, &value, NULL),
                NULL);
}

/* ---- Stages ---- */

void bench_frame_project(void *arg)
{
    bench_frame *f = arg;
    f->n = 0;
    for (uint32_t slot = 0; slot < f->primitives.n; slot += 64)
        f->n += f->k.raster->project(&f->project, slot, f->n);
}

void bench_frame_sort(void *arg)
{
    bench_frame *f = arg;
    memcpy(f->keys, f->project.keys, f->n * sizeof *f->keys);
    f->bin.order = adcgs_sort_keys(f->keys, f->keys + f->primitives.n, f->n);
}

void bench_frame_list_tiles(void *arg)
{
    bench_frame *f = arg;
    memset(f->counts, 0, (size_t)f->tiles * sizeof *f->counts);
    f->k.raster->bin(&f->bin, 0, f->n, f->counts, f->emitted);
}

void bench_frame_blend(void *arg)
{
    bench_frame *f = arg;
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.raster->blend(&f->blend, tile);
}

void bench_frame_blend_back(void *arg)
{
    bench_frame *f = arg;
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.back->blend(&f->gradients, tile);
}

void bench_frame_project_back(void *arg)
{
    bench_frame *f = arg;
    for (uint32_t slot = 0; slot < f->primitives.n; slot += 64)
        f->k.back->project(&f->gradients, slot);
}

/* ---- The baseline ---- */

void bench_frame_plain_draw(void *arg)
{
    bench_frame *f = arg;
    bench_frame_project(f);
    bench_frame_sort(f);
    for (uint32_t i = 0; i < f->n; i++)
        f->bin.to[i] = f->bin.from[(uint32_t)f->bin.order[i]];
    f->plain.n = f->n;
    plain_bin(&f->plain);
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.plain->blend(&f->plain, tile);
}

void bench_frame_plain_draw_and_back(void *arg)
{
    bench_frame *f = arg;
    bench_frame_plain_draw(f);
    memset(f->plain.sums, 0, (size_t)f->n * SUM_WORDS * sizeof *f->plain.sums);
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.plain->back(&f->plain, tile);
    for (uint32_t slot = 0; slot < f->primitives.n; slot += 64)
        f->k.back->project(&f->plain_gradients, slot);
}

/** Root mean square of the difference of n numbers, relative to the root mean square of a. */
static double difference(const float *a, const float *b, size_t n)
{
    double between = 0, size = 1e-30;
    for (size_t i = 0; i < n; i++) {
        between += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
        size += (double)a[i] * (double)a[i];
    }
    return sqrt(between / size);
}

/**
 * The baseline renders the same image and gradients, except beyond three standard deviations of a splat. Otherwise a comparison
 * of times would mean nothing.
 */
static void compare(bench_frame *f)
{
    const size_t pixels = 3 * (size_t)f->view.width * (size_t)f->view.height, n = (size_t)f->primitives.n * ADCGS_ROWS;
    float *ours = bench_floats(n);
    bench_frame_draw_and_back(f);
    memcpy(ours, f->grads, n * sizeof *ours);
    bench_frame_plain_draw_and_back(f);
    const double rgb = difference(f->rgb, f->target, pixels), gradients = difference(ours, f->grads, n);
    adcgs_free(NULL, ours);
    if (rgb < 0.001 && gradients < 0.1)
        return;
    fprintf(stderr, "adcgs-bench: the baseline differs: images by %g, gradients by %g\n", rgb, gradients);
    exit(1);
}

/* ---- Memory of a frame ---- */

static void make_room(bench_frame *f)
{
    const uint32_t n = f->primitives.n;
    const size_t values = 3 * (size_t)f->view.width * (size_t)f->view.height;
    f->grads = bench_floats(ADCGS_MAX((size_t)n * ADCGS_GRAD_ROWS, values));
    f->to = adcgs_raster_grads_of(f->grads, n);
    f->rgb = bench_floats(values);
    f->target = bench_floats(values);
    f->grad = bench_floats(values);
    for (size_t i = 0; i < values; i++)
        f->grad[i] = sinf((float)i);
}

/** Allocates memory for the stages. The first frame determines its size. */
static void make_stages(bench_frame *f)
{
    const uint32_t n = f->primitives.n;
    bench_frame_draw_and_back(f);
    adcgs_raster_kept(f->raster, &f->kept);
    f->tiles = f->kept.tiles_x * f->kept.tiles_y;
    uint32_t areas = 0;
    f->project = (adcgs_project_job){.primitives = &f->primitives,
                                     .view = &f->view,
                                     .filter = FILTER,
                                     .tiles_x = f->kept.tiles_x,
                                     .tiles_y = f->kept.tiles_y};
    f->project.splats = (void *)bench_floats((size_t)(n + 64) * 16);
    f->project.outlines = (void *)bench_floats((size_t)(n + 64) * 4);
    f->project.keys = (void *)bench_floats((size_t)(n + 64) * 2);
    f->project.areas = (void *)bench_floats(n + 64);
    f->keys = (void *)bench_floats((size_t)n * 4);
    f->where = (void *)bench_floats(n);
    f->first = (void *)bench_floats(n + 1);
    f->counts = (void *)bench_floats((size_t)f->tiles);
    bench_frame_project(f);
    for (uint32_t i = 0; i < f->n; i++)
        areas += f->project.areas[i];
    f->emitted = (void *)bench_floats(2 * ((size_t)areas + ADCGS_BIN_SLACK));
    bench_frame_sort(f);
    f->bin = (adcgs_bin_job){.order = f->bin.order,
                             .from = f->project.splats,
                             .outlines = f->project.outlines,
                             .tiles_x = f->kept.tiles_x,
                             .to = (void *)bench_floats((size_t)(n + 64) * 16),
                             .first = f->first,
                             .where = f->where};
    f->blend = (adcgs_blend_job){.splats = f->kept.splats,
                                 .entries = f->kept.entries,
                                 .tile_start = f->kept.tile_start,
                                 .tiles_x = f->kept.tiles_x,
                                 .width = f->view.width,
                                 .height = f->view.height,
                                 .background = {background[0], background[1], background[2]},
                                 .rgb = f->rgb};
    f->gradients = (adcgs_back_job){.kept = f->kept,
                                    .primitives = &f->primitives,
                                    .view = &f->view,
                                    .filter = FILTER,
                                    .rgb = f->rgb,
                                    .grad = f->grad,
                                    .out = f->to};
    f->gradients.sums = bench_floats((size_t)f->kept.tile_start[f->tiles] * SUM_WORDS);
}

/** The baseline writes its image into target. It has one set of sums for each splat, over all tiles. */
static void make_plain(bench_frame *f)
{
    uint32_t *one_each = (void *)bench_floats(f->primitives.n + 1);
    for (uint32_t i = 0; i <= f->primitives.n; i++)
        one_each[i] = i;
    f->plain = (plain_job){.splats = f->bin.to,
                           .tiles_x = f->kept.tiles_x,
                           .tiles_y = f->kept.tiles_y,
                           .width = f->view.width,
                           .height = f->view.height,
                           .background = {background[0], background[1], background[2]},
                           .rgb = f->target,
                           .grad = f->grad};
    plain_init(&f->plain, f->primitives.n);
    f->plain_gradients = f->gradients;
    f->plain_gradients.kept.first = one_each;
    f->plain_gradients.sums = f->plain.sums;
}

void bench_frame_make(bench_frame *f, adcgs_cpu_level level, int threads, int width, int height, uint32_t splats)
{
    static const double origin[3] = {0, 0, 0};
    const adcgs_camera camera = scene_camera(width, height);
    adcgs_error error = {.status = ADCGS_OK};
    *f = (bench_frame){.k = bench_frame_kernels_of(level, 0), .scene = scene_room(splats, OVERLAP, 1)};
    f->primitives = scene_primitives(&f->scene);
    bench_check(adcgs_view_init(&f->view, &camera, origin, 1, &error), &error);
    bench_check(adcgs_pool_create(&f->pool, threads, &error), &error);
    bench_check(adcgs_raster_create(&f->raster, level, f->pool, NULL, &error), &error);
    bench_check(adcgs_raster_back_create(&f->back, level, f->pool, &error), &error);
    bench_check(adcgs_loss_create(&f->loss, level, f->pool, &error), &error);
    make_room(f);
    make_stages(f);
    make_plain(f);
    compare(f);
}

void bench_frame_clear(bench_frame *f)
{
    void *const parts[] = {f->grads,          f->rgb,
                           f->target,         f->grad,
                           f->project.splats, f->project.outlines,
                           f->project.keys,   f->project.areas,
                           f->keys,           f->where,
                           f->first,          f->counts,
                           f->emitted,        f->bin.to,
                           f->gradients.sums, (void *)(uintptr_t)f->plain_gradients.kept.first,
                           f->scene.data};
    plain_clear(&f->plain);
    adcgs_loss_free(&f->loss);
    adcgs_raster_back_free(&f->back);
    adcgs_raster_free(&f->raster);
    adcgs_pool_free(&f->pool);
    for (size_t i = 0; i < ADCGS_COUNTOF(parts); i++)
        adcgs_free(NULL, parts[i]);
}
