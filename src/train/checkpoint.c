/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Checkpoints: one walk over the state of a run visits every number that the
 * rest of the run depends on; saving and loading are its two visitors.
 * A file is "ADCGSCKP", a format number, the walk, and a CRC-32C of it all.
 */
#include "train/checkpoint.h"

#include "base/digest.h"
#include "io/atomic.h"
#include "io/file.h"

#include <stdio.h>
#include <stdlib.h>

static const char magic[8] = { 'A', 'D', 'C', 'G', 'S', 'C', 'K', 'P' };
enum { FORMAT = 18 };

typedef struct walk {
    adcgs_buffer *out; /* storing */
    adcgs_reader *in;  /* or restoring */
    int failed;
} walk;

static void visit(walk *w, void *data, size_t bytes)
{
    if (w->out) {
        adcgs_write_bytes(w->out, data, bytes);
        return;
    }
    const uint8_t *from = adcgs_read_bytes(w->in, bytes);
    if (from)
        memcpy(data, from, bytes);
    else
        w->failed = 1;
}

/** A number that must be the same in the run and in the file. */
static void visit_same(walk *w, uint64_t value)
{
    uint64_t stored = value;
    visit(w, &stored, sizeof stored);
    w->failed |= stored != value;
}

/** Everything that the run depends on and no limit of time: a run may go on with another. */
static void walk_options(walk *w, const adcgs_train_config *c)
{
    const uint64_t whole[] = { c->seed, c->iterations, (uint64_t)c->scale, c->start_anchors, c->max_anchors, c->densify_every,
                               (uint64_t)c->rate_period, c->without_coarse, c->without_fine, c->without_rate,
                               c->without_densification, c->without_rounding, c->bf16 };
    const float real[] = { c->ssim_weight, c->densify_threshold, c->prune_opacity, c->keep_opacity, c->rigid_weight,
                           c->scale_weight, c->still_below, c->rdo_strength, c->dropout, c->network_rate, c->average_last,
                           c->curriculum_begin, c->curriculum_until, c->quarter_until, c->half_until, c->scale_from,
                           c->deform_from, c->fine_from, c->densify_from, c->densify_until, c->noise_from, c->rate_from,
                           c->prune_units_at, c->prune_units_again, c->decide_at, c->round_from, c->freeze_from };
    for (size_t i = 0; i < ADCGS_COUNTOF(whole); i++)
        visit_same(w, whole[i]);
    for (size_t i = 0; i < ADCGS_COUNTOF(real); i++)
        visit_same(w, adcgs_float_bits(real[i]));
}

/** A run is bound to its lambda, or its target, from where that has a say; before, it may go on with another. */
static void walk_lambda(walk *w, adcgs_trainer *t)
{
    const adcgs_train_config *c = &t->config;
    uint32_t lambda = adcgs_float_bits(c->lambda), target = c->target;
    double value = c->target_value;
    visit(w, &lambda, sizeof lambda);
    visit(w, &target, sizeof target);
    visit(w, &value, sizeof value);
    visit(w, &t->lambda_used, sizeof t->lambda_used);
    w->failed |= t->lambda_used && (lambda != adcgs_float_bits(c->lambda) || target != c->target || value != c->target_value);
}

/** Whether weights get a lattice is open until they do. */
static void walk_lattice(walk *w, adcgs_trainer *t)
{
    uint8_t without = t->config.without_weight_steps;
    visit(w, &without, sizeof without);
    visit(w, &t->rounding, sizeof t->rounding);
    w->failed |= t->rounding && without != t->config.without_weight_steps;
}

static void walk_sizes(walk *w, const adcgs_params *p, const adcgs_shape *s)
{
    const int sizes[] = { p->k, p->n_fv, p->n_fg, p->chunks, p->n_eta, p->octaves, p->fine_uses_fv, p->coarse_rotation,
                          p->adaptive_steps, p->time_rows, p->time_width, s->theta_width, s->theta_hidden, s->omega_width,
                          s->omega_hidden, s->varpi_width, s->varpi_hidden, s->entropy_width, s->entropy_hidden, s->depth };
    const float steps[] = { s->step_fv, s->step_fg, s->step_sigma, s->step_colour };
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++)
        visit_same(w, (uint64_t)sizes[i]);
    for (size_t i = 0; i < ADCGS_COUNTOF(steps); i++)
        visit_same(w, adcgs_float_bits(steps[i]));
}

