/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bodies of the trainer's kernels. Included once per CPU level by a file that defines ISA(name) and is compiled with that level's
 * flags. The 64-lane loops are written for the compiler's vectoriser, the weight gradient by hand.
 */
#include "base/fmath.h"
#include "grad/dsp.h"
#include "grad/random.h"
#include "model/model.h"

#include <math.h>
#include <stdalign.h>

#define LANES ADCGS_LANES

/* ---- Weight gradients ---- */
#if defined(__AVX512F__)
#include <immintrin.h>
typedef __m512 vec;
#define VN 16
#define vzero _mm512_setzero_ps
#define vspread _mm512_set1_ps
#define vload _mm512_load_ps
#define vloadu _mm512_loadu_ps
#define vstoreu _mm512_storeu_ps
#define vfma _mm512_fmadd_ps
#define vadd _mm512_add_ps
#define vbelow(x) ((uint64_t)_mm512_cmp_ps_mask(x, _mm512_setzero_ps(), _CMP_LT_OQ))
#define vslope(x, below) _mm512_mask_mul_ps(x, (__mmask16)(below), x, _mm512_set1_ps(0x1p-6f))
#elif defined(__AVX2__)
#include <immintrin.h>
typedef __m256 vec;
#define VN 8
#define vzero _mm256_setzero_ps
#define vspread _mm256_set1_ps
#define vload _mm256_load_ps
#define vloadu _mm256_loadu_ps
#define vstoreu _mm256_storeu_ps
#define vfma _mm256_fmadd_ps
#define vadd _mm256_add_ps
#define vbelow(x) ((uint64_t)_mm256_movemask_ps(_mm256_cmp_ps(x, _mm256_setzero_ps(), _CMP_LT_OQ)))
static inline vec vslope(vec x, uint64_t below)
{
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)(uint32_t)below), lane), lane);
    return _mm256_blendv_ps(x, _mm256_mul_ps(x, _mm256_set1_ps(0x1p-6f)), _mm256_castsi256_ps(set));
}
#else
typedef float vec;
#define VN 1
#define vzero() 0.0f
#define vspread(x) (x)
#define vload(p) (*(p))
#define vloadu(p) (*(p))
#define vstoreu(p, x) (*(p) = (x))
#define vfma(a, b, c) ((a) * (b) + (c))
#define vadd(a, b) ((a) + (b))
#define vbelow(x) ((uint64_t)((x) < 0))
/* clang-format off */
#define vslope(x, below) ((below) & 1 ? (x) * 0x1p-6f : (x))
/* clang-format on */
#endif

/* Outputs and vectors of inputs whose products stay in registers during the loop over lanes. */
enum { TILE_O = 6, TILE_V = VN == 16 ? 4 : 2, TILE_I = TILE_V * VN };

#if VN > 1
/** Transposes n of eight rows of eight lanes; the other rows count as 0. */
static inline __attribute__((always_inline)) void turn_eight(float *to, const float *from, int n)
{
    for (int half = 0; half < 2; half++, from += 4, to += 4 * TILE_I) {
        __m256 r[4];
#pragma GCC unroll 4
        for (int i = 0; i < 4; i++) {
            const __m128 low = i < n ? _mm_load_ps(from + i * LANES) : _mm_setzero_ps();
            const __m128 high = i + 4 < n ? _mm_load_ps(from + (i + 4) * LANES) : _mm_setzero_ps();
            r[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(low), high, 1);
        }
        const __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
        const __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
        _mm256_store_ps(to, _mm256_shuffle_ps(a, c, 0x44));
        _mm256_store_ps(to + TILE_I, _mm256_shuffle_ps(a, c, 0xee));
        _mm256_store_ps(to + 2 * TILE_I, _mm256_shuffle_ps(b, d, 0x44));
        _mm256_store_ps(to + 3 * TILE_I, _mm256_shuffle_ps(b, d, 0xee));
    }
}

/** to[lane][input] of n inputs from x[input][lane]; the last vector's other inputs are 0. */
static void turn(float to[LANES][TILE_I], const float *x, int n)
{
    for (int i = 0; i < (n + VN - 1) / VN * VN; i += 8)
        for (int l = 0; l < LANES; l += 8)
            if (n - i >= 8)
                turn_eight(&to[l][i], x + (size_t)i * LANES + l, 8);
            else
                turn_eight(&to[l][i], x + (size_t)i * LANES + l, n - i);
}

/** Adds to gb[n], up to eight, the sums over lanes of dy[n][64]. */
static inline __attribute__((always_inline)) void sum_lanes(float *gb, const float *dy, int n)
{
    __m256 row[8] = {_mm256_setzero_ps()}, half[4];
    float sums[8];
    for (int l = 0; l < LANES; l += 8)
#pragma GCC unroll 8
        for (int i = 0; i < 8; i++)
            if (i < n)
                row[i] = _mm256_add_ps(row[i], _mm256_load_ps(dy + i * LANES + l));
#pragma GCC unroll 4
    for (int i = 0; i < 4; i++)
        half[i] =
            _mm256_add_ps(_mm256_permute2f128_ps(row[i], row[i + 4], 0x20), _mm256_permute2f128_ps(row[i], row[i + 4], 0x31));
    _mm256_storeu_ps(sums, _mm256_hadd_ps(_mm256_hadd_ps(half[0], half[1]), _mm256_hadd_ps(half[2], half[3])));
    for (int i = 0; i < n; i++)
        gb[i] += sums[i];
}

static void bias_grad(float *gb, const float *dy, int n)
{
    for (; n >= 8; n -= 8, gb += 8, dy += 8 * LANES)
        sum_lanes(gb, dy, 8);
    if (n)
        sum_lanes(gb, dy, n);
}
#else
static void turn(float to[LANES][TILE_I], const float *x, int n)
{
    for (int l = 0; l < LANES; l++)
        for (int i = 0; i < n; i++)
            to[l][i] = x[(size_t)i * LANES + (size_t)l];
}

