/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Random valid models for tests, and models that are predicted from another. */
#include "random_model.h"

#include "base/cpu_detect.h"
#include "geom/geom.h"
#include "model/inter_priv.h"
#include "model/model_priv.h"

uint64_t adcgs_random_next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

int64_t adcgs_random_range(uint64_t *state, int64_t lo, int64_t hi)
{
    return lo + (int64_t)(adcgs_random_next(state) % (uint64_t)(hi - lo + 1));
}

static int draw(uint64_t *state, int lo, int hi)
{
    return (int)adcgs_random_range(state, lo, hi);
}

void adcgs_random_params(adcgs_params *p, int moving, uint64_t *state)
{
    memset(p, 0, sizeof *p);
    p->k = (uint8_t)draw(state, 1, ADCGS_K_MAX);
    p->n_fv = (uint8_t)draw(state, 1, 40);
    p->chunks = (uint8_t)draw(state, 1, ADCGS_CHUNKS_MAX);
    p->n_fg = (uint8_t)(p->chunks * draw(state, 0, 4));
    p->n_eta = (uint8_t)draw(state, 0, ADCGS_ETA_MAX);
    p->octaves = (uint8_t)draw(state, 0, ADCGS_OCTAVES_MAX);
    p->fine_uses_fv = (uint8_t)draw(state, 0, 1);
    p->coarse_rotation = (uint8_t)draw(state, 0, 1);
    p->adaptive_steps = (uint8_t)draw(state, 0, 1);
    p->time_rows = (uint16_t)(moving ? draw(state, 1, 12) : 0);
    p->time_width = (uint16_t)(moving ? draw(state, 1, 9) : 0);
    p->spans = (uint8_t)(moving ? *state >> 33 & 1 : 0);
    p->bodies = (uint8_t)(moving && *state >> 34 & 1 ? 1 + (*state >> 35) % ADCGS_BODIES_MAX : 0);
    p->smooth_time = (uint8_t)(moving ? *state >> 40 & 1 : 0);
}

/** Magnitudes stay small enough for the E24 row bound with 96 inputs and for finite binary32 networks of 4 layers. */
static adcgs_status fill_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols, int limit, int e, int mode, uint64_t *state,
                                adcgs_error *error)
{
    *t = (adcgs_tensor){.rows = rows, .cols = cols, .mode = (uint8_t)mode, .e = (uint8_t)e};
    t->m = adcgs_alloc(NULL, (size_t)rows * cols, sizeof *t->m, error);
    if (!t->m)
        return ADCGS_ERR_MEMORY;
    for (size_t i = 0; i < (size_t)rows * cols; i++) {
        const int32_t v = draw(state, 0, 2) ? draw(state, -limit, limit) : 0;
        t->m[i] = mode ? (int32_t)adcgs_float_bits((float)v * 0x1.357p-9f) : v;
    }
    return ADCGS_OK;
}

static adcgs_status random_net(adcgs_net *net, const adcgs_params *params, int role, uint64_t *state, adcgs_error *error)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(params, role, &n_in, &n_out);
    const int e24 = role < ADCGS_ROLE_PREDICTION, prior = adcgs_role_is_prior(role), table = role == ADCGS_ROLE_TIME;
    const int limit = e24 ? 60 : 400;
    *net = (adcgs_net){.present = 1, .role = (uint8_t)role};
    net->n_layers = (uint8_t)(table || n_in == 0 ? 1 : draw(state, 1, 3));
    net->in_shift = (uint8_t)(e24 ? draw(state, 0, 3) : 0);
    net->sigma_shift = (uint8_t)(prior ? draw(state, 6, 9) : 0);
    net->sigma_offset = (int16_t)(prior ? draw(state, 0, 40) : 0);
    for (int i = 0; i < net->n_layers; i++) {
        adcgs_layer *l = &net->layer[i];
        const int last = i == net->n_layers - 1;
        l->residual = (uint8_t)(!last && i > 0 && draw(state, 0, 1));
        const uint32_t rows = last ? n_out : l->residual ? n_in : (uint32_t)draw(state, 1, 24);
        l->shift = (uint8_t)(!e24 ? 0 : prior || !last ? draw(state, 5, 9) : draw(state, 9, 15));
        ADCGS_TRY(fill_tensor(&l->w, rows, n_in, limit, e24 ? 0 : 9, e24 ? 0 : draw(state, 0, 3) == 0, state, error));
        if (!table)
            ADCGS_TRY(fill_tensor(&l->b, rows, 1, e24 ? 20000 : limit, e24 ? 0 : 9, 0, state, error));
        n_in = rows;
    }
    return ADCGS_OK;
}

