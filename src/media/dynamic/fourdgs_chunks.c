/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Chunks of a .4dgs file: their places, intervals and references, not yet their splats. */
#include "config.h"

#include "media/dynamic/fourdgs.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define CHUNKS_FIRST 16     /* entries of the first table */
#define SPLATS_PER_BYTE 16u /* accepted splats per byte of a chunk */
#define FRAME 9             /* bytes of a record before its content; definition (.4dgs) */

/** The packing that a chunk names for its block of streams. */
static adcgs_status read_packing(adcgs_packing *packing, const adcgs_fourdgs *f, adcgs_byte_cursor *c, adcgs_error *error)
{
    const uint32_t n = adcgs_cursor_u32(c);
    const char *const name = (const char *)adcgs_cursor_bytes(c, n);
    *packing = ADCGS_PACKED_NOT;
    if (!name || !n)
        return ADCGS_OK; /* the caller checks the cursor */
    if (n == 7 && !memcmp(name, "deflate", n))
        *packing = ADCGS_PACKED_ZLIB;
    else if (n == 4 && !memcmp(name, "zstd", n))
        *packing = ADCGS_PACKED_ZSTD;
    else
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .4dgs: chunk %u is packed by \"%.*s\", expected deflate or zstd",
                          f->path, f->n_chunks, (int)ADCGS_MIN(n, 32), name);
    return ADCGS_OK;
}

static adcgs_status add_chunk(adcgs_fourdgs *f, const adcgs_fourdgs_chunk *chunk, adcgs_error *error)
{
    const uint32_t n = f->n_chunks;
    if ((n & (n - 1)) == 0 && (n >= CHUNKS_FIRST || !n)) { /* full */
        adcgs_fourdgs_chunk *const more = realloc(f->chunks, (n ? 2 * (size_t)n : CHUNKS_FIRST) * sizeof *more);
        if (!more)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", f->path);
        f->chunks = more;
    }
    f->chunks[f->n_chunks++] = *chunk;
    return ADCGS_OK;
}

/** Index of the chunk whose record begins at a byte; f->n_chunks: none. */
static uint32_t find_chunk(const adcgs_fourdgs *f, uint64_t offset)
{
    uint32_t low = 0, high = f->n_chunks;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (f->chunks[middle].offset < offset)
            low = middle + 1;
        else
            high = middle;
    }
    return low < f->n_chunks && f->chunks[low].offset == offset ? low : f->n_chunks;
}

/**
 * Changes refer to an earlier chunk, through as many chunks as their record states. Updates and deaths can be packed to almost
 * nothing; the splats of the earlier chunk bound them.
 */
static adcgs_status find_reference(const adcgs_fourdgs *f, adcgs_fourdgs_chunk *k, adcgs_error *error)
{
    const uint32_t i = k->reference = find_chunk(f, k->reference_offset);
    if (!f->has_keyframes)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: changes to a chunk at byte %llu of a file without keyframes",
                          f->path, (unsigned long long)k->offset);
    if (i == f->n_chunks)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u changes one at byte %llu, expected an earlier chunk there",
                          f->path, f->n_chunks, (unsigned long long)k->reference_offset);
    const adcgs_fourdgs_chunk *const to = &f->chunks[i];
    const uint64_t keyframe = to->is_delta ? to->keyframe_offset : to->offset;
    if (k->depth != to->depth + 1 || k->keyframe_offset != keyframe || k->level != to->level || k->mode > 1)
        return adcgs_fail(
            error, ADCGS_ERR_DATA,
            "%s: .4dgs: chunk %u: depth %u, keyframe at byte %llu, level %u, mode %d; expected %u, %llu, %u, 0 or 1", f->path,
            f->n_chunks, k->depth, (unsigned long long)k->keyframe_offset, k->level, k->mode, to->depth + 1,
            (unsigned long long)keyframe, to->level);
    if ((uint64_t)k->updates + k->deaths > to->population)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u: %u updates and %u deaths of %llu splats", f->path,
                          f->n_chunks, k->updates, k->deaths, (unsigned long long)to->population);
    k->population = to->population + k->n - k->deaths;
    return ADCGS_OK;
}

