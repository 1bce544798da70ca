/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The rate of the networks' weights and its gradient, the choice of lattices, weights that stay binary32. */
#include "second_sources.h"
#include "weight_runs.h"

#include "encode/encode.h"
#include "fmodel/weight_rate.h"
#include "train/density/sample.h"
#include "train/rate/weight_steps.h"

#include <math.h>

/* ---- The rate of weights ---- */

/** The gradient against central differences. The bits in binary32 are accurate to about 1e-4 of a bit in 1e4. */
static void weight_rate_has_its_gradient(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 0);
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &t->f->param[i];
        if (!t->f->mlp[i].n)
            continue;
        randomise(t->f, i, 0.4);
        memset(t->f->mlp[i].weight_step, i % 2 ? 4 : ADCGS_WEIGHT_STEP_NONE, sizeof t->f->mlp[i].weight_step);
        memset(p->g, 0, p->n * sizeof *p->g);
        const double bits = adcgs_weight_rate(t->f, i, 2);
        assert_true(bits > 0 && adcgs_weight_rate(t->f, i, 0) == bits);
        for (size_t j = 0; j < p->n; j += p->n / 40 + 1) {
            const float w = p->p[j], h = 1e-3f;
            p->p[j] = w + h;
            const double high = adcgs_weight_rate(t->f, i, 0);
            p->p[j] = w - h;
            const double low = adcgs_weight_rate(t->f, i, 0), g = (high - low) / (2 * (double)h);
            p->p[j] = w;
            assert_float_equal(p->g[j] / 2, g, 0.05 * fabs(g) + 0.3);
        }
    }
    adcgs_trainer_free(&t);
}

/** The estimate follows the bits of the weight coder. */
static void weight_rate_is_close_to_the_coder(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 0);
    adcgs_mlp *m = &t->f->mlp[ADCGS_P_VARPI];
    for (double size = 0.02; size < 3; size *= 3) {
        double coded = 0, bits;
        randomise(t->f, ADCGS_P_VARPI, size);
        memset(m->weight_step, 6, sizeof m->weight_step);
        for (int l = 0; l <= m->hidden; l++) {
            assert_int_equal(adcgs_weight_step_bits(m, t->f->param[ADCGS_P_VARPI].p, l, 6, &bits, &error), ADCGS_OK);
            coded += bits;
        }
        bits = adcgs_weight_rate(t->f, ADCGS_P_VARPI, 0);
        print_message("weights of %.2f: %.0f bits coded, %.0f estimated\n", size, coded, bits);
        assert_true(bits > 0.6 * coded && bits < 1.4 * coded);
    }
    adcgs_trainer_free(&t);
}

/** A higher price makes the networks' part of the file smaller. */
static void price_shrinks_networks(void **state)
{
    uint64_t bytes[2];
    for (int i = 0; i < 2; i++) {
        adcgs_train_config config = small_config();
        config.prune_units_at = 0.55f;
        config.network_rate = i ? 300 : 0;
        adcgs_trainer *t = run_to(&config, ITERATIONS);
        adcgs_stream stream;
        adcgs_buffer out;
        adcgs_buffer_init(&out);
        assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
        assert_int_equal(adcgs_encode_verified(&stream, &out, t->cpu, pool, &error), ADCGS_OK);
        bytes[i] = stream.bytes.networks;
        adcgs_buffer_clear(&out);
        adcgs_stream_clear(&stream, NULL);
        adcgs_trainer_free(&t);
    }
    print_message("networks: %llu bytes without a price, %llu at a high price\n", (unsigned long long)bytes[0],
                  (unsigned long long)bytes[1]);
    assert_true(bytes[1] < bytes[0]);
}

/* ---- Lattices ---- */

/** The bits of all layers sum to the size of the networks in a file, minus shapes and framing. */
static void lattice_bits_are_the_files(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, ITERATIONS);
    adcgs_stream stream;
    adcgs_buffer out;
    double sum = 0, bits;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        for (int l = 0; t->f->mlp[i].n && l <= t->f->mlp[i].hidden; l++) {
            assert_int_equal(adcgs_weight_step_bits(&t->f->mlp[i], t->f->param[i].p, l, t->f->mlp[i].weight_step[l], &bits,
                                                    &error),
                             ADCGS_OK);
            sum += bits / 8;
        }
    adcgs_buffer_init(&out);
    assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
    assert_int_equal(adcgs_encode_verified(&stream, &out, t->cpu, pool, &error), ADCGS_OK);
    print_message("layers: %.0f bytes, networks in the file: %llu bytes\n", sum, (unsigned long long)stream.bytes.networks);
    assert_float_equal(sum, (double)stream.bytes.networks, 0.01 * sum + 150);
    adcgs_buffer_clear(&out);
    adcgs_stream_clear(&stream, NULL);
    adcgs_trainer_free(&t);
}