static adcgs_status random_positions(adcgs_model *m, uint64_t *state, adcgs_error *error)
{
    const uint32_t side = 1U << m->depth;
    const uint64_t cells = (uint64_t)side * side * side, stride = cells / m->n;
    for (uint32_t i = 0; i < m->n; i++) { /* distinct: one cell out of each run of stride */
        const uint64_t cell = i * stride + adcgs_random_next(state) % stride;
        m->pos[3 * i] = (uint32_t)(cell % side);
        m->pos[3 * i + 1] = (uint32_t)(cell / side % side);
        m->pos[3 * i + 2] = (uint32_t)(cell / side / side);
    }
    if (!adcgs_morton_sort(m->pos, m->n, NULL, error))
        return ADCGS_OK;
    return ADCGS_ERR_INTERNAL;
}

static void random_steps(float *d, int n, uint64_t *state)
{
    const int form = draw(state, 0, 3);
    for (int i = 0; i < n; i++) {
        const uint32_t bits = adcgs_float_bits(0x1p-7f) + (uint32_t)draw(state, 0, 0xffffff);
        d[i] = form & 1 && i > 0 ? d[0] : adcgs_bits_float(form & 2 ? bits & 0xffff0000 : bits);
    }
}

static void random_tables(adcgs_model *m, uint64_t *state)
{
    random_steps(m->d_fv, m->params.n_fv, state);
    random_steps(m->d_sigma, adcgs_sigma_rows(&m->params), state);
    random_steps(m->d_colour, ADCGS_COLOUR_N, state);
    random_steps(m->d_fg, m->params.n_fg, state);
    for (int i = 0; i < m->params.n_eta; i++) {
        m->eta_mu[i] = (int16_t)draw(state, -400, 400);
        m->eta_si[i] = (uint8_t)draw(state, 0, ADCGS_SIGMA_LEVELS - 1);
    }
    m->voxel = 2.0f / (float)(1U << m->depth);
    for (int a = 0; a < 3; a++)
        m->origin[a] = -1.0f + (float)draw(state, -9, 9) * 0x1p-5f;
}

/** Mostly small numbers, occasionally one far out in the escape codes or past the clip. */
static void draw_site(void *user, const adcgs_latent_site *site)
{
    uint64_t *state = user;
    for (int c = 0; c < site->count; c++) {
        int32_t n = 0;
        if (site->si[c] > 0) {
            const int spread = 1 + site->si[c] / 8, far = adcgs_value_max(site->si[c]);
            n = draw(state, 0, 199) ? draw(state, -spread, spread) : draw(state, -ADCGS_MIN(far, 700), ADCGS_MIN(far, 700));
        }
        site->yq[c] = (int16_t)adcgs_clip(64 * n + site->mu[c], 32767);
    }
}

adcgs_status adcgs_random_values(adcgs_model *m, uint64_t *state, adcgs_error *error)
{
    adcgs_latents *latents = NULL;
    adcgs_cpu_level cpu;
    adcgs_status status = adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, error);
    if (status == ADCGS_OK)
        status = adcgs_latents_create(&latents, m, cpu, NULL, error);
    for (int layer = 0; layer < adcgs_params_layers(&m->params) && status == ADCGS_OK; layer++)
        status = adcgs_latents_walk(latents, m, layer, 0, m->n, draw_site, state, error);
    adcgs_latents_free(&latents);
    return status;
}

/** Runs of anchors with one body, or none. */
static void random_bodies(adcgs_model *m, uint64_t *state)
{
    int body = 0;
    for (uint32_t i = 0; m->params.bodies && i < m->n; i++) {
        if (m->is_static[i])
            continue;
        body = draw(state, 0, 2) ? body : draw(state, 0, m->params.bodies);
        m->body[i] = (uint8_t)body;
    }
}

