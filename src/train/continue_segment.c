/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Continuation of the previous segment. */
#include "train/continue_segment.h"

#include "fmodel/from_model.h"
#include "train/continue_bodies.h"
#include "train/initialise.h"

#include <math.h>

#define GONE 0.05f /* presence below which an anchor's lifetime has ended; chosen by hand, not measured */
/* Presence at both ends of a segment, from which a lifetime covers it; chosen by hand, not measured. */
#define LIVES 0.9f
/*
 * Scene units of motion by the anchor's velocity, below which its position is the same in both segments; chosen by hand, not
 * measured.
 */
#define STRAYS 4e-3

/** True if an anchor lives through the whole segment without velocity, so that the next segment can share it. */
static int lives_whole(const adcgs_fmodel *f, uint32_t i)
{
    double way = 0;
    for (int a = 0; a < 3; a++)
        way = fmax(way, fabs((double)*adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_VELOCITY + a)) / 8);
    return adcgs_fmodel_presence(f, i, 0) > LIVES && adcgs_fmodel_presence(f, i, 1) > LIVES && way < STRAYS;
}

/**
 * Converts a lifetime to the time of the new segment: t of the previous segment is from + ratio t. Presence and motion are
 * functions of u, which is unchanged.
 */
static void shift_life(adcgs_fmodel *f, uint32_t i, double from, double ratio)
{
    float *middle = adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_MIDDLE);
    float *pace = adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_PACE);
    const double t = (double)*middle / 8 + 0.5;
    *middle = (float)(8 * ((t - from) / ratio - 0.5));
    *pace += (float)log(ratio);
    f->trainable[i] = 1;
}

static void go_on_living(adcgs_fmodel *f, double from, double ratio)
{
    for (uint32_t i = 0; f->params.spans && i < f->n; i++)
        if (f->moving[i] != 0 && !lives_whole(f, i))
            shift_life(f, i, from, ratio);
}

/**
 * Starts the time table at time `from` of the previous one. In pose columns, row 1 and later rows continue the motion by one row.
 */
static void start_time_table(adcgs_fmodel *f, double from)
{
    const size_t width = f->params.time_width, columns = (size_t)adcgs_fmodel_time_columns(&f->params);
    const size_t rows = f->params.time_rows;
    float *z = f->param[ADCGS_P_TIME].p;
    if (rows < 2)
        return;
    const double at = from * (double)(rows - 1);
    const size_t row = ADCGS_MIN((size_t)at, rows - 2);
    const float rest = (float)(at - (double)(row + 1)); /* 0 at the end */
    for (size_t i = 0; i < columns; i++) {
        const float next = z[(row + 1) * columns + i], way = next - z[row * columns + i];
        for (size_t r = 0; r < rows; r++)
            z[r * columns + i] = next + rest * way + (i < width ? 0 : (float)ADCGS_MIN(r, 1) * way);
    }
}

/** Removes anchors whose lifetime has ended; at least one stays. */
static adcgs_status drop_dead(adcgs_fmodel *f, adcgs_error *error)
{
    uint32_t(*pos)[3] = adcgs_alloc(NULL, f->n, sizeof *pos, error);
    uint32_t *source = adcgs_alloc(NULL, f->n, sizeof *source, error), n = 0;
    adcgs_status status = pos && source ? ADCGS_OK : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < f->n; i++)
        if (f->trainable[i] == 0 || fmaxf(adcgs_fmodel_presence(f, i, 0), adcgs_fmodel_presence(f, i, 0.5f)) > GONE ||
            (n == 0 && i + 1 == f->n)) {
            memcpy(pos[n], f->pos[i], sizeof pos[n]);
            source[n++] = i;
        }
    if (status == ADCGS_OK)
        status = adcgs_fmodel_regroup(f, (const uint32_t(*)[3])pos, source, NULL, n, error);
    adcgs_free(NULL, pos);
    adcgs_free(NULL, source);
    return status;
}

adcgs_status adcgs_continue_segment(adcgs_fmodel **out, const adcgs_model *before, const adcgs_train_config *config,
                                    adcgs_stereo *found, double duration, adcgs_cpu_level cpu, adcgs_error *error)
{
    const double end = before->time_end - before->time_start, then = end + before->reach;
    const double from = then > 0 ? end / then : 1, ratio = then > 0 && duration > 0 ? duration / then : 1;
    ADCGS_TRY(adcgs_fmodel_from_model(out, before, &config->shape, config->seed, cpu, error));
    go_on_living(*out, from, ratio);
    start_time_table(*out, from);
    ADCGS_TRY(adcgs_continue_bodies(*out, found, error));
    adcgs_set_poses(*out, found);
    return drop_dead(*out, error);
}
