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

/** Sums over the pixels of a channel that are known. */
typedef struct moments {
    double n, a, b, aa, ab, bb;
} moments;

/** What no line through a says of b: the sum of squares. */
static double left_over(const moments *m)
{
    const double va = m->aa - m->a * m->a / m->n, vb = m->bb - m->b * m->b / m->n, vab = m->ab - m->a * m->b / m->n;
    const double rest = va > 0 ? vb - vab * vab / va : vb;
    return rest > 0 ? rest : 0;
}

double adcgs_fitted_psnr(const float *a, const float *b, size_t n)
{
    double sum = 0, count = 0;
    for (size_t c = 0; c < 3; c++, a += n, b += n) {
        moments m = {0};
        for (size_t i = 0; i < n; i++) {
            const double x = (double)a[i], y = (double)b[i];
            if (isnan(b[i]))
                continue;
            m.n++;
            m.a += x;
            m.b += y;
            m.aa += x * x;
            m.ab += x * y;
            m.bb += y * y;
        }
        sum += m.n > 0 ? left_over(&m) : 0;
        count += m.n;
    }
    return count > 0 ? adcgs_psnr_from_mse(sum / count) : IDENTICAL;
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
