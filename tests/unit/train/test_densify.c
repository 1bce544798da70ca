/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Changes of the set of anchors in training: densification, pruning, anchors that become static, anchors for missing content.
 */
#include "training_runs.h"

#include "geom/geom.h"
#include "train/density/densify.h"
#include "train/density/residual_densify.h"
#include "train/start_points.h"
#include "train/static/prune_and_fix.h"
#include "train/static/unchanging.h"
#include "train/train_views.h"

#include <math.h>

/* ---- Refinement ---- */

typedef struct census {
    adcgs_trainer *t;
    uint32_t least, most;
} census;

static int count_anchors(void *user, const adcgs_train_report *r)
{
    census *c = user;
    const adcgs_fmodel *f = c->t->f;
    assert_int_equal(r->anchors, f->n);
    assert_in_range(f->n, 1, c->t->config.max_anchors);
    for (uint32_t i = 0; i < f->n; i++) {
        assert_true(f->pos[i][0] >> f->shape.depth == 0 && f->pos[i][1] >> f->shape.depth == 0 &&
                    f->pos[i][2] >> f->shape.depth == 0);
        assert_true(i == 0 || adcgs_morton(f->pos[i - 1]) < adcgs_morton(f->pos[i]));
    }
    for (uint32_t i = f->n; i < f->groups * 64; i++)
        assert_true(f->live[i] == 0);
    c->least = ADCGS_MIN(c->least, f->n);
    c->most = ADCGS_MAX(c->most, f->n);
    return 0;
}

static void densification_keeps_order_and_budget(void **state)
{
    const adcgs_train_config config = all_stages_config();
    census c = {make_trainer(&config, pool), UINT32_MAX, 0};
    const uint32_t start = c.t->f->n;
    run(c.t, count_anchors, &c);
    assert_true(c.most > start);
    adcgs_trainer_free(&c.t);
}

/** Densification removes anchors that no view saw since the last one. The others stay and keep their parameters. */
static void densification_prunes_what_is_not_seen(void **state)
{
    adcgs_train_config config = all_stages_config();
    config.densify_threshold = 1e6f;
    adcgs_trainer *t = make_trainer(&config, pool);
    uint32_t stop = 50, gone[3], left;
    run(t, stop_at, &stop);
    const uint32_t slots = t->pass->primitives.n, k = config.params.k;
    for (uint32_t i = 0; i < slots; i++) {
        const int seen = i % 64 != 3;
        t->stats.weight[i] = t->stats.opacity[i] = seen ? 1000.0f * (float)t->stats.n : 0;
    }
    memcpy(gone, t->f->pos[3], sizeof gone);
    left = t->f->n - (t->f->n + 60) / 64; /* minus one of each group of 64 */
    const float next = *adcgs_fmodel_at(t->f, ADCGS_P_FG, 4, (int)k);
    assert_int_equal(adcgs_densify(t, 0.4, &error), ADCGS_OK);
    assert_int_equal(t->f->n, left);
    for (uint32_t i = 0; i < left; i++)
        assert_memory_not_equal(t->f->pos[i], gone, sizeof gone);
    assert_true(*adcgs_fmodel_at(t->f, ADCGS_P_FG, 3, (int)k) == next);
    adcgs_trainer_free(&t);
}

/** Runs 50 iterations, then makes primitive 1 of each anchor and all of anchor 5 faint: weight, against 1 of the others. */
static adcgs_trainer *make_faint(const adcgs_train_config *config, float weight)
{
    adcgs_trainer *t = make_trainer(config, pool);
    uint32_t stop = 50;
    run(t, stop_at, &stop);
    for (uint32_t i = 0; i < t->f->n; i++)
        for (int j = 0; j < config->params.k; j++) {
            const size_t slot = adcgs_fmodel_slot(t->f, i, j);
            const int faint = j == 1 || i == 5;
            t->stats.weight[slot] = (faint ? weight : 1) * 1000.0f * (float)t->stats.n;
            t->stats.opacity[slot] = config->min_mean_opacity * (faint ? 0.99f : 1.01f) * t->stats.presence[i];
        }
    return t;
}

/** Pruning removes faint primitives, and anchors that have no other. */
static void faint_primitives_go(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_faint(&config, 0.1f);
    const uint32_t n = t->f->n;
    assert_int_equal(adcgs_prune_and_fix(t, &error), ADCGS_OK);
    assert_int_equal(t->f->n, n - 1);
    for (uint32_t i = 0; i < t->f->n; i++)
        for (int j = 0; j < config.params.k; j++)
            assert_true((t->f->keep[adcgs_fmodel_slot(t->f, i, j)] > 0) == (j != 1));
    adcgs_trainer_free(&t);
}

