/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The range coder: a program of operations, taken from the first bytes and repeated, is decoded from the other bytes. Values that
 * decode without an error are the same when coded and decoded again.
 */
#include "fuzz.h"

#include "net/net.h"

#define PROGRAM 12
#define OPERATIONS 2000

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/range", NULL};

/** Encoder and decoder of the same program. */
typedef struct coder {
    const uint8_t *program;
    adcgs_range_dec *dec;
    adcgs_range_enc *enc;
    adcgs_adaptive contexts[16];
} coder;

static int32_t code_one(coder *c, int i, int32_t v)
{
    const int op = c->program[i % PROGRAM], form = op >> 2;
    const int n = 1 + form % 16, si = 1 + (op * 7 + i) % (ADCGS_SIGMA_LEVELS - 1);
    const uint32_t p1 = 1 + (uint32_t)(op * 257 % 65535);
    switch (op & 3) {
    case 0:
        if (c->enc)
            adcgs_range_enc_bits(c->enc, (uint32_t)v, n);
        return c->enc ? v : (int32_t)adcgs_range_dec_bits(c->dec, n);
    case 1:
        if (c->enc)
            adcgs_range_enc_bit(c->enc, p1, v);
        return c->enc ? v : adcgs_range_dec_bit(c->dec, p1);
    case 2:
        if (c->enc)
            adcgs_adaptive_enc(c->enc, &c->contexts[form % 16], v);
        return c->enc ? v : adcgs_adaptive_dec(c->dec, &c->contexts[form % 16]);
    default:
        if (c->enc)
            adcgs_value_enc(c->enc, si, v);
        return c->enc ? v : adcgs_value_dec(c->dec, si);
    }
}

static void run(coder *c, int32_t *values)
{
    adcgs_adaptive_init(c->contexts, ADCGS_COUNTOF(c->contexts));
    for (int i = 0; i < OPERATIONS; i++) {
        values[i] = code_one(c, i, values[i]);
        FUZZ_REQUIRE(!c->dec || c->dec->range >> 32);
        FUZZ_REQUIRE(!c->dec || c->dec->broken || c->dec->value < c->dec->range);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int32_t values[OPERATIONS] = {0}, again[OPERATIONS] = {0};
    adcgs_range_dec dec;
    adcgs_range_enc enc;
    adcgs_buffer out;
    if (size < PROGRAM)
        return 0;
    coder c = {.program = data, .dec = &dec};
    adcgs_range_dec_init(&dec, data + PROGRAM, size - PROGRAM);
    run(&c, values);
    (void)adcgs_range_dec_finish(&dec, NULL);
    if (dec.broken)
        return 0;
    adcgs_buffer_init(&out);
    adcgs_range_enc_init(&enc, &out);
    coder back = {.program = data, .enc = &enc};
    run(&back, values);
    adcgs_range_enc_finish(&enc);
    adcgs_range_dec_init(&dec, out.data, out.size);
    run(&c, again);
    FUZZ_REQUIRE(adcgs_range_dec_finish(&dec, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(memcmp(values, again, sizeof values) == 0);
    adcgs_buffer_clear(&out);
    return 0;
}
