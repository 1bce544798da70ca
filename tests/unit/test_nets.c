/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The cost of the networks and its reduction: the rate of their weights and its gradient, the choice of lattices, weights that
 * stay binary32.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "fmodel/weight_rate.h"
#include "grad/random.h"
#include "train/unit_prune.h"
#include "train/sample.h"
#include "train/weight_steps.h"

#include <math.h>

static void go_on(adcgs_trainer *t, uint32_t stop)
{
    int stopped;
    if (adcgs_trainer_run(t, stop_at, &stop, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** A run that stopped before iteration `stop`. */
static adcgs_trainer *run_to(const adcgs_train_config *config, uint32_t stop)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create(&t, scene, config, adcgs_cpu_best(), pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    go_on(t, stop);
    return t;
}

/* ---- The rate of weights ---- */

static void randomise(adcgs_fmodel *f, int group, double size)
{
    for (size_t i = 0; i < f->param[group].n; i++) {
        const double wide = i % 3 == 0 ? 0.02 : 1; /* some next to 0, where magnitudes are rounded off */
        f->param[group].p[i] = (float)(size * wide * adcgs_random_normal(5, (uint64_t)group, i));
    }
}

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

static size_t weights_of(const adcgs_fmodel *f)
{
    size_t n = 0;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        n += f->mlp[i].hidden ? f->param[i].n : 0;
    return n;
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

/** Hidden units are pruned once the networks have converged, and again when a bit costs them more. */
static void units_go_twice(void **state)
{
    adcgs_train_config config = small_config();
    config.iterations = 1500;
    config.prune_units_at = 0.7f;
    config.prune_units_again = 0.8f;
    config.lambda = 0.02f;
    adcgs_trainer *t = run_to(&config, 1040);
    const size_t before = weights_of(t->f);
    assert_int_equal(t->units_pruned, 0);
    go_on(t, 1100);
    const size_t once = weights_of(t->f);
    assert_int_equal(t->units_pruned, 1);
    t->lambda = 100;
    go_on(t, 1250);
    const size_t twice = weights_of(t->f);
    print_message("%zu weights; %zu after the first pruning, %zu after the second\n", before, once, twice);
    assert_int_equal(t->units_pruned, 2);
    assert_true(once < before && twice < once);
    adcgs_trainer_free(&t);
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
        t->lambda = (const double[]){1e-4, 1, 100}[i];
        assert_int_equal(adcgs_weight_steps_choose(t, &error), ADCGS_OK);
        sum[i] = sum_of_lattices(t->f);
    }
    print_message("sums of exponents: %d, %d, %d\n", sum[0], sum[1], sum[2]);
    assert_true(sum[0] >= sum[1] && sum[1] > sum[2]);
    assert_memory_equal(before, t->f->param[ADCGS_P_OMEGA].p, t->f->param[ADCGS_P_OMEGA].n * sizeof *before);
    t->lambda = 1;
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
    t->lambda = 0.01; /* every loss counts */
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
    t->lambda = 100;
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
    assert_true(t->rounding && !t->frozen);
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

/* ---- Narrower networks ---- */

/** Primitives at one time, and the bits of all features. */
static void outputs(adcgs_trainer *t, float *prim, double *bits)
{
    adcgs_rate rate;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (t->f->mlp[i].n)
            adcgs_mlp_prepare(&t->f->mlp[i], t->f->param[i].p, 1);
    adcgs_pass_forward(t->pass, t->f, 0.3f, &(adcgs_pass_mode){.deform = 1});
    memcpy(prim, t->pass->prim, ADCGS_ROWS * (size_t)t->pass->primitives.n * sizeof *prim);
    adcgs_pass_rate(t->pass, t->f, &rate);
    *bits = rate.total;
}

static void assert_close(const float *a, const float *b, size_t n, float tolerance)
{
    for (size_t i = 0; i < n; i++)
        if (!(fabsf(a[i] - b[i]) <= tolerance * (1 + fabsf(a[i]))))
            fail_msg("value %zu is %g, expected %g", i, (double)b[i], (double)a[i]);
}

/** A network without its unread units computes the same, and the optimiser's state stays with its parameters. */
static void narrow_networks_compute_the_same(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 100);
    const size_t n = ADCGS_ROWS * (size_t)t->pass->primitives.n;
    float *before = malloc(n * sizeof *before), *after = malloc(n * sizeof *after);
    double bits[2];
    assert_true(before && after);
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        const adcgs_mlp *m = &t->f->mlp[i];
        adcgs_param *p = &t->f->param[i];
        uint8_t keep[16];
        if (!m->hidden)
            continue;
        randomise(t->f, i, 0.3);
        for (int u = 0; u < m->width; u++) {
            keep[u] = u % 3 != i % 3;
            for (int l = 1; l <= m->hidden; l++)
                for (int o = 0; o < m->n_out[l] && !keep[u]; o++)
                    p->p[m->w[l] + (size_t)(o * m->width + u)] = 0;
        }
        for (size_t j = 0; j < p->n; j++) {
            p->m[j] = 2 * p->p[j];
            p->v[j] = p->p[j] * p->p[j];
        }
        outputs(t, before, &bits[0]);
        const size_t all = p->n;
        adcgs_fmodel_narrow(t->f, i, keep);
        assert_true(m->width == (i % 3 == 0 ? 10 : 11) && p->n == m->n && p->n < all);
        outputs(t, after, &bits[1]);
        assert_close(before, after, n, 1e-5f);
        assert_float_equal(bits[0], bits[1], 1e-4 * bits[0]);
        for (size_t j = 0; j < p->n; j++)
            assert_true(p->m[j] == 2 * p->p[j] && p->v[j] == p->p[j] * p->p[j]);
    }
    free(before);
    free(after);
    adcgs_trainer_free(&t);
}

/** If a unit is a multiple of another one, or constant, the other units take over its work. */
static void silent_units_are_replaced(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = run_to(&config, 100);
    const size_t n = ADCGS_ROWS * (size_t)t->pass->primitives.n;
    float *before = malloc(n * sizeof *before), *after = malloc(n * sizeof *after);
    double bits;
    assert_true(before && after);
    for (int i = ADCGS_P_THETA; i <= ADCGS_P_VARPI; i++) {
        const adcgs_mlp *m = &t->f->mlp[i];
        float *p = t->f->param[i].p;
        adcgs_gram gram;
        randomise(t->f, i, 0.3);
        for (int l = 0; l < m->hidden; l++) {
            for (int j = 0; j < m->in[l]; j++) {
                p[m->w[l] + (size_t)(3 * m->in[l] + j)] = 2 * p[m->w[l] + (size_t)(5 * m->in[l] + j)];
                p[m->w[l] + (size_t)(7 * m->in[l] + j)] = 0;
            }
            p[m->b[l] + 3] = 2 * p[m->b[l] + 5];
            p[m->b[l] + 7] = 0.5f;
        }
        outputs(t, before, &bits);
        assert_int_equal(adcgs_gram_take(&gram, t->f, i, &error), ADCGS_OK);
        adcgs_mlp_prune_unit(m, p, &gram, 3);
        adcgs_mlp_prune_unit(m, p, &gram, 7);
        adcgs_gram_clear(&gram);
        for (int l = 1; l <= m->hidden; l++)
            for (int o = 0; o < m->n_out[l]; o++)
                assert_true(p[m->w[l] + (size_t)(o * m->width + 3)] == 0 && p[m->w[l] + (size_t)(o * m->width + 7)] == 0);
        outputs(t, after, &bits);
        assert_close(before, after, n, 2e-3f);
    }
    free(before);
    free(after);
    adcgs_trainer_free(&t);
}

/** A run with networks of other widths restores these, wider or narrower. */
static void checkpoints_hold_widths(const adcgs_train_config *config, const adcgs_trainer *t)
{
    adcgs_trainer *other = run_to(config, 110);
    adcgs_buffer wide, narrow, again;
    adcgs_buffer_init(&wide);
    adcgs_buffer_init(&narrow);
    adcgs_buffer_init(&again);
    assert_int_equal(adcgs_trainer_store(other, &wide, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_store(t, &narrow, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_restore(other, narrow.data, narrow.size, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_store(other, &again, &error), ADCGS_OK);
    assert_true(again.size == narrow.size && again.size < wide.size && !memcmp(again.data, narrow.data, again.size));
    again.size = 0;
    assert_int_equal(adcgs_trainer_restore(other, wide.data, wide.size, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_store(other, &again, &error), ADCGS_OK);
    assert_true(again.size == wide.size && !memcmp(again.data, wide.data, again.size));
    adcgs_buffer_clear(&again);
    adcgs_buffer_clear(&narrow);
    adcgs_buffer_clear(&wide);
    adcgs_trainer_free(&other);
}

/** Pruning removes units if bits are expensive and keeps them if bits cost nothing. Either run continues and ends in a file. */
static void units_go_when_bits_are_dear(void **state)
{
    adcgs_train_config config = small_config();
    config.params.adaptive_steps = 1;
    for (int dear = 0; dear < 2; dear++) {
        adcgs_trainer *t = run_to(&config, 110);
        adcgs_stream stream;
        adcgs_buffer out;
        int units = 0, all = 0;
        t->lambda = dear ? 1000 : 0;
        assert_int_equal(adcgs_prune_units(t, &error), ADCGS_OK);
        for (int i = ADCGS_P_THETA; i <= ADCGS_P_VARPI; i++, all += 16)
            units += t->f->mlp[i].width;
        print_message("%d of %d units remain\n", units, all);
        assert_true(dear ? units < all / 2 : units > all / 2);
        assert_int_equal(t->f->mlp[ADCGS_P_E_STEPS].width, 16);
        t->lambda = (double)config.lambda;
        checkpoints_hold_widths(&config, t);
        go_on(t, ITERATIONS);
        adcgs_buffer_init(&out);
        assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
        if (adcgs_encode_verified(&stream, &out, t->cpu, pool, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        adcgs_buffer_clear(&out);
        adcgs_stream_clear(&stream, NULL);
        adcgs_trainer_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_rate_has_its_gradient),
        cmocka_unit_test(weight_rate_is_close_to_the_coder),
        cmocka_unit_test(price_shrinks_networks),
        cmocka_unit_test(units_go_twice),
        cmocka_unit_test(lattice_bits_are_the_files),
        cmocka_unit_test(lattices_follow_lambda),
        cmocka_unit_test(no_lattice_about_the_nominal_is_cheaper),
        cmocka_unit_test(lattices_outlive_their_streams),
        cmocka_unit_test(silent_values_follow_their_means),
        cmocka_unit_test(raw_networks_are_exact),
        cmocka_unit_test(narrow_networks_compute_the_same),
        cmocka_unit_test(silent_units_are_replaced),
        cmocka_unit_test(units_go_when_bits_are_dear),
    };
    return cmocka_run_group_tests_name("nets", tests, open_scene, close_scene);
}
