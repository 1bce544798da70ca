/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Status codes and error messages.
 *
 * Every function that can fail returns an adcgs_status. Where a function also
 * takes an adcgs_error pointer, it writes one complete line there that names
 * what was being read, where, and what was expected; the pointer may be NULL.
 */
#ifndef ADCGS_STATUS_H
#define ADCGS_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define ADCGS_API __attribute__((visibility("default")))
#define ADCGS_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define ADCGS_API
#define ADCGS_PRINTF(fmt, args)
#endif

/** Result of an operation: zero is success, everything else is negative. */
typedef enum adcgs_status {
    ADCGS_OK = 0,
    ADCGS_ERR_USAGE = -1,       /**< a caller broke the contract of a function */
    ADCGS_ERR_MEMORY = -2,      /**< an allocation failed */
    ADCGS_ERR_IO = -3,          /**< reading or writing failed */
    ADCGS_ERR_DATA = -4,        /**< the input violates its format */
    ADCGS_ERR_TRUNCATED = -5,   /**< the input ends before it is complete */
    ADCGS_ERR_UNSUPPORTED = -6, /**< valid, but newer or other than this build can handle */
    ADCGS_ERR_LIMIT = -7,       /**< exceeds the stream's level or the caller's limit */
    ADCGS_ERR_FPENV = -8,       /**< this machine or build does not compute strict binary32 */
    ADCGS_ERR_INTERNAL = -9     /**< a defect of this library */
} adcgs_status;

/** A status with its one-line explanation. Caller-owned; text is always terminated. */
typedef struct adcgs_error {
    adcgs_status status;
    char text[248];
} adcgs_error;

/** \return a short static English name of the status, never NULL. */
ADCGS_API const char *adcgs_status_name(adcgs_status status);

/** Exit code of the programs for a status: 0, 2 usage, 3 input/output and memory, 4 invalid data, 5 unsupported. */
ADCGS_API int adcgs_status_exit_code(adcgs_status status);

#ifdef __cplusplus
}
#endif
#endif
