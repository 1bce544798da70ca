/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Validation of a model before anything is derived from it: everything that
 * the later stages rely on without checking it again.
 */
#include "geom/geom.h"
#include "model/latents.h"
#include "model/model.h"
#include "model/model_priv.h"

#define FLOAT_LAYERS_MAX 4

const char *adcgs_role_name(int role)
{
    static const char *const names[ADCGS_ROLES] = {"E_fv",  "E_Sigma", "E_C",     "E_fg0",   "E_fg1",   "E_fg2",
                                                   "E_fg3", "E_q",     "F_theta", "F_omega", "F_varpi", "Z"};
    return role >= 0 && role < ADCGS_ROLES ? names[role] : "unknown";
}

int adcgs_role_allowed(const adcgs_params *params, int role)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(params, role, &n_in, &n_out);
    return n_out > 0;
}

int adcgs_role_required(const adcgs_params *params, int role)
{
    return role != ADCGS_ROLE_COARSE && role != ADCGS_ROLE_FINE && adcgs_role_allowed(params, role);
}

static adcgs_status check_range(const char *name, uint32_t value, uint32_t lo, uint32_t hi, adcgs_error *error)
{
    if (value < lo || value > hi)
        return adcgs_fail(error, ADCGS_ERR_DATA, "model: %s is %u, expected %u..%u", name, value, lo, hi);
    return ADCGS_OK;
}

adcgs_status adcgs_params_validate(const adcgs_params *p, adcgs_error *error)
{
    ADCGS_TRY(check_range("k", p->k, 1, ADCGS_K_MAX, error));
    ADCGS_TRY(check_range("n_fv", p->n_fv, 1, ADCGS_NV_MAX, error));
    ADCGS_TRY(check_range("n_fg", p->n_fg, 0, ADCGS_NG_MAX, error));
    ADCGS_TRY(check_range("chunks", p->chunks, 1, ADCGS_CHUNKS_MAX, error));
    ADCGS_TRY(check_range("n_eta", p->n_eta, 0, ADCGS_ETA_MAX, error));
    ADCGS_TRY(check_range("octaves", p->octaves, 0, ADCGS_OCTAVES_MAX, error));
    ADCGS_TRY(check_range("fine_uses_fv", p->fine_uses_fv, 0, 1, error));
    ADCGS_TRY(check_range("coarse_rotation", p->coarse_rotation, 0, 1, error));
    ADCGS_TRY(check_range("adaptive_steps", p->adaptive_steps, 0, 1, error));
    ADCGS_TRY(check_range("spans", p->spans, 0, p->time_rows > 0, error));
    ADCGS_TRY(check_range("bodies", p->bodies, 0, p->time_rows > 0 ? ADCGS_BODIES_MAX : 0, error));
    ADCGS_TRY(check_range("smooth_time", p->smooth_time, 0, p->time_rows > 0, error));
    ADCGS_TRY(check_range("time_rows", p->time_rows, 0, ADCGS_TIME_ROWS_MAX, error));
    ADCGS_TRY(check_range("time_width", p->time_width, p->time_rows > 0, ADCGS_TIME_WIDTH_MAX, error));
    if (p->n_fg % p->chunks)
        return adcgs_fail(error, ADCGS_ERR_DATA, "model: n_fg is %u, expected a multiple of chunks, %u", p->n_fg, p->chunks);
    return ADCGS_OK;
}

/** Check a weight of a binary32 network: exact in binary32, magnitude below 2^8, so that nothing downstream overflows. */
static int float_weight_ok(const adcgs_tensor *t, int32_t m)
{
    if (t->mode == 0) {
        const int64_t magnitude = m < 0 ? -(int64_t)m : m;
        return magnitude < INT64_C(1) << 24 && magnitude < INT64_C(1) << (8 + t->e);
    }
    const uint32_t exponent = (uint32_t)m >> 23 & 255;
    return exponent == 0 ? ((uint32_t)m & 0x7fffff) == 0 : exponent < 127 + 8;
}