/** In a scene made of faint primitives, pruning removes at most a tenth of the rendered weight: the faintest primitives. */
static void test_faint_scene_is_kept(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_faint(&config, 10);
    const int k = config.params.k;
    const uint32_t n = t->f->n;
    double drawn = 0, left = 0;
    for (uint32_t i = 0; i < n; i++) {
        t->stats.opacity[adcgs_fmodel_slot(t->f, i, 1)] *= i < n / 50 ? 0.5f : 1;
        drawn += (10 + (i == 5 ? 10 : 1) * (k - 1.0)) / n;
    }
    assert_int_equal(adcgs_prune_and_fix(t, &error), ADCGS_OK);
    assert_int_equal(t->f->n, n);
    for (uint32_t i = 0; i < n; i++)
        for (int j = 0; j < k; j++) {
            const int is_kept = t->f->keep[adcgs_fmodel_slot(t->f, i, j)] > 0;
            left += is_kept * (j == 1 || i == 5 ? 10.0 : 1.0) / n;
            assert_true(is_kept ? !(j == 1 && i < n / 50) : j == 1 || i == 5);
        }
    assert_true(left >= 0.9 * drawn && left < 0.92 * drawn);
    adcgs_trainer_free(&t);
}

/** Number of anchors that still move after 50 iterations and the decision on motion, where every primitive has this opacity. */
static uint32_t moving_anchors(const adcgs_train_config *config, float opacity)
{
    adcgs_trainer *t = make_trainer(config, pool);
    uint32_t stop = 50, moving = 0;
    run(t, stop_at, &stop);
    for (uint32_t i = 0; i < t->f->n; i++)
        for (int j = 0; j < config->params.k; j++) {
            t->stats.weight[adcgs_fmodel_slot(t->f, i, j)] = 1000.0f * (float)t->stats.n;
            t->stats.opacity[adcgs_fmodel_slot(t->f, i, j)] = opacity * t->stats.presence[i];
        }
    assert_int_equal(adcgs_prune_and_fix(t, &error), ADCGS_OK);
    for (uint32_t i = 0; i < t->f->n; i++)
        moving += t->f->moving[i] != 0;
    adcgs_trainer_free(&t);
    return moving;
}

/** The fainter the layers of a scene, the smaller the motion that keeps an anchor dynamic. Opaque layers do not differ. */
static void faint_layers_move_together(void **state)
{
    adcgs_train_config config = all_stages_config();
    config.min_mean_opacity = 0;
    config.params.spans = 0; /* primitives with a lifetime are dynamic in any case */
    config.static_threshold = 10;
    const uint32_t opaque = moving_anchors(&config, 0.9f), faint = moving_anchors(&config, 0.02f);
    print_message("%u anchors move with opaque layers, %u with faint ones\n", opaque, faint);
    assert_int_equal(moving_anchors(&config, 0.5f), opaque);
    assert_true(faint > opaque);
}

/** Anchors in regions where no camera's images change become static, independent of the networks' motion. The others move. */
static void test_unchanging_regions_are_static(void **state)
{
    adcgs_train_config config = all_stages_config();
    config.min_mean_opacity = 0;
    config.params.spans = 0;
    config.static_threshold = 1e-30f;                 /* any motion of the networks at all */
    config.start_anchors = config.max_anchors = 1500; /* some of them in regions where nothing changes */
    adcgs_trainer *t = make_trainer(&config, pool);
    uint32_t stop = 50, changing = 0, moving = 0;
    run(t, stop_at, &stop);
    const uint32_t n = t->f->n;
    float *const share = malloc(n * sizeof *share);
    assert_non_null(share);
    assert_int_equal(adcgs_changing_share(t, share, &error), ADCGS_OK);
    for (uint32_t i = 0; i < n; i++) {
        assert_true(share[i] == -1 || (share[i] >= 0 && share[i] <= 1.0001f));
        changing += share[i] < 0 || share[i] > 0.01f;
        for (int j = 0; j < config.params.k; j++) {
            t->stats.weight[adcgs_fmodel_slot(t->f, i, j)] = 1000.0f * (float)t->stats.n;
            t->stats.opacity[adcgs_fmodel_slot(t->f, i, j)] = t->stats.presence[i];
        }
    }
    free(share);
    assert_int_equal(adcgs_prune_and_fix(t, &error), ADCGS_OK);
    assert_int_equal(t->f->n, n);
    for (uint32_t i = 0; i < n; i++)
        moving += t->f->moving[i] != 0;
    print_message("%u of %u anchors are in changing regions\n", changing, n);
    assert_true(changing > 0 && changing < n);
    assert_int_equal(moving, changing);
    adcgs_trainer_free(&t);
}

