/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * CPU levels that this machine and this build support.
 */
#ifndef ADCGS_CPU_H
#define ADCGS_CPU_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** \return the best level that this build supports on this machine, never ADCGS_CPU_AUTO */
ADCGS_API adcgs_cpu_level adcgs_cpu_best(void);

/**
 * Name a level.
 * \param level any number
 * \return "auto", "scalar", "avx2", "avx512" or "unknown"; static
 */
ADCGS_API const char *adcgs_cpu_name(adcgs_cpu_level level);

#ifdef __cplusplus
}
#endif
#endif
