/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs that continue the segment before. The float model made from a model quantises to the same model. Frozen anchors stay to
 * the bit and are found again in the resulting model. Stopping changes nothing.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "fmodel/body_trajectories.h"
#include "fmodel/from_model.h"
#include "geometry/rotation.h"
#include "model/inter.h"
#include "train/continue_bodies.h"
#include "train/density/unfreeze.h"
#include "train/train_views.h"
#include "train/trainer.h"

static adcgs_train_config follow_config(void)
{
    adcgs_train_config c = small_config();
    c.params.adaptive_steps = 1;
    c.params.spans = 1;
    return c;
}

static adcgs_trainer *make(const adcgs_train_config *config, const adcgs_model *before, adcgs_pool *threads)
{
    adcgs_trainer *t;
    const adcgs_trainer_input input = {.before = before};
    if (adcgs_trainer_create_from(&t, scene, config, &input, adcgs_cpu_best(), threads, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    t->f->is_part = 1;
    return t;
}

/** The model at the end of a run. */
static void take_model(adcgs_model *model, const adcgs_fmodel *f)
{
    const adcgs_quantise_options options = {.cpu = adcgs_cpu_best()};
    if (adcgs_quantise(model, f, &options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    model->time_end = scene->duration;
}

static void learn(adcgs_model *model, const adcgs_model *before)
{
    const adcgs_train_config config = follow_config();
    adcgs_trainer *t = make(&config, before, pool);
    run_trainer(t, NULL, NULL);
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
        n += f->trainable[i] == 0;
    return n;
}

/** If a segment has a crossfade after its end, the next one's time table starts at that end. */
static void time_begins_where_the_next_does(void **state)
{
    const adcgs_train_config config = follow_config();
    adcgs_model before;
    adcgs_fmodel *f;
    (void)state;
    learn(&before, NULL);
    before.time_end = before.reach = scene->duration / 2; /* its end is the middle of its time */
    assert_int_equal(adcgs_fmodel_from_model(&f, &before, &config.shape, 7, adcgs_cpu_best(), &error), ADCGS_OK);
    adcgs_trainer *t = make(&config, &before, pool);
    const size_t rows = f->params.time_rows, columns = (size_t)adcgs_fmodel_time_columns(&f->params), below = (rows - 1) / 2;
    const float *was = f->param[ADCGS_P_TIME].p, *is = t->f->param[ADCGS_P_TIME].p;
    assert_true(rows > 2);
    for (size_t i = 0; i < f->params.time_width; i++) {
        const float middle = (was[below * columns + i] + was[(rows - 1 - below) * columns + i]) / 2;
        for (size_t r = 0; r < rows; r++)
            assert_float_equal(is[r * columns + i], middle, 1e-5);
    }
    adcgs_trainer_free(&t);
    adcgs_fmodel_free(&f);
    adcgs_model_clear(&before, NULL);
}

/** Prediction from the model before is possible. At least the frozen anchors are predicted, and they stay to the bit. */
static void test_frozen_anchors_are_predicted(void **state)
{
    const adcgs_train_config config = follow_config();
    adcgs_model before, model;
    adcgs_inter kept = {.n = 0};
    (void)state;
    learn(&before, NULL);
    adcgs_trainer *t = make(&config, &before, pool);
    const uint32_t first = settled(t->f);
    assert_true(first > 0 && first <= before.n);
    t->stage.unfreeze_tests = UINT8_MAX; /* a run this short leaves large errors, and would unfreeze everything */
    run_trainer(t, NULL, NULL);
    take_model(&model, t->f);
    assert_true(adcgs_inter_possible(&before, &model, &error));
    assert_int_equal(adcgs_inter_find(&kept, &before, &model, &error), ADCGS_OK);
    assert_true(settled(t->f) > 0 && settled(t->f) <= first);
    assert_in_range(kept.n, settled(t->f), before.n);
    adcgs_inter_clear(&kept, NULL);
    adcgs_model_clear(&model, NULL);
    adcgs_model_clear(&before, NULL);
    adcgs_trainer_free(&t);
}

/** A run that stops in each stage and is restored, with other threads, ends like one that never stopped. */
static void stopping_changes_nothing(void **state)
{
    static const uint32_t stops[] = {0, 60, 150, 190};
    const adcgs_train_config config = follow_config();
    adcgs_model before, other;
    adcgs_buffer end, middle, again;
    (void)state;
    learn(&before, NULL);
    adcgs_trainer *through = make(&config, &before, pool), *stopping = make(&config, &before, NULL);
    run_trainer(through, NULL, NULL);
    store(through, &end);
    for (size_t i = 0; i < ADCGS_COUNTOF(stops); i++) {
        uint32_t stop = stops[i];
        run_trainer(stopping, stop_at, &stop);
        store(stopping, &middle);
        adcgs_trainer *restored = make(&config, &before, pool);
        assert_int_equal(adcgs_trainer_restore(restored, middle.data, middle.size, &error), ADCGS_OK);
        run_trainer(restored, NULL, NULL);
        store(restored, &again);
        assert_int_equal(again.size, end.size);
        assert_memory_equal(again.data, end.data, end.size);
        adcgs_buffer_clear(&again);
        adcgs_trainer_free(&restored);
        if (i + 1 < ADCGS_COUNTOF(stops))
            adcgs_buffer_clear(&middle);
    }
    /* A checkpoint belongs to the model that it continues. */
    learn(&other, &before);
    adcgs_trainer *stranger = make(&config, &other, NULL);
    assert_int_equal(adcgs_trainer_restore(stranger, middle.data, middle.size, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "another previous segment"));
    adcgs_trainer_free(&stranger);
    adcgs_model_clear(&other, NULL);
    adcgs_buffer_clear(&middle);
    adcgs_buffer_clear(&end);
    adcgs_trainer_free(&stopping);
    adcgs_trainer_free(&through);
    adcgs_model_clear(&before, NULL);
}

/** Frozen static anchors that became darker than the images are unfrozen, except those that no image shows. */
static void test_changed_anchors_are_unfrozen(void **state)
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
    assert_int_equal(adcgs_unfreeze_step(t, 0, &error), ADCGS_OK);
    assert_in_range(settled(t->f), 0, before.n * 6 / 10);
    assert_int_equal(t->stage.unfreeze_tests, 1);
    const uint32_t left = settled(t->f);
    assert_int_equal(adcgs_unfreeze_step(t, 0, &error), ADCGS_OK); /* the check does not run again at once */
    assert_int_equal(settled(t->f), left);
    adcgs_trainer_free(&t);
    adcgs_model_clear(&before, NULL);
}

/* ---- Bodies ---- */

/** R(q) (x - pivot) + pivot + way. */
static void place(const adcgs_stereo_pose *p, const double pivot[3], const double x[3], double out[3])
{
    double r[12];
    adcgs_rotation_to_pose(p->q, r);
    for (int i = 0; i < 3; i++) {
        out[i] = pivot[i] + p->way[i];
        for (int a = 0; a < 3; a++)
            out[i] += r[4 * i + a] * (x[a] - pivot[a]);
    }
}

/** Pose after t of a body that turns about an axis of its own and flies. */
static adcgs_stereo_pose truth(int body, double t)
{
    static const double turn[2][3] = {{0.3, -0.8, 0.5}, {-0.2, 0.1, 0.9}};
    static const double way[2][3] = {{0.2, 0.05, -0.1}, {-0.3, 0.1, 0}};
    adcgs_stereo_pose p;
    adcgs_rotation_exp(turn[body], t, p.q);
    for (int a = 0; a < 3; a++)
        p.way[a] = way[body][a] * t;
    return p;
}

enum { FOUND = 3, SEEN = 4 };

/** A model with two bodies, last posed at t = 1. */
static adcgs_fmodel *make_bodies(void)
{
    static const uint32_t pos[][3] = {{10, 10, 10}, {14, 12, 13}, {40, 44, 40}, {46, 46, 47}};
    static const double zero[3] = {0, 0, 0};
    const float origin[3] = {-0.5f, -0.5f, -0.5f};
    adcgs_train_config c = follow_config();
    adcgs_fmodel *f;
    c.params.bodies = 4;
    c.params.time_rows = 2;
    c.shape.depth = 6;
    assert_int_equal(adcgs_fmodel_create(&f, &c.params, &c.shape, origin, 1.0f / 64, pos, 4, 1, &error), ADCGS_OK);
    for (uint32_t i = 0; i < 4; i++)
        f->body[i] = i < 2 ? 3 : 1; /* numbers 2 and 4 are free */
    adcgs_bodies_recentre(f);
    for (int b = 0; b < 2; b++) {
        const adcgs_stereo_pose left = truth(b, 1);
        adcgs_bodies_set_pose(f, b ? 1 : 3, 0, left.q, zero, left.way);
    }
    return f;
}

/** Sets the pose p of a body at a time, relative to its place at t = 1 + 2/3, as stereo finds it. */
static void see_pose(adcgs_stereo_pose *p, int body, double t, const double pivot[3])
{
    static const double zero[3] = {0, 0, 0};
    const adcgs_stereo_pose now = truth(body, t), then = truth(body, 1 + 2 / 3.0);
    const double back[4] = {then.q[0], -then.q[1], -then.q[2], -then.q[3]};
    double at[3];
    /* x rests at T(then) x0 and moves by T(now) T(then)^-1; the translation of that pose is the pivot's. */
    const adcgs_stereo_pose inverse = {{back[0], back[1], back[2], back[3]}, {0, 0, 0}};
    double moved[3] = {pivot[0] - then.way[0], pivot[1] - then.way[1], pivot[2] - then.way[2]}, x0[3];
    place(&inverse, zero, moved, x0);
    place(&now, zero, x0, at);
    adcgs_rotation_multiply(now.q, back, p->q);
    for (int a = 0; a < 3; a++)
        p->way[a] = at[a] - pivot[a];
}

/** Both bodies of the model and a third one, in another order, each with a point. */
static adcgs_stereo see_bodies(const adcgs_fmodel *f)
{
    static const double pivot[3] = {0.1, -0.2, 0.05}, zero[3] = {0, 0, 0};
    adcgs_stereo found = {.n_frames = SEEN, .n_bodies = FOUND, .n_moving = FOUND};
    found.frame_time = adcgs_alloc(NULL, SEEN, sizeof *found.frame_time, &error);
    found.body = adcgs_alloc(NULL, FOUND, sizeof *found.body, &error);
    found.moving = adcgs_alloc(NULL, FOUND, sizeof *found.moving, &error);
    for (int m = 0; m < SEEN; m++)
        found.frame_time[m] = (float)m / (SEEN - 1);
    for (int i = 0; i < FOUND; i++) {
        const int b = i == 0 ? 1 : i == 2 ? 0 : -1; /* the one in the middle is new */
        found.body[i].pose = adcgs_alloc(NULL, SEEN, sizeof *found.body[i].pose, &error);
        memcpy(found.body[i].pivot, pivot, sizeof pivot);
        found.moving[i] = (adcgs_stereo_point){.x = {0.4, 0.4, -0.4}, .moves = 1, .body = (uint8_t)(i + 1)};
        for (int m = 0; m < SEEN; m++)
            see_pose(&found.body[i].pose[m], b < 0 ? 0 : b, 1 + m / (SEEN - 1.0), pivot);
        if (b >= 0) { /* its point is the centre of its anchors at the first time */
            const float *centre = f->centre[b ? 0 : 2];
            const double x[3] = {(double)centre[0], (double)centre[1], (double)centre[2]};
            const adcgs_stereo_pose left = truth(b, 1);
            place(&left, zero, x, found.moving[i].x);
        }
    }
    return found;
}

/**
 * The model has two bodies, last posed at t = 1. Stereo finds these and a third one, in another order, by points in their places
 * at t = 1 + 2/3 and with poses relative to that time. Each known body is recognised, and gets poses relative to its rest
 * position in the model.
 */
static void bodies_are_found_again(void **state)
{
    static const double zero[3] = {0, 0, 0};
    adcgs_fmodel *f = make_bodies();
    adcgs_stereo found = see_bodies(f);
    (void)state;
    assert_int_equal(adcgs_continue_bodies(f, &found, &error), ADCGS_OK);
    assert_int_equal(found.n_bodies, 4);
    assert_int_equal(found.moving[0].body, 1);
    assert_int_equal(found.moving[1].body, 2);
    assert_int_equal(found.moving[2].body, 3);
    assert_true(found.body[0].pose && found.body[1].pose && found.body[2].pose && !found.body[3].pose);
    for (int b = 0; b < 2; b++)
        for (int m = 0; m < SEEN; m++) {
            const adcgs_stereo_body *body = &found.body[b ? 0 : 2];
            const adcgs_stereo_pose wanted = truth(b, 1 + m / (SEEN - 1.0));
            const double x[3] = {0.03, 0.21, -0.17};
            double here[3], there[3];
            place(&body->pose[m], body->pivot, x, here);
            place(&wanted, zero, x, there);
            for (int a = 0; a < 3; a++)
                assert_float_equal(here[a], there[a], 1e-5);
        }
    adcgs_stereo_clear(&found);
    adcgs_fmodel_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(float_models_come_back),
        cmocka_unit_test(time_begins_where_the_next_does),
        cmocka_unit_test(test_frozen_anchors_are_predicted),
        cmocka_unit_test(stopping_changes_nothing),
        cmocka_unit_test(test_changed_anchors_are_unfrozen),
        cmocka_unit_test(bodies_are_found_again),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
