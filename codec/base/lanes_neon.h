/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sixteen lanes in four NEON registers, which every 64-bit ARM has; see lanes.h. */
#include <arm_neon.h>

typedef struct vf {
    float32x4_t v[4];
} vf;
typedef struct vm {
    uint32x4_t v[4];
} vm;

#define LANES_EACH for (int i = 0; i < 4; i++)

#define LANES_UNARY(name, expression) \
    LANES_INLINE vf name(vf a)        \
    {                                 \
        vf r;                         \
        LANES_EACH r.v[i] = expression; \
        return r;                     \
    }
#define LANES_BINARY(name, type, expression) \
    LANES_INLINE type name(vf a, vf b)       \
    {                                        \
        type r;                              \
        LANES_EACH r.v[i] = expression;      \
        return r;                            \
    }

LANES_BINARY(vf_add, vf, vaddq_f32(a.v[i], b.v[i]))
LANES_BINARY(vf_sub, vf, vsubq_f32(a.v[i], b.v[i]))
LANES_BINARY(vf_mul, vf, vmulq_f32(a.v[i], b.v[i]))
LANES_BINARY(vf_div, vf, vdivq_f32(a.v[i], b.v[i]))
/* Not vminq_f32() and vmaxq_f32(), whose rules for NaN and zeros differ. */
LANES_BINARY(vf_min, vf, vbslq_f32(vcltq_f32(a.v[i], b.v[i]), a.v[i], b.v[i]))
LANES_BINARY(vf_max, vf, vbslq_f32(vcgtq_f32(a.v[i], b.v[i]), a.v[i], b.v[i]))
LANES_BINARY(vf_ge, vm, vcgeq_f32(a.v[i], b.v[i]))
LANES_UNARY(vf_sqrt, vsqrtq_f32(a.v[i]))
LANES_UNARY(vf_abs, vabsq_f32(a.v[i]))

LANES_INLINE uint32x4_t lanes_bits(float32x4_t x) { return vreinterpretq_u32_f32(x); }
LANES_INLINE float32x4_t lanes_number(uint32x4_t x) { return vreinterpretq_f32_u32(x); }

LANES_BINARY(vf_scale2, vf, lanes_number(vaddq_u32(lanes_bits(a.v[i]), vshlq_n_u32(lanes_bits(b.v[i]), 23))))

LANES_INLINE vf vf_set1(float x)
{
    vf r;
    LANES_EACH r.v[i] = vdupq_n_f32(x);
    return r;
}

LANES_INLINE vf vf_load(const float *p)
{
    vf r;
    LANES_EACH r.v[i] = vld1q_f32(p + 4 * i);
    return r;
}

LANES_INLINE void vf_store(float *p, vf a)
{
    LANES_EACH vst1q_f32(p + 4 * i, a.v[i]);
}

LANES_INLINE vf vf_load_once(const float *p) { return vf_load(p); }
LANES_INLINE vf vf_loadu(const float *p) { return vf_load(p); }
LANES_INLINE void vf_storeu(float *p, vf a) { vf_store(p, a); }

LANES_INLINE vf vf_fma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = vfmaq_f32(c.v[i], a.v[i], b.v[i]);
    return r;
}

LANES_INLINE vf vf_fnma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = vfmsq_f32(c.v[i], a.v[i], b.v[i]);
    return r;
}

LANES_INLINE int vm_any(vm m)
{
    return vmaxvq_u32(vorrq_u32(vorrq_u32(m.v[0], m.v[1]), vorrq_u32(m.v[2], m.v[3]))) != 0;
}

LANES_INLINE vf vf_only(vm m, vf a)
{
    vf r;
    LANES_EACH r.v[i] = lanes_number(vandq_u32(m.v[i], lanes_bits(a.v[i])));
    return r;
}

LANES_INLINE vf vf_fma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = vbslq_f32(m.v[i], vfmaq_f32(c.v[i], a.v[i], b.v[i]), c.v[i]);
    return r;
}

LANES_INLINE vf vf_fnma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = vbslq_f32(m.v[i], vfmsq_f32(c.v[i], a.v[i], b.v[i]), c.v[i]);
    return r;
}

LANES_INLINE void vf_store_int(int32_t *p, vf a)
{
    LANES_EACH vst1q_s32(p + 4 * i, vcvtq_s32_f32(a.v[i]));
}

LANES_INLINE void vf_store_rows(float *const row[4], vf a)
{
    LANES_EACH vst1q_f32(row[i], a.v[i]);
}

LANES_INLINE vf vf_load_rows(const float *p, size_t stride)
{
    vf r;
    LANES_EACH r.v[i] = vld1q_f32(p + (size_t)i * stride);
    return r;
}

LANES_INLINE vf vf_next(vf a)
{
    vf r;
    LANES_EACH r.v[i] = vextq_f32(a.v[i], i < 3 ? a.v[i + 1] : vdupq_n_f32(0.0f), 1);
    return r;
}

LANES_INLINE vf vf_before(vf a)
{
    vf r;
    LANES_EACH r.v[i] = vextq_f32(i > 0 ? a.v[i - 1] : vdupq_n_f32(0.0f), a.v[i], 3);
    return r;
}

LANES_INLINE void vf_turn_squares(vf r[4])
{
    LANES_EACH {
        const float32x4x2_t a = vzipq_f32(r[0].v[i], r[2].v[i]), b = vzipq_f32(r[1].v[i], r[3].v[i]);
        const float32x4x2_t c = vzipq_f32(a.val[0], b.val[0]), d = vzipq_f32(a.val[1], b.val[1]);
        r[0].v[i] = c.val[0];
        r[1].v[i] = c.val[1];
        r[2].v[i] = d.val[0];
        r[3].v[i] = d.val[1];
    }
}

/* Lanes 0 and 2, and lanes 1 and 3, of the four registers' sum. */
LANES_INLINE float32x2_t lanes_halves(vf x)
{
    const float32x4_t s = vaddq_f32(vaddq_f32(x.v[0], x.v[2]), vaddq_f32(x.v[1], x.v[3]));
    return vadd_f32(vget_low_f32(s), vget_high_f32(s));
}

/* See lanes_avx512.h. */
LANES_INLINE void vf_sums(float *out, const vf v[12])
{
    for (int c = 0; c < 4; c++)
        vst1q_f32(out + 4 * c, vcombine_f32(vpadd_f32(lanes_halves(v[c]), lanes_halves(v[4 + c])),
                                            vpadd_f32(lanes_halves(v[8 + c]), vdup_n_f32(0.0f))));
}