static adcgs_status check_tensor(const adcgs_tensor *t, uint32_t rows, uint32_t cols, int role, int layer, adcgs_error *error)
{
    const char *name = adcgs_role_name(role);
    if (t->rows != rows || t->cols != cols)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: layer %d has a tensor of %ux%u, expected %ux%u", name, layer,
                          t->rows, t->cols, rows, cols);
    if (t->mode > 1 || t->e > 40)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: layer %d has tensor mode %u, exponent %u, expected 0..1, 0..40",
                          name, layer, t->mode, t->e);
    if (role < ADCGS_ROLE_PREDICTION)
        return ADCGS_OK;
    for (size_t i = 0; i < (size_t)rows * cols; i++)
        if (!float_weight_ok(t, t->m[i]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: layer %d, value %zu of a tensor is not a weight below 2^8",
                              name, layer, i);
    return ADCGS_OK;
}

static adcgs_status check_layers(int role, const adcgs_net *net, uint32_t n_in, uint32_t n_out, adcgs_error *error)
{
    const char *name = adcgs_role_name(role);
    for (int i = 0; i < net->n_layers; i++) {
        const adcgs_layer *l = &net->layer[i];
        const int last = i == net->n_layers - 1;
        const uint32_t rows = last ? n_out : l->w.rows;
        if (!last)
            ADCGS_TRY(check_range("hidden width", rows, 1, ADCGS_NET_WIDTH_MAX, error));
        ADCGS_TRY(check_tensor(&l->w, rows, n_in, role, i, error));
        if (role != ADCGS_ROLE_TIME)
            ADCGS_TRY(check_tensor(&l->b, rows, 1, role, i, error));
        if (l->residual > 1 || (l->residual && (last || (i == 0 && role >= ADCGS_ROLE_PREDICTION) || rows != n_in)))
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: layer %d cannot be residual", name, i);
        if (l->shift > 24)
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: layer %d has shift %u, expected 0..24", name, i, l->shift);
        n_in = rows;
    }
    return ADCGS_OK;
}

/** Check the E24 rules by preparing the network for evaluation, which performs these checks. */
static adcgs_status check_e24(const adcgs_net *net, adcgs_error *error)
{
    adcgs_e24 *ready = NULL;
    const adcgs_status status = adcgs_e24_create(&ready, net, ADCGS_CPU_SCALAR, NULL, error);
    adcgs_e24_free(&ready, NULL);
    return status;
}

adcgs_status adcgs_net_validate(const adcgs_params *params, int role, const adcgs_net *net, adcgs_error *error)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(params, role, &n_in, &n_out);
    if (n_out == 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: not used with these parameters", adcgs_role_name(role));
    const int layers_max = role < ADCGS_ROLE_PREDICTION ? ADCGS_NET_LAYERS_MAX : FLOAT_LAYERS_MAX;
    const int one_layer = role == ADCGS_ROLE_TIME || n_in == 0;
    if (net->role != role || net->n_layers < 1 || net->n_layers > (one_layer ? 1 : layers_max))
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: role %u with %u layers, expected role %d with 1..%d",
                          adcgs_role_name(role), net->role, net->n_layers, role, one_layer ? 1 : layers_max);
    if (net->in_shift > 8 || net->sigma_shift > 24 || net->sigma_offset < -64 || net->sigma_offset > 127)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: shifts %u, %u, offset %d, expected 0..8, 0..24, -64..127",
                          adcgs_role_name(role), net->in_shift, net->sigma_shift, net->sigma_offset);
    if (!adcgs_role_is_prior(role) && (net->sigma_shift || net->sigma_offset))
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %s: it has no scale indices, but their shift is %u, their offset %d",
                          adcgs_role_name(role), net->sigma_shift, net->sigma_offset);
    ADCGS_TRY(check_layers(role, net, n_in, n_out, error));
    return role < ADCGS_ROLE_PREDICTION ? check_e24(net, error) : ADCGS_OK;
}

