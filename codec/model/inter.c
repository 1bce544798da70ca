/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Coding of inter-segment prediction (KEEP), in both directions. */
#include "model/inter.h"
#include "model/inter_priv.h"

#define MORE_MAX 15 /* magnitudes from this value on have an escape code */

/** One direction of coding. Each function returns the value that it read, or writes its argument and returns it. */
typedef struct coder {
    adcgs_range_dec *dec; /**< NULL: encoding */
    adcgs_range_enc *enc;
} coder;

/** Contexts, and the recent decisions that select them. */
typedef struct contexts {
    adcgs_adaptive drop[2][3], refine[2][3], change[ADCGS_INTER_GROUPS], zero[ADCGS_INTER_GROUPS][2];
    adcgs_adaptive more[ADCGS_INTER_GROUPS][MORE_MAX]; /**< by magnitude */
    int dropped[2], refined[2];                        /**< for the last two anchors; for the last two that were not dropped */
} contexts;

static int code_flag(const coder *c, adcgs_adaptive *context, int bit)
{
    if (c->dec)
        return adcgs_adaptive_dec(c->dec, context);
    adcgs_adaptive_enc(c->enc, context, bit);
    return bit;
}

static int32_t code_escape(const coder *c, int32_t excess)
{
    if (c->dec)
        return adcgs_excess_dec(c->dec);
    adcgs_excess_enc(c->enc, excess);
    return excess;
}

static int code_sign(const coder *c, int negative)
{
    if (c->dec)
        return (int)adcgs_range_dec_bits(c->dec, 1);
    adcgs_range_enc_bits(c->enc, (uint32_t)negative, 1);
    return negative;
}

/** Code a difference, in steps. */
static int32_t code_difference(const coder *c, contexts *x, int group, int after_other, int32_t q)
{
    const int32_t wanted = q < 0 ? -q : q;
    if (!code_flag(c, &x->zero[group][after_other], q != 0))
        return 0;
    const int negative = code_sign(c, q < 0);
    int32_t magnitude = 1;
    while (magnitude < MORE_MAX && code_flag(c, &x->more[group][magnitude], wanted > magnitude))
        magnitude++;
    if (magnitude == MORE_MAX)
        magnitude += code_escape(c, wanted - MORE_MAX);
    return negative ? -magnitude : magnitude;
}

/** Code the differences of one group of an anchor. row: the previous values when decoding, the new values when encoding. */
static void code_group(const coder *c, contexts *x, int group, const int16_t *before, int16_t *row, int n)
{
    if (!code_flag(c, &x->change[group], memcmp(before, row, (size_t)n * sizeof *row) != 0))
        return;
    int other = 0;
    for (int i = 0; i < n; i++) {
        const int32_t q = code_difference(c, x, group, other, adcgs_inter_difference(before[i], row[i]));
        row[i] = (int16_t)adcgs_clip(before[i] + 64 * q, 32767);
        other = q != 0;
    }
}

static void code_anchor(const coder *c, contexts *x, adcgs_inter *kept, const adcgs_model *before, uint32_t i)
{
    const int is_static = before->is_static[i], mode = kept->mode[i];
    const int dropped = code_flag(c, &x->drop[is_static][x->dropped[0] + x->dropped[1]], mode == ADCGS_INTER_DROPPED);
    x->dropped[1] = x->dropped[0];
    x->dropped[0] = dropped;
    kept->mode[i] = ADCGS_INTER_DROPPED;
    if (dropped)
        return;
    const int refined = code_flag(c, &x->refine[is_static][x->refined[0] + x->refined[1]], mode == ADCGS_INTER_REFINED);
    x->refined[1] = x->refined[0];
    x->refined[0] = refined;
    kept->mode[i] = refined ? ADCGS_INTER_REFINED : ADCGS_INTER_SAME;
    kept->n++;
    for (int g = 0; refined && g < ADCGS_INTER_GROUPS; g++) {
        const size_t at = (size_t)i * (size_t)adcgs_inter_channels(&before->params, g);
        const int coded = g == ADCGS_INTER_SIGMA && is_static ? ADCGS_SIGMA_N : adcgs_inter_channels(&before->params, g);
        code_group(c, x, g, adcgs_inter_rows(before, g) + at, kept->rows[g] + at, coded);
    }
}

