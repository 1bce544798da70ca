/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Dense layers on WebAssembly, 4 lanes per vector. */
#include "base/fma_wasm.h"
#include "splat/dense_isa.h"

#define V v128_t
#define VW 4
#define COLS 2
#define LOAD wasm_v128_load
#define STORE wasm_v128_store
#define SPREAD wasm_f32x4_splat
#define FMADD adcgs_fma4
#define ADDV wasm_f32x4_add
#define LRELU lrelu_vector

static inline v128_t lrelu_vector(v128_t v)
{
    const v128_t negative = wasm_f32x4_lt(v, wasm_f32x4_splat(0.0f));
    return wasm_v128_bitselect(wasm_f32x4_mul(v, wasm_f32x4_splat(0x1p-6f)), v, negative);
}

#include "splat/dense_kernels.h"

const adcgs_dense_dsp adcgs_dense_wasm = {dense, lrelu, residual};