static void bias_grad(float *gb, const float *dy, int n)
{
    for (int o = 0; o < n; o++) {
        float sum = 0;
        for (int l = 0; l < LANES; l++)
            sum += dy[o * LANES + l];
        gb[o] += sum;
    }
}
#endif

/** Gradients of `no` weight rows, ni of each in nv vectors, from lanes of their outputs dy[no][64] and inputs xt[64][TILE_I]. */
static inline __attribute__((always_inline)) void weight_tile(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I],
                                                              int no, int nv, int ni)
{
    vec acc[TILE_O][TILE_V];
    for (int o = 0; o < no; o++)
        for (int v = 0; v < nv; v++)
            acc[o][v] = vzero();
    for (int l = 0; l < LANES; l++) {
        vec x[TILE_V];
        for (int v = 0; v < nv; v++)
            x[v] = vload(xt[l] + v * VN);
#pragma GCC unroll 6
        for (int o = 0; o < no; o++) {
            const vec d = vspread(dy[o * LANES + l]);
#pragma GCC unroll 4
            for (int v = 0; v < nv; v++)
                acc[o][v] = vfma(d, x[v], acc[o][v]);
        }
    }
#pragma GCC unroll 6
    for (int o = 0; o < no; o++, gw += ldg) {
        float rest[VN];
#pragma GCC unroll 4
        for (int v = 0; v < nv; v++)
            if ((v + 1) * VN <= ni)
                vstoreu(gw + v * VN, vadd(vloadu(gw + v * VN), acc[o][v]));
        vstoreu(rest, acc[o][nv - 1]);
        for (int i = ni / VN * VN; i < ni; i++)
            gw[i] += rest[i % VN];
    }
}

static inline __attribute__((always_inline)) void weight_rows(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I],
                                                              int no, int nv, int ni)
{
    switch (no) {
    case 6:
        weight_tile(gw, ldg, dy, xt, 6, nv, ni);
        break;
    case 5:
        weight_tile(gw, ldg, dy, xt, 5, nv, ni);
        break;
    case 4:
        weight_tile(gw, ldg, dy, xt, 4, nv, ni);
        break;
    case 3:
        weight_tile(gw, ldg, dy, xt, 3, nv, ni);
        break;
    case 2:
        weight_tile(gw, ldg, dy, xt, 2, nv, ni);
        break;
    default:
        weight_tile(gw, ldg, dy, xt, 1, nv, ni);
        break;
    }
}

/** Divides n_out rows evenly: a rest of one or two would leave the multipliers idle. */
static void weight_columns(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I], int n_out, int ni)
{
    const int groups = (n_out + TILE_O - 1) / TILE_O;
    for (int g = 0, o = 0, no; g < groups; g++, o += no, gw += (size_t)no * ldg, dy += no * LANES) {
        no = (n_out - o + groups - g - 1) / (groups - g);
        switch ((ni + VN - 1) / VN) {
#if VN == 16
        case 4:
            weight_rows(gw, ldg, dy, xt, no, 4, ni);
            break;
        case 3:
            weight_rows(gw, ldg, dy, xt, no, 3, ni);
            break;
#endif
        case 2:
            weight_rows(gw, ldg, dy, xt, no, 2, ni);
            break;
        default:
            weight_rows(gw, ldg, dy, xt, no, 1, ni);
            break;
        }
    }
}

static void ISA(weight_grad)(float *gw, size_t ldg, float *gb, const float *dy, size_t sy, const float *x, size_t sx, int tiles,
                             int n_out, int n_in)
{
    const int vectors = (n_in + VN - 1) / VN, blocks = (vectors + TILE_V - 1) / TILE_V;
    alignas(64) float xt[LANES][TILE_I];
    for (int t = 0; t < tiles; t++, dy += sy, x += sx) {
        for (int b = 0, i = 0, ni; b < blocks; b++, i += ni) {
            ni = ADCGS_MIN((vectors - i / VN + blocks - b - 1) / (blocks - b) * VN, n_in - i);
            turn(xt, x + (size_t)i * LANES, ni);
            weight_columns(gw + i, ldg, dy, xt, n_out, ni);
        }
        if (gb)
            bias_grad(gb, dy, n_out);
    }
}

static void ISA(lrelu_back)(float *restrict dz, const float *restrict h, int n)
{
    for (int i = 0; i < n * LANES; i++)
        dz[i] *= h[i] < 0 ? 0x1p-6f : 1.0f;
}

/** Mask of the negative lanes of a row. */
static inline uint64_t below_of(const float *row)
{
    uint64_t below = 0;
    for (int l = 0; l < LANES; l += VN)
        below |= vbelow(vload(row + l)) << l;
    return below;
}

/* A few rows at a time, so that their sums stay in the L1 cache. */
static void ISA(residual)(const adcgs_train_dsp *dsp, float *h, uint64_t *below, const float *bias, const adcgs_square *w,
                          const float *x)
{
    enum { ROWS = 36 };
    const int n = w->n;
    alignas(64) float z[ROWS * LANES];
    for (int o = 0; o < n; o += ROWS) {
        const int rows = n - o < ROWS ? n - o : ROWS;
        dsp->dense.dense(z, NULL, bias + o, w->w + (size_t)o * (size_t)n, (size_t)n, x, rows, n);
        dsp->hidden(h + (size_t)o * LANES, below + o, z, x + (size_t)o * LANES, rows);
    }
}

