/* SPDX-License-Identifier: BSD-2-Clause */
/** \file CRC-32C (RFC 3720) to detect damage, MD5 (RFC 1321) for conformance digests. Neither guards against attackers. */
#ifndef ADCGS_BASE_DIGEST_H
#define ADCGS_BASE_DIGEST_H

#include "base/base.h"

/** CRC-32C of data continued from crc; start with 0. */
uint32_t adcgs_crc32c(uint32_t crc, const void *data, size_t bytes);

typedef struct adcgs_md5 {
    uint32_t state[4];
    uint64_t bytes;
    uint8_t block[64];
} adcgs_md5;

void adcgs_md5_init(adcgs_md5 *md5);
void adcgs_md5_update(adcgs_md5 *md5, const void *data, size_t bytes);
void adcgs_md5_final(adcgs_md5 *md5, uint8_t digest[16]);
/** 32 lower-case hexadecimal digits and a zero. */
void adcgs_md5_hex(const uint8_t digest[16], char text[33]);

#endif
