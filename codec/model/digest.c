/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Equality and digest of models. One list of items, in the order of the spec
 * clause "Model digest", drives both. So two models are equal exactly when
 * their canonical serialisations are.
 */
#include "base/digest.h"
#include "model/model.h"
#include "model/model_priv.h"

/** Operation on each item: count elements of size bytes at a; b is the same item of the other model. */
typedef struct visitor {
    void (*item)(struct visitor *v, const char *name, const void *a, const void *b, size_t size, size_t count);
    adcgs_md5 md5;
    const char *difference; /**< name of the first item that differs */
    size_t index;           /**< element of it that differs */
} visitor;

/** Digest the elements as little-endian bytes on any machine. */
static void digest_item(visitor *v, const char *name, const void *a, const void *b, size_t size, size_t count)
{
    uint8_t block[512];
    const uint8_t *p = a;
    (void)name;
    (void)b;
    while (count > 0) {
        const size_t n = ADCGS_MIN(count, sizeof block / size);
        for (size_t i = 0; i < n; i++, p += size) {
            uint16_t u16;
            uint32_t u32;
            uint64_t u64;
            if (size == 1) {
                block[i] = *p;
            } else if (size == 2) {
                memcpy(&u16, p, 2);
                adcgs_store_le16(block + 2 * i, u16);
            } else if (size == 4) {
                memcpy(&u32, p, 4);
                adcgs_store_le32(block + 4 * i, u32);
            } else {
                memcpy(&u64, p, 8);
                adcgs_store_le64(block + 8 * i, u64);
            }
        }
        adcgs_md5_update(&v->md5, block, n * size);
        count -= n;
    }
}

static void compare_item(visitor *v, const char *name, const void *a, const void *b, size_t size, size_t count)
{
    if (v->difference || count == 0 || memcmp(a, b, size * count) == 0)
        return;
    const uint8_t *p = a, *q = b;
    v->difference = name;
    for (v->index = 0; memcmp(p, q, size) == 0; v->index++, p += size, q += size)
        ;
}

#define ITEM(name, field) v->item(v, name, &a->field, &b->field, sizeof a->field, 1)
#define LIST(name, field, n) v->item(v, name, a->field, b->field, sizeof a->field[0], n)

static void visit_params(visitor *v, const adcgs_params *a, const adcgs_params *b)
{
    ITEM("k", k);
    ITEM("n_fv", n_fv);
    ITEM("n_fg", n_fg);
    ITEM("chunks", chunks);
    ITEM("n_eta", n_eta);
    ITEM("octaves", octaves);
    ITEM("fine_uses_fv", fine_uses_fv);
    ITEM("coarse_rotation", coarse_rotation);
    ITEM("adaptive_steps", adaptive_steps);
    ITEM("spans", spans);
    ITEM("bodies", bodies);
    ITEM("smooth_time", smooth_time);
    ITEM("time_rows", time_rows);
    ITEM("time_width", time_width);
}

static void visit_tensor(visitor *v, const adcgs_tensor *a, const adcgs_tensor *b)
{
    ITEM("tensor rows", rows);
    ITEM("tensor cols", cols);
    ITEM("tensor mode", mode);
    ITEM("tensor e", e);
    LIST("tensor values", m, (size_t)a->rows * a->cols);
}

static void visit_net(visitor *v, const adcgs_net *a, const adcgs_net *b)
{
    ITEM("network present", present);
    if (!a->present)
        return;
    ITEM("network role", role);
    ITEM("network n_layers", n_layers);
    const int e24 = a->role < ADCGS_ROLE_PREDICTION;
    if (e24) {
        ITEM("network in_shift", in_shift);
    }
    if (adcgs_role_is_prior(a->role)) {
        ITEM("network sigma_shift", sigma_shift);
        ITEM("network sigma_offset", sigma_offset);
    }
    for (int i = 0; i < a->n_layers && !v->difference; i++) {
        ITEM("layer residual", layer[i].residual);
        if (e24)
            ITEM("layer shift", layer[i].shift);
        visit_tensor(v, &a->layer[i].w, &b->layer[i].w);
        if (a->role != ADCGS_ROLE_TIME)
            visit_tensor(v, &a->layer[i].b, &b->layer[i].b);
    }
}

static void visit_anchors(visitor *v, const adcgs_model *a, const adcgs_model *b)
{
    const size_t n = a->n;
    const adcgs_params *p = &a->params;
    LIST("pos", pos, 3 * n);
    LIST("is_static", is_static, n);
    LIST("body", body, n);
    LIST("mask", mask, n);
    LIST("tier", tier, n);
    LIST("eta", eta, n * p->n_eta);
    LIST("fv", fv, n * p->n_fv);
    LIST("sigma", sigma, n * (size_t)adcgs_sigma_rows(p));
    LIST("colour", colour, n * ADCGS_COLOUR_N);
    LIST("fg", fg, n * p->k * p->n_fg);
}

static void visit_model(visitor *v, const adcgs_model *a, const adcgs_model *b)
{
    visit_params(v, &a->params, &b->params);
    ITEM("time_start", time_start);
    ITEM("time_end", time_end);
    ITEM("reach", reach);
    ITEM("anchors", n);
    ITEM("depth", depth);
    LIST("origin", origin, 3);
    ITEM("voxel", voxel);
    if (v->difference) /* the arrays differ in size */
        return;
    LIST("d_fv", d_fv, a->params.n_fv);
    LIST("d_sigma", d_sigma, (size_t)adcgs_sigma_rows(&a->params));
    LIST("d_colour", d_colour, ADCGS_COLOUR_N);
    LIST("d_fg", d_fg, a->params.n_fg);
    LIST("eta_mu", eta_mu, a->params.n_eta);
    LIST("eta_si", eta_si, a->params.n_eta);
    ITEM("finest", finest);
    if (v->difference)
        return;
    LIST("growth", growth, a->finest);
    visit_anchors(v, a, b);
    for (int role = 0; role < ADCGS_ROLES && !v->difference; role++)
        visit_net(v, &a->net[role], &b->net[role]);
}

void adcgs_model_digest(const adcgs_model *model, uint8_t digest[16])
{
    visitor v = {.item = digest_item};
    adcgs_md5_init(&v.md5);
    visit_model(&v, model, model);
    adcgs_md5_final(&v.md5, digest);
}

int adcgs_model_equal(const adcgs_model *a, const adcgs_model *b, adcgs_error *error)
{
    visitor v = {.item = compare_item};
    visit_model(&v, a, b);
    if (!v.difference)
        return 1;
    adcgs_fail(error, ADCGS_ERR_DATA, "models differ in %s[%zu]", v.difference, v.index);
    return 0;
}

int adcgs_params_equal(const adcgs_params *a, const adcgs_params *b)
{
    visitor v = {.item = compare_item};
    visit_params(&v, a, b);
    return v.difference == NULL;
}

int adcgs_net_equal(const adcgs_net *a, const adcgs_net *b)
{
    visitor v = {.item = compare_item};
    visit_net(&v, a, b);
    return v.difference == NULL;
}