static void ISA(residual_back)(const adcgs_train_dsp *dsp, float *dx, float *dz, const uint64_t *below, const adcgs_square *turn,
                               const float *dh, const float *io)
{
    const int n = turn->n;
    for (int i = 0; i < n; i++)
        for (int l = 0; l < LANES; l += VN)
            vstoreu(dz + i * LANES + l, vslope(vload(dh + i * LANES + l), below[i] >> l));
    dsp->dense.dense(dx, dh, NULL, turn->w, (size_t)n, dz, n, n);
}

static void ISA(noise)(float *restrict y, const float *restrict p, const float *restrict step, int n, uint32_t seed)
{
    for (int i = 0; i < n; i++)
        for (int l = 0; l < LANES; l++) {
            const uint32_t r = adcgs_mix32(seed + (uint32_t)(i * LANES + l));
            y[i * LANES + l] = p[i * LANES + l] + step[i] * ((float)(int32_t)r * 0x1p-32f);
        }
}

static void ISA(round)(float *restrict y, const float *restrict p, const float *restrict step, const float *restrict mu, int n)
{
    const float most = 32767.0f / 64;
    for (int i = 0; i < n; i++) {
        const float inverse = 1 / step[i];
        for (int l = 0; l < LANES; l++) {
            const int alone = adcgs_mean_alone(mu[i * LANES + l]);
            const float m = (mu[i * LANES + l] - (alone ? ADCGS_MEAN_ALONE : 0)) * 0x1p-6f;
            const float v = adcgs_bounded(rintf(p[i * LANES + l] * inverse - m), -ADCGS_LEVEL_MAX, ADCGS_LEVEL_MAX);
            y[i * LANES + l] = step[i] * adcgs_bounded((alone ? 0 : v) + m, -most, most);
        }
    }
}

/* ---- From network outputs to primitives, and back. The forward formulas are those of spec clause "Primitives". ---- */

/** Rotation matrix of a unit quaternion, row-major, per lane. */
#define ROTATION(r, w, x, y, z)                                                                            \
    const float r##00 = 1 - 2 * (y * y + z * z), r##01 = 2 * (x * y - w * z), r##02 = 2 * (x * z + w * y); \
    const float r##10 = 2 * (x * y + w * z), r##11 = 1 - 2 * (x * x + z * z), r##12 = 2 * (y * z - w * x); \
    const float r##20 = 2 * (x * z - w * y), r##21 = 2 * (y * z + w * x), r##22 = 1 - 2 * (x * x + y * y)

/** Values of an anchor shared by its primitives. */
typedef struct anchor_terms {
    float extent[3][LANES], base[3][LANES];               /* exp(Sigma_v) */
    float move[3][LANES], grow[3][LANES], tint[3][LANES]; /* deltas of F_omega */
    float own[4][LANES];                                  /* rotation by F_omega */
    float q[4][LANES];                                    /* total rotation, with the body's */
    float body[4][LANES], from[3][LANES];         /* rotation of the body; translation before it, minus the body's centre */
    float norm[LANES];                            /* length of (1, r) */
    float pace[LANES], u[LANES], presence[LANES]; /* of lifetimes */
} anchor_terms;

/**
 * Position and presence of an anchor in its lifetime: it moves with its velocity, and its presence has a flat top with steep
 * ends.
 */
static void ISA(span_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    for (int l = 0; l < LANES; l++)
        a->presence[l] = 1;
    if (!io->spans)
        return;
    const float *restrict middle = io->sigma + ADCGS_SPAN_MIDDLE * LANES, *restrict pace = io->sigma + ADCGS_SPAN_PACE * LANES;
    for (int l = 0; l < LANES; l++) {
        a->pace[l] = adcgs_exp(adcgs_clampf(pace[l], -8, 8));
        a->u[l] = adcgs_clampf((io->t - (middle[l] * 0.125f + 0.5f)) * a->pace[l], -4, 4);
        const float square = a->u[l] * a->u[l];
        a->presence[l] = io->moving[l] != 0 ? adcgs_exp(-(square * square)) : 1;
    }
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++)
            a->move[c][l] += io->sigma[(ADCGS_SPAN_VELOCITY + c) * LANES + l] * 0.125f * a->u[l] * io->moving[l];
}

/* Products of quaternions: a b, conj(a) b, or a conj(b). */
/* clang-format off */
#define PRODUCT(c, a, b, i, j)                                                                        \
    const float c##0 = a##0 * b##0 - (i) * (j) * (a##1 * b##1 + a##2 * b##2 + a##3 * b##3);           \
    const float c##1 = (j) * a##0 * b##1 + (i) * a##1 * b##0 + (i) * (j) * (a##2 * b##3 - a##3 * b##2); \
    const float c##2 = (j) * a##0 * b##2 + (i) * a##2 * b##0 + (i) * (j) * (a##3 * b##1 - a##1 * b##3); \
    const float c##3 = (j) * a##0 * b##3 + (i) * a##3 * b##0 + (i) * (j) * (a##1 * b##2 - a##2 * b##1)
/* clang-format on */
#define QUATERNION(name, from) const float name##0 = from[0][l], name##1 = from[1][l], name##2 = from[2][l], name##3 = from[3][l]

/** Moves and rotates anchors with their rigid bodies. */
static void ISA(body_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    float to[3][LANES];
    for (int l = 0; l < LANES; l++) {
        static const adcgs_body_place still = {.q = {1, 0, 0, 0}};
        const adcgs_body_place *p = io->body[l] && io->moving[l] != 0 ? &io->pose[io->body[l] - 1] : &still;
        for (int c = 0; c < 4; c++)
            a->body[c][l] = p->q[c];
        for (int c = 0; c < 3; c++) {
            a->from[c][l] = a->move[c][l] - p->centre[c];
            to[c][l] = p->to[c];
        }
    }
    for (int l = 0; l < LANES; l++) {
        QUATERNION(b, a->body);
        QUATERNION(o, a->own);
        ROTATION(r, b0, b1, b2, b3);
        PRODUCT(q, b, o, 1, 1);
        const float x = a->from[0][l], y = a->from[1][l], z = a->from[2][l];
        a->move[0][l] = r00 * x + r01 * y + r02 * z + to[0][l];
        a->move[1][l] = r10 * x + r11 * y + r12 * z + to[1][l];
        a->move[2][l] = r20 * x + r21 * y + r22 * z + to[2][l];
        a->q[0][l] = q0;
        a->q[1][l] = q1;
        a->q[2][l] = q2;
        a->q[3][l] = q3;
    }
}

