/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The lowest layer: errors, memory, little-endian access, small integer
 * helpers, the clock. It knows nothing of the codec. The other headers of this
 * folder: thread_pool.h, cpu_detect.h, log.h, digest.h, fmath.h, lanes.h, strict.h.
 */
#ifndef ADCGS_BASE_BASE_H
#define ADCGS_BASE_BASE_H

#include <adcgs/status.h>

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* WebAssembly with SIMD, which is then the level "scalar". */
#if defined(__wasm_simd128__) && !defined(ADCGS_PORTABLE)
#define ADCGS_WASM 1
#endif

#if defined(__GNUC__)
#define ADCGS_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define ADCGS_PRINTF(fmt, args)
#endif

/* Refuse builds by macro. When a decoder opens, strict.h finds faults that no macro shows (contraction, flushing, rounding). */
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "adcgs must not be built with -ffast-math or a part of it: decoded frames would differ"
#endif
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0
#error "adcgs must not be built with -ffinite-math-only: NaN and infinity have defined results"
#endif
#if FLT_EVAL_METHOD != 0
#error "adcgs needs binary32 without excess precision: on 32-bit x86 add -msse2 -mfpmath=sse, elsewhere -fexcess-precision=fast"
#endif
#if FLT_RADIX != 2 || FLT_MANT_DIG != 24 || FLT_MAX_EXP != 128 || DBL_MANT_DIG != 53
#error "adcgs needs float and double to be binary32 and binary64"
#endif

/**
 * Record status and message, return status: `return adcgs_fail(err, ADCGS_ERR_DATA, "...", ...)`. error may be NULL. The message
 * stays one line: control characters, which file names and other outside text may contain, become question marks.
 */
adcgs_status adcgs_fail(adcgs_error *error, adcgs_status status, const char *format, ...) ADCGS_PRINTF(3, 4);

/** Put the name of an input before a message about its contents, in place of "stream:". error may be NULL. */
void adcgs_error_locate(adcgs_error *error, const char *name);

/** Make a line of text safe to show: control characters become question marks. */
void adcgs_one_line(char *text);

/** Return early when expr is not ADCGS_OK. */
#define ADCGS_TRY(expr)                          \
    do {                                         \
        const adcgs_status try_status_ = (expr); \
        if (try_status_ != ADCGS_OK)             \
            return try_status_;                  \
    } while (0)

/** Memory accounting with a limit. One per decoder; alignment is 64 bytes; contents are zero. Not thread-safe. */
typedef struct adcgs_memory {
    uint64_t used, peak;
    uint64_t limit; /**< bytes; 0 means none */
} adcgs_memory;

/**
 * Allocate count * size zeroed bytes, 64-byte aligned. NULL on overflow, limit or
 * exhaustion, with the reason in error (ADCGS_ERR_MEMORY or ADCGS_ERR_LIMIT).
 * memory may be NULL: no accounting. count * size == 0 gives a valid pointer.
 */
void *adcgs_alloc(adcgs_memory *memory, size_t count, size_t size, adcgs_error *error);
/**
 * The status of a failed adcgs_alloc(). Callers return it, so that a limit stays a limit. Without an error the reason is unknown
 * and ADCGS_ERR_MEMORY is returned; code that sets a limit must pass an error.
 */
static inline adcgs_status adcgs_alloc_status(const adcgs_error *error)
{
    return error ? error->status : ADCGS_ERR_MEMORY;
}
/** Free memory from adcgs_alloc(), with the same memory argument. pointer may be NULL. */
void adcgs_free(adcgs_memory *memory, void *pointer);

static inline uint16_t adcgs_load_le16(const uint8_t *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}
static inline uint32_t adcgs_load_le32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline uint64_t adcgs_load_le64(const uint8_t *p)
{
    return adcgs_load_le32(p) | (uint64_t)adcgs_load_le32(p + 4) << 32;
}
static inline void adcgs_store_le16(uint8_t *p, uint16_t v)
{
    p[0] = (uint8_t)v;
    p[1] = (uint8_t)(v >> 8);
}
static inline void adcgs_store_le32(uint8_t *p, uint32_t v)
{
    adcgs_store_le16(p, (uint16_t)v);
    adcgs_store_le16(p + 2, (uint16_t)(v >> 16));
}
static inline void adcgs_store_le64(uint8_t *p, uint64_t v)
{
    adcgs_store_le32(p, (uint32_t)v);
    adcgs_store_le32(p + 4, (uint32_t)(v >> 32));
}
/** The bits of a binary32 as an integer, and back. */
static inline uint32_t adcgs_float_bits(float f)
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}
static inline float adcgs_bits_float(uint32_t u)
{
    float f;
    memcpy(&f, &u, sizeof f);
    return f;
}
static inline uint64_t adcgs_double_bits(double f)
{
    uint64_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}
static inline double adcgs_bits_double(uint64_t u)
{
    double f;
    memcpy(&f, &u, sizeof f);
    return f;
}

/** Seconds of a monotonic clock. */
double adcgs_seconds(void);

/** Time in seconds: of that clock, and processor time of all threads of this program together. */
typedef struct adcgs_time {
    double clock, cpu;
} adcgs_time;

adcgs_time adcgs_time_now(void);
static inline adcgs_time adcgs_time_less(adcgs_time a, adcgs_time b)
{
    return (adcgs_time){a.clock - b.clock, a.cpu - b.cpu};
}
static inline adcgs_time adcgs_time_plus(adcgs_time a, adcgs_time b)
{
    return (adcgs_time){a.clock + b.clock, a.cpu + b.cpu};
}

#define ADCGS_MIN(a, b) ((a) < (b) ? (a) : (b))
#define ADCGS_MAX(a, b) ((a) > (b) ? (a) : (b))
#define ADCGS_COUNTOF(a) (sizeof(a) / sizeof((a)[0]))

#endif
