/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The model's storage, and the shapes that its parameters imply. */
#include "model/model.h"
#include "model/model_priv.h"

int adcgs_params_layers(const adcgs_params *params)
{
    return params->n_fg ? 1 + params->chunks : 1;
}

int adcgs_params_steps(const adcgs_params *params)
{
    return !params->adaptive_steps ? 0 : params->n_fg ? 2 + params->chunks : 2;
}

uint64_t adcgs_anchor_values(const adcgs_params *params)
{
    const uint64_t own = (uint64_t)params->n_eta + params->n_fv + (uint64_t)adcgs_sigma_rows(params) + ADCGS_COLOUR_N;
    return own + (uint64_t)params->k * params->n_fg;
}

uint64_t adcgs_anchor_bytes(const adcgs_params *params)
{
    return 3 * sizeof(uint32_t) + 3 * sizeof(uint8_t) + sizeof(uint16_t) + adcgs_anchor_values(params) * sizeof(int16_t);
}

void adcgs_role_shape(const adcgs_params *params, int role, uint32_t *n_in, uint32_t *n_out)
{
    const uint32_t fv = params->n_fv, width = params->time_width;
    const uint32_t chunk = params->n_fg / params->chunks;
    uint32_t in = 0, out = 0;
    if (role == ADCGS_ROLE_ENTROPY_FV) {
        in = params->n_eta;
        out = 2 * fv;
    } else if (role == ADCGS_ROLE_ENTROPY_SIGMA) {
        in = fv;
        out = 2 * (uint32_t)adcgs_sigma_rows(params);
    } else if (role == ADCGS_ROLE_ENTROPY_COLOUR) {
        in = fv;
        out = 2 * ADCGS_COLOUR_N;
    } else if (role >= ADCGS_ROLE_ENTROPY_FG && role < ADCGS_ROLE_ENTROPY_FG + params->chunks && chunk > 0) {
        in = fv + (uint32_t)(role - ADCGS_ROLE_ENTROPY_FG) * chunk;
        out = 2 * chunk;
    } else if (role == ADCGS_ROLE_ENTROPY_STEPS && params->adaptive_steps) {
        in = fv;
        out = (uint32_t)adcgs_params_steps(params);
    } else if (role == ADCGS_ROLE_PREDICTION) {
        in = fv + (uint32_t)adcgs_slot_inputs(params) + params->n_fg;
        out = 14;
    } else if (role == ADCGS_ROLE_COARSE && params->time_rows > 0) {
        in = fv + width;
        out = params->coarse_rotation ? 12 : 9;
    } else if (role == ADCGS_ROLE_FINE && params->time_rows > 0) {
        in = 6U * params->octaves + (params->fine_uses_fv ? fv : 0) + width;
        out = 4U * params->k;
    } else if (role == ADCGS_ROLE_TIME && params->time_rows > 0) {
        in = width + adcgs_pose_columns(params);
        out = params->time_rows;
    }
    *n_in = in;
    *n_out = out;
}

static void clear_tensor(adcgs_tensor *t, adcgs_memory *memory)
{
    adcgs_free(memory, t->m);
    t->m = NULL;
}

void adcgs_net_release(adcgs_net *net, adcgs_memory *memory)
{
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++) {
        clear_tensor(&net->layer[i].w, memory);
        clear_tensor(&net->layer[i].b, memory);
    }
    memset(net, 0, sizeof *net);
}

static adcgs_status copy_tensor(adcgs_tensor *dst, const adcgs_tensor *src, adcgs_memory *memory, adcgs_error *error)
{
    const size_t n = (size_t)src->rows * src->cols;
    *dst = *src;
    dst->m = adcgs_alloc(memory, n, sizeof *dst->m, error);
    if (!dst->m)
        return adcgs_alloc_status(error);
    if (n > 0)
        memcpy(dst->m, src->m, n * sizeof *dst->m);
    return ADCGS_OK;
}

