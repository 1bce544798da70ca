/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The rate in training against the coder: after rounding, bits, means and levels of the float twins equal those of the integer
 * networks and tables; before, the smooth rate is close to them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rate_fixture.h"

#include "encode/quantise.h"
#include "fmodel/pass.h"
#include "grad/random.h"

#include <stdlib.h>

/* ---- The coder ---- */

typedef struct counter {
    const adcgs_model *model;
    double bits[ADCGS_GROUPS];
    int levels[ADCGS_SIGMA_LEVELS];
} counter;

static void count_site(void *user, const adcgs_latent_site *s)
{
    counter *c = user;
    for (int i = 0; i < s->count; i++) {
        c->levels[s->si[i]]++;
        if (s->si[i])
            c->bits[s->group] += adcgs_value_cost(s->si[i], (s->yq[i] - s->mu[i]) / 64) * 0x1p-16;
    }
}

/** Bits of a model by group, from the integer networks and the tables of the decoder. */
static void count_bits(counter *c, adcgs_model *model)
{
    adcgs_latents *latents;
    *c = (counter){.model = model};
    assert_int_equal(adcgs_latents_create(&latents, model, ADCGS_CPU_SCALAR, NULL, &error), ADCGS_OK);
    for (int layer = 0; layer < model->layers; layer++)
        assert_int_equal(adcgs_latents_walk(latents, model, layer, 0, model->n, count_site, c, NULL), ADCGS_OK);
    adcgs_latents_free(&latents);
}

/** True if value i of a parameter group belongs to an existing anchor and primitive. */
static int is_coded(const adcgs_fmodel *f, int group, size_t i)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group), g = i / (rows * 64), row = i / 64 % rows;
    if (group == ADCGS_P_FG)
        return f->keep[(g * f->params.k + row / f->params.n_fg) * 64 + i % 64] != 0;
    return f->live[g * 64 + i % 64] != 0;
}

/** The twins' means and bits equal the coder's, for ordinary arithmetic and where all values are at their bounds. */
static void twins_are_exact(void **state)
{
    static const struct {
        int hidden;
        double size;
    } cases[] = {{1, 0.2}, {2, 0.2}, {3, 0.1}, {1, 3}, {2, 30}};
    int levels[ADCGS_SIGMA_LEVELS] = {0}, used = 0;
    for (size_t i = 0; i < 2 * ADCGS_COUNTOF(cases); i++) {
        fixture x;
        adcgs_model model;
        adcgs_rate rate;
        counter real;
        float *mu[ADCGS_P_ANCHOR];
        make(&x, (adcgs_cpu_level)(uintptr_t)*state, cases[i / 2].hidden, cases[i / 2].size, i % 2);
        const size_t factors = x.f->groups * (size_t)adcgs_params_steps(&x.f->params) * 64;
        float *factor = calloc(factors + 1, sizeof *factor);
        for (int g = 0; g < ADCGS_P_ANCHOR; g++)
            mu[g] = calloc(x.f->param[g].n, sizeof(float));
        const adcgs_quantise_options options = {.cpu = ADCGS_CPU_SCALAR, .mu = mu, .factor = factor};
        assert_int_equal(adcgs_quantise(&model, x.f, &options, &error), ADCGS_OK);
        count_bits(&real, &model);
        adcgs_pass_rate(x.pass, x.f, &rate);
        for (int g = 0; g < ADCGS_GROUPS; g++)
            assert_float_equal(rate.bits[g], real.bits[g], 1e-5 * real.bits[g]);
        for (int g = 0; g < ADCGS_P_ANCHOR; g++) {
            for (size_t j = 0; j < x.f->param[g].n; j++)
                if (is_coded(x.f, g, j) && x.pass->mu[g][j] != mu[g][j])
                    fail_msg("case %zu, %s[%zu]: mean %g, the coder has %g", i, x.f->param[g].name, j, (double)x.pass->mu[g][j],
                             (double)mu[g][j]);
            free(mu[g]);
        }
        for (size_t j = 0; j < factors; j++)
            if (x.f->live[j / 64 / (size_t)adcgs_params_steps(&x.f->params) * 64 + j % 64] != 0)
                assert_true(factor[j] == x.pass->factor[j]);
        free(factor);
        for (int l = 0; l < ADCGS_SIGMA_LEVELS; l++)
            levels[l] += real.levels[l];
        adcgs_model_clear(&model, NULL);
        clear(&x);
    }
    for (int l = 0; l < ADCGS_SIGMA_LEVELS; l++)
        used += levels[l] > 0;
    assert_int_equal(used, ADCGS_SIGMA_LEVELS);
}

/**
 * The rounded values in training equal the stream's, including values that the stream cannot hold: far from zero or from their
 * means, or at level 0.
 */
