/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The configuration of a run of adcgs-enc. */
#ifndef ADCGS_APPS_ENC_ENC_CONFIGURE_H
#define ADCGS_APPS_ENC_ENC_CONFIGURE_H

#include "session/enc_run.h"

/** Applies preset, --fixed, --set and single options, in this order, and checks the result. */
adcgs_status adcgs_enc_configure(adcgs_train_config *c, const adcgs_enc_options *o, adcgs_cpu_level cpu, adcgs_error *error);

#endif
