/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The order of the latents and their contexts (spec clause "Latent chain").
 * All decoding, encoding, quantising and concealing goes through the two walks
 * here, so the order is defined once.
 */
#include "model/latents.h"
#include "model/latents_priv.h"
#include "model/model_priv.h"

#define INPUTS_MAX (ADCGS_NV_MAX + ADCGS_NG_MAX)
#define BODY_BITS 4 /* for values 0..ADCGS_BODIES_MAX */
#define BODY_TREE (1 << BODY_BITS)
#define ROOM_ALIGNMENT 64
/* Memory for inputs, means and scales of a walk, before the networks' activations. */
#define ROOM_VALUES (((INPUTS_MAX + ADCGS_NV_MAX) * sizeof(int16_t) + ADCGS_NV_MAX) * ADCGS_LANES)

struct adcgs_latents {
    adcgs_memory *memory;
    adcgs_e24 *net[ADCGS_ROLE_PREDICTION]; /**< by role; NULL where the parameters have none */
    size_t scratch;                        /**< bytes that the largest of them needs */
};

/** State of one walk: position and working memory, 64 anchors wide. */
typedef struct walker {
    const adcgs_latents *latents;
    adcgs_model *model;
    adcgs_latent_visit visit;
    void *user;
    uint32_t begin; /**< first anchor of the group */
    int n;          /**< anchors in it, 1..64 */
    int16_t (*x)[ADCGS_LANES];
    int16_t (*mu)[ADCGS_LANES];
    uint8_t (*si)[ADCGS_LANES];
    void *scratch;
} walker;

adcgs_status adcgs_latents_create(adcgs_latents **out, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_memory *memory,
                                  adcgs_error *error)
{
    adcgs_latents *l = adcgs_alloc(memory, 1, sizeof *l, error);
    *out = l;
    if (!l)
        return adcgs_alloc_status(error);
    l->memory = memory;
    for (int role = 0; role < ADCGS_ROLE_PREDICTION; role++) {
        if (!adcgs_role_required(&model->params, role))
            continue;
        const adcgs_status status = adcgs_e24_create(&l->net[role], &model->net[role], cpu, memory, error);
        if (status != ADCGS_OK) {
            adcgs_latents_free(out);
            return status;
        }
        const size_t scratch = adcgs_e24_scratch(l->net[role]);
        l->scratch = ADCGS_MAX(l->scratch, scratch);
    }
    return ADCGS_OK;
}

void adcgs_latents_free(adcgs_latents **latents)
{
    adcgs_latents *l = *latents;
    if (!l)
        return;
    for (int role = 0; role < ADCGS_ROLE_PREDICTION; role++)
        adcgs_e24_free(&l->net[role], l->memory);
    adcgs_free(l->memory, l);
    *latents = NULL;
}

/**
 * Copy channels [0,count) of rows that are stride apart into feature-major inputs. Lanes past the end of the group are never
 * used.
 */
static void gather(int16_t (*x)[ADCGS_LANES], const int16_t *rows, size_t stride, int n, int count)
{
    for (int j = 0; j < n; j++)
        for (int c = 0; c < count; c++)
            x[c][j] = rows[(size_t)j * stride + (size_t)c];
}

/** Pass the group's anchors to the visitor. rows: first value of the first anchor; k < 0: values that every anchor has. */
static void visit_group(const walker *w, int group, int k, int first, int count, int16_t *rows, size_t stride)
{
    int16_t mu[ADCGS_NV_MAX];
    uint8_t si[ADCGS_NV_MAX];
    adcgs_latent_site site = {.k = k, .group = group, .first = first, .count = count, .mu = mu, .si = si};
    for (int j = 0; j < w->n; j++) {
        site.anchor = w->begin + (uint32_t)j;
        site.yq = rows + (size_t)j * stride;
        if (k >= 0 && !(w->model->mask[site.anchor] >> k & 1)) {
            memset(site.yq, 0, (size_t)count * sizeof *site.yq);
            continue;
        }
        if (group == ADCGS_GROUP_SIGMA) {
            site.count = adcgs_sigma_coded(w->model, site.anchor);
            memset(site.yq + site.count, 0, (size_t)(count - site.count) * sizeof *site.yq);
        }
        for (int c = 0; c < site.count; c++) {
            mu[c] = w->mu[c][j];
            si[c] = w->si[c][j];
        }
        w->visit(w->user, &site);
    }
}

static void predict(const walker *w, int role)
{
    adcgs_e24_eval(w->latents->net[role], w->x[0], w->mu[0], w->si[0], w->scratch);
}

static void walk_base(const walker *w)
{
    adcgs_model *m = w->model;
    const int n_eta = m->params.n_eta, n_fv = m->params.n_fv, n_sigma = adcgs_sigma_rows(&m->params);
    int16_t *eta = m->eta + (size_t)w->begin * (size_t)n_eta;
    int16_t *fv = m->fv + (size_t)w->begin * (size_t)n_fv;
    for (int c = 0; c < n_eta; c++)
        for (int j = 0; j < w->n; j++) {
            w->mu[c][j] = m->eta_mu[c];
            w->si[c][j] = m->eta_si[c];
        }
    if (n_eta > 0)
        visit_group(w, ADCGS_GROUP_ETA, -1, 0, n_eta, eta, (size_t)n_eta);
    gather(w->x, eta, (size_t)n_eta, w->n, n_eta);
    predict(w, ADCGS_ROLE_ENTROPY_FV);
    visit_group(w, ADCGS_GROUP_FV, -1, 0, n_fv, fv, (size_t)n_fv);

    gather(w->x, fv, (size_t)n_fv, w->n, n_fv);
    predict(w, ADCGS_ROLE_ENTROPY_SIGMA);
    visit_group(w, ADCGS_GROUP_SIGMA, -1, 0, n_sigma, m->sigma + (size_t)w->begin * (size_t)n_sigma, (size_t)n_sigma);
    predict(w, ADCGS_ROLE_ENTROPY_COLOUR);
    visit_group(w, ADCGS_GROUP_COLOUR, -1, 0, ADCGS_COLOUR_N, m->colour + (size_t)w->begin * ADCGS_COLOUR_N, ADCGS_COLOUR_N);
}