/** The scene by its cameras and times; its pictures are taken on trust. */
static void walk_scene(walk *w, const adcgs_trainer *t)
{
    uint32_t crc = 0;
    for (uint32_t i = 0; i < t->n_views; i++) {
        const adcgs_scene_view *v = &t->scene->views[ADCGS_SPLIT_TRAIN][i];
        crc = adcgs_crc32c(crc, v->camera.cam_to_world, sizeof v->camera.cam_to_world);
        crc = adcgs_crc32c(crc, &v->camera.fx, sizeof v->camera.fx);
        crc = adcgs_crc32c(crc, &v->time, sizeof v->time);
    }
    visit_same(w, t->n_views);
    visit_same(w, crc);
}

static void walk_config(walk *w, adcgs_trainer *t)
{
    visit_same(w, FORMAT);
    walk_options(w, &t->config);
    walk_lambda(w, t);
    walk_lattice(w, t);
    walk_sizes(w, &t->f->params, &t->f->shape);
    walk_scene(w, t);
}

static void walk_scalars(walk *w, adcgs_trainer *t)
{
    visit(w, &t->iteration, sizeof t->iteration);
    visit(w, &t->adam_steps, sizeof t->adam_steps);
    visit(w, &t->weighed, sizeof t->weighed);
    visit(w, &t->slimmed, sizeof t->slimmed);
    visit(w, &t->decided, sizeof t->decided);
    visit(w, &t->frozen, sizeof t->frozen);
    visit(w, &t->lr_scale, sizeof t->lr_scale);
    visit(w, &t->lambda, sizeof t->lambda);
    visit(w, &t->rate_control, sizeof t->rate_control);
    visit(w, &t->curriculum.n, sizeof t->curriculum.n);
    visit(w, &t->curriculum.first, sizeof t->curriculum.first);
    visit(w, &t->curriculum.last, sizeof t->curriculum.last);
    visit(w, &t->rollbacks, sizeof t->rollbacks);
    visit(w, &t->mean_loss, sizeof t->mean_loss);
    visit(w, &t->mean_mse, sizeof t->mean_mse);
    visit(w, t->mean_bits, sizeof t->mean_bits);
    visit(w, &t->elapsed, sizeof t->elapsed);
}

/** Hidden layers may be narrower than they began. */
static void walk_width(walk *w, adcgs_fmodel *f, int group)
{
    const int from[ADCGS_P_COUNT] = { [ADCGS_P_THETA] = f->shape.theta_width, [ADCGS_P_OMEGA] = f->shape.omega_width,
                                      [ADCGS_P_VARPI] = f->shape.varpi_width };
    int width = f->mlp[group].width;
    visit(w, &width, sizeof width);
    if (!f->mlp[group].hidden || w->out)
        return;
    if (width < 1 || width > (f->mlp[group].entropy ? f->shape.entropy_width : from[group]))
        w->failed = 1;
    else
        adcgs_fmodel_set_width(f, group, width);
}

static void walk_arrays(walk *w, adcgs_trainer *t)
{
    adcgs_fmodel *f = t->f;
    const size_t lanes = (size_t)f->groups * 64, slots = lanes * f->params.k;
    visit(w, f->density, sizeof f->density);
    visit(w, f->keep, slots * sizeof(float));
    visit(w, f->moving, lanes * sizeof(float));
    visit(w, t->stats.weight, 3 * slots * sizeof(float));
    visit(w, &t->stats.n, sizeof t->stats.n);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &f->param[i];
        walk_width(w, f, i);
        visit(w, p->p, p->n * sizeof(float));
        visit(w, p->m, p->n * sizeof(float));
        visit(w, p->v, p->n * sizeof(float));
        visit(w, f->mlp[i].weight_step, sizeof f->mlp[i].weight_step);
    }
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        visit(w, t->pass->mu[i], f->param[i].n * sizeof(float));
    visit(w, t->pass->factor, lanes * (size_t)adcgs_params_steps(&f->params) * sizeof(float));
}

