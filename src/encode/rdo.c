/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choosing a level. */
#include "encode/rdo.h"

int32_t adcgs_rdo_level(int si, double wanted, int32_t nearest, double weight, double lambda_bit)
{
    const double bit = lambda_bit * 0x1p-16;
    const int32_t towards = nearest > 0 ? -1 : 1;
    int32_t best = nearest;
    double least = 0;
    for (int32_t n = nearest; nearest; n += towards) {
        const double cost = weight * (n - wanted) * (n - wanted) + bit * adcgs_value_cost(si, n);
        if (n == nearest || cost < least) {
            least = cost;
            best = n;
        }
        if (n == 0)
            break;
    }
    return best;
}
