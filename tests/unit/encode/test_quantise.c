/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The numbers of a trained model that end up in a stream: quantisation, estimated and written bits, models without motion or
 * without compression.
 */
#include "training_runs.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "encode/raw.h"
#include "metric/metric.h"
#include "model/latents_priv.h"
#include "splat/splat.h"
#include "train/density/sample.h"
#include "train/static/prune_and_fix.h"

#include <math.h>

/* ---- Quantisation ---- */

static void take_values(adcgs_fmodel *f, float *mu[ADCGS_P_ANCHOR], float *value[ADCGS_P_ANCHOR])
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        mu[i] = calloc(f->param[i].n, sizeof(float));
        value[i] = calloc(f->param[i].n, sizeof(float));
        assert_true(mu[i] && value[i]);
    }
}

static void decoded_values_are_their_own_quantisation(void **state)
{
    adcgs_train_config config = all_stages_config();
    for (uint32_t stop = 90; stop <= ITERATIONS; stop += 55) {
        config.params.adaptive_steps = config.params.spans = stop % 110 == 90;
        adcgs_trainer *t = make_trainer(&config, pool);
        adcgs_model first, second;
        float *mu[ADCGS_P_ANCHOR], *value[ADCGS_P_ANCHOR];
        run(t, stop_at, &stop);
        take_values(t->f, mu, value);
        const adcgs_quantise_options with = {.cpu = t->cpu, .mu = mu, .value = value};
        assert_int_equal(adcgs_quantise(&first, t->f, &with, &error), ADCGS_OK);
        if (adcgs_model_validate(&first, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        for (int i = 0; i < ADCGS_P_ANCHOR; i++)
            memcpy(t->f->param[i].p, value[i], t->f->param[i].n * sizeof(float));
        const adcgs_quantise_options scalar = {.cpu = ADCGS_CPU_SCALAR};
        assert_int_equal(adcgs_quantise(&second, t->f, &scalar, &error), ADCGS_OK);
        if (!adcgs_model_equal(&first, &second, &error))
            fail_msg("%s", error.text);
        for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
            free(mu[i]);
            free(value[i]);
        }
        adcgs_model_clear(&first, NULL);
        adcgs_model_clear(&second, NULL);
        adcgs_trainer_free(&t);
    }
}

/** True if a value is so near the middle between two levels that either is right. */
static int is_tie(double value, double level, double other)
{
    return fabs(value - (level + other) / 2) < 1e-5 * fabs(level - other);
}

/** The values that rounding passes to the networks are the decoded ones, adaptive steps included. */
static void rounding_is_decoding(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    float *mu[ADCGS_P_ANCHOR], *value[ADCGS_P_ANCHOR];
    adcgs_model model;
    uint32_t stop = 180, adapted = 0, ties = 0;
    run(t, stop_at, &stop);
    take_values(t->f, mu, value);
    const adcgs_quantise_options options = {.cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor, .value = value};
    assert_int_equal(adcgs_quantise(&model, t->f, &options, &error), ADCGS_OK);
    adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_ROUND});
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        for (uint32_t a = 0; a < t->f->n; a++)
            for (int r = 0; r < adcgs_fmodel_rows(t->f, i); r++) {
                const size_t at = (size_t)(adcgs_fmodel_at(t->f, i, a, r) - t->f->param[i].p);
                const double want = (double)value[i][at], seen = (double)t->pass->used[i][at];
                if (i == ADCGS_P_FG && !(model.mask[a] >> r / t->f->params.n_fg & 1))
                    continue;
                if (i == ADCGS_P_SIGMA && r >= adcgs_sigma_coded(&model, a))
                    continue;
                if (is_tie((double)t->f->param[i].p[at], seen, want))
                    ties++;
                else
                    assert_float_equal(seen, want, 2e-6 * (1 + fabs(want)));
            }
        free(mu[i]);
        free(value[i]);
    }
    for (uint32_t i = 0; i < t->f->groups * (2u + t->f->params.chunks) * 64; i++)
        adapted += t->pass->factor[i] != 1;
    assert_true(adapted > 0 && ties < 10);
    adcgs_model_clear(&model, NULL);
    adcgs_trainer_free(&t);
}

static int write_flag(void *user, adcgs_adaptive *context, int bit)
{
    adcgs_adaptive_enc(user, context, bit);
    return bit;
}