static void rounded_values_are_the_coders(void **state)
{
    static const double sizes[] = {0.2, 3, 30};
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        fixture x;
        adcgs_model model;
        adcgs_rate rate;
        float *value[ADCGS_P_ANCHOR];
        make(&x, (adcgs_cpu_level)(uintptr_t)*state, 1, sizes[i], 1);
        for (int r = 0; r < adcgs_fmodel_rows(x.f, ADCGS_P_FV); r += 2)
            x.f->step[ADCGS_P_FV][r] = 0.001f;
        for (int g = 0; g < ADCGS_P_ANCHOR; g++)
            value[g] = calloc(x.f->param[g].n, sizeof(float));
        assert_int_equal(adcgs_quantise(&model, x.f, &(adcgs_quantise_options){.value = value}, &error), ADCGS_OK);
        adcgs_pass_rate(x.pass, x.f, &rate);
        adcgs_pass_forward(x.pass, x.f, 0.5f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_ROUND});
        for (int g = 0; g < ADCGS_P_ANCHOR; g++) {
            for (size_t j = 0; j < x.f->param[g].n; j++)
                if (is_coded(x.f, g, j))
                    assert_float_equal(x.pass->used[g][j], value[g][j], 1e-5 * fabs((double)value[g][j]));
            free(value[g]);
        }
        adcgs_model_clear(&model, NULL);
        clear(&x);
    }
}

/** Steps are widened only where a value would be beyond the range of a stream. */
static void steps_reach_all_values(void **state)
{
    fixture x;
    make(&x, (adcgs_cpu_level)(uintptr_t)*state, 1, 0.2, 0);
    const float fine = 0.001f, ordinary = x.f->step[ADCGS_P_FG][3];
    const int at = adcgs_fmodel_step_at(x.f, ADCGS_P_FG, 2);
    *adcgs_fmodel_at(x.f, ADCGS_P_FG, 100, 8 + 2) = -40; /* channel 2 of the second primitive */
    x.f->param[ADCGS_P_STEP].p[at] = logf(fine);
    adcgs_fmodel_widen_steps(x.f);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(x.f->step[ADCGS_P_FG][8 * k + 2], 40.0 / 480, 1e-4);
        assert_float_equal(x.f->step[ADCGS_P_FG][8 * k + 3], ordinary, 1e-6);
    }
    clear(&x);
}

/** Rates of parts of the groups sum to the rate of all groups, with noise and after rounding. */
static void parts_add_up(void **state)
{
    enum { PERIOD = 2 };
    static const adcgs_quant modes[] = {ADCGS_QUANT_NONE, ADCGS_QUANT_ROUND};
    fixture x;
    make(&x, (adcgs_cpu_level)(uintptr_t)*state, 1, 0.2, 1);
    for (size_t i = 0; i < ADCGS_COUNTOF(modes); i++) {
        adcgs_rate all, part;
        double sum[ADCGS_GROUPS] = {0};
        adcgs_pass_forward(x.pass, x.f, 0.5f, &(adcgs_pass_mode){.quant = modes[i]});
        adcgs_pass_backward(x.pass, x.f, 0, 1, 1, 0, &all);
        for (int first = 0; first < PERIOD; first++) {
            adcgs_pass_backward(x.pass, x.f, 0, 1, PERIOD, first, &part);
            for (int g = 0; g < ADCGS_GROUPS; g++)
                sum[g] += part.bits[g] / PERIOD;
        }
        for (int g = 0; g < ADCGS_GROUPS; g++)
            assert_float_equal(sum[g], all.bits[g], 1e-6 * all.bits[g]);
    }
    clear(&x);
}

/** Gradients of the rate alone, for all parameters, with original or rounded values. */
static void rate_gradients(fixture *x, adcgs_quant quant, float *g[ADCGS_P_COUNT])
{
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        memset(x->f->param[i].g, 0, x->f->param[i].n * sizeof(float));
    adcgs_pass_forward(x->pass, x->f, 0.5f, &(adcgs_pass_mode){.quant = quant});
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    adcgs_pass_backward(x->pass, x->f, 0, 1, 1, 0, NULL);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        g[i] = malloc(x->f->param[i].n * sizeof(float) + 1);
        memcpy(g[i], x->f->param[i].g, x->f->param[i].n * sizeof(float));
    }
}

/**
 * Where steps are small relative to sigma, straight-through gradients of the rounded rate agree with those of the smooth rate.
 */
static void exact_gradients_follow_the_smooth_ones(void **state)
{
    fixture x;
    float *smooth[ADCGS_P_COUNT], *exact[ADCGS_P_COUNT];
    make(&x, (adcgs_cpu_level)(uintptr_t)*state, 2, 0.2, 0);
    rate_gradients(&x, ADCGS_QUANT_NONE, smooth);
    rate_gradients(&x, ADCGS_QUANT_ROUND, exact);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        double aa = 0, bb = 0, ab = 0;
        for (size_t j = 0; j < x.f->param[i].n; j++) {
            aa += (double)smooth[i][j] * (double)smooth[i][j];
            bb += (double)exact[i][j] * (double)exact[i][j];
            ab += (double)smooth[i][j] * (double)exact[i][j];
        }
        if (aa == 0)
            assert_true(bb == 0); /* the rate does not depend on it */
        else if (!(ab > 0.97 * sqrt(aa * bb) && bb > 0.7 * aa && bb < 1.4 * aa))
            fail_msg("%s: cosine %g, ratio of lengths %g", x.f->param[i].name, ab / sqrt(aa * bb), sqrt(bb / aa));
        free(smooth[i]);
        free(exact[i]);
    }
    clear(&x);
}

