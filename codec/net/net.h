/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Networks as the stream carries them, the E24 integer evaluation of the
 * entropy networks, and the coding of weights (decisions D2, D6; spec clauses
 * "Networks" and "Weights").
 */
#ifndef ADCGS_NET_NET_H
#define ADCGS_NET_NET_H

#include "base/base.h"
#include "bits/range.h"

#include <adcgs/types.h>

#define ADCGS_NET_LAYERS_MAX 8
#define ADCGS_NET_INPUTS_MAX 1024
#define ADCGS_NET_WIDTH_MAX 512
#define ADCGS_LANES 64 /**< samples are evaluated in groups of 64, feature-major: [feature][64] */

/**
 * A tensor [rows][cols], row-major, of 32-bit values.
 * mode 0: value = m * 2^-e, 0 <= e <= 40, any int32 m; mode 1: m holds the bits of a finite binary32.
 */
typedef struct adcgs_tensor {
    uint32_t rows, cols;
    uint8_t mode, e;
    int32_t *m;
} adcgs_tensor;

/** Role of a network. The values are those of the syntax element net_role. */
typedef enum adcgs_role {
    ADCGS_ROLE_ENTROPY_FV = 0,     /**< E_fv: eta -> mean and scale of f_v */
    ADCGS_ROLE_ENTROPY_SIGMA = 1,  /**< E_Sigma: f_v -> mean and scale of Sigma_v */
    ADCGS_ROLE_ENTROPY_COLOUR = 2, /**< E_C: f_v -> mean and scale of C_v */
    ADCGS_ROLE_ENTROPY_FG = 3,     /**< E_fg: 3 + chunk, chunk 0..3: f_v and earlier chunks of f_g,k -> the same of this chunk */
    ADCGS_ROLE_ENTROPY_STEPS = 7,  /**< E_q: f_v -> step indices of Sigma_v, C_v and the chunks of f_g */
    ADCGS_ROLE_PREDICTION = 8,     /**< F_theta (binary32) */
    ADCGS_ROLE_COARSE = 9,         /**< F_omega (binary32) */
    ADCGS_ROLE_FINE = 10,          /**< F_varpi (binary32) */
    ADCGS_ROLE_TIME = 11,          /**< Z, the time table: one tensor [time_rows][time_width + poses] in layer 0's w, no bias */
    ADCGS_ROLES = 12
} adcgs_role;

/** One dense layer, optionally residual. Float networks ignore the shift. */
typedef struct adcgs_layer {
    adcgs_tensor w;   /**< [n_out][n_in] */
    adcgs_tensor b;   /**< [n_out][1] (0 rows for the time table) */
    uint8_t residual; /**< h' = clip(h + lrelu(shr(acc, shift)), A), n_in == n_out; never on the last layer */
    uint8_t shift;    /**< s, E24: hidden layers, and s_mu on the last */
} adcgs_layer;

/**
 * A network. Hidden layers use leaky ReLU of slope 1/64; the last is linear.
 * E24 (roles below 8): input clip(shr(yq, in_shift), 2047); the last layer's rows are [mu of C channels, then sigma index of
 * C channels]; mu = clip(shr(acc, shift), 32767), si = clip3(0, 63, shr(acc, sigma_shift) + sigma_offset). E_q only has the mu
 * rows and uses neither sigma_shift nor sigma_offset: both are 0.
 * A network with n_in == 0 has one layer and its outputs are its biases.
 */
typedef struct adcgs_net {
    uint8_t present;
    uint8_t role;
    uint8_t n_layers;
    uint8_t in_shift;     /**< 0..8 */
    uint8_t sigma_shift;  /**< 0..24 */
    int16_t sigma_offset; /**< -64..127 */
    adcgs_layer layer[ADCGS_NET_LAYERS_MAX];
} adcgs_net;

