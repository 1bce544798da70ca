/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the vector loops. The including file defines vectors F of floats and I of 16-bit integers, the number LANES of floats
 * in one, and the operations FMA, SPREAD, LOAD, ADD, ISPREAD, IMADD (products of neighbours, added in pairs) and IADD.
 * Enough independent chains hide the latency of an instruction.
 */
enum { CHAINS = 10, READS = 8 };

static double sum_of(F v)
{
    float lanes[LANES], sum = 0;
    memcpy(lanes, &v, sizeof lanes);
    for (int i = 0; i < LANES; i++)
        sum += lanes[i];
    return (double)sum;
}

static double fma_loop(int times, double *operations)
{
    F chain[CHAINS];
    const F by = SPREAD(0.999f), plus = SPREAD(0.5f);
#pragma GCC unroll 10
    for (int c = 0; c < CHAINS; c++)
        chain[c] = SPREAD((float)c);
    for (int i = 0; i < times; i++)
#pragma GCC unroll 10
        for (int c = 0; c < CHAINS; c++)
            chain[c] = FMA(chain[c], by, plus);
    double sum = 0;
#pragma GCC unroll 10
    for (int c = 0; c < CHAINS; c++)
        sum += sum_of(chain[c]);
    *operations = 2.0 * CHAINS * LANES * times;
    return sum;
}

static double int16_loop(int times, double *operations)
{
    I chain[CHAINS];
    const I by = ISPREAD(3);
    int32_t lanes[LANES];
#pragma GCC unroll 10
    for (int c = 0; c < CHAINS; c++)
        chain[c] = ISPREAD((int16_t)(c + 1));
    for (int i = 0; i < times; i++)
#pragma GCC unroll 10
        for (int c = 0; c < CHAINS; c++)
            chain[c] = IADD(chain[c], IMADD(chain[c], by));
    double sum = 0;
    for (int c = 0; c < CHAINS; c++) {
        memcpy(lanes, &chain[c], sizeof lanes);
        for (int i = 0; i < LANES; i++)
            sum += lanes[i];
    }
    *operations = 4.0 * CHAINS * LANES * times;
    return sum;
}

static double read_loop(const float *from, size_t n)
{
    F sum[READS];
#pragma GCC unroll 8
    for (int j = 0; j < READS; j++)
        sum[j] = SPREAD(0);
    for (size_t i = 0; i < n; i += READS * LANES)
#pragma GCC unroll 8
        for (size_t j = 0; j < READS; j++)
            sum[j] = ADD(sum[j], LOAD(from + i + j * LANES));
    double all = 0;
#pragma GCC unroll 8
    for (int j = 0; j < READS; j++)
        all += sum_of(sum[j]);
    return all;
}
