/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The walk over the state of a run, and its visitors in memory: storing and restoring. */
#include "train/state/checkpoint_walk.h"

#include "base/digest.h"
#include "system/text.h"
#include "train/settings.h"
#include "train/state/checkpoint_check.h"

#include <stdarg.h>

/** Puts a mismatch into the message; only the first one is kept. */
static void differ(adcgs_checkpoint_walk *w, const char *format, ...) ADCGS_PRINTF(2, 3);
static void differ(adcgs_checkpoint_walk *w, const char *format, ...)
{
    va_list arguments;
    if (w->failed || w->differs[0])
        return;
    va_start(arguments, format);
    vsnprintf(w->differs, sizeof w->differs, format, arguments);
    va_end(arguments);
}

/** The target binds a run once lambda affects it. Before, a run may continue with another target. */
static void walk_target(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    const adcgs_train_config *c = &t->config;
    uint32_t target = c->target;
    double value = c->target_value;
    adcgs_checkpoint_visit(w, &t->rate.lambda_used, sizeof t->rate.lambda_used);
    adcgs_checkpoint_visit(w, &target, sizeof target);
    adcgs_checkpoint_visit(w, &value, sizeof value);
    if (t->rate.lambda_used && (target != c->target || value != c->target_value))
        differ(w, "saved with other options: another target, and the run depends on it by now");
}

/** All settings. The time limit is not one of them, so a run may continue with another. */
static void walk_settings(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    adcgs_checkpoint_visit(w, &t->stage.rounding, sizeof t->stage.rounding);
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        const int bound =
            s->fixed == ADCGS_FIXED_WITH_LAMBDA ? t->rate.lambda_used : s->fixed == ADCGS_FIXED_ALWAYS || t->stage.rounding;
        const double here = adcgs_setting_get(s, &t->config);
        char texts[2][ADCGS_SETTING_TEXT];
        double there = here;
        adcgs_checkpoint_visit(w, &there, sizeof there);
        const char *const reason = t->config.origin[s - adcgs_settings].reason;
        if (bound && there != here)
            differ(w, "saved with other options: %s is %s in the file and %s here%s%s", s->name,
                   adcgs_setting_print(s, there, texts[0]), adcgs_setting_print(s, here, texts[1]), reason ? ", because " : "",
                   reason ? reason : "");
    }
}

/** Visits the checksum of a part of the scene. */
static void visit_part(adcgs_checkpoint_walk *w, const char *what, uint32_t crc)
{
    uint32_t stored = crc;
    adcgs_checkpoint_visit(w, &stored, sizeof stored);
    if (stored != crc)
        differ(w, "saved with another scene: different %s", what);
}

static uint32_t add_camera(uint32_t crc, const adcgs_scene_view *v)
{
    const adcgs_camera *c = &v->camera;
    const adcgs_lens *l = &v->lens;
    const double numbers[] = {c->width, c->height, c->fx, c->fy, c->cx,   c->cy, c->near_plane, l->width, l->height,
                              l->fx,    l->fy,     l->cx, l->cy, l->skew, l->k8, l->p[0],       l->p[1],  (double)l->is_fisheye};
    crc = adcgs_crc32c(crc, numbers, sizeof numbers);
    crc = adcgs_crc32c(crc, l->k, sizeof l->k);
    return adcgs_crc32c(crc, c->cam_to_world, sizeof c->cam_to_world);
}

/** Visits the scene except its images. Their location does not matter, and their contents are compared only for files. */
static void walk_scene(adcgs_checkpoint_walk *w, const adcgs_trainer *t)
{
    const adcgs_scene *s = t->scene;
    uint32_t cameras = 0, times = 0;
    uint64_t n = t->views.n;
    adcgs_checkpoint_visit(w, &n, sizeof n);
    if (n != t->views.n)
        differ(w, "saved with another scene: %llu training view%s in the file and %u here", (unsigned long long)n, adcgs_s(n),
               t->views.n);
    for (uint32_t i = 0; i < t->views.n; i++) {
        const adcgs_scene_view *v = &s->views[ADCGS_SPLIT_TRAIN][i];
        cameras = add_camera(cameras, v);
        times = adcgs_crc32c(times, &v->time, sizeof v->time);
        times = adcgs_crc32c(times, &v->frame, sizeof v->frame);
    }
    visit_part(w, "cameras", cameras);
    visit_part(w, "timestamps", adcgs_crc32c(times, &s->duration, sizeof s->duration));
    visit_part(w, "background", adcgs_crc32c((uint32_t)s->has_alpha, s->background, sizeof s->background));
    visit_part(w, "initial points", adcgs_crc32c(0, s->points.position, s->points.n * sizeof *s->points.position));
}