static void ISA(anchor_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            a->extent[c][l] = adcgs_exp(adcgs_clampf(io->sigma[c * LANES + l], -16, 8));
            a->base[c][l] = adcgs_exp(adcgs_clampf(io->sigma[(3 + c) * LANES + l], -16, 8));
        }
    const float *om = io->omega;
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            a->move[c][l] = om ? om[c * LANES + l] * io->moving[l] : 0;
            a->grow[c][l] = om ? adcgs_exp(adcgs_clampf(om[(3 + c) * LANES + l] * io->moving[l], -8, 8)) : 1;
            a->tint[c][l] = om ? om[(6 + c) * LANES + l] * io->moving[l] : 0;
        }
    const int turn = om && io->rotation;
    for (int l = 0; l < LANES; l++) {
        const float x = turn ? om[9 * LANES + l] * io->moving[l] : 0;
        const float y = turn ? om[10 * LANES + l] * io->moving[l] : 0;
        const float z = turn ? om[11 * LANES + l] * io->moving[l] : 0;
        const float norm = sqrtf(1 + x * x + y * y + z * z), inverse = 1 / norm;
        a->norm[l] = norm;
        a->own[0][l] = inverse;
        a->own[1][l] = x * inverse;
        a->own[2][l] = y * inverse;
        a->own[3][l] = z * inverse;
    }
    ISA(span_forward)(a, io);
    if (io->body)
        ISA(body_forward)(a, io);
    else
        memcpy(a->q, a->own, sizeof a->q);
}

static void ISA(primitives)(const adcgs_group_io *io)
{
    anchor_terms a;
    ISA(anchor_forward)(&a, io);
    for (int k = 0; k < io->k; k++) {
        const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
        const float *restrict va = io->varpi ? io->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
        const float *restrict keep = io->keep + k * LANES;
        float *restrict m0 = io->mean[0] + k * LANES, *restrict m1 = io->mean[1] + k * LANES,
                        *restrict m2 = io->mean[2] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float ox = th[l] * a.extent[0][l], oy = th[LANES + l] * a.extent[1][l], oz = th[2 * LANES + l] * a.extent[2][l];
            const float w = a.q[0][l], x = a.q[1][l], y = a.q[2][l], z = a.q[3][l];
            ROTATION(r, w, x, y, z);
            const float px = io->x[l] + ox, py = io->x[LANES + l] + oy, pz = io->x[2 * LANES + l] + oz;
            m0[l] = a.move[0][l] + (r00 * px + r01 * py + r02 * pz);
            m1[l] = a.move[1][l] + (r10 * px + r11 * py + r12 * pz);
            m2[l] = a.move[2][l] + (r20 * px + r21 * py + r22 * pz);
        }
        for (int c = 0; c < 3; c++) {
            float *restrict scale = io->scale[c] + k * LANES;
            for (int l = 0; l < LANES; l++)
                scale[l] = adcgs_clampf(a.base[c][l] * adcgs_sigmoid(th[(3 + c) * LANES + l]) * a.grow[c][l], 0x1p-20f, 0x1p10f);
        }
        float *restrict qw = io->rot[0] + k * LANES, *restrict qx = io->rot[1] + k * LANES;
        float *restrict qy = io->rot[2] + k * LANES, *restrict qz = io->rot[3] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float vw = th[6 * LANES + l] + 1, vx = th[7 * LANES + l], vy = th[8 * LANES + l], vz = th[9 * LANES + l];
            const float inverse = 1 / sqrtf(vw * vw + vx * vx + vy * vy + vz * vz + 1e-12f);
            const float pw = vw * inverse, px = vx * inverse, py = vy * inverse, pz = vz * inverse;
            const float w = a.q[0][l], x = a.q[1][l], y = a.q[2][l], z = a.q[3][l];
            qw[l] = w * pw - x * px - y * py - z * pz;
            qx[l] = w * px + x * pw + y * pz - z * py;
            qy[l] = w * py - x * pz + y * pw + z * px;
            qz[l] = w * pz + x * py - y * px + z * pw;
        }
        for (int c = 0; c < 3; c++) {
            float *restrict rgb = io->rgb[c] + k * LANES;
            for (int l = 0; l < LANES; l++)
                rgb[l] = io->colour[c * LANES + l] + th[(10 + c) * LANES + l] + a.tint[c][l] +
                         (va ? va[(1 + c) * LANES + l] * io->moving[l] : 0);
        }
        float *restrict opacity = io->opacity + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float logit = th[13 * LANES + l] + (va ? va[l] * io->moving[l] : 0);
            opacity[l] = 0.99f * adcgs_sigmoid(logit) * keep[l] * a.presence[l];
        }
    }
}

/** Gradients of the anchors, summed over a group's primitives. */
typedef struct anchor_grads {
    float move[3][LANES], grow[3][LANES], tint[3][LANES];
    float m[9][LANES]; /* sum of dL/dmean (x) canonical mean: gradient of the rotation matrix */
    float q[4][LANES]; /* gradient of the anchor's quaternion through the primitives' */
    float presence[LANES];
} anchor_grads;

