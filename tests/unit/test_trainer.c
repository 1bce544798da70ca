/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whole training runs in miniature: stopping and continuing, densification, recovery from values that are not numbers, and the
 * numbers that end up in a stream.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "encode/quantise.h"
#include "encode/raw.h"
#include "geom/geom.h"
#include "metric/metric.h"
#include "model/latents_priv.h"
#include "splat/splat.h"
#include "train/black_level.h"
#include "train/contrast.h"
#include "train/prune_and_fix.h"
#include "train/unchanging.h"
#include "train/densify.h"
#include "train/initialise.h"
#include "train/residual_densify.h"
#include "train/sample.h"
#include "train/start_points.h"
#include "train/train_views.h"

#include <math.h>

static adcgs_train_config all_stages_config(void)
{
    adcgs_train_config c = small_config();
    c.freeze_start = 0.92f; /* long enough to stop in */
    c.rdo_strength = 1;
    c.params.adaptive_steps = 1;
    c.params.spans = 1;
    return c;
}

static void run(adcgs_trainer *t, adcgs_train_observe observe, void *user)
{
    int stopped;
    if (adcgs_trainer_run(t, observe, user, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(stopped, t->iteration < t->config.iterations && !(t->config.time_limit > 0));
}

static void assert_same(const adcgs_buffer *a, const adcgs_buffer *b)
{
    assert_int_equal(a->size, b->size);
    assert_memory_equal(a->data, b->data, a->size);
}

/** Mean squared difference between the image of the first tiers and that of all tiers. */
static double wrong_with(const adcgs_trainer *t, const adcgs_model *model, int tiers)
{
    const adcgs_view *view = &t->views[0].view;
    const size_t n = 3 * (size_t)view->width * (size_t)view->height;
    float *picture[2] = {calloc(n, sizeof(float)), calloc(n, sizeof(float))};
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        adcgs_model part;
        adcgs_splat *splat;
        adcgs_primitives primitives;
        assert_int_equal(adcgs_model_coarser(&part, model, i ? tiers : model->finest + 1, NULL, &error), ADCGS_OK);
        assert_int_equal(adcgs_splat_create(&splat, &part, t->cpu, NULL, NULL, &error), ADCGS_OK);
        assert_int_equal(adcgs_splat_at(splat, t->views[0].t, &primitives, &error), ADCGS_OK);
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

static int all_finite(const adcgs_fmodel *f)
{
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        for (size_t j = 0; j < f->param[i].n; j++)
            if (!isfinite(f->param[i].p[j]))
                return 0;
    return 1;
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
        assert_int_equal(stopping->iteration, stop);
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
        t->lambda_used = t->rounding = (uint8_t)later;
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
static void what_faint_primitives_make_stays(void **state)
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
static void what_never_changes_is_static(void **state)
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
    assert_int_equal(adcgs_image_store_get(t->pictures, 0, t->taken, &error), ADCGS_OK);
    t->taken[5] = value;
    assert_int_equal(adcgs_image_store_put(t->pictures, 0, t->taken, &error), ADCGS_OK);
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
        assert_int_equal(p.t->iteration, ITERATIONS);
        assert_int_equal(p.t->rollbacks, 1);
        assert_true(isfinite(p.t->mean_loss) && all_finite(p.t->f));
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
        assert_int_equal(p.t->iteration, ITERATIONS);
        assert_true(p.t->rollbacks >= 1 && all_finite(p.t->f));
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
    assert_true(all_finite(p.t->f) || p.t->rollbacks > 0);
    adcgs_trainer_free(&p.t);
}

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
    assert_memory_equal(stream.segments[0].shape, t->f->density, sizeof t->f->density);
    estimate[0] = flag_bytes(&stream.segments[0]);
    for (int g = 0; g < ADCGS_GROUPS; g++)
        estimate[g < ADCGS_GROUP_FG ? 0 : 1 + g - ADCGS_GROUP_FG] += t->mean_bits[g] / 8;
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
                const int dead = network == ADCGS_P_E_FV && l == 0 && t->rounding && eta_is_zero(t, j);
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
        const adcgs_pass_mode mode = {.quant = t->rounding ? ADCGS_QUANT_ROUND : ADCGS_QUANT_NOISE,
                                      .deform = ADCGS_DEFORM_ALL,
                                      .seed = 5};
        assert_int_equal(t->rounding, s);
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
    if (adcgs_raster_forward(t->raster, &t->pass->primitives, &t->views[0].view, scene->background, 0.3f, image, 0, &error))
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
    if (adcgs_raster_forward(t->raster, &primitives, &t->views[0].view, scene->background, 0.3f, there, 0, &error))
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
        t->lambda = (much ? 20 : 2) * (stopped - 1.01 * moved) / bits * 0x1p23;
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

/* ---- Parts of images ---- */

/** A crop of a view is rendered exactly as in the whole image, and its loss is that of its pixels. */
static void crops_are_parts_of_pictures(void **state)
{
    enum { X = 16, Y = 9, W = 16, H = 20, SIDE = 32 };
    static float whole[3 * SIDE * SIDE];
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_loss_value value;
    const float *target;
    double square = 0;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    adcgs_trainer_prepare_networks(t);
    adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.deform = 1});
    assert_int_equal(adcgs_view_render(t, &t->views[0].view, 0, whole, 0, &error), ADCGS_OK);
    adcgs_view crop = t->views[0].view;
    assert_true(crop.width == SIDE && crop.height == SIDE);
    adcgs_view_crop(&crop, X, Y, W, H);
    assert_int_equal(adcgs_view_render(t, &crop, 0, t->image, 0, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_target(t, 0, NULL, &target, &error), ADCGS_OK);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const int at = (c * SIDE + Y + y) * SIDE + X + x;
                const float drawn = t->image[(c * H + y) * W + x];
                assert_float_equal(drawn, whole[at], 1e-4);
                square += (double)((drawn - target[at]) * (drawn - target[at])) / (3 * W * H);
            }
    assert_int_equal(adcgs_trainer_loss_crop(t, 0, &crop, &value, &error), ADCGS_OK);
    assert_float_equal(value.mse, square, 1e-6);
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

/* ---- The part of time that is trained on ---- */

static float *time_row(adcgs_trainer *t, int row)
{
    return t->f->param[ADCGS_P_TIME].p + (size_t)row * t->f->params.time_width;
}

/** Views enter from the middle of time outwards. A newly reached time row starts as a copy of its neighbour; others stay. */
static void windows_grow_outwards(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_curriculum *w = &t->curriculum;
    const size_t bytes = t->f->params.time_width * sizeof(float);
    const int rows = t->f->params.time_rows;
    assert_true(rows >= 6);
    adcgs_curriculum_grow(w, 0.1, t->f);
    const int first = w->first, last = w->last;
    assert_true(w->n > 0 && w->n < t->n_views && first > 0 && last < rows - 1);
    for (int i = 0; i < 100; i++) {
        const float at = t->views[adcgs_curriculum_pick(w, 1, (uint32_t)i)].t * (float)(rows - 1);
        assert_true(at >= (float)first && at <= (float)last);
    }
    for (int r = 0; r < rows; r++)
        time_row(t, r)[0] = (float)r;
    adcgs_curriculum_grow(w, 0.6, t->f);
    assert_true(w->first < first && w->last > last && w->last - w->first < rows - 1);
    adcgs_curriculum_grow(w, 0.2, t->f); /* takes nothing back */
    for (int r = 0; r < rows; r++)
        if (r < w->first || r > w->last)
            assert_true(time_row(t, r)[0] == (float)r);
        else
            assert_memory_equal(time_row(t, r), time_row(t, r < first ? first : r > last ? last : r), bytes);
    adcgs_curriculum_grow(w, 1, t->f);
    assert_true(w->n == t->n_views && w->first == 0 && w->last == rows - 1);
    adcgs_trainer_free(&t);
}

/** The mean of three states, exact to the bit where the states agree. A model of another size starts a mean of its own. */
static void averages_are_means(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_fmodel *f = t->f;
    adcgs_param *varied = &f->param[ADCGS_P_OMEGA], *same = &f->param[ADCGS_P_THETA];
    adcgs_weight_average average = {.n = 0};
    const float begin = varied->p[0], kept = same->p[1];
    adcgs_weight_average_take(&average, f); /* the average of no states changes nothing */
    assert_true(varied->p[0] == begin);
    for (int i = 0; i < 3; i++) {
        varied->p[0] = (const float[]){1, 2, 6}[i];
        assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    }
    adcgs_weight_average_take(&average, f);
    assert_float_equal(varied->p[0], 3, 1e-6);
    assert_true(same->p[1] == kept && average.n == 0);
    assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    adcgs_fmodel_set_width(f, ADCGS_P_THETA, 8);
    varied->p[0] = 7;
    assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    assert_int_equal(average.n, 1);
    adcgs_weight_average_take(&average, f);
    assert_true(varied->p[0] == 7);
    adcgs_weight_average_clear(&average);
    adcgs_trainer_free(&t);
}

/* ---- Brightness of cameras ---- */

/** Multiplies all images by a factor. */
static void dim(adcgs_trainer *t, float by)
{
    for (uint32_t i = 0; i < t->n_views; i++) {
        const size_t n = 3 * (size_t)t->views[i].view.width * (size_t)t->views[i].view.height;
        assert_int_equal(adcgs_image_store_get(t->pictures, i, t->taken, &error), ADCGS_OK);
        for (size_t j = 0; j < n; j++)
            t->taken[j] *= by;
        assert_int_equal(adcgs_image_store_put(t->pictures, i, t->taken, &error), ADCGS_OK);
    }
}

/** A scene filmed with half the light is coded twice as finely. A lambda set by the user is used unchanged. */
static void lambda_follows_contrast(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    double contrast, half, lambda;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    assert_int_equal(adcgs_contrast(t, &contrast, &error), ADCGS_OK);
    assert_true(contrast > 0.05 && contrast < 0.5); /* values in [0,1] deviate by 0.5 at most */
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    lambda = t->lambda;
    assert_float_equal(lambda, (double)config.lambda * contrast / ADCGS_CONTRAST_NOMINAL, 1e-9);
    dim(t, 0.5f);
    assert_int_equal(adcgs_contrast(t, &half, &error), ADCGS_OK);
    assert_float_equal(half, contrast / 2, 1e-4 * contrast);
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK); /* the contrast has been measured and stays */
    assert_float_equal(t->lambda, lambda, 0);
    t->contrast = 0;
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_float_equal(t->lambda, lambda / 2, 1e-4 * lambda);
    dim(t, 0); /* images of one colour: the rate still has a price */
    t->contrast = 0;
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_true(t->lambda > 0);
    t->config.own_lambda = 1;
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_float_equal(t->lambda, config.lambda, 0);
    adcgs_trainer_free(&t);
}

/**
 * The images of three cameras in turn: half of each image (of the last camera's: last_share) is within one level of the camera's
 * black, in levels of 255. The rest is bright.
 */
static void darken(adcgs_trainer *t, const float black[3], float last_share)
{
    for (uint32_t i = 0; i < t->n_views; i++) {
        const size_t plane = (size_t)t->views[i].view.width * (size_t)t->views[i].view.height;
        const uint32_t camera = t->exposure.of[i];
        const float share = camera == 2 ? last_share : 0.5f;
        for (size_t j = 0; j < 3 * plane; j++)
            t->taken[j] = j % plane < share * (float)plane ? (black[camera] + (float)(j % 3) / 2) / 255 : 0.5f;
        assert_int_equal(adcgs_image_store_put(t->pictures, i, t->taken, &error), ADCGS_OK);
    }
}

/** A camera's black offset is found only where all cameras see black. The exposure correction then removes it. */
static void black_levels_are_found(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_scene_view *views = calloc(t->n_views, sizeof *views);
    assert_non_null(views);
    for (uint32_t i = 0; i < t->n_views; i++)
        views[i].camera.cam_to_world[3] = i % 3;
    assert_int_equal(adcgs_exposure_create(&t->exposure, views, t->n_views, 0, &error), ADCGS_OK);
    free(views);
    assert_int_equal(t->exposure.n, 3);
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    const float black[3] = {10, 2, 16};
    darken(t, black, 0.5f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(t->exposure.cameras[i].black[c], (black[i] - 10) / 255, 0.3 / 255);
    const float taken[3] = {0.5f, 0.25f, 0.125f};
    float even[3];
    adcgs_exposure_even(&t->exposure, 1, taken, even, 1); /* the second view is the second camera's */
    for (int c = 0; c < 3; c++)
        assert_float_equal(even[c], taken[c] + 8.0f / 255, 0.3 / 255);
    /* A camera that sees too little black, or a darkness of its own, prevents an estimate for all cameras. */
    darken(t, black, 0.1f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    for (int i = 0; i < 3; i++)
        assert_true(t->exposure.cameras[i].black[0] == 0);
    darken(t, (const float[]){10, 2, 40}, 0.5f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    assert_true(t->exposure.cameras[1].black[2] == 0);
    adcgs_trainer_free(&t);
}

enum { CAMERAS = 3, PICTURES = 5, PLANE = 64 };

static void follow_picture(adcgs_exposure *exposure, uint32_t view, const float *drawn, const float *taken)
{
    adcgs_exposure_sums sums;
    adcgs_exposure_sum(exposure, view, drawn, taken, PLANE, &sums);
    adcgs_exposure_follow(exposure, view, &sums);
}

/**
 * Images by cameras of these gains, followed in capture order. even receives the images as the mean camera would have taken them.
 */
static uint32_t follow_cameras(const float *gain, uint32_t n_views, int still, float even[][3 * PLANE], const float *drawn)
{
    adcgs_scene_view views[CAMERAS * PICTURES] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    float taken[3 * PLANE];
    for (uint32_t i = 0; i < n_views; i++)
        views[i].camera.cam_to_world[3] = i % CAMERAS;
    assert_int_equal(adcgs_exposure_create(&exposure, views, n_views, still, &error), ADCGS_OK);
    for (int even_out = 0; even_out < 2; even_out++)
        for (uint32_t i = 0; exposure.n && i < n_views; i++) {
            for (int j = 0; j < 3 * PLANE; j++)
                taken[j] = gain[i % CAMERAS] * drawn[j];
            if (even_out)
                adcgs_exposure_even(&exposure, i, taken, even[i], PLANE);
            else
                follow_picture(&exposure, i, drawn, taken);
        }
    const uint32_t n = exposure.n;
    adcgs_exposure_clear(&exposure);
    return n;
}

static void cameras_are_evened_out(void **state)
{
    float drawn[3 * PLANE], even[CAMERAS * PICTURES][3 * PLANE];
    for (int j = 0; j < 3 * PLANE; j++)
        drawn[j] = 0.1f + (float)(j * 29 % 101) / 250;
    /* Gains of mean 1 are found to within 3 %, for any images. */
    assert_int_equal(follow_cameras((const float[]){0.5f, 1, 2}, CAMERAS * PICTURES, 0, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS * PICTURES; i++) {
        const double left = exp(0.03 * (i % CAMERAS - 1));
        for (int j = 0; j < 3 * PLANE; j++)
            assert_float_equal(even[i][j], left * (double)drawn[j], 1e-5);
    }
    /* Images of cameras that agree stay unchanged to the bit. */
    const float near[] = {0.99f, 1, 1.01f};
    assert_int_equal(follow_cameras(near, CAMERAS * PICTURES, 0, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS * PICTURES; i++)
        for (int j = 0; j < 3 * PLANE; j++)
            assert_true(even[i][j] == near[i % CAMERAS] * drawn[j]);
    /* Too few images per camera give no estimate. */
    assert_int_equal(follow_cameras(near, CAMERAS * 3, 0, even, drawn), 0);
    /* In a static scene one image per camera is enough, as soon as every camera has one. */
    assert_int_equal(follow_cameras((const float[]){0.5f, 1, 2}, CAMERAS, 1, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS; i++)
        assert_float_equal(even[i][7], exp(0.03 * (i % CAMERAS - 1)) * (double)drawn[7], 1e-5);
    adcgs_exposure exposure = {.n = 0};
    adcgs_scene_view views[2] = {{.time = 0}};
    float bright[3 * PLANE];
    views[1].camera.cam_to_world[3] = 1;
    for (int j = 0; j < 3 * PLANE; j++)
        bright[j] = 2 * drawn[j];
    assert_int_equal(adcgs_exposure_create(&exposure, views, 2, 1, &error), ADCGS_OK);
    follow_picture(&exposure, 0, drawn, bright);
    adcgs_exposure_even(&exposure, 0, bright, even[0], PLANE);
    assert_memory_equal(even[0], bright, sizeof bright);
    follow_picture(&exposure, 1, drawn, drawn);
    adcgs_exposure_even(&exposure, 0, bright, even[0], PLANE);
    assert_true(even[0][7] < 0.8f * bright[7]);
    adcgs_exposure_clear(&exposure);
}

/** No gain leaves the range of the images' brightness, for any model. */
static void gains_are_bounded_by_images(void **state)
{
    adcgs_scene_view views[CAMERAS] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    double brightness[CAMERAS] = {0.2, 0.25, 0.2};
    float drawn[3 * PLANE], taken[3 * PLANE], even[3 * PLANE];
    for (int i = 0; i < CAMERAS; i++)
        views[i].camera.cam_to_world[3] = i;
    assert_int_equal(adcgs_exposure_create(&exposure, views, CAMERAS, 1, &error), ADCGS_OK);
    adcgs_exposure_bound(&exposure, brightness);
    for (uint32_t i = 0; i < CAMERAS; i++) {
        for (int j = 0; j < 3 * PLANE; j++) {
            drawn[j] = i ? 0.3f : 0.1f; /* haze before the first camera doubles the brightness there */
            taken[j] = 0.3f;
        }
        follow_picture(&exposure, i, drawn, taken);
    }
    adcgs_exposure_even(&exposure, 0, taken, even, PLANE);
    assert_float_equal(log(0.3 / (double)even[0]), log(0.25 / 0.2) + 0.1, 1e-5);
    adcgs_exposure_clear(&exposure);
}

/** An overexposed pixel is a lower bound of the mean camera's value, except where it is the background of an image with alpha. */
static void burnt_pixels_are_lower_bounds(void **state)
{
    adcgs_scene_view views[2] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    float target[3 * PLANE], drawn[3 * PLANE];
    const float white[3] = {1, 1, 1};
    views[1].camera.cam_to_world[3] = 1;
    assert_int_equal(adcgs_exposure_create(&exposure, views, 2, 1, &error), ADCGS_OK);
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++)
            exposure.cameras[i] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {i ? 1 : 2, i ? 1 : 2, i ? 1 : 2}};
    for (int j = 0; j < 3 * PLANE; j++) {
        target[j] = j % PLANE == 0 ? 1 : j % PLANE == 1 ? 0.5f : j == 2 ? 1 : 0.25f; /* white, grey, and overexposed red */
        drawn[j] = 1.5f;
    }
    adcgs_exposure_even(&exposure, 0, target, target, PLANE);
    const float grey = target[1], red = target[2], even_white = target[0];
    assert_true(even_white < 0.8f);
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, white, target, PLANE);
    assert_true(target[0] == even_white && target[1] == grey && target[2] == 1.5f && target[PLANE + 2] < 0.25f);
    drawn[2] = 0.5f * red; /* a value below the bound is still an error */
    target[2] = red;
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, white, target, PLANE);
    assert_true(target[2] == red);
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, NULL, target, PLANE);
    assert_true(target[0] == 1.5f);
    adcgs_exposure_clear(&exposure);
}

/** Where nothing covers the background of images with alpha, there is no error, at any gain. */
static void backgrounds_have_no_gain(void **state)
{
    adcgs_scene white = *scene;
    adcgs_train_config config = small_config();
    const float *target;
    white.has_alpha = 1;
    for (int c = 0; c < 3; c++)
        white.background[c] = 1;
    const adcgs_scene *const before = scene;
    adcgs_trainer *t;
    assert_int_equal(adcgs_trainer_create(&t, &white, &config, adcgs_cpu_best(), pool, &error), ADCGS_OK);
    assert_ptr_equal(scene, before);
    adcgs_scene_view *views = calloc(t->n_views, sizeof *views);
    assert_non_null(views);
    for (uint32_t i = 0; i < t->n_views; i++)
        views[i].camera.cam_to_world[3] = i % 2;
    assert_int_equal(adcgs_exposure_create(&t->exposure, views, t->n_views, 0, &error), ADCGS_OK);
    free(views);
    t->exposure.cameras[0] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {2, 2, 2}};
    t->exposure.cameras[1] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {1, 1, 1}};
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    memset(t->f->keep, 0, (size_t)t->f->groups * ADCGS_LANES * t->f->params.k * sizeof *t->f->keep);
    adcgs_pass_forward(t->pass, t->f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_NONE});
    for (uint32_t i = 0; i < 2; i++) {
        const size_t values = 3 * (size_t)t->views[i].view.width * (size_t)t->views[i].view.height;
        for (size_t j = 0; j < values; j++)
            t->taken[j] = 1;
        assert_int_equal(adcgs_image_store_put(t->pictures, i, t->taken, &error), ADCGS_OK);
        assert_int_equal(adcgs_view_render(t, &t->views[i].view, i, t->image, 0, &error), ADCGS_OK);
        assert_int_equal(adcgs_trainer_target(t, i, NULL, &target, &error), ADCGS_OK);
        for (size_t j = 0; j < values; j++)
            assert_float_equal(t->image[j], target[j], 1e-6);
        assert_int_equal(target[0] < 0.8f, i == 0);
    }
    adcgs_trainer_free(&t);
}

