/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Narrower networks: units without effect or worth go, and the others compute the same. */
#include "second_sources.h"
#include "weight_runs.h"

#include "encode/encode.h"
#include "train/static/unit_prune.h"

#include <math.h>

static size_t weights_of(const adcgs_fmodel *f)
{
    size_t n = 0;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        n += f->mlp[i].hidden ? f->param[i].n : 0;
    return n;
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
    assert_int_equal(t->stage.units_pruned, 0);
    go_on(t, 1100);
    const size_t once = weights_of(t->f);
    assert_int_equal(t->stage.units_pruned, 1);
    t->rate.lambda = 100;
    go_on(t, 1250);
    const size_t twice = weights_of(t->f);
    print_message("%zu weights; %zu after the first pruning, %zu after the second\n", before, once, twice);
    assert_int_equal(t->stage.units_pruned, 2);
    assert_true(once < before && twice < once);
    adcgs_trainer_free(&t);
}

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
        t->rate.lambda = dear ? 1000 : 0;
        assert_int_equal(adcgs_prune_units(t, &error), ADCGS_OK);
        for (int i = ADCGS_P_THETA; i <= ADCGS_P_VARPI; i++, all += 16)
            units += t->f->mlp[i].width;
        print_message("%d of %d units remain\n", units, all);
        assert_true(dear ? units < all / 2 : units > all / 2);
        assert_int_equal(t->f->mlp[ADCGS_P_E_STEPS].width, 16);
        t->rate.lambda = (double)config.lambda;
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

int adcgs_test_nets_widths(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_go_twice),
        cmocka_unit_test(narrow_networks_compute_the_same),
        cmocka_unit_test(silent_units_are_replaced),
        cmocka_unit_test(units_go_when_bits_are_dear),
    };
    return cmocka_run_group_tests_name("nets widths", tests, open_scene, close_scene);
}