static void ISA(primitive_mean_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g,
                                     int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict g0 = g->mean[0] + k * LANES, *restrict g1 = g->mean[1] + k * LANES,
                          *restrict g2 = g->mean[2] + k * LANES;
    float *restrict ds = g->sigma;
    for (int l = 0; l < LANES; l++) {
        const float ox = th[l] * a->extent[0][l], oy = th[LANES + l] * a->extent[1][l], oz = th[2 * LANES + l] * a->extent[2][l];
        const float w = a->q[0][l], x = a->q[1][l], y = a->q[2][l], z = a->q[3][l];
        ROTATION(r, w, x, y, z);
        s->move[0][l] += g0[l];
        s->move[1][l] += g1[l];
        s->move[2][l] += g2[l];
        const float fx = r00 * g0[l] + r10 * g1[l] + r20 * g2[l];
        const float fy = r01 * g0[l] + r11 * g1[l] + r21 * g2[l];
        const float fz = r02 * g0[l] + r12 * g1[l] + r22 * g2[l];
        dt[l] = fx * a->extent[0][l];
        dt[LANES + l] = fy * a->extent[1][l];
        dt[2 * LANES + l] = fz * a->extent[2][l];
        ds[l] += fx * ox;
        ds[LANES + l] += fy * oy;
        ds[2 * LANES + l] += fz * oz;
        const float px = io->x[l] + ox, py = io->x[LANES + l] + oy, pz = io->x[2 * LANES + l] + oz;
        s->m[0][l] += g0[l] * px;
        s->m[1][l] += g0[l] * py;
        s->m[2][l] += g0[l] * pz;
        s->m[3][l] += g1[l] * px;
        s->m[4][l] += g1[l] * py;
        s->m[5][l] += g1[l] * pz;
        s->m[6][l] += g2[l] * px;
        s->m[7][l] += g2[l] * py;
        s->m[8][l] += g2[l] * pz;
    }
}

static void ISA(primitive_rotation_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io,
                                         const adcgs_group_grad *g, int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict gw = g->rot[0] + k * LANES, *restrict gx = g->rot[1] + k * LANES;
    const float *restrict gy = g->rot[2] + k * LANES, *restrict gz = g->rot[3] + k * LANES;
    for (int l = 0; l < LANES; l++) {
        const float vw = th[6 * LANES + l] + 1, vx = th[7 * LANES + l], vy = th[8 * LANES + l], vz = th[9 * LANES + l];
        const float inverse = 1 / sqrtf(vw * vw + vx * vx + vy * vy + vz * vz + 1e-12f);
        const float pw = vw * inverse, px = vx * inverse, py = vy * inverse, pz = vz * inverse;
        const float w = a->q[0][l], x = a->q[1][l], y = a->q[2][l], z = a->q[3][l];
        /* conj(anchor) times g: gradient of the primitive's own quaternion */
        const float hw = w * gw[l] + x * gx[l] + y * gy[l] + z * gz[l];
        const float hx = w * gx[l] - x * gw[l] - y * gz[l] + z * gy[l];
        const float hy = w * gy[l] + x * gz[l] - y * gw[l] - z * gx[l];
        const float hz = w * gz[l] - x * gy[l] + y * gx[l] - z * gw[l];
        const float along = pw * hw + px * hx + py * hy + pz * hz;
        dt[6 * LANES + l] = (hw - pw * along) * inverse;
        dt[7 * LANES + l] = (hx - px * along) * inverse;
        dt[8 * LANES + l] = (hy - py * along) * inverse;
        dt[9 * LANES + l] = (hz - pz * along) * inverse;
        /* g times conj(primitive): gradient of the anchor's quaternion */
        s->q[0][l] += gw[l] * pw + gx[l] * px + gy[l] * py + gz[l] * pz;
        s->q[1][l] += -gw[l] * px + gx[l] * pw - gy[l] * pz + gz[l] * py;
        s->q[2][l] += -gw[l] * py + gx[l] * pz + gy[l] * pw - gz[l] * px;
        s->q[3][l] += -gw[l] * pz - gx[l] * py + gy[l] * px + gz[l] * pw;
    }
}

static void ISA(primitive_rest_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g,
                                     int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict va = io->varpi ? io->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
    float *restrict dv = io->varpi ? g->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
    for (int c = 0; c < 3; c++) {
        const float *restrict gs = g->scale[c] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float sg = adcgs_sigmoid(th[(3 + c) * LANES + l]);
            const float t = gs[l] * a->base[c][l] * sg * a->grow[c][l]; /* dL/d log scale */
            dt[(3 + c) * LANES + l] = t * (1 - sg);
            s->grow[c][l] += t;
            g->sigma[(3 + c) * LANES + l] += t;
        }
        const float *restrict gc = g->rgb[c] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            dt[(10 + c) * LANES + l] = gc[l];
            s->tint[c][l] += gc[l];
            g->colour[c * LANES + l] += gc[l];
            if (dv)
                dv[(1 + c) * LANES + l] = gc[l] * io->moving[l];
        }
    }
    const float *restrict go = g->opacity + k * LANES, *restrict keep = io->keep + k * LANES;
    for (int l = 0; l < LANES; l++) {
        const float sg = adcgs_sigmoid(th[13 * LANES + l] + (va ? va[l] * io->moving[l] : 0));
        const float whole = go[l] * keep[l] * 0.99f * sg, t = whole * (1 - sg) * a->presence[l];
        s->presence[l] += whole;
        dt[13 * LANES + l] = t;
        if (dv)
            dv[l] = t * io->moving[l];
    }
}

/**
 * Converts the gradients of an anchor's total motion to those of the motion before its body, in place, and adds to the sums for
 * the body. With R = B O of the body and F_omega: for B, dR O^T; for O, B^T dR; quaternions likewise.
 */
