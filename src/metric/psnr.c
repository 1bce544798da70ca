/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Peak signal-to-noise ratio. */
#include "config.h"

#include "metric/metric.h"

#include <math.h>

#define IDENTICAL 99.0

double adcgs_psnr_from_mse(double mse)
{
    if (!(mse > 0.0))
        return mse == 0.0 ? IDENTICAL : mse; /* not-a-number stays visible */
    return ADCGS_MIN(IDENTICAL, -10.0 * log10(mse));
}

double adcgs_psnr(const float *a, const float *b, size_t n)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const double difference = (double)a[i] - (double)b[i];
        const int seen = !isnan(b[i]);
        sum += seen ? difference * difference : 0.0;
        count += (size_t)seen;
    }
    return count ? adcgs_psnr_from_mse(sum / (double)count) : IDENTICAL;
}
