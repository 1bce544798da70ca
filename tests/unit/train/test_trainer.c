/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whole training runs in miniature: checkpoints, recovery from values that are not numbers, tiers. */
#include "training_runs.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "splat/splat.h"

#include <math.h>

/** Mean squared difference between the image of the first tiers and that of all tiers. */
static double wrong_with(const adcgs_trainer *t, const adcgs_model *model, int tiers)
{
    const adcgs_view *view = &t->views.list[0].view;
    const size_t n = 3 * (size_t)view->width * (size_t)view->height;
    float *picture[2] = {calloc(n, sizeof(float)), calloc(n, sizeof(float))};
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        adcgs_model part;
        adcgs_splat *splat;
        adcgs_primitives primitives;
        assert_int_equal(adcgs_model_coarser(&part, model, i ? tiers : model->finest + 1, NULL, &error), ADCGS_OK);
        assert_int_equal(adcgs_splat_create(&splat, &part, t->cpu, NULL, NULL, &error), ADCGS_OK);
        assert_int_equal(adcgs_splat_at(splat, t->views.list[0].t, &primitives, &error), ADCGS_OK);
        assert_int_equal(adcgs_raster_forward(t->raster, &primitives, view, t->scene->background, ADCGS_SCREEN_FILTER, picture[i],
                                              0, &error),
                         ADCGS_OK);
        adcgs_splat_free(&splat);
        adcgs_model_clear(&part, NULL);
    }
    for (size_t i = 0; i < n; i++)
        sum += (double)(picture[0][i] - picture[1][i]) * (double)(picture[0][i] - picture[1][i]);
    free(picture[0]);
    free(picture[1]);
    return sum / (double)n;
}

/** Each tier has its share of the anchors and brings the image closer to the whole one. The run does not depend on threads. */
static void tiers_are_of_falling_worth(void **state)
{
    adcgs_train_config config = small_config();
    config.start_anchors = config.max_anchors = 500;
    config.tiers = 3;
    adcgs_trainer *t = make_trainer(&config, pool), *alone = make_trainer(&config, NULL);
    adcgs_stream stream;
    adcgs_buffer ends[2];
    uint32_t anchors[3] = {0};
    (void)state;
    run(t, NULL, NULL);
    run(alone, NULL, NULL);
    store(t, &ends[0]);
    store(alone, &ends[1]);
    assert_same(&ends[0], &ends[1]);
    assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
    const adcgs_model *m = &stream.segments[0];
    assert_int_equal(m->finest, 2);
    for (uint32_t i = 0; i < m->n; i++)
        anchors[m->tier[i]]++;
    assert_true(anchors[0] > 0.13 * m->n && anchors[0] < 0.19 * m->n && anchors[1] > 0.2 * m->n && anchors[1] < 0.28 * m->n);
    const double coarse = wrong_with(t, m, 1), fine = wrong_with(t, m, 2);
    assert_true(fine > 0 && fine < 0.7 * coarse);
    assert_true(wrong_with(t, m, 3) == 0);
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&ends[0]);
    adcgs_buffer_clear(&ends[1]);
    adcgs_trainer_free(&t);
    adcgs_trainer_free(&alone);
}

/* ---- Checkpoints ---- */

/** In each stage, a restored run equals the stored one to the bit. Both end in the same state as a run that never stopped. */
static void restored_runs_go_on_in_lockstep(void **state)
{
    static const uint32_t stops[] = {0, 30, 90, 140, 180, 190};
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *through = make_trainer(&config, pool), *stopping = make_trainer(&config, NULL);
    adcgs_buffer end, middle, again;
    run(through, NULL, NULL);
    store(through, &end);
    for (size_t i = 0; i < ADCGS_COUNTOF(stops); i++) {
        uint32_t stop = stops[i];
        run(stopping, stop_at, &stop);
        assert_int_equal(stopping->run.iteration, stop);
        store(stopping, &middle);
        adcgs_trainer *restored = make_trainer(&config, pool);
        assert_int_equal(adcgs_trainer_restore(restored, middle.data, middle.size, &error), ADCGS_OK);
        store(restored, &again);
        assert_same(&middle, &again);
        adcgs_buffer_clear(&again);
        run(restored, NULL, NULL);
        store(restored, &again);
        assert_same(&end, &again);
        adcgs_buffer_clear(&again);
        adcgs_buffer_clear(&middle);
        adcgs_trainer_free(&restored);
    }
    run(stopping, NULL, NULL);
    store(stopping, &again);
    assert_same(&end, &again);
    adcgs_buffer_clear(&again);
    adcgs_buffer_clear(&end);
    adcgs_trainer_free(&stopping);
    adcgs_trainer_free(&through);
}