static adcgs_status check_nets(const adcgs_model *model, adcgs_error *error)
{
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const adcgs_net *net = &model->net[role];
        if (net->present)
            ADCGS_TRY(adcgs_net_validate(&model->params, role, net, error));
        else if (adcgs_role_required(&model->params, role))
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %s is missing", adcgs_role_name(role));
    }
    return ADCGS_OK;
}

static adcgs_status check_steps(const char *name, const float *d, size_t n, adcgs_error *error)
{
    for (size_t i = 0; i < n; i++)
        if (!(d[i] >= 0x1p-40f && d[i] <= 0x1p10f))
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: %s[%zu] is %g, expected 2^-40..2^10", name, i, (double)d[i]);
    return ADCGS_OK;
}

static adcgs_status check_tables(const adcgs_model *m, adcgs_error *error)
{
    ADCGS_TRY(check_steps("d_fv", m->d_fv, m->params.n_fv, error));
    ADCGS_TRY(check_steps("d_sigma", m->d_sigma, adcgs_sigma_rows(&m->params), error));
    ADCGS_TRY(check_steps("d_colour", m->d_colour, ADCGS_COLOUR_N, error));
    ADCGS_TRY(check_steps("d_fg", m->d_fg, m->params.n_fg, error));
    for (int i = 0; i < m->params.n_eta; i++) {
        ADCGS_TRY(check_range("eta_si", m->eta_si[i], 0, ADCGS_SIGMA_LEVELS - 1, error));
        if (m->eta_mu[i] == INT16_MIN)
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: eta_mu[%d] is -32768, expected -32767..32767", i);
    }
    return ADCGS_OK;
}

static adcgs_status check_positions(const adcgs_model *m, adcgs_error *error)
{
    uint64_t previous = 0;
    for (uint32_t i = 0; i < m->n; i++) {
        const uint32_t *v = m->pos + 3 * (size_t)i;
        const uint64_t code = adcgs_morton(v);
        if ((v[0] | v[1] | v[2]) >> m->depth || (i > 0 && code <= previous))
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: position of anchor %u is outside the cube or not in Morton order",
                              i);
        previous = code;
    }
    return ADCGS_OK;
}

static adcgs_status check_values(const char *name, const int16_t *v, size_t n, adcgs_error *error)
{
    for (size_t i = 0; i < n; i++)
        if (v[i] == INT16_MIN)
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: %s[%zu] is -32768, expected -32767..32767", name, i);
    return ADCGS_OK;
}

/** Check that static anchors have no lifetime. */
static adcgs_status check_spans(const adcgs_model *m, adcgs_error *error)
{
    const int rows = adcgs_sigma_rows(&m->params);
    for (uint32_t i = 0; i < m->n; i++)
        for (int c = adcgs_sigma_coded(m, i); c < rows; c++)
            if (m->sigma[(size_t)i * (size_t)rows + (size_t)c] != 0)
                return adcgs_fail(error, ADCGS_ERR_DATA, "model: anchor %u is static but has a lifetime", i);
    return ADCGS_OK;
}