/* ---- Missing content ---- */

/** Every view shows the background and one dot: at the projection of x, or scattered, elsewhere in each view. */
static void show_dot(adcgs_trainer *t, const float x[3], int scattered)
{
    static const float colour[3] = {0.9f, 0.6f, 0.3f};
    for (uint32_t i = 0; i < t->views.n; i++) {
        const adcgs_view *v = &t->views.list[i].view;
        const int w = v->width, h = v->height;
        float p[3];
        for (int a = 0; a < 3; a++)
            p[a] = v->rotation[3 * a] * x[0] + v->rotation[3 * a + 1] * x[1] + v->rotation[3 * a + 2] * x[2] + v->translation[a];
        const int u = scattered ? (int)(i * 7 % 19) + 6 : (int)(v->fx * p[0] / p[2] + v->cx);
        const int y = scattered ? (int)(i * 5 % 17) + 7 : (int)(v->fy * p[1] / p[2] + v->cy);
        assert_true(p[2] > 0 && u >= 1 && y >= 1 && u < w - 1 && y < h - 1);
        for (int c = 0; c < 3; c++) {
            for (int j = 0; j < w * h; j++)
                t->taken[c * w * h + j] = t->scene->background[c];
            t->taken[(c * h + y) * w + u] += colour[c];
        }
        assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
    }
}

/** An object without a primitive near it is found where the cameras of a frame agree on its place, and only then. */
static void missing_things_are_found(void **state)
{
    enum { MOST = 64 };
    const adcgs_train_config config = all_stages_config();
    const float x[3] = {0.1f, -0.05f, 0.12f};
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_residual places[MOST];
    uint32_t n;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    adcgs_curriculum_grow(&t->curriculum, 1, t->f);
    memset(t->f->keep, 0, (size_t)t->f->groups * 64 * (size_t)t->f->params.k * sizeof *t->f->keep);
    show_dot(t, x, 0);
    assert_int_equal(adcgs_residual_find(t, places, MOST, &n, &error), ADCGS_OK);
    assert_true(n > 0);
    for (uint32_t i = 0; i < n; i++) {
        for (int a = 0; a < 3; a++)
            assert_true(fabsf(places[i].x[a] - x[a]) < 2 * places[i].size);
        assert_true(places[i].size > 0.01f && places[i].size < 0.2f && places[i].score > 0);
        assert_float_equal(places[i].rgb[0] - scene->background[0], 0.9, 2e-5); /* images have 16 bits */
    }
    /* Densification puts an anchor there if the scene's own points may have left it out. */
    adcgs_scene with_points = *scene;
    with_points.points.n = ADCGS_POINTS_LEAST;
    t->scene = &with_points;
    t->stats.n = 1;
    assert_int_equal(adcgs_densify(t, 0.1, &error), ADCGS_OK);
    int put = 0;
    for (uint32_t i = 0; i < t->f->n; i++) {
        const float *place = t->f->x + (size_t)i / 64 * 192 + i % 64;
        float off = 0;
        for (int a = 0; a < 3; a++)
            off = fmaxf(off, fabsf(place[64 * a] - x[a]));
        put += off < 2 * places[0].size && *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, i, 3) == logf(places[0].size);
    }
    assert_int_equal(put, 1);
    memset(t->f->keep, 0, (size_t)t->f->groups * 64 * (size_t)t->f->params.k * sizeof *t->f->keep);
    show_dot(t, x, 1);
    assert_int_equal(adcgs_residual_find(t, places, MOST, &n, &error), ADCGS_OK);
    assert_int_equal(n, 0);
    show_dot(t, x, 0);
    for (uint32_t i = 0; i < t->views.n; i++)
        t->views.list[i].t = (float)i / (float)t->views.n; /* no two views share a timestamp */
    assert_int_equal(adcgs_residual_find(t, places, MOST, &n, &error), ADCGS_OK);
    assert_int_equal(n, 0);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densification_keeps_order_and_budget),
        cmocka_unit_test(densification_prunes_what_is_not_seen),
        cmocka_unit_test(faint_primitives_go),
        cmocka_unit_test(test_faint_scene_is_kept),
        cmocka_unit_test(faint_layers_move_together),
        cmocka_unit_test(test_unchanging_regions_are_static),
        cmocka_unit_test(missing_things_are_found),
    };
    return cmocka_run_group_tests_name("densify", tests, open_scene, close_scene);
}