/** The model of the previous segment is part of a run's input. */
static void walk_before(adcgs_checkpoint_walk *w, const adcgs_trainer *t)
{
    uint8_t digest[sizeof t->before];
    memcpy(digest, t->before, sizeof digest);
    adcgs_checkpoint_visit(w, digest, sizeof digest);
    if (memcmp(digest, t->before, sizeof digest))
        differ(w, "saved with another previous segment");
}

static void walk_config(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    uint64_t format = ADCGS_CHECKPOINT_FORMAT;
    adcgs_checkpoint_visit(w, &format, sizeof format);
    if (format != ADCGS_CHECKPOINT_FORMAT)
        differ(w, "saved by another version of the program");
    walk_scene(w, t);
    walk_before(w, t);
    walk_target(w, t);
    adcgs_checkpoint_visit(w, t->trials, sizeof t->trials);
    t->trials[sizeof t->trials - 1] = '\0';
    walk_settings(w, t);
}

static void walk_parts(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    adcgs_run_state_walk(w, &t->run);
    adcgs_stage_state_walk(w, &t->stage);
    adcgs_rate_state_walk(w, &t->rate);
    adcgs_curriculum_walk(w, &t->curriculum);
    adcgs_decisions_walk(w, &t->decisions);
}

/** Hidden layers may be narrower than at the start. */
static void walk_width(adcgs_checkpoint_walk *w, adcgs_fmodel *f, int group)
{
    const int from[ADCGS_P_COUNT] =
        {[ADCGS_P_THETA] = f->shape.theta_width, [ADCGS_P_OMEGA] = f->shape.omega_width, [ADCGS_P_VARPI] = f->shape.varpi_width};
    int width = f->mlp[group].width;
    adcgs_checkpoint_visit(w, &width, sizeof width);
    if (!f->mlp[group].hidden || !w->in)
        return;
    if (width < 1 || width > (f->mlp[group].entropy ? f->shape.entropy_width : from[group]))
        w->failed = 1;
    else
        adcgs_fmodel_set_width(f, group, width);
}

static void walk_arrays(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    adcgs_fmodel *f = t->f;
    const size_t lanes = (size_t)f->groups * ADCGS_LANES, slots = lanes * f->params.k;
    adcgs_checkpoint_visit(w, f->keep, slots * sizeof(float));
    adcgs_checkpoint_visit(w, f->moving, lanes * sizeof(float));
    adcgs_checkpoint_visit(w, f->body, lanes);
    adcgs_checkpoint_visit(w, f->tier, lanes);
    adcgs_checkpoint_visit(w, &f->finest, sizeof f->finest);
    adcgs_checkpoint_visit(w, f->growth, sizeof f->growth);
    adcgs_checkpoint_visit(w, f->trainable, lanes * sizeof(float));
    w->failed |= f->finest >= ADCGS_TIERS_MAX;
    adcgs_checkpoint_visit(w, f->centre, sizeof f->centre);
    adcgs_checkpoint_visit(w, t->stats.weight, adcgs_train_stats_size(f) * sizeof(float));
    adcgs_checkpoint_visit(w, &t->stats.n, sizeof t->stats.n);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &f->param[i];
        walk_width(w, f, i);
        adcgs_checkpoint_visit(w, &p->steps, sizeof p->steps);
        adcgs_checkpoint_visit(w, p->p, p->n * sizeof(float));
        adcgs_checkpoint_visit(w, p->m, p->n * sizeof(float));
        adcgs_checkpoint_visit(w, p->v, p->n * sizeof(float));
        adcgs_checkpoint_visit(w, f->mlp[i].weight_step, sizeof f->mlp[i].weight_step);
    }
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        adcgs_checkpoint_visit(w, t->pass->mu[i], f->param[i].n * sizeof(float));
    adcgs_checkpoint_visit(w, t->pass->factor, lanes * (size_t)adcgs_params_steps(&f->params) * sizeof(float));
}