static int any_exists(const walker *w, int k)
{
    for (int j = 0; j < w->n; j++)
        if (w->model->mask[w->begin + (uint32_t)j] >> k & 1)
            return 1;
    return 0;
}

static void walk_chunk(const walker *w, int chunk)
{
    adcgs_model *m = w->model;
    const int n_fv = m->params.n_fv, count = m->params.n_fg / m->params.chunks, before = chunk * count;
    const size_t stride = (size_t)m->params.k * m->params.n_fg;
    gather(w->x, m->fv + (size_t)w->begin * (size_t)n_fv, (size_t)n_fv, w->n, n_fv);
    for (int k = 0; k < m->params.k; k++) {
        int16_t *fg = m->fg + (size_t)w->begin * stride + (size_t)k * m->params.n_fg;
        gather(w->x + n_fv, fg, stride, w->n, before);
        if (any_exists(w, k))
            predict(w, ADCGS_ROLE_ENTROPY_FG + chunk);
        visit_group(w, ADCGS_GROUP_FG + chunk, k, before, count, fg + before, stride);
    }
}

size_t adcgs_latents_room(const adcgs_latents *latents)
{
    return ROOM_VALUES + (latents->scratch + ROOM_ALIGNMENT - 1) / ROOM_ALIGNMENT * ROOM_ALIGNMENT;
}

void adcgs_latents_walk_in(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                           adcgs_latent_visit visit, void *user, void *room)
{
    walker w = {latents, model, visit, user, 0, 0, NULL, NULL, NULL, NULL};
    w.x = room;
    w.mu = w.x + INPUTS_MAX;
    w.si = (uint8_t(*)[ADCGS_LANES])(w.mu + ADCGS_NV_MAX);
    w.scratch = (uint8_t *)room + ROOM_VALUES;
    for (w.begin = begin; w.begin < end; w.begin += ADCGS_LANES) {
        w.n = (int)ADCGS_MIN(end - w.begin, (uint32_t)ADCGS_LANES);
        if (layer == 0)
            walk_base(&w);
        else
            walk_chunk(&w, layer - 1);
    }
}

adcgs_status adcgs_latents_walk(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                adcgs_latent_visit visit, void *user, adcgs_error *error)
{
    void *room = adcgs_alloc(NULL, 1, adcgs_latents_room(latents), error);
    if (!room)
        return adcgs_alloc_status(error);
    adcgs_latents_walk_in(latents, model, layer, begin, end, visit, user, room);
    adcgs_free(NULL, room);
    return ADCGS_OK;
}

/* Contexts for the bodies of a slice, and the last body coded. */
typedef struct body_coder {
    adcgs_adaptive same[2], tree[BODY_TREE];
    int last;
} body_coder;

/* Code the body of an anchor that is not static: the last body, or another one. */
static adcgs_status code_body(body_coder *b, adcgs_model *model, uint32_t anchor, adcgs_flag_fn code, void *user,
                              adcgs_error *error)
{
    const int bodies = model->params.bodies, last = b->last, body = model->body[anchor];
    if (!code(user, &b->same[last > 0], body == last)) {
        int node = 1;
        for (int value = BODY_TREE + body, bit = BODY_BITS - 1; bit >= 0; bit--)
            node = 2 * node + code(user, &b->tree[node], value >> bit & 1);
        b->last = node - BODY_TREE;
        if (b->last > bodies || b->last == last)
            return adcgs_fail(error, ADCGS_ERR_DATA, "body of anchor %u is %d, expected 0..%d, but not %d", anchor, b->last,
                              bodies, last);
    }
    model->body[anchor] = (uint8_t)b->last;
    return ADCGS_OK;
}

adcgs_status adcgs_latents_flags(adcgs_model *model, uint32_t begin, uint32_t end, adcgs_flag_fn code, void *user,
                                 adcgs_error *error)
{
    adcgs_adaptive static_context[2], mask_context[4];
    body_coder bodies = {.last = 0};
    const int n_k = model->params.k, moves = model->params.time_rows > 0;
    int previous_static = 0;
    uint32_t previous_mask = (1U << n_k) - 1;
    adcgs_adaptive_init(static_context, ADCGS_COUNTOF(static_context));
    adcgs_adaptive_init(bodies.same, ADCGS_COUNTOF(bodies.same));
    adcgs_adaptive_init(bodies.tree, ADCGS_COUNTOF(bodies.tree));
    adcgs_adaptive_init(mask_context, ADCGS_COUNTOF(mask_context));
    for (uint32_t i = begin; i < end; i++) {
        if (moves)
            previous_static = code(user, &static_context[previous_static], model->is_static[i]);
        model->is_static[i] = (uint8_t)previous_static;
        if (model->params.bodies && !previous_static)
            ADCGS_TRY(code_body(&bodies, model, i, code, user, error));
        else
            model->body[i] = 0;
        uint32_t mask = 0, left = 1;
        for (int k = 0; k < n_k; k++) {
            left = (uint32_t)code(user, &mask_context[2 * (previous_mask >> k & 1) + left], model->mask[i] >> k & 1);
            mask |= left << k;
        }
        model->mask[i] = (uint16_t)mask;
        previous_mask = mask;
    }
    return ADCGS_OK;
}
