/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Capabilities of the CPU. */
#ifndef ADCGS_BASE_CPU_DETECT_H
#define ADCGS_BASE_CPU_DETECT_H

#include "base/base.h"

#include <adcgs/cpu.h>

/** Resolve AUTO to the best level; ADCGS_ERR_UNSUPPORTED if the machine or the build lacks the requested level. */
adcgs_status adcgs_cpu_resolve(adcgs_cpu_level asked, adcgs_cpu_level *level, adcgs_error *error);
/** "auto", "scalar", "avx2", "avx512", indexed by level, then NULL. */
extern const char *const adcgs_cpu_names[];

#endif
