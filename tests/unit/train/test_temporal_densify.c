/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Anchors with lifetimes: their begin and length, densification in time, and statistics that do not count the frames in which an
 * anchor is absent.
 */
#include "square_scene.h"

#include "encode/encode.h"
#include "train/density/anchor_set.h"
#include "train/density/temporal_densify.h"
#include "train/settings.h"
#include "train/start_points.h"
#include "train/train_views.h"
#include "train/trainer.h"

#include <math.h>

static adcgs_train_config small_config(void)
{
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "draft", &error), ADCGS_OK);
    assert_int_equal(adcgs_train_set(&c,
                                     "start_anchors=200,max_anchors=300,densify_interval=10,k=4,n_fv=12,theta_width=16,"
                                     "omega_width=16,varpi_width=16,entropy_width=16",
                                     &error),
                     ADCGS_OK);
    c.iterations = 80;
    return c;
}

static adcgs_trainer *make(const adcgs_train_config *config)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create(&t, &scene, config, adcgs_cpu_best(), NULL, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    return t;
}

static float span_of(const adcgs_trainer *t, uint32_t anchor, int channel)
{
    return *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, anchor, channel);
}

/** Each frame has moving anchors about it, as fast as the square. Anchors on the wall are static. */
static void lives_begin_at_their_moments(void **state)
{
    adcgs_train_config config = small_config();
    config.params.bodies = 0;
    adcgs_trainer *t = make(&config);
    const float half = config.lifetime_frames / (MOMENTS - 1);
    int at_moment[MOMENTS] = {0}, fast = 0, moving = 0, still = 0;
    assert_int_equal(t->config.params.spans, 1);
    for (uint32_t i = 0; i < t->f->n; i++) {
        const float m = (span_of(t, i, ADCGS_SPAN_MIDDLE) / 8 + 0.5f) * (MOMENTS - 1);
        const float way = span_of(t, i, ADCGS_SPAN_VELOCITY) / 8;
        still += t->f->moving[i] == 0;
        if (t->f->moving[i] == 0 || fabsf(span_of(t, i, ADCGS_SPAN_PACE) + logf(half)) > 1e-5f)
            continue;
        moving++;
        assert_true(fabsf(m - roundf(m)) < 1e-4f);
        at_moment[(int)roundf(m)]++;
        fast += fabs((double)way * t->scale - SPEED * (double)half) < 0.3 * SPEED * (double)half;
        assert_true(adcgs_fmodel_presence(t->f, i, roundf(m) / (MOMENTS - 1)) > 0.999f);
    }
    for (int m = 0; m < MOMENTS; m++)
        assert_true(at_moment[m] > 0);
    print_message("%d anchors move, %d of them at the right speed; %d are static\n", moving, fast, still);
    assert_true(fast > moving / 2 && still > moving);
    adcgs_trainer_free(&t);
}

