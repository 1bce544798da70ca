/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs that go on with the segment before: the float model made of a model is quantised to the same model again, what is settled
 * stays to the bit and is found again in the model that results, and stopping changes nothing.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "fmodel/from_model.h"
#include "model/keep.h"
#include "train/release.h"
#include "train/trainer.h"
#include "train/views.h"

static adcgs_train_config follow_config(void)
{
    adcgs_train_config c = small_config();
    c.rdo_strength = 1;
    c.params.adaptive_steps = 1;
    c.params.spans = 1;
    return c;
}

static adcgs_trainer *make(const adcgs_train_config *config, const adcgs_model *before, adcgs_pool *threads)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create_after(&t, scene, config, before, adcgs_cpu_best(), threads, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    t->f->is_part = 1;
    return t;
}

static void run(adcgs_trainer *t, adcgs_train_observe observe, void *user)
{
    int stopped;
    if (adcgs_trainer_run(t, observe, user, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** The model of a run's end. */
static void take_model(adcgs_model *model, const adcgs_fmodel *f)
{
    const adcgs_quantise_options options = { .cpu = adcgs_cpu_best() };
    if (adcgs_quantise(model, f, &options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    model->time_end = scene->duration;
}

static void learn(adcgs_model *model, const adcgs_model *before)
{
    const adcgs_train_config config = follow_config();
    adcgs_trainer *t = make(&config, before, pool);
    run(t, NULL, NULL);
    take_model(model, t->f);
    adcgs_trainer_free(&t);
}

static void float_models_come_back(void **state)
{
    const adcgs_train_config config = follow_config();
    adcgs_model model, again;
    adcgs_fmodel *f;
    (void)state;
    learn(&model, NULL);
    if (adcgs_fmodel_from_model(&f, &model, &config.shape, 7, adcgs_cpu_best(), &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    f->is_part = 1;
    take_model(&again, f);
    if (!adcgs_model_equal(&model, &again, &error))
        fail_msg("%s", error.text);
    adcgs_fmodel_free(&f);
    adcgs_model_clear(&again, NULL);

    adcgs_shape other = config.shape;
    other.depth--;
    assert_int_equal(adcgs_fmodel_from_model(&f, &model, &other, 7, adcgs_cpu_best(), &error), ADCGS_ERR_DATA);
    other = config.shape;
    other.theta_width = 1;
    assert_int_equal(adcgs_fmodel_from_model(&f, &model, &other, 7, adcgs_cpu_best(), &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "another shape"));
    adcgs_model_clear(&model, NULL);
}

static uint32_t settled(const adcgs_fmodel *f)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < f->n; i++)
        n += f->learns[i] == 0;
    return n;
}

/** The model before can be followed, at least what is settled is kept of it, and stays to the bit. */
static void what_is_settled_is_kept(void **state)
{
    const adcgs_train_config config = follow_config();
    adcgs_model before, model;
    adcgs_keep kept = { .n = 0 };
    (void)state;
    learn(&before, NULL);
    adcgs_trainer *t = make(&config, &before, pool);
    const uint32_t first = settled(t->f);
    assert_true(first > 0 && first <= before.n);
    t->released = UINT8_MAX; /* so short a run leaves much to wish for: all would learn again */
    run(t, NULL, NULL);
    take_model(&model, t->f);
    assert_true(adcgs_kept_possible(&before, &model, &error));
    assert_int_equal(adcgs_kept_find(&kept, &before, &model, &error), ADCGS_OK);
    assert_true(settled(t->f) > 0 && settled(t->f) <= first);
    assert_in_range(kept.n, settled(t->f), before.n);
    adcgs_kept_clear(&kept, NULL);
    adcgs_model_clear(&model, NULL);
    adcgs_model_clear(&before, NULL);
    adcgs_trainer_free(&t);
}

static void store(adcgs_trainer *t, adcgs_buffer *out)
{
    t->elapsed = 0;
    adcgs_buffer_init(out);
    assert_int_equal(adcgs_trainer_store(t, out, &error), ADCGS_OK);
}

/** Stopped in each stage and restored, and with other threads, a run ends where it does otherwise. */
static void stopping_changes_nothing(void **state)
{
    static const uint32_t stops[] = { 0, 60, 150, 190 };
    const adcgs_train_config config = follow_config();
    adcgs_model before, other;
    adcgs_buffer end, middle, again;
    (void)state;
    learn(&before, NULL);
    adcgs_trainer *through = make(&config, &before, pool), *stopping = make(&config, &before, NULL);
    run(through, NULL, NULL);
    store(through, &end);
    for (size_t i = 0; i < ADCGS_COUNTOF(stops); i++) {
        uint32_t stop = stops[i];
        run(stopping, stop_at, &stop);
        store(stopping, &middle);
        adcgs_trainer *restored = make(&config, &before, pool);
        assert_int_equal(adcgs_trainer_restore(restored, middle.data, middle.size, &error), ADCGS_OK);
        run(restored, NULL, NULL);
        store(restored, &again);
        assert_int_equal(again.size, end.size);
        assert_memory_equal(again.data, end.data, end.size);
        adcgs_buffer_clear(&again);
        adcgs_trainer_free(&restored);
        if (i + 1 < ADCGS_COUNTOF(stops))
            adcgs_buffer_clear(&middle);
    }
    /* It is bound to the model that it goes on with. */
    learn(&other, &before);
    adcgs_trainer *stranger = make(&config, &other, NULL);
    assert_int_equal(adcgs_trainer_restore(stranger, middle.data, middle.size, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "another segment before it"));
    adcgs_trainer_free(&stranger);
    adcgs_model_clear(&other, NULL);
    adcgs_buffer_clear(&middle);
    adcgs_buffer_clear(&end);
    adcgs_trainer_free(&stopping);
    adcgs_trainer_free(&through);
    adcgs_model_clear(&before, NULL);
}

/** What stands still and has become darker learns again, but for what no picture shows. */
static void what_has_changed_learns(void **state)
{
    const adcgs_train_config config = follow_config();
    adcgs_model before;
    (void)state;
    learn(&before, NULL);
    memset(before.is_static, 1, before.n);
    memset(before.body, 0, before.n);
    for (uint32_t i = 0; i < before.n * ADCGS_COLOUR_N; i++)
        before.colour[i] = -2000;
    adcgs_trainer *t = make(&config, &before, NULL);
    assert_int_equal(settled(t->f), before.n);
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    assert_int_equal(adcgs_release_step(t, 0, &error), ADCGS_OK);
    assert_in_range(settled(t->f), 0, before.n * 6 / 10);
    assert_int_equal(t->released, 1);
    const uint32_t left = settled(t->f);
    assert_int_equal(adcgs_release_step(t, 0, &error), ADCGS_OK); /* it is not asked again at once */
    assert_int_equal(settled(t->f), left);
    adcgs_trainer_free(&t);
    adcgs_model_clear(&before, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(float_models_come_back),
        cmocka_unit_test(what_is_settled_is_kept),
        cmocka_unit_test(stopping_changes_nothing),
        cmocka_unit_test(what_has_changed_learns),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