uint32_t adcgs_net_weights(const adcgs_net *net);
static inline uint32_t adcgs_net_inputs(const adcgs_net *net)
{
    return net->layer[0].w.cols;
}
static inline uint32_t adcgs_net_outputs(const adcgs_net *net)
{
    return net->layer[net->n_layers - 1].w.rows;
}
/** Whether a role's outputs are the means (first half) and scale indices (second half) of a prior. */
static inline int adcgs_role_is_prior(int role)
{
    return role < ADCGS_ROLE_ENTROPY_STEPS;
}
/** Channels of an E24 network: the rows of the last layer, or half of them if it gives a prior. */
static inline uint32_t adcgs_net_channels(const adcgs_net *net)
{
    return adcgs_role_is_prior(net->role) ? adcgs_net_outputs(net) / 2 : adcgs_net_outputs(net);
}

/** An E24 network prepared for evaluation: int16 weights packed for the CPU level. */
typedef struct adcgs_e24 adcgs_e24;
/**
 * Checks shapes, |w| <= 2047, mode 0 (the numbers m are the weights, e is not used), and the row bound
 * A*sum|w| + |b| + 2^(s-1) <= 2^24-1: ADCGS_ERR_DATA names the row.
 */
adcgs_status adcgs_e24_create(adcgs_e24 **out, const adcgs_net *net, adcgs_cpu_level cpu, adcgs_memory *memory,
                              adcgs_error *error);
void adcgs_e24_free(adcgs_e24 **net, adcgs_memory *memory);
/**
 * Evaluate 64 samples. x: [n_in][64] yq in 1/64 step (already the reconstruction; shift and clip happen inside).
 * mu: [C][64] in 1/64 step; si: [C][64] in 0..63, C = n_out/2. scratch: adcgs_e24_scratch() bytes, 64-byte aligned.
 * For E_q, si is NULL and C = n_out.
 */
void adcgs_e24_eval(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, void *scratch);
size_t adcgs_e24_scratch(const adcgs_e24 *net);
/** Known-answer test of every E24 kernel that this machine supports. */
adcgs_status adcgs_e24_check(adcgs_error *error);

/** shr of the specification: floor((v + 2^(s-1)) / 2^s), s = 0 gives v. |v| < 2^30, 0 <= s <= 24. */
static inline int32_t adcgs_shr(int32_t v, int s)
{
    if (s == 0)
        return v;
    const int32_t r = v + (1 << (s - 1));
    return r >= 0 ? r >> s : -((-r + (1 << s) - 1) >> s);
}
static inline int32_t adcgs_clip(int32_t v, int32_t limit)
{
    return v > limit ? limit : v < -limit ? -limit : v;
}

/** Weight coder (bitstream study 4): codes class, top bits, rest and sign of m with adaptive contexts. */
void adcgs_tensor_encode(adcgs_range_enc *e, const adcgs_tensor *t);
/**
 * The caller sets rows, cols, mode and e, and allocates m with adcgs_alloc(). Errors of d are sticky. ADCGS_ERR_DATA if a value
 * is outside the mode's range.
 */
adcgs_status adcgs_tensor_decode(adcgs_range_dec *d, adcgs_tensor *t, adcgs_error *error);

/* ---- Probability tables (spec annex "Tables") ---- */
#define ADCGS_SIGMA_LEVELS 64
/** Half-support T of level l: coded values are -T..T and an escape. */
int adcgs_table_support(int level);
/** CDF of level l, 2T+3 entries, 0 .. 65536; symbol k is value k-T, the last symbol is the escape. */
const uint32_t *adcgs_table_cdf(int level);
/** Decode / encode the excess of a magnitude over a bound, 0..65534: a prefix of at most 15 ones, then as many bits. */
int32_t adcgs_excess_dec(adcgs_range_dec *d);
void adcgs_excess_enc(adcgs_range_enc *e, int32_t excess);
/** Decode / encode one value under level si (si == 0 is never coded: the value is 0). */
int32_t adcgs_value_dec(adcgs_range_dec *d, int si);
void adcgs_value_enc(adcgs_range_enc *e, int si, int32_t value);
/** Cost in 1/65536 bit. |value| <= adcgs_value_max(). */
uint32_t adcgs_value_cost(int si, int32_t value);
/** Largest |value| that can be coded at a level. */
int32_t adcgs_value_max(int si);

#endif