static adcgs_status check_chunk(const adcgs_fourdgs *f, const adcgs_fourdgs_chunk *k, adcgs_error *error)
{
    if (!isfinite(k->begin) || !isfinite(k->end) || !(k->begin <= k->end))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u lasts from %g to %g seconds", f->path, f->n_chunks,
                          k->begin, k->end);
    if (k->n / SPLATS_PER_BYTE > k->length || k->n > ADCGS_SPLATS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: .4dgs: chunk %u: %u splats in %llu bytes, expected at most %u, %u in a byte", f->path, f->n_chunks,
                          k->n, (unsigned long long)k->length, ADCGS_SPLATS_MAX, SPLATS_PER_BYTE);
    return ADCGS_OK;
}

adcgs_status adcgs_fourdgs_read_chunk(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, int is_delta, adcgs_error *error)
{
    adcgs_fourdgs_chunk k = {.offset = offset, .length = FRAME + (uint64_t)(c.end - c.at), .is_delta = is_delta};
    k.begin = adcgs_cursor_f64(&c);
    k.end = adcgs_cursor_f64(&c);
    k.level = adcgs_cursor_u32(&c);
    if (is_delta) {
        k.mode = adcgs_cursor_u8(&c);
        k.reference_offset = adcgs_cursor_u64(&c);
        k.keyframe_offset = adcgs_cursor_u64(&c);
        k.depth = adcgs_cursor_u16(&c);
        k.updates = adcgs_cursor_u32(&c);
    }
    k.n = adcgs_cursor_u32(&c);
    if (is_delta)
        k.deaths = adcgs_cursor_u32(&c);
    ADCGS_TRY(read_packing(&k.streams.packing, f, &c, error));
    k.streams.unpacked = adcgs_cursor_u64(&c);
    k.streams.bytes = adcgs_cursor_u64(&c);
    k.streams.data = adcgs_cursor_bytes(&c, k.streams.bytes);
    if (c.failed)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u at byte %llu ends early", f->path, f->n_chunks,
                          (unsigned long long)offset);
    ADCGS_TRY(check_chunk(f, &k, error));
    k.population = k.n;
    if (is_delta)
        ADCGS_TRY(find_reference(f, &k, error));
    return add_chunk(f, &k, error);
}

adcgs_status adcgs_fourdgs_check_index(const adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    const double begin = adcgs_cursor_f64(&c), end = adcgs_cursor_f64(&c);
    const uint64_t chunk = adcgs_cursor_u64(&c), length = adcgs_cursor_u64(&c);
    const uint32_t n = adcgs_cursor_u32(&c), n_bands = adcgs_cursor_u32(&c), i = find_chunk(f, chunk);
    (void)adcgs_cursor_bytes(&c, (uint64_t)n_bands * 17); /* a byte and two offsets each */
    if (c.failed || i == f->n_chunks)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the entry of the index at byte %llu ends early or names no chunk",
                          f->path, (unsigned long long)offset);
    const adcgs_fourdgs_chunk *const k = &f->chunks[i];
    int same = begin == k->begin && end == k->end && length == k->length && n == k->n + k->updates + k->deaths;
    if (f->has_keyframes) {
        same &= adcgs_cursor_u8(&c) == k->is_delta && adcgs_cursor_u8(&c) == k->mode;
        same &= adcgs_cursor_u64(&c) == k->reference_offset;
        same &= adcgs_cursor_u64(&c) == (k->is_delta ? k->keyframe_offset : k->offset);
        same &= adcgs_cursor_u16(&c) == k->depth && !c.failed;
    }
    return same ? ADCGS_OK
                : adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the entry of the index at byte %llu differs from chunk %u",
                             f->path, (unsigned long long)offset, i);
}
