/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tiers, the sets of a model's anchors: extracting a tier, joining tiers, leaving out the finest. */
#include "geom/geom.h"
#include "model/model_priv.h"

uint64_t adcgs_anchor_place(const adcgs_model *model, uint32_t anchor)
{
    return adcgs_morton(model->pos + 3 * (size_t)anchor);
}

/** Copy one anchor's row of an array; `values` is its number of values per anchor. */
#define COPY(array, values) \
    memcpy(to->array + (size_t)i * (values), from->array + (size_t)j * (values), (values) * sizeof *to->array)

void adcgs_anchor_copy(adcgs_model *to, uint32_t i, const adcgs_model *from, uint32_t j)
{
    const adcgs_params *p = &to->params;
    COPY(pos, (size_t)3);
    COPY(is_static, (size_t)1);
    COPY(body, (size_t)1);
    COPY(mask, (size_t)1);
    COPY(tier, (size_t)1);
    COPY(eta, (size_t)p->n_eta);
    COPY(fv, (size_t)p->n_fv);
    COPY(sigma, (size_t)adcgs_sigma_rows(p));
    COPY(colour, (size_t)ADCGS_COLOUR_N);
    COPY(fg, (size_t)p->k * p->n_fg);
}

adcgs_model adcgs_model_frame(const adcgs_model *model)
{
    adcgs_model m = *model;
    m.pos = NULL;
    m.is_static = m.body = m.tier = NULL;
    m.mask = NULL;
    m.eta = m.fv = m.sigma = m.colour = m.fg = NULL;
    memset(m.net, 0, sizeof m.net);
    return m;
}

/** The anchors of tiers first .. last, with the model's networks. */
static adcgs_status copy_tiers(adcgs_model *dst, const adcgs_model *src, int first, int last, adcgs_memory *memory,
                               adcgs_error *error)
{
    *dst = adcgs_model_frame(src);
    dst->n = 0;
    for (uint32_t i = 0; i < src->n; i++)
        dst->n += src->tier[i] >= first && src->tier[i] <= last;
    ADCGS_TRY(adcgs_model_alloc(dst, memory, error));
    for (uint32_t i = 0, n = 0; i < src->n; i++)
        if (src->tier[i] >= first && src->tier[i] <= last)
            adcgs_anchor_copy(dst, n++, src, i);
    return adcgs_nets_copy(dst, src, memory, error);
}

adcgs_status adcgs_model_tier(adcgs_model *dst, const adcgs_model *src, int tier, adcgs_memory *memory, adcgs_error *error)
{
    return copy_tiers(dst, src, tier, tier, memory, error);
}

adcgs_status adcgs_model_coarser(adcgs_model *dst, const adcgs_model *src, int tiers, adcgs_memory *memory, adcgs_error *error)
{
    const adcgs_status status = copy_tiers(dst, src, 0, tiers - 1, memory, error);
    dst->absent = (uint8_t)(src->finest + 1 - tiers);
    return status;
}

adcgs_status adcgs_tiers_check(const adcgs_model *coarser, const adcgs_model *added, adcgs_error *error)
{
    for (uint32_t i = 0, j = 0; i < coarser->n; i++) {
        while (j < added->n && adcgs_anchor_place(added, j) < adcgs_anchor_place(coarser, i))
            j++;
        if (j < added->n && adcgs_anchor_place(added, j) == adcgs_anchor_place(coarser, i))
            return adcgs_fail(error, ADCGS_ERR_DATA, "GEOM: anchor %u has the position of another one (earlier tier or kept)", j);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_tiers_join(const adcgs_model *coarser, adcgs_model *model, adcgs_memory *memory, adcgs_error *error)
{
    adcgs_model all = adcgs_model_frame(model);
    all.n = coarser->n + model->n;
    all.layers = ADCGS_MIN(coarser->layers, model->layers);
    const adcgs_status status = adcgs_model_alloc(&all, memory, error);
    if (status != ADCGS_OK) {
        adcgs_model_clear(&all, memory);
        return status;
    }
    for (uint32_t i = 0, j = 0; i + j < all.n;) {
        const int first = j == model->n || (i < coarser->n && adcgs_anchor_place(coarser, i) < adcgs_anchor_place(model, j));
        adcgs_anchor_copy(&all, i + j, first ? coarser : model, first ? i : j);
        i += (uint32_t)first;
        j += (uint32_t)!first;
    }
    memcpy(all.net, model->net, sizeof all.net);
    memset(model->net, 0, sizeof model->net);
    adcgs_model_clear(model, memory);
    *model = all;
    return ADCGS_OK;
}
