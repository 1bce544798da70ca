/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A float model with random values, for the tests of the rate. */
#ifndef ADCGS_TESTS_RATE_FIXTURE_H
#define ADCGS_TESTS_RATE_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fmodel/pass.h"
#include "grad/random.h"

enum { ANCHORS = 150 };

static adcgs_error error;

typedef struct fixture {
    adcgs_fmodel *f;
    adcgs_pass *pass;
} fixture;

static inline void randomise(float *p, size_t n, double size, uint64_t stream)
{
    for (size_t i = 0; i < n; i++)
        p[i] = (float)(size * adcgs_random_normal(7, stream, i));
}

static inline void set_rounding(adcgs_fmodel *f)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (f->mlp[i].n)
            adcgs_mlp_prepare(&f->mlp[i], f->param[i].p, 1);
}

/** A random model whose entropy networks have `hidden` layers and weights about `size`. */
static inline void make(fixture *x, adcgs_cpu_level cpu, int hidden, double size, int adaptive)
{
    const adcgs_params params = {.k = 3,
                                 .n_fv = 9,
                                 .n_fg = 8,
                                 .chunks = 4,
                                 .n_eta = 3,
                                 .octaves = 2,
                                 .adaptive_steps = (uint8_t)adaptive,
                                 .time_rows = 3,
                                 .time_width = 2};
    const adcgs_shape shape = {.theta_width = 6,
                               .theta_hidden = 2,
                               .omega_width = 5,
                               .omega_hidden = 1,
                               .varpi_width = 5,
                               .varpi_hidden = 1,
                               .entropy_width = 11,
                               .entropy_hidden = hidden,
                               .step_fv = 0.1f,
                               .step_fg = 0.07f,
                               .step_sigma = 0.03f,
                               .step_colour = 0.05f,
                               .depth = 8};
    const float origin[3] = {-1, -1, -1};
    static uint32_t pos[ANCHORS][3];
    for (uint32_t i = 0; i < ANCHORS; i++)
        pos[i][0] = i;
    assert_int_equal(adcgs_fmodel_create(&x->f, &params, &shape, origin, 1.0f / 128, (const uint32_t(*)[3])pos, ANCHORS, 3,
                                         &error),
                     ADCGS_OK);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        if (i != ADCGS_P_STEP)
            randomise(x->f->param[i].p, x->f->param[i].n, i < ADCGS_P_ANCHOR ? 0.7 : size, (uint64_t)i);
    for (size_t i = 0; i < x->f->param[ADCGS_P_ETA].n; i++)
        x->f->param[ADCGS_P_ETA].p[i] *= 30; /* eta's step is 1 */
    x->f->keep[1 * 64 + 9] = x->f->keep[2 * 64 + 63] = 0;
    x->f->moving[5] = 0;
    set_rounding(x->f);
    assert_int_equal(adcgs_pass_create(&x->pass, x->f, cpu, NULL, &error), ADCGS_OK);
}

static inline void clear(fixture *x)
{
    adcgs_pass_free(&x->pass);
    adcgs_fmodel_free(&x->f);
}

#endif
