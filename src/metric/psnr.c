/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Peak signal-to-noise ratio. */
#include "config.h"

#include "metric/metric.h"

#include <math.h>

#define IDENTICAL 99.0 /* dB for identical images; chosen by hand, not measured */

double adcgs_psnr_from_mse(double mse)
{
    if (!(mse > 0.0))
        return mse == 0.0 ? IDENTICAL : mse; /* NaN stays visible */
    return ADCGS_MIN(IDENTICAL, -10.0 * log10(mse));
}

/** Fit one channel: *gain and *black of the line through a that is nearest to b, where b is known. */
static void fit_line(const float *a, const float *b, size_t n, double *gain, double *black)
{
    double count = 0, sa = 0, sb = 0, saa = 0, sab = 0;
    for (size_t i = 0; i < n; i++) {
        const double x = (double)a[i], y = (double)b[i];
        if (isnan(b[i]))
            continue;
        count++;
        sa += x;
        sb += y;
        saa += x * x;
        sab += x * y;
    }
    const double variance = saa - sa * sa / count, both = sab - sa * sb / count;
    *gain = variance > 0 ? both / variance : 0;
    *black = count > 0 ? (sb - *gain * sa) / count : 0;
}

void adcgs_fit_levels(float *fitted, const float *a, const float *b, size_t n)
{
    for (size_t c = 0; c < 3; c++, a += n, b += n, fitted += n) {
        double gain, black;
        fit_line(a, b, n, &gain, &black);
        for (size_t i = 0; i < n; i++)
            fitted[i] = (float)(gain * (double)a[i] + black);
    }
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