static void code_all(const coder *c, adcgs_inter *kept, const adcgs_model *before)
{
    contexts x = {.dropped = {0, 0}};
    adcgs_adaptive_init(x.drop[0], 6);
    adcgs_adaptive_init(x.refine[0], 6);
    adcgs_adaptive_init(x.change, ADCGS_INTER_GROUPS);
    adcgs_adaptive_init(x.zero[0], 2 * ADCGS_INTER_GROUPS);
    adcgs_adaptive_init(x.more[0], ADCGS_INTER_GROUPS * MORE_MAX);
    kept->n = 0;
    for (uint32_t i = 0; i < before->n; i++)
        code_anchor(c, &x, kept, before, i);
}

int adcgs_inter_channels(const adcgs_params *params, int group)
{
    return group == ADCGS_INTER_FV ? params->n_fv : group == ADCGS_INTER_SIGMA ? adcgs_sigma_rows(params) : ADCGS_COLOUR_N;
}

int16_t *adcgs_inter_rows(const adcgs_model *model, int group)
{
    return group == ADCGS_INTER_FV ? model->fv : group == ADCGS_INTER_SIGMA ? model->sigma : model->colour;
}

int32_t adcgs_inter_difference(int32_t before, int32_t now)
{
    const int32_t distance = now - before;
    return now == 32767 ? (distance + 63) / 64 : now == -32767 ? (distance - 63) / 64 : distance / 64;
}

adcgs_status adcgs_inter_alloc(adcgs_inter *kept, const adcgs_model *before, adcgs_memory *memory, adcgs_error *error)
{
    kept->n = 0;
    kept->mode = adcgs_alloc(memory, before->n, sizeof *kept->mode, error);
    int failed = !kept->mode;
    for (int g = 0; g < ADCGS_INTER_GROUPS && !failed; g++) {
        const size_t row = (size_t)adcgs_inter_channels(&before->params, g) * sizeof *kept->rows[g];
        kept->rows[g] = adcgs_alloc(memory, before->n, row, error);
        failed = !kept->rows[g];
        if (!failed)
            memcpy(kept->rows[g], adcgs_inter_rows(before, g), before->n * row);
    }
    return failed ? adcgs_alloc_status(error) : ADCGS_OK;
}

void adcgs_inter_clear(adcgs_inter *kept, adcgs_memory *memory)
{
    adcgs_free(memory, kept->mode);
    for (int g = 0; g < ADCGS_INTER_GROUPS; g++)
        adcgs_free(memory, kept->rows[g]);
    memset(kept, 0, sizeof *kept);
}

uint64_t adcgs_inter_values(const adcgs_model *before)
{
    const uint64_t own = 1 + (uint64_t)before->params.n_fv + (uint64_t)adcgs_sigma_rows(&before->params) + ADCGS_COLOUR_N;
    return before->n * own;
}

adcgs_status adcgs_inter_decode(adcgs_inter *kept, const adcgs_model *before, adcgs_range_dec *range, adcgs_memory *memory,
                                adcgs_error *error)
{
    const coder c = {.dec = range};
    ADCGS_TRY(adcgs_inter_alloc(kept, before, memory, error));
    code_all(&c, kept, before);
    return adcgs_range_dec_finish(range, error);
}

adcgs_status adcgs_inter_encode(const adcgs_inter *kept, const adcgs_model *before, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_range_enc range;
    const coder c = {.enc = &range};
    adcgs_inter same = *kept; /* code_all() stores the same values again */
    adcgs_range_enc_init(&range, out);
    code_all(&c, &same, before);
    adcgs_range_enc_finish(&range);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "KEEP: no memory for the sub-stream") : ADCGS_OK;
}
