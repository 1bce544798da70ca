/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Networks whose tensors come from adcgs_alloc(). */
#ifndef ADCGS_TESTS_FREE_NET_H
#define ADCGS_TESTS_FREE_NET_H

#include "net/net.h"

static inline void free_net(adcgs_net *net)
{
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++) {
        adcgs_free(NULL, net->layer[i].w.m);
        adcgs_free(NULL, net->layer[i].b.m);
    }
    *net = (adcgs_net){0};
}

#endif
