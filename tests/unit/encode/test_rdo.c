/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Levels chosen by rate and distortion: the choice of one level, its curvature, and the result in a stream. */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "encode/rdo.h"
#include "grad/random.h"
#include "train/density/sample.h"
#include "train/rate/curvature.h"
#include "train/rate/levels.h"

#include <math.h>

static const char small[] = "max_anchors=150,start_anchors=100,densify_interval=20,k=4,n_fv=12,theta_width=16,omega_width=16,"
                            "varpi_width=16,entropy_width=16,lambda=0.05,matching_frames=0,n_fg=8";
static adcgs_trainer *trainer; /**< stopped just before its values are frozen */

static adcgs_trainer *make(void)
{
    adcgs_train_config c;
    adcgs_trainer *t;
    assert_int_equal(adcgs_train_preset(&c, "draft", &error), ADCGS_OK);
    assert_int_equal(adcgs_train_set(&c, small, &error), ADCGS_OK);
    c.iterations = 400;
    c.freeze_start = 0.90f;
    if (adcgs_trainer_create(&t, scene, &c, adcgs_cpu_best(), pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    return t;
}

static int setup(void **state)
{
    uint32_t stop = 360;
    int stopped;
    if (open_scene(state) != 0)
        return -1;
    trainer = make();
    return adcgs_trainer_run(trainer, stop_at, &stop, &stopped, &error) != ADCGS_OK || trainer->stage.frozen ||
           !trainer->stage.rounding;
}

static int teardown(void **state)
{
    adcgs_trainer_free(&trainer);
    return close_scene(state);
}

/** A separate trainer in the common state, optionally frozen. */
static adcgs_trainer *copy(int frozen)
{
    adcgs_buffer b;
    adcgs_trainer *t = make();
    uint32_t stop = 0;
    int stopped;
    adcgs_buffer_init(&b);
    assert_int_equal(adcgs_trainer_store(trainer, &b, &error), ADCGS_OK);
    /* Stops at once, so that the views are loaded. */
    assert_int_equal(adcgs_trainer_restore(t, b.data, b.size, &error), ADCGS_OK);
    stop = t->run.iteration + (frozen ? 10 : 0);
    assert_int_equal(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error), ADCGS_OK);
    assert_int_equal(t->stage.frozen, frozen);
    float *h[ADCGS_P_ANCHOR];
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        h[i] = t->f->param[i].v;
    if (frozen) /* the run itself does not measure it, since it chooses nothing by it */
        assert_int_equal(adcgs_curvature_measure(t, h, NULL, &error), ADCGS_OK);
    adcgs_buffer_clear(&b);
    return t;
}

/* ---- One level ---- */

static double price(int si, double wanted, int32_t n, double weight, double lambda_bit)
{
    return weight * (n - wanted) * (n - wanted) + lambda_bit * adcgs_value_cost(si, n) / 65536;
}

/** No level in between is cheaper, for any table. If bits cost nothing, the nearest level is chosen. */
static void levels_are_the_cheapest(void **state)
{
    (void)state;
    for (uint32_t trial = 0; trial < 4000; trial++) {
        const int si = 1 + (int)(adcgs_mix32(trial) % 63);
        const double wanted = ldexp(adcgs_random_unit(1, 1, trial) - 0.5, (int)(trial % 9));
        const double weight = exp(8 * adcgs_random_unit(1, 2, trial) - 6), bit = trial % 5 ? 0.1 : 0;
        const int32_t nearest = (int32_t)rint(wanted), n = adcgs_rdo_level(si, wanted, nearest, weight, bit);
        assert_in_range(nearest < 0 ? -n : n, 0, nearest < 0 ? -nearest : nearest);
        for (int32_t other = ADCGS_MIN(nearest, 0); other <= ADCGS_MAX(nearest, 0); other++)
            assert_true(price(si, wanted, n, weight, bit) <= price(si, wanted, other, weight, bit));
        if (bit == 0)
            assert_int_equal(n, nearest);
    }
    assert_int_equal(adcgs_rdo_level(0, 0.9, 0, 1, 1), 0);
    assert_int_equal(adcgs_rdo_level(30, 7.2, 7, 0, 1), 0);
}

/* ---- Curvature ---- */

/** Replaces the images by the model's render plus noise: the loss then has the curvature of the Gauss-Newton approximation. */
static void explain_pictures(adcgs_trainer *t)
{
    for (uint32_t i = 0; i < t->views.n; i++) {
        const adcgs_train_view *v = &t->views.list[i];
        const size_t n = 3 * (size_t)v->view.width * (size_t)v->view.height;
        adcgs_pass_forward(t->pass, t->f, v->t, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
        assert_int_equal(adcgs_raster_forward(t->raster, &t->pass->primitives, &v->view, scene->background, 0.3f, t->image, 0,
                                              &error),
                         ADCGS_OK);
        for (size_t j = 0; j < n; j++)
            t->taken[j] = t->image[j] + (float)(0.03 * adcgs_random_normal(9, i, j));
        assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
    }
}

enum { PORTIONS = 32 };

/** Loss after moving the values of one portion of a group by half a step, randomly up or down. */
static double loss_moved(adcgs_trainer *t, int group, uint32_t portion, float direction)
{
    adcgs_param *p = &t->f->param[group];
    const size_t rows = (size_t)adcgs_fmodel_rows(t->f, group), bytes = p->n * sizeof(float);
    double loss;
    float *still = malloc(bytes);
    assert_non_null(still);
    memcpy(still, p->p, bytes);
    for (size_t i = 0; i < p->n; i++)
        if (adcgs_mix32((uint32_t)i) % PORTIONS == portion)
            p->p[i] += (adcgs_mix32((uint32_t)i ^ 0x9e3779b9u) & 1 ? 0.5f : -0.5f) * direction * t->f->step[group][i / 64 % rows];
    assert_int_equal(adcgs_sample_loss(t, ADCGS_CURVATURE_VIEWS, 1, &loss, &error), ADCGS_OK);
    memcpy(p->p, still, bytes);
    free(still);
    return loss;
}

/** Ratio of the loss's second differences, summed over portions of a group's values, to the measured curvature. */
static double seen_by_said(adcgs_trainer *t, int group, const float *h, double still)
{
    const adcgs_param *p = &t->f->param[group];
    const size_t rows = (size_t)adcgs_fmodel_rows(t->f, group);
    double seen = 0, said = 0;
    for (uint32_t portion = 0; portion < PORTIONS; portion++)
        seen += 0.5 * (loss_moved(t, group, portion, 1) + loss_moved(t, group, portion, -1)) - still;
    for (size_t i = 0; i < p->n; i++) {
        const double d = 0.5 * (double)t->f->step[group][i / 64 % rows];
        said += 0.5 * (double)h[i] * d * d;
    }
    return seen / said;
}

/** The curvature of each group is within a factor 2 of the loss's own. */
static void curvature_is_that_of_the_loss(void **state)
{
    (void)state;
    adcgs_trainer *t = copy(1);
    adcgs_fmodel *f = t->f;
    float *h[ADCGS_P_ANCHOR];
    double still;
    explain_pictures(t);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        h[i] = malloc(f->param[i].n * sizeof(float));
        assert_non_null(h[i]);
    }
    assert_int_equal(adcgs_curvature_measure(t, h, NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_sample_loss(t, ADCGS_CURVATURE_VIEWS, 1, &still, &error), ADCGS_OK);
    for (int i = 0; i < ADCGS_P_ETA; i++) {
        const double ratio = seen_by_said(t, i, h[i], still);
        print_message("%s: the loss has %.2f times the measured curvature\n", f->param[i].name, ratio);
        assert_true(ratio > 0.5 && ratio < 2);
    }
    for (size_t j = 0; j < f->param[ADCGS_P_ETA].n; j++)
        assert_true(h[ADCGS_P_ETA][j] == 0);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        free(h[i]);
    adcgs_trainer_free(&t);
}

/* ---- Frozen values ---- */

static uint64_t stream_bytes(const adcgs_trainer *t, adcgs_model *model)
{
    const adcgs_encode_note note = {"key", "value"};
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_encode_stream(&stream, t, &note, 1, &error), ADCGS_OK);
    if (adcgs_encode_verified(&stream, &bytes, t->cpu, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    const uint64_t n = bytes.size;
    *model = stream.segments[0];
    memset(&stream.segments[0], 0, sizeof stream.segments[0]);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return n;
}

/** The predicted bytes equal the written ones. Strength never costs more bytes, and equal strengths give equal values. */
static void strength_tells_bytes(void **state)
{
    (void)state;
    static const double strengths[] = {0, 1, 10, 100, 1000, 10};
    const adcgs_encode_note note = {"key", "value"};
    adcgs_trainer *t = copy(1);
    uint64_t told[ADCGS_COUNTOF(strengths)], last = UINT64_MAX;
    adcgs_bytes bytes;
    for (size_t i = 0; i < ADCGS_COUNTOF(strengths); i++) {
        assert_int_equal(adcgs_encode_bytes(&bytes, t, strengths[i], &note, 1, &error), ADCGS_OK);
        told[i] = bytes.total;
    }
    assert_int_equal(told[2], told[5]);
    for (size_t i = 0; i < ADCGS_COUNTOF(strengths); i++) {
        adcgs_model model;
        assert_int_equal(adcgs_level_choose(t, strengths[i], &error), ADCGS_OK);
        assert_int_equal(stream_bytes(t, &model), told[i]);
        assert_int_equal(adcgs_encode_bytes(&bytes, t, -1, &note, 1, &error), ADCGS_OK);
        assert_int_equal(bytes.total, told[i]);
        print_message("strength %g: %llu bytes\n", strengths[i], (unsigned long long)told[i]);
        adcgs_model_clear(&model, NULL);
        if (i < 5)
            assert_true(told[i] <= last);
        last = told[i];
    }
    assert_true(told[4] < told[0] * 97 / 100);
    adcgs_trainer_free(&t);
}

/** Levels chosen for their bits stay unchanged while the networks train, and into the stream. */
static void decisions_are_kept(void **state)
{
    (void)state;
    adcgs_trainer *t = copy(1);
    adcgs_model chosen, last;
    int stopped;
    assert_int_equal(adcgs_level_choose(t, 5, &error), ADCGS_OK);
    stream_bytes(t, &chosen);
    assert_int_equal(adcgs_trainer_run(t, NULL, NULL, &stopped, &error), ADCGS_OK);
    stream_bytes(t, &last);
    const adcgs_params *p = &chosen.params;
    assert_int_equal(chosen.n, last.n);
    assert_memory_equal(chosen.eta, last.eta, chosen.n * p->n_eta * sizeof *last.eta);
    assert_memory_equal(chosen.fv, last.fv, chosen.n * p->n_fv * sizeof *last.fv);
    assert_memory_equal(chosen.sigma, last.sigma, chosen.n * (size_t)adcgs_sigma_rows(p) * sizeof *last.sigma);
    assert_memory_equal(chosen.colour, last.colour, chosen.n * ADCGS_COLOUR_N * sizeof *last.colour);
    assert_memory_equal(chosen.fg, last.fg, (size_t)chosen.n * p->k * p->n_fg * sizeof *last.fg);
    adcgs_model_clear(&chosen, NULL);
    adcgs_model_clear(&last, NULL);
    adcgs_trainer_free(&t);
}

static void only_frozen_values_are_decided(void **state)
{
    (void)state;
    adcgs_trainer *t = copy(0);
    adcgs_bytes bytes;
    assert_int_equal(adcgs_encode_bytes(&bytes, t, 1, NULL, 0, &error), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_level_choose(t, 1, &error), ADCGS_ERR_USAGE);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_the_cheapest),        cmocka_unit_test(curvature_is_that_of_the_loss),
        cmocka_unit_test(strength_tells_bytes),           cmocka_unit_test(decisions_are_kept),
        cmocka_unit_test(only_frozen_values_are_decided),
    };
    return cmocka_run_group_tests_name("rdo", tests, setup, teardown);
}
