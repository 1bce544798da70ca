/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Packed symbols, as .splat4d and .4dgs store them: integers of 1, 2 or 4 bytes, packed by zlib or zstd. The lowest bytes of all
 * symbols come first, then the next ones.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_BYTE_PLANES_H
#define ADCGS_MEDIA_DYNAMIC_BYTE_PLANES_H

#include "base/base.h"

#define ADCGS_PLANES_MAX ((uint64_t)1 << 31) /**< bytes that a stream may unpack to; chosen by hand, not measured */

typedef enum adcgs_packing { ADCGS_PACKED_NOT, ADCGS_PACKED_ZLIB, ADCGS_PACKED_ZSTD } adcgs_packing;

/** Bytes as they lie in a file. */
typedef struct adcgs_packed {
    const uint8_t *data;
    uint64_t bytes, unpacked; /**< size here, and expected size after unpacking */
    adcgs_packing packing;
} adcgs_packed;

/** ADCGS_ERR_UNSUPPORTED if this build cannot unpack. format: ".4dgs", for the message. */
adcgs_status adcgs_planes_check(const char *path, const char *format, adcgs_error *error);
/**
 * Unpack into new memory, from malloc(), at least one byte. The memory is requested only for sizes that the packed bytes can
 * hold. name: of the stream, for messages: "positions of chunk 3".
 */
adcgs_status adcgs_planes_unpack(uint8_t **out, const adcgs_packed *packed, const char *path, const char *name,
                                 adcgs_error *error);

/** CRC-32 (IEEE 802.3) of bytes, at most 2^32 - 1 of them; 0 if this build cannot unpack. */
uint32_t adcgs_planes_crc32(const uint8_t *data, size_t bytes);

/** Symbol i of n, of `width` bytes. */
static inline uint32_t adcgs_planes_symbol(const uint8_t *planes, uint64_t n, uint64_t i, int width)
{
    uint32_t value = 0;
    for (int j = 0; j < width; j++)
        value |= (uint32_t)planes[(uint64_t)j * n + i] << 8 * j;
    return value;
}

/** 0, -1, 1, -2, ... */
static inline int32_t adcgs_zigzag(uint32_t symbol)
{
    return (int32_t)(symbol >> 1) ^ -(int32_t)(symbol & 1);
}

#endif