/**
 * Where several views share a timestamp, defaults change: no rigidity loss, the scale regulariser from the start, and the whole
 * weight of the squared error. Settings given by the user win.
 */
static void moments_shared_by_views_change_settings(void **state)
{
    adcgs_scene alone = *scene;
    adcgs_train_config config = small_config();
    const float rigid = config.rigidity_weight, from = config.scale_reg_start, square = config.l2_share;
    const adcgs_scene *alone_and_shared[] = {&alone, scene};
    assert_true(rigid > 0 && from > 0 && square > 0.5f);
    alone.n_times = alone.n_views[ADCGS_SPLIT_TRAIN];
    for (int by_hand = 0; by_hand < 2; by_hand++)
        for (int i = 0; i < 2; i++) {
            adcgs_trainer *t;
            if (by_hand)
                assert_int_equal(adcgs_train_set(&config, "rigidity_weight=0.5,scale_reg_start=0.125,l2_share=0.75", &error),
                                 ADCGS_OK);
            assert_int_equal(adcgs_trainer_create(&t, alone_and_shared[i], &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
            assert_true(t->config.rigidity_weight == (by_hand ? 0.5f : i ? 0 : rigid));
            assert_true(t->config.scale_reg_start == (by_hand ? 0.125f : i ? 0 : from));
            assert_true(t->config.l2_share == (by_hand ? 0.75f : i ? square : 0.5f));
            adcgs_trainer_free(&t);
        }
}

/** Time follows a spline where fewer than half of the cameras see each frame, except if the user set it otherwise. */
static void few_cameras_make_time_smooth(void **state)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene alone = *scene, few = *scene;
    const adcgs_scene *scenes[] = {scene, &alone, &few};
    adcgs_train_config config = small_config();
    adcgs_scene_view *views = malloc(n * sizeof *views);
    assert_true(views && n >= 2 * scene->n_times);
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], n * sizeof *views);
    for (uint32_t i = 0; i < n; i++) /* in the second half of time cameras stand elsewhere, so that there are twice as many */
        views[i].camera.cam_to_world[3] += views[i].time > scene->duration / 2 ? 0.01 : 0;
    few.views[ADCGS_SPLIT_TRAIN] = views;
    alone.n_times = n;
    for (int by_hand = 0; by_hand < 2; by_hand++)
        for (int i = 0; i < 3; i++) {
            adcgs_trainer *t;
            if (by_hand)
                assert_int_equal(adcgs_train_set(&config, i ? "smooth_time=0" : "smooth_time=1", &error), ADCGS_OK);
            assert_int_equal(adcgs_trainer_create(&t, scenes[i], &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
            assert_int_equal(t->f->params.smooth_time, by_hand ? !i : i > 0);
            const adcgs_quantise_options how = {.cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor};
            adcgs_model model;
            t->f->is_part = 1; /* keeps motion in the stream even if nothing moves */
            adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_ROUND});
            assert_int_equal(adcgs_quantise(&model, t->f, &how, &error), ADCGS_OK);
            assert_int_equal(model.params.smooth_time, t->f->params.smooth_time);
            adcgs_model_clear(&model, NULL);
            adcgs_trainer_free(&t);
        }
    adcgs_trainer *t;
    adcgs_train_config without = small_config(); /* as preset paper */
    without.params.smooth_time = 0;
    assert_int_equal(adcgs_trainer_create(&t, &few, &without, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
    assert_int_equal(t->f->params.smooth_time, 0);
    adcgs_trainer_free(&t);
    free(views);
}

/* ---- Time ---- */

/** The learning-rate scale of a kind applies to its groups and to no other. */
static void rates_follow_their_kind(void **state)
{
    adcgs_train_config config = small_config();
    static const int groups[] = {ADCGS_P_COLOUR, ADCGS_P_THETA, ADCGS_P_TIME, ADCGS_P_E_FV};
    adcgs_trainer *plain = make_trainer(&config, NULL), *told;
    const adcgs_status status =
        adcgs_train_set(&config, "lr_scale_anchors=2,lr_scale_prediction=3,lr_scale_motion=5,lr_scale_entropy=7", &error);
    assert_int_equal(status, ADCGS_OK);
    told = make_trainer(&config, NULL);
    for (int i = 0; i < 4; i++) {
        const adcgs_param *p = &plain->f->param[groups[i]], *q = &told->f->param[groups[i]];
        const float times = (const float[]){2, 3, 5, 7}[i];
        assert_true(p->lr0 > p->lr1 && p->lr1 > 0);
        assert_float_equal(q->lr0, times * p->lr0, 1e-6);
        assert_float_equal(q->lr1, times * p->lr1, 1e-6);
    }
    adcgs_trainer_free(&plain);
    adcgs_trainer_free(&told);
}

/** Learning rates are constant until lr_decay_start, then fall by equal factors in equal times. */
static void rates_stay_then_fall(void **state)
{
    adcgs_train_config c = {.lr_decay_start = 0.5f};
    for (int i = 0; i <= 2; i++)
        assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.25 * i), 8, 0);
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.75), 4, 1e-6);
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 1), 2, 1e-6);
    c.lr_decay_start = 0;
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.5), 4, 1e-6);
    c.lr_decay_start = 2;
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 1), 8, 0);
}

