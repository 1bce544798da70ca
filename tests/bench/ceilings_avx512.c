/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Loops of one kind of instruction, AVX-512. */
#include "ceilings.h"

#include <immintrin.h>
#include <string.h>

#define LANES 16
#define F __m512
#define I __m512i
#define FMA _mm512_fmadd_ps
#define SPREAD _mm512_set1_ps
#define LOAD _mm512_load_ps
#define ADD _mm512_add_ps
#define ISPREAD _mm512_set1_epi16
#define IMADD _mm512_madd_epi16
#define IADD _mm512_add_epi32
#include "ceilings_kernels.h"

const bench_loops bench_loops_avx512 = {fma_loop, int16_loop, read_loop};