static void ISA(body_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    float sums[16][LANES];
    for (int l = 0; l < LANES; l++) {
        QUATERNION(b, a->body);
        QUATERNION(o, a->own);
        QUATERNION(d, s->q);
        ROTATION(r, b0, b1, b2, b3);
        ROTATION(w, o0, o1, o2, o3);
        PRODUCT(e, d, o, 1, -1);
        PRODUCT(f, b, d, -1, 1);
        const float x = s->move[0][l], y = s->move[1][l], z = s->move[2][l];
        const float v[3] = {a->from[0][l], a->from[1][l], a->from[2][l]}, way[3] = {x, y, z};
        for (int i = 0; i < 3; i++) {
            const float m0 = s->m[3 * i][l], m1 = s->m[3 * i + 1][l], m2 = s->m[3 * i + 2][l];
            sums[3 * i][l] = m0 * w00 + m1 * w01 + m2 * w02 + way[i] * v[0];
            sums[3 * i + 1][l] = m0 * w10 + m1 * w11 + m2 * w12 + way[i] * v[1];
            sums[3 * i + 2][l] = m0 * w20 + m1 * w21 + m2 * w22 + way[i] * v[2];
            sums[13 + i][l] = way[i];
        }
        for (int j = 0; j < 3; j++) {
            const float m0 = s->m[j][l], m1 = s->m[3 + j][l], m2 = s->m[6 + j][l];
            s->m[j][l] = r00 * m0 + r10 * m1 + r20 * m2;
            s->m[3 + j][l] = r01 * m0 + r11 * m1 + r21 * m2;
            s->m[6 + j][l] = r02 * m0 + r12 * m1 + r22 * m2;
        }
        sums[9][l] = e0;
        sums[10][l] = e1;
        sums[11][l] = e2;
        sums[12][l] = e3;
        s->q[0][l] = f0;
        s->q[1][l] = f1;
        s->q[2][l] = f2;
        s->q[3][l] = f3;
        s->move[0][l] = r00 * x + r10 * y + r20 * z;
        s->move[1][l] = r01 * x + r11 * y + r21 * z;
        s->move[2][l] = r02 * x + r12 * y + r22 * z;
    }
    for (int l = 0; l < LANES; l++) {
        if (!io->body[l] || io->moving[l] == 0)
            continue;
        adcgs_body_grad *to = &g->body[io->body[l] - 1];
        for (int i = 0; i < 9; i++)
            to->m[i] += sums[i][l];
        for (int i = 0; i < 4; i++)
            to->q[i] += sums[9 + i][l];
        for (int i = 0; i < 3; i++)
            to->way[i] += sums[13 + i][l];
    }
}

static void ISA(omega_back)(const anchor_terms *a, const anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    float *restrict d = g->omega;
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            d[c * LANES + l] = s->move[c][l] * io->moving[l];
            d[(3 + c) * LANES + l] = s->grow[c][l] * io->moving[l];
            d[(6 + c) * LANES + l] = s->tint[c][l] * io->moving[l];
        }
    if (!io->rotation)
        return;
    for (int l = 0; l < LANES; l++) {
        const float w = a->own[0][l], x = a->own[1][l], y = a->own[2][l], z = a->own[3][l];
        const float m00 = s->m[0][l], m01 = s->m[1][l], m02 = s->m[2][l], m10 = s->m[3][l], m11 = s->m[4][l];
        const float m12 = s->m[5][l], m20 = s->m[6][l], m21 = s->m[7][l], m22 = s->m[8][l];
        const float gw = s->q[0][l] + 2 * (z * (m10 - m01) + y * (m02 - m20) + x * (m21 - m12));
        const float gx = s->q[1][l] + 2 * (y * (m01 + m10) + z * (m02 + m20) + w * (m21 - m12) - 2 * x * (m11 + m22));
        const float gy = s->q[2][l] + 2 * (x * (m01 + m10) + z * (m12 + m21) + w * (m02 - m20) - 2 * y * (m00 + m22));
        const float gz = s->q[3][l] + 2 * (x * (m02 + m20) + y * (m12 + m21) + w * (m10 - m01) - 2 * z * (m00 + m11));
        const float along = w * gw + x * gx + y * gy + z * gz, turn = io->moving[l] / a->norm[l];
        d[9 * LANES + l] = (gx - x * along) * turn;
        d[10 * LANES + l] = (gy - y * along) * turn;
        d[11 * LANES + l] = (gz - z * along) * turn;
    }
}

static void ISA(span_back)(const anchor_terms *a, const anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    const float *restrict velocity = io->sigma + ADCGS_SPAN_VELOCITY * LANES;
    float *restrict d = g->sigma + ADCGS_SPAN_VELOCITY * LANES;
    for (int l = 0; l < LANES; l++) {
        const float u = a->u[l], inside = u > -4 && u < 4 ? io->moving[l] : 0;
        float du = -4 * u * u * u * a->presence[l] * s->presence[l];
        for (int c = 0; c < 3; c++) {
            du += 0.125f * s->move[c][l] * velocity[c * LANES + l];
            d[c * LANES + l] += 0.125f * s->move[c][l] * u * io->moving[l];
        }
        d[(ADCGS_SPAN_MIDDLE - ADCGS_SPAN_VELOCITY) * LANES + l] -= 0.125f * a->pace[l] * du * inside;
        d[(ADCGS_SPAN_PACE - ADCGS_SPAN_VELOCITY) * LANES + l] += u * du * inside;
    }
}

