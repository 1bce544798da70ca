/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Loops of one kind of instruction, AVX2. */
#include "ceilings.h"

#include <immintrin.h>
#include <string.h>

#define LANES 8
#define F __m256
#define I __m256i
#define FMA _mm256_fmadd_ps
#define SPREAD _mm256_set1_ps
#define LOAD _mm256_load_ps
#define ADD _mm256_add_ps
#define ISPREAD _mm256_set1_epi16
#define IMADD _mm256_madd_epi16
#define IADD _mm256_add_epi32
#include "ceilings_kernels.h"

const bench_loops bench_loops_avx2 = {fma_loop, int16_loop, read_loop};