/** Seconds per iteration of an imaginary machine: this share of an iteration at full resolution is not spent on pixels. */
static double true_cost(int divide, double overhead)
{
    return 0.01 * (overhead + (1 - overhead) / (divide * divide));
}

/** The estimate of the remaining time is never negative, never rises by much, and is near the truth from the start on. */
static void time_left_follows_the_schedule(void **state)
{
    static const double overheads[] = {0.05, 0.2, 0.6, 1};
    static const float halves[][2] = {{0.25f, 0.7f}, {0, 0}, {0.3f, 0.3f}, {0, 0.5f}, {1, 1}};
    enum { N = 4000 };
    for (size_t o = 0; o < ADCGS_COUNTOF(overheads); o++)
        for (size_t h = 0; h < ADCGS_COUNTOF(halves); h++) {
            adcgs_train_config c = small_config();
            adcgs_time_left left = {.load = 0};
            c.iterations = N;
            c.quarter_size_until = halves[h][0];
            c.half_size_until = halves[h][1];
            assert_true(isnan(adcgs_time_left_of(&left, &c, 0, 0)));
            double truth = 0, before = HUGE_VAL;
            for (uint32_t i = 0; i < N; i++)
                truth += true_cost(adcgs_coarse_divide(&c, (double)i / N), overheads[o]);
            for (uint32_t i = 0; i < N; i++) {
                const int divide = adcgs_coarse_divide(&c, (double)i / N);
                const double cost = true_cost(divide, overheads[o]);
                adcgs_time_left_add(&left, divide, cost);
                truth -= cost;
                const double told = adcgs_time_left_of(&left, &c, i + 1, 0);
                const int last = divide == 1 || (double)i / N >= (double)halves[h][1];
                assert_true(told >= 0 && told < 4.1 * truth + 1e-9 && told > truth / 4.1 - 1e-9);
                assert_true(!last || fabs(told - truth) < 1e-6 * N);
                assert_true(told <= before || divide != adcgs_coarse_divide(&c, i ? (double)(i - 1) / N : 0));
                before = told;
            }
            assert_true(before < 1e-9);
            /* The time limit ends the run, with or without an estimate. After its end the remaining time is 0, not negative. */
            c.time_limit = 7;
            assert_true(adcgs_time_left_of(&left, &c, 0, 6.5) <= 0.5 && adcgs_time_left_of(&left, &c, 0, 99) == 0);
            left = (adcgs_time_left){.load = 0};
            assert_true(adcgs_time_left_of(&left, &c, 0, 3) == 4);
            assert_true(adcgs_time_left_of(&left, &c, N, 3) == 0);
        }
}

