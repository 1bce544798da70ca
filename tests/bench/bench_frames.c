/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames: rendering of splats and its gradients, complete and by stages, at each CPU level. */
#include "config.h"

#include "bench_frame.h"
#include "bench_parts.h"

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

/** Pixels of the blocks in which splats are listed, before light runs out. */
static double pairs(const bench_frame *f)
{
    uint64_t blocks = 0;
    for (uint32_t i = 0; i < f->kept.tile_start[f->tiles]; i++)
        blocks += (uint64_t)__builtin_popcount(f->kept.entries[i].mask);
    return 16.0 * (double)blocks;
}

/* ---- Groups ---- */

static void whole(const bench *b, bench_frame *f, bench_place place)
{
    const double pixels = (double)place.width * place.height;
    place.group = "frame";
    if (place.threads > 1) { /* the baseline has one thread */
        bench_group(b, &place, &(bench_item){"draw", bench_frame_draw, f, pixels, "pixel", 0}, 1, 0);
        place.group = "frame and gradients";
        bench_group(b, &place, &(bench_item){"draw and back", bench_frame_draw_and_back, f, pixels, "pixel", 0}, 1, 0);
    } else {
        const bench_item frames[] = {{"draw", bench_frame_draw, f, pixels, "pixel", 0},
                                     {"baseline", bench_frame_plain_draw, f, pixels, "pixel", 0}};
        bench_group(b, &place, frames, 2, 1);
        const bench_item gradients[] = {{"draw and back", bench_frame_draw_and_back, f, pixels, "pixel", 0},
                                        {"baseline", bench_frame_plain_draw_and_back, f, pixels, "pixel", 0}};
        place.group = "frame and gradients";
        bench_group(b, &place, gradients, 2, 1);
    }
    place.group = "loss";
    bench_group(b, &place, &(bench_item){"L1 and SSIM", bench_frame_loss, f, pixels, "pixel", LOSS_OPERATIONS}, 1, 0);
}

static void stages(const bench *b, bench_frame *f, bench_place place)
{
    const double n = f->n, listed = f->kept.tile_start[f->tiles], drawn = pairs(f);
    const double back = (drawn * PAIR_BACK_OPERATIONS + listed * ENTRY_BACK_OPERATIONS) / drawn;
    /* Restore the sums of the kept frame: other items have run since. */
    bench_frame_draw_and_back(f);
    bench_frame_project(f);
    bench_frame_sort(f);
    const bench_item items[] = {{"project", bench_frame_project, f, n, "splat", 0},
                                {"sort by depth", bench_frame_sort, f, n, "splat", 0},
                                {"list tiles", bench_frame_list_tiles, f, listed, "entry", ENTRY_OPERATIONS},
                                {"blend", bench_frame_blend, f, drawn, "pair", PAIR_OPERATIONS},
                                {"gradients of blend", bench_frame_blend_back, f, drawn, "pair", back},
                                {"gradients of project", bench_frame_project_back, f, n, "splat", 0}};
    place.group = "stages";
    bench_group(b, &place, items, ADCGS_COUNTOF(items), 0);
}

void bench_frames(const bench *b, int width, int height, uint32_t splats)
{
    if (!bench_wants(b, "frame") && !bench_wants(b, "stages") && !bench_wants(b, "loss"))
        return;
    for (int threads = 1; threads <= b->threads; threads = bench_more_threads(b, threads)) {
        bench_frame f;
        bench_frame_make(&f, b->level, threads, width, height, splats);
        const bench_place place = {.width = width, .height = height, .splats = splats, .threads = threads};
        whole(b, &f, place);
        if (threads == 1)
            stages(b, &f, place);
        bench_frame_clear(&f);
    }
}

/** Runs all kernels of a frame one after the other. */
static void all_kernels(void *arg)
{
    bench_frame_project(arg);
    bench_frame_list_tiles(arg);
    bench_frame_blend(arg);
    bench_frame_blend_back(arg);
    bench_frame_project_back(arg);
}

static void exactness(const bench *b, bench_place place)
{
    bench_frame exact, fast;
    if (b->level == ADCGS_CPU_SCALAR)
        return;
    bench_frame_make(&exact, b->level, 1, place.width, place.height, place.splats);
    bench_frame_make(&fast, b->level, 1, place.width, place.height, place.splats);
    fast.k = bench_frame_kernels_of(b->level, 1);
    const bench_item items[] = {{"not exact", all_kernels, &fast, exact.n, "splat", 0},
                                {"exact", all_kernels, &exact, exact.n, "splat", 0}};
    place.group = "exactness";
    bench_group(b, &place, items, 2, 1);
    bench_frame_clear(&fast);
    bench_frame_clear(&exact);
}

void bench_levels(const bench *b)
{
    bench_place place = {.group = "levels", .width = 400, .height = 400, .splats = 20000, .threads = 1};
    if (bench_wants(b, "exactness"))
        exactness(b, place);
    if (!bench_wants(b, "levels"))
        return;
    bench_frame frames[ADCGS_CPU_AVX512 + 1];
    bench_item items[ADCGS_CPU_AVX512 + 1];
    int n = 0;
    for (int level = (int)b->level; level >= ADCGS_CPU_SCALAR; level--, n++) {
        bench_frame_make(&frames[n], (adcgs_cpu_level)level, 1, place.width, place.height, place.splats);
        items[n] =
            (bench_item){adcgs_cpu_name((adcgs_cpu_level)level), bench_frame_draw_and_back, &frames[n], place.splats, "splat", 0};
    }
    bench_group(b, &place, items, n, 1);
    while (n-- > 0)
        bench_frame_clear(&frames[n]);
}