static void checkpoints_are_checked(void **state)
{
    adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, NULL), *other;
    adcgs_buffer b;
    store(t, &b);
    for (size_t cut = 0; cut < b.size; cut += b.size / 97 + 1) {
        assert_int_equal(adcgs_trainer_restore(t, b.data, cut, &error), ADCGS_ERR_DATA);
        assert_true(error.text[0] && !strchr(error.text, '\n'));
    }
    adcgs_write_uint(&b, 0, 1);
    assert_int_equal(adcgs_trainer_restore(t, b.data, b.size, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_trainer_restore(t, b.data, b.size - 1, &error), ADCGS_OK);
    config.densify_until += 0.01f;
    other = make_trainer(&config, NULL);
    assert_int_equal(adcgs_trainer_restore(other, b.data, b.size - 1, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "other options: densify_until is 0.5 in the file and 0.51 here"));
    adcgs_trainer_free(&other);
    adcgs_trainer_free(&t);
    adcgs_buffer_clear(&b);
}

/** The error names any setting that differs, as soon as the run depends on it. */
static void checkpoints_name_what_differs(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, NULL);
    for (int later = 0; later < 2; later++) {
        adcgs_buffer b;
        t->rate.lambda_used = t->stage.rounding = (uint8_t)later;
        store(t, &b);
        for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
            uint8_t *field = (uint8_t *)&t->config + s->offset;
            char text[60];
            *field ^= 1;
            const adcgs_status status = adcgs_trainer_restore(t, b.data, b.size, &error);
            *field ^= 1;
            if (!later && s->fixed != ADCGS_FIXED_ALWAYS) {
                assert_int_equal(status, ADCGS_OK);
                continue;
            }
            snprintf(text, sizeof text, "saved with other options: %s is ", s->name);
            assert_int_equal(status, ADCGS_ERR_DATA);
            assert_ptr_equal(strstr(error.text, text), error.text);
        }
        adcgs_buffer_clear(&b);
    }
    adcgs_trainer_free(&t);
}

/** The trainer checks its configuration itself: values out of range are refused, however they were set. */
static void bad_configurations_make_no_trainer(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t;
    config.start_anchors = config.max_anchors + 1;
    assert_int_equal(adcgs_trainer_create(&t, scene, &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_ERR_USAGE);
    assert_non_null(strstr(error.text, "settings start_anchors=151 and max_anchors=150"));
    assert_null(t);
    config = small_config();
    config.ssim_weight = 1.5f;
    assert_int_equal(adcgs_trainer_create(&t, scene, &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_ERR_USAGE);
    assert_non_null(strstr(error.text, "setting ssim_weight=1.5: expected a number from 0 to 1"));
}

static void refuse_checkpoint(const adcgs_scene *other, const char *what)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t;
    assert_int_equal(adcgs_trainer_create(&t, other, &config, adcgs_cpu_best(), NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_load(t, in("state"), &error), what ? ADCGS_ERR_DATA : ADCGS_OK);
    if (what && (!strstr(error.text, what) || !strstr(error.text, "state: saved with another scene") || strchr(error.text, '\n')))
        fail_msg("%s; expected %s", error.text, what);
    adcgs_trainer_free(&t);
}

/** A checkpoint continues with the scene that it was made from; for another scene the error names the difference. */
static void checkpoints_know_their_scene(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, NULL);
    assert_int_equal(adcgs_trainer_save(t, in("state"), &error), ADCGS_OK);
    adcgs_trainer_free(&t);
    refuse_checkpoint(scene, NULL);

    adcgs_scene other = *scene;
    adcgs_scene_view views[4];
    assert_true(other.n_views[ADCGS_SPLIT_TRAIN] > 4);
    other.n_views[ADCGS_SPLIT_TRAIN] = 4;
    other.views[ADCGS_SPLIT_TRAIN] = views;
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], sizeof views);
    refuse_checkpoint(&other, "training views in the file and 4 here");
    other = *scene;
    other.background[1] = 0.5f;
    refuse_checkpoint(&other, "different background");
    adcgs_scene_view *v = &scene->views[ADCGS_SPLIT_TRAIN][3];
    const adcgs_scene_view kept = *v;
    v->camera.fy *= 1.001;
    refuse_checkpoint(scene, "different cameras");
    *v = kept;
    v->lens.k[0] = 0.01;
    refuse_checkpoint(scene, "different cameras");
    *v = kept;
    v->time += 1e-4;
    refuse_checkpoint(scene, "different timestamps");
    *v = kept;

    /* One level of one sample of one image. */
    FILE *file = fopen(v->path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, -1, SEEK_END), 0);
    const int level = fgetc(file);
    assert_int_equal(fseek(file, -1, SEEK_END), 0);
    fputc(level ^ 1, file);
    fclose(file);
    refuse_checkpoint(scene, "the files of the training images have changed");
    file = fopen(v->path, "r+b");
    assert_int_equal(fseek(file, -1, SEEK_END), 0);
    fputc(level, file);
    fclose(file);
    refuse_checkpoint(scene, NULL);
}

