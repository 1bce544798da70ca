/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pruning of floaters in front of the cameras. */
#include "train/density/floaters.h"

#include "train/density/anchor_set.h"

void adcgs_drop_floaters(adcgs_trainer *t)
{
    const adcgs_fmodel *f = t->f;
    const adcgs_primitives *p = &t->pass->primitives;
    if (!t->stereo.maps || !t->config.prune_floaters)
        return;
    adcgs_pass_forward(t->pass, f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_NONE});
    for (uint32_t i = 0; i < p->n; i++) {
        const uint32_t anchor = adcgs_anchor_of(f, i);
        const double x[3] = {(double)p->mean[0][i], (double)p->mean[1][i], (double)p->mean[2][i]};
        if (anchor < f->n && f->trainable[anchor] != 0 && f->moving[anchor] == 0 && f->keep[i] != 0 &&
            adcgs_stereo_floats(&t->stereo, x))
            f->keep[i] = 0;
    }
}