/** Flags, masks, bodies and values of anchors whose positions are set. */
static adcgs_status random_anchors(adcgs_model *m, uint64_t *state, adcgs_error *error)
{
    for (uint32_t i = 0; i < m->n; i++) {
        m->is_static[i] = (uint8_t)(m->params.time_rows > 0 && draw(state, 0, 1));
        m->mask[i] = (uint16_t)((adcgs_random_next(state) | adcgs_random_next(state)) & ((1U << m->params.k) - 1));
    }
    random_bodies(m, state);
    return adcgs_random_values(m, state, error);
}

/** One to three tiers, each with anchors. */
static void random_tiers(adcgs_model *m, uint64_t *state)
{
    m->finest = (uint8_t)draw(state, 0, (int)ADCGS_MIN(m->n - 1, 2U));
    for (int t = 0; t < m->finest; t++)
        m->growth[t] = (uint8_t)draw(state, 0, ADCGS_GROWTH_MAX);
    for (uint32_t i = 0; i < m->n; i++)
        m->tier[i] = (uint8_t)(i <= m->finest ? (int)i : draw(state, 0, m->finest));
}

void adcgs_random_small_params(adcgs_params *params, int n_fg, uint64_t *state)
{
    adcgs_random_params(params, 1, state);
    params->k = 2;
    params->n_fv = 3;
    params->chunks = 2;
    params->n_fg = (uint8_t)n_fg;
}

void adcgs_random_one_tier(adcgs_model *m)
{
    m->finest = 0;
    memset(m->tier, 0, m->n);
}

adcgs_status adcgs_random_model(adcgs_model *m, const adcgs_params *params, uint32_t n, int depth, uint64_t *state,
                                adcgs_error *error)
{
    memset(m, 0, sizeof *m);
    m->params = *params;
    m->n = n;
    m->depth = (uint8_t)depth;
    m->time_end = 1;
    m->layers = (uint8_t)adcgs_params_layers(params);
    random_tables(m, state);
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const int optional = adcgs_role_allowed(params, role) && !adcgs_role_required(params, role);
        if (adcgs_role_required(params, role) || (optional && draw(state, 0, 3)))
            ADCGS_TRY(random_net(&m->net[role], params, role, state, error));
    }
    ADCGS_TRY(adcgs_model_alloc(m, NULL, error));
    ADCGS_TRY(random_positions(m, state, error));
    random_tiers(m, state);
    return random_anchors(m, state, error);
}

adcgs_model adcgs_random_frame(const adcgs_model *before)
{
    adcgs_model m = adcgs_model_frame(before);
    m.n = 0;
    m.layers = (uint8_t)adcgs_params_layers(&m.params);
    m.predicted = 1;
    return m;
}

static int at_place(const adcgs_model *m, uint32_t anchor, uint64_t place)
{
    return adcgs_morton(m->pos + 3 * (size_t)anchor) == place;
}

/** True if one of the model's first `settled` anchors, or a predicted anchor, has this voxel. */
static int is_taken(const adcgs_model *m, uint32_t settled, const adcgs_inter *kept, const adcgs_model *before,
                    const uint32_t voxel[3])
{
    const uint64_t place = adcgs_morton(voxel);
    int taken = 0;
    for (uint32_t i = 0; i < settled && !taken; i++)
        taken = at_place(m, i, place);
    for (uint32_t i = 0; i < before->n && !taken; i++)
        taken = kept->mode[i] != ADCGS_INTER_DROPPED && at_place(before, i, place);
    return taken;
}

adcgs_status adcgs_random_settle(adcgs_model *m, const adcgs_inter *kept, const adcgs_model *before, adcgs_error *error)
{
    const uint32_t side = 1U << m->depth;
    if ((uint64_t)m->n + kept->n > UINT64_C(1) << 3 * m->depth)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%u new anchors do not fit next to %u predicted ones", m->n, kept->n);
    for (uint32_t i = 0; i < m->n; i++) {
        uint32_t *const voxel = m->pos + 3 * (size_t)i;
        while (is_taken(m, i, kept, before, voxel))
            for (int a = 0; a < 3 && (voxel[a] = (voxel[a] + 1) % side) == 0; a++)
                ;
    }
    return adcgs_morton_sort(m->pos, m->n, NULL, error) ? ADCGS_ERR_INTERNAL : ADCGS_OK;
}

