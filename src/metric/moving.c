/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of moving pixels, by a known mask. */
#include "config.h"

#include "metric/moving.h"

#include "metric/metric.h"

#include <math.h>

adcgs_moving adcgs_moving_measure(const uint8_t *moving, const float *decoded, const float *truth, size_t plane)
{
    double squares = 0.0;
    size_t n = 0;
    for (size_t i = 0; i < plane; i++) {
        if (!moving[i] || isnan(truth[i]))
            continue;
        n++;
        for (size_t c = 0; c < 3; c++) {
            const double difference = (double)decoded[c * plane + i] - (double)truth[c * plane + i];
            squares += difference * difference;
        }
    }
    return (adcgs_moving){
        .psnr = n ? adcgs_psnr_from_mse(squares / (3.0 * (double)n)) : (double)NAN,
        .share = (double)n / (double)plane,
    };
}