static int sum_of_lattices(const adcgs_fmodel *f)
{
    int sum = 0;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        for (int l = 0; f->mlp[i].n && l <= f->mlp[i].hidden; l++) {
            assert_in_range(f->mlp[i].weight_step[l], ADCGS_WEIGHT_STEP_MIN,
                            f->mlp[i].entropy ? ADCGS_E24_BITS : ADCGS_WEIGHT_STEP_MAX);
            sum += f->mlp[i].weight_step[l];
        }
    return sum;
}

/** The more a bit costs, the coarser the lattices. The choice changes lattices only and uses no random numbers. */
static void lattices_follow_lambda(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 169);
    float *before = calloc(t->f->param[ADCGS_P_OMEGA].n, sizeof *before);
    int sum[3];
    assert_non_null(before);
    memcpy(before, t->f->param[ADCGS_P_OMEGA].p, t->f->param[ADCGS_P_OMEGA].n * sizeof *before);
    for (int i = 0; i < 3; i++) {
        t->rate.lambda = (const double[]){1e-4, 1, 100}[i];
        assert_int_equal(adcgs_weight_steps_choose(t, &error), ADCGS_OK);
        sum[i] = sum_of_lattices(t->f);
    }
    print_message("sums of exponents: %d, %d, %d\n", sum[0], sum[1], sum[2]);
    assert_true(sum[0] >= sum[1] && sum[1] > sum[2]);
    assert_memory_equal(before, t->f->param[ADCGS_P_OMEGA].p, t->f->param[ADCGS_P_OMEGA].n * sizeof *before);
    t->rate.lambda = 1;
    assert_int_equal(adcgs_weight_steps_choose(t, &error), ADCGS_OK);
    assert_int_equal(sum_of_lattices(t->f), sum[1]);
    free(before);
    adcgs_trainer_free(&t);
}

/** The cost of a network's layer on a lattice, in bits, while all other layers have full precision. */
static double cost_on(adcgs_trainer *t, int group, int layer, int e)
{
    double distortion, bits;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_mlp *m = &t->f->mlp[i];
        memset(m->weight_step, m->entropy ? ADCGS_E24_BITS : ADCGS_WEIGHT_STEP_NONE, sizeof m->weight_step);
    }
    t->f->mlp[group].weight_step[layer] = (int8_t)e;
    adcgs_trainer_prepare_networks(t);
    adcgs_mlp_prepare(&t->f->mlp[group], t->f->param[group].p, 1);
    assert_int_equal(adcgs_sample_distortion(t, group, &distortion, &error), ADCGS_OK);
    assert_int_equal(adcgs_weight_step_bits(&t->f->mlp[group], t->f->param[group].p, layer, e, &bits, &error), ADCGS_OK);
    return distortion + bits;
}

/** No lattice of F_theta near the nominal one costs less than the chosen one. */
static void assert_cheapest(adcgs_trainer *t)
{
    const int last = t->f->mlp[ADCGS_P_THETA].hidden;
    int8_t nominal[ADCGS_MLP_LAYERS], chosen[ADCGS_MLP_LAYERS];
    adcgs_weight_steps_nominal(t);
    memcpy(nominal, t->f->mlp[ADCGS_P_THETA].weight_step, sizeof nominal);
    assert_int_equal(adcgs_weight_steps_choose(t, &error), ADCGS_OK);
    memcpy(chosen, t->f->mlp[ADCGS_P_THETA].weight_step, sizeof chosen);
    for (int l = 0; l <= last; l++) {
        const double cost = cost_on(t, ADCGS_P_THETA, l, chosen[l]);
        for (int e = ADCGS_MAX(nominal[l] - 2, ADCGS_WEIGHT_STEP_MIN); e <= ADCGS_MIN(nominal[l] + 2, ADCGS_WEIGHT_STEP_MAX); e++)
            assert_true(cost <= cost_on(t, ADCGS_P_THETA, l, e));
    }
}

/**
 * A large weight makes even the nominal lattice far too coarse, and a coarser one may lose less by chance. The choice tries finer
 * lattices as well.
 */
static void no_lattice_about_the_nominal_is_cheaper(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 169);
    const adcgs_mlp *m = &t->f->mlp[ADCGS_P_THETA];
    t->rate.lambda = 0.01; /* every loss counts */
    for (int times = 1; times <= 16; times *= 4) {
        t->f->param[ADCGS_P_THETA].p[m->w[m->hidden]] = 10.0f * (float)times;
        assert_cheapest(t);
    }
    adcgs_trainer_free(&t);
}

