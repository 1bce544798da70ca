/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Multilayer perceptrons in training: their layout, the weights that a pass uses, evaluation over tiles of samples, and
 * gradients.
 */
#ifndef ADCGS_FMODEL_MLP_H
#define ADCGS_FMODEL_MLP_H

#include "grad/dsp.h"

#define ADCGS_MLP_LAYERS 4         /* largest number of layers of a network; definition */
#define ADCGS_WEIGHT_STEP_NONE 127 /**< exponent that stands for binary32 weights; definition */

/**
 * Shape of a network: inputs [own | time], hidden layers of equal width (leaky ReLU; from the second on residual), linear output.
 * Parameters in one block: per layer w [n_out][n_in] then b [n_out].
 */
typedef struct adcgs_mlp {
    int own, time, width, hidden, out;
    int in[ADCGS_MLP_LAYERS], n_out[ADCGS_MLP_LAYERS];
    size_t w[ADCGS_MLP_LAYERS], b[ADCGS_MLP_LAYERS]; /**< offsets into the block */
    size_t n;                                        /**< parameters; 0: the network does not exist */
    float *use;                           /**< [n] the weights of the forward pass: the parameters, or their lattice values */
    float *turn;                          /**< [n] the same transposed per layer: w^T [n_in][n_out] at w's offset */
    uint32_t *packed;                     /**< see adcgs_mlp_packed(); NULL in an entropy network */
    int8_t weight_step[ADCGS_MLP_LAYERS]; /**< exponent e of the step 2^-e of each layer's weights, or ADCGS_WEIGHT_STEP_NONE */
    uint8_t entropy; /**< an entropy network: on the lattice it is the integer network of spec clause "E24" */
} adcgs_mlp;

/** Fill in a network's layout; returns its number of parameters. */
size_t adcgs_mlp_layout(adcgs_mlp *mlp, int own, int time, int width, int hidden, int out);
/** Allocates the weights in use; m has its layout. */
adcgs_status adcgs_mlp_alloc(adcgs_mlp *m, adcgs_error *error);
void adcgs_mlp_clear(adcgs_mlp *m);
/** Sets the width of hidden layers, at most the allocated one. The caller updates the parameters. \return their number. */
size_t adcgs_mlp_set_width(adcgs_mlp *m, int width);
/** Initial parameters: weights uniform within +-sqrt(3/n_in) of unit gain, biases zero; the last layer scaled by `last`. */
void adcgs_mlp_start(const adcgs_mlp *mlp, float *p, float last, uint64_t seed, uint64_t stream);

/** Copies parameters to `use` (on the lattice if `quantise` is nonzero and a lattice is set) and transposes them. */
void adcgs_mlp_prepare(adcgs_mlp *mlp, const float *p, int quantise);
/** Packs the residual layers of `use` and `turn` if these kernels need it. */
void adcgs_mlp_pack(const adcgs_train_dsp *dsp, const adcgs_mlp *mlp);
/** The packed weights of residual layer i >= 1, or their transpose. */
static inline uint32_t *adcgs_mlp_packed(const adcgs_mlp *mlp, int i, int turned)
{
    return mlp->packed ? mlp->packed + (size_t)(2 * (i - 1) + turned) * adcgs_square_words(mlp->width) : NULL;
}
/**
 * The weights [n] of the integer network for an entropy network's parameters, as multiples of 2^-ADCGS_E24_BITS: in range, and
 * every row within the bound that makes its sums exact.
 */
void adcgs_mlp_integer(const adcgs_mlp *mlp, const float *p, float *to);

/** Rows of 64 floats that hold one word for each unit of a network's residual layers. */
static inline size_t adcgs_mlp_below_rows(const adcgs_mlp *m)
{
    return m->hidden > 1 ? ((size_t)(m->hidden - 1) * (size_t)m->width + 31) / 32 : 0;
}

/** Evaluates layers 1.. of a network: h[0] holds layer 0's sums and is activated in place. */
void adcgs_mlp_tail(const adcgs_train_dsp *dsp, const adcgs_mlp *m, float *h, uint64_t *below, float *out);
/** Gradients dz of every hidden layer's sums, from dout. */
void adcgs_mlp_tail_back(const adcgs_train_dsp *dsp, const adcgs_mlp *m, const float *h, const uint64_t *below, const float *dout,
                         float *dz);
/** Weight gradients of layers 1.. over tiles of the given strides. */
void adcgs_mlp_weight_grads(const adcgs_train_dsp *dsp, const adcgs_mlp *m, float *g, const float *h, size_t sh, const float *dz,
                            size_t sdz, const float *dout, size_t sdout, int tiles);

#endif