static void walk_average(adcgs_checkpoint_walk *w, adcgs_trainer *t)
{
    adcgs_weight_average *a = &t->average;
    uint32_t n = a->n;
    adcgs_checkpoint_visit(w, &n, sizeof n);
    if (n > 0 && w->in && adcgs_weight_average_begin(a, t->f, NULL) != ADCGS_OK)
        w->failed = 1;
    a->n = w->failed ? 0 : n;
    if (a->n > 0)
        adcgs_checkpoint_visit(w, a->mean, a->size * sizeof *a->mean);
}

void adcgs_checkpoint_walk_all(adcgs_checkpoint_walk *w, const adcgs_trainer *trainer)
{
    adcgs_trainer *t = (adcgs_trainer *)(uintptr_t)trainer; /* the storing visitors only read */
    walk_config(w, t);
    walk_parts(w, t);
    adcgs_checkpoint_visit(w, &t->f->n, sizeof t->f->n);
    adcgs_checkpoint_visit(w, t->f->pos, t->f->n * sizeof *t->f->pos);
    walk_arrays(w, t);
    walk_average(w, t);
    adcgs_exposure_walk(w, &t->exposure);
    adcgs_rate_state_walk_begin(w, &t->rate);
}

adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_checkpoint_walk w = {.out = out};
    adcgs_checkpoint_walk_all(&w, trainer);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a checkpoint") : ADCGS_OK;
}

/** Sets the stored number of anchors and their positions; the parameters follow. */
static adcgs_status restore_anchors(adcgs_checkpoint_walk *w, adcgs_trainer *t, adcgs_error *error)
{
    uint32_t n = 0;
    adcgs_checkpoint_visit(w, &n, sizeof n);
    if (w->failed || n == 0 || n > adcgs_reader_left(w->in) / 12)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%u anchors do not match the size of the data", n);
    uint32_t(*pos)[3] = adcgs_alloc(NULL, n, sizeof *pos, error);
    uint32_t *source = adcgs_alloc(NULL, n, sizeof *source, error);
    adcgs_status status = pos && source ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        adcgs_checkpoint_visit(w, pos, n * sizeof *pos);
        const char *const wrong = adcgs_checkpoint_check_places(t->f, (const uint32_t(*)[3])pos, n);
        status = wrong ? adcgs_fail(error, ADCGS_ERR_DATA, "%s", wrong) : ADCGS_OK;
    }
    if (status == ADCGS_OK) {
        status = adcgs_fmodel_regroup(t->f, (const uint32_t(*)[3])pos, source, NULL, n, error);
    }
    adcgs_free(NULL, pos);
    adcgs_free(NULL, source);
    return status == ADCGS_OK ? adcgs_trainer_resize(t, error) : status;
}

adcgs_status adcgs_trainer_restore(adcgs_trainer *t, const uint8_t *data, size_t size, adcgs_error *error)
{
    adcgs_reader reader;
    adcgs_reader_init(&reader, data, size);
    adcgs_checkpoint_walk w = {.in = &reader};
    walk_config(&w, t);
    if (w.differs[0])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s", w.differs);
    if (w.failed)
        return adcgs_fail(error, ADCGS_ERR_DATA, "it ends too early");
    walk_parts(&w, t);
    ADCGS_TRY(restore_anchors(&w, t, error));
    walk_arrays(&w, t);
    walk_average(&w, t);
    adcgs_exposure_walk(&w, &t->exposure);
    adcgs_rate_state_walk_begin(&w, &t->rate);
    if (w.failed || adcgs_reader_left(&reader))
        return adcgs_fail(error, ADCGS_ERR_DATA, "its length does not match its contents");
    const char *const wrong = adcgs_checkpoint_check(t);
    if (wrong)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s", wrong);
    adcgs_fmodel_take_steps(t->f);
    adcgs_trainer_prepare_networks(t);
    return ADCGS_OK;
}
