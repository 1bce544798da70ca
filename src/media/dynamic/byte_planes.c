/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Unpacking of symbols. */
#include "config.h"

#include "media/dynamic/byte_planes.h"

#include <stdlib.h>

#ifdef HAVE_SPZ /* zlib and zstd */

#define ZLIB_CONST /* zlib's input is const */
#include <zlib.h>
#include <zstd.h>

#define ZLIB_RATIO 1032                /* upper bound of deflate's compression ratio; literature (zlib's documentation) */
#define ZSTD_RATIO ((uint64_t)1 << 17) /* above zstd's ratio: a block of 128 KiB takes four bytes; RFC 8878, arithmetic */

adcgs_status adcgs_planes_check(const char *path, const char *format, adcgs_error *error)
{
    return ADCGS_OK;
}

/** zlib's numbers of bytes have 32 bits: ADCGS_PLANES_MAX bounds the output, and the caller the input. */
static adcgs_status unpack_zlib(uint8_t *out, const adcgs_packed *p, const char *path, const char *name, adcgs_error *error)
{
    z_stream z = {.next_in = p->data, .avail_in = (uInt)p->bytes, .next_out = out, .avail_out = (uInt)p->unpacked};
    if (inflateInit(&z) != Z_OK)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    uint8_t beyond;
    int result = inflate(&z, Z_FINISH);
    const unsigned missing = z.avail_out;
    if (result == Z_BUF_ERROR && !missing) { /* a stream that fills the output exactly may still have its end to come */
        z.next_out = &beyond;
        z.avail_out = 1;
        result = inflate(&z, Z_FINISH);
    }
    const int is_whole = result == Z_STREAM_END && !missing && z.next_out != &beyond + 1;
    inflateEnd(&z);
    if (result == Z_MEM_ERROR)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (is_whole)
        return ADCGS_OK;
    if (result == Z_DATA_ERROR || result == Z_NEED_DICT)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: damaged zlib stream", path, name);
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: %s than %llu bytes in the zlib stream", path, name,
                      missing ? "fewer" : "more", (unsigned long long)p->unpacked);
}

static adcgs_status unpack_zstd(uint8_t *out, const adcgs_packed *p, const char *path, const char *name, adcgs_error *error)
{
    const size_t got = ZSTD_decompress(out, (size_t)p->unpacked, p->data, (size_t)p->bytes);
    if (ZSTD_isError(got))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: damaged zstd stream: %s", path, name, ZSTD_getErrorName(got));
    if (got != p->unpacked)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: %zu bytes in the zstd stream, expected %llu", path, name, got,
                          (unsigned long long)p->unpacked);
    return ADCGS_OK;
}

/** False for sizes that these bytes cannot unpack to. */
static int can_hold(const adcgs_packed *p)
{
    if (p->packing == ADCGS_PACKED_NOT)
        return p->unpacked == p->bytes;
    if (p->packing == ADCGS_PACKED_ZLIB)
        return p->bytes <= UINT32_MAX && p->unpacked / ZLIB_RATIO <= p->bytes;
    const unsigned long long size = ZSTD_getFrameContentSize(p->data, (size_t)p->bytes);
    return p->unpacked / ZSTD_RATIO <= p->bytes && (size == ZSTD_CONTENTSIZE_UNKNOWN || size <= p->unpacked);
}

/** Refuse sizes before memory is requested for them. */
static adcgs_status check_sizes(const adcgs_packed *p, const char *path, const char *name, adcgs_error *error)
{
    if (p->unpacked > ADCGS_PLANES_MAX)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %s: %llu bytes, expected at most %llu", path, name,
                          (unsigned long long)p->unpacked, (unsigned long long)ADCGS_PLANES_MAX);
    if (p->packing == ADCGS_PACKED_ZSTD && ZSTD_getFrameContentSize(p->data, (size_t)p->bytes) == ZSTD_CONTENTSIZE_ERROR)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: damaged zstd stream: no header of a frame", path, name);
    if (!can_hold(p))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: a stream of %llu bytes, which do not unpack to %llu", path, name,
                          (unsigned long long)p->bytes, (unsigned long long)p->unpacked);
    return ADCGS_OK;
}

adcgs_status adcgs_planes_unpack(uint8_t **out, const adcgs_packed *p, const char *path, const char *name, adcgs_error *error)
{
    *out = NULL;
    ADCGS_TRY(check_sizes(p, path, name, error));
    uint8_t *const to = *out = malloc((size_t)p->unpacked + !p->unpacked);
    if (!to)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %s", path, name);
    if (p->packing == ADCGS_PACKED_NOT && p->bytes)
        memcpy(to, p->data, (size_t)p->bytes);
    const adcgs_status status = p->packing == ADCGS_PACKED_ZLIB   ? unpack_zlib(to, p, path, name, error)
                                : p->packing == ADCGS_PACKED_ZSTD ? unpack_zstd(to, p, path, name, error)
                                                                  : ADCGS_OK;
    if (status != ADCGS_OK) {
        free(to);
        *out = NULL;
    }
    return status;
}

uint32_t adcgs_planes_crc32(const uint8_t *data, size_t bytes)
{
    return (uint32_t)crc32(0, data, (uInt)bytes);
}

#else

adcgs_status adcgs_planes_check(const char *path, const char *format, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no %s: it needs zlib and zstd", path, format);
}

adcgs_status adcgs_planes_unpack(uint8_t **out, const adcgs_packed *p, const char *path, const char *name, adcgs_error *error)
{
    *out = NULL;
    return adcgs_planes_check(path, "packed streams", error);
}

uint32_t adcgs_planes_crc32(const uint8_t *data, size_t bytes)
{
    return 0;
}

#endif
