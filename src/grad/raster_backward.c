/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Backward pass of the renderer: one row of sums per (splat, tile) pair, then per slot the rows of its splat in the order of the
 * pairs. No two threads add to the same place, so the result is the same for any number of threads.
 */
#include "config.h"

#include "grad/raster_backward_isa.h"

/* Slots per job of the back-projection; chosen by hand, not measured. */
#define PROJECT_PIECE 512u

struct adcgs_raster_back {
    adcgs_back_dsp dsp;
    adcgs_pool *pool;
    float *sums;
    size_t entries; /* allocated entries of sums */
    adcgs_back_job job;
};

adcgs_status adcgs_raster_back_create(adcgs_raster_back **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_cpu_level level;
    *out = NULL;
    ADCGS_TRY(adcgs_cpu_resolve(cpu, &level, error));
    adcgs_raster_back *b = adcgs_alloc(NULL, 1, sizeof *b, error);
    if (!b)
        return error ? error->status : adcgs_alloc_status(error);
    b->pool = pool;
    b->dsp = adcgs_back_scalar;
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        b->dsp = adcgs_back_avx2;
#endif
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        b->dsp = adcgs_back_avx512;
#endif
    *out = b;
    return ADCGS_OK;
}

void adcgs_raster_back_free(adcgs_raster_back **back)
{
    adcgs_raster_back *b = *back;
    if (!b)
        return;
    adcgs_free(NULL, b->sums);
    adcgs_free(NULL, b);
    *back = NULL;
}

static void blend_tile(void *arg, int index, int thread)
{
    const adcgs_raster_back *b = arg;
    b->dsp.blend(&b->job, index);
}

static void project_piece(void *arg, int index, int thread)
{
    const adcgs_raster_back *b = arg;
    const uint32_t begin = (uint32_t)index * PROJECT_PIECE, end = ADCGS_MIN(begin + PROJECT_PIECE, b->job.kept.n_slots);
    for (uint32_t slot = begin; slot < end; slot += 64)
        b->dsp.project(&b->job, slot);
}

static adcgs_status grow_entries(adcgs_raster_back *b, size_t entries, adcgs_error *error)
{
    if (entries <= b->entries)
        return ADCGS_OK;
    adcgs_free(NULL, b->sums);
    b->entries = 0;
    b->sums = adcgs_alloc(NULL, entries + entries / 4, SUM_WORDS * sizeof(float), error);
    if (!b->sums)
        return error ? error->status : adcgs_alloc_status(error);
    b->entries = entries + entries / 4;
    return ADCGS_OK;
}

adcgs_status adcgs_raster_backward(adcgs_raster_back *b, const adcgs_raster *raster, const adcgs_primitives *primitives,
                                   const adcgs_view *view, const float background[3], float screen_filter, const float *rgb,
                                   const float *grad, adcgs_raster_grads *out, adcgs_error *error)
{
    adcgs_kept kept;
    adcgs_raster_kept(raster, &kept);
    if (!kept.where || kept.n_slots != primitives->n)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "backward: the last forward pass kept no data for %u slots", primitives->n);
    const int tiles = kept.tiles_x * kept.tiles_y;
    ADCGS_TRY(grow_entries(b, kept.tile_start[tiles], error));
    b->job = (adcgs_back_job){.kept = kept,
                              .primitives = primitives,
                              .view = view,
                              .filter = screen_filter,
                              .rgb = rgb,
                              .grad = grad,
                              .sums = b->sums,
                              .out = *out};
    adcgs_pool_run(b->pool, blend_tile, b, tiles);
    adcgs_pool_run(b->pool, project_piece, b, (int)((kept.n_slots + PROJECT_PIECE - 1) / PROJECT_PIECE));
    return ADCGS_OK;
}
