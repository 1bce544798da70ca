/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Budgets of adcgs-dec. */
#include "apps/dec/dec_budget.h"

#include "cli/cli.h"
#include "system/numbers.h"

#include <stdlib.h>

adcgs_status adcgs_budget_parse(adcgs_budget *budget, const char *text, adcgs_error *error)
{
    char *unit;
    uint64_t bytes;
    budget->most = strtod(text, &unit);
    budget->of = !strcmp(unit, "splats") ? ADCGS_BUDGET_SPLATS : !strcmp(unit, "ms") ? ADCGS_BUDGET_TIME : ADCGS_BUDGET_BYTES;
    if (budget->of != ADCGS_BUDGET_BYTES && budget->most > 0 && budget->most < 1e12)
        return ADCGS_OK;
    if (budget->of != ADCGS_BUDGET_BYTES || adcgs_parse_size(text, 1, UINT64_C(1) << 40, &bytes))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--budget %.100s: expected bytes (40k), splats (20000splats) or time (16ms)",
                          text);
    budget->most = (double)bytes;
    return ADCGS_OK;
}

typedef struct source {
    adcgs_read_fn read;
    void *user;
    double left;
} source;

static int64_t read_some(void *user, void *buffer, size_t bytes)
{
    source *const s = user;
    const size_t n = (double)bytes < s->left ? bytes : (size_t)s->left;
    const int64_t got = n ? s->read(s->user, buffer, n) : 0;
    s->left -= got > 0 ? (double)got : 0.0;
    return got;
}

adcgs_status adcgs_budget_open(adcgs_decoder **decoder, const adcgs_budget *budget, adcgs_read_fn read, void *user,
                               const adcgs_config *config, adcgs_error *error)
{
    source from = {read, user, budget->most};
    return adcgs_open_stream(decoder, read_some, &from, config, error);
}

/** Measures the cost of a frame, in the budget's unit. */
static adcgs_status measure(const adcgs_budget *budget, adcgs_decoder *decoder, const adcgs_camera *camera, double time,
                            adcgs_frame *frame, double *cost, adcgs_error *error)
{
    adcgs_primitives splats;
    if (budget->of == ADCGS_BUDGET_SPLATS) {
        ADCGS_TRY(adcgs_get_primitives(decoder, time, &splats, error));
        *cost = 0;
        for (uint32_t i = 0; i < splats.n; i++)
            *cost += splats.opacity[i] > 0;
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_render(decoder, camera, time, frame, error)); /* the first render allocates memory and is not timed */
    const double begin = adcgs_seconds();
    const adcgs_status status = adcgs_render(decoder, camera, time, frame, error);
    *cost = 1e3 * (adcgs_seconds() - begin);
    return status;
}

adcgs_status adcgs_budget_fit(const adcgs_budget *budget, adcgs_decoder *decoder, const adcgs_camera *camera, double time,
                              adcgs_frame *frame, int *tiers, adcgs_error *error)
{
    adcgs_info info;
    double cost;
    *tiers = 0;
    if (budget->of != ADCGS_BUDGET_SPLATS && budget->of != ADCGS_BUDGET_TIME)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    for (int n = info.tiers; n > 0; n--) {
        ADCGS_TRY(adcgs_set_tiers(decoder, n, error));
        ADCGS_TRY(measure(budget, decoder, camera, time, frame, &cost, error));
        *tiers = n < info.tiers ? n : 0;
        if (cost <= budget->most)
            break;
    }
    return ADCGS_OK;
}
