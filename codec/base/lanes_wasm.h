/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sixteen lanes in four registers of WebAssembly's SIMD; see lanes.h. Operations for the trainer alone are absent. */
#include "base/fma_wasm.h"

typedef struct vf {
    v128_t v[4];
} vf;
typedef struct vm {
    v128_t v[4];
} vm;

#define LANES_EACH for (int i = 0; i < 4; i++)

#define LANES_UNARY(name, expression)   \
    LANES_INLINE vf name(vf a)          \
    {                                   \
        vf r;                           \
        LANES_EACH r.v[i] = expression; \
        return r;                       \
    }
#define LANES_BINARY(name, type, expression) \
    LANES_INLINE type name(vf a, vf b)       \
    {                                        \
        type r;                              \
        LANES_EACH r.v[i] = expression;      \
        return r;                            \
    }

LANES_BINARY(vf_add, vf, wasm_f32x4_add(a.v[i], b.v[i]))
LANES_BINARY(vf_sub, vf, wasm_f32x4_sub(a.v[i], b.v[i]))
LANES_BINARY(vf_mul, vf, wasm_f32x4_mul(a.v[i], b.v[i]))
LANES_BINARY(vf_div, vf, wasm_f32x4_div(a.v[i], b.v[i]))
/* These instructions return the second operand if it is smaller (larger), else the first. */
LANES_BINARY(vf_min, vf, wasm_f32x4_pmin(b.v[i], a.v[i]))
LANES_BINARY(vf_max, vf, wasm_f32x4_pmax(b.v[i], a.v[i]))
LANES_BINARY(vf_ge, vm, wasm_f32x4_ge(a.v[i], b.v[i]))
LANES_BINARY(vf_scale2, vf, wasm_i32x4_add(a.v[i], wasm_i32x4_shl(b.v[i], 23)))
LANES_UNARY(vf_sqrt, wasm_f32x4_sqrt(a.v[i]))
LANES_UNARY(vf_abs, wasm_f32x4_abs(a.v[i]))

LANES_INLINE vf vf_set1(float x)
{
    vf r;
    LANES_EACH r.v[i] = wasm_f32x4_splat(x);
    return r;
}

LANES_INLINE vf vf_load(const float *p)
{
    vf r;
    LANES_EACH r.v[i] = wasm_v128_load(p + 4 * i);
    return r;
}

LANES_INLINE void vf_store(float *p, vf a)
{
    LANES_EACH wasm_v128_store(p + 4 * i, a.v[i]);
}

LANES_INLINE vf vf_loadu(const float *p) { return vf_load(p); }
LANES_INLINE void vf_storeu(float *p, vf a) { vf_store(p, a); }

LANES_INLINE vf vf_fma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = adcgs_fma4(a.v[i], b.v[i], c.v[i]);
    return r;
}

LANES_INLINE vf vf_fnma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = adcgs_fma4(wasm_f32x4_neg(a.v[i]), b.v[i], c.v[i]);
    return r;
}

LANES_INLINE int vm_any(vm m)
{
    return wasm_v128_any_true(wasm_v128_or(wasm_v128_or(m.v[0], m.v[1]), wasm_v128_or(m.v[2], m.v[3])));
}

LANES_INLINE vf vf_only(vm m, vf a)
{
    vf r;
    LANES_EACH r.v[i] = wasm_v128_and(m.v[i], a.v[i]);
    return r;
}

LANES_INLINE vf vf_fma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = wasm_v128_bitselect(adcgs_fma4(a.v[i], b.v[i], c.v[i]), c.v[i], m.v[i]);
    return r;
}

LANES_INLINE vf vf_fnma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = wasm_v128_bitselect(adcgs_fma4(wasm_f32x4_neg(a.v[i]), b.v[i], c.v[i]), c.v[i], m.v[i]);
    return r;
}

LANES_INLINE void vf_store_int(int32_t *p, vf a)
{
    LANES_EACH wasm_v128_store(p + 4 * i, wasm_i32x4_trunc_sat_f32x4(a.v[i]));
}

LANES_INLINE void vf_store_rows(float *const row[4], vf a)
{
    LANES_EACH wasm_v128_store(row[i], a.v[i]);
}