/** Future loading between resolutions counts. */
static void time_left_knows_loading(void **state)
{
    adcgs_train_config c = small_config();
    adcgs_time_left left = {.cost = {1, 1, 1}, .load = 100};
    c.iterations = 10;
    c.quarter_size_until = 0.2f;
    c.half_size_until = 0.5f;
    assert_true(adcgs_time_left_of(&left, &c, 0, 0) == 210);
    assert_true(adcgs_time_left_of(&left, &c, 3, 0) == 107);
    assert_true(adcgs_time_left_of(&left, &c, 9, 0) == 1);
}

/** The time limit counts from the start of the program. If it is over before the first iteration, there is no run. */
static void time_limits_count_what_was_before(void **state)
{
    adcgs_train_config config = small_config();
    int stopped;
    config.time_limit = 5;
    adcgs_trainer *t = make_trainer(&config, pool);
    t->started.clock = adcgs_seconds() - 6;
    assert_int_equal(adcgs_trainer_run(t, NULL, NULL, &stopped, &error), ADCGS_ERR_USAGE);
    assert_int_equal(t->iteration, 0);
    assert_true(strstr(error.text, "time limit of 5 s") && strstr(error.text, "before training began"));
    adcgs_trainer_free(&t);
    /* The remaining time is many times that of a short run, however busy the machine is. */
    config.time_limit = 0;
    config.iterations = 10;
    const double begin = adcgs_seconds();
    t = make_trainer(&config, pool);
    run(t, NULL, NULL);
    adcgs_trainer_free(&t);
    const double left = fmax(1, 5 * (adcgs_seconds() - begin));
    config.time_limit = 10000;
    config.iterations = 1000000;
    t = make_trainer(&config, pool);
    t->started.clock = adcgs_seconds() - (config.time_limit - left);
    run(t, NULL, NULL);
    assert_true(t->iteration > 0 && t->iteration < config.iterations);
    assert_true(t->elapsed.clock >= config.time_limit && t->elapsed.cpu > 0);
    adcgs_trainer_free(&t);
}