/* ---- Tables ---- */

/** Bits and derivatives of one value under the smooth rate. */
static adcgs_rate_cell smooth(const adcgs_train_dsp *dsp, float n, int level)
{
    _Alignas(64) float y[64], mu[64] = {0}, si[64], weight[64] = {1}, dy[64] = {0}, dmu[64], dsi[64];
    const float step = 1;
    for (int l = 0; l < 64; l++) {
        y[l] = n;
        si[l] = ((float)level - ADCGS_SI_CENTRE) / ADCGS_SI_GAIN;
    }
    const adcgs_rate_io io =
        {.n = 1, .y = y, .step = &step, .mu = mu, .si = si, .weight = weight, .scale = 1, .dy = dy, .dmu = dmu, .dsi = dsi};
    adcgs_rate_cell cell;
    cell.bits = (float)dsp->rate(&io);
    cell.by_value = dy[0];
    cell.by_level = dsi[0] / ADCGS_SI_GAIN;
    return cell;
}

/** The smooth rate and the Gaussian's tables agree at every level, in bits and derivatives. */
static void smooth_rate_follows_the_tables(void **state)
{
    adcgs_train_dsp dsp;
    adcgs_rate_table *table = malloc(sizeof *table);
    adcgs_train_dsp_init(&dsp, (adcgs_cpu_level)(uintptr_t)*state);
    adcgs_rate_table_init(table);
    for (int level = 1; level < ADCGS_SIGMA_LEVELS; level++) {
        const uint32_t *cdf = adcgs_table_cdf(level);
        const int support = adcgs_table_support(level);
        double real = 0, close = 0;
        for (int n = -support; n <= support; n++) {
            const double p = (cdf[n + support + 1] - cdf[n + support]) / 65536.0;
            const adcgs_rate_cell s = smooth(&dsp, (float)n, level), t = table->cell[level][abs(n)];
            assert_int_equal((int)lrint(65536 * (double)t.bits), adcgs_value_cost(level, n));
            real += p * t.bits;
            close += p * s.bits;
            if (p < 1e-3)
                continue;
            const double rounding = 2.5 / (65536 * p); /* of the tables */
            assert_float_equal(s.bits, t.bits, 0.01 + rounding);
            assert_float_equal(s.by_level, t.by_level, 0.01 + 0.2 * fabsf(t.by_level) + rounding);
            if (level > 28) /* the slope is nearly constant within a step: sigma is above 2 */
                assert_float_equal(n < 0 ? -s.by_value : s.by_value, t.by_value, 0.02 + 0.15 * fabsf(t.by_value));
        }
        assert_float_equal(close, real, 0.001 + 0.002 * real);
    }
    free(table);
}

/** Level 0 codes nothing, larger values cost more, and values far out have a gradient towards a higher level. */
static void tables_lead_back(void **state)
{
    (void)state;
    adcgs_rate_table *table = malloc(sizeof *table);
    adcgs_rate_table_init(table);
    for (int level = 0; level < ADCGS_SIGMA_LEVELS; level++)
        for (int a = 0; a <= ADCGS_LEVEL_MAX; a++) {
            const adcgs_rate_cell *cell = &table->cell[level][a];
            const double sigma = 0.11 * pow(64 / 0.11, level / 63.0);
            if (level)
                assert_int_equal((int)lrint(65536 * (double)cell->bits), adcgs_value_cost(level, a));
            else
                assert_true(cell->bits == 0);
            if (a == 0 ? cell->by_value != 0 : !(cell->by_value > 0))
                fail_msg("level %d: bits change by %g from magnitude %d", level, (double)cell->by_value, a);
            if (a > 4 * sigma + 1)
                assert_true(cell->by_level < 0);
            else if (a == 0)
                assert_true(cell->by_level >= 0);
        }
    free(table);
}

int main(void)
{
    int failed = 0;
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++) {
        void *const state = (void *)(uintptr_t)level;
        const struct CMUnitTest tests[] = {
            cmocka_unit_test_prestate(twins_are_exact, state),
            cmocka_unit_test_prestate(rounded_values_are_the_coders, state),
            cmocka_unit_test_prestate(steps_reach_all_values, state),
            cmocka_unit_test_prestate(parts_add_up, state),
            cmocka_unit_test_prestate(exact_gradients_follow_the_smooth_ones, state),
            cmocka_unit_test_prestate(smooth_rate_follows_the_tables, state),
            cmocka_unit_test_prestate(tables_lead_back, state),
        };
        failed += cmocka_run_group_tests_name("rate", tests, NULL, NULL);
    }
    return failed;
}
