/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the vector dense kernels. The including file defines the vector
 * type V, its width VW, the columns of a register tile COLS (COLS*VW divides
 * 64) and the operations LOAD, STORE, SPREAD, FMADD, ADDV, LRELU.
 *
 * A tile of up to six rows by COLS vectors stays in registers during the loop
 * over all inputs, so each output is one chain of fused multiply-adds in input
 * order.
 */
#define ROWS_MAX 6
#define INLINE static inline __attribute__((always_inline))

INLINE void dense_tile(int rows, float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x,
                       int n_in)
{
    V acc[ROWS_MAX][COLS];
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++)
#pragma GCC unroll 4
        for (int c = 0; c < COLS; c++)
            acc[r][c] = init ? LOAD(init + r * ADCGS_LANES + c * VW) : SPREAD(bias ? bias[r] : 0.0f);
    for (int i = 0; i < n_in; i++) {
        V in[COLS];
#pragma GCC unroll 4
        for (int c = 0; c < COLS; c++)
            in[c] = LOAD(x + (size_t)i * ADCGS_LANES + c * VW);
#pragma GCC unroll 6
        for (int r = 0; r < rows; r++) {
            const V weight = SPREAD(w[(size_t)r * ldw + (size_t)i]);
#pragma GCC unroll 4
            for (int c = 0; c < COLS; c++)
                acc[r][c] = FMADD(weight, in[c], acc[r][c]);
        }
    }
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++)
#pragma GCC unroll 4
        for (int c = 0; c < COLS; c++)
            STORE(y + r * ADCGS_LANES + c * VW, acc[r][c]);
}

static void dense_rows(int rows, float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x,
                       int n_in)
{
    for (int lane = 0; lane < ADCGS_LANES; lane += COLS * VW) {
        float *out = y + lane;
        const float *start = init ? init + lane : NULL;
        switch (rows) {
        case 6:
            dense_tile(6, out, start, bias, w, ldw, x + lane, n_in);
            break;
        case 5:
            dense_tile(5, out, start, bias, w, ldw, x + lane, n_in);
            break;
        case 4:
            dense_tile(4, out, start, bias, w, ldw, x + lane, n_in);
            break;
        case 3:
            dense_tile(3, out, start, bias, w, ldw, x + lane, n_in);
            break;
        case 2:
            dense_tile(2, out, start, bias, w, ldw, x + lane, n_in);
            break;
        default:
            dense_tile(1, out, start, bias, w, ldw, x + lane, n_in);
            break;
        }
    }
}

/* Distribute the rows evenly over tiles: a remainder of one or two rows would leave the multipliers idle. */
static void dense(float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x, int n_out, int n_in)
{
    const int tiles = (n_out + ROWS_MAX - 1) / ROWS_MAX;
    int row = 0;
    for (int t = 0; t < tiles; t++) {
        const int rows = (n_out - row + tiles - t - 1) / (tiles - t);
        const size_t at = (size_t)row * ADCGS_LANES;
        dense_rows(rows, y + at, init ? init + at : NULL, bias ? bias + row : NULL, w + (size_t)row * ldw, ldw, x, n_in);
        row += rows;
    }
}

static void lrelu(float *y, int n)
{
    for (size_t i = 0; i < (size_t)n * ADCGS_LANES; i += VW)
        STORE(y + i, LRELU(LOAD(y + i)));
}

static void residual(float *y, const float *x, int n)
{
    for (size_t i = 0; i < (size_t)n * ADCGS_LANES; i += VW)
        STORE(y + i, ADDV(LOAD(x + i), LRELU(LOAD(y + i))));
}
