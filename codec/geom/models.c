/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Coding of one split: mixed binary decisions with integer logistic mixing. */
#include "geom/geom_models.h"

#include "geom/logistic_data.h"

#define DOMAIN_MAX 2047

static const int16_t stretch_half[] = {LOGISTIC_STRETCH};
static const uint16_t squash_half[] = {LOGISTIC_SQUASH};

static int stretch(uint32_t p)
{
    const int cell = (int)(p >> 4);
    return cell < 2048 ? -stretch_half[2047 - cell] : stretch_half[cell - 2048];
}

static uint32_t squash(int v)
{
    if (v < 0)
        return 65536u - squash_half[v < -DOMAIN_MAX ? DOMAIN_MAX : -v];
    return squash_half[v > DOMAIN_MAX ? DOMAIN_MAX : v];
}

/* Weight of a context by the number of its updates. */
static int weight(uint32_t count)
{
    return count == 0 ? 0 : count < 3 ? 2 : count < 8 ? 4 : 5;
}

static int code_mixed(adcgs_geom_coder *c, adcgs_adaptive *a, adcgs_adaptive *b, adcgs_adaptive *d, int bit)
{
    const int sum = weight(a->count) * stretch(a->p1) + weight(b->count) * stretch(b->p1) + weight(d->count) * stretch(d->p1);
    /* |sum| <= 15 * 2307; the offset makes the shift one of a positive number, so it rounds downwards */
    const int mixed = ((sum * 9 + (1 << 20)) >> 7) - (1 << 13);
    const uint32_t p1 = squash(mixed);
    if (c->dec)
        bit = adcgs_range_dec_bit(c->dec, p1);
    else
        adcgs_range_enc_bit(c->enc, p1, bit);
    adcgs_adaptive_update(a, bit);
    adcgs_adaptive_update(b, bit);
    adcgs_adaptive_update(d, bit);
    return bit;
}

static uint32_t code_raw(adcgs_geom_coder *c, uint32_t value, int n)
{
    uint32_t high = 0;
    if (n > 16) {
        high = code_raw(c, value >> 16, n - 16) << 16;
        value &= 0xffff;
        n = 16;
    }
    if (n == 0)
        return high;
    if (c->dec)
        return high | adcgs_range_dec_bits(c->dec, n);
    adcgs_range_enc_bits(c->enc, value, n);
    return high | value;
}

static int bit_length(uint32_t v)
{
    int n = 0;
    for (; v; v >>= 1)
        n++;
    return n;
}

/* Code v in [0, n), n <= 16, in a tree of adaptive decisions. Decisions with only one possible outcome are skipped. */
static uint32_t code_tree(adcgs_geom_coder *c, adcgs_adaptive *tree, uint32_t v, uint32_t n)
{
    uint32_t node = 1, value = 0;
    for (int i = bit_length(n - 1) - 1; i >= 0; i--) {
        int bit = 0;
        if ((value | 1u << i) < n) {
            bit = (int)(v >> i & 1);
            if (c->dec)
                bit = adcgs_adaptive_dec(c->dec, &tree[node]);
            else
                adcgs_adaptive_enc(c->enc, &tree[node], bit);
        }
        node = node << 1 | (uint32_t)bit;
        value |= (uint32_t)bit << i;
    }
    return value;
}

/* Code v in [0, n), all values equally likely: truncated binary code. */
static uint32_t code_uniform(adcgs_geom_coder *c, uint32_t v, uint32_t n)
{
    const int length = bit_length(n) - 1;
    const uint32_t short_codes = (uint32_t)((UINT64_C(2) << length) - n);
    const uint32_t word = v < short_codes ? v : (v + short_codes) >> 1;
    const uint32_t head = code_raw(c, word, length);
    if (head < short_codes)
        return head;
    return (head << 1 | code_raw(c, (v + short_codes) & 1, 1)) - short_codes;
}

static int sign_class(uint64_t a, uint64_t b)
{
    return a < b ? 0 : a > b ? 2 : 1;
}