static void walk_average(walk *w, adcgs_trainer *t)
{
    adcgs_weight_average *a = &t->average;
    uint32_t n = a->n;
    visit(w, &n, sizeof n);
    if (n > 0 && !w->out && adcgs_weight_average_begin(a, t->f, NULL) != ADCGS_OK)
        w->failed = 1;
    a->n = w->failed ? 0 : n;
    if (a->n > 0)
        visit(w, a->mean, a->size * sizeof *a->mean);
}

/** The cameras are the scene's. */
static void walk_exposure(walk *w, adcgs_trainer *t)
{
    for (uint32_t i = 0; i < t->exposure.n; i++)
        visit(w, &t->exposure.cameras[i], sizeof t->exposure.cameras[i]);
}

adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_trainer *t = (adcgs_trainer *)(uintptr_t)trainer; /* the storing visitor only reads */
    walk w = { out, NULL, 0 };
    walk_config(&w, t);
    walk_scalars(&w, t);
    visit(&w, &t->f->n, sizeof t->f->n);
    visit(&w, t->f->pos, t->f->n * sizeof *t->f->pos);
    walk_arrays(&w, t);
    walk_average(&w, t);
    walk_exposure(&w, t);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a checkpoint") : ADCGS_OK;
}

/** Give the model the stored number of anchors and their places; parameters follow. */
static adcgs_status restore_anchors(walk *w, adcgs_trainer *t, adcgs_error *error)
{
    uint32_t n = 0;
    visit(w, &n, sizeof n);
    if (w->failed || n == 0 || n > adcgs_reader_left(w->in) / 12)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%u anchors do not fit its size", n);
    uint32_t(*pos)[3] = adcgs_alloc(NULL, n, sizeof *pos, error);
    uint32_t *source = adcgs_alloc(NULL, n, sizeof *source, error);
    adcgs_status status = pos && source ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        visit(w, pos, n * sizeof *pos);
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
    walk w = { NULL, &reader, 0 };
    walk_config(&w, t);
    if (w.failed)
        return adcgs_fail(error, ADCGS_ERR_DATA, "saved with other options or another scene; give the same as then");
    walk_scalars(&w, t);
    if (!t->lambda_used)
        t->lambda = (double)t->config.lambda;
    ADCGS_TRY(restore_anchors(&w, t, error));
    walk_arrays(&w, t);
    walk_average(&w, t);
    walk_exposure(&w, t);
    if (w.failed || adcgs_reader_left(&reader))
        return adcgs_fail(error, ADCGS_ERR_DATA, "its length does not match its contents");
    adcgs_fmodel_take_steps(t->f);
    adcgs_trainer_prepare_networks(t);
    return ADCGS_OK;
}

adcgs_status adcgs_trainer_save(const adcgs_trainer *t, const char *path, adcgs_error *error)
{
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    adcgs_write_bytes(&b, magic, sizeof magic);
    adcgs_status status = adcgs_trainer_store(t, &b, error);
    if (status == ADCGS_OK) {
        adcgs_write_uint(&b, adcgs_crc32c(0, b.data, b.size), 4);
        status = b.failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path)
                          : adcgs_atomic_save(path, b.data, b.size, error);
    }
    adcgs_buffer_clear(&b);
    return status;
}

adcgs_status adcgs_trainer_load(adcgs_trainer *t, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t size;
    ADCGS_TRY(adcgs_file_load(&data, &size, path, 1ull << 36, error));
    adcgs_status status;
    if (size < sizeof magic + 4 || memcmp(data, magic, sizeof magic))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "not a checkpoint of adcgs-enc");
    else if (adcgs_crc32c(0, data, size - 4) != adcgs_load_le32(data + size - 4))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "damaged: its checksum does not match");
    else
        status = adcgs_trainer_restore(t, data + sizeof magic, size - 4 - sizeof magic, error);
    free(data);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}
