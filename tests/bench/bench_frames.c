/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames: rendering of splats, and its gradients. */
#include "config.h"

#include "bench_parts.h"
#include "fast.h"
#include "plain.h"

#include "grad/loss.h"
#include "render/sort.h"
#include "unit/pixels_scene.h"

#define OVERLAP 36.0 /* splats that cover a pixel, about */
#define FILTER 0.3f

static const float background[3] = {0.1f, 0.2f, 0.3f};

/**
 * Binary32 operations that would keep the multiply-add units busy, counted from the instructions of the kernels. The difference
 * to the measured ceiling is the cost of all other work. A multiply-add counts as two.
 */
enum {
    PAIR_OPERATIONS = 26,         /* 13 instructions for a pixel and a splat */
    PAIR_BACK_OPERATIONS = 52,    /* 26 */
    ENTRY_BACK_OPERATIONS = 1056, /* 33 of sixteen lanes, to add up the sums of a splat in a tile */
    ENTRY_OPERATIONS = 640,       /* 20 of sixteen lanes, to list a splat in a tile */
    LOSS_OPERATIONS = 668         /* L1 and SSIM with their gradient, for a pixel */
};

/** Kernels of a level: the renderer's and the baseline's. */
typedef struct kernels {
    const adcgs_raster_dsp *raster;
    const adcgs_back_dsp *back;
    const plain_dsp *plain;
} kernels;

typedef struct frame {
    kernels k;
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
} frame;

static kernels kernels_of(adcgs_cpu_level level, int fast)
{
    switch (level) {
#ifdef HAVE_AVX512
    case ADCGS_CPU_AVX512:
        return fast ? (kernels){&bench_fast_raster_avx512, &bench_fast_back_avx512, &plain_avx512}
                    : (kernels){&adcgs_raster_avx512, &adcgs_back_avx512, &plain_avx512};
#endif
#ifdef HAVE_AVX2
    case ADCGS_CPU_AVX2:
        return fast ? (kernels){&bench_fast_raster_avx2, &bench_fast_back_avx2, &plain_avx2}
                    : (kernels){&adcgs_raster_avx2, &adcgs_back_avx2, &plain_avx2};
#endif
    default:
        return (kernels){&adcgs_raster_scalar, &adcgs_back_scalar, &plain_scalar};
    }
}

/* ---- Whole frames ---- */

static void draw(void *arg)
{
    frame *f = arg;
    bench_check(adcgs_raster_forward(f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, 0, NULL), NULL);
}

static void draw_and_back(void *arg)
{
    frame *f = arg;
    bench_check(adcgs_raster_forward(f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, 1, NULL), NULL);
    bench_check(adcgs_raster_backward(f->back, f->raster, &f->primitives, &f->view, background, FILTER, f->rgb, f->grad, &f->to,
                                      NULL),
                NULL);
}

static void loss(void *arg)
{
    frame *f = arg;
    adcgs_loss_value value;
    bench_check(adcgs_loss_image(f->loss, f->rgb, f->target, f->view.width, f->view.height, &(adcgs_loss_shares){0.2f, 0.9f},
                                 f->grads, &value, NULL),
                NULL);
}

/* ---- Stages ---- */

static void project(void *arg)
{
    frame *f = arg;
    f->n = 0;
    for (uint32_t slot = 0; slot < f->primitives.n; slot += 64)
        f->n += f->k.raster->project(&f->project, slot, f->n);
}

static void sort(void *arg)
{
    frame *f = arg;
    memcpy(f->keys, f->project.keys, f->n * sizeof *f->keys);
    f->bin.order = adcgs_sort_keys(f->keys, f->keys + f->primitives.n, f->n);
}

static void list_tiles(void *arg)
{
    frame *f = arg;
    memset(f->counts, 0, (size_t)f->tiles * sizeof *f->counts);
    f->k.raster->bin(&f->bin, 0, f->n, f->counts, f->emitted);
}

static void blend(void *arg)
{
    frame *f = arg;
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.raster->blend(&f->blend, tile);
}

static void blend_back(void *arg)
{
    frame *f = arg;
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.back->blend(&f->gradients, tile);
}

static void project_back(void *arg)
{
    frame *f = arg;
    for (uint32_t slot = 0; slot < f->primitives.n; slot += 64)
        f->k.back->project(&f->gradients, slot);
}

/* ---- The baseline ---- */

static void plain_draw(void *arg)
{
    frame *f = arg;
    project(f);
    sort(f);
    for (uint32_t i = 0; i < f->n; i++)
        f->bin.to[i] = f->bin.from[(uint32_t)f->bin.order[i]];
    f->plain.n = f->n;
    plain_bin(&f->plain);
    for (int tile = 0; tile < f->tiles; tile++)
        f->k.plain->blend(&f->plain, tile);
}

