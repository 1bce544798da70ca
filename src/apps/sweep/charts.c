/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The list of charts, and making all of them. */
#include "apps/sweep/charts.h"

const adcgs_chart adcgs_charts[] = {
    {"rate", "Quality against bytes", adcgs_chart_curves, ADCGS_Q_BYTES, ADCGS_Q_PSNR},
    {"rate-moving", "Quality of moving regions against bytes", adcgs_chart_curves, ADCGS_Q_BYTES, ADCGS_Q_MOVING},
    {"rate-ssim", "SSIM against bytes", adcgs_chart_curves, ADCGS_Q_BYTES, ADCGS_Q_SSIM},
    {"time", "Quality against CPU time of training", adcgs_chart_curves, ADCGS_Q_SECONDS, ADCGS_Q_PSNR},
    {"time-moving",
     "Quality of moving regions against CPU time of "
     "training",
     adcgs_chart_curves, ADCGS_Q_SECONDS, ADCGS_Q_MOVING},
    {"speed", "Quality against playback speed", adcgs_chart_curves, ADCGS_Q_SPEED, ADCGS_Q_PSNR},
    {"bytes", "Distribution of the bytes", adcgs_chart_bytes, 0, 0},
    {"portions", "Quality of a part of the stream", adcgs_chart_portions, 0, 0},
    {"views", "Quality over time", adcgs_chart_views, 0, 0},
    {"errors", "Quality view by view", adcgs_chart_errors, 0, 0},
    {.name = NULL},
};

adcgs_status adcgs_sweep_draw(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned *charts, adcgs_error *error)
{
    *charts = 0;
    for (int i = 0; adcgs_charts[i].name; i++) {
        int drawn;
        ADCGS_TRY(adcgs_charts[i].make(&adcgs_charts[i], sweep, plan, &drawn, error));
        *charts |= drawn ? 1U << i : 0;
    }
    return ADCGS_OK;
}
