/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The baseline: lists of the splats in each tile. */
#include "plain.h"

#include "measure.h"

#include <math.h>
#include <stdlib.h>

void plain_init(plain_job *job, uint32_t most)
{
    const size_t tiles = (size_t)job->tiles_x * (size_t)job->tiles_y;
    job->start = calloc(tiles + 2, sizeof *job->start);
    job->tiles = (void *)bench_floats(tiles * sizeof *job->tiles / sizeof(float));
    job->sums = bench_floats((size_t)most * SUM_WORDS);
    job->list = NULL;
    job->list_room = 0;
    bench_check(job->start ? ADCGS_OK : ADCGS_ERR_MEMORY, NULL);
}

void plain_clear(plain_job *job)
{
    free(job->start);
    free(job->list);
    adcgs_free(NULL, job->tiles);
    adcgs_free(NULL, job->sums);
}

/** Tiles of the square around the circle of three standard deviations: [x0, x1) x [y0, y1). */
static void tiles_of(const plain_job *job, const adcgs_splat2d *s, int tile[4])
{
    /* The conic is scaled by -log2(e) / 2. The larger radius follows from the smaller eigenvalue of the inverse covariance. */
    const float a = -1.3862944f * s->a, b = -0.6931472f * s->b, c = -1.3862944f * s->c;
    const float half = 0.5f * (a + c), least = half - sqrtf(fmaxf(0, half * half - a * c + b * b));
    const float radius = ceilf(3 / sqrtf(fmaxf(least, 1e-12f)));
    tile[0] = (int)fminf(fmaxf((s->x - radius) / 16, 0), (float)job->tiles_x);
    tile[1] = (int)fminf(fmaxf((s->y - radius) / 16, 0), (float)job->tiles_y);
    tile[2] = (int)fminf(fmaxf((s->x + radius) / 16 + 1, 0), (float)job->tiles_x);
    tile[3] = (int)fminf(fmaxf((s->y + radius) / 16 + 1, 0), (float)job->tiles_y);
}

void plain_bin(plain_job *job)
{
    const int tiles = job->tiles_x * job->tiles_y;
    uint32_t *start = job->start;
    int tile[4];
    memset(start, 0, ((size_t)tiles + 2) * sizeof *start);
    for (uint32_t i = 0; i < job->n; i++) {
        tiles_of(job, job->splats + i, tile);
        for (int y = tile[1]; y < tile[3]; y++)
            for (int x = tile[0]; x < tile[2]; x++)
                start[y * job->tiles_x + x + 2]++;
    }
    for (int t = 0; t < tiles; t++)
        start[t + 2] += start[t + 1];
    if (start[tiles + 1] > job->list_room) {
        free(job->list);
        job->list_room = start[tiles + 1];
        job->list = malloc(job->list_room * sizeof *job->list);
        bench_check(job->list ? ADCGS_OK : ADCGS_ERR_MEMORY, NULL);
    }
    for (uint32_t i = 0; i < job->n; i++) {
        tiles_of(job, job->splats + i, tile);
        for (int y = tile[1]; y < tile[3]; y++)
            for (int x = tile[0]; x < tile[2]; x++)
                job->list[start[y * job->tiles_x + x + 1]++] = i;
    }
}
