/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Networks as containers of tensors. */
#include "net/net.h"

uint32_t adcgs_net_weights(const adcgs_net *net)
{
    uint32_t total = 0;
    for (int i = 0; i < net->n_layers; i++)
        total += net->layer[i].w.rows * net->layer[i].w.cols + net->layer[i].b.rows * net->layer[i].b.cols;
    return total;
}
