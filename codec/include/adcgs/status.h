/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Status codes and error messages.
 *
 * Every function that can fail returns an adcgs_status and takes a pointer to
 * an adcgs_error, into which it writes one complete line: the input that it
 * read, the position, and the expected contents. The pointer may be NULL. If
 * the function succeeds, a non-NULL error keeps its contents.
 */
#ifndef ADCGS_STATUS_H
#define ADCGS_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
/** Marks each function that the library exports. */
#define ADCGS_API __attribute__((visibility("default")))
#else
/** Marks each function that the library exports. */
#define ADCGS_API
#endif

/** Result of an operation: zero is success, everything else is negative. */
typedef enum adcgs_status {
    ADCGS_OK = 0,               /**< success */
    ADCGS_ERR_USAGE = -1,       /**< a caller broke the contract of a function */
    ADCGS_ERR_MEMORY = -2,      /**< an allocation failed: the machine is out of memory */
    ADCGS_ERR_IO = -3,          /**< reading or writing failed */
    ADCGS_ERR_DATA = -4,        /**< the input violates its format */
    ADCGS_ERR_TRUNCATED = -5,   /**< the input ends before it is complete */
    ADCGS_ERR_UNSUPPORTED = -6, /**< valid, but newer than, or different from, the features of this build */
    ADCGS_ERR_LIMIT = -7,       /**< more than the stream's level, the caller's memory_limit or a limit of the format allows */
    ADCGS_ERR_FPENV = -8,       /**< this machine or build does not compute strict binary32 */
    ADCGS_ERR_INTERNAL = -9     /**< a defect of this library */
} adcgs_status;

/** Size of an error's text in bytes, including the terminating zero. */
#define ADCGS_ERROR_TEXT 248

/** A status with its explanation. Owned by the caller; its size never changes. */
typedef struct adcgs_error {
    adcgs_status status;         /**< return value of the function */
    char text[ADCGS_ERROR_TEXT]; /**< one line of UTF-8 without line feed, always ended by a zero byte */
} adcgs_error;

/**
 * Name a status.
 * \param status any number
 * \return a short static English name, never NULL; unknown numbers give "internal error"
 */
ADCGS_API const char *adcgs_status_name(adcgs_status status);

#ifdef __cplusplus
}
#endif
#endif