/** A change by whole steps: mostly few, occasionally so many that they need an escape or meet the clip. */
static int32_t random_steps_of(int16_t before, uint64_t *state)
{
    const int kind = draw(state, 0, 99);
    const int32_t most = kind < 60 ? 0 : kind < 90 ? 3 : kind < 97 ? 100 : 1100;
    return adcgs_clip(before + 64 * draw(state, -most, most), 32767);
}

static void random_modes(adcgs_inter *kept, const adcgs_model *before, uint64_t *state)
{
    const int dropped_most = draw(state, 0, 99); /* hundredths */
    for (uint32_t i = 0; i < before->n; i++) {
        kept->mode[i] = (uint8_t)(draw(state, 0, 99) < dropped_most ? ADCGS_INTER_DROPPED
                                  : draw(state, 0, 1)               ? ADCGS_INTER_SAME
                                                                    : ADCGS_INTER_REFINED);
        kept->n += kept->mode[i] != ADCGS_INTER_DROPPED;
        for (int g = 0; kept->mode[i] == ADCGS_INTER_REFINED && g < ADCGS_INTER_GROUPS; g++) {
            const int n = adcgs_inter_channels(&before->params, g);
            const int coded = g == ADCGS_INTER_SIGMA && before->is_static[i] ? ADCGS_SIGMA_N : n;
            int16_t *const row = kept->rows[g] + (size_t)i * (size_t)n;
            for (int c = 0; draw(state, 0, 3) && c < coded; c++)
                row[c] = (int16_t)random_steps_of(row[c], state);
        }
    }
}

/** The networks of the model before; each role is occasionally replaced, or added where absent. */
static adcgs_status random_networks(adcgs_model *m, const adcgs_model *before, uint64_t *state, adcgs_error *error)
{
    for (int role = 0; role < ADCGS_ROLES; role++) {
        if (adcgs_role_allowed(&m->params, role) && draw(state, 0, 7) == 0)
            ADCGS_TRY(random_net(&m->net[role], &m->params, role, state, error));
        else if (before->net[role].present)
            ADCGS_TRY(adcgs_net_copy(&m->net[role], &before->net[role], NULL, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_random_join(const adcgs_inter *kept, const adcgs_model *before, adcgs_model *m, adcgs_error *error)
{
    adcgs_model stay;
    adcgs_status status = adcgs_inter_model(&stay, kept, before, NULL, error);
    if (status == ADCGS_OK)
        status = adcgs_tiers_join(&stay, m, NULL, error);
    adcgs_model_clear(&stay, NULL);
    return status;
}

/** Makes new anchors in a frame that has its networks, then joins the predicted ones. */
static adcgs_status random_joined(adcgs_model *m, const adcgs_model *before, adcgs_inter *kept, uint32_t n, uint64_t *state,
                                  adcgs_error *error)
{
    const uint64_t cells = UINT64_C(1) << 3 * m->depth;
    ADCGS_TRY(adcgs_inter_alloc(kept, before, NULL, error));
    random_modes(kept, before, state);
    m->n = (uint32_t)ADCGS_MIN((uint64_t)draw(state, kept->n == 0, (int)n), cells - kept->n);
    ADCGS_TRY(adcgs_model_alloc(m, NULL, error));
    if (m->n > 0)
        ADCGS_TRY(random_positions(m, state, error));
    ADCGS_TRY(adcgs_random_settle(m, kept, before, error));
    ADCGS_TRY(random_anchors(m, state, error));
    return adcgs_random_join(kept, before, m, error);
}

adcgs_status adcgs_random_follower(adcgs_model *m, const adcgs_model *before, uint32_t n, uint64_t *state, adcgs_error *error)
{
    adcgs_inter kept = {.n = 0};
    *m = adcgs_random_frame(before);
    adcgs_status status = random_networks(m, before, state, error);
    if (status == ADCGS_OK)
        status = random_joined(m, before, &kept, n, state, error);
    adcgs_inter_clear(&kept, NULL);
    return status;
}
