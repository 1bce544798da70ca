/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The weight coder (spec clause "Weights"). Every tensor is a run of 32-bit
 * numbers. Unused precision and range (low bits on a coarse lattice, large
 * magnitudes, differences between rows) cost next to nothing, and all values
 * are exact. One walk over the elements serves both directions; a coder with e
 * set encodes.
 */
#include "net/net.h"

#define CLASSES 33

typedef struct coder {
    adcgs_range_enc *e; /* one of e and d is set */
    adcgs_range_dec *d;
    int bad; /* a value does not fit its type */
} coder;

typedef struct integer_models {
    adcgs_adaptive size[CLASSES][CLASSES]; /* is the class larger than this index? given the neighbours' mean class */
    adcgs_adaptive top[CLASSES][3];
} integer_models;

typedef struct float_models {
    adcgs_adaptive exponent[256], zeros[32], top[3];
} float_models;

static int code_bit(coder *c, adcgs_adaptive *context, int bit)
{
    if (!c->e)
        return adcgs_adaptive_dec(c->d, context);
    adcgs_adaptive_enc(c->e, context, bit);
    return bit;
}

/* Code n raw bits, 0..32; if there are more than 16, the high part first. */
static uint32_t code_raw(coder *c, uint32_t value, int n)
{
    if (n == 0)
        return 0;
    if (n > 16) {
        const uint32_t high = code_raw(c, value >> 16, n - 16);
        return high << 16 | code_raw(c, value & 0xffff, 16);
    }
    if (!c->e)
        return adcgs_range_dec_bits(c->d, n);
    adcgs_range_enc_bits(c->e, value, n);
    return value;
}

/* Code a number of n bits, most significant first, in a tree of 2^n contexts. */
static uint32_t code_tree(coder *c, adcgs_adaptive *tree, uint32_t value, int n)
{
    uint32_t node = 1;
    for (int i = n - 1; i >= 0; i--)
        node = node << 1 | (uint32_t)code_bit(c, &tree[node], value >> i & 1);
    return node - (1u << n);
}

/* Code the n bits below an implied leading one: at most two of them adaptively, the rest raw. */
static uint32_t code_tail(coder *c, adcgs_adaptive top[3], uint32_t value, int n)
{
    const int adaptive = ADCGS_MIN(n, 2), raw = n - adaptive;
    uint32_t head = 1;
    for (int i = adaptive - 1; i >= 0; i--)
        head = head << 1 | (uint32_t)code_bit(c, &top[head - 1], value >> (raw + i) & 1);
    const uint32_t rest = code_raw(c, raw ? value & (uint32_t)((UINT64_C(1) << raw) - 1) : 0, raw);
    return (uint32_t)((uint64_t)(head - (1u << adaptive)) << raw | rest);
}

static int bit_length(uint32_t v)
{
    int n = 0;
    for (int step = 16; step; step >>= 1)
        if (v >> n >> step)
            n += step;
    return v ? n + 1 : 0;
}

static uint32_t magnitude_of(int32_t v)
{
    return v < 0 ? 0u - (uint32_t)v : (uint32_t)v;
}

/* Code one integer; *class becomes its bit length. context: the rounded mean class of its neighbours. */
static int32_t code_integer(coder *c, integer_models *models, int context, int32_t v, uint8_t *class)
{
    const uint32_t magnitude = magnitude_of(v);
    const int length = bit_length(magnitude);
    int k = 0;
    while (k < CLASSES - 1 && code_bit(c, &models->size[context][k], length > k))
        k++;
    *class = (uint8_t)k;
    if (k == 0)
        return 0;
    const uint32_t leading = 1u << (k - 1), coded = leading | code_tail(c, models->top[k], magnitude - leading, k - 1);
    const uint32_t negative = code_raw(c, v < 0, 1);
    if (coded > UINT32_C(0x7fffffff) + negative)
        c->bad = 1;
    return (int32_t)((int64_t)(negative ? -(int64_t)coded : (int64_t)(coded & 0x7fffffff)));
}

static int neighbour_context(const uint8_t *classes, uint32_t row, uint32_t col)
{
    /* classes[col] still holds the row above, classes[col - 1] already this row */
    if (row == 0 && col == 0)
        return 0;
    const int up = row ? classes[col] : classes[col - 1];
    const int left = col ? classes[col - 1] : up;
    return (up + left + 1) >> 1;
}