adcgs_status adcgs_net_copy(adcgs_net *dst, const adcgs_net *src, adcgs_memory *memory, adcgs_error *error)
{
    *dst = *src;
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++)
        dst->layer[i].w.m = dst->layer[i].b.m = NULL;
    for (int i = 0; i < src->n_layers; i++) {
        ADCGS_TRY(copy_tensor(&dst->layer[i].w, &src->layer[i].w, memory, error));
        ADCGS_TRY(copy_tensor(&dst->layer[i].b, &src->layer[i].b, memory, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_nets_copy(adcgs_model *dst, const adcgs_model *src, adcgs_memory *memory, adcgs_error *error)
{
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (src->net[role].present)
            ADCGS_TRY(adcgs_net_copy(&dst->net[role], &src->net[role], memory, error));
    return ADCGS_OK;
}

adcgs_status adcgs_model_alloc(adcgs_model *model, adcgs_memory *memory, adcgs_error *error)
{
    const adcgs_params *p = &model->params;
    const size_t n = model->n, value = sizeof(int16_t);
    model->pos = adcgs_alloc(memory, n, 3 * sizeof *model->pos, error);
    model->is_static = model->pos ? adcgs_alloc(memory, n, sizeof *model->is_static, error) : NULL;
    model->body = model->is_static ? adcgs_alloc(memory, n, sizeof *model->body, error) : NULL;
    model->mask = model->body ? adcgs_alloc(memory, n, sizeof *model->mask, error) : NULL;
    model->tier = model->mask ? adcgs_alloc(memory, n, sizeof *model->tier, error) : NULL;
    model->eta = model->tier ? adcgs_alloc(memory, n, p->n_eta * value, error) : NULL;
    model->fv = model->eta ? adcgs_alloc(memory, n, p->n_fv * value, error) : NULL;
    model->sigma = model->fv ? adcgs_alloc(memory, n, (size_t)adcgs_sigma_rows(p) * value, error) : NULL;
    model->colour = model->sigma ? adcgs_alloc(memory, n, ADCGS_COLOUR_N * value, error) : NULL;
    model->fg = model->colour ? adcgs_alloc(memory, n, (size_t)p->k * p->n_fg * value, error) : NULL;
    return model->fg ? ADCGS_OK : adcgs_alloc_status(error);
}

/** Copy the anchors' arrays; dst has them allocated. */
static void copy_arrays(adcgs_model *dst, const adcgs_model *src)
{
    const adcgs_params *p = &src->params;
    const size_t n = src->n, value = sizeof(int16_t);
    const struct {
        void *to;
        const void *from;
        size_t bytes;
    } arrays[] = {
        {dst->pos, src->pos, 3 * sizeof *src->pos},
        {dst->is_static, src->is_static, sizeof *src->is_static},
        {dst->body, src->body, sizeof *src->body},
        {dst->mask, src->mask, sizeof *src->mask},
        {dst->tier, src->tier, sizeof *src->tier},
        {dst->eta, src->eta, p->n_eta * value},
        {dst->fv, src->fv, p->n_fv * value},
        {dst->sigma, src->sigma, (size_t)adcgs_sigma_rows(p) * value},
        {dst->colour, src->colour, ADCGS_COLOUR_N * value},
        {dst->fg, src->fg, (size_t)p->k * p->n_fg * value},
    };
    for (size_t i = 0; n && i < ADCGS_COUNTOF(arrays); i++)
        memcpy(arrays[i].to, arrays[i].from, n * arrays[i].bytes);
}

adcgs_status adcgs_model_copy(adcgs_model *dst, const adcgs_model *src, adcgs_memory *memory, adcgs_error *error)
{
    *dst = *src;
    dst->pos = NULL;
    dst->is_static = dst->body = dst->tier = NULL;
    dst->mask = NULL;
    dst->eta = dst->fv = dst->sigma = dst->colour = dst->fg = NULL;
    memset(dst->net, 0, sizeof dst->net);
    ADCGS_TRY(adcgs_model_alloc(dst, memory, error));
    copy_arrays(dst, src);
    return adcgs_nets_copy(dst, src, memory, error);
}

void adcgs_model_clear(adcgs_model *model, adcgs_memory *memory)
{
    adcgs_free(memory, model->pos);
    adcgs_free(memory, model->is_static);
    adcgs_free(memory, model->body);
    adcgs_free(memory, model->mask);
    adcgs_free(memory, model->tier);
    adcgs_free(memory, model->eta);
    adcgs_free(memory, model->fv);
    adcgs_free(memory, model->sigma);
    adcgs_free(memory, model->colour);
    adcgs_free(memory, model->fg);
    for (int role = 0; role < ADCGS_ROLES; role++)
        adcgs_net_release(&model->net[role], memory);
    memset(model, 0, sizeof *model);
}
