/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs with unsuitable inputs: steps too long, no steps at all, points that no camera sees, images without any known pixel. The
 * runs end well, or report the reason.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "train/exposure/contrast.h"
#include "train/schedule.h"
#include "train/train_views.h"

#include <math.h>

/* ---- Steps ---- */

/** A step that destroys the scene at once is detected and rolled back, until steps are short enough. */
static void lost_pictures_are_learnt_anew(void **state)
{
    static const char *const too_long[] = {"lr_scale_prediction=100", "lr_scale_motion=100", "lr_scale_prediction=10"};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(too_long); i++) {
        adcgs_train_config config = small_config();
        assert_int_equal(adcgs_train_set(&config, too_long[i], &error), ADCGS_OK);
        adcgs_trainer *t = make_trainer(&config, pool);
        int stopped;
        if (adcgs_trainer_run(t, NULL, NULL, &stopped, &error) != ADCGS_OK)
            fail_msg("%s: %s", too_long[i], error.text);
        assert_true(i < 2 ? t->run.rollbacks > 0 : t->run.rollbacks == 0);
        assert_true(!adcgs_trainer_is_lost(t));
        assert_true(t->rate.contrast > 0 && t->rate.lambda < (double)config.lambda); /* also after a rollback to the start */
        adcgs_trainer_free(&t);
    }
}

/** A learning rate of 0 leaves a group unchanged and is no reason to stop. */
static void test_zero_rate_changes_nothing(void **state)
{
    adcgs_train_config config = small_config();
    int stopped;
    (void)state;
    assert_int_equal(adcgs_train_set(&config, "lr_scale_prediction=0", &error), ADCGS_OK);
    for (int i = 0; i <= 10; i++)
        assert_float_equal(adcgs_train_rate(&config, 0, 0, i / 10.0), 0, 0);
    config.prune_units_at = config.prune_units_again = 2;
    config.without_rounding = 1;
    adcgs_trainer *t = make_trainer(&config, pool);
    const adcgs_param *p = &t->f->param[ADCGS_P_THETA];
    float *before = calloc(p->n, sizeof *before);
    memcpy(before, p->p, p->n * sizeof *before);
    if (adcgs_trainer_run(t, NULL, NULL, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(t->run.rollbacks, 0);
    for (size_t i = 0; i < p->n; i++)
        assert_float_equal(p->p[i], before[i], 1e-6); /* a mean of equal values may be off by a rounding */
    free(before);
    adcgs_trainer_free(&t);
}

/* ---- Points and images ---- */

enum { POINTS = 100 };

/** Puts points around a place. */
static void put_points(adcgs_scene *s, float at)
{
    assert_int_equal(adcgs_points_alloc(&s->points, POINTS, "points", &error), ADCGS_OK);
    for (int i = 0; i < POINTS; i++)
        for (int a = 0; a < 3; a++)
            s->points.position[i][a] = (double)(at + 0.01f * (float)(i * (a + 1) % 10));
}

/** Points in other units than the poses would become anchors that no image constrains. */
static void points_that_no_camera_sees_are_refused(void **state)
{
    static const float places[] = {0, 1000, -20, 1e30f};
    const adcgs_train_config config = small_config();
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(places); i++) {
        adcgs_scene with = *scene;
        adcgs_trainer *t;
        put_points(&with, places[i]);
        const adcgs_status status = adcgs_trainer_create(&t, &with, &config, adcgs_cpu_best(), pool, &error);
        assert_int_equal(status, i ? ADCGS_ERR_DATA : ADCGS_OK);
        assert_true(!i || strstr(error.text, "units")); /* of the points, or of a consequence */
        adcgs_trainer_free(&t);
        adcgs_points_free(&with.points);
    }
}

/** Unknown pixels do not count in the contrast, and so not in lambda. */
static void test_contrast_of_known_pixels(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    double contrast;
    (void)state;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    for (int known = 2; known >= 0; known--) { /* one in `known` pixels is known, black and white alternately */
        for (uint32_t i = 0; i < t->views.n; i++) {
            const size_t plane = (size_t)t->views.list[i].view.width * (size_t)t->views.list[i].view.height;
            for (size_t j = 0; j < plane; j++)
                for (size_t c = 0; c < 3; c++)
                    t->taken[c * plane + j] = !known || (known == 2 && j % 2) ? (float)NAN : (float)(j / 2 % 2);
            assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
        }
        assert_int_equal(adcgs_contrast(t, &contrast, &error), ADCGS_OK);
        assert_float_equal(contrast, known ? 0.5 : 0, 1e-9);
    }
    adcgs_trainer_free(&t);
}

/* ---- Ends ---- */

/** A run can be finalised for the stream at any time, except before its first iteration and after it diverged. */
static void test_run_ends_in_any_stage(void **state)
{
    static const uint32_t stops[] = {60, 198};
    const adcgs_train_config config = small_config();
    adcgs_train_report report;
    adcgs_trainer *t = make_trainer(&config, pool);
    (void)state;
    assert_int_equal(adcgs_trainer_finish(t, &report, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "before its first iteration"));
    for (size_t i = 0; i < ADCGS_COUNTOF(stops); i++) {
        uint32_t stop = stops[i];
        int stopped;
        adcgs_stream stream;
        assert_int_equal(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error), ADCGS_OK);
        adcgs_trainer *other = make_trainer(&config, pool);
        adcgs_buffer bytes;
        adcgs_buffer_init(&bytes);
        assert_int_equal(adcgs_trainer_store(t, &bytes, &error), ADCGS_OK);
        assert_int_equal(adcgs_trainer_restore(other, bytes.data, bytes.size, &error), ADCGS_OK);
        if (adcgs_trainer_finish(other, &report, &error) != ADCGS_OK)
            fail_msg("at %u: %s", t->run.iteration, error.text);
        assert_true(other->stage.frozen && other->stage.rounding && other->stage.pruned && other->views.divide == 1);
        assert_int_equal(report.iteration, t->run.iteration);
        bytes.size = 0;
        assert_int_equal(adcgs_encode_stream(&stream, other, NULL, 0, &error), ADCGS_OK);
        assert_int_equal(adcgs_encode_verified(&stream, &bytes, t->cpu, pool, &error), ADCGS_OK);
        adcgs_stream_clear(&stream, NULL);
        adcgs_buffer_clear(&bytes);
        adcgs_trainer_free(&other);
    }
    t->f->param[ADCGS_P_FV].p[0] = NAN;
    assert_int_equal(adcgs_trainer_finish(t, &report, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "has diverged at iteration 200"));
    adcgs_trainer_free(&t);
}

