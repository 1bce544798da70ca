/* SPDX-License-Identifier: BSD-2-Clause */
/** \file MD5 (RFC 1321): the digest of models and frames in conformance tests. */
#include "base/digest.h"

static const uint32_t sines[64] = {
    0xd76aa478, 0xe8c7b756, 0x242070db, 0xc1bdceee, 0xf57c0faf, 0x4787c62a, 0xa8304613, 0xfd469501, 0x698098d8, 0x8b44f7af,
    0xffff5bb1, 0x895cd7be, 0x6b901122, 0xfd987193, 0xa679438e, 0x49b40821, 0xf61e2562, 0xc040b340, 0x265e5a51, 0xe9b6c7aa,
    0xd62f105d, 0x02441453, 0xd8a1e681, 0xe7d3fbc8, 0x21e1cde6, 0xc33707d6, 0xf4d50d87, 0x455a14ed, 0xa9e3e905, 0xfcefa3f8,
    0x676f02d9, 0x8d2a4c8a, 0xfffa3942, 0x8771f681, 0x6d9d6122, 0xfde5380c, 0xa4beea44, 0x4bdecfa9, 0xf6bb4b60, 0xbebfbc70,
    0x289b7ec6, 0xeaa127fa, 0xd4ef3085, 0x04881d05, 0xd9d4d039, 0xe6db99e5, 0x1fa27cf8, 0xc4ac5665, 0xf4292244, 0x432aff97,
    0xab9423a7, 0xfc93a039, 0x655b59c3, 0x8f0ccc92, 0xffeff47d, 0x85845dd1, 0x6fa87e4f, 0xfe2ce6e0, 0xa3014314, 0x4e0811a1,
    0xf7537e82, 0xbd3af235, 0x2ad7d2bb, 0xeb86d391,
};
static const uint8_t shifts[4][4] = {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};

static void transform(uint32_t state[4], const uint8_t *block)
{
    uint32_t word[16], a = state[0], b = state[1], c = state[2], d = state[3];
    for (int i = 0; i < 16; i++)
        word[i] = adcgs_load_le32(block + 4 * i);
    for (int i = 0; i < 64; i++) {
        const int round = i >> 4, shift = shifts[round][i & 3];
        uint32_t f;
        int index;
        if (round == 0) {
            f = (b & c) | (~b & d);
            index = i;
        } else if (round == 1) {
            f = (d & b) | (~d & c);
            index = 5 * i + 1;
        } else if (round == 2) {
            f = b ^ c ^ d;
            index = 3 * i + 5;
        } else {
            f = c ^ (b | ~d);
            index = 7 * i;
        }
        const uint32_t sum = a + f + sines[i] + word[index & 15];
        a = d;
        d = c;
        c = b;
        b += sum << shift | sum >> (32 - shift);
    }
    state[0] += a;
    state[1] += b;
    state[2] += c;
    state[3] += d;
}

void adcgs_md5_init(adcgs_md5 *md5)
{
    *md5 = (adcgs_md5){.state = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476}};
}

void adcgs_md5_update(adcgs_md5 *md5, const void *data, size_t bytes)
{
    const uint8_t *p = data;
    size_t fill = (size_t)(md5->bytes & 63);
    md5->bytes += bytes;
    while (bytes) {
        if (fill == 0 && bytes >= 64) {
            transform(md5->state, p);
            p += 64;
            bytes -= 64;
            continue;
        }
        const size_t take = ADCGS_MIN(bytes, 64 - fill);
        memcpy(md5->block + fill, p, take);
        p += take;
        bytes -= take;
        fill += take;
        if (fill == 64) {
            transform(md5->state, md5->block);
            fill = 0;
        }
    }
}

void adcgs_md5_final(adcgs_md5 *md5, uint8_t digest[16])
{
    static const uint8_t padding[64] = {0x80};
    uint8_t length[8];
    adcgs_store_le64(length, md5->bytes * 8);
    adcgs_md5_update(md5, padding, (size_t)((119 - md5->bytes % 64) % 64 + 1));
    adcgs_md5_update(md5, length, 8);
    for (int i = 0; i < 4; i++)
        adcgs_store_le32(digest + 4 * i, md5->state[i]);
}

void adcgs_md5_hex(const uint8_t digest[16], char text[33])
{
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < 16; i++) {
        text[2 * i] = digits[digest[i] >> 4];
        text[2 * i + 1] = digits[digest[i] & 15];
    }
    text[32] = 0;
}