static void ISA(primitives_back)(const adcgs_group_io *io, const adcgs_group_grad *grad)
{
    anchor_terms a;
    anchor_grads s;
    memset(&s, 0, sizeof s);
    const float *restrict pull = io->omega ? grad->pull : NULL;
    ISA(anchor_forward)(&a, io);
    for (int k = 0; k < io->k; k++) {
        ISA(primitive_mean_back)(&a, &s, io, grad, k);
        ISA(primitive_rotation_back)(&a, &s, io, grad, k);
        ISA(primitive_rest_back)(&a, &s, io, grad, k);
    }
    if (io->body)
        ISA(body_back)(&a, &s, io, grad);
    if (io->spans)
        ISA(span_back)(&a, &s, io, grad);
    for (int i = 0; pull && i < 12 * LANES; i++) /* for F_omega only */
        (i < 3 * LANES ? s.move[i / LANES] : s.m[i / LANES - 3])[i % LANES] += pull[i];
    if (io->omega)
        ISA(omega_back)(&a, &s, io, grad);
}

/* ---- Rate: the continuous twin of the coder's tables. ---- */

/** Upper tail of the standard normal for x >= 0 (Abramowitz and Stegun 26.2.17), and its density. */
static inline float tail(float x, float *density)
{
    const float t = 1 / (1 + 0.2316419f * x);
    const float p = t * (0.319381530f + t * (-0.356563782f + t * (1.781477937f + t * (-1.821255978f + t * 1.330274429f))));
    *density = 0.3989422804f * adcgs_exp(adcgs_clampf(-0.5f * x * x, -80, 0));
    return p * *density;
}

/** One row of values: bits of each lane; v in steps from the mean; gv, gs: derivatives with respect to v and to the level. */
static void ISA(rate_row)(float *restrict bits, float *restrict gv, float *restrict gs, const float *restrict v_row,
                          const float *restrict level_row)
{
    const float log2_ratio = 0.145784517f; /* log2(64/0.11)/63: sigma levels are 2^0.1458 apart */
    const float level0 = -3.18442457f;     /* log2(0.11) */
    for (int l = 0; l < LANES; l++) {
        const float v = v_row[l], av = v < 0 ? -v : v, level = adcgs_clampf(level_row[l], 0, 63);
        const float inv_sigma = adcgs_exp(-0.69314718f * (level * log2_ratio + level0));
        const float a = (av - 0.5f) * inv_sigma, b = (av + 0.5f) * inv_sigma;
        float fa, fb;
        const float qa = tail(a < 0 ? -a : a, &fa), qb = tail(b, &fb);
        const float inside = (a < 0 ? 1 - qa : qa) - qb;
        /* a thin heavy tail models the escape code and keeps gradients nonzero far out */
        const float width = 1 + 4 / inv_sigma, far = 1 / (width * width + av * av), heavy = 0x1p-14f * width * far;
        const float p = inside * (1 - 0x1p-12f) + heavy + 1e-12f, factor = -1.44269504f / p;
        const float dp_dv = (fb - fa) * inv_sigma * (1 - 0x1p-12f) - 2 * heavy * av * far;
        /* d p / d ln sigma; the tail's width grows with sigma */
        const float dp_dlog = -(b * fb - a * fa) * (1 - 0x1p-12f) + 0x1p-14f * far * (1 - 2 * width * width * far) * (width - 1);
        bits[l] = -adcgs_log2(p);
        gv[l] = factor * dp_dv * (v < 0 ? -1.0f : 1.0f);
        gs[l] = factor * dp_dlog * (0.69314718f * log2_ratio);
    }
}

/** The same with the coder's exact costs, from the table cells of each lane's level. */
static void ISA(rate_row_exact)(float *restrict bits, float *restrict gv, float *restrict gs, const float *restrict v_row,
                                const float *restrict n, const float *restrict level, const adcgs_rate_cell *restrict cells)
{
    for (int l = 0; l < LANES; l++) {
        /*
         * The derivative with respect to the level uses the coded value; that with respect to the value uses the unrounded one.
         */
        const float v = v_row[l], a = v < 0 ? -v : v, floor_a = floorf(a);
        const int at = (int)level[l] * ADCGS_RATE_CELLS, below = at + (int)floor_a;
        const float slope = cells[below].by_value + (a - floor_a) * (cells[below + 1].by_value - cells[below].by_value);
        bits[l] = cells[at + (int)(n[l] < 0 ? -n[l] : n[l])].bits;
        gv[l] = v < 0 ? -slope : slope;
        gs[l] = cells[at + (int)floorf(a + 0.5f)].by_level;
    }
}

/** Adds bits and derivatives of a row of io to its sum and gradients; raw: the level before clamping. */
static float ISA(rate_pass_on)(const adcgs_rate_io *io, int i, const float *restrict bits, const float *restrict gv,
                               const float *restrict gs, const float *restrict raw)
{
    float *restrict dy = io->dy + i * LANES, *restrict dmu = io->dmu + i * LANES, *restrict dsi = io->dsi + i * LANES;
    const float *restrict weight = io->weight;
    const float inverse = 1 / io->step[i], scale = io->scale;
    float sum = 0;
    for (int l = 0; l < LANES; l++) {
        const float v = gv[l] * weight[l] * scale, s = gs[l] * weight[l] * scale * ADCGS_SI_GAIN;
        /* a level out of range may only move back */
        const int outwards = ((raw[l] < 0) & (s > 0)) | ((raw[l] > 63) & (s < 0));
        dy[l] += v * inverse;
        dmu[l] = -v * ADCGS_MU_GAIN;
        dsi[l] = outwards ? 0 : s;
    }
    for (int l = 0; l < LANES; l++)
        sum += bits[l] * weight[l];
    return sum;
}