/* ---- Checkpoints ---- */

/** Corrupts a value that the run's checkpoint will hold; 0 if there is no such case. */
static int spoil(adcgs_trainer *t, int way)
{
    adcgs_fmodel *f = t->f;
    switch (way) {
    case 0:
        t->curriculum.n = t->views.n + 1;
        break;
    case 1:
        t->curriculum.last = f->params.time_rows;
        break;
    case 2:
        t->curriculum.first = -1;
        break;
    case 3:
        f->body[1] = (uint8_t)(f->params.bodies + 1);
        break;
    case 4:
        f->tier[2] = (uint8_t)(f->finest + 1);
        break;
    case 5:
        f->growth[0] = 255;
        break;
    case 6:
        f->pos[3][1] = 1U << f->shape.depth;
        break;
    case 7:
        memcpy(f->pos[3], f->pos[2], sizeof f->pos[3]);
        break;
    case 8:
        f->keep[5] = 0.5f;
        break;
    case 9:
        f->moving[5] = NAN;
        break;
    case 10:
        f->mlp[ADCGS_P_THETA].weight_step[0] = -1;
        break;
    case 11:
        t->run.lr_scale = INFINITY;
        break;
    case 12:
        t->rate.lambda = NAN;
        break;
    case 13:
        t->stage.units_pruned = 3;
        break;
    case 14:
        t->stage.frozen = 1;
        break;
    case 15:
        t->run.elapsed.clock = -1;
        break;
    default:
        return 0;
    }
    return 1;
}

/** A checkpoint that no run can write is refused, if later stages would index beyond an array because of it. */
static void impossible_checkpoints_are_refused(void **state)
{
    const adcgs_train_config config = small_config();
    uint32_t stop = 30;
    int stopped, way = 0, more = 1;
    (void)state;
    for (; more; way++) {
        adcgs_trainer *t = make_trainer(&config, pool), *other = make_trainer(&config, pool);
        adcgs_buffer bytes;
        assert_int_equal(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error), ADCGS_OK);
        more = spoil(t, way);
        adcgs_buffer_init(&bytes);
        assert_int_equal(adcgs_trainer_store(t, &bytes, &error), ADCGS_OK);
        const adcgs_status status = adcgs_trainer_restore(other, bytes.data, bytes.size, &error);
        if (status != (more ? ADCGS_ERR_DATA : ADCGS_OK))
            fail_msg("way %d: %d", way, status);
        adcgs_buffer_clear(&bytes);
        adcgs_trainer_free(&t);
        adcgs_trainer_free(&other);
    }
    assert_int_equal(way, 17);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lost_pictures_are_learnt_anew),
        cmocka_unit_test(test_zero_rate_changes_nothing),
        cmocka_unit_test(points_that_no_camera_sees_are_refused),
        cmocka_unit_test(test_contrast_of_known_pixels),
        cmocka_unit_test(test_run_ends_in_any_stage),
        cmocka_unit_test(impossible_checkpoints_are_refused),
    };
    return cmocka_run_group_tests_name("recovery", tests, open_scene, close_scene);
}