/* ---- Recovery ---- */

typedef struct poison {
    adcgs_trainer *t;
    int group;  /* of the parameter, or -1: an image */
    int repair; /* after the first rollback the image is whole again; otherwise each report spoils it */
    int given;
    uint32_t at;
} poison;

/** The first view's image with one value replaced. */
static void put_value(adcgs_trainer *t, float value)
{
    assert_int_equal(adcgs_image_store_get(t->views.store, 0, t->taken, &error), ADCGS_OK);
    t->taken[5] = value;
    assert_int_equal(adcgs_image_store_put(t->views.store, 0, t->taken, &error), ADCGS_OK);
}

static int give_poison(void *user, const adcgs_train_report *r)
{
    poison *p = user;
    const int lasting = p->group < 0 && !p->repair;
    if ((!p->given || lasting) && r->iteration >= p->at) {
        p->given = 1;
        if (p->group < 0)
            put_value(p->t, INFINITY); /* NaN would be a mask */
        else
            p->t->f->param[p->group].p[p->group == ADCGS_P_FG ? 64 : 0] = NAN;
    }
    if (p->group < 0 && p->repair && r->rollbacks)
        put_value(p->t, 0.5f);
    return 0;
}

static void no_number_is_rolled_back(void **state)
{
    static const int groups[] = {-1,          ADCGS_P_FV,    ADCGS_P_FG,   ADCGS_P_COLOUR,
                                 ADCGS_P_ETA, ADCGS_P_THETA, ADCGS_P_TIME, ADCGS_P_E_FV};
    const adcgs_train_config config = all_stages_config();
    for (size_t i = 0; i < ADCGS_COUNTOF(groups); i++) {
        adcgs_model model;
        poison p = {.t = make_trainer(&config, pool), .group = groups[i], .repair = 1, .at = 90};
        run(p.t, give_poison, &p);
        assert_int_equal(p.t->run.iteration, ITERATIONS);
        assert_int_equal(p.t->run.rollbacks, 1);
        assert_true(isfinite(p.t->run.mean_loss) && all_finite(p.t->f));
        assert_int_equal(adcgs_quantise(&model, p.t->f, &(adcgs_quantise_options){.cpu = p.t->cpu}, &error), ADCGS_OK);
        assert_int_equal(adcgs_model_validate(&model, &error), ADCGS_OK);
        adcgs_model_clear(&model, NULL);
        adcgs_trainer_free(&p.t);
    }
}

/** The same in the last stages, where anchors are final and stored as they decode. */
static void no_number_is_rolled_back_late(void **state)
{
    const adcgs_train_config config = all_stages_config();
    for (uint32_t at = 140; at < ITERATIONS; at += 20) {
        poison p = {.t = make_trainer(&config, pool), .group = ADCGS_P_THETA, .at = at};
        run(p.t, give_poison, &p);
        assert_int_equal(p.t->run.iteration, ITERATIONS);
        assert_true(p.t->run.rollbacks >= 1 && all_finite(p.t->f));
        adcgs_trainer_free(&p.t);
    }
}

static void lasting_poison_ends_the_run(void **state)
{
    const adcgs_train_config config = all_stages_config();
    poison p = {.t = make_trainer(&config, pool), .group = -1, .at = 0};
    int stopped;
    p.at = 10;
    assert_int_equal(adcgs_trainer_run(p.t, give_poison, &p, &stopped, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "diverged"));
    assert_null(strchr(error.text, '\n'));
    assert_true(all_finite(p.t->f) || p.t->run.rollbacks > 0);
    adcgs_trainer_free(&p.t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restored_runs_go_on_in_lockstep), cmocka_unit_test(checkpoints_are_checked),
        cmocka_unit_test(checkpoints_name_what_differs),   cmocka_unit_test(bad_configurations_make_no_trainer),
        cmocka_unit_test(checkpoints_know_their_scene),    cmocka_unit_test(no_number_is_rolled_back),
        cmocka_unit_test(no_number_is_rolled_back_late),   cmocka_unit_test(lasting_poison_ends_the_run),
        cmocka_unit_test(tiers_are_of_falling_worth),
    };
    return cmocka_run_group_tests_name("trainer", tests, open_scene, close_scene);
}
