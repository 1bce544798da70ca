/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Digest of primitives (conformance point S). */
#include "base/digest.h"
#include "splat/rows.h"
#include "splat/splat.h"

void adcgs_splat_digest(const adcgs_model *model, const adcgs_primitives *p, uint8_t digest[16])
{
    const float *const arrays[] = {p->mean[0],  p->mean[1],     p->mean[2],     p->scale[0],    p->scale[1],
                                   p->scale[2], p->rotation[0], p->rotation[1], p->rotation[2], p->rotation[3],
                                   p->opacity,  p->colour[0],   p->colour[1],   p->colour[2]};
    adcgs_md5 md5;
    adcgs_md5_init(&md5);
    for (uint32_t i = 0; i < model->n; i++)
        for (uint32_t k = 0; k < model->params.k; k++) {
            uint8_t bytes[4 * ADCGS_COUNTOF(arrays)];
            const size_t slot = adcgs_slot_of(i, model->params.k, (int)k);
            if (!(model->mask[i] >> k & 1))
                continue;
            for (size_t a = 0; a < ADCGS_COUNTOF(arrays); a++)
                adcgs_store_le32(bytes + 4 * a, adcgs_float_bits(arrays[a][slot]));
            adcgs_md5_update(&md5, bytes, sizeof bytes);
        }
    adcgs_md5_final(&md5, digest);
}
