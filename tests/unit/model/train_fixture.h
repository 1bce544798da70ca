/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A float model with random parameters, and the comparison of gradients with central differences. */
#ifndef ADCGS_TESTS_TRAIN_FIXTURE_H
#define ADCGS_TESTS_TRAIN_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "train_reference.h"

#include "fmodel/body_trajectories.h"
#include "fmodel/pass.h"
#include "grad/random.h"

#include <math.h>
#include <stdlib.h>

typedef struct fixture {
    adcgs_fmodel *f;
    adcgs_pass *pass;
} fixture;

static inline void randomise(float *p, size_t n, double size, uint64_t stream)
{
    for (size_t i = 0; i < n; i++)
        p[i] += (float)(size * adcgs_random_normal(7, stream, i));
}

/** Lifetimes all over the segment and beyond it. Some are so far away that their times have no gradient. */
static inline void spread_lives(adcgs_fmodel *f)
{
    for (uint32_t a = 0; a < f->n; a++) {
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, a, ADCGS_SPAN_MIDDLE) = 8 * ((float)(a % 13) / 10 - 0.6f);
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, a, ADCGS_SPAN_PACE) = a == 8 ? 9.0f : (float)(a % 7) / 3 - 0.5f;
    }
}

/** The state is a CPU level, optionally with WITH_SPANS, which adds lifetimes and bodies. */
enum { WITH_SPANS = 16 };

/** Two bodies, with anchors of no body among theirs. */
static inline void spread_bodies(adcgs_fmodel *f)
{
    const size_t columns = (size_t)adcgs_fmodel_time_columns(&f->params), width = f->params.time_width;
    for (uint32_t a = 0; a < f->n; a++)
        f->body[a] = (uint8_t)(a % 3);
    for (size_t r = 0; r < f->params.time_rows; r++)
        randomise(f->param[ADCGS_P_TIME].p + r * columns + width, columns - width, 8, 99 + r);
    adcgs_bodies_recentre(f);
}

static inline int setup(void **state)
{
    const int spans = (uintptr_t)*state >= WITH_SPANS;
    const adcgs_params params = {.k = K,
                                 .n_fv = NV,
                                 .n_fg = NG,
                                 .chunks = CHUNKS,
                                 .n_eta = ETA,
                                 .octaves = OCTAVES,
                                 .fine_uses_fv = 1,
                                 .coarse_rotation = 1,
                                 .adaptive_steps = 1,
                                 .spans = (uint8_t)spans,
                                 .bodies = spans ? 2 : 0,
                                 .smooth_time = (uint8_t)spans,
                                 .time_rows = 4,
                                 .time_width = 3};
    const adcgs_shape shape = {.theta_width = 6,
                               .theta_hidden = 2,
                               .omega_width = 5,
                               .omega_hidden = 3,
                               .varpi_width = 6,
                               .varpi_hidden = 2,
                               .entropy_width = 6,
                               .entropy_hidden = 2,
                               .step_fv = 0.1f,
                               .step_fg = 0.2f,
                               .step_sigma = 0.1f,
                               .step_colour = 0.05f,
                               .depth = 8};
    const float origin[3] = {-1, -1, -1};
    static uint32_t pos[ANCHORS][3];
    for (uint32_t i = 0; i < ANCHORS; i++)
        pos[i][0] = i, pos[i][1] = 3 * i % 200, pos[i][2] = 7 * i % 200;
    fixture *x = calloc(1, sizeof *x);
    adcgs_error error;
    assert_int_equal(adcgs_fmodel_create(&x->f, &params, &shape, origin, 1.0f / 128, (const uint32_t(*)[3])pos, ANCHORS, 3,
                                         &error),
                     ADCGS_OK);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        randomise(x->f->param[i].p, x->f->param[i].n, i < ADCGS_P_ANCHOR ? 0.4 : 0.15, (uint64_t)i);
    x->f->moving[5] = 0;
    if (spans)
        spread_bodies(x->f);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        if (x->f->mlp[i].n)
            adcgs_mlp_prepare(&x->f->mlp[i], x->f->param[i].p, 0);
    }
    adcgs_fmodel_take_steps(x->f);
    if (spans)
        spread_lives(x->f);
    x->f->keep[1 * 64 + 9] = 0;
    const adcgs_cpu_level level = (adcgs_cpu_level)((uintptr_t)*state % WITH_SPANS);
    assert_int_equal(adcgs_pass_create(&x->pass, x->f, level, NULL, &error), ADCGS_OK);
    *state = x;
    return 0;
}

static inline int teardown(void **state)
{
    fixture *x = *state;
    adcgs_pass_free(&x->pass);
    adcgs_fmodel_free(&x->f);
    free(x);
    return 0;
}

/** A fixed random weight for value v of a slot. The tested gradient is that of the weighted sum of all primitives. */
static inline double weight_of(size_t slot, int v)
{
    return adcgs_random_normal(11, (uint64_t)v, slot);
}

static inline double ref_sum(const adcgs_fmodel *f, double t)
{
    double sum = 0, p[VALUES];
    for (uint32_t a = 0; a < f->n; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            ref_primitive(f, a, k, t, p);
            for (int v = 0; v < VALUES; v++)
                sum += weight_of(slot, v) * p[v];
        }
    return sum;
}

typedef double (*scalar_fn)(const adcgs_fmodel *f);

static inline double distortion(const adcgs_fmodel *f)
{
    return ref_sum(f, 0.4f);
}

/** Compares gradients of a sample of each group's parameters with central differences of fn. */
static inline void check_gradients(adcgs_fmodel *f, scalar_fn fn, int first_group)
{
    for (int g = first_group; g < ADCGS_P_COUNT; g++) {
        const adcgs_param *p = &f->param[g];
        double size = 0;
        for (size_t i = 0; i < p->n; i++)
            size = fmax(size, fabs(p->g[i]));
        if (!p->n)
            continue;
        for (int trial = 0; trial < 24; trial++) {
            const size_t i = (size_t)(adcgs_random_unit(5, (uint64_t)g, (uint64_t)trial) * (double)p->n);
            const float keep = p->p[i], h = g == ADCGS_P_STEP ? 1e-3f : 1e-4f;
            p->p[i] = keep + h;
            adcgs_fmodel_take_steps(f);
            const double hi = p->p[i], up = fn(f);
            p->p[i] = keep - h;
            adcgs_fmodel_take_steps(f);
            const double lo = p->p[i], down = fn(f);
            p->p[i] = keep;
            adcgs_fmodel_take_steps(f);
            const double want = (up - down) / (hi - lo);
            if (fabs(p->g[i] - want) > 2e-3 * size + 1e-3 * fabs(want))
                fail_msg("%s[%zu]: gradient %g, differences %g (largest %g)", p->name, i, (double)p->g[i], want, size);
        }
    }
}

static inline void clear_gradients(adcgs_fmodel *f)
{
    for (int g = 0; g < ADCGS_P_COUNT; g++)
        memset(f->param[g].g, 0, f->param[g].n * sizeof(float));
}

#endif