/* ---- Masks ---- */

enum { MASK_FROM = 6, MASK_UNTIL = 19 }; /* columns and rows */

static int is_masked(int i, int width)
{
    const int x = i % width, y = i / width;
    return x >= MASK_FROM && x < MASK_UNTIL && y >= MASK_FROM && y < MASK_UNTIL;
}

/** Writes a copy of a view's image, under a name of its own, with other values behind the mask. */
static void put_behind_mask(adcgs_scene_view *v, uint32_t number, float value)
{
    char name[64];
    adcgs_image image;
    assert_int_equal(adcgs_image_read(&image, v->path, &error), ADCGS_OK);
    for (int i = 0; i < image.width * image.height; i++)
        for (int c = 0; is_masked(i, image.width) && c < image.channels; c++)
            image.data[i * image.channels + c] = value * (float)((i + c + (int)number) % 3) / 2;
    snprintf(name, sizeof name, "behind_%u_%g.ppm", number, (double)value);
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
    v->path = strdup(in(name));
}

/** A run on views with a mask, and its report at the end. */
static void run_behind_mask(float value, adcgs_buffer *end, double *psnr)
{
    adcgs_train_config config = small_config();
    adcgs_scene masked = *scene;
    const uint32_t n = masked.n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene_view *views = calloc(n, sizeof *views);
    masked.views[ADCGS_SPLIT_TRAIN] = views;
    for (uint32_t i = 0; i < n; i++) {
        views[i] = scene->views[ADCGS_SPLIT_TRAIN][i];
        put_behind_mask(&views[i], i, value);
        views[i].mask = strdup(in("mask.pgm"));
    }
    adcgs_trainer *t;
    assert_int_equal(adcgs_trainer_create(&t, &masked, &config, adcgs_cpu_best(), pool, &error), ADCGS_OK);
    t->quantise = adcgs_encode_quantise_hook;
    run(t, NULL, NULL);
    store(t, end);
    assert_int_equal(adcgs_sample_psnr(t, 4, psnr, &error), ADCGS_OK);
    assert_true(all_finite(t->f) && t->rollbacks == 0);
    adcgs_trainer_free(&t);
    for (uint32_t i = 0; i < n; i++) {
        unlink(views[i].path);
        adcgs_scene_view_clear(&views[i]);
    }
    free(views);
}

