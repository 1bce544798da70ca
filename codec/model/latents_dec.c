/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decoding a slice of a layer, and concealing an absent one. */
#include "model/latents.h"
#include "model/latents_priv.h"

typedef struct decoder {
    adcgs_range_dec *range;
} decoder;

static int decode_flag(void *user, adcgs_adaptive *context, int bit)
{
    decoder *d = user;
    (void)bit;
    return adcgs_adaptive_dec(d->range, context);
}

static void decode_site(void *user, const adcgs_latent_site *site)
{
    decoder *d = user;
    for (int c = 0; c < site->count; c++) {
        const int32_t n = site->si[c] > 0 ? adcgs_value_dec(d->range, site->si[c]) : 0;
        site->yq[c] = (int16_t)adcgs_clip(64 * n + site->mu[c], 32767);
    }
}

adcgs_status adcgs_latents_decode_flags(adcgs_model *model, uint32_t begin, uint32_t end, adcgs_range_dec *range,
                                        adcgs_error *error)
{
    decoder d = {range};
    return adcgs_latents_flags(model, begin, end, decode_flag, &d, error);
}

adcgs_status adcgs_latents_decode(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                  adcgs_range_dec *range, void *room, adcgs_error *error)
{
    decoder d = {range};
    if (layer == 0)
        ADCGS_TRY(adcgs_latents_decode_flags(model, begin, end, range, error));
    adcgs_latents_walk_in(latents, model, layer, begin, end, decode_site, &d, room);
    return adcgs_range_dec_finish(range, error);
}

static void conceal_site(void *user, const adcgs_latent_site *site)
{
    (void)user;
    memcpy(site->yq, site->mu, (size_t)site->count * sizeof *site->yq);
}

adcgs_status adcgs_latents_conceal(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; layer == 0 && i < end; i++) {
        model->is_static[i] = model->body[i] = 0;
        model->mask[i] = (uint16_t)((1U << model->params.k) - 1);
    }
    return adcgs_latents_walk(latents, model, layer, begin, end, conceal_site, NULL, NULL);
}