/** The square is a rigid body: its anchors live as long as it does, and move with it. */
static void test_rigid_square_is_a_body(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make(&config);
    const adcgs_primitives *p = &t->pass->primitives;
    float *begin = calloc(p->n, sizeof *begin);
    int of_body = 0, along = 0;
    assert_non_null(begin);
    assert_int_equal(t->config.params.bodies, 1);
    adcgs_trainer_prepare_networks(t);
    adcgs_pass_forward(t->pass, t->f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    memcpy(begin, p->mean[0], p->n * sizeof *begin);
    adcgs_pass_forward(t->pass, t->f, 1, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    for (uint32_t i = 0; i < t->f->n; i++) {
        const size_t slot = adcgs_fmodel_slot(t->f, i, 0);
        const double way = (double)(p->mean[0][slot] - begin[slot]) * t->scale;
        if (!t->f->body[i])
            continue;
        of_body++;
        along += fabs(way - SPEED) < 0.1 * SPEED;
        for (int end = 0; end <= 1; end++)
            assert_true(t->f->moving[i] != 0 && adcgs_fmodel_presence(t->f, i, (float)end) > 0.98f);
    }
    print_message("%d anchors of a body, %d move with it\n", of_body, along);
    assert_true(of_body > 10 && along == of_body);
    free(begin);
    adcgs_trainer_free(&t);
}

/**
 * Where stereo finds nothing that moves, lifetimes would cost bits for nothing. Without stereo, lifetimes begin as long as time.
 */
static void spans_need_what_moves(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_scene few = scene;
    adcgs_trainer *t;
    few.n_views[ADCGS_SPLIT_TRAIN] = 2 * MOMENTS; /* two cameras are too few to match */
    assert_int_equal(adcgs_trainer_create(&t, &few, &config, adcgs_cpu_best(), NULL, &error), ADCGS_OK);
    assert_int_equal(t->config.params.spans, 0);
    assert_int_equal(adcgs_fmodel_rows(t->f, ADCGS_P_SIGMA), ADCGS_SIGMA_N);
    adcgs_trainer_free(&t);
    config.matching_frames = 0;
    t = make(&config);
    assert_int_equal(t->config.params.spans, 1);
    for (uint32_t i = 0; i < t->f->n; i++)
        for (int end = 0; end <= 1; end++)
            assert_true(t->f->moving[i] != 0 && adcgs_fmodel_presence(t->f, i, (float)end) > 0.98f);
    adcgs_trainer_free(&t);
}

/**
 * An untrained model misses nearly everything. The result holds points of two frames, each better than the render, the worst
 * first, and repeats exactly.
 */
static void test_missing_points_are_found(void **state)
{
    enum { MOST = 40 };
    const adcgs_train_config config = small_config();
    const adcgs_stereo_point *points[MOST], *again[MOST];
    adcgs_trainer *t = make(&config);
    uint32_t n, m;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    for (uint32_t i = 0; i < t->f->n; i++) /* the square is missing */
        for (int k = 0; k < t->f->params.k && t->f->moving[i] != 0; k++)
            t->f->keep[adcgs_fmodel_slot(t->f, i, k)] = 0;
    assert_int_equal(adcgs_temporal_densify_find(t, points, MOST, &n, &error), ADCGS_OK);
    assert_true(n > MOST / 4 && n <= MOST);
    for (uint32_t i = 0; i < n; i++)
        assert_true(points[i]->moves && points[i] >= t->stereo.moving && points[i] < t->stereo.moving + t->stereo.n_moving);
    assert_int_equal(adcgs_temporal_densify_find(t, again, MOST, &m, &error), ADCGS_OK);
    assert_int_equal(m, n);
    assert_memory_equal(again, points, n * sizeof *points);
    adcgs_trainer_free(&t);
}

/** Opacity and pixels are means over the frames in which an anchor is present. */
static void absence_is_no_idleness(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make(&config);
    t->stats.n = 100;
    t->stats.presence[0] = t->stats.in_view[0] = 5;
    for (int k = 0; k < t->f->params.k; k++) {
        t->stats.opacity[adcgs_fmodel_slot(t->f, 0, k)] = 0.5f * 5;
        t->stats.weight[adcgs_fmodel_slot(t->f, 0, k)] = 10 * 5;
    }
    assert_false(adcgs_anchor_is_idle(t, 0, 1));
    t->stats.presence[0] = t->stats.in_view[0] = 100;
    t->stats.presence[1] = 0; /* no frame has asked for it yet */
    assert_true(adcgs_anchor_is_idle(t, 0, 100));
    assert_false(adcgs_anchor_is_idle(t, 1, 1));
    adcgs_trainer_free(&t);
}

/** Pixels are means over the views that contain an anchor: views of other places, and views not yet visited, do not count. */
static void views_of_other_places_are_no_idleness(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make(&config);
    t->stats.presence[0] = (float)(t->stats.n = t->views.n - 1);
    for (int k = 0; k < t->f->params.k; k++)
        t->stats.opacity[adcgs_fmodel_slot(t->f, 0, k)] = 0.5f * (float)t->views.n;
    assert_false(adcgs_anchor_is_idle(t, 0, 1)); /* the last view may contain it */
    t->stats.presence[0] = (float)++t->stats.n;
    assert_true(adcgs_anchor_is_idle(t, 0, 1)); /* none does */
    t->stats.in_view[0] = 2;
    t->stats.weight[adcgs_fmodel_slot(t->f, 0, 0)] = 5;
    assert_false(adcgs_anchor_is_idle(t, 0, 2));
    assert_true(adcgs_anchor_is_idle(t, 0, 3));
    adcgs_trainer_free(&t);
}

static int stop_half_way(void *user, const adcgs_train_report *report)
{
    return report->iteration == *(const uint32_t *)user;
}

static void run_until(adcgs_trainer *t, uint32_t iteration)
{
    int stopped;
    if (adcgs_trainer_run(t, stop_half_way, &iteration, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/**
 * A run with lifetimes and bodies continues from a checkpoint as if it had not stopped. Its stream decodes to the written models.
 */
static void runs_go_on_and_decode(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *through = make(&config), *after = make(&config);
    adcgs_buffer middle, out;
    adcgs_stream stream;
    adcgs_buffer_init(&middle);
    adcgs_buffer_init(&out);
    run_until(through, 40);
    assert_int_equal(adcgs_trainer_store(through, &middle, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_restore(after, middle.data, middle.size, &error), ADCGS_OK);
    run_until(through, UINT32_MAX);
    run_until(after, UINT32_MAX);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        assert_int_equal(through->f->param[i].n, after->f->param[i].n);
        assert_memory_equal(through->f->param[i].p, after->f->param[i].p, through->f->param[i].n * sizeof(float));
    }
    assert_int_equal(adcgs_encode_stream(&stream, through, NULL, 0, &error), ADCGS_OK);
    assert_int_equal(stream.params.spans, 1);
    assert_int_equal(stream.params.bodies, 1);
    if (adcgs_encode_verified(&stream, &out, adcgs_cpu_best(), NULL, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&middle);
    adcgs_buffer_clear(&out);
    adcgs_trainer_free(&through);
    adcgs_trainer_free(&after);
}

/** Without lifetimes the points of the middle frame start, limited to the maximum number of anchors. */
static void one_moment_does_not_overflow(void **state)
{
    enum { MANY = 1000 };
    adcgs_train_config config = small_config();
    adcgs_stereo_point *points = calloc(MANY, sizeof *points);
    float moment[] = {0, 0.5f, 1};
    adcgs_start_points start;
    assert_non_null(points);
    for (int i = 0; i < MANY; i++)
        points[i] = (adcgs_stereo_point){.x = {0.001 * i, 0, SQUARE}, .t = 0.5f, .size = 0.01f, .moves = 1};
    const adcgs_stereo many = {.n_moving = MANY, .moving = points, .n_frames = 3, .frame_time = moment};
    config.params.spans = 0;
    if (adcgs_start_points_find(&start, &scene, &config, &many, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(start.n, config.start_anchors);
    adcgs_start_points_clear(&start);
    free(points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_moment_does_not_overflow),          cmocka_unit_test(lives_begin_at_their_moments),
        cmocka_unit_test(test_rigid_square_is_a_body),           cmocka_unit_test(spans_need_what_moves),
        cmocka_unit_test(test_missing_points_are_found),         cmocka_unit_test(absence_is_no_idleness),
        cmocka_unit_test(views_of_other_places_are_no_idleness), cmocka_unit_test(runs_go_on_and_decode),
    };
    return cmocka_run_group_tests(tests, put_scene, remove_scene);
}
