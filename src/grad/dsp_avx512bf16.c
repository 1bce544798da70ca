/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Layers of networks with bf16 factors and binary32 sums. The products of layers and of weight gradients share one kernel: rows
 * of pairs of factors by pairs of rows of 64 columns. A layer's pairs lie along its inputs, a weight gradient's along the lanes.
 */
#include "grad/dsp.h"

#include <immintrin.h>
#include <stdalign.h>

#define LANES ADCGS_LANES
#define INLINE static inline __attribute__((always_inline))

/*
 * ROWS, COLS: rows and vectors of columns whose sums stay in registers; PAIRS: pairs whose columns stay in the L1 cache.
 * Arithmetic of the 32 registers and of caches of 32 KB.
 */
enum { ROWS = 6, COLS = 4, VN = 16, PAIRS = 64, OUTPUTS = 256 };

/** A product's right side: pairs of rows of 64 columns. */
typedef struct columns {
    __m512i pair[PAIRS][COLS];
} columns;

/**
 * Its sums: in `to`, with rows ld apart and n columns in use. They start from `from`, else from bias, else from 0. If `in` is
 * given, the result is `in` plus the leaky ReLU of the sums, in rows of 64, and `below` marks negative sums.
 */
typedef struct sums {
    float *to;
    const float *from, *bias;
    size_t ld;
    int n;
    const float *in;
    uint64_t *below;
} sums;

static inline __mmask16 first_lanes(int n)
{
    return (__mmask16)(n >= VN ? 0xffff : n > 0 ? (1 << n) - 1 : 0);
}

static inline __m512 slope(__m512 x, __mmask16 below)
{
    return _mm512_mask_mul_ps(x, below, x, _mm512_set1_ps(0x1p-6f));
}

/* ---- The product ---- */

/** End of a residual layer, for one row. */
INLINE void store_residual(const sums *s, int r, const __m512 acc[COLS])
{
    uint64_t below = 0;
#pragma GCC unroll 4
    for (int c = 0; c < COLS; c++) {
        const size_t at = (size_t)r * LANES + (size_t)(c * VN);
        const __mmask16 negative = _mm512_cmp_ps_mask(acc[c], _mm512_setzero_ps(), _CMP_LT_OQ);
        _mm512_store_ps(s->to + at, _mm512_add_ps(_mm512_load_ps(s->in + at), slope(acc[c], negative)));
        below |= (uint64_t)negative << c * VN;
    }
    s->below[r] = below;
}

INLINE void store_sums(int cols, const sums *s, int r, const __m512 acc[COLS], __mmask16 last)
{
#pragma GCC unroll 4
    for (int c = 0; c < cols; c++)
        if (c < cols - 1 || last == 0xffff)
            _mm512_storeu_ps(s->to + (size_t)r * s->ld + c * VN, acc[c]);
        else
            _mm512_mask_storeu_ps(s->to + (size_t)r * s->ld + c * VN, last, acc[c]);
}

INLINE void product_tile(int rows, int cols, const sums *s, const uint32_t *a, size_t lda, const columns *b, int pairs)
{
    const __mmask16 last = first_lanes(s->n - (cols - 1) * VN);
    __m512 acc[ROWS][COLS];
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++)
#pragma GCC unroll 4
        for (int c = 0; c < cols; c++)
            acc[r][c] = s->from ? _mm512_maskz_loadu_ps(c < cols - 1 ? 0xffff : last, s->from + (size_t)r * s->ld + c * VN)
                                : _mm512_set1_ps(s->bias ? s->bias[r] : 0.0f);
    for (int p = 0; p < pairs; p++) {
        __m512i column[COLS];
#pragma GCC unroll 4
        for (int c = 0; c < cols; c++)
            column[c] = b->pair[p][c];
#pragma GCC unroll 6
        for (int r = 0; r < rows; r++) {
            const __m512i factor = _mm512_set1_epi32((int)a[(size_t)r * lda + (size_t)p]);
#pragma GCC unroll 4
            for (int c = 0; c < cols; c++)
                acc[r][c] = _mm512_dpbf16_ps(acc[r][c], (__m512bh)column[c], (__m512bh)factor);
        }
    }
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++)
        if (cols == COLS && s->in)
            store_residual(s, r, acc[r]);
        else
            store_sums(cols, s, r, acc[r], last);
}

INLINE void product_rows(int rows, const sums *s, const uint32_t *a, size_t lda, const columns *b, int pairs)
{
    switch ((s->n + VN - 1) / VN) {
    case 4:
        product_tile(rows, 4, s, a, lda, b, pairs);
        break;
    case 3:
        product_tile(rows, 3, s, a, lda, b, pairs);
        break;
    case 2:
        product_tile(rows, 2, s, a, lda, b, pairs);
        break;
    default:
        product_tile(rows, 1, s, a, lda, b, pairs);
        break;
    }
}

