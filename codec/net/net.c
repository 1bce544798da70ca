/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Networks as containers of tensors. */
#include "net/net.h"

void adcgs_net_clear(adcgs_net *net)
{
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++) {
        adcgs_free(NULL, net->layer[i].w.m);
        adcgs_free(NULL, net->layer[i].b.m);
    }
    *net = (adcgs_net){0};
}

uint32_t adcgs_net_weights(const adcgs_net *net)
{
    uint32_t total = 0;
    for (int i = 0; i < net->n_layers; i++)
        total += net->layer[i].w.rows * net->layer[i].w.cols + net->layer[i].b.rows * net->layer[i].b.cols;
    return total;
}
