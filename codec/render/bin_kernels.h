/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the binning kernel. The part of the ellipse alpha >= 1/255 within a
 * row of 4x4 blocks is convex, so the blocks it touches are those between its
 * leftmost and rightmost points. The kernel finds these points for sixteen
 * block rows, which are four tile rows, at once.
 */
#include "render/raster_isa.h"

#include <stdalign.h>

/* Prefetch distance of records, which were written by slot and are read by depth. */
#define FETCH_AHEAD 12

static const alignas(64) float row_centre[16] = {0.5f,  4.5f,  8.5f,  12.5f, 16.5f, 20.5f, 24.5f, 28.5f,
                                                 32.5f, 36.5f, 40.5f, 44.5f, 48.5f, 52.5f, 56.5f, 60.5f};

/* Touched blocks [begin, end) of sixteen block rows, in blocks from the image's left edge, within the splat's tiles. */
typedef struct block_rows {
    vf begin, end;
} block_rows;

LANES_INLINE block_rows find_rows(const adcgs_splat2d *s, const adcgs_outline *o, int tile_y)
{
    const vf zero = vf_set1(0.0f), ym = vf_set1(o->ym), y_right = vf_set1(o->y_right), y_left = vf_set1(-o->y_right);
    const vf top = vf_sub(vf_add(vf_load(row_centre), vf_set1(16.0f * (float)tile_y)), vf_set1(s->y));
    const vf bottom = vf_add(top, vf_set1(3.0f));
    const vm touched = vf_ge(ym, vf_max(top, vf_sub(zero, bottom)));
    const vf dy_right = vf_min(vf_max(y_right, top), bottom), dy_left = vf_min(vf_max(y_left, top), bottom);
    const vf yy = vf_mul(ym, ym), slope = vf_set1(o->slope), width = vf_set1(o->width);
    const vf reach_right = vf_sqrt(vf_max(vf_fnma(dy_right, dy_right, yy), zero));
    const vf reach_left = vf_sqrt(vf_max(vf_fnma(dy_left, dy_left, yy), zero));
    const vf right = vf_fma(width, reach_right, vf_mul(slope, dy_right));
    const vf left = vf_fnma(width, reach_left, vf_mul(slope, dy_left));
    const vf size = vf_max(vf_abs(left), vf_abs(right));
    const vf slack = vf_fma(vf_add(size, vf_set1(fabsf(s->x))), vf_set1(0x1p-20f), vf_set1(0x1p-5f));
    const vf begin = vf_mul(vf_add(vf_sub(left, slack), vf_set1(s->x + 0.5f)), vf_set1(0.25f));
    const vf end = vf_mul(vf_add(vf_add(right, slack), vf_set1(s->x + 3.5f)), vf_set1(0.25f));
    const vf first = vf_set1(4.0f * (float)s->tile[0]), last = vf_set1(4.0f * (float)s->tile[2]);
    return (block_rows){vf_min(vf_max(begin, first), last), vf_only(touched, vf_min(vf_max(end, first), last))};
}

/*
 * A group of 4x4 tiles has sixteen block rows of sixteen blocks. With the rows' bits as 16-bit words, four words are one row
 * of tiles. The mask of a tile consists of one hexadecimal digit of each word.
 */
#if ADCGS_LANES_ISA == 512
typedef struct bin_frame {
    __m512i offset[2]; /* tile numbers of a group's tiles from its first, at bit 16 */
} bin_frame;

static inline bin_frame bin_begin(int tiles_x)
{
    const __m512i column = _mm512_set_epi64(3, 2, 1, 0, 3, 2, 1, 0), row = _mm512_set_epi64(1, 1, 1, 1, 0, 0, 0, 0);
    const __m512i line = _mm512_set1_epi64(tiles_x);
    const __m512i first = _mm512_add_epi64(column, _mm512_mullo_epi64(row, line));
    const __m512i third = _mm512_add_epi64(first, _mm512_add_epi64(line, line));
    return (bin_frame){{_mm512_slli_epi64(first, 16), _mm512_slli_epi64(third, 16)}};
}

/* Masks of two rows of tiles; their words are in lanes 0-3 and 4-7. */
static inline __m512i tile_masks(__m512i words)
{
    const __m512i digit = _mm512_set_epi64(12, 8, 4, 0, 12, 8, 4, 0);
    __m512i x = _mm512_and_si512(_mm512_srlv_epi64(words, digit), _mm512_set1_epi64(0x000f000f000f000f));
    x = _mm512_or_si512(x, _mm512_srli_epi64(x, 12));
    x = _mm512_or_si512(x, _mm512_srli_epi64(x, 24));
    return _mm512_and_si512(x, _mm512_set1_epi64(0xffff));
}