static void product(int rows, const sums *s, const uint32_t *a, size_t lda, const columns *b, int pairs)
{
    switch (rows) {
    case 6:
        product_rows(6, s, a, lda, b, pairs);
        break;
    case 5:
        product_rows(5, s, a, lda, b, pairs);
        break;
    case 4:
        product_rows(4, s, a, lda, b, pairs);
        break;
    case 3:
        product_rows(3, s, a, lda, b, pairs);
        break;
    case 2:
        product_rows(2, s, a, lda, b, pairs);
        break;
    default:
        product_rows(1, s, a, lda, b, pairs);
        break;
    }
}

/** Divides rows evenly: a rest of one or two rows would leave the multipliers idle. */
static int rows_next(int left)
{
    const int tiles = (left + ROWS - 1) / ROWS;
    return (left + tiles - 1) / tiles;
}

/** Prefetches rows of n numbers into the L1 cache (cache 1) or the L2 cache. */
INLINE void fetch(int cache, const float *from, size_t ld, int rows, int n)
{
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < n; c += VN)
            if (cache == 1)
                _mm_prefetch((const char *)(from + (size_t)r * ld + c), _MM_HINT_T0);
            else
                _mm_prefetch((const char *)(from + (size_t)r * ld + c), _MM_HINT_T1);
}

/* ---- Layers ---- */

/** Rounds 32 consecutive numbers. */
static inline __m512i pair_up(__m512 low, __m512 high)
{
    return (__m512i)_mm512_cvtne2ps_pbh(high, low);
}

/** Pairs of consecutive numbers of a row, padded with 0. */
static inline void pack_row(uint32_t *to, const float *from, int n)
{
    int i = 0;
    for (; i + 2 * VN <= n; i += 2 * VN)
        _mm512_store_si512(to + i / 2, pair_up(_mm512_loadu_ps(from + i), _mm512_loadu_ps(from + i + VN)));
    if (i < n)
        _mm512_store_si512(to + i / 2, pair_up(_mm512_maskz_loadu_ps(first_lanes(n - i), from + i),
                                               _mm512_maskz_loadu_ps(first_lanes(n - i - VN), from + i + VN)));
}

/** Pairs of consecutive rows of 64 lanes. */
static void pack_inputs(columns *to, const float *x, int n)
{
    const __m512i odd = _mm512_set1_epi32(16 << 16), low = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    const __m512i alternate = _mm512_add_epi32(_mm512_or_si512(low, _mm512_slli_epi32(low, 16)), odd);
    for (int i = 0; i < n; i += 2)
        for (int c = 0; c < COLS; c++) {
            const float *from = x + (size_t)i * LANES + c * VN;
            const __m512 next = i + 1 < n ? _mm512_load_ps(from + LANES) : _mm512_setzero_ps();
            const __m512i both = pair_up(_mm512_load_ps(from), next);
            to->pair[i / 2][c] = _mm512_permutexvar_epi16(alternate, both);
        }
}

/** Words of a packed row. */
static inline size_t words_of(int n)
{
    return ((size_t)n + 31) / 32 * 16;
}

/** Some rows of weights for the inputs from i on: in w, or in packed if it is not NULL. */
typedef struct weights {
    const float *w;
    size_t ldw;
    const uint32_t *packed;
} weights;

/** One layer. y: of its first row. soon: NULL, or 2 n_out rows of 64 to prefetch for the next step. */
static void layer(const sums *y, const weights *w, const float *x, int n_out, int n_in, const float *soon)
{
    alignas(64) uint32_t some[ROWS][PAIRS];
    const size_t words = words_of(n_in);
    columns inputs;
    const float *init = y->from;
    int i = 0;
    do {
        const int n = n_in - i < 2 * PAIRS ? n_in - i : 2 * PAIRS;
        pack_inputs(&inputs, x + (size_t)i * LANES, n);
        for (int o = 0, rows; o < n_out; o += rows) {
            const size_t at = (size_t)o * LANES;
            const int ends = y->in && i + n == n_in;
            const sums s = {y->to + at, init ? init + at : NULL,  y->bias ? y->bias + o : NULL, LANES,
                            LANES,      ends ? y->in + at : NULL, ends ? y->below + o : NULL};
            rows = rows_next(n_out - o);
            if (soon && i == 0)
                fetch(2, soon + 2 * at, LANES, 2 * rows, LANES);
            if (w->packed) {
                product(rows, &s, w->packed + (size_t)o * words + i / 2, words, &inputs, (n + 1) / 2);
                continue;
            }
            for (int r = 0; r < rows; r++)
                pack_row(some[r], w->w + (size_t)(o + r) * w->ldw + i, n);
            product(rows, &s, some[0], PAIRS, &inputs, (n + 1) / 2);
        }
        init = y->to;
        i += n;
    } while (i < n_in);
}

static void dense(float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x, int n_out, int n_in)
{
    layer(&(sums){y, init, bias, LANES, LANES, NULL, NULL}, &(weights){w, ldw, NULL}, x, n_out, n_in, NULL);
}