static double ISA(rate)(const adcgs_rate_io *io)
{
    double total = 0;
    for (int i = 0; i < io->n; i++) {
        const float *restrict y = io->y + i * LANES, *restrict mu = io->mu + i * LANES, *restrict si = io->si + i * LANES;
        float v[LANES], raw[LANES], bits[LANES], gv[LANES], gs[LANES];
        const float inverse = 1 / io->step[i];
        for (int l = 0; l < LANES; l++) {
            v[l] = y[l] * inverse - ADCGS_MU_GAIN * mu[l];
            raw[l] = ADCGS_SI_GAIN * si[l] + ADCGS_SI_CENTRE;
        }
        for (int l = 0; io->x && l < LANES; l++)
            io->x[i * LANES + l] = y[l] * inverse * (1 / ADCGS_MU_GAIN);
        ISA(rate_row)(bits, gv, gs, v, raw);
        total += ISA(rate_pass_on)(io, i, bits, gv, gs, raw);
    }
    return total;
}

/* ---- Exact rate: the coder's integers as floats, and its tables. ---- */

/** shr(v, s) of the specification for v = x * 2^s. */
static inline float nearest(float x)
{
    return floorf(x + 0.5f);
}

static void ISA(hidden)(float *restrict h, uint64_t *restrict below, const float *restrict z, const float *restrict in, int n)
{
    for (int i = 0; i < n * LANES; i++)
        h[i] = (z[i] < 0 ? z[i] * 0x1p-6f : z[i]) + (in ? in[i] : 0);
    for (int i = 0; i < n; i++)
        below[i] = below_of(z + i * LANES);
}

static void ISA(hidden_exact)(float *restrict h, uint64_t *restrict below, const float *restrict z, const float *restrict in,
                              int n)
{
    const float up = 1 << ADCGS_E24_BITS, down = 1 / up, most = ADCGS_E24_MAX * down;
    for (int i = 0; i < n * LANES; i++) {
        /* The leaky ReLU is the maximum of the two. */
        const float v = nearest(z[i] * up), slow = nearest(v * 0x1p-6f), a = (v > slow ? v : slow) * down;
        h[i] = adcgs_bounded(in ? a + in[i] : a, -most, most);
    }
    for (int i = 0; i < n; i++)
        below[i] = below_of(z + i * LANES);
}

/** A row of values in the coder's form. */
typedef struct exact_row {
    float mean[LANES], raw[LANES], level[LANES];
    float v[LANES], n[LANES]; /* in steps from the mean; the same rounded, or 0 if nothing is coded */
} exact_row;

static void ISA(exact_values)(exact_row *restrict r, const float *restrict y, const float *restrict mu, const float *restrict si,
                              float inverse)
{
    for (int l = 0; l < LANES; l++) {
        const float level = adcgs_coder_level(si[l]), m = adcgs_coder_mean(mu[l]);
        const float v = adcgs_bounded(y[l] * inverse - m * 0x1p-6f, -ADCGS_LEVEL_MAX, ADCGS_LEVEL_MAX), n = rintf(v);
        r->mean[l] = m;
        r->raw[l] = ADCGS_SI_GAIN * si[l] + ADCGS_SI_CENTRE;
        r->level[l] = level;
        r->v[l] = v;
        r->n[l] = level > 0 ? n : 0;
    }
}

/** The row as input of later networks. */
static void ISA(exact_inputs)(float *restrict x, const exact_row *restrict r)
{
    const float down = 1.0f / (1 << ADCGS_E24_BITS), most = ADCGS_E24_MAX * down, quarter = 1.0f / (1 << ADCGS_E24_INPUT_SHIFT);
    for (int l = 0; l < LANES; l++) {
        const float yq = adcgs_bounded(64 * r->n[l] + r->mean[l], -32767, 32767);
        x[l] = adcgs_bounded(nearest(yq * quarter) * down, -most, most);
    }
}

static double ISA(rate_exact)(const adcgs_rate_io *io)
{
    double total = 0;
    for (int i = 0; i < io->n; i++) {
        exact_row r;
        float bits[LANES], gv[LANES], gs[LANES];
        ISA(exact_values)(&r, io->y + i * LANES, io->mu + i * LANES, io->si + i * LANES, 1 / io->step[i]);
        for (int l = 0; l < LANES; l++)
            io->mean[i * LANES + l] = adcgs_mean_pack(r.mean[l], !(r.level[l] > 0));
        if (io->x)
            ISA(exact_inputs)(io->x + i * LANES, &r);
        ISA(rate_row_exact)(bits, gv, gs, r.v, r.n, r.level, &io->table->cell[0][0]);
        total += ISA(rate_pass_on)(io, i, bits, gv, gs, r.raw);
    }
    return total;
}

static void ISA(adam)(float *restrict p, float *restrict g, float *restrict m, float *restrict v, size_t n, float lr, float c1,
                      float c2)
{
    for (size_t i = 0; i < n; i++) {
        m[i] = 0.9f * m[i] + 0.1f * g[i];
        v[i] = 0.999f * v[i] + 0.001f * (g[i] * g[i]);
        const float step = m[i] * c1 / (sqrtf(v[i] * c2) + 1e-15f), low = step < -1 ? -1 : step;
        p[i] -= lr * (low > 1 ? 1 : low);
        g[i] = 0;
    }
}

void ISA(adcgs_train_dsp_init)(adcgs_train_dsp *dsp);
void ISA(adcgs_train_dsp_init)(adcgs_train_dsp *dsp)
{
    dsp->weight_grad = ISA(weight_grad);
    dsp->lrelu_back = ISA(lrelu_back);
    dsp->residual = ISA(residual);
    dsp->residual_back = ISA(residual_back);
    dsp->pack = NULL;
    dsp->noise = ISA(noise);
    dsp->round = ISA(round);
    dsp->primitives = ISA(primitives);
    dsp->primitives_back = ISA(primitives_back);
    dsp->hidden = ISA(hidden);
    dsp->hidden_exact = ISA(hidden_exact);
    dsp->rate = ISA(rate);
    dsp->rate_exact = ISA(rate_exact);
    dsp->adam = ISA(adam);
}