/** Pixels behind a mask have no effect: with any values the run ends in the same state, to the bit. */
static void masked_pixels_have_no_part(void **state)
{
    const int side = 32; /* of the tiny scene's images */
    adcgs_image mask;
    adcgs_buffer dark, bright;
    double psnr[2];
    assert_int_equal(adcgs_image_alloc(&mask, side, side, 1, "mask", &error), ADCGS_OK);
    for (int i = 0; i < side * side; i++)
        mask.data[i] = !is_masked(i, side);
    assert_int_equal(adcgs_image_write(&mask, in("mask.pgm"), 0, &error), ADCGS_OK);
    adcgs_image_free(&mask);
    run_behind_mask(0, &dark, &psnr[0]);
    run_behind_mask(1, &bright, &psnr[1]);
    assert_same(&dark, &bright);
    assert_true(psnr[0] == psnr[1] && psnr[0] > 10);
    adcgs_buffer_clear(&dark);
    adcgs_buffer_clear(&bright);
}

/* ---- Missing content ---- */

/** Every view shows the background and one dot: at the projection of x, or scattered, elsewhere in each view. */
static void show_dot(adcgs_trainer *t, const float x[3], int scattered)
{
    static const float colour[3] = {0.9f, 0.6f, 0.3f};
    for (uint32_t i = 0; i < t->n_views; i++) {
        const adcgs_view *v = &t->views[i].view;
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
        assert_int_equal(adcgs_image_store_put(t->pictures, i, t->taken, &error), ADCGS_OK);
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
    for (uint32_t i = 0; i < t->n_views; i++)
        t->views[i].t = (float)i / (float)t->n_views; /* no two views share a timestamp */
    assert_int_equal(adcgs_residual_find(t, places, MOST, &n, &error), ADCGS_OK);
    assert_int_equal(n, 0);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restored_runs_go_on_in_lockstep),
        cmocka_unit_test(checkpoints_are_checked),
        cmocka_unit_test(checkpoints_name_what_differs),
        cmocka_unit_test(bad_configurations_make_no_trainer),
        cmocka_unit_test(checkpoints_know_their_scene),
        cmocka_unit_test(densification_keeps_order_and_budget),
        cmocka_unit_test(densification_prunes_what_is_not_seen),
        cmocka_unit_test(faint_primitives_go),
        cmocka_unit_test(what_faint_primitives_make_stays),
        cmocka_unit_test(faint_layers_move_together),
        cmocka_unit_test(what_never_changes_is_static),
        cmocka_unit_test(no_number_is_rolled_back),
        cmocka_unit_test(no_number_is_rolled_back_late),
        cmocka_unit_test(lasting_poison_ends_the_run),
        cmocka_unit_test(decoded_values_are_their_own_quantisation),
        cmocka_unit_test(rounding_is_decoding),
        cmocka_unit_test(estimated_bits_are_written_bytes),
        cmocka_unit_test(rate_reaches_every_weight),
        cmocka_unit_test(motion_pays_for_little),
        cmocka_unit_test(still_models_carry_no_motion),
        cmocka_unit_test(uncompressed_models_lose_nothing),
        cmocka_unit_test(windows_grow_outwards),
        cmocka_unit_test(averages_are_means),
        cmocka_unit_test(black_levels_are_found),
        cmocka_unit_test(cameras_are_evened_out),
        cmocka_unit_test(gains_are_bounded_by_images),
        cmocka_unit_test(burnt_pixels_are_lower_bounds),
        cmocka_unit_test(backgrounds_have_no_gain),
        cmocka_unit_test(lambda_follows_contrast),
        cmocka_unit_test(moments_shared_by_views_change_settings),
        cmocka_unit_test(few_cameras_make_time_smooth),
        cmocka_unit_test(crops_are_parts_of_pictures),
        cmocka_unit_test(rates_stay_then_fall),
        cmocka_unit_test(rates_follow_their_kind),
        cmocka_unit_test(time_left_follows_the_schedule),
        cmocka_unit_test(time_left_knows_loading),
        cmocka_unit_test(tiers_are_of_falling_worth),
        cmocka_unit_test(time_limits_count_what_was_before),
        cmocka_unit_test(masked_pixels_have_no_part),
        cmocka_unit_test(missing_things_are_found),
    };
    return cmocka_run_group_tests_name("trainer", tests, open_scene, close_scene);
}