static inline uint32_t emit(uint64_t *out, __m512i item, __m512i offset, __m512i masks)
{
    const __mmask8 hit = _mm512_test_epi64_mask(masks, masks);
    const __m512i items = _mm512_add_epi64(_mm512_add_epi64(item, offset), masks);
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi64(hit, items));
    return (uint32_t)__builtin_popcount(hit);
}

static inline uint32_t bin_group(const bin_frame *f, const block_rows *rows, int tile_rows, int x, uint64_t item, uint64_t *out)
{
    const __m512i zero = _mm512_setzero_si512(), sixteen = _mm512_set1_epi32(16), one = _mm512_set1_epi32(1);
    const __m512i at = _mm512_set1_epi32(4 * x);
    const __m512i b = _mm512_min_epi32(_mm512_max_epi32(_mm512_sub_epi32(_mm512_cvttps_epi32(rows->begin), at), zero), sixteen);
    const __m512i e = _mm512_min_epi32(_mm512_max_epi32(_mm512_sub_epi32(_mm512_cvttps_epi32(rows->end), at), zero), sixteen);
    const __mmask16 inside = (__mmask16)(tile_rows >= 4 ? 0xffff : (1 << 4 * tile_rows) - 1);
    const __mmask16 some = _mm512_mask_cmpgt_epi32_mask(inside, e, b);
    const __m512i bits = _mm512_maskz_sub_epi32(some, _mm512_sllv_epi32(one, e), _mm512_sllv_epi32(one, b));
    const __m512i words = _mm512_castsi256_si512(_mm512_cvtepi32_epi16(bits)), base = _mm512_set1_epi64((long long)item);
    const __m512i upper = _mm512_permutexvar_epi64(_mm512_set_epi64(1, 1, 1, 1, 0, 0, 0, 0), words);
    const __m512i lower = _mm512_permutexvar_epi64(_mm512_set_epi64(3, 3, 3, 3, 2, 2, 2, 2), words);
    const uint32_t n = emit(out, base, f->offset[0], tile_masks(upper));
    return n + emit(out + n, base, f->offset[1], tile_masks(lower));
}
#elif ADCGS_LANES_ISA == 256
typedef struct bin_frame {
    __m256i offset[4]; /* tile numbers of a row of four tiles from the group's first, at bit 16 */
} bin_frame;

static inline bin_frame bin_begin(int tiles_x)
{
    const __m256i column = _mm256_setr_epi64x(0, 1, 2, 3);
    bin_frame f;
    for (int row = 0; row < 4; row++)
        f.offset[row] = _mm256_slli_epi64(_mm256_add_epi64(column, _mm256_set1_epi64x((long long)row * tiles_x)), 16);
    return f;
}

/* Bits of eight rows of blocks. */
static inline __m256i row_bits(__m256 begin, __m256 end, int at)
{
    const __m256i zero = _mm256_setzero_si256(), sixteen = _mm256_set1_epi32(16), one = _mm256_set1_epi32(1);
    const __m256i from = _mm256_set1_epi32(at);
    const __m256i b = _mm256_min_epi32(_mm256_max_epi32(_mm256_sub_epi32(_mm256_cvttps_epi32(begin), from), zero), sixteen);
    const __m256i e = _mm256_min_epi32(_mm256_max_epi32(_mm256_sub_epi32(_mm256_cvttps_epi32(end), from), zero), sixteen);
    const __m256i bits = _mm256_sub_epi32(_mm256_sllv_epi32(one, e), _mm256_sllv_epi32(one, b));
    return _mm256_and_si256(bits, _mm256_cmpgt_epi32(e, b));
}

/* Masks of a row of four tiles. */
static inline __m256i tile_masks(long long words)
{
    __m256i x = _mm256_srlv_epi64(_mm256_set1_epi64x(words), _mm256_setr_epi64x(0, 4, 8, 12));
    x = _mm256_and_si256(x, _mm256_set1_epi64x(0x000f000f000f000f));
    x = _mm256_or_si256(x, _mm256_srli_epi64(x, 12));
    x = _mm256_or_si256(x, _mm256_srli_epi64(x, 24));
    return _mm256_and_si256(x, _mm256_set1_epi64x(0xffff));
}

