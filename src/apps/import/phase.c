/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The phases of an import on the progress line. */
#include "config.h"

#include "apps/import/phase.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define LEAST_DONE 3      /* parts from which a rate is known */
#define LEAST_SECONDS 2.0 /* seconds from which it is known */

double adcgs_import_time_left(double spent, uint32_t done, uint32_t all, double growth)
{
    if (done < LEAST_DONE || done > all || spent < LEAST_SECONDS)
        return NAN;
    return spent * (pow((double)all / done, growth) - 1.0);
}

void adcgs_import_show(adcgs_import_phase *phase, adcgs_progress *progress, const char *name, uint32_t done, uint32_t all,
                       double growth)
{
    char text[32];
    const double now = adcgs_seconds();
    if (!phase->name || strcmp(phase->name, name))
        *phase = (adcgs_import_phase){name, now};
    if (all)
        adcgs_progress_show(progress, "%-9s %6u/%u%s", name, done, all,
                            adcgs_progress_eta(adcgs_import_time_left(now - phase->began, done, all, growth), text));
    else
        adcgs_progress_show(progress, "%s ...", name);
}
