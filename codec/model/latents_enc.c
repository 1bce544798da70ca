/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Encoding a slice of a layer from values that were quantised in the same walk. */
#include "model/latents.h"
#include "model/latents_priv.h"

typedef struct encoder {
    adcgs_range_enc range;
    adcgs_status status;
    adcgs_error *error;
} encoder;

static int encode_flag(void *user, adcgs_adaptive *context, int bit)
{
    encoder *e = user;
    adcgs_adaptive_enc(&e->range, context, bit);
    return bit;
}

/** The n of smallest magnitude with clip(64 n + mu, 32767) == yq; 0 if there is none (the caller checks). */
static int32_t level_of(int32_t yq, int32_t mu)
{
    const int32_t distance = yq - mu;
    if (yq == 32767)
        return (distance + 63) / 64;
    if (yq == -32767)
        return (distance - 63) / 64;
    return distance / 64;
}

static void encode_site(void *user, const adcgs_latent_site *site)
{
    encoder *e = user;
    for (int c = 0; c < site->count && e->status == ADCGS_OK; c++) {
        const int32_t yq = site->yq[c], n = level_of(yq, site->mu[c]), limit = adcgs_value_max(site->si[c]);
        if (adcgs_clip(64 * n + site->mu[c], 32767) != yq || n < -limit || n > limit || (site->si[c] == 0 && n != 0))
            e->status = adcgs_fail(e->error, ADCGS_ERR_USAGE,
                                   "latents: anchor %u, primitive %d, group %d, channel %d holds %d, which mean %d and level %u "
                                   "cannot give",
                                   site->anchor, site->k, site->group, site->first + c, yq, site->mu[c], site->si[c]);
        else if (site->si[c] > 0)
            adcgs_value_enc(&e->range, site->si[c], n);
    }
}

adcgs_status adcgs_latents_encode(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                  adcgs_buffer *out, adcgs_error *error)
{
    encoder e = {.status = ADCGS_OK, .error = error};
    adcgs_range_enc_init(&e.range, out);
    if (layer == 0)
        ADCGS_TRY(adcgs_latents_flags(model, begin, end, encode_flag, &e, error));
    ADCGS_TRY(adcgs_latents_walk(latents, model, layer, begin, end, encode_site, &e, error));
    ADCGS_TRY(e.status);
    adcgs_range_enc_finish(&e.range);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "latents: no memory for the sub-stream") : ADCGS_OK;
}