/** Check that the bodies exist, and that static anchors belong to none. */
static adcgs_status check_bodies(const adcgs_model *m, adcgs_error *error)
{
    for (uint32_t i = 0; i < m->n; i++)
        if (m->body[i] > m->params.bodies || (m->body[i] && m->is_static[i]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: body of anchor %u is %u, expected 0..%u, and 0 of a static one", i,
                              m->body[i], m->params.bodies);
    return ADCGS_OK;
}

/** Check that the tiers exist and that, in a model that is not predicted, each tier has anchors. */
static adcgs_status check_tiers(const adcgs_model *m, adcgs_error *error)
{
    uint32_t brings[ADCGS_TIERS_MAX] = {0};
    ADCGS_TRY(check_range("finest", m->finest, 0, ADCGS_TIERS_MAX - 1, error));
    ADCGS_TRY(check_range("absent", m->absent, 0, m->finest, error));
    for (int t = 0; t < m->finest; t++)
        ADCGS_TRY(check_range("growth", m->growth[t], 0, ADCGS_GROWTH_MAX, error));
    for (uint32_t i = 0; i < m->n; i++) {
        ADCGS_TRY(check_range("tier", m->tier[i], 0, m->finest - (uint32_t)m->absent, error));
        brings[m->tier[i]]++;
    }
    for (int t = 0; !m->predicted && t <= m->finest - m->absent; t++)
        if (!brings[t])
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: tier %d has no anchors", t);
    return ADCGS_OK;
}

/** Check flags and masks, and that primitives that do not exist hold zeros. */
static adcgs_status check_primitives(const adcgs_model *m, adcgs_error *error)
{
    const adcgs_params *p = &m->params;
    const int16_t *fg = m->fg;
    for (uint32_t i = 0; i < m->n; i++) {
        if (m->is_static[i] > (p->time_rows > 0) || m->mask[i] >> p->k)
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: anchor %u has static flag %u, mask %u, expected 0..%d, %u bits", i,
                              m->is_static[i], m->mask[i], p->time_rows > 0, p->k);
        for (int k = 0; k < p->k; k++)
            for (int c = 0; c < p->n_fg; c++, fg++)
                if (*fg != 0 && !(m->mask[i] >> k & 1))
                    return adcgs_fail(error, ADCGS_ERR_DATA, "model: primitive %d of anchor %u does not exist but has f_g", k, i);
    }
    return ADCGS_OK;
}

static adcgs_status check_frame(const adcgs_model *m, adcgs_error *error)
{
    if (m->n > ADCGS_ANCHORS_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "model: anchors is %u, the format allows %u", m->n, ADCGS_ANCHORS_MAX);
    ADCGS_TRY(check_range("anchors", m->n, 1, ADCGS_ANCHORS_MAX, error));
    ADCGS_TRY(check_range("depth", m->depth, 0, ADCGS_GEOM_DEPTH_MAX, error));
    for (int a = 0; a < 3; a++)
        if (!(m->origin[a] >= -0x1p15f && m->origin[a] <= 0x1p15f))
            return adcgs_fail(error, ADCGS_ERR_DATA, "model: origin[%d] is %g, expected -2^15..2^15", a, (double)m->origin[a]);
    if (!(m->voxel >= 0x1p-40f && m->voxel <= 0x1p10f))
        return adcgs_fail(error, ADCGS_ERR_DATA, "model: voxel is %g, expected 2^-40..2^10", (double)m->voxel);
    if (!(m->time_start <= m->time_end && m->time_start >= -0x1p60 && m->time_end <= 0x1p60))
        return adcgs_fail(error, ADCGS_ERR_DATA, "model: times %g..%g s are not a time range", m->time_start, m->time_end);
    if (!(m->reach >= 0 && m->reach <= 0x1p60))
        return adcgs_fail(error, ADCGS_ERR_DATA, "model: reach is %g s, expected a duration", m->reach);
    return ADCGS_OK;
}

adcgs_status adcgs_model_validate(const adcgs_model *model, adcgs_error *error)
{
    const adcgs_params *p = &model->params;
    const size_t n = model->n;
    ADCGS_TRY(adcgs_params_validate(p, error));
    ADCGS_TRY(check_frame(model, error));
    ADCGS_TRY(check_tables(model, error));
    ADCGS_TRY(check_nets(model, error));
    ADCGS_TRY(check_positions(model, error));
    ADCGS_TRY(check_primitives(model, error));
    ADCGS_TRY(check_spans(model, error));
    ADCGS_TRY(check_bodies(model, error));
    ADCGS_TRY(check_tiers(model, error));
    ADCGS_TRY(check_values("eta", model->eta, n * p->n_eta, error));
    ADCGS_TRY(check_values("fv", model->fv, n * p->n_fv, error));
    ADCGS_TRY(check_values("sigma", model->sigma, n * (size_t)adcgs_sigma_rows(p), error));
    ADCGS_TRY(check_values("colour", model->colour, n * ADCGS_COLOUR_N, error));
    return check_values("fg", model->fg, n * p->k * p->n_fg, error);
}