/** A layer's lattice step is at most 4 times a 16th of its weights' root mean square; at the output, 2 times a 64th. */
static void assert_fine(const adcgs_fmodel *f, int group, int layer)
{
    const adcgs_mlp *m = &f->mlp[group];
    const size_t begin = m->w[layer], end = layer < m->hidden ? m->w[layer + 1] : m->n;
    double square = 0;
    for (size_t i = begin; i < end; i++)
        square += (double)f->param[group].p[i] * (double)f->param[group].p[i];
    const double rms = sqrt(square / (double)(end - begin));
    const int farther = layer < m->hidden ? 2 : 1;
    const double steps = ldexp(layer < m->hidden ? 16 : 64, -farther);
    assert_true(ldexp(steps, -m->weight_step[layer]) <= 1.001 * rms || m->weight_step[layer] >= ADCGS_E24_BITS - farther);
}

/** Codes only the means of all f_g: their networks give sigma level 0 everywhere. */
static void silence_streams(adcgs_fmodel *f)
{
    for (int c = 0; c < f->params.chunks; c++) {
        const adcgs_mlp *m = &f->mlp[ADCGS_P_E_FG + c];
        float *out = f->param[ADCGS_P_E_FG + c].p + m->b[m->hidden];
        for (int i = m->out / 2; i < m->out; i++)
            out[i] = -100;
    }
}

/** Streams without any bit left to save do not make their networks' lattices coarse. */
static void lattices_outlive_their_streams(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 169);
    silence_streams(t->f);
    t->rate.lambda = 100;
    assert_int_equal(adcgs_weight_steps_choose(t, &error), ADCGS_OK);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        for (int l = 0; t->f->mlp[i].entropy && t->f->mlp[i].n && l <= t->f->mlp[i].hidden; l++)
            assert_fine(t->f, i, l);
    adcgs_trainer_free(&t);
}

/** Where only the mean is coded, values equal the mean. */
static void silent_values_follow_their_means(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 169);
    silence_streams(t->f);
    go_on(t, 185);
    assert_true(t->stage.rounding && !t->stage.frozen);
    const size_t n = (size_t)adcgs_fmodel_rows(t->f, ADCGS_P_FG) * t->f->groups * 64;
    for (size_t j = 0; j < n; j++) {
        assert_true(adcgs_mean_alone(t->pass->mu[ADCGS_P_FG][j]));
        assert_true(t->f->param[ADCGS_P_FG].p[j] == t->pass->used[ADCGS_P_FG][j]);
    }
    adcgs_trainer_free(&t);
}

/**
 * Binary32 weights are in the file to the bit. A run can continue with or without lattices from the iteration that chooses them.
 */
static void raw_networks_are_exact(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 169), *raw;
    adcgs_buffer state_of_run, out;
    adcgs_stream stream;
    adcgs_buffer_init(&state_of_run);
    adcgs_buffer_init(&out);
    assert_int_equal(adcgs_trainer_store(t, &state_of_run, &error), ADCGS_OK);
    config.without_weight_steps = 1;
    raw = run_to(&config, 0);
    assert_int_equal(adcgs_trainer_restore(raw, state_of_run.data, state_of_run.size, &error), ADCGS_OK);
    go_on(raw, ITERATIONS);
    assert_int_equal(adcgs_encode_stream(&stream, raw, NULL, 0, &error), ADCGS_OK);
    assert_int_equal(adcgs_encode_verified(&stream, &out, raw->cpu, pool, &error), ADCGS_OK);
    const adcgs_tensor *w = &stream.segments[0].net[ADCGS_ROLE_PREDICTION].layer[0].w;
    const float *p = raw->f->param[ADCGS_P_THETA].p;
    assert_int_equal(w->mode, 1);
    for (size_t i = 0; i < (size_t)w->rows * w->cols; i++)
        assert_true((uint32_t)w->m[i] == adcgs_float_bits(p[i]));
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&out);
    adcgs_buffer_clear(&state_of_run);
    adcgs_trainer_free(&raw);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_rate_has_its_gradient),   cmocka_unit_test(weight_rate_is_close_to_the_coder),
        cmocka_unit_test(price_shrinks_networks),         cmocka_unit_test(lattice_bits_are_the_files),
        cmocka_unit_test(lattices_follow_lambda),         cmocka_unit_test(no_lattice_about_the_nominal_is_cheaper),
        cmocka_unit_test(lattices_outlive_their_streams), cmocka_unit_test(silent_values_follow_their_means),
        cmocka_unit_test(raw_networks_are_exact),
    };
    int failed = cmocka_run_group_tests_name("nets", tests, open_scene, close_scene);
    failed += adcgs_test_nets_widths();
    return failed;
}
