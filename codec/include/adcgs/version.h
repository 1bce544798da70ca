/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Version of the library and of the bitstream that it decodes. configure.ac reads this file.
 */
#ifndef ADCGS_VERSION_H
#define ADCGS_VERSION_H

#include <stdint.h>

#include <adcgs/status.h>

/** Version of these headers. */
#define ADCGS_VERSION_MAJOR 0
/** Version of these headers, second number. */
#define ADCGS_VERSION_MINOR 1
/** Version of these headers, third number. */
#define ADCGS_VERSION_PATCH 0

/** A version as one number; later versions have larger ones. minor and patch: 0..999. */
#define ADCGS_MAKE_VERSION(major, minor, patch) (1000000U * (major) + 1000U * (minor) + (patch))

/** The version of these headers, to compare with ADCGS_MAKE_VERSION() in `#if`. */
#define ADCGS_VERSION ADCGS_MAKE_VERSION(ADCGS_VERSION_MAJOR, ADCGS_VERSION_MINOR, ADCGS_VERSION_PATCH)

/** Version of the bitstream that is decoded (clause "HEAD"). */
#define ADCGS_BITSTREAM_MAJOR 0
/** Version of the bitstream, second number. */
#define ADCGS_BITSTREAM_MINOR 12

#ifdef __cplusplus
extern "C" {
#endif

/** \return the version of the library that is running, as ADCGS_VERSION is that of the headers */
ADCGS_API uint32_t adcgs_version_number(void);

/** \return the version of the library that is running, e.g. "0.1.0"; static */
ADCGS_API const char *adcgs_version_string(void);

#ifdef __cplusplus
}
#endif
#endif