/* Code the half: 1 is left. Mirror images share their contexts, so that both halves train the same contexts. */
static int code_side(adcgs_geom_coder *c, int several, int step, const adcgs_geom_around *around, int left)
{
    int s0 = sign_class(around->before, around->behind), s1 = sign_class(around->ring_before, around->ring_behind);
    int s2 = sign_class((uint64_t)around->lateral_left, (uint64_t)around->lateral_right);
    int near = around->lateral_left, far = around->lateral_right;
    const int mirrored = s0 * 9 + s1 * 3 + s2 < 13;
    if (mirrored) {
        s0 = 2 - s0;
        s1 = 2 - s1;
        s2 = 2 - s2;
        near = around->lateral_right;
        far = around->lateral_left;
    }
    return mirrored ^ code_mixed(c, &c->models->side[several].signs[(s0 * 3 + s1) * 3 + s2],
                                 &c->models->side[several].lateral[(near * 5 + far) * 9 + s0 * 3 + s1],
                                 &c->models->side[several].step[step * 9 + s1 * 3 + s2], left ^ mirrored);
}

static int code_one_sided(adcgs_geom_coder *c, int step, uint32_t n, const adcgs_geom_around *around, int one_sided)
{
    const uint32_t class = ADCGS_MIN(n, ADCGS_GEOM_COUNT_CLASSES - 1);
    const uint32_t lateral = (uint32_t)(ADCGS_MIN(around->lateral_left, 3) * 4 + ADCGS_MIN(around->lateral_right, 3));
    const uint32_t axis = ADCGS_MIN(around->before, 2) * 3 + ADCGS_MIN(around->behind, 2);
    const uint32_t ring = (uint32_t)sign_class(around->ring_before, around->ring_behind);
    return code_mixed(c, &c->models->one_step[(uint32_t)step * ADCGS_GEOM_COUNT_CLASSES + class],
                      &c->models->one_lateral[lateral * ADCGS_GEOM_COUNT_CLASSES + class],
                      &c->models->one_axis[(axis * 3 + ring) * ADCGS_GEOM_COUNT_CLASSES + class], one_sided);
}

/* Code v in [0, n) when both halves have points. */
static uint32_t code_inner(adcgs_geom_coder *c, uint32_t v, uint32_t n, int constrained)
{
    if (n <= 16)
        return code_tree(c, c->models->few[constrained][n - 1], v, n);
    const uint64_t wide = n;
    uint32_t bin = (uint32_t)((uint64_t)v * 16 / wide);
    bin = code_tree(c, c->models->many[bit_length(n) - 1], bin, 16);
    const uint32_t first = (uint32_t)((bin * wide + 15) / 16), next = (uint32_t)(((bin + 1) * wide + 15) / 16);
    return first + code_uniform(c, v - first, next - first);
}

void adcgs_geom_models_init(adcgs_geom_models *models)
{
    for (int i = 0; i < 2; i++) {
        adcgs_adaptive_init(models->side[i].signs, ADCGS_COUNTOF(models->side[i].signs));
        adcgs_adaptive_init(models->side[i].lateral, ADCGS_COUNTOF(models->side[i].lateral));
        adcgs_adaptive_init(models->side[i].step, ADCGS_COUNTOF(models->side[i].step));
    }
    adcgs_adaptive_init(models->one_step, ADCGS_COUNTOF(models->one_step));
    adcgs_adaptive_init(models->one_lateral, ADCGS_COUNTOF(models->one_lateral));
    adcgs_adaptive_init(models->one_axis, ADCGS_COUNTOF(models->one_axis));
    adcgs_adaptive_init(models->few[0][0], sizeof models->few / sizeof(adcgs_adaptive));
    adcgs_adaptive_init(models->many[0], sizeof models->many / sizeof(adcgs_adaptive));
}

uint32_t adcgs_geom_code_split(adcgs_geom_coder *c, int step, uint32_t n, uint64_t capacity, const adcgs_geom_around *around,
                               uint32_t left)
{
    if (n == 1) {
        const int nothing_near = !around->before && !around->behind && !around->ring_before && !around->ring_behind &&
                                 !around->lateral_left && !around->lateral_right;
        return nothing_near ? code_raw(c, left, 1) : (uint32_t)code_side(c, 0, step, around, (int)left);
    }
    if (n <= capacity && code_one_sided(c, step, n, around, left == 0 || left == n))
        return code_side(c, 1, step, around, left != 0) ? n : 0;
    /* left in [least, n - least] */
    const uint32_t least = n <= capacity ? 1 : (uint32_t)(n - capacity);
    const uint32_t choices = n - 2 * least + 1;
    return least + code_inner(c, left - least, choices, n > capacity);
}