/* Code everything except the two header elements of a mode 0 tensor. m must be readable when decoding, too. */
static void code_integers(coder *c, const adcgs_tensor *t, int zeros, int by_row, uint8_t *classes)
{
    integer_models models;
    adcgs_adaptive_init(models.size[0], CLASSES * CLASSES);
    adcgs_adaptive_init(models.top[0], CLASSES * 3);
    for (uint32_t row = 0; row < t->rows; row++) {
        int32_t *m = t->m + (size_t)row * t->cols;
        const int32_t *above = by_row && row ? m - t->cols : NULL;
        for (uint32_t col = 0; col < t->cols; col++) {
            const uint32_t base = above ? (uint32_t)(above[col] / (INT64_C(1) << zeros)) : 0;
            const int32_t given = (int32_t)((uint32_t)(m[col] / (INT64_C(1) << zeros)) - base);
            const int32_t coded = code_integer(c, &models, neighbour_context(classes, row, col), given, &classes[col]);
            const int64_t value = (int64_t)(int32_t)((uint32_t)coded + base) * (INT64_C(1) << zeros);
            if (value > INT32_MAX || value < INT32_MIN)
                c->bad = 1;
            if (!c->e)
                m[col] = c->bad ? 0 : (int32_t)value;
        }
    }
}

static void code_floats(coder *c, const adcgs_tensor *t)
{
    float_models models;
    adcgs_adaptive_init(models.exponent, ADCGS_COUNTOF(models.exponent));
    adcgs_adaptive_init(models.zeros, ADCGS_COUNTOF(models.zeros));
    adcgs_adaptive_init(models.top, ADCGS_COUNTOF(models.top));
    const size_t n = (size_t)t->rows * t->cols;
    for (size_t i = 0; i < n; i++) {
        const uint32_t given = (uint32_t)t->m[i], mantissa = given & 0x7fffff;
        int zeros = 0;
        while (zeros < 23 && !(mantissa >> zeros & 1))
            zeros++;
        const uint32_t sign = code_raw(c, given >> 31, 1);
        const uint32_t exponent = code_tree(c, models.exponent, given >> 23 & 255, 8);
        zeros = (int)code_tree(c, models.zeros, (uint32_t)zeros, 5);
        uint32_t fraction = 0;
        if (zeros < 23)
            fraction = (code_tail(c, models.top, mantissa >> zeros >> 1, 22 - zeros) << 1 | 1) << zeros;
        if (exponent == 255 || zeros > 23)
            c->bad = 1;
        if (!c->e)
            t->m[i] = c->bad ? 0 : (int32_t)(sign << 31 | exponent << 23 | fraction);
    }
}

/* Trailing zero bits common to all elements; 0 if all elements are zero. */
static int common_zeros(const adcgs_tensor *t)
{
    const size_t n = (size_t)t->rows * t->cols;
    uint32_t all = 0;
    for (size_t i = 0; i < n; i++)
        all |= (uint32_t)t->m[i];
    int zeros = 0;
    while (all && !(all >> zeros & 1))
        zeros++;
    return zeros;
}

/* Whether differences between rows are smaller than the values. */
static int rows_are_smooth(const adcgs_tensor *t)
{
    int64_t plain = 0, difference = 0;
    for (size_t i = t->cols; i < (size_t)t->rows * t->cols; i++) {
        plain += bit_length(magnitude_of(t->m[i]));
        const int64_t step = (int64_t)t->m[i] - t->m[i - t->cols];
        difference += bit_length((uint32_t)(step < 0 ? -step : step));
    }
    return difference < plain;
}

void adcgs_tensor_encode(adcgs_range_enc *e, const adcgs_tensor *t)
{
    coder c = {.e = e};
    uint8_t classes[ADCGS_NET_INPUTS_MAX] = {0};
    if (t->mode == 1) {
        code_floats(&c, t);
        return;
    }
    const int zeros = common_zeros(t), by_row = rows_are_smooth(t);
    code_raw(&c, (uint32_t)zeros, 5);
    code_raw(&c, (uint32_t)by_row, 1);
    code_integers(&c, t, zeros, by_row, classes);
}

adcgs_status adcgs_tensor_decode(adcgs_range_dec *d, adcgs_tensor *t, adcgs_error *error)
{
    coder c = {.d = d};
    uint8_t classes[ADCGS_NET_INPUTS_MAX] = {0};
    if (t->mode > 1 || t->cols > ADCGS_NET_INPUTS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "tensor of mode %d with %u columns; modes are 0 and 1, columns up to %d",
                          t->mode, t->cols, ADCGS_NET_INPUTS_MAX);
    if (t->mode == 1) {
        code_floats(&c, t);
    } else {
        const int zeros = (int)code_raw(&c, 0, 5), by_row = (int)code_raw(&c, 0, 1);
        code_integers(&c, t, zeros, by_row, classes);
    }
    if (c.bad)
        return adcgs_fail(error, ADCGS_ERR_DATA, "tensor of %u x %u numbers: one does not fit its type", t->rows, t->cols);
    return ADCGS_OK;
}
