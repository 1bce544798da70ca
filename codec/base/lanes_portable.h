/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sixteen lanes in portable C, the reference of the other variants; see lanes.h. */

typedef struct vf {
    float v[16];
} vf;
typedef struct vm {
    uint8_t v[16];
} vm;

#define LANES_EACH for (int i = 0; i < 16; i++)

#define LANES_UNARY(name, type, expression) \
    LANES_INLINE type name(vf a)            \
    {                                       \
        type r;                             \
        LANES_EACH r.v[i] = expression;     \
        return r;                           \
    }
#define LANES_BINARY(name, type, expression) \
    LANES_INLINE type name(vf a, vf b)       \
    {                                        \
        type r;                              \
        LANES_EACH r.v[i] = expression;      \
        return r;                            \
    }

LANES_BINARY(vf_add, vf, a.v[i] + b.v[i])
LANES_BINARY(vf_sub, vf, a.v[i] - b.v[i])
LANES_BINARY(vf_mul, vf, a.v[i] * b.v[i])
LANES_BINARY(vf_div, vf, a.v[i] / b.v[i])
LANES_BINARY(vf_min, vf, a.v[i] < b.v[i] ? a.v[i] : b.v[i])
LANES_BINARY(vf_max, vf, a.v[i] > b.v[i] ? a.v[i] : b.v[i])
LANES_BINARY(vf_ge, vm, (uint8_t)(a.v[i] >= b.v[i]))
LANES_BINARY(vf_scale2, vf, adcgs_scale2(a.v[i], b.v[i]))
LANES_UNARY(vf_sqrt, vf, sqrtf(a.v[i]))
LANES_UNARY(vf_abs, vf, fabsf(a.v[i]))

LANES_INLINE vf vf_set1(float x)
{
    vf r;
    LANES_EACH r.v[i] = x;
    return r;
}

LANES_INLINE vf vf_load(const float *p)
{
    vf r;
    memcpy(r.v, p, sizeof r.v);
    return r;
}

LANES_INLINE void vf_store(float *p, vf a)
{
    memcpy(p, a.v, sizeof a.v);
}

LANES_INLINE vf vf_load_once(const float *p) { return vf_load(p); }
LANES_INLINE vf vf_loadu(const float *p) { return vf_load(p); }
LANES_INLINE void vf_storeu(float *p, vf a) { vf_store(p, a); }

LANES_INLINE vf vf_fma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = fmaf(a.v[i], b.v[i], c.v[i]);
    return r;
}

LANES_INLINE vf vf_fnma(vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = fmaf(-a.v[i], b.v[i], c.v[i]);
    return r;
}

LANES_INLINE int vm_any(vm m)
{
    int any = 0;
    LANES_EACH any |= m.v[i];
    return any;
}

LANES_INLINE vf vf_only(vm m, vf a)
{
    vf r;
    LANES_EACH r.v[i] = m.v[i] ? a.v[i] : 0.0f;
    return r;
}

LANES_INLINE vf vf_fma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = m.v[i] ? fmaf(a.v[i], b.v[i], c.v[i]) : c.v[i];
    return r;
}

LANES_INLINE vf vf_fnma_where(vm m, vf a, vf b, vf c)
{
    vf r;
    LANES_EACH r.v[i] = m.v[i] ? fmaf(-a.v[i], b.v[i], c.v[i]) : c.v[i];
    return r;
}

LANES_INLINE void vf_store_int(int32_t *p, vf a)
{
    LANES_EACH p[i] = (int32_t)a.v[i];
}

LANES_INLINE void vf_store_rows(float *const row[4], vf a)
{
    for (int i = 0; i < 4; i++)
        memcpy(row[i], a.v + 4 * i, 4 * sizeof(float));
}

LANES_INLINE vf vf_load_rows(const float *p, size_t stride)
{
    vf r;
    for (size_t i = 0; i < 4; i++)
        memcpy(r.v + 4 * i, p + i * stride, 4 * sizeof(float));
    return r;
}

LANES_UNARY(vf_next, vf, i < 15 ? a.v[i + 1] : 0.0f)
LANES_UNARY(vf_before, vf, i > 0 ? a.v[i - 1] : 0.0f)

LANES_INLINE void vf_turn_squares(vf r[4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++)
            for (int k = 0; k < 16; k += 4) {
                const float keep = r[i].v[k + j];
                r[i].v[k + j] = r[j].v[k + i];
                r[j].v[k + i] = keep;
            }
}

/* See lanes_avx512.h. */
LANES_INLINE void vf_sums(float *out, const vf v[12])
{
    for (int i = 0; i < 16; i++)
        out[i] = 0.0f;
    for (int i = 0; i < 12; i++) {
        vf x = v[i];
        for (int width = 8; width; width /= 2)
            for (int j = 0; j < width; j++)
                x.v[j] += x.v[j + width];
        out[4 * (i & 3) + i / 4] = x.v[0];
    }
}
