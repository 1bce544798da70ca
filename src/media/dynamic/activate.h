/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Activations of trained splats: files hold logits of opacities and logarithms of scales. */
#ifndef ADCGS_MEDIA_DYNAMIC_ACTIVATE_H
#define ADCGS_MEDIA_DYNAMIC_ACTIVATE_H

#include "media/splats/splats.h"

/** The standard deviation with this logarithm: at least that of a flat axis; INFINITY above binary32, NAN for NAN. */
float adcgs_scale_of_log(double logarithm);
/** Replace logarithms in scale and logits in opacity by their values. */
void adcgs_splats_activate(adcgs_splats *splats);

#endif