static inline uint32_t emit(uint64_t *out, __m256i items, __m256i masks)
{
    /* The set bits of four, first to last, as indices of two 32-bit halves each. */
    static const uint32_t halves_of[16] = {0,    0x10,   0x32,   0x3210,   0x54,   0x5410,   0x5432,   0x543210,
                                           0x76, 0x7610, 0x7632, 0x763210, 0x7654, 0x765410, 0x765432, 0x76543210};
    const __m256i hits = _mm256_cmpgt_epi64(masks, _mm256_setzero_si256());
    const uint32_t hit = (uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(hits));
    const __m256i digits = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
    const __m256i from = _mm256_srlv_epi32(_mm256_set1_epi32((int)halves_of[hit]), digits);
    _mm256_storeu_si256((__m256i *)out, _mm256_permutevar8x32_epi32(_mm256_add_epi64(items, masks), from));
    return (uint32_t)__builtin_popcount(hit);
}

static inline uint32_t bin_group(const bin_frame *f, const block_rows *rows, int tile_rows, int x, uint64_t item, uint64_t *out)
{
    const __m256i packed =
        _mm256_packus_epi32(row_bits(rows->begin.a, rows->end.a, 4 * x), row_bits(rows->begin.b, rows->end.b, 4 * x));
    const __m256i base = _mm256_set1_epi64x((long long)item);
    alignas(32) long long words[4];
    uint32_t n = 0;
    _mm256_store_si256((__m256i *)words, _mm256_permute4x64_epi64(packed, 0xd8));
    for (int r = 0; r < 4 && r < tile_rows; r++)
        n += emit(out + n, _mm256_add_epi64(base, f->offset[r]), tile_masks(words[r]));
    return n;
}
#else
typedef struct bin_frame {
    int tiles_x;
} bin_frame;

static inline bin_frame bin_begin(int tiles_x)
{
    return (bin_frame){tiles_x};
}

/* The words of one row of tiles. */
static inline uint64_t row_words(const int32_t *begin, const int32_t *end, int at)
{
    uint64_t words = 0;
    for (int j = 0; j < 4; j++) {
        const int b = begin[j] - at < 0 ? 0 : begin[j] - at, e = end[j] - at > 16 ? 16 : end[j] - at;
        words |= (uint64_t)(e > b ? (1u << e) - (1u << b) : 0u) << 16 * j;
    }
    return words;
}

static inline uint32_t bin_group(const bin_frame *f, const block_rows *rows, int tile_rows, int x, uint64_t item, uint64_t *out)
{
    alignas(64) int32_t begin[16], end[16];
    uint32_t n = 0;
    vf_store_int(begin, rows->begin);
    vf_store_int(end, rows->end);
    for (int r = 0; r < 4 && r < tile_rows; r++) {
        const uint64_t words = row_words(begin + 4 * r, end + 4 * r, 4 * x);
        for (int t = 0; t < 4; t++) {
            uint64_t mask = words >> 4 * t & 0x000f000f000f000f;
            mask |= mask >> 12;
            mask = (mask | mask >> 24) & 0xffff;
            out[n] = item + ((uint64_t)(r * f->tiles_x + t) << 16) + mask;
            n += mask != 0;
        }
    }
    return n;
}
#endif

static inline uint32_t bin_splat(const bin_frame *f, const adcgs_splat2d *s, const adcgs_outline *o, uint32_t index, int tiles_x,
                                 uint64_t *out)
{
    uint32_t n = 0;
    for (int y = s->tile[1]; y < s->tile[3]; y += 4) {
        const block_rows rows = find_rows(s, o, y);
        for (int x = s->tile[0]; x < s->tile[2]; x += 4) {
            const uint64_t tile = (uint64_t)y * (uint64_t)tiles_x + (uint64_t)x;
            n += bin_group(f, &rows, s->tile[3] - y, x, (uint64_t)index << 36 | tile << 16, out + n);
        }
    }
    return n;
}

static uint32_t bin(const adcgs_bin_job *job, uint32_t begin, uint32_t end, uint32_t *counts, uint64_t *out)
{
    const bin_frame frame = bin_begin(job->tiles_x);
    uint32_t n = 0;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t source = (uint32_t)job->order[i];
        if (end - i > FETCH_AHEAD) {
            const uint32_t ahead = (uint32_t)job->order[i + FETCH_AHEAD];
            __builtin_prefetch(job->from + ahead);
            __builtin_prefetch(job->outlines + ahead);
        }
        job->to[i] = job->from[source];
        if (job->where) {
            job->first[i] = n;
            job->where[job->from[source].slot] = i;
        }
        n += bin_splat(&frame, job->from + source, job->outlines + source, i, job->tiles_x, out + n);
    }
    for (uint32_t i = 0; i < n; i++)
        counts[out[i] >> 16 & 0xfffff]++;
    return n;
}