static void plain_draw_and_back(void *arg)
{
    frame *f = arg;
    plain_draw(f);
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
static void compare(frame *f)
{
    const size_t pixels = 3 * (size_t)f->view.width * (size_t)f->view.height, n = (size_t)f->primitives.n * ADCGS_ROWS;
    float *ours = bench_floats(n);
    draw_and_back(f);
    memcpy(ours, f->grads, n * sizeof *ours);
    plain_draw_and_back(f);
    const double rgb = difference(f->rgb, f->target, pixels), gradients = difference(ours, f->grads, n);
    adcgs_free(NULL, ours);
    if (rgb < 0.001 && gradients < 0.1)
        return;
    fprintf(stderr, "adcgs-bench: the baseline differs: images by %g, gradients by %g\n", rgb, gradients);
    exit(1);
}

/* ---- Memory of a frame ---- */

static void make_room(frame *f)
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
static void make_stages(frame *f)
{
    const uint32_t n = f->primitives.n;
    draw_and_back(f);
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
    project(f);
    for (uint32_t i = 0; i < f->n; i++)
        areas += f->project.areas[i];
    f->emitted = (void *)bench_floats(2 * ((size_t)areas + ADCGS_BIN_SLACK));
    sort(f);
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
static void make_plain(frame *f)
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

static void make(frame *f, adcgs_cpu_level level, int threads, int width, int height, uint32_t splats)
{
    static const double origin[3] = {0, 0, 0};
    const adcgs_camera camera = scene_camera(width, height);
    adcgs_error error = {.status = ADCGS_OK};
    *f = (frame){.k = kernels_of(level, 0), .scene = scene_room(splats, OVERLAP, 1)};
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

static void clear(frame *f)
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

/** Pixels of the blocks in which splats are listed, before light runs out. */
static double pairs(const frame *f)
{
    uint64_t blocks = 0;
    for (uint32_t i = 0; i < f->kept.tile_start[f->tiles]; i++)
        blocks += (uint64_t)__builtin_popcount(f->kept.entries[i].mask);
    return 16.0 * (double)blocks;
}

/* ---- Groups ---- */

static void whole(const bench *b, frame *f, bench_place place)
{
    const double pixels = (double)place.width * place.height;
    place.group = "frame";
    if (place.threads > 1) { /* the baseline has one thread */
        bench_group(b, &place, &(bench_item){"draw", draw, f, pixels, "pixel", 0}, 1, 0);
        place.group = "frame and gradients";
        bench_group(b, &place, &(bench_item){"draw and back", draw_and_back, f, pixels, "pixel", 0}, 1, 0);
    } else {
        const bench_item frames[] = {{"draw", draw, f, pixels, "pixel", 0}, {"baseline", plain_draw, f, pixels, "pixel", 0}};
        bench_group(b, &place, frames, 2, 1);
        const bench_item gradients[] = {{"draw and back", draw_and_back, f, pixels, "pixel", 0},
                                        {"baseline", plain_draw_and_back, f, pixels, "pixel", 0}};
        place.group = "frame and gradients";
        bench_group(b, &place, gradients, 2, 1);
    }
    place.group = "loss";
    bench_group(b, &place, &(bench_item){"L1 and SSIM", loss, f, pixels, "pixel", LOSS_OPERATIONS}, 1, 0);
}

static void stages(const bench *b, frame *f, bench_place place)
{
    const double n = f->n, listed = f->kept.tile_start[f->tiles], drawn = pairs(f);
    const double back = (drawn * PAIR_BACK_OPERATIONS + listed * ENTRY_BACK_OPERATIONS) / drawn;
    /* Restore the sums of the kept frame: other items have run since. */
    draw_and_back(f);
    project(f);
    sort(f);
    const bench_item items[] = {{"project", project, f, n, "splat", 0},
                                {"sort by depth", sort, f, n, "splat", 0},
                                {"list tiles", list_tiles, f, listed, "entry", ENTRY_OPERATIONS},
                                {"blend", blend, f, drawn, "pair", PAIR_OPERATIONS},
                                {"gradients of blend", blend_back, f, drawn, "pair", back},
                                {"gradients of project", project_back, f, n, "splat", 0}};
    place.group = "stages";
    bench_group(b, &place, items, ADCGS_COUNTOF(items), 0);
}

void bench_frames(const bench *b, int width, int height, uint32_t splats)
{
    if (!bench_wants(b, "frame") && !bench_wants(b, "stages") && !bench_wants(b, "loss"))
        return;
    for (int threads = 1; threads <= b->threads; threads = bench_more_threads(b, threads)) {
        frame f;
        make(&f, b->level, threads, width, height, splats);
        const bench_place place = {.width = width, .height = height, .splats = splats, .threads = threads};
        whole(b, &f, place);
        if (threads == 1)
            stages(b, &f, place);
        clear(&f);
    }
}

/** Runs all kernels of a frame one after the other. */
static void all_kernels(void *arg)
{
    project(arg);
    list_tiles(arg);
    blend(arg);
    blend_back(arg);
    project_back(arg);
}

static void exactness(const bench *b, bench_place place)
{
    frame exact, fast;
    if (b->level == ADCGS_CPU_SCALAR)
        return;
    make(&exact, b->level, 1, place.width, place.height, place.splats);
    make(&fast, b->level, 1, place.width, place.height, place.splats);
    fast.k = kernels_of(b->level, 1);
    const bench_item items[] = {{"not exact", all_kernels, &fast, exact.n, "splat", 0},
                                {"exact", all_kernels, &exact, exact.n, "splat", 0}};
    place.group = "exactness";
    bench_group(b, &place, items, 2, 1);
    clear(&fast);
    clear(&exact);
}

void bench_levels(const bench *b)
{
    bench_place place = {.group = "levels", .width = 400, .height = 400, .splats = 20000, .threads = 1};
    if (bench_wants(b, "exactness"))
        exactness(b, place);
    if (!bench_wants(b, "levels"))
        return;
    frame frames[ADCGS_CPU_AVX512 + 1];
    bench_item items[ADCGS_CPU_AVX512 + 1];
    int n = 0;
    for (int level = (int)b->level; level >= ADCGS_CPU_SCALAR; level--, n++) {
        make(&frames[n], (adcgs_cpu_level)level, 1, place.width, place.height, place.splats);
        items[n] = (bench_item){adcgs_cpu_name((adcgs_cpu_level)level), draw_and_back, &frames[n], place.splats, "splat", 0};
    }
    bench_group(b, &place, items, n, 1);
    while (n-- > 0)
        clear(&frames[n]);
}