static void residual(const adcgs_train_dsp *dsp, float *h, uint64_t *below, const float *bias, const adcgs_square *w,
                     const float *x)
{
    layer(&(sums){h, NULL, bias, LANES, LANES, x, below}, &(weights){.packed = w->packed}, x, w->n, w->n, NULL);
}

static void residual_back(const adcgs_train_dsp *dsp, float *dx, float *dz, const uint64_t *below, const adcgs_square *turn,
                          const float *dh, const float *io)
{
    for (int i = 0; i < turn->n; i++)
        for (int c = 0; c < COLS; c++) {
            const size_t at = (size_t)i * LANES + (size_t)(c * VN);
            _mm512_store_ps(dz + at, slope(_mm512_load_ps(dh + at), (__mmask16)(below[i] >> c * VN)));
        }
    layer(&(sums){dx, dh, NULL, LANES, LANES, NULL, NULL}, &(weights){.packed = turn->packed}, dz, turn->n, turn->n, io);
}

static void pack(uint32_t *to, const float *w, int n)
{
    for (int o = 0; o < n; o++)
        pack_row(to + (size_t)o * words_of(n), w + (size_t)o * (size_t)n, n);
}

/* ---- Weight gradients ---- */

/** Transposes 16 rows of 16. Each round interleaves halves of the matrix. */
INLINE void turn(__m512i r[VN])
{
    const __m512i low = _mm512_set_epi32(23, 7, 22, 6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
    const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
#pragma GCC unroll 4
    for (int round = 0; round < 4; round++) {
        __m512i s[VN];
#pragma GCC unroll 8
        for (int i = 0; i < VN / 2; i++) {
            s[2 * i] = _mm512_permutex2var_epi32(r[i], low, r[i + VN / 2]);
            s[2 * i + 1] = _mm512_permutex2var_epi32(r[i], high, r[i + VN / 2]);
        }
#pragma GCC unroll 16
        for (int i = 0; i < VN; i++)
            r[i] = s[i];
    }
}

/** Pairs of lanes, each with up to 64 inputs; the columns after them are unused. */
static void turn_inputs(columns *to, const float *x, int n)
{
    for (int c = 0; c * VN < n; c++)
        for (int half = 0; half < 2; half++) {
            __m512i r[VN];
#pragma GCC unroll 16
            for (int i = 0; i < VN; i++) {
                const float *from = x + (size_t)ADCGS_MIN(c * VN + i, n - 1) * LANES + half * 2 * VN;
                r[i] = pair_up(_mm512_load_ps(from), _mm512_load_ps(from + VN));
            }
            turn(r);
#pragma GCC unroll 16
            for (int i = 0; i < VN; i++)
                to->pair[half * VN + i][c] = r[i];
        }
}

/** Gradients of rows of weights, and of biases, from the lanes of one tile. */
static void tile_grad(float *gw, size_t ldg, float *gb, const float *dy, const float *x, int n_out, int n_in)
{
    alignas(64) uint32_t factors[OUTPUTS][LANES / 2];
    columns inputs;
    for (int o = 0; o < n_out; o++)
        pack_row(factors[o], dy + (size_t)o * LANES, LANES);
    for (int i = 0; i < n_in; i += LANES) {
        turn_inputs(&inputs, x + (size_t)i * LANES, n_in - i < LANES ? n_in - i : LANES);
        for (int o = 0, rows; o < n_out; o += rows) {
            float *at = gw + (size_t)o * ldg + i;
            const sums s = {at, at, NULL, ldg, n_in - i < LANES ? n_in - i : LANES, NULL, NULL};
            rows = rows_next(n_out - o);
            if (o + rows < n_out)
                fetch(1, at + (size_t)rows * ldg, ldg, rows_next(n_out - o - rows), s.n);
            product(rows, &s, factors[o], LANES / 2, &inputs, LANES / 2);
        }
    }
    for (int o = 0; gb && o < n_out; o++) {
        const float *d = dy + (size_t)o * LANES;
        const __m512 low = _mm512_add_ps(_mm512_load_ps(d), _mm512_load_ps(d + VN));
        const __m512 high = _mm512_add_ps(_mm512_load_ps(d + 2 * VN), _mm512_load_ps(d + 3 * VN));
        gb[o] += _mm512_reduce_add_ps(_mm512_add_ps(low, high));
    }
}

static void weight_grad(float *gw, size_t ldg, float *gb, const float *dy, size_t sy, const float *x, size_t sx, int tiles,
                        int n_out, int n_in)
{
    for (int t = 0; t < tiles; t++, dy += sy, x += sx)
        for (int o = 0; o < n_out; o += OUTPUTS)
            tile_grad(gw + (size_t)o * ldg, ldg, gb ? gb + o : NULL, dy + (size_t)o * LANES, x,
                      n_out - o < OUTPUTS ? n_out - o : OUTPUTS, n_in);
}

void adcgs_train_dsp_init_avx512bf16(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx512bf16(adcgs_train_dsp *dsp)
{
    dsp->dense.dense = dense;
    dsp->residual = residual;
    dsp->residual_back = residual_back;
    dsp->pack = pack;
    dsp->weight_grad = weight_grad;
}