/** Bytes of the flags of a model of one slice. */
static double flag_bytes(adcgs_model *model)
{
    adcgs_buffer bytes;
    adcgs_range_enc range;
    adcgs_buffer_init(&bytes);
    adcgs_range_enc_init(&range, &bytes);
    assert_int_equal(adcgs_latents_flags(model, 0, model->n, write_flag, &range, NULL), ADCGS_OK);
    adcgs_range_enc_finish(&range);
    const double size = (double)bytes.size;
    adcgs_buffer_clear(&bytes);
    return size;
}

/** The bits that a run reports for each stream after fixing the values are the bits of the stream in the file. */
static void estimated_bits_are_written_bytes(void **state)
{
    enum { LARGE = 1000, FRAMING = 10 }; /* per sub-stream: its length, checksum and end */
    adcgs_train_config config = all_stages_config();
    config.start_anchors = config.max_anchors = 600;
    config.params.k = 6;
    config.tiers = 1; /* each tier has its own flags and sub-streams */
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_stream stream;
    adcgs_buffer bytes;
    double estimate[ADCGS_LAYERS] = {0};
    int large = 0;
    run(t, NULL, NULL);
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
    if (adcgs_encode_verified(&stream, &bytes, t->cpu, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    estimate[0] = flag_bytes(&stream.segments[0]);
    for (int g = 0; g < ADCGS_GROUPS; g++)
        estimate[g < ADCGS_GROUP_FG ? 0 : 1 + g - ADCGS_GROUP_FG] += t->rate.mean_bits[g] / 8;
    for (int i = 0; i < ADCGS_LAYERS; i++) {
        const double written = (double)stream.bytes.layer[i] - FRAMING;
        print_message("layer %d: estimated %.0f bytes, written %.0f (%+.2f %%)\n", i, estimate[i], written,
                      100 * (written / estimate[i] - 1));
        if (written < LARGE)
            continue;
        large++;
        assert_float_equal(written, estimate[i], 0.005 * written);
    }
    assert_int_equal(large, ADCGS_LAYERS);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    adcgs_trainer_free(&t);
}

/** True if channel c of eta, rounded, is an input of 0 to E_fv for every anchor: within an eighth of a step. */
static int eta_is_zero(const adcgs_trainer *t, int c)
{
    const adcgs_fmodel *f = t->f;
    for (uint32_t i = 0; i < f->n; i++) {
        const float *p = adcgs_fmodel_at(f, ADCGS_P_ETA, i, c), mean = t->pass->mu[ADCGS_P_ETA][p - f->param[ADCGS_P_ETA].p];
        const float yq = adcgs_mean_alone(mean) ? mean - ADCGS_MEAN_ALONE : 64 * rintf(*p - mean / 64) + mean;
        if (floorf(yq / 16 + 0.5f) != 0)
            return 0;
    }
    return 1;
}

static void check_reach(const adcgs_trainer *t, int network)
{
    const adcgs_mlp *m = &t->f->mlp[network];
    const float *g = t->f->param[network].g;
    for (int l = 0; l <= m->hidden; l++)
        for (int o = 0; o < m->n_out[l]; o++) {
            assert_true(g[m->b[l] + (size_t)o] != 0);
            for (int j = 0; j < m->in[l]; j++) {
                const int dead = network == ADCGS_P_E_FV && l == 0 && t->stage.rounding && eta_is_zero(t, j);
                if (dead != (g[m->w[l] + (size_t)(o * m->in[l] + j)] == 0))
                    fail_msg("%s, layer %d: weight %d of output %d has %s gradient", t->f->param[network].name, l, j, o,
                             dead ? "a" : "no");
            }
        }
}

/**
 * In each stage the rate alone gives every weight of every entropy network a gradient. Exactly the weights that an input of 0
 * leaves without effect have none.
 */
static void rate_reaches_every_weight(void **state)
{
    static const uint32_t stops[] = {120, 180};
    adcgs_train_config config = all_stages_config();
    config.without_weight_steps = 1; /* coarser lattices, or a price of weights, may leave nothing of a unit */
    config.network_rate = 0;
    for (size_t s = 0; s < ADCGS_COUNTOF(stops); s++) {
        adcgs_trainer *t = make_trainer(&config, pool);
        adcgs_fmodel *f = t->f;
        uint32_t stop = stops[s];
        run(t, stop_at, &stop);
        const adcgs_pass_mode mode = {.quant = t->stage.rounding ? ADCGS_QUANT_ROUND : ADCGS_QUANT_NOISE,
                                      .deform = ADCGS_DEFORM_ALL,
                                      .seed = 5};
        assert_int_equal(t->stage.rounding, s);
        for (int i = 0; i < ADCGS_P_COUNT; i++)
            memset(f->param[i].g, 0, f->param[i].n * sizeof(float));
        adcgs_pass_forward(t->pass, f, 0.5f, &mode);
        memset(t->pass->grad, 0, 16 * (size_t)t->pass->primitives.n * sizeof(float));
        adcgs_pass_backward(t->pass, f, 1, 1, 1, 0, NULL);
        for (size_t j = 0; j < f->param[ADCGS_P_ETA_PRIOR].n; j++)
            assert_true(f->param[ADCGS_P_ETA_PRIOR].g[j] != 0);
        int networks = 0;
        for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
            if (f->mlp[i].entropy && f->mlp[i].n) {
                check_reach(t, i);
                networks++;
            }
        assert_int_equal(networks, 4 + f->params.chunks);
        adcgs_trainer_free(&t);
    }
}

/** The first view's image of the current model, 32 x 32. */
static void draw(adcgs_trainer *t, float image[3 * 32 * 32])
{
    adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.deform = 1});
    if (adcgs_raster_forward(t->raster, &t->pass->primitives, &t->views.list[0].view, scene->background, 0.3f, image, 0, &error))
        fail_msg("%s", error.text);
}

