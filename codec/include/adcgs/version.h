/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Version of the library and of the bitstream it writes. configure.ac reads this file. */
#ifndef ADCGS_VERSION_H
#define ADCGS_VERSION_H

#include <adcgs/status.h>

#define ADCGS_VERSION_MAJOR 0
#define ADCGS_VERSION_MINOR 1
#define ADCGS_VERSION_PATCH 0

#define ADCGS_BITSTREAM_MAJOR 0
#define ADCGS_BITSTREAM_MINOR 3

#ifdef __cplusplus
extern "C" {
#endif
/** \return the version of the library that is running, e.g. "0.1.0". */
ADCGS_API const char *adcgs_version_string(void);
#ifdef __cplusplus
}
#endif
#endif
