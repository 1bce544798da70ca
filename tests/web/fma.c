/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Fused multiply-adds, mostly in cases where rounding twice gives another result: prints a digest of some millions of results. On
 * this machine they are those of the C library, on WebAssembly those of base/fma_wasm.h, one by one and four at a time.
 */
#include "base/digest.h"
#include "base/fmath.h"

#include <stdio.h>

#define ROUNDS 400000

static uint32_t state = 1;

static uint32_t draw(void)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/* Numbers with few and with many bits, of every exponent: sums that are ties, or nearly so, and subnormal ones. */
static float number(int kind)
{
    const uint32_t sign = draw() & 0x80000000u;
    const uint32_t exponent = kind == 1 ? 50 + draw() % 28 : kind & 2 ? 100 + draw() % 54 : draw() % 256;
    const uint32_t few = draw() & 7 ? 0x7fffffu << (draw() % 24) : 0x7fffff;
    return adcgs_bits_float(sign | exponent << 23 | (draw() & few & 0x7fffff));
}

/* An addend about as large as the product, or half an ulp of it away, near a tie. */
static float addend(float a, float b, int kind)
{
    const float p = a * b;
    if (kind == 1)
        return adcgs_bits_float((draw() & 0x80ffffffu) >> (draw() & 7)); /* about the smallest normal number */
    if (kind < 4)
        return number(kind);
    const float half = adcgs_bits_float(draw() & 1 ? adcgs_float_bits(p) - (24u << 23) : adcgs_float_bits(p) + (24u << 23));
    return adcgs_bits_float((adcgs_float_bits(half) & 0xff800000u) | (draw() & 1 ? 0 : draw() & 7)) * (draw() & 1 ? 1.0f : -1.0f);
}

static uint32_t together(const float a[4], const float b[4], const float c[4], int lane)
{
#ifdef ADCGS_WASM
    float out[4];
    wasm_v128_store(out, adcgs_fma4(wasm_v128_load(a), wasm_v128_load(b), wasm_v128_load(c)));
    return adcgs_float_bits(out[lane]);
#else
    return adcgs_float_bits(fmaf(a[lane], b[lane], c[lane]));
#endif
}

/* All NaNs count as the same. */
static uint32_t same_nan(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000 ? 0x7fc00000 : bits;
}

int main(void)
{
    uint32_t crc = 0, subnormal = 0;
    for (int i = 0; i < ROUNDS; i++) {
        float a[4], b[4], c[4];
        uint8_t bytes[32];
        for (int l = 0; l < 4; l++) {
            const int kind = (int)(draw() % 8);
            a[l] = number(kind);
            b[l] = number(kind);
            c[l] = addend(a[l], b[l], kind);
        }
        for (int l = 0; l < 4; l++) {
            const uint32_t one = same_nan(adcgs_float_bits(fmaf(a[l], b[l], c[l])));
            subnormal += (one & 0x7f800000) == 0 && (one & 0x7fffff);
            adcgs_store_le32(bytes + 8 * l, one);
            adcgs_store_le32(bytes + 8 * l + 4, same_nan(together(a, b, c, l)));
        }
        crc = adcgs_crc32c(crc, bytes, sizeof bytes);
    }
    printf("%08x, %u subnormal\n", (unsigned)crc, (unsigned)subnormal);
    return subnormal < ROUNDS / 100;
}