/** The image from the decoded, quantised values equals the trainer's image. */
static void check_picture(adcgs_trainer *t)
{
    static float here[3 * 32 * 32], there[3 * 32 * 32];
    float *value[ADCGS_P_ANCHOR];
    adcgs_model model;
    adcgs_splat *splat;
    adcgs_primitives primitives;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        value[i] = t->f->param[i].p;
    const adcgs_quantise_options options = {.cpu = t->cpu, .value = value};
    assert_int_equal(adcgs_quantise(&model, t->f, &options, &error), ADCGS_OK);
    assert_int_equal(adcgs_splat_create(&splat, &model, t->cpu, NULL, NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_splat_at(splat, 0.5f, &primitives, &error), ADCGS_OK);
    draw(t, here);
    if (adcgs_raster_forward(t->raster, &primitives, &t->views.list[0].view, scene->background, 0.3f, there, 0, &error))
        fail_msg("%s", error.text);
    print_message("decoded image against the trainer's: %.1f dB\n", adcgs_psnr(here, there, ADCGS_COUNTOF(here)));
    assert_true(adcgs_psnr(here, there, ADCGS_COUNTOF(here)) > 70);
    adcgs_splat_free(&splat);
    adcgs_model_clear(&model, NULL);
}

/** Motion has to pay for a part of its networks only, since most of their hidden units are pruned later. */
static void motion_pays_for_little(void **state)
{
    const adcgs_train_config config = all_stages_config();
    for (int much = 0; much < 2; much++) {
        adcgs_trainer *t = make_trainer(&config, pool);
        uint32_t stop = 90, moving = 0;
        double stopped, moved;
        run(t, stop_at, &stop);
        assert_int_equal(adcgs_sample_loss(t, 32, 0, &stopped, &error), ADCGS_OK);
        assert_int_equal(adcgs_sample_loss(t, 32, 1, &moved, &error), ADCGS_OK);
        const double bits = 7.0 * (double)(t->f->mlp[ADCGS_P_OMEGA].n + t->f->mlp[ADCGS_P_VARPI].n + t->f->mlp[ADCGS_P_TIME].n);
        print_message("loss without motion %g, with motion %g\n", stopped, moved);
        assert_true(stopped > 1.01 * moved);
        t->rate.lambda = (much ? 20 : 2) * (stopped - 1.01 * moved) / bits * 0x1p23;
        assert_int_equal(adcgs_test_motion_gain(t, &error), ADCGS_OK);
        for (uint32_t i = 0; i < t->f->n; i++)
            moving += t->f->moving[i] != 0;
        assert_true(much ? moving == 0 : moving > 0);
        adcgs_trainer_free(&t);
    }
}

/** A stream of a model in which no anchor moves has no networks, table or flags for motion. */
static void still_models_carry_no_motion(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_stream stream;
    adcgs_buffer bytes;
    uint32_t stop = 180;
    run(t, stop_at, &stop);
    memset(t->f->moving, 0, (size_t)t->f->groups * 64 * sizeof *t->f->moving);
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
    const adcgs_model *m = &stream.segments[0];
    assert_int_equal(stream.params.time_rows + stream.params.time_width + m->params.time_rows, 0);
    assert_int_equal(stream.params.spans + m->params.spans, 0);
    assert_int_equal(adcgs_net_outputs(&m->net[ADCGS_ROLE_ENTROPY_SIGMA]), 12);
    assert_false(m->net[ADCGS_ROLE_COARSE].present || m->net[ADCGS_ROLE_FINE].present || m->net[ADCGS_ROLE_TIME].present);
    if (adcgs_encode_verified(&stream, &bytes, t->cpu, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    check_picture(t);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    adcgs_trainer_free(&t);
}

/* ---- Without compression ---- */

/** PSNR between the image of the model and the image of its quantised values, which replace the model's values. */
static double loss_of_quantisation(adcgs_trainer *t, adcgs_model *model)
{
    static float before[3 * 32 * 32], after[3 * 32 * 32];
    float *value[ADCGS_P_ANCHOR];
    draw(t, before);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        value[i] = t->f->param[i].p;
    const adcgs_quantise_options options = {.cpu = t->cpu, .value = value};
    assert_int_equal(adcgs_quantise(model, t->f, &options, &error), ADCGS_OK);
    draw(t, after);
    return adcgs_psnr(before, after, ADCGS_COUNTOF(before));
}

static uint32_t drawing_weights(const adcgs_model *model)
{
    uint32_t n = 0;
    for (int role = ADCGS_ROLE_PREDICTION; role < ADCGS_ROLES; role++)
        n += adcgs_net_weights(&model->net[role]);
    return n;
}

static void uncompressed_models_lose_nothing(void **state)
{
    adcgs_train_config config = all_stages_config();
    config.without_rate = config.without_rounding = 1;
    adcgs_trainer *t = make_trainer(&config, pool), *other = make_trainer(&config, pool);
    adcgs_model model, coarse;
    adcgs_buffer bytes;
    run(t, NULL, NULL);
    run(other, NULL, NULL);
    const double usual = loss_of_quantisation(other, &coarse);
    adcgs_raw_prepare(t->f);
    const double finest = loss_of_quantisation(t, &model);
    print_message("quantisation: %.1f dB with the usual steps, %.1f dB with the finest\n", usual, finest);
    assert_true(finest > 55 && finest > usual + 10);
    assert_int_equal(adcgs_model_validate(&model, &error), ADCGS_OK);
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_raw_write(&model, &bytes, &error), ADCGS_OK);
    uint32_t primitives = 0;
    for (uint32_t i = 0; i < model.n; i++)
        primitives += (uint32_t)__builtin_popcount(model.mask[i]);
    uint32_t lives = 0;
    for (uint32_t i = 0; i < model.n; i++)
        lives += model.is_static[i] == 0;
    const uint32_t numbers = model.n * (3 + config.params.n_fv + 6 + 3) + 5 * lives + primitives * config.params.n_fg;
    assert_int_equal(bytes.size, 4 * (numbers + drawing_weights(&model)));
    float first[3];
    memcpy(first, bytes.data, sizeof first);
    for (int a = 0; a < 3; a++)
        assert_true(fabsf(first[a] - t->f->x[a * 64]) < 1e-6f);
    adcgs_buffer_clear(&bytes);
    adcgs_model_clear(&model, NULL);
    adcgs_model_clear(&coarse, NULL);
    adcgs_trainer_free(&t);
    adcgs_trainer_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decoded_values_are_their_own_quantisation),
        cmocka_unit_test(rounding_is_decoding),
        cmocka_unit_test(estimated_bits_are_written_bytes),
        cmocka_unit_test(rate_reaches_every_weight),
        cmocka_unit_test(motion_pays_for_little),
        cmocka_unit_test(still_models_carry_no_motion),
        cmocka_unit_test(uncompressed_models_lose_nothing),
    };
    return cmocka_run_group_tests_name("quantise", tests, open_scene, close_scene);
}
