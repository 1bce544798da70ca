/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the CPU can do. */
#ifndef ADCGS_BASE_CPU_H
#define ADCGS_BASE_CPU_H

#include "base/base.h"

#include <adcgs/cpu.h>

/** Resolve AUTO to the best level; ADCGS_ERR_UNSUPPORTED when the machine or the build lacks the level asked for. */
adcgs_status adcgs_cpu_resolve(adcgs_cpu_level asked, adcgs_cpu_level *level, adcgs_error *error);
/** "auto", "scalar", "avx2", "avx512" by level, then NULL. */
extern const char *const adcgs_cpu_names[];

#endif
