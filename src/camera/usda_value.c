/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Values of USD properties at times, and freeing a parsed file. */
#include "config.h"

#include "camera/usda.h"

#include <math.h>
#include <stdlib.h>

const adcgs_usda_property *adcgs_usda_find(const adcgs_usda *usda, int prim, const char *name)
{
    const adcgs_usda_property *found = NULL;
    for (int i = 0; i < usda->n_properties; i++) {
        const adcgs_usda_property *const p = &usda->properties[i];
        const int says = p->text || p->n_samples;
        if (p->prim == prim && says && !strcmp(p->name, name) && (!found || found->is_fixed)) /* samples override a fixed value */
            found = p;
    }
    return found;
}

void adcgs_usda_value(const adcgs_usda_property *property, double at, double out[ADCGS_USDA_NUMBERS])
{
    const adcgs_usda_sample *const s = property->samples;
    int low = 0, high = property->n_samples - 1;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (s[middle].at <= at)
            low = middle;
        else
            high = middle;
    }
    const double step = s[high].at - s[low].at, part = step > 0.0 ? fmin(fmax((at - s[low].at) / step, 0.0), 1.0) : 0.0;
    for (int i = 0; i < property->n; i++)
        out[i] = part == 0.0 ? s[low].v[i] : part == 1.0 ? s[high].v[i] : s[low].v[i] + part * (s[high].v[i] - s[low].v[i]);
}

void adcgs_usda_free(adcgs_usda *usda)
{
    for (int i = 0; i < usda->n_properties; i++) {
        free(usda->properties[i].name);
        free(usda->properties[i].samples);
        free(usda->properties[i].text);
    }
    free(usda->properties);
    free(usda->prims);
    *usda = (adcgs_usda){0};
}
